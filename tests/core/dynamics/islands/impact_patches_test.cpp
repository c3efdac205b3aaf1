// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/islands/impact_patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/solver/impact.hpp"
#include "core/dynamics/solver/solver.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

namespace tesserae {
namespace {

using namespace tesserae::testing;

/// A layer of touching spheres on a plane, and one that falls on the middle one.
Bodies struck_layer(double mass, double speed, double restitution = 0) {
    constexpr int kAcross = 11;
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0));
    for (int x = 0; x < kAcross; ++x)
        for (int z = 0; z < kAcross; ++z)
            for (int w = 0; w < kAcross; ++w)
                add(bodies, sphere_type(0.5), {x - 5.0, 0.5, z - 5.0, w - 5.0});
    BodyType ball = sphere_type(0.5, mass);
    ball.restitution = restitution;
    add(bodies, ball, {0, 1.5 + 0.4 * kStep * speed, 0, 0}, {0, -speed, 0, 0});
    return bodies;
}

/// What the first step's impacts find, and they.
struct Found {
    Simulation simulation;
    StepData step;
    std::vector<std::vector<std::uint32_t>> hits = {{}};
};
Found before_impacts(Bodies bodies) {
    StageCopy copy(Stage::kSolveImpacts);
    Stepper world(std::move(bodies), PhysicsSettings{});
    world.observe(&copy);
    world.step(kStep);
    Found found{copy.simulation, copy.step};
    list_impacts(found.simulation, found.step, {0, found.step.contacts.size()}, found.hits[0]);
    return found;
}

/// Solves all islands that await it.
void solve_all(Found& found) {
    for (std::size_t island = 0; island < found.step.islands.size(); ++island)
        solve_impact(found.simulation, found.step, island);
}

double energy_of(const Found& found) {
    double sum = 0;
    for (BodyId id = 0; id < found.simulation.bodies.size(); ++id)
        sum += twice_kinetic_energy(found.simulation, found.step, id, motion_of(found.step, id));
    return sum;
}

TEST(ImpactPatches, HaveWhatTouchesWhatIsHitAndWhatTouchesThat) {
    Found found = before_impacts(struck_layer(1, 3));
    const auto ball = static_cast<BodyId>(found.simulation.bodies.size() - 1);
    ASSERT_EQ(found.hits[0].size(), 1u);
    ASSERT_EQ(found.step.islands.size(), 1u);
    ASSERT_TRUE(found.step.islands.is_coloured(0));
    ASSERT_GE(found.step.islands.contacts[0], kPatchedFrom);
    ImpactPatches patches;
    patches.begin(found.simulation, found.step, found.hits);
    const Islands& islands = found.step.islands;
    ASSERT_EQ(islands.size(), 2u);
    EXPECT_EQ(found.step.awaits[0], Awaits::kNothing);
    EXPECT_EQ(found.step.awaits[1], Awaits::kPatch);
    EXPECT_TRUE(std::is_sorted(islands.runs_in(1).begin(), islands.runs_in(1).end()));
    // The ball, the one below it and those at most two further on along the axes, 25.
    std::set<BodyId> bodies;
    for (const std::uint32_t n : islands.runs_in(1)) {
        const ContactList::Run run = found.step.contacts.nth_run(n);
        for (const BodyId id : {run.a, run.b})
            if (id != 0) bodies.insert(id);
    }
    EXPECT_EQ(bodies.size(), 26u);
    for (const BodyId id : bodies) {
        const Vec4 x = found.step.position[id];
        if (id != ball) {
            EXPECT_LT(std::abs(x[0]) + std::abs(x[2]) + std::abs(x[3]), 2.1) << id;
        }
    }
    std::size_t all_between = 0;
    for (const Contact& c : found.step.contacts)
        all_between += (c.a == 0 || bodies.count(c.a)) && bodies.count(c.b);
    EXPECT_EQ(islands.contacts[1], all_between);
}

