// SPDX-License-Identifier: Apache-2.0
#include "render/tile/centre_layers.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// A rotation twice: as a rotor and, by another route, as the product of plane rotations.
struct Turn {
    Rotor rotor;
    Mat4 matrix = Mat4::Identity();

    /// Then turns by an angle in the plane of axes i and j.
    void add(int i, int j, double angle) {
        static constexpr double Bivector::*kPlanes[4][4] = {
            {nullptr, &Bivector::xy, &Bivector::xz, &Bivector::xw},
            {nullptr, nullptr, &Bivector::yz, &Bivector::yw},
            {nullptr, nullptr, nullptr, &Bivector::zw},
            {}};
        Bivector b;
        b.*kPlanes[i][j] = -0.5 * angle;
        rotor = exp(b) * rotor;
        Mat4 m = Mat4::Identity();
        m(i, i) = m(j, j) = std::cos(angle);
        m(j, i) = std::sin(angle), m(i, j) = -std::sin(angle);
        matrix = m * matrix;
    }
};

void turn_at_random(Random& random, double angle, Turn& turn) {
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) turn.add(i, j, uniform(random, -angle, angle));
}

/// The test's own pinhole: axes by Gram and Schmidt, the right one by the sign of the determinant.
struct Pinhole {
    Vec4 origin;
    Mat4 axes;
    double pixel;

    Pinhole(const CameraDescription& d, int height) : origin(d.position) {
        const Vec4 forward = (d.look_at - d.position).normalized();
        const Vec4 fourth = (d.fourth - d.fourth.dot(forward) * forward).normalized();
        Vec4 up = d.up - d.up.dot(forward) * forward;
        up = (up - up.dot(fourth) * fourth).normalized();
        Vec4 right = Vec4::Zero();
        for (int i = 0; i < 4; ++i) {
            Vec4 axis = Vec4::Unit(i);
            for (const Vec4& a : {forward, fourth, up}) axis -= axis.dot(a) * a;
            if (axis.norm() > right.norm()) right = axis;
        }
        axes << right.normalized(), up, forward, fourth;
        if (axes.determinant() < 0) axes.col(0) *= -1;
        pixel = 2 * std::tan(d.field_of_view * std::numbers::pi / 360) / height;
    }
    /// [pixels; right, up] from the forward axis.
    Vec2 film(const Vec4& offset) const {
        const Vec4 c = axes.transpose() * offset;
        return Vec2(c[0], c[1]) / (c[2] * pixel);
    }
    bool has_before(const Vec4& offset) const {
        return axes.col(2).dot(offset) > 1e-9 * offset.norm();
    }
};

/// Bodies of all shapes that move, turn and swell, before a camera that does, too: one for each of
/// the frames before, at and after.
struct Motion {
    TestScene scene;
    std::vector<std::array<Turn, 3>> turns;
    std::vector<std::array<Vec4, 3>> places;

    Motion(std::uint64_t seed, double body_motion, double camera_motion) {
        Random random(seed);
        scene.camera = random_camera(random, 6);
        const Vec4 middle = scene.camera.look_at;
        for (int i = 0; i < 12; ++i) {
            std::array<Turn, 3> turn;
            turn_at_random(random, 3, turn[1]);
            turn[0] = turn[2] = turn[1];
            const Vec4 place = middle + random_vector(random, 1.3);
            std::array<Vec4, 3> at = {place, place, place};
            for (const int k : {0, 2}) {
                turn_at_random(random, body_motion, turn[static_cast<std::size_t>(k)]);
                at[static_cast<std::size_t>(k)] += random_vector(random, body_motion);
            }
            scene.add(random_shape(random, i % kShapeKinds, 1), place, turn[1].rotor);
            turns.push_back(turn), places.push_back(at);
        }
        const Vec4 normal = (scene.camera.position - middle + 2 * scene.camera.up).normalized();
        scene.add(Hyperplane{normal, normal.dot(middle) - 2}, Vec4::Zero());
        turns.emplace_back(), places.push_back({Vec4::Zero(), Vec4::Zero(), Vec4::Zero()});
        for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) {
            Neighbour other = {scene.bodies, scene.camera};
            for (BodyId id = 0; id < turns.size(); ++id) {
                other.bodies.position[id] = places[id][k];
                other.bodies.rotor[id] = turns[id][k].rotor;
            }
            other.camera.position += random_vector(random, camera_motion);
            other.camera.look_at += random_vector(random, camera_motion);
            other.camera.up += random_vector(random, camera_motion);
            other.camera.fourth += random_vector(random, camera_motion);
            other.camera.field_of_view += 20 * uniform(random, -camera_motion, camera_motion);
            (k == 0 ? scene.last : scene.next) = other;
        }
        scene.settings.width = 44, scene.settings.height = 33;
        scene.settings.samples = 1;
        scene.settings.channels.motion = scene.settings.channels.zplanar = true;
        scene.settings.channels.normal3 = true;
    }
};

