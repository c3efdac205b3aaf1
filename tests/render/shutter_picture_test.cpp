// SPDX-License-Identifier: Apache-2.0
// An open shutter held against many pictures of closed ones, and against what can be worked out by
// hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/camera/camera.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

TEST(Shutter, AFastBodyLeavesAnEvenTrace) {
    // A ball of a pixel's size flies over 6000 pixels, of which the film shows 33: at fewer
    // times than that it would be seen in places only.
    TestScene scene;
    scene.camera.position = Vec4::Zero(), scene.camera.look_at = Vec4::UnitZ();
    scene.camera.field_of_view = 2;
    scene.settings.width = scene.settings.height = 33;
    scene.settings.samples = 1 << 16;
    scene.settings.crop = Crop{0, 16, 33, 17};
    scene.settings.channels = {true, false, false, false, false};
    const double pixel = 2 * std::tan(std::numbers::pi / 180) / 33;
    scene.add(Hypersphere{pixel}, {-3000 * pixel, 0, 1, 0});
    scene.closing = scene.bodies;
    scene.closing->position[0].x() = 3000 * pixel;
    const Image image = picture_of(scene);
    // The mean chord of the ball over the pixel's width, in parts of the way.
    const double chord = 0.5 * (std::sqrt(0.75) + 2 * std::numbers::pi / 6) * 2 / 6000;
    const double deviation = std::sqrt(chord / scene.settings.samples);
    for (int x = 0; x < 33; ++x) EXPECT_NEAR(image.at("A", x, 16), chord, 5 * deviation) << x;
}

/// Bodies of all shapes and materials that move, turn, and wait for a while, in two parts.
TestScene busy_shutter(Integrator integrator) {
    Random random(77);
    TestScene scene;
    scene.settings.width = 12, scene.settings.height = 9;
    scene.settings.integrator = integrator;
    scene.settings.channels.variance = true;
    scene.materials.resize(5);
    scene.materials[1].kind = MaterialKind::kMirror;
    scene.materials[2].kind = MaterialKind::kGlass;
    scene.materials[3].kind = MaterialKind::kRough;
    scene.materials[4].pattern = Pattern::kChecker;
    scene.materials[4].emission = {0.5, 0.2, 0};
    for (int i = 0; i < 30; ++i)
        scene.add(random_shape(random, i % kShapeKinds, 0.7), random_vector(random, 1.5),
                  random_rotor(random), static_cast<std::uint32_t>(i % 5));
    scene.add(Hyperplane{Vec4::UnitY(), -2}, Vec4::Zero(), {}, 0);
    Sun sun;
    sun.direction = Vec4(0.3, -1, 0.4, 0.1).normalized();
    sun.angle = 3;
    scene.lights.suns = {sun};
    scene.lights.spheres = {{Vec4(-2, 2, 0, -0.3), 0.4, Color(3, 4, 5)}};
    scene.lights.sky = {0.2, 0.25, 0.3};
    scene.camera.position = {0, 0.5, -4, 0};
    Bodies bodies = scene.bodies;
    for (const double time : {0.4, 1.0}) {
        for (BodyId id = 0; id + 1 < bodies.size(); ++id) {
            if (id % 5 == 1 && time < 1) continue;
            bodies.position[id] += random_vector(random, 0.6);
            bodies.rotor[id] = random_rotor(random);
            bodies.angular_velocity[id] = {.xy = 3, .yz = -2, .zw = 4};
        }
        scene.path.push_back({time, bodies, scene.camera});
    }
    return scene;
}

/// Without a rough material, which each picture makes a table for: that is most of its time.
TestScene smooth_shutter() {
    TestScene scene = busy_shutter(Integrator::kDirect);
    scene.materials[3] = {};
    return scene;
}

/// The scene as it is at a time, and its random numbers those of another frame.
TestScene still_at(const TestScene& scene, double time, int frame) {
    TestScene still = scene;
    still.path.clear();
    still.frame = frame;
    const bool is_first = time < scene.path[0].time;
    const Bodies& before = is_first ? scene.bodies : scene.path[0].bodies;
    const Bodies& after = scene.path[is_first ? 0 : 1].bodies;
    const double begin = is_first ? 0 : scene.path[0].time;
    const double length = scene.path[is_first ? 0 : 1].time - begin;
    const double part = (time - begin) / length;
    for (BodyId id = 0; id < scene.bodies.size(); ++id) {
        still.bodies.position[id] = (1 - part) * before.position[id] + part * after.position[id];
        if (const auto turn = turning(before, after, length, id))
            still.bodies.rotor[id] = turn->at(part);
        else
            still.bodies.rotor[id] = before.rotor[id];
    }
    // What the cameras of these tests do: everything evenly, between unit axes at right angles.
    const CameraDescription &a = is_first ? scene.camera : scene.path[0].camera,
                            &b = scene.path[is_first ? 0 : 1].camera;
    still.camera.position = (1 - part) * a.position + part * b.position;
    still.camera.look_at = (1 - part) * a.look_at + part * b.look_at;
    still.camera.fourth = (1 - part) * a.fourth + part * b.fourth;
    return still;
}

