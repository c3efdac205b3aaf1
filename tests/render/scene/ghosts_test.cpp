// SPDX-License-Identifier: Apache-2.0
#include "render/scene/ghosts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// What a ray meets of a ball or box, by the test's own way: where, and the normal there.
struct Met {
    double distance = kMiss;
    Vec4 normal;
};

Met meet_ball(double radius, const Vec4& start, const Vec4& direction) {
    const double b = start.dot(direction), c = start.squaredNorm() - radius * radius;
    if (b * b < c || c < 0) return {};
    const double t = -b - std::sqrt(b * b - c);
    if (t <= 0) return {};
    return {t, (start + t * direction) / radius};
}
Met meet_box(const Vec4& half, const Vec4& start, const Vec4& direction) {
    double in = -kMiss, out = kMiss;
    Vec4 normal = Vec4::Zero();
    for (int i = 0; i < 4; ++i) {
        const double a = (-half[i] - start[i]) / direction[i];
        const double b = (half[i] - start[i]) / direction[i];
        if (std::min(a, b) > in) in = std::min(a, b), normal = Vec4::Unit(i);
        out = std::min(out, std::max(a, b));
    }
    return in > 0 && in < out ? Met{in, normal} : Met{};
}

/// A body by numbers of its own.
struct Solid {
    bool is_ball;
    double radius;
    Vec4 half, centre;
    Mat4 turn;  ///< body to world

    Met meet(const Vec4& start, const Vec4& direction) const {
        const Vec4 from = turn.transpose() * (start - centre), along = turn.transpose() * direction;
        Met met = is_ball ? meet_ball(radius, from, along) : meet_box(half, from, along);
        met.normal = turn * met.normal;
        return met;
    }
    double half_width(const Vec4& n) const {
        return is_ball ? radius : half.dot((turn.transpose() * n).cwiseAbs());
    }
};

/// Balls and boxes about the slice.
struct Pieces {
    TestScene scene;
    std::vector<Solid> solids;

    explicit Pieces(std::uint64_t seed) {
        Random random(seed);
        scene.camera = random_camera(random, 9);
        scene.camera.look_at = Vec4::Zero();
        for (int i = 0; i < 14; ++i) {
            Solid s = {i % 2 == 0, uniform(random, 0.3, 1), {}, random_vector(random, 2), {}};
            for (int axis = 0; axis < 4; ++axis) s.half[axis] = uniform(random, 0.2, 0.8);
            const Rotor rotor = random_rotor(random);
            s.turn = to_matrix(rotor);
            scene.add(s.is_ball ? Shape(Hypersphere{s.radius}) : Shape(Hyperbox{2 * s.half}),
                      s.centre, rotor);
            solids.push_back(s);
        }
        scene.lights.sky = Color::Constant(0.5);
        scene.settings.width = 48, scene.settings.height = 36;
        scene.settings.samples = 1;
        scene.settings.ghost_depth = 1.5;
        scene.settings.ghost_colors = {Color(0.1, 0.2, 0.9), Color(0.8, 0.5, 0.3)};
    }

    /// Red, green, blue and alpha through a pixel's centre.
    std::array<double, 4> ghosts(int x, int y) const {
        const Camera camera(scene.camera, scene.settings.width, scene.settings.height);
        const Vec4 n = camera.fourth(), at = scene.camera.position;
        const Vec3 d = camera.ray_direction({x + 0.5, y + 0.5});
        const Vec4 direction = d[0] * camera.right() + d[1] * camera.up() + d[2] * camera.forward();
        const double depth = scene.settings.ghost_depth;
        struct Layer {
            Met met;
            double alpha;
            bool is_above;
        };
        double solid = kMiss;
        std::vector<Layer> layers;
        for (const Solid& s : solids) {
            const double off = n.dot(s.centre - at), gap = std::abs(off) - s.half_width(n);
            if (gap <= 0) solid = std::min(solid, s.meet(at, direction).distance);
            if (gap <= 0 || gap >= depth) continue;
            const double shift = std::clamp(off, -depth, depth);
            const Met met = s.meet(at + shift * n, direction);
            if (met.distance < kMiss) layers.push_back({met, 1 - gap / depth, off > 0});
        }
        std::sort(layers.begin(), layers.end(),
                  [](auto& a, auto& b) { return a.met.distance < b.met.distance; });
        Color color = Color::Zero();
        double clear = 1;
        for (const Layer& layer : layers) {
            if (layer.met.distance > solid) break;
            const Vec4 seen = layer.met.normal - n.dot(layer.met.normal) * n;
            const double facing = std::abs(seen.normalized().dot(direction));
            color += clear * layer.alpha * (0.4 + 0.6 * facing) *
                     scene.settings.ghost_colors[layer.is_above ? 1 : 0];
            clear *= 1 - layer.alpha;
        }
        return {color[0], color[1], color[2], 1 - clear};
    }
};

