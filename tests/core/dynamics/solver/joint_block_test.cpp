// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/joint_block.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/step/stage_copy.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

struct Jointed {
    Bodies bodies;
    std::vector<Joint> joints;
};

/// A rope of links of 1 kg and 0.1 m each, from the origin along a direction, with a load.
Jointed rope(int links, double load, double radius, const Vec4& direction) {
    constexpr double kHalf = 0.05;
    Jointed rope;
    add(rope.bodies, held_type());
    Vec4 on_last = Vec4::Zero();
    for (int i = 0; i <= links; ++i) {
        const double half = i < links ? kHalf : radius;
        const BodyId id = add(rope.bodies, sphere_type(half, i < links ? 1 : load),
                              (2 * kHalf * i + half) * direction);
        rope.joints.push_back({id - 1, id, PointJoint{on_last, -half * direction}, false});
        on_last = half * direction;
    }
    return rope;
}

double energy_of(const Stepper& world) {
    return kinetic_energy(world.bodies()) +
           potential_energy(world.bodies(), world.simulation().settings.gravity);
}

/// What hangs still is as long as it was, to 1e-5 of its length.
TEST(JointBlock, HeavyLoadsDoNotStretchARope) {
    for (const double load : {1.0, 200.0, 1800.0}) {
        const Jointed of = rope(50, load, 0.3, -Vec4::UnitY());
        Stepper world(make_simulation(of.bodies, PhysicsSettings{}, of.joints));
        const double first = world.bodies().position.back()[1];
        run(world, 240);
        EXPECT_LT(std::abs(world.bodies().position.back()[1] - first), 1e-5 * 5) << load;
        EXPECT_LT(fastest_of(world), 1e-5) << load;
    }
}

/// The same while a heavy box rests on a shelf and hangs on the rope: contacts and joints.
TEST(JointBlock, ARopeHoldsWhatLeansOnAShelf) {
    Jointed of = rope(20, 200, 0.2, -Vec4::UnitY());
    BodyType shelf = box_type({0.5, 0.1, 1, 1});
    shelf.fixed_position = shelf.fixed_rotation = true;
    const Vec4 load = of.bodies.position.back();
    add(of.bodies, shelf, load + Vec4(0.3, -0.2 - 0.05, 0, 0));
    Stepper world(make_simulation(of.bodies, PhysicsSettings{}, of.joints));
    run(world, 480);
    EXPECT_LT((world.bodies().position[of.joints.back().b] - load).norm(), 0.01);
    EXPECT_LT(fastest_of(world), 0.02);
}

/// A rope is as stiff where its island is large: its load hangs against eighty blocks.
TEST(JointBlock, IsNoWeakerInALargeIsland) {
    Jointed of = rope(12, 900, 0.3, -Vec4::UnitY());
    const Vec4 load = of.bodies.position.back();
    const double floor = load[1] - 0.6;
    add(of.bodies, plane_type(Vec4::UnitY(), floor, 0.5));
    const auto first = add(of.bodies, box_type(Vec4::Constant(0.1)), {0, floor + 0.05, 0, 0});
    for (int i = 1; i < 80; ++i)
        add(of.bodies, of.bodies.type[first], {0.1 * (i % 9), floor + 0.05, 0.1 * (i / 9 % 9), 0});
    // They carry a plate that leans on the load.
    add(of.bodies, box_type({0.9, 0.1, 0.9, 0.2}), {0.4, floor + 0.15, 0.4, 0}, {0, 0, 0, 0});
    add(of.bodies, box_type({0.4, 0.1, 0.4, 0.2}), {0, floor + 0.25, 0, 0});
    const auto torn = [&](const ColouredFrom& way) {
        Stepper world(make_simulation(of.bodies, PhysicsSettings{}, of.joints), way);
        run(world, 60);
        double farthest = 0;
        for (const Joint& joint : of.joints)
            farthest = std::max(farthest, coordinates_of(joint, world.bodies()).values.norm());
        return farthest;
    };
    EXPECT_LT(torn({}), 1e-4);
    EXPECT_GT(torn(kNoneColoured), 1e-3);  // swept, they are torn: so this could fail
}

/// What is let go aslant swings, in all four dimensions, and gains next to nothing.
TEST(JointBlock, ARopeThatSwingsGainsNoEnergy) {
    for (const double load : {1.0, 20.0, 200.0}) {
        const Jointed of = rope(20, load, 0.05, Vec4(1, -0.2, 0.3, 0.4).normalized());
        Stepper world(make_simulation(of.bodies, PhysicsSettings{}, of.joints));
        const double scale = (20 + load) * 10 * 2;  // [J], from the height of its length
        const double first = energy_of(world);
        double least = first, most = first;
        for (int i = 0; i < 480; ++i) {
            world.step(kStep);
            least = std::min(least, energy_of(world)), most = std::max(most, energy_of(world));
        }
        EXPECT_LT(most - first, 0.01 * scale) << load;
        EXPECT_GT(least - first, -0.01 * scale) << load;
    }
}

/// Boxes that lie on each other and on a floor, some of them joined, pushed at random.
Jointed clump(std::mt19937_64& random) {
    Jointed of;
    add(of.bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    const int count = 2 + static_cast<int>(uniform(random, 0, 4));
    for (int i = 0; i < count; ++i) {
        BodyType type = box_type({0.5, 0.4, 0.5, 0.5}, std::exp(uniform(random, -1, 1)));
        type.friction = uniform(random, 0, 0.8);
        const Vec4 w = random_vector(random, 0.3), v = random_vector(random, 0.3);
        add(of.bodies, type, {0.1 * i, 0.2 + 0.4 * i, 0, 0.05 * i}, v,
            {w[0], w[1], w[2], w[3], v[0], v[1]});
    }
    for (int i = 1; i < count; i += 2) {
        const auto a = static_cast<BodyId>(i), b = static_cast<BodyId>(i + 1);
        const Vec4 on_a = random_vector(random, 0.2);
        of.joints.push_back(
            {a, b, PointJoint{on_a, on_a + of.bodies.position[a] - of.bodies.position[b]}, true});
    }
    return of;
}

/// Joints aim as those of loops do: only a block aims again.
StepData solved_by(const Jointed& of, const ColouredFrom& way, const PhysicsSettings& settings) {
    StageCopy copy(Stage::kFinishStep);
    Simulation simulation = make_simulation(of.bodies, settings, of.joints);
    simulation.joints.in_loop.assign(of.joints.size(), 1);
    Stepper world(std::move(simulation), way);
    world.observe(&copy);
    world.step(kStep);
    return copy.step;
}

/// With contacts that open, stick and slide, and joints: the velocities are those to which sweeps
/// of one joint after the other converge.
void expect_solved_as_by_sweeps(int clumps) {
    std::mt19937_64 random(1);
    for (int i = 0; i < clumps; ++i) {
        const Jointed of = clump(random);
        PhysicsSettings settings;
        settings.iterations = 5000, settings.tolerance = 1e-10;
        const StepData block = solved_by(of, {}, settings);
        const StepData swept = solved_by(of, kNoneColoured, settings);
        for (BodyId id = 1; id < of.bodies.size(); ++id)
            EXPECT_LT((block.velocity[id] - swept.velocity[id]).norm(), 1e-5) << i;
    }
}

TEST(JointBlock, SolvesAsManySweepsDo) { expect_solved_as_by_sweeps(20); }
TEST(JointBlockSlow, SolvesAsManySweepsDo) { expect_solved_as_by_sweeps(60); }

}  // namespace
}  // namespace tesserae
