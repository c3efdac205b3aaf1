// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/dynamics/stepper.hpp"
#include "parallel/parallel_stepper.hpp"
#include "parallel/threads.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/parallel/first_difference.hpp"

namespace tesserae::parallel {
namespace {

using namespace tesserae::testing;

/// A net of balls, each joined to its neighbours by points between them, over some that it falls
/// on: one island of hundreds of joints and their contacts.
Simulation net() {
    constexpr int kSide = 12;
    constexpr double kApart = 0.5;
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), -0.6, 0.5));
    BodyType held = sphere_type(0.4, 1, 0.5);
    held.fixed_position = held.fixed_rotation = true;
    add(bodies, held, {3, -0.3, 3, 0.05});
    add(bodies, sphere_type(0.2, 1, 0.5));
    bodies.position[2] = {4, 2, 4, 0};
    std::vector<Joint> joints;
    const auto join = [&](BodyId a, BodyId b, const Vec4& along) {
        joints.push_back({a, b, PointJoint{0.5 * kApart * along, -0.5 * kApart * along}, false});
    };
    for (int i = 0; i < kSide * kSide; ++i) {
        const BodyId id = add(bodies, 2, {kApart * (i % kSide), 0.2, kApart * (i / kSide), 0});
        if (i % kSide > 0) join(id - 1, id, Vec4::UnitX());
        if (i >= kSide) join(id - kSide, id, Vec4::UnitZ());
    }
    return make_simulation(bodies, PhysicsSettings{}, joints);
}

class JointsOnThreads : public ::testing::TestWithParam<int> {};

TEST_P(JointsOnThreads, HaveTheBitsOfTheSerialWorld) {
    Stepper serial(net());
    StepReport report;
    for (int i = 0; i < 120; ++i) report = serial.step(kStep);
    EXPECT_GT(report.contacts, 20u);
    Threads threads(GetParam());
    ParallelStepper world(net());
    threads.run([&] {
        for (int i = 0; i < 120; ++i) world.step(kStep);
    });
    EXPECT_EQ(difference_of(serial, world), "");
    EXPECT_EQ(serial.memory().joint_impulses, world.memory().joint_impulses);
}

INSTANTIATE_TEST_SUITE_P(Counts, JointsOnThreads, ::testing::Values(1, 2, 4));

}  // namespace
}  // namespace tesserae::parallel
