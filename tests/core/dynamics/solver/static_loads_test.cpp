// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/static_loads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

// What is slender and stands on the ground: loads that hold it still.
namespace tesserae {
namespace {

using namespace testing;

/// Of boxes of one kind on a floor, each a little aside of the one below and turned about the
/// vertical.
struct Pile {
    Vec4 size = Vec4::Zero();
    int count = 0;
    double aside = 0;   ///< of half a box's size, at most
    double turned = 0;  ///< in two planes, at most
    double gap = 0;     ///< of a box's height

    Bodies bodies(unsigned seed) const {
        std::mt19937_64 engine(seed);
        std::uniform_real_distribution<> part(-1, 1);
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        BodyType box = box_type(size);
        box.friction = 0.5;
        for (int i = 0; i < count; ++i) {
            Vec4 place = 0.5 * aside * size;
            for (int k : {0, 2, 3}) place[k] *= part(engine);
            place[1] = (i + 0.5 + (i + 1) * gap) * size[1];
            const Bivector turn = {0, turned * part(engine), 0, 0, 0, turned * part(engine)};
            add(bodies, box, place, Vec4::Zero(), {}, exp(turn));
        }
        return bodies;
    }
};

/// How far a body has gone sideways, at most.
double moved_aside(const Stepper& world, const Bodies& start) {
    double largest = 0;
    for (BodyId id = 0; id < start.size(); ++id) {
        Vec4 way = world.bodies().position[id] - start.position[id];
        way[1] = 0;
        largest = std::max(largest, way.norm());
    }
    return largest;
}

/// Of 24 towers without gaps six swayed, by up to 2 % of a cube a second.
TEST(StaticLoads, HoldHighTowersOfSmallCubesStill) {
    for (const double size : {0.01, 0.019, 0.03}) {
        const Bodies start = Pile{Vec4::Constant(size), 25}.bodies(1);
        Stepper world(start, PhysicsSettings{});
        run(world, 1200);
        EXPECT_LT(fastest_of(world), 1e-3 * size) << size;
        EXPECT_LT(moved_aside(world, start), 1e-3 * size) << size;
    }
}

/// Of 240 such towers 46 still swayed after four seconds, and two fell.
void hold_towers_with_gaps(unsigned towers) {
    for (unsigned seed = 0; seed < towers; ++seed) {
        const double size = 0.01 * std::pow(2, seed % 4);
        const Bodies start =
            Pile{Vec4::Constant(size), 12 + 4 * static_cast<int>(seed), 0, 0, 0.01}.bodies(seed);
        Stepper world(start, PhysicsSettings{});
        run(world, 960);
        EXPECT_LT(fastest_of(world), 2e-3 * size) << seed;
        EXPECT_LT(moved_aside(world, start), 0.05 * size) << seed;
    }
}

TEST(StaticLoads, HoldTowersThatStartWithGaps) { hold_towers_with_gaps(4); }
TEST(StaticLoadsSlow, HoldTowersThatStartWithGaps) { hold_towers_with_gaps(8); }

/// Of 24 such piles 4 fell, after up to 14 s; the first two of these did.
TEST(StaticLoadsSlow, HoldPilesOfSmallBoards) {
    for (const unsigned seed : {13u, 18u, 3u, 7u}) {
        const double s = 0.0105 + 0.0001 * (seed % 20);
        const Pile pile = {
            {s, 0.12 * s, 0.5 * s, 0.5 * s}, 10 + static_cast<int>(seed % 10), 0.3, 0.2, 0.01};
        const Bodies start = pile.bodies(seed);
        Stepper world(start, PhysicsSettings{});
        run(world, 4800);
        EXPECT_LT(fastest_of(world), 1e-3 * s) << seed;
        EXPECT_LT(moved_aside(world, start), 0.05 * s) << seed;
    }
}

/// What is left of a body's motion after gravity and the impulses of all its contacts.
struct Left {
    Vec4 momentum = Vec4::Zero();
    Bivector angular;
};
std::vector<Left> left_by(const Simulation& simulation, const StepData& step) {
    std::vector<Left> left(simulation.bodies.size());
    for (BodyId id = 0; id < left.size(); ++id) {
        const TypeProperties& type = simulation.type_of(id);
        if (!type.movable) continue;
        left[id].momentum = type.mass * step.velocity[id];
        left[id].angular = angular_momentum(type, step.rotor[id], step.angular_velocity[id]);
    }
    for (std::size_t i = 0; i < step.contacts.size(); ++i) {
        const Contact contact = step.contacts[i];
        const ContactImpulse& load = step.impulses[i];
        const Vec4 impulse = load.normal * contact.normal + load.tangent();
        for (const auto& [id, side] : {std::pair{contact.a, -1.0}, {contact.b, 1.0}}) {
            if (!simulation.type_of(id).movable) continue;
            left[id].momentum += side * impulse;
            left[id].angular += side * wedge(contact.point - step.position[id], impulse);
        }
    }
    return left;
}

/// Newton's laws body by body, from no impulses: nothing moves any more, and contacts bear it.
TEST(StaticLoads, StopWhatCreeps) {
    int held = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        const Vec4 size = seed % 2 ? Vec4(0.4, 0.1, 0.3, 0.3) : Vec4(0.02, 0.03, 0.025, 0.02);
        StageCopy copy(Stage::kSolveIslands);
        Stepper world(
            make_simulation(Pile{size, 2 + static_cast<int>(seed) / 2, 0.2, 0.2}.bodies(seed),
                            PhysicsSettings{}),
            seed % 4 < 2 ? 1 : kNoneColoured);
        run(world, 5);
        world.observe(&copy);
        world.step(kStep);
        const Simulation& simulation = copy.simulation;
        StepData& step = copy.step;
        ASSERT_EQ(step.islands.size(), 1u);
        std::mt19937_64 engine(seed);
        std::uniform_real_distribution<> part(-1, 1);
        const double kick = step.h * simulation.settings.gravity.norm();
        for (BodyId id = 1; id < simulation.bodies.size(); ++id)
            for (int k = 0; k < 4; ++k) step.velocity[id][k] += 1e-3 * kick * part(engine);
        for (ContactImpulse& load : step.impulses) load = {};
        hold_still(simulation, step, 0);

        double most = 0;
        for (std::size_t i = 0; i < step.impulses.size(); ++i) {
            const ContactImpulse& load = step.impulses[i];
            EXPECT_GE(load.normal, 0);
            EXPECT_LE(load.tangent().norm(), 0.5 * load.normal * (1 + 1e-6));
        }
        for (const Left& left : left_by(simulation, step)) {
            // Friction is kept in float; in coloured islands points act where the deepest does.
            most = std::max(most, left.momentum.norm() / kick);
            most = std::max(most, norm(left.angular) / (kick * 0.5 * size.norm()));
        }
        held += most < 1e-4;
        EXPECT_LT(most, 0.02) << seed;
    }
    EXPECT_EQ(held, 60);
}

/// What is so fast that bodies bounce keeps the loads that it had.
TEST(StaticLoads, AreNotOfWhatSlidesFast) {
    StageCopy copy(Stage::kSolveIslands);
    Bodies bodies = Pile{Vec4::Constant(0.1), 3}.bodies(0);
    for (BodyId id = 1; id < bodies.size(); ++id) bodies.velocity[id][0] = 0.4 * id;
    Stepper world(bodies, PhysicsSettings{});
    run(world, 2);
    world.observe(&copy);
    world.step(kStep);
    const std::vector<ContactImpulse> before = copy.step.impulses;
    hold_still(copy.simulation, copy.step, 0);
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_EQ(copy.step.impulses[i].normal, before[i].normal);
}

}  // namespace
}  // namespace tesserae
