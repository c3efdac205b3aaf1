// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/dynamics/solver/kernels/points.hpp"
#include "tests/core/dynamics/solver/random_island.hpp"

namespace tesserae {
namespace {

using namespace testing;

TEST(SlipByTurning, InLanesIsThatOfEachContact) {
    Unsolved island = random_island(0.5, true);
    const Simulation& simulation = island.simulation;
    StepData& step = island.step;
    const ColouredStage stage{.simulation = simulation, .step = step, .first_member = 0};
    int driven = 0, slower = 0;
    for (std::uint32_t i = 0; i < step.contacts.size(); ++i) {
        const Contact contact = step.contacts[i];
        const std::size_t k = i % kLanes;
        lanes::EightPoints points = {};
        lanes::put(contact.normal, points.normal[k]);
        lanes::put_turning(stage, i, k, points.turning);
        const lanes::Lane<lanes::Float8> lane;
        const auto slip =
            lanes::slip_by_turning(stage, lane, lanes::load(lane, points.normal), points.turning);
        const Vec4 expected = slip_by_turning(simulation, step, contact, Cause::kLoad);
        for (std::size_t axis = 0; axis < 4; ++axis)
            EXPECT_NEAR(slip[axis][k], expected[static_cast<int>(axis)], 1e-6 * expected.norm())
                << i;
        const bool any_driven =
            is_driven(simulation, contact.a) || is_driven(simulation, contact.b);
        EXPECT_GT(expected.norm(), 0) << i;
        ++(any_driven ? driven : slower);
    }
    EXPECT_GT(driven, 5);
    EXPECT_GT(slower, 100);
}

}  // namespace
}  // namespace tesserae