/// Holds the picture of an open shutter against the mean of stills at random times, one in each of
/// so many equal parts, pixel by pixel.
void expect_mean_of_stills(TestScene scene, const char* what, int stills = 64) {
    SCOPED_TRACE(what);
    scene.settings.samples = 2 * stills;
    const Image blurred = picture_of(scene);
    Random random(5);
    const int samples = scene.settings.samples;
    scene.settings.samples = 2;
    std::map<std::string, std::vector<double>> sums, squares;
    for (int k = 0; k < stills; ++k) {
        const Image still =
            picture_of(still_at(scene, (k + uniform(random, 0, 1)) / stills, 1000 + k));
        for (const char* channel : {"R", "G", "B", "A"}) {
            const std::vector<float>& plane = still.planes.at(channel);
            sums[channel].resize(plane.size()), squares[channel].resize(plane.size());
            for (std::size_t i = 0; i < plane.size(); ++i) {
                sums[channel][i] += plane[i] / static_cast<float>(stills);
                squares[channel][i] += static_cast<double>(plane[i]) * plane[i] / stills;
            }
        }
    }
    // Both variances are those of independent samples: more than those of stratified ones.
    double mean = 0, of_mean = 0, deviations = 0;
    int count = 0, most = 0;
    for (const char* channel : {"R", "G", "B", "A"})
        for (std::size_t i = 0; i < sums[channel].size(); ++i) {
            const double m = sums[channel][i];
            const double own = std::max(0.0, squares[channel][i] - m * m) / (stills - 1);
            const double value = blurred.planes.at(channel)[i];
            const double its = *channel == 'A'
                                   ? value * (1 - value) / samples
                                   : blurred.planes.at(std::string("variance.") + channel)[i];
            const double variance = own + its + 1e-6 + 1e-6 * m * m;  // and halves' rounding
            const double off = value - m;
            mean += off, of_mean += variance;
            deviations += off * off / variance, ++count;
            most += std::abs(off) > 4 * std::sqrt(variance);
        }
    EXPECT_LT(std::abs(mean), 4 * std::sqrt(of_mean));
    EXPECT_LT(deviations / count, 1.1);
    EXPECT_LE(most, count / 200);
}

TEST(Shutter, IsTheMeanOfItsMomentsDirect) {
    expect_mean_of_stills(busy_shutter(Integrator::kDirect), "direct", 40);
}

TEST(Shutter, IsTheMeanOfItsMomentsPath) {
    expect_mean_of_stills(busy_shutter(Integrator::kPath), "path", 40);
}

TEST(ShutterSlow, IsTheMeanOfItsMoments) {
    for (const Integrator integrator : {Integrator::kDirect, Integrator::kPath})
        expect_mean_of_stills(busy_shutter(integrator), "more stills", 64);
}

TEST(Shutter, IsTheMeanOfItsMomentsInClosedForm) {
    TestScene scene = smooth_shutter();
    scene.settings.intersector = Intersector::kAnalytic;
    expect_mean_of_stills(scene, "analytic");
}

void expect_mean_with_a_moving_camera(int stills) {
    TestScene scene = busy_shutter(Integrator::kDirect);
    scene.path[0].camera.position += Vec4(0.4, 0.1, 0.2, 0.3);
    scene.path[1].camera.position += Vec4(-0.3, 0.2, 0.1, -0.2);
    scene.path[1].camera.look_at += Vec4(0.2, 0, 0.1, 0.1);
    expect_mean_of_stills(scene, "moves", stills);
    // Nothing but the camera moves, and its slice turns.
    for (ShutterMoment& moment : scene.path) moment.bodies = scene.bodies;
    scene.path[1].camera.fourth = Vec4(0.6, 0, 0, 0.8);
    scene.path[0].camera.fourth = scene.camera.fourth;
    scene.camera.aperture = 0.05;
    for (ShutterMoment& moment : scene.path) moment.camera.aperture = 0.05;
    TestScene turning_slice = scene;
    turning_slice.materials = smooth_shutter().materials;
    // Between two directions of unit length the way is straight, as between() takes it.
    expect_mean_of_stills(turning_slice, "turns", stills);
}

TEST(Shutter, IsTheMeanOfItsMomentsWithAMovingCamera) { expect_mean_with_a_moving_camera(40); }
TEST(ShutterSlow, IsTheMeanOfItsMomentsWithAMovingCamera) { expect_mean_with_a_moving_camera(64); }

TEST(Shutter, IsTheMeanOfItsMomentsInsideMovingGlass) {
    TestScene scene = smooth_shutter();
    // The camera is in the first ball, and later not; the second one reaches into it.
    scene.add(Hypersphere{0.8}, scene.camera.position + Vec4(0.1, 0.2, 0.3, 0.1), {}, 2);
    scene.add(Hypersphere{0.6}, scene.camera.position + Vec4(0.2, -0.1, 0.9, 0), {}, 2);
    for (ShutterMoment& moment : scene.path) {
        moment.bodies = scene.bodies;
        for (BodyId id = 31; id < 33; ++id)
            moment.bodies.position[id] += moment.time * Vec4(0.3, 1.5, 0, 0);
    }
    expect_mean_of_stills(scene, "in glass");
}

}  // namespace
}  // namespace tesserae::render
