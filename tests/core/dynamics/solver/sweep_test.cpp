// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

// What `iterations` and `tolerance` promise of every solve.
namespace tesserae {
namespace {

using namespace testing;

/// Bodies of three shapes and of unequal masses that fall onto a floor and each other.
Bodies random_heap(std::mt19937_64& random, bool friction) {
    Bodies bodies;
    const double rough = friction ? uniform(random, 0.1, 1) : 0;
    add(bodies, plane_type(Vec4::UnitY(), 0, rough, uniform(random, 0, 0.9)));
    const int count = 2 + static_cast<int>(random() % 8);
    for (int i = 0; i < count; ++i) {
        const double size = uniform(random, 0.2, 1), mass = uniform(random, 0.1, 30);
        const std::array<BodyType, 3> types = {sphere_type(size / 2, mass),
                                               box_type(Vec4::Constant(size), mass),
                                               capsule_type(size / 4, size / 2, mass)};
        BodyType type = types[random() % types.size()];
        type.friction = rough, type.restitution = uniform(random, 0, 0.9);
        const Vec4 aside = random_vector(random, 0.3);
        add(bodies, type, {aside.x(), 0.6 + 0.8 * i, aside.z(), aside.w()});
    }
    return bodies;
}

PhysicsSettings settings_with(int iterations, double tolerance) {
    PhysicsSettings settings;
    settings.iterations = iterations, settings.tolerance = tolerance;
    return settings;
}

TEST(Iterations, AreTheMostSweepsOfAnySolve) {
    std::mt19937_64 random(71);
    constexpr std::array<int, 9> kIterations = {1, 2, 3, 7, 10, 29, 64, 100, 150};
    int most_in_use = 0;
    for (int round = 0; round < 90; ++round) {
        const int iterations = kIterations[static_cast<std::size_t>(round) % kIterations.size()];
        Stepper world(make_simulation(random_heap(random, true), settings_with(iterations, 1e-6)),
                      kAllWays[random() % std::size(kAllWays)]);
        std::uint64_t most = 0;
        for (int i = 0; i < 240; ++i) most = std::max(most, world.step(kStep).sweeps);
        EXPECT_LE(most, static_cast<std::uint64_t>(iterations)) << "round " << round;
        most_in_use += most == static_cast<std::uint64_t>(iterations);
    }
    EXPECT_GT(most_in_use, 45) << "most scenes need so many at some time";
}

/// Without friction, as sweeps may lead away where friction jams, and then end.
TEST(Iterations, AreAllTakenWithTheToleranceZero) {
    std::mt19937_64 random(72);
    constexpr std::array<int, 6> kIterations = {1, 2, 7, 10, 33, 100};
    int steps = 0;
    for (int round = 0; round < 60; ++round) {
        const int iterations = kIterations[static_cast<std::size_t>(round) % kIterations.size()];
        Stepper world(make_simulation(random_heap(random, false), settings_with(iterations, 0)),
                      kAllWays[random() % std::size(kAllWays)]);
        for (int i = 0; i < 240; ++i) {
            const StepReport report = world.step(kStep);
            if (report.contacts == 0) continue;
            ASSERT_EQ(report.sweeps, static_cast<std::uint64_t>(iterations)) << "round " << round;
            ++steps;
        }
    }
    EXPECT_GT(steps, 3000);
}

TEST(Iterations, OfAStepWithoutContactsAreNone) {
    Bodies bodies;
    add(bodies, sphere_type(1));
    Stepper world(bodies, PhysicsSettings{});
    EXPECT_EQ(world.step(kStep).sweeps, 0u);
}

/// Returns how deep a box under a heavy one is pressed in two seconds, in its size.
double pressed(double size, double ratio, double gap, const PhysicsSettings& settings) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (int i = 0; i < 2; ++i) {
        BodyType type = box_type(Vec4::Constant(size), i == 0 ? 1 : ratio);
        type.friction = 0.5;
        add(bodies, type, {0, (0.5 + i) * size + (i + 1) * gap, 0, 0});
    }
    Stepper world(bodies, settings);
    double deepest = 0;
    for (int i = 0; i < 480; ++i) deepest = std::max(deepest, world.step(kStep).penetration);
    return deepest / size;
}

TEST(Tolerance, OfZeroPressesNoLightBoxDeeper) {
    std::mt19937_64 random(73);
    for (int round = 0; round < 24; ++round) {
        const double size = std::pow(10, uniform(random, -2, 0));
        const double ratio = std::pow(10, uniform(random, 0, 2.6));
        const double gap = round % 2 == 0 ? 0 : size * uniform(random, 0, 1e-3);
        const double usual = pressed(size, ratio, gap, {});
        const double all =
            pressed(size, ratio, gap, settings_with(PhysicsSettings{}.iterations, 0));
        EXPECT_LT(all, usual + 1e-4) << size << " m, " << ratio << " masses";
        EXPECT_LT(usual, 1e-3) << size << " m, " << ratio << " masses";
    }
}

/// A heap that falls needs more than ten.
TEST(Iterations, MoreOfThemMoveDifferently) {
    const auto end_of = [](int iterations) {
        std::mt19937_64 random(74);
        Stepper world(random_heap(random, true), settings_with(iterations, 1e-6));
        run(world, 240);
        return world.bodies();
    };
    EXPECT_FALSE(same_bits(end_of(10), end_of(20)));
}

}  // namespace
}  // namespace tesserae