TEST(Ghosts, AreThoseOfABruteForcePicture) {
    int seen = 0, covered = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Pieces pieces(seed);
        const Image image = picture_of(pieces.scene);
        int wrong = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const auto expected = pieces.ghosts(x, y);
                bool is_right = true;
                for (std::size_t i = 0; i < 4; ++i) {
                    const double found = image.at(std::string("ghost.") + "RGBA"[i], x, y);
                    is_right &= std::abs(found - expected[i]) < 2e-3;
                }
                wrong += is_right ? 0 : 1;
                seen += expected[3] > 0 ? 1 : 0;
                covered += expected[3] > 0 && image.id(x, y) != 0 ? 1 : 0;
            }
        EXPECT_LE(wrong, 0) << "seed " << seed;
    }
    EXPECT_GT(seen, 1000);
    EXPECT_GT(covered, 50);
}

TEST(Ghosts, HaveTheGapOfTheirVertices) {
    Random random(3);
    for (int round = 0; round < 100; ++round) {
        TestScene scene;
        scene.camera = random_camera(random, 6);
        scene.add(random_shape(random, 3, 1), random_vector(random, 3), random_rotor(random));
        const Camera camera(scene.camera, 64, 48);
        const auto& hull = std::get<Complete<Polychoron>>(scene.bodies.types[0].shape).body->hull;
        double low = kMiss, high = -kMiss;
        for (const Vec4& vertex : hull.vertices) {
            const Vec4 at = rotate(scene.bodies.rotor[0], vertex) + scene.bodies.position[0];
            const double w = camera.fourth().dot(at - scene.camera.position);
            low = std::min(low, w), high = std::max(high, w);
        }
        const SliceRange slice = {-0.1 * (round % 3), 0.1 * (round % 3)};
        const double gap = std::max(low - slice.high, slice.low - high), depth = 2;
        const auto found = ghosts_beside(place_bodies(scene.picture(), camera.origin()), camera,
                                         slice, depth, kSideColors);
        ASSERT_EQ(found.size(), gap > 0 && gap < depth ? 1u : 0u) << round;
        if (found.empty()) continue;
        EXPECT_NEAR(found[0].alpha, 1 - gap / depth, 1e-12);
        EXPECT_TRUE((found[0].color == kSideColors[low > slice.high ? 1 : 0]).all());
        EXPECT_GE(found[0].fourth, low - 1e-12);
        EXPECT_LE(found[0].fourth, high + 1e-12);
    }
}

TEST(Ghosts, AreTheSameWithAnyTilesCropThreadsAndSlices) {
    Pieces pieces(2);
    TestScene& scene = pieces.scene;
    scene.settings.samples = 5;
    scene.settings.max_samples = 20;
    scene.camera.aperture = 0.05;
    Folder folder;
    for (const int slices : {1, 4}) {
        scene.camera.slices = slices;
        scene.camera.slice_thickness = 0.4;
        scene.settings.tile = 32;
        scene.settings.crop.reset();
        const Image whole = picture_of(scene);
        const auto expect_same = [&](const Image& other, const char* what) {
            for (int y = other.y0; y < other.y0 + other.height; ++y)
                for (int x = other.x0; x < other.x0 + other.width; ++x)
                    for (const char* channel : {"ghost.R", "ghost.A", "R"})
                        ASSERT_EQ(other.at(channel, x, y), whole.at(channel, x, y)) << what;
        };
        scene.settings.tile = 8;
        expect_same(picture_of(scene), "tile");
        scene.settings.crop = Crop{7, 5, 40, 30};
        expect_same(picture_of(scene), "crop");
        scene.settings.crop.reset();
        render(scene, folder / "a.exr", {}, 1);
        render(scene, folder / "b.exr", {}, 4);
        EXPECT_EQ(content(folder / "a.exr"), content(folder / "b.exr"));
    }
}

TEST(Ghosts, ChangeNothingElseOfThePicture) {
    Pieces pieces(4);
    const Image with = picture_of(pieces.scene);
    pieces.scene.settings.ghost_depth = 0;
    const Image without = picture_of(pieces.scene);
    EXPECT_EQ(without.planes.count("ghost.A"), 0u);
    for (const auto& [name, plane] : without.planes) EXPECT_EQ(plane, with.planes.at(name)) << name;
    EXPECT_EQ(with.ids, without.ids);
}

}  // namespace
}  // namespace tesserae::render
