// SPDX-License-Identifier: Apache-2.0
#include "core/world/world.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/dynamics/step/step.hpp"
#include "core/error.hpp"
#include "tests/core/world/random_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

TEST(World, ABallThatFallsOnAFloorBounces) {
    World world;
    const BodyId floor = world.add(plane_type(Vec4::UnitY(), 0));
    const BodyId ball =
        world.add(sphere_type(0.5, 3, 0, 0.5), {{0, 2, 0, 0.2}, {}, Vec4::Zero(), {}});
    world.contact_changes();
    Vec4 before = Vec4::Zero();
    while (world.contacts().empty() && world.time() < 2) {
        before = world.state(ball).velocity;
        world.step();
    }
    ASSERT_EQ(world.contacts().size(), 1u);
    const ContactReading contact = world.contacts()[0];
    EXPECT_EQ(contact.a, floor);
    EXPECT_EQ(contact.b, ball);
    EXPECT_NEAR(contact.normal[1], 1, 1e-12);
    EXPECT_NEAR(contact.point[3], 0.2, 1e-12);
    // Gravity acts before and after the impulse.
    const double change = world.state(ball).velocity[1] - before[1] + 10 * kStep;
    EXPECT_GT(change, 8);
    EXPECT_NEAR(contact.impulse, 3 * change, 1e-9);
    const std::vector<TouchingPair> pair = {{floor, ball}};
    EXPECT_EQ(world.contact_changes().began, pair);
    while (!world.contacts().empty()) world.step();
    EXPECT_EQ(world.contact_changes().ended, pair);
    EXPECT_TRUE(world.contact_changes().ended.empty());
}

TEST(World, StepsAsTheStepperDoes) {
    const Bodies bodies = mixed_heap();
    Stepper stepper(bodies, {});
    World world;
    add_all(world, bodies);
    for (int i = 0; i < 100; ++i) {
        stepper.step(1.0 / 240);
        world.step();
    }
    for (BodyId i = 0; i < bodies.size(); ++i) {
        EXPECT_EQ(world.state(i).position, stepper.bodies().position[i]) << i;
        EXPECT_EQ(world.state(i).rotor, stepper.bodies().rotor[i]) << i;
    }
}

/// Bodies without contacts, in the order of their numbers.
TEST(World, KnowsItsBodiesThroughAThousandRandomCalls) {
    std::mt19937_64 random(5);
    World world(without_gravity());
    std::map<BodyId, BodyState> model;
    BodyId next = 0;
    const auto random_state = [&] {
        return BodyState{random_vector(random, 1e4),
                         exp({uniform(random, -2, 2), 0, 1, 0, 0, 0}),
                         Vec4::Zero(),
                         {}};
    };
    for (int call = 0; call < 1000; ++call) {
        const double what = uniform(random, 0, 1);
        const auto pick = [&] {
            auto at = model.begin();
            std::advance(at,
                         std::uniform_int_distribution<std::size_t>(0, model.size() - 1)(random));
            return at;
        };
        if (model.empty() || what < 0.45) {
            const BodyState state = random_state();
            ASSERT_EQ(world.add(sphere_type(uniform(random, 0.1, 0.2)), state), next);
            model[next++] = state;
        } else if (what < 0.75) {
            const auto at = pick();
            world.remove(at->first);
            EXPECT_THROW(world.state(at->first), InputError);
            model.erase(at);
        } else if (what < 0.9) {
            const auto at = pick();
            world.set_state(at->first, at->second = random_state());
        } else {
            world.step();
        }
        ASSERT_EQ(world.size(), model.size());
        if (call % 10 != 0) continue;
        std::size_t place = 0;
        const BodyArrays arrays = world.arrays();
        for (const auto& [id, state] : model) {
            ASSERT_EQ(world.ids()[place], id);
            ASSERT_EQ(world.state(id).position, state.position);
            ASSERT_EQ(arrays.position[place], state.position);
            ASSERT_EQ(arrays.rotor[place], state.rotor);
            ++place;
        }
    }
}

