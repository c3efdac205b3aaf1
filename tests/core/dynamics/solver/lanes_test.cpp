// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "core/dynamics/solver/coloured_rows.hpp"
#include "tests/core/dynamics/solver/random_island.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// Pairs of batches that are swept at once in sixteen lanes, for each number of rows.
std::array<int, kManifoldPoints + 1> count_twos(const ColouredIslands& coloured) {
    std::array<int, kManifoldPoints + 1> twos = {};
    const auto count = [&](const std::vector<Batch>& all, BatchRange range) {
        largest_of_twos(all, range, false, Members::only(0), [&](BatchRange some) {
            twos[all[some.begin].rows] += some.end - some.begin == 2;
            return 0;
        });
    };
    for (const ColourBatches& colour :
         std::span(coloured.colours).first(coloured.colours.size() - 1)) {
        count(coloured.round, colour.round);
        count(coloured.general, colour.general);
    }
    return twos;
}

struct LanesCase {
    bool spheres_only;
    double friction, rolling, thinnest;
};

/// Impact, load and what takes overlap away.
Unsolved solved_with(Unsolved world, LaneCount lanes) {
    const Simulation& simulation = world.simulation;
    solve_coloured_impact(simulation, world.step, 0, OneThread{}, lanes);
    solve_coloured_island(simulation, world.step, 0, OneThread{}, lanes);
    advance_second_half(simulation, world.step, {0, simulation.bodies.size()});
    apply_coloured_correction(simulation, world.step, 0, OneThread{});
    return world;
}

void expect_the_same_bits_with_all_lanes(const LanesCase& of) {
    const Unsolved island = random_island(of.friction, of.spheres_only, of.rolling, of.thinnest);
    ASSERT_EQ(island.step.islands.size(), 1u);
    const ColouredIslands& coloured = island.step.coloured;
    const BatchRange& many =
        of.spheres_only ? coloured.colours.back().round : coloured.colours.back().general;
    ASSERT_GT(many.end - many.begin, 4u);
    EXPECT_EQ(coloured.round_friction.empty(), of.friction == 0);
    EXPECT_EQ(coloured.round_rolling.empty(), of.rolling == 0);
    EXPECT_EQ(coloured.inverse_inertias.empty(), of.spheres_only);
    const auto twos = count_twos(coloured);
    EXPECT_GT(twos[1], of.spheres_only ? 20 : 0);
    EXPECT_GT(twos[8], of.spheres_only ? -1 : 1);
    const Unsolved one = solved_with(island, LaneCount::kOne);
    EXPECT_GT(
        std::count_if(one.step.hit.begin(), one.step.hit.end(), [](double h) { return h > 0; }),
        50);
    EXPECT_GT(one.step.residual[0], 0);
    double normal = 0, tangent = 0;
    for (const ContactImpulse& p : one.step.impulses)
        normal += p.normal, tangent += p.tangent().norm();
    EXPECT_GT(normal, 1) << "nothing was solved";
    EXPECT_EQ(tangent > 0, of.friction > 0);
    EXPECT_FALSE(same_bits(one.step.velocity, one.simulation.bodies.velocity));
    for (const LaneCount lanes : {LaneCount::kEight, LaneCount::kSixteen}) {
        if (lanes > most_lanes()) continue;
        const Unsolved many_lanes = solved_with(island, lanes);
        EXPECT_TRUE(same_bits(one.step.velocity, many_lanes.step.velocity));
        EXPECT_TRUE(same_bits(one.step.angular_velocity, many_lanes.step.angular_velocity));
        EXPECT_EQ(one.step.residual, many_lanes.step.residual);
        EXPECT_EQ(one.step.hit, many_lanes.step.hit);
        EXPECT_EQ(one.step.angular_impulses, many_lanes.step.angular_impulses);
        for (std::size_t i = 0; i < one.step.impulses.size(); ++i) {
            ASSERT_EQ(one.step.impulses[i].normal, many_lanes.step.impulses[i].normal);
            ASSERT_EQ(one.step.impulses[i].slope, many_lanes.step.impulses[i].slope);
        }
    }
}

TEST(ColouredRows, HasTheSameBitsWithOneEightAndSixteenLanes) {
    // Up to 0.75 there are conjugate directions.
    for (const auto& [friction, rolling] :
         {std::pair{0.0, 0.0}, {0.3, 0.0}, {0.7, 0.0}, {0.7, 0.1}}) {
        expect_the_same_bits_with_all_lanes({true, friction, rolling, 0.5});
        for (const double thinnest : {0.5, 0.05})
            expect_the_same_bits_with_all_lanes({false, friction, rolling, thinnest});
    }
}

}  // namespace
}  // namespace tesserae
