// SPDX-License-Identifier: Apache-2.0
// Noise: that it differs from frame to frame, and what it is.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// A floor and a ball under a lamp, path traced: 48 x 36 pixels, all of them noisy.
TestScene noisy_scene() {
    TestScene scene;
    scene.materials[0].albedo = Color::Constant(0.6);
    scene.add(Hyperplane{Vec4::UnitY(), 0}, Vec4::Zero());
    scene.add(Hypersphere{0.7}, {0.3, 0.7, 0, 0.2});
    scene.lights.spheres.push_back({{2, 6, -3, 0.3}, 0.8, Color::Constant(60)});
    scene.lights.sky = Color::Constant(0.3);
    scene.camera.position = {0, 4, -4, 0};
    scene.settings.width = 48, scene.settings.height = 36;
    scene.settings.samples = 4;
    scene.settings.integrator = Integrator::kPath;
    scene.settings.intersector = Intersector::kAnalytic;
    return scene;
}

std::vector<double> greens_of(const TestScene& scene) {
    const Image image = picture_of(scene);
    const auto& plane = image.planes.at("G");
    return {plane.begin(), plane.end()};
}

std::vector<double> minus(std::vector<double> a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
    return a;
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// Of what has mean 0.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    return product(a, b) / std::sqrt(product(a, a) * product(b, b));
}

TEST(Noise, OfFramesAndSeedsIsIndependentAndAsLarge) {
    TestScene scene = noisy_scene();
    scene.settings.samples = 1024;
    const std::vector<double> converged = greens_of(scene);
    scene.settings.samples = 4;
    // Errors of frames 0 to 3 with seed 0, and with seed 1.
    std::vector<std::vector<double>> errors;
    for (const std::uint64_t seed : {0, 1})
        for (int frame = 0; frame < 4; ++frame) {
            scene.settings.seed = seed, scene.frame = frame;
            errors.push_back(minus(greens_of(scene), converged));
        }
    // Of 1728 independent pairs the correlation has deviation 1/sqrt(1728) = 0.024, with the
    // unequal variances of the pixels twice that; the converged picture's own error adds 4/1024.
    for (std::size_t i = 0; i < errors.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_NEAR(correlation(errors[i], errors[j]), 0, 5 * 0.048) << i << " " << j;
    // A variance of so many pixels is known to some 5 %.
    for (const auto& error : errors)
        EXPECT_NEAR(product(error, error) / product(errors[0], errors[0]), 1, 0.25);
}

TEST(Noise, StandsStillWhereItIsLocked) {
    TestScene scene = noisy_scene();
    const std::vector<double> first = greens_of(scene);
    scene.frame = 7;
    const std::vector<double> moved = greens_of(scene);
    scene.settings.lock_noise = true;
    EXPECT_EQ(greens_of(scene), first);
    EXPECT_NE(moved, first);
    // Not that of seed 0.
    scene.settings.seed = 3;
    const std::vector<double> other = greens_of(scene);
    EXPECT_NE(other, first);
    scene.frame = 0;
    EXPECT_EQ(greens_of(scene), other);
}

TEST(Noise, OfAFrameDoesNotDependOnTilesAndCrop) {
    TestScene scene = noisy_scene();
    scene.frame = 11, scene.settings.seed = 5;
    const Image whole = picture_of(scene);
    scene.settings.tile = 8;
    scene.settings.crop = Crop{7, 9, 40, 31};
    const Image part = picture_of(scene);
    for (int y = 9; y < 31; ++y)
        for (int x = 7; x < 40; ++x) ASSERT_EQ(part.at("G", x, y), whole.at("G", x, y));
}

/// A glowing ball above a floor, path traced with one bounce: the camera sees a spot of the floor
/// right below it, where the closed form holds: albedo L sin^3, with the sine of the ball's rim. It
/// stands in glass that bends nothing, so that paths find it by chance only.
struct GlowingBall {
    static constexpr double kAlbedo = 0.8, kGlow = 8, kRadius = 1;
    TestScene scene;
    double exact;

    explicit GlowingBall(double distance)
        : exact(kAlbedo * kGlow * std::pow(kRadius / distance, 3)) {
        scene.materials.resize(3);
        scene.materials[0].albedo = Color::Constant(kAlbedo);
        scene.materials[2].kind = MaterialKind::kGlass;
        scene.materials[2].ior = 1;
        scene.materials[2].albedo = Color::Ones();
        scene.materials[1].albedo = Color::Zero();
        scene.materials[1].emission = Color::Constant(kGlow);
        scene.add(Hyperplane{Vec4::UnitY(), 0}, Vec4::Zero());
        scene.add(Hypersphere{kRadius}, {0, distance, 0, 0}, {}, 1);
        scene.add(Hypersphere{1.1 * kRadius}, {0, distance, 0, 0}, {}, 2);
        scene.camera.position = {0, 0.5, -4, 0};
        scene.camera.field_of_view = 0.03;
        scene.settings.integrator = Integrator::kPath;
        scene.settings.intersector = Intersector::kAnalytic;
        scene.settings.bounces = 1;
        scene.settings.samples = 16;
        scene.settings.noise_target = 0.02, scene.settings.max_samples = 32;
        scene.settings.channels.samples = true;
    }
    /// Mean of the picture over the exact value, less 1, within 4 deviations.
    void expect_exact(int width, int height, double most_sigma) {
        scene.settings.width = width, scene.settings.height = height;
        const Image image = picture_of(scene);
        double sum = 0, squares = 0, samples = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const double off = image.at("G", x, y) / exact - 1;
                sum += off, squares += off * off, samples += image.at("samples", x, y);
            }
        const double count = width * height, sigma = std::sqrt(squares) / count;
        EXPECT_LT(sigma, most_sigma);
        EXPECT_NEAR(sum / count, 0, 4 * sigma);
        // Some pixels stop, some go on.
        EXPECT_GT(samples / count, 17);
        EXPECT_LT(samples / count, 31.9);
    }
};

TEST(NoiseTarget, AFoundLightIsAsBrightAsItIs) { GlowingBall(2.6).expect_exact(96, 72, 0.02); }

TEST(NoiseTargetSlow, AFoundLightIsAsBrightAsItIsToHalfAPercent) {
    GlowingBall(2.4).expect_exact(480, 360, 0.005 / 4);
}

}  // namespace
}  // namespace tesserae::render