/// A body far away, the first of all: when it goes, the places of all others change.
TEST(World, WhatStaysGoesOnWithTheSameBitsWhenSomethingFarAwayIsRemoved) {
    World alone = busy_world();
    World other(sleepy_settings());
    const BodyId far = other.add(sphere_type(1), {{0, 1e4, 500, 0}, {}, Vec4::Zero(), {}});
    const BodyId link = other.add(sphere_type(1), {{0, 1e4, 505, 0}, {}, Vec4::Zero(), {}});
    const JointId joint = other.join({.type = JointType::kDistance}, far, link);
    // The same bodies behind the two.
    std::vector<BodyId> ids;
    for (const BodyId id : alone.ids()) ids.push_back(other.add(alone.type(id), alone.state(id)));
    BodyId last = kWorld;
    for (std::size_t i = 0; i < 3; ++i) {
        JointDescription description;
        description.anchor = {40, 5.3 - 0.6 * static_cast<double>(i), 0, 0};
        const BodyId body = ids[ids.size() - 3 + i];
        other.join(description, body, last);
        last = body;
    }
    // One goes while boxes lie on each other awake, one while some sleep.
    for (int i = 0; i < 60; ++i) alone.step(), other.step();
    other.remove(far);
    for (int i = 0; i < 140; ++i) alone.step(), other.step();
    EXPECT_TRUE(alone.is_asleep(alone.ids()[ids.size() - 6]));
    other.remove(link);
    EXPECT_FALSE(other.has_joint(joint));
    for (int i = 0; i < 200; ++i) {
        alone.step(), other.step();
        const BodyArrays a = alone.arrays(), b = other.arrays();
        ASSERT_EQ(a.position.size(), b.position.size());
        ASSERT_TRUE(std::equal(a.position.begin(), a.position.end(), b.position.begin())) << i;
        ASSERT_TRUE(std::equal(a.rotor.begin(), a.rotor.end(), b.rotor.begin())) << i;
    }
    EXPECT_EQ(alone.contacts().size(), other.contacts().size());
}

TEST(World, WhatSleepsOnABodyThatIsRemovedFalls) {
    World world(sleepy_settings());
    world.add(plane_type(Vec4::UnitY(), 0, 0.5));
    std::vector<BodyId> boxes;
    for (int i = 0; i < 3; ++i)
        boxes.push_back(
            world.add(box_type(Vec4::Ones(), 10), {{0, 0.5 + i, 0, 0}, {}, Vec4::Zero(), {}}));
    while (!world.is_asleep(boxes[2])) ASSERT_LT((world.step(), world.time()), 5);
    world.contact_changes();
    world.remove(boxes[0]);
    EXPECT_FALSE(world.is_asleep(boxes[2]));
    EXPECT_EQ(world.contact_changes().ended.size(), 2u);
    for (int i = 0; i < 480; ++i) world.step();
    EXPECT_NEAR(world.state(boxes[1]).position[1], 0.5, 1e-3);
    EXPECT_NEAR(world.state(boxes[2]).position[1], 1.5, 1e-3);
    // So does what sleeps on a body that contacts do not move, when this goes or is moved away.
    BodyType table = box_type({4, 1, 4, 4});
    table.fixed_position = table.fixed_rotation = true;
    const BodyId tables[] = {world.add(table, {{10, 1, 0, 0}, {}, Vec4::Zero(), {}}),
                             world.add(table, {{20, 1, 0, 0}, {}, Vec4::Zero(), {}})};
    const BodyId on[] = {world.add(box_type(Vec4::Ones()), {{10, 2, 0, 0}, {}, Vec4::Zero(), {}}),
                         world.add(box_type(Vec4::Ones()), {{20, 2, 0, 0}, {}, Vec4::Zero(), {}})};
    while (!world.is_asleep(on[0]) || !world.is_asleep(on[1]))
        ASSERT_LT((world.step(), world.time()), 20);
    world.remove(tables[0]);
    world.set_state(tables[1], {{20, 50, 0, 0}, {}, Vec4::Zero(), {}});
    for (int i = 0; i < 240; ++i) world.step();
    for (const BodyId id : on) EXPECT_NEAR(world.state(id).position[1], 0.5, 1e-3);
}

TEST(World, CopiesGoOnWithTheSameBits) {
    World world = busy_world();
    for (int i = 0; i < 120; ++i) world.step();
    World copy = world;
    EXPECT_TRUE(same_worlds(world, copy));
    for (int i = 0; i < 120; ++i) world.step(), copy.step();
    EXPECT_TRUE(same_worlds(world, copy));
    copy.remove(copy.ids().back());
    EXPECT_EQ(copy.size() + 1, world.size());
}

