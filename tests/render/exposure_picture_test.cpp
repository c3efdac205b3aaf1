// SPDX-License-Identifier: Apache-2.0
// Pictures through a lens, of a thick slice, of several slices and with an open shutter, held
// against what can be worked out by hand; and the noise target.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/camera/camera.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// A camera at the origin that looks along z, a film of 33 x 33 pixels.
TestScene looking_along_z() {
    TestScene scene;
    scene.camera.position = Vec4::Zero();
    scene.camera.look_at = {0, 0, 1, 0};
    scene.camera.field_of_view = 10;
    scene.settings.width = scene.settings.height = 33;
    scene.settings.samples = 1024;
    return scene;
}

/// Three standard deviations of a mean of 1024 independent zeros and ones, at worst; stratified
/// ones are closer.
constexpr double kThreeSigma = 3 * 0.5 / 32;

TEST(Exposure, AThickSliceShowsTheShareOfItThatABodyFills) {
    TestScene scene = looking_along_z();
    scene.add(Hypersphere{0.4}, {0, 0, 5, 0.1});
    scene.camera.slice_thickness = 2;
    // The ray through the middle meets the sphere in the slices from -0.3 to 0.5.
    EXPECT_NEAR(picture_of(scene).at("A", 16, 16), 0.4, kThreeSigma);
    // A slice that the sphere fills along the ray.
    scene.camera.slice_thickness = 0.5;
    EXPECT_EQ(picture_of(scene).at("A", 16, 16), 1);
}

TEST(Exposure, ALensSpreadsWhatIsOutOfFocus) {
    TestScene scene = looking_along_z();
    scene.add(Hypersphere{0.02}, {0, 0, 5, 0});
    scene.camera.aperture = 0.1;
    scene.camera.focus_distance = 5;
    EXPECT_EQ(picture_of(scene).at("A", 16, 16), 1);
    // Through the middle of the film all rays meet at distance 10: halfway they are spread over a
    // disc of half the lens's radius, of which the ball covers a part. The pixel's own width at
    // that distance, 0.013 m, blurs the ball's rim, not its area.
    scene.camera.focus_distance = 10;
    EXPECT_NEAR(picture_of(scene).at("A", 16, 16), std::pow(0.02 / 0.05, 2), kThreeSigma);
}

TEST(Exposure, AnOpenShutterShowsForHowLongABodyIsThere) {
    TestScene scene = looking_along_z();
    scene.add(Hypersphere{0.1}, {-0.3, 0, 5, 0});
    scene.camera.shutter = 0.5;
    scene.closing = scene.bodies;
    scene.closing->position[0].x() = 0.5;
    // 0.2 of the way of 0.8 the ball is before the middle; the pixel is a tenth of the ball wide.
    EXPECT_NEAR(picture_of(scene).at("A", 16, 16), 0.25, kThreeSigma);
    // What the centre's ray alone says is as of the opening.
    EXPECT_EQ(picture_of(scene).id(16, 16), 0u);
}

TEST(Exposure, ABodyThatTurnsIsBlurredAndAtItsAxisStill) {
    TestScene scene = looking_along_z();
    scene.materials[0].albedo = Color::Ones();
    scene.materials[0].pattern = Pattern::kStripes;
    scene.materials[0].pattern_albedo = Color::Zero();
    scene.materials[0].pattern_size = 0.2;
    scene.add(Hypersphere{0.35}, {0, 0, 5, 0});
    scene.closing = scene.bodies;
    // About the line of sight, by nearly half a turn: every point off the axis sees both colours.
    scene.closing->rotor[0] = exp(Bivector{0.45 * std::numbers::pi, 0, 0, 0, 0, 0});
    scene.camera.shutter = 1;
    const Image turning = picture_of(scene);
    EXPECT_NEAR(turning.at("albedo.R", 16, 16), 1, 1e-3);
    double least = 1, greatest = 0;
    for (int x = 8; x < 25; ++x) {
        least = std::min(least, static_cast<double>(turning.at("albedo.R", x, 11)));
        greatest = std::max(greatest, static_cast<double>(turning.at("albedo.R", x, 11)));
    }
    EXPECT_GT(least, 0.05);
    EXPECT_LT(greatest, 0.95);
}

/// How much of the time a body covers a pixel.
double coverage(const TestScene& scene, int x, int y) { return picture_of(scene).at("A", x, y); }