/// A pixel's place in a picture of one slice or several, by the rule of the scene format.
struct Place {
    Vec2 film;      ///< of its centre [pixels; right, up] from the cell's forward axis
    double fourth;  ///< of its slice
    bool is_empty;
};
Place place_of(const TestScene& scene, int x, int y, int& cell_height) {
    const int slices = scene.camera.slices;
    const int columns = static_cast<int>(std::ceil(std::sqrt(slices)));
    const int rows = (slices + columns - 1) / columns;
    const int width = scene.settings.width / columns;
    cell_height = scene.settings.height / rows;
    const int slice = y / cell_height * columns + x / width;
    const double part = slices > 1 ? static_cast<double>(slice) / (slices - 1) - 0.5 : 0;
    return {{x % width + 0.5 - 0.5 * width, 0.5 * cell_height - y % cell_height - 0.5},
            part * scene.camera.slice_thickness,
            slice >= slices || x >= columns * width || y >= rows * cell_height};
}

/// How many pixels showed a body that moves, the plane, the sky, and nothing.
struct Counts {
    int bodies = 0, plane = 0, sky = 0, empty = 0, behind = 0;
};

/// Checks all layers of the centre ray against the hit's distance, body and normal.
Counts check_layers(const Motion& m) {
    const TestScene& scene = m.scene;
    const Image image = picture_of(scene);
    Counts counts;
    for (int y = image.y0; y < image.y0 + image.height; ++y)
        for (int x = image.x0; x < image.x0 + image.width; ++x) {
            int height = 0;
            const Place place = place_of(scene, x, y, height);
            const auto at = [&](const char* name) { return double{image.at(name, x, y)}; };
            SCOPED_TRACE(::testing::Message() << x << ", " << y);
            const Pinhole camera(scene.camera, height);
            const Vec3 slant(place.film[0] * camera.pixel, place.film[1] * camera.pixel, 1);
            const Vec4 direction = camera.axes.leftCols<3>() * slant.normalized();
            const std::uint32_t id = place.is_empty ? 0 : image.id(x, y);
            const double distance = at("Z");
            const Vec4 offset = distance * direction + place.fourth * camera.axes.col(3);
            const bool is_plane = id == scene.bodies.size();
            ++(place.is_empty ? counts.empty
               : id == 0      ? counts.sky
               : is_plane     ? counts.plane
                              : counts.bodies);
            for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) {
                const Neighbour& other = k == 0 ? *scene.last : *scene.next;
                const Pinhole seen_by(other.camera, height);
                Vec4 there = direction;
                if (id > 0) {
                    const auto& turn = m.turns[id - 1];
                    const auto& centre = m.places[id - 1];
                    const Vec4 own =
                        turn[1].matrix.transpose() * (camera.origin + offset - centre[1]);
                    there = turn[k].matrix * own + centre[k] - seen_by.origin;
                }
                Vec2 way = seen_by.film(there) - place.film;
                const bool is_behind = !seen_by.has_before(there);
                if (!place.is_empty) counts.behind += is_behind;
                if (place.is_empty || is_behind) way = Vec2::Zero();
                // The hit's distance is a float, 1e-6 m; a pixel is 0.01 m there. What is nearly
                // beside the other camera is magnified: by as much as its vector is long.
                const double off = 1e-3 + 1e-4 * way.norm();
                EXPECT_NEAR(at(k == 0 ? "backward.u" : "forward.u"), way[0], off);
                EXPECT_NEAR(at(k == 0 ? "backward.v" : "forward.v"), way[1], off);
            }
            const Vec4 normal(at("N.X"), at("N.Y"), at("N.Z"), at("N.W"));
            const Vec3 part = (camera.axes.transpose() * normal).head<3>();
            const Vec3 slice(at("Nslice.X"), at("Nslice.Y"), at("Nslice.Z"));
            if (id == 0) {
                EXPECT_EQ(at("Zplanar"), std::numeric_limits<float>::infinity());
                EXPECT_EQ(slice, Vec3(0, 0, 0));
                continue;
            }
            // Roundings of floats.
            EXPECT_NEAR(at("Zplanar"), distance / slant.norm(), 3e-7 * distance);
            EXPECT_LT((slice - part.normalized()).norm(), 1e-6 / part.norm());
        }
    return counts;
}