/// x = v t + F t^2 / 2m, L = N t; on every second axis and plane.
TEST(World, ForcesAndTorquesAccelerateWhatIsFree) {
    const Vec4 force{1, -2, 0.5, 3};
    const Bivector torque{0.4, 0, -0.3, 0.2, 0, 0.1};
    World world(without_gravity());
    const BodyId ball = world.add(sphere_type(0.5, 2)),
                 box = world.add(box_type({1, 2, 3, 4}, 5), {{100, 0, 0, 0}, {}, Vec4::Zero(), {}});
    const int steps = 240;
    Bivector momentum;
    for (int i = 0; i < steps; ++i) {
        for (const BodyId id : {ball, box}) {
            world.apply_force(id, force, world.state(id).position);
            world.apply_torque(id, torque);
        }
        world.step();
    }
    EXPECT_NEAR((world.state(ball).position - 0.25 * force).norm(), 0, 1e-12);
    EXPECT_NEAR((world.state(ball).velocity - 0.5 * force).norm(), 0, 1e-12);
    // A ball's moment in any plane is m r^2 / 3.
    const Bivector omega = world.state(ball).angular_velocity;
    EXPECT_NEAR(norm(omega - (3 / (2 * 0.25)) * torque), 0, 1e-12);
    EXPECT_NEAR((world.momentum() - 2 * force).norm(), 0, 1e-12);
    EXPECT_NEAR(
        norm(world.angular_momentum() - (2 * torque + wedge(world.state(ball).position, force) +
                                         wedge(world.state(box).position, force))),
        0, 1e-9);
    // They act in one step only.
    world.step();
    EXPECT_NEAR((world.momentum() - 2 * force).norm(), 0, 1e-12);
}

/// What a force does follows from that of gravity, also where it presses on a floor.
TEST(World, AForceOfTheWeightIsGravity) {
    PhysicsSettings none = without_gravity();
    World pulled(none), pushed(none), heavy;
    for (World* world : {&pushed, &heavy}) {
        world->add(plane_type(Vec4::UnitY(), 0, 0.5));
        for (int i = 0; i < 3; ++i)
            world->add(box_type(Vec4::Ones(), 2), {{0.1 * i, 0.6 + i, 0, 0}, {}, Vec4::Zero(), {}});
    }
    for (int i = 0; i < 480; ++i) {
        for (const BodyId id : {1u, 2u, 3u})
            pushed.apply_force(id, {0, -20, 0, 0}, pushed.state(id).position);
        pushed.step(), heavy.step();
    }
    for (const BodyId id : {1u, 2u, 3u})
        EXPECT_NEAR((pushed.state(id).position - heavy.state(id).position).norm(), 0, 1e-3) << id;
}

TEST(World, ImpulsesChangeMomentumAndAngularMomentumByWhatTheyAre) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 200; ++i) {
        World world(without_gravity());
        const BodyType type = i % 2 == 0 ? box_type({1, 2, 3, 4}, 5) : sphere_type(0.7, 3);
        const BodyId body = world.add(type, {random_vector(random, 3),
                                             exp({1.0 * i, 0.3, -1, 0, 0.2, 2}),
                                             random_vector(random, 1),
                                             {1, 2, 0, -1, 0, 1}});
        const Vec4 p = world.momentum(), impulse = random_vector(random, 2),
                   point = random_vector(random, 2);
        const Bivector l = world.angular_momentum(), more{0.1, 0.2, -0.3, 0.4, 0.5, -0.6};
        world.apply_impulse(body, impulse, point);
        EXPECT_NEAR((world.momentum() - p - impulse).norm(), 0, 1e-12);
        EXPECT_NEAR(norm(world.angular_momentum() - l - wedge(point, impulse)), 0, 1e-11);
        world.apply_angular_impulse(body, more);
        EXPECT_NEAR(norm(world.angular_momentum() - l - wedge(point, impulse) - more), 0, 1e-11);
    }
}

/// A ball that nothing had turned, in a world in which nothing turned so far.
TEST(World, ABodyThatIsTurnedByHandTurns) {
    World world;
    const BodyId ball = world.add(sphere_type(1)),
                 other = world.add(sphere_type(1), {{5, 0, 0, 0}, {}, Vec4::Zero(), {}});
    world.step();
    BodyState state = world.state(ball);
    state.rotor = exp({0.3, 0, 0, 0, 0, 0});
    world.set_state(ball, state);
    world.step();
    EXPECT_EQ(world.state(ball).rotor, state.rotor);
    world.apply_angular_impulse(other, {0, 0, 1, 0, 0, 0});
    world.step();
    EXPECT_NEAR(world.state(other).angular_velocity.xw, 3, 1e-12);
    EXPECT_NE(world.state(other).rotor, Rotor{});
}