TEST(Exposure, ABodyTurnsAsFarAsItsAngularVelocitySays) {
    // A bar turns by three quarters: its two ends pass every point of their circle. The shortest
    // way, a quarter back, would leave out half of them.
    TestScene scene = looking_along_z();
    scene.add(Hypercapsule{0.03, 0.6}, {0, 0, 5, 0});
    scene.camera.shutter = 1;
    for (const double turn : {1.5 * std::numbers::pi, -1.5 * std::numbers::pi}) {
        const Bivector omega{turn, 0, 0, 0, 0, 0};
        scene.bodies.angular_velocity[0] = omega;
        scene.closing = scene.bodies;
        scene.closing->rotor[0] = exp(-0.5 * omega);
        const Image image = picture_of(scene);
        int seen = 0;
        for (int i = 0; i < 64; ++i) {
            const double angle = 2 * std::numbers::pi * (i + 0.5) / 64;
            const int x = 16 + static_cast<int>(std::lround(8 * std::cos(angle)));
            const int y = 16 + static_cast<int>(std::lround(8 * std::sin(angle)));
            seen += image.at("A", x, y) > 0;
        }
        EXPECT_EQ(seen, 64) << turn;
    }
}

TEST(Exposure, ABounceInsideTheShutterIsSeen) {
    // Down and up again: at the opening and the closing the ball is in the same place.
    TestScene scene = looking_along_z();
    scene.add(Hypersphere{0.1}, {0, 0.2, 5, 0});
    scene.camera.shutter = 1;
    Bodies low = scene.bodies;
    low.position[0].y() = -0.2;
    scene.path = {{0.5, low, scene.camera}, {1, scene.bodies, scene.camera}};
    // Twice through the middle, 0.2 of each way of 0.4 / 0.2 balls: half of the time.
    EXPECT_NEAR(coverage(scene, 16, 16), 0.5, kThreeSigma);
    scene.path.clear();
    EXPECT_EQ(coverage(scene, 16, 16), 0);
}

TEST(Exposure, MomentsDivideTheTimeAsTheySay) {
    // A tenth of the time on the left, then on the right.
    TestScene scene = looking_along_z();
    scene.add(Hypersphere{0.1}, {-0.25, 0, 5, 0});
    scene.camera.shutter = 1;
    Bodies right = scene.bodies;
    right.position[0].x() = 0.25;
    scene.path = {{0.1, scene.bodies, scene.camera},
                  {0.1 + 1e-9, right, scene.camera},
                  {1, right, scene.camera}};
    const double pixel = 5 * 2 * std::tan(5 * std::numbers::pi / 180) / 33;
    const int off = static_cast<int>(std::lround(0.25 / pixel));
    EXPECT_NEAR(coverage(scene, 16 - off, 16), 0.1, kThreeSigma);
    EXPECT_NEAR(coverage(scene, 16 + off, 16), 0.9, kThreeSigma);
    EXPECT_EQ(coverage(scene, 16, 16), 0);
}

TEST(Exposure, WhatStandsStillLooksTheSameWithAnOpenShutter) {
    Random random(7);
    TestScene scene = looking_along_z();
    scene.settings.samples = 4;
    for (int i = 0; i < 12; ++i)
        scene.add(random_shape(random, i % kShapeKinds, 0.3),
                  Vec4(0, 0, 5, 0) + random_vector(random, 0.5), random_rotor(random));
    const Folder folder;
    render(scene, folder / "closed.exr");
    scene.closing = scene.bodies;
    render(scene, folder / "open.exr");
    EXPECT_EQ(content(folder / "closed.exr"), content(folder / "open.exr"));
}

TEST(SliceSheet, EveryCellIsTheFrameOfACameraMovedAlongTheFourthAxis) {
    Random random(8);
    TestScene scene;
    scene.camera = random_camera(random, 6);
    scene.settings.samples = 1;
    for (int i = 0; i < 20; ++i)
        scene.add(random_shape(random, i % 3, 0.6), scene.camera.look_at + random_vector(random, 1),
                  random_rotor(random));
    scene.lights.suns.push_back({});
    TestScene one = scene;
    scene.camera.slices = 3;
    scene.camera.slice_thickness = 1.5;
    scene.settings.width = 81, scene.settings.height = 61;  // cells of 40 x 30
    const Image sheet = picture_of(scene);
    one.settings.width = 40, one.settings.height = 30;
    const Vec4 fourth = Camera(one.camera, 40, 30).fourth();
    int hits = 0;
    for (int k = 0; k < 3; ++k) {
        TestScene moved = one;
        moved.camera.position += (k - 1) * 0.75 * fourth;
        moved.camera.look_at += (k - 1) * 0.75 * fourth;
        const Image frame = picture_of(moved);
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x) {
                const int sx = x + (k % 2) * 40, sy = y + (k / 2) * 30;
                EXPECT_EQ(frame.id(x, y), sheet.id(sx, sy)) << k << " " << x << " " << y;
                if (frame.id(x, y) == 0) continue;
                ++hits;
                EXPECT_NEAR(frame.at("Z", x, y), sheet.at("Z", sx, sy), 1e-5);
                EXPECT_NEAR(frame.at("R", x, y), sheet.at("R", sx, sy), 2e-3);
            }
    }
    EXPECT_GT(hits, 300);
    // What is left over shows nothing.
    EXPECT_EQ(sheet.at("A", 80, 60), 0);
    EXPECT_EQ(sheet.at("R", 60, 45), 0);
}

