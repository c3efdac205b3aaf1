// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/render/traced_scene.hpp"

// Cameras inside bodies of glass, one or several, at the world's origin.
namespace tesserae::render {
namespace {

using std::numbers::pi;

constexpr std::array kIntegrators = {Integrator::kDirect, Integrator::kPath};

/// Glass of a given index around everything; white.
TestScene glass_scene(double index, Integrator integrator) {
    TestScene scene = path_scene(100'000);
    scene.settings.integrator = integrator;
    scene.lights.sky = Color::Ones();
    scene.materials[0].kind = MaterialKind::kGlass;
    scene.materials[0].albedo = Color::Ones();
    scene.materials[0].ior = index;
    return scene;
}

TEST(InsideGlass, AWhiteFurnaceHasTheCubeOfTheIndex) {
    // Radiance over the index cubed is what crossings keep. A ray that starts nearer to the centre
    // than radius/index meets the surface below the critical angle, always at the same, and gets
    // out.
    Random random(551);
    for (const Integrator integrator : kIntegrators)
        for (int i = 0; i < 10; ++i) {
            const double index = uniform(random, 1.05, 2.5);
            TestScene scene = glass_scene(index, integrator);
            const double off = uniform(random, 0, 0.9) / index;
            scene.add(Hypersphere{1}, off * random_direction(random));
            expect_near(mean_radiance(TracedScene(scene), random_direction(random), 1000),
                        index * index * index, 0.05, std::to_string(index));
        }
}

TEST(InsideGlass, AtABallsCentreTheSkyIsSeenThroughOneCrossing) {
    // At normal incidence R comes back through the centre to the other side, tinted each time:
    // n^3 a (1 - R) (1 + a R + ...).
    for (const Integrator integrator : kIntegrators)
        for (const double index : {1.33, 1.5, 2.4}) {
            TestScene scene = glass_scene(index, integrator);
            scene.materials[0].albedo = Color::Constant(0.7);
            scene.lights.sky = Color::Constant(2);
            scene.add(Hypersphere{3}, Vec4::Zero());
            const double r = std::pow((index - 1) / (index + 1), 2);
            const double seen = 2 * std::pow(index, 3) * 0.7 * (1 - r) / (1 - 0.7 * r);
            expect_near(
                mean_radiance(TracedScene(scene), Vec4(0.1, 0.3, 1, 0.4).normalized(), 4000), seen,
                0.05, std::to_string(index));
        }
}

/// The reference of glass that overlaps: what stands between two surfaces that a ray passes is told
/// by the point in the middle of them, all bodies tried. One path at a time, by recursion.
class GlassReference {
  public:
    explicit GlassReference(const TracedScene& traced) : t_(traced) {}

    /// Of a path's scatterings so far.
    struct Scattered {
        int rough = 0, specular = 0;
    };

    Color radiance(const Vec4& origin, const Vec4& direction, Scattered scattered,
                   Random& random) const {
        const auto passed = surfaces_on(origin, direction);
        const auto behind = [&](std::size_t k) {
            const double from = k == 0 ? 0 : passed[k - 1].first;
            const double to = k < passed.size() ? passed[k].first : from + 2;
            return at(origin + 0.5 * (from + to) * direction);
        };
        const std::uint32_t here = behind(0);
        for (std::size_t k = 0; k < passed.size(); ++k) {
            const std::uint32_t there = behind(k + 1);
            if (there == here) continue;
            const Vec4 point = origin + passed[k].first * direction;
            return from_surface(passed[k].second, here, there, point, direction, scattered, random);
        }
        return t_.scene.lights.sky;
    }

    /// The last body of glass that holds a point, any other that does, or none.
    std::uint32_t at(const Vec4& point) const {
        std::uint32_t found = kNoBody;
        for (std::uint32_t b = 0; b < t_.placed.bodies.size(); ++b) {
            const PlacedBody& body = t_.placed.bodies[b];
            const Vec4 local = t_.placed.point_to_body(body, point);
            if (std::visit([&](const auto& s) { return signed_distance(s, local); }, *body.shape) >=
                0)
                continue;
            if (!is_glass(b)) return b;
            found = b;
        }
        return found;
    }
    bool is_glass(std::uint32_t body) const {
        return body != kNoBody && material(body).kind == MaterialKind::kGlass;
    }

  private:
    const Material& material(std::uint32_t body) const { return t_.scene.materials[body % 5]; }

    /// Where the ray goes into and out of bodies, ascending.
    std::vector<std::pair<double, std::uint32_t>> surfaces_on(const Vec4& origin,
                                                              const Vec4& direction) const {
        constexpr double kBack = 50, kHere = 1e-9;
        std::vector<std::pair<double, std::uint32_t>> surfaces;
        for (std::uint32_t b = 0; b < t_.placed.bodies.size(); ++b) {
            const PlacedBody& body = t_.placed.bodies[b];
            const Vec4 o = t_.placed.point_to_body(body, origin - kBack * direction);
            const Vec4 d = t_.placed.direction_to_body(body, direction);
            std::visit(
                [&](const auto& s) {
                    const double in = ray_hit(s, o, d);
                    if (in == kMiss) return;
                    const double out = in + ray_exit(s, o + in * d, d);
                    if (in - kBack > kHere) surfaces.push_back({in - kBack, b});
                    if (out - kBack > kHere && out < kMiss) surfaces.push_back({out - kBack, b});
                },
                *body.shape);
        }
        std::sort(surfaces.begin(), surfaces.end());
        return surfaces;
    }

    Color from_surface(std::uint32_t body, std::uint32_t here, std::uint32_t there,
                       const Vec4& point, const Vec4& direction, Scattered scattered,
                       Random& random) const {
        const Material& m = material(body);
        const Settings& settings = t_.scene.settings;
        if (is_glass(body) ? scattered.specular == settings.specular_bounces
                           : scattered.rough > settings.bounces)
            return m.emission;
        ++(is_glass(body) ? scattered.specular : scattered.rough);
        const PlacedBody& b = t_.placed.bodies[body];
        const Vec4 local = t_.placed.point_to_body(b, point);
        Vec4 facing = t_.placed.direction_to_world(
            b, std::visit([&](const auto& s) { return normal(s, local); }, *b.shape));
        if (facing.dot(direction) > 0) facing = -facing;
        if (!is_glass(body)) {
            Vec4 next = random_direction(random);
            if (next.dot(facing) < 0) next = -next;
            const Color from = radiance(point, next, scattered, random);
            return m.emission + m.albedo * (3 / (4 * pi) * next.dot(facing) * pi * pi) * from;
        }
        // Fresnel by the angles; two of three polarisations lie across the plane of incidence.
        const double n1 = is_glass(here) ? material(here).ior : 1;
        const double n2 = is_glass(there) ? material(there).ior : 1;
        const double in = std::acos(std::min(1.0, -direction.dot(facing)));
        const double sine = std::sin(in) * n1 / n2;
        double reflected = 1;
        if (sine < 1) {
            const double out = std::asin(sine);
            const double s =
                (n1 * std::cos(in) - n2 * std::cos(out)) / (n1 * std::cos(in) + n2 * std::cos(out));
            const double p =
                (n1 * std::cos(out) - n2 * std::cos(in)) / (n1 * std::cos(out) + n2 * std::cos(in));
            reflected = (p * p + 2 * s * s) / 3;
        }
        const Vec4 along = direction - direction.dot(facing) * facing;
        if (uniform(random, 0, 1) < reflected)
            return m.emission + m.albedo * radiance(point, along - direction.dot(facing) * facing,
                                                    scattered, random);
        const Vec4 across = along * (n1 / n2) - std::sqrt(1 - sine * sine) * facing;
        return m.emission + m.albedo * std::pow(n1 / n2, 3) *
                                radiance(point, across.normalized(), scattered, random);
    }

    const TracedScene& t_;
};

/// Bodies of all shapes about the origin, of which one of glass holds it: three kinds of glass,
/// one glowing, and two of diffuse ones, black for DirectIntegrator.
TestScene heap_about_the_origin(Random& random, Integrator integrator) {
    TestScene scene = path_scene(12);
    scene.settings.specular_bounces = 12;
    scene.settings.integrator = integrator;
    scene.lights.sky = {1, 0.6, 0.2};
    scene.materials.resize(5);
    const double indices[] = {1.5, 1.2, 1.8};
    for (std::size_t i = 0; i < 3; ++i) {
        scene.materials[i].kind = MaterialKind::kGlass;
        scene.materials[i].ior = indices[i];
        scene.materials[i].albedo = {0.9, 0.95, 0.8};
    }
    scene.materials[1].emission = Color::Constant(0.1);
    scene.materials[3].emission = {0, 0.5, 1};
    scene.materials[4].emission = {0.5, 0, 0};
    const double white = integrator == Integrator::kPath ? 0.8 : 0;
    scene.materials[3].albedo = scene.materials[4].albedo = Color::Constant(white);
    for (std::uint32_t i = 0; i < 9; ++i) {
        const bool is_glass = i % 5 < 3;
        const Rotor rotor = random_rotor(random);
        const Vec4 place = random_vector(random, is_glass ? 0.5 : 1.2);
        const auto kind = static_cast<int>(random() % 3);
        scene.add(random_shape(random, kind, is_glass ? 1 : 0.5), place, rotor, i % 5);
    }
    return scene;
}

void expect_heaps_of_glass(int heaps) {
    // The greatest of some 100 differences of two means in units of its deviation stays below 4.5
    // with probability 0.999.
    Random random(552);
    int compared = 0;
    for (int i = 0; compared < heaps; ++i) {
        const TracedScene traced(
            heap_about_the_origin(random, kIntegrators[static_cast<std::size_t>(i) % 2]));
        const GlassReference reference(traced);
        if (!reference.is_glass(reference.at(Vec4::Zero()))) continue;
        ++compared;
        const Vec4 direction = random_direction(random);
        const Mean found = mean_radiance(traced, direction, 1500);
        Mean expected;
        for (int k = 0; k < 1500; ++k)
            expected.add(reference.radiance(Vec4::Zero(), direction, {}, random));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.mean()[c], expected.mean()[c],
                        4.5 * std::hypot(found.sigma()[c], expected.sigma()[c]) + 1e-9)
                << i << " " << c << ": " << found.sigma()[c] << " " << expected.sigma()[c];
    }
}

TEST(InsideGlass, HeapsAgreeWithTheReference) { expect_heaps_of_glass(12); }
TEST(InsideGlassSlow, HeapsAgreeWithTheReference) { expect_heaps_of_glass(36); }

TEST(InsideGlass, TheFirstSurfaceBeyondTheCameraIsShown) {
    // A camera in a ball of glass, off its centre, in which a small diffuse ball hangs: depth and
    // number are the small ball's, else those of the way out, by the quadratic equation. The glass
    // that comes first in the list and holds the camera too is not there.
    for (const bool has_lens : {false, true}) {
        TestScene scene;
        scene.settings.width = 48, scene.settings.height = 36;
        scene.settings.channels.position = true;
        scene.settings.samples = 2;
        scene.materials.resize(2);
        scene.materials[1].kind = MaterialKind::kGlass;
        scene.camera.position = {0.2, 0.1, -0.5, 0.1}, scene.camera.look_at = {0.2, 0, 3, 0.1};
        scene.camera.field_of_view = 90;
        if (has_lens) scene.camera.aperture = 0.01;
        scene.add(Hyperbox{Vec4::Constant(9)}, Vec4::Zero(), {}, 1);
        scene.add(Hypersphere{0.2}, {0.3, 0, 0.5, 0});
        const Vec4 centre(0.1, 0, 0.2, 0.3);
        scene.add(Hypersphere{1.5}, centre, {}, 1);
        const Image image = picture_of(scene);
        const Camera camera(scene.camera, 48, 36);
        int inside = 0;
        for (int y = 0; y < 36; ++y)
            for (int x = 0; x < 48; ++x) {
                const Vec3 view = camera.ray_direction({x + 0.5, y + 0.5});
                const Vec4 d = camera.to_world(Vec4(view.x(), view.y(), view.z(), 0));
                const auto root = [&](const Vec4& c, double radius, double sign) {
                    const Vec4 o = camera.origin() - c;
                    const double b = o.dot(d), square = b * b - o.squaredNorm() + radius * radius;
                    return square < 0 ? kMiss : -b + sign * std::sqrt(square);
                };
                const double ball = root({0.3, 0, 0.5, 0}, 0.2, -1), out = root(centre, 1.5, 1);
                inside += ball < out;
                ASSERT_EQ(image.id(x, y), ball < out ? 2u : 3u) << x << ", " << y;
                const double depth = std::min(ball, out);
                EXPECT_NEAR(image.at("Z", x, y), depth, 1e-6 * depth) << x << ", " << y;
                EXPECT_NEAR(image.at("P.Z", x, y), (camera.origin() + depth * d).z(), 1e-6);
                EXPECT_EQ(image.at("A", x, y), 1);
                // The normal points out of the body.
                const Vec4 normal = (camera.origin() + out * d - centre) / 1.5;
                if (out < ball) {
                    EXPECT_NEAR(image.at("N.Z", x, y), normal.z(), 1e-6);
                }
            }
        EXPECT_GT(inside, 20);
    }
}

TEST(InsideGlass, EveryRaysOwnStartDecides) {
    // A white furnace looked at along the side of a box of glass, through a lens of which half dips
    // into it, and from a thick slice of which half lies in it: from inside the cube of the index
    // is seen, from outside 1. No ray is trapped: all meet the box's far face at right angles,
    // nearly.
    for (const bool is_lens : {true, false})
        for (const Integrator integrator : kIntegrators) {
            TestScene scene = glass_scene(1.3, integrator);
            scene.settings.width = scene.settings.height = 6;
            scene.settings.samples = 400;
            scene.camera.position = {0, 0, 0, 0}, scene.camera.look_at = {0, -0.1, 0, 0};
            scene.camera.up = Vec4::UnitZ();
            scene.camera.field_of_view = 5;
            if (is_lens)
                scene.camera.aperture = 0.1, scene.camera.focus_distance = 50;
            else
                scene.camera.slice_thickness = 0.2;
            // The surface stands upright across the lens, or across the fourth axis.
            const Vec4 side = is_lens ? Vec4::UnitX() : Vec4::UnitW();
            scene.add(Hyperbox{Vec4::Constant(8)}, 4 * side, {}, 0);
            const Image image = picture_of(scene);
            double sum = 0;
            for (const float r : image.planes.at("R")) sum += r;
            // 14400 samples, stratified within pixels.
            EXPECT_NEAR(sum / 36, 0.5 * (1 + std::pow(1.3, 3)), 0.03) << is_lens;
        }
}

}  // namespace
}  // namespace tesserae::render