TEST(World, ViewsOfItsArraysGoOnThroughStepsAndOutliveChanges) {
    World world = busy_world();
    world.step();
    const BodyArrays arrays = world.arrays();
    for (int i = 0; i < 3; ++i) {
        world.step();
        for (std::size_t place = 0; place < world.size(); ++place) {
            const BodyState state = world.state(world.ids()[place]);
            EXPECT_EQ(arrays.position[place], state.position);
            EXPECT_EQ(arrays.rotor[place], state.rotor);
            EXPECT_EQ(arrays.velocity[place], state.velocity);
            EXPECT_EQ(arrays.angular_velocity[place], state.angular_velocity);
        }
    }
    const Vec4 last = arrays.position[5];
    world.remove(world.ids()[5]);
    world.add(sphere_type(1));
    for (int i = 0; i < 3; ++i) world.step();
    EXPECT_EQ(arrays.position[5], last);
    EXPECT_EQ(arrays.position.size(), world.size());
}

/// In a world in which nothing turned so far: that is computed anew.
TEST(World, ViewsGoOnThroughAllChangesButThoseOfTheBodies) {
    World world(without_gravity());
    const BodyId ball = world.add(sphere_type(1)),
                 other = world.add(sphere_type(1), {{5, 0, 0, 0}});
    world.step();
    const BodyArrays arrays = world.arrays();
    const auto expect_live = [&](const char* after) {
        for (int i = 0; i < 2; ++i) {
            world.step();
            EXPECT_EQ(arrays.position[0], world.state(ball).position) << after;
            EXPECT_EQ(arrays.rotor[0], world.state(ball).rotor) << after;
            EXPECT_EQ(arrays.angular_velocity[0], world.state(ball).angular_velocity) << after;
        }
    };
    const Rotor turned = exp({0.3, 0, 0, 0, 0, 0});
    world.set_state(ball, {.position = {0, 1, 0, 0}, .rotor = turned, .velocity = {0, 0, 0, 1}});
    EXPECT_EQ(world.state(ball).rotor, turned);
    expect_live("set_state");
    world.apply_torque(ball, {1, 0, 0, 0, 0, 0});
    expect_live("apply_torque");
    EXPECT_NE(world.state(ball).angular_velocity.xy, 0);
    const JointId rope = world.join({.type = JointType::kRope, .length = 9}, ball, other);
    expect_live("join");
    world.remove_joint(rope);
    expect_live("remove_joint");
}

TEST(World, LooksAtItsArraysChangeNoBit) {
    World seen = busy_world(), unseen = busy_world();
    const BodyArrays arrays = seen.arrays();
    for (int i = 0; i < 100; ++i) seen.step(), unseen.step();
    EXPECT_TRUE(same_worlds(seen, unseen));
}

TEST(World, SetsAllStatesAtOnce) {
    World world = busy_world();
    std::vector<Vec4> position(world.size(), Vec4(0, 5, 0, 0));
    position[0] = Vec4::Zero();
    for (std::size_t i = 0; i < position.size(); ++i)
        if (is_bounded(world.type(world.ids()[i]).shape))
            position[i][0] = 3.0 * static_cast<double>(i);
        else
            position[i].setZero();
    world.set_arrays(position, {}, {}, {});
    EXPECT_EQ(world.arrays().position[9], position[9]);
    position.pop_back();
    EXPECT_THROW(world.set_arrays(position, {}, {}, {}), InputError);
}

TEST(World, NamesTheBodyThatLeavesTheFiniteRange) {
    World world(without_gravity());
    const BodyId gone = world.add(sphere_type(1)),
                 fast = world.add(sphere_type(1), {{9, 0, 0, 0}, {}, Vec4::Zero(), {}});
    world.remove(gone);
    for (int i = 0; i < 20; ++i) world.apply_impulse(fast, {1e15, 0, 0, 0}, {9, 0, 0, 0});
    const std::string before = world.save();
    try {
        world.step(1e300);
        FAIL();
    } catch (const LeftFiniteRange& error) {
        EXPECT_EQ(error.body, fast);
    }
    EXPECT_EQ(world.save(), before);
}

}  // namespace
}  // namespace tesserae
