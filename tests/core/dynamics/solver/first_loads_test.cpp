// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/first_loads.hpp"

#include <gtest/gtest.h>

#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// The first step as islands are built in it: contacts have what they start from.
StepData first_step(const Bodies& bodies, const PhysicsSettings& settings) {
    StageCopy copy(Stage::kBuildIslands);
    Stepper world(bodies, settings);
    world.observe(&copy);
    world.step(kStep);
    return copy.step;
}

/// What gravity and the contacts' impulses would do to each body's momentum, and to its angular
/// momentum about its centre, beside its weight and that times its size.
double unbalanced(const Bodies& bodies, const StepData& step, const PhysicsSettings& settings) {
    std::vector<Vec4> momentum(bodies.size(), Vec4::Zero());
    std::vector<Bivector> angular(bodies.size());
    for (std::size_t i = 0; i < step.contacts.size(); ++i) {
        const Contact c = step.contacts[i];
        const Vec4 impulse = step.impulses[i].normal * c.normal;
        momentum[c.a] -= impulse, momentum[c.b] += impulse;
        angular[c.a] = angular[c.a] - wedge(c.point - step.position[c.a], impulse);
        angular[c.b] = angular[c.b] + wedge(c.point - step.position[c.b], impulse);
    }
    double worst = 0;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        if (!bodies.is_movable(id)) continue;
        const double mass = bodies.type_of(id).mass;
        const double weight = mass * kStep * settings.gravity.norm();
        worst = std::max(worst, (momentum[id] + mass * kStep * settings.gravity).norm() / weight);
        worst = std::max(worst, norm(angular[id]) / weight);
    }
    return worst;
}

/// Boards on each other, each with a weight of its own and moved a little, on a floor.
Bodies leaning_tower(std::mt19937_64& random, double moved) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0));
    std::uniform_real_distribution<> part(-1, 1);
    Vec4 place = Vec4::Zero();
    for (int i = 0; i < 8; ++i) {
        place += Vec4(moved * part(random), 0, moved * part(random), moved * part(random));
        place[1] = 0.25 + 0.5 * i;
        add(bodies, box_type({1, 0.5, 1.2, 0.8}, std::exp(2 * part(random))), place);
    }
    return bodies;
}

TEST(FirstLoads, AreThoseOfTowersThatStand) {
    std::mt19937_64 random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const Bodies bodies = leaning_tower(random, trial % 2 == 0 ? 0 : 0.02);
        const StepData step = first_step(bodies, {});
        EXPECT_LT(unbalanced(bodies, step, {}), 1e-9) << trial;
    }
}

/// Of a wall every brick but those of the lowest row stands on two, those at the ends on one.
TEST(FirstLoads, AreThoseOfWalls) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (int row = 0; row < 12; ++row)
        for (int column = 0; column < 12 - row; ++column)
            add(bodies, box_type({1, 0.5, 0.5, 0.5}, 1 + 0.1 * (row + column) / 24),
                {1.05 * column + 0.525 * row, 0.5 * row + 0.25, 0, 0});
    EXPECT_LT(unbalanced(bodies, first_step(bodies, {}), {}), 1e-9);
}

/// Along any direction of gravity, of a row of spheres one under the other.
TEST(FirstLoads, AreAlongGravity) {
    PhysicsSettings settings;
    settings.gravity = Vec4(1, -2, 3, 4);
    const Vec4 up = -settings.gravity.normalized();
    Bodies bodies;
    add(bodies, plane_type(up, 0));
    for (int i = 0; i < 10; ++i) add(bodies, sphere_type(0.5, 1 + i % 3), (0.5 + i) * up);
    EXPECT_LT(unbalanced(bodies, first_step(bodies, settings), settings), 1e-9);
}

double sum_of_impulses(const StepData& step) {
    double sum = 0;
    for (const ContactImpulse& impulse : step.impulses) sum += impulse.normal;
    return sum;
}

TEST(FirstLoads, AreOfNothingThatDoesNotStand) {
    const auto pile = [](double height, double gap) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0));
        for (int i = 0; i < 3; ++i)
            add(bodies, box_type(Vec4::Ones()), {0, height + i + 0.5 + gap * i, 0, 0});
        return bodies;
    };
    EXPECT_GT(sum_of_impulses(first_step(pile(0, 0), {})), 0);
    EXPECT_EQ(sum_of_impulses(first_step(pile(5, 0), {})), 0);  // falls
    EXPECT_EQ(sum_of_impulses(first_step(pile(0, 0), without_gravity())), 0);
    const StepData apart = first_step(pile(0, 0.002), {});  // only the lowest touches
    EXPECT_NEAR(sum_of_impulses(apart), 10 * kStep, 1e-12);
    Bodies hangs = pile(5, 0);  // on one that contacts do not move
    BodyType held = box_type(Vec4::Ones());
    held.fixed_position = held.fixed_rotation = true;
    give_type(hangs, 1, held);
    EXPECT_NEAR(sum_of_impulses(first_step(hangs, {})), (20 + 10) * kStep, 1e-12);
}

/// The warm start stays: the second step starts from what the first one ended with.
TEST(FirstLoads, AreGuessedOnce) {
    std::mt19937_64 random(2);
    Stepper world(leaning_tower(random, 0.02), {});
    world.step(kStep);
    const KeptImpulses left = world.memory().impulses;
    StageCopy copy(Stage::kBuildIslands);
    world.observe(&copy);
    world.step(kStep);
    ASSERT_GT(left.size(), 20u);
    std::size_t known = 0;
    for (std::size_t i = 0; i < copy.step.contacts.size(); ++i)
        for (const KeptImpulse& impulse : left)
            if (key_of(impulse) == key_of(copy.step.contacts[i])) {
                EXPECT_EQ(copy.step.impulses[i].normal, impulse.normal);
                ++known;
            }
    EXPECT_EQ(known, left.size());
}

/// They fell: a step is a larger part of their time to fall the smaller they are.
TEST(FirstLoads, LetSmallTowersStand) {
    for (const auto& [size, count] : {std::pair{0.01, 10}, {0.05, 20}, {0.1, 20}, {0.2, 30}}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        BodyType box = box_type(Vec4::Constant(size));
        box.friction = 0.5;
        for (int i = 0; i < count; ++i) add(bodies, box, {0, size * (i + 0.5), 0, 0});
        Stepper world(bodies, {});
        run(world, 480);
        for (BodyId id = 1; id < bodies.size(); ++id)
            EXPECT_LT((world.bodies().position[id] - bodies.position[id]).norm(), 1e-3 * size)
                << size;
    }
}

}  // namespace
}  // namespace tesserae