/// All of it at once, and a shadow's edge for the noise target to work on.
TestScene everything() {
    Random random(9);
    TestScene scene;
    scene.camera = random_camera(random, 6);
    scene.camera.aperture = 0.05;
    scene.camera.slice_thickness = 0.2;
    scene.camera.shutter = 0.5;
    for (int i = 0; i < 20; ++i)
        scene.add(random_shape(random, i % 3, 0.6), scene.camera.look_at + random_vector(random, 1),
                  random_rotor(random));
    scene.closing = scene.bodies;
    for (Vec4& position : scene.closing->position) position += random_vector(random, 0.1);
    // Bright bodies before a dark sky: their edges are noisy.
    Sun sun;
    sun.direction = (scene.camera.look_at - scene.camera.position).normalized();
    sun.irradiance = Color::Constant(6);
    scene.lights.suns.push_back(sun);
    scene.lights.sky = Color::Constant(0.01);
    scene.settings.width = 48, scene.settings.height = 36;
    scene.settings.samples = 8;
    scene.settings.max_samples = 64;
    scene.settings.noise_target = 0.004;
    scene.settings.filter = FilterKind::kGaussian;
    scene.settings.filter_width = 2.5;
    scene.settings.tile = 16;
    Channels& channels = scene.settings.channels;
    channels.variance = channels.samples = true;
    channels.motion = channels.zplanar = channels.normal3 = channels.light = true;
    scene.next = {*scene.closing, random_camera(random, 6)};
    scene.last = {scene.bodies, random_camera(random, 6)};
    scene.add_mattes();
    return scene;
}

TEST(Exposure, BytesDoNotDependOnThreads) {
    const TestScene scene = everything();
    const Folder folder;
    render(scene, folder / "1.exr", folder / "1.png", 1);
    for (const int threads : {2, 3, 8}) {
        render(scene, folder / "n.exr", folder / "n.png", threads);
        EXPECT_EQ(content(folder / "1.exr"), content(folder / "n.exr")) << threads;
        EXPECT_EQ(content(folder / "1.png"), content(folder / "n.png")) << threads;
    }
}

TEST(Exposure, PixelsDoNotDependOnTilesOrCrop) {
    TestScene scene = everything();
    const Image whole = picture_of(scene);
    scene.settings.tile = 8;
    scene.settings.crop = Crop{5, 3, 31, 29};
    const Image part = picture_of(scene);
    for (const auto& [channel, plane] : part.planes)
        for (int y = 3; y < 29; ++y)
            for (int x = 5; x < 31; ++x)
                ASSERT_EQ(part.at(channel, x, y), whole.at(channel, x, y))
                    << channel << " " << x << " " << y;
}

TEST(NoiseTarget, PixelsGetSamplesWhereTheyAreNoisy) {
    const TestScene scene = everything();
    const Image image = picture_of(scene);
    int least = 0, most = 0;
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 48; ++x) {
            const auto samples = static_cast<int>(image.at("samples", x, y));
            ASSERT_GE(samples, 8);
            ASSERT_LE(samples, 64);
            least += samples == 8, most += samples == 64;
            // Flat pixels get no more.
            if (image.at("variance.R", x, y) == 0 && image.at("variance.G", x, y) == 0 &&
                image.at("variance.B", x, y) == 0) {
                EXPECT_EQ(samples, 8);
            }
        }
    EXPECT_GT(least, 100);
    EXPECT_GT(most, 20);
}

TEST(NoiseTarget, TheErrorIsWhatItAsksFor) {
    constexpr double kTarget = 0.04;
    TestScene scene = everything();
    scene.settings.noise_target = kTarget;
    scene.settings.samples = 16;
    scene.settings.max_samples = 1024;
    const Image image = picture_of(scene);
    scene.settings.noise_target = 0;
    scene.settings.samples = 2048;
    const Image converged = picture_of(scene);
    double squares = 0;
    int count = 0, outside = 0;
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 48; ++x) {
            // Grey light: all channels are the luminance.
            const double off = std::sqrt(image.at("G", x, y)) - std::sqrt(converged.at("G", x, y));
            squares += off * off, ++count;
            outside += std::abs(off) > 4 * kTarget;
        }
    // The target is a bound of every pixel's standard error as if samples were independent. Many
    // pixels need few samples, so that the mean is 0.34 of it; for twice the target it is 0.43.
    EXPECT_LT(std::sqrt(squares / count), 0.4 * kTarget);
    EXPECT_LT(outside, count / 100);
}

}  // namespace
}  // namespace tesserae::render