TEST(CentreLayers, OfBodiesAndCamerasThatMoveAndTurnFollowTheMaterialPoint) {
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        const Counts counts = check_layers(Motion(seed, 0.3, 0.1));
        EXPECT_GT(counts.bodies, 100) << seed;
        EXPECT_GT(counts.sky + counts.plane, 100) << seed;
    }
    EXPECT_GT(check_layers(Motion(5, 0.3, 0)).bodies, 100);
    EXPECT_GT(check_layers(Motion(6, 0, 0.2)).bodies, 100);
}

TEST(CentreLayers, OfASheetAreThoseOfItsCells) {
    for (const int slices : {3, 4, 5}) {
        Motion motion(7, 0.3, 0.1);
        motion.scene.camera.slices = motion.scene.next->camera.slices = slices;
        motion.scene.camera.slice_thickness = 1.5;
        motion.scene.settings.height = 32;
        const Counts counts = check_layers(motion);
        EXPECT_GT(counts.bodies, 100);
        EXPECT_EQ(counts.empty > 0, slices != 4) << slices;
    }
}

TEST(CentreLayers, OfWhatTheOtherCameraHasBehindItAreZero) {
    Motion motion(8, 0.3, 0);
    CameraDescription& camera = motion.scene.next->camera;
    camera.look_at = 2 * camera.position - camera.look_at;
    const Counts counts = check_layers(motion);
    EXPECT_GT(counts.behind, 500);
    // Turned upward by a right angle: about half of it.
    camera = motion.scene.camera;
    const Vec4 view = camera.look_at - camera.position;
    const Vec4 up = camera.up - camera.up.dot(view) / view.squaredNorm() * view;
    camera.look_at = camera.position + up;
    camera.up = -view;
    const int behind = check_layers(motion).behind;
    EXPECT_GT(behind, 100);
    EXPECT_LT(behind, 1300);
}

TEST(CentreLayers, OfWhatStandsStillAreExactlyZero) {
    TestScene scene = Motion(9, 0, 0).scene;
    const Image image = picture_of(scene);
    for (const char* channel : {"forward.u", "forward.v", "backward.u", "backward.v"})
        for (const float v : image.planes.at(channel)) ASSERT_EQ(v, 0) << channel;
    // And of frames without neighbours.
    scene = Motion(9, 0.3, 0.1).scene;
    scene.next.reset();
    const Image alone = picture_of(scene);
    for (const float v : alone.planes.at("forward.u")) ASSERT_EQ(v, 0);
    EXPECT_NE(alone.planes.at("backward.u"), image.planes.at("backward.u"));
}

TEST(CentreLayers, DependOnNeitherSamplesNorShutterNorLens) {
    TestScene scene = Motion(10, 0.2, 0.1).scene;
    const Image one = picture_of(scene);
    scene.settings.samples = 5;
    scene.camera.aperture = scene.next->camera.aperture = 0.1;
    scene.camera.shutter = 0.5;
    scene.closing = scene.next->bodies;
    const Image many = picture_of(scene);
    for (const char* channel : {"forward.u", "forward.v", "backward.u", "backward.v", "Zplanar",
                                "Nslice.X", "Nslice.Y", "Nslice.Z"})
        EXPECT_EQ(one.planes.at(channel), many.planes.at(channel)) << channel;
}

TEST(CentreLayers, OfASurfaceParallelToTheSliceHaveNoNormalInIt) {
    for (const double tilt : {0.0, 1e-10, 1e-6, 1e-3}) {
        TestScene scene;
        scene.camera.position = {0, 0, -4, 0};
        scene.settings.width = scene.settings.height = 4;
        scene.settings.samples = 1;
        scene.settings.channels.normal3 = true;
        // The slice w = 0 is just inside, and view rays begin there: a surface at distance 0.
        const Vec4 normal = Vec4(tilt, 0, 0, std::sqrt(1 - tilt * tilt));
        scene.add(Hyperplane{normal, 1}, Vec4::Zero());
        const Image image = picture_of(scene);
        ASSERT_EQ(image.id(1, 1), 1u);
        EXPECT_EQ(image.at("Nslice.X", 1, 1), tilt > 1e-8 ? 1 : 0) << tilt;
        EXPECT_EQ(image.at("Nslice.Z", 1, 1), 0);
    }
}

}  // namespace
}  // namespace tesserae::render