TEST(ImpactPatches, MoveBodiesAsTheWholeIslandDoes) {
    for (const double restitution : {0.0, 0.6}) {
        Found patched = before_impacts(struck_layer(1, 3, restitution)), whole = patched;
        const double energy = energy_of(patched);
        const std::size_t hit = patched.hits[0][0];
        ImpactPatches patches;
        patches.begin(patched.simulation, patched.step, patched.hits);
        solve_all(patched);
        EXPECT_FALSE(patches.end(patched.simulation, patched.step));
        EXPECT_EQ(patched.step.islands.size(), 1u);
        EXPECT_EQ(patched.step.islands.runs.size(), whole.step.islands.runs.size());
        EXPECT_EQ(patched.step.was_hit, std::vector<std::uint8_t>{1});
        EXPECT_GT(patched.step.hit[hit], 0);
        EXPECT_LT(energy_of(patched), energy);
        // As often as it takes.
        whole.simulation.settings.iterations = 1000;
        whole.step.awaits.assign(1, Awaits::kImpact);
        solve_all(whole);
        for (BodyId id = 0; id < patched.simulation.bodies.size(); ++id)
            EXPECT_LT((patched.step.velocity[id] - whole.step.velocity[id]).norm(), 0.01) << id;
        EXPECT_NEAR(patched.step.velocity.back()[1], 3 * restitution, 0.01);
    }
}

/// What bounces on a heap that is solved as a whole, by the iterations that there are by default.
TEST(ImpactOfALargeIsland, ReturnsNewtonsSpeedOfPlatesOnABedOfBalls) {
    Bodies bed;
    add(bed, plane_type(Vec4::UnitY(), 0));
    for (int layer = 0; layer < 3; ++layer)
        for (int x = 0; x < 6; ++x)
            for (int z = 0; z < 6; ++z)
                for (int w = 0; w < 6; ++w)
                    add(bed, sphere_type(0.5), {x - 2.5, 0.5 + layer, z - 2.5, w - 2.5});
    for (const double size : {1.9, 3.9, 5.5})
        for (const double mass : {5.0, 20.0, 80.0, 300.0}) {
            constexpr double kSpeed = 3;
            Bodies bodies = bed;
            BodyType plate = box_type({size, 1, size, size}, mass);
            plate.restitution = 0.8;
            add(bodies, plate, {0, 3.5 + 0.4 * kStep * kSpeed, 0, 0}, {0, -kSpeed, 0, 0});
            Found found = before_impacts(bodies);
            ASSERT_EQ(found.step.islands.size(), 1u);
            ASSERT_GE(found.step.islands.contacts[0], kPatchedFrom);
            EXPECT_GE(found.hits[0].size(), 8u);
            found.step.awaits.assign(1, Awaits::kImpact);
            solve_all(found);
            EXPECT_NEAR(found.step.velocity.back()[1], 0.8 * kSpeed, 0.01) << size << ' ' << mass;
        }
}

/// A ball of 10^4 masses drives what it hits aside.
TEST(ImpactPatches, GiveUpWhereTheyReachOut) {
    Bodies bodies = struck_layer(1e4, 20);
    bodies.position.back() += Vec4{0.3, -0.02, 0.2, 0.1};
    Found found = before_impacts(bodies);
    const StepData before = found.step;
    ImpactPatches patches;
    patches.begin(found.simulation, found.step, found.hits);
    ASSERT_EQ(found.step.islands.size(), 2u);
    solve_all(found);
    EXPECT_FALSE(same_bits(found.step.velocity, before.velocity));
    EXPECT_TRUE(patches.end(found.simulation, found.step));
    EXPECT_TRUE(same_bits(found.step.velocity, before.velocity));
    EXPECT_TRUE(same_bits(found.step.angular_velocity, before.angular_velocity));
    EXPECT_EQ(found.step.hit, before.hit);
    EXPECT_EQ(found.step.awaits, std::vector<Awaits>{Awaits::kImpact});
    EXPECT_EQ(found.step.was_hit, before.was_hit);
    EXPECT_EQ(found.step.islands.size(), 1u);
}

/// The whole is the cheaper then.
TEST(ImpactPatches, AreNoneWhereMuchIsHit) {
    Bodies bodies = struck_layer(1, 3);
    for (BodyId id = 1; id + 1 < bodies.size(); id += 9) bodies.velocity[id] = {0, -2, 0, 0};
    Found found = before_impacts(bodies);
    EXPECT_GT(found.hits[0].size(), 30u);
    ImpactPatches patches;
    patches.begin(found.simulation, found.step, found.hits);
    EXPECT_EQ(found.step.islands.size(), 1u);
    EXPECT_EQ(found.step.awaits, std::vector<Awaits>{Awaits::kImpact});
    EXPECT_FALSE(patches.end(found.simulation, found.step));
}

}  // namespace
}  // namespace tesserae
