// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "core/dynamics/contacts/find_contacts.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/step/step.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/part_of.hpp"

// What is a kilometre away changes no bit: no switch of the whole scene changes a result.
namespace tesserae {
namespace {

using namespace testing;

constexpr double kFar = 1000;

/// Spheres, boxes and capsules that fall into one heap, and a tower of boxes beside it.
Bodies heap_and_tower(bool spheres_only) {
    Bodies bodies = spheres_only ? heap_of_spheres(90, 3) : mixed_heap(90, 3);
    if (spheres_only) return bodies;
    BodyType box = box_type({0.5, 0.3, 0.4, 0.5}, 2);
    box.friction = 0.5;
    for (int i = 0; i < 4; ++i) add(bodies, box, {8, 0.151 + 0.301 * i, 0, 0});
    return bodies;
}

/// Adds one kind of stranger, at a place.
using Stranger = std::function<void(Bodies&, const Vec4&)>;

BodyType with(BodyType type, double friction, double restitution = 0, double rolling = 0) {
    type.friction = friction, type.restitution = restitution, type.rolling_friction = rolling;
    return type;
}

BodyType fixed(BodyType type) {
    type.fixed_position = type.fixed_rotation = true;
    return type;
}

struct Kind {
    const char* name;
    Stranger add_to;
};

std::vector<Kind> kinds() {
    const auto two = [](BodyType type) {  // that touch
        return [type](Bodies& bodies, const Vec4& at) {
            add(bodies, type, at);
            add(bodies, type, at + bounding_radius(type.shape) * Vec4::UnitX());
        };
    };
    return {
        {"slender", two(with(box_type({1, 1e-3, 1e-3, 1e-3}), 0.5))},
        {"a needle beyond floats", two(box_type({1, 1e-6, 1e-6, 1e-6}))},
        {"fixed", two(fixed(sphere_type(0.5)))},
        {"driven",
         [](Bodies& bodies, const Vec4& at) {
             add(bodies, fixed(sphere_type(0.5)), at, {1, 0, 0, 0}, {1, 0, 0, 0, 0, 0});
             add(bodies, sphere_type(0.5, 1, 0.5), at + 0.9 * Vec4::UnitX());
         }},
        {"huge", two(sphere_type(200, 1e9, 0.5))},
        {"tiny", two(sphere_type(1e-5, 1e-15, 0.5))},
        {"a mass beyond floats", two(sphere_type(0.5, 1e25, 0.5))},
        {"rolling", two(with(sphere_type(0.5), 0.5, 0, 0.05))},
        {"very rough", two(with(box_type(Vec4::Ones()), 5))},
        {"bouncing", two(with(sphere_type(0.5), 0.5, 1))},
        {"fast",
         [](Bodies& bodies, const Vec4& at) {
             add(bodies, sphere_type(0.01, 1, 0.5), at, {300, 0, 0, 0});
             add(bodies, fixed(box_type({0.01, 4, 4, 4})), at + 2 * Vec4::UnitX());
         }},
        {"whirling",
         [](Bodies& bodies, const Vec4& at) {
             add(bodies, box_type({0.3, 0.4, 0.5, 0.6}), at, Vec4::Zero(), {9, 8, -7, 6, 5, -4});
         }},
        {"a coin on its rim",
         [](Bodies& bodies, const Vec4& at) {
             Duocylinder coin;
             coin.radii = {0.5, 0.05};
             complete(coin);
             BodyType type = with(box_type(Vec4::Ones()), 0.5);
             type.shape = coin;
             add(bodies, fixed(box_type({4, 1, 4, 4})), at);
             add(bodies, type, at + 0.999 * Vec4::UnitY(), Vec4::Zero(), {3, 0, 0, 0, 0, 0});
         }},
        {"a lone one, of all freedoms", two(with(box_type({0.3, 0.4, 0.5, 0.6}), 0.7))},
    };
}

TEST(Strangers, FarAwayChangeNoBit) {
    for (const bool spheres_only : {true, false}) {
        const Bodies alone = heap_and_tower(spheres_only);
        Stepper world(alone, PhysicsSettings{});
        run(world, 150);
        EXPECT_GT(world.memory().impulses.size(), 50u);
        for (const Kind& kind : kinds()) {
            Bodies beside = alone;
            kind.add_to(beside, {0, kFar, kFar, 0});
            Stepper there(beside, PhysicsSettings{});
            run(there, 150);
            EXPECT_TRUE(same_bits(world.bodies(), part_of(there.bodies(), 0, alone.size())))
                << kind.name << (spheres_only ? ", spheres" : "");
        }
    }
}

/// How far ahead contacts of two bodies are looked for does not depend on how many pairs others
/// are.
TEST(Strangers, ThatAreManyPairsChangeNoMargin) {
    Bodies bodies;
    add(bodies, sphere_type(0.5), {0, 0, 0, 0}, {100, 0, 0, 0});
    add(bodies, sphere_type(0.5), {0, 1.2, 0, 0}, {100, 3, 0, 0});
    const Simulation simulation = make_simulation(bodies, PhysicsSettings{});
    StepData step;
    begin_step(simulation, step, kStep);
    advance_first_half(simulation, step, {0, 2});
    const Margins alone = margins_of(simulation, step, 0, 1);
    step.pairs.assign(100000, {0, 1});
    const Margins beside = margins_of(simulation, step, 0, 1);
    EXPECT_EQ(alone.as_they_move, beside.as_they_move);
    EXPECT_EQ(alone.if_one_stops, beside.if_one_stops);
    EXPECT_GT(alone.as_they_move, 0.01);
}

}  // namespace
}  // namespace tesserae
