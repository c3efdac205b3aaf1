// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/members.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"
#include "tests/core/dynamics/part_of.hpp"

namespace tesserae {
namespace {

using namespace testing;
using Random = std::mt19937_64;

std::set<int> items_of(Members members) {
    std::set<int> items;
    for (const int member : members) items.insert(member);
    return items;
}

TEST(Members, AreASet) {
    Random random(3);
    std::bernoulli_distribution is_in(0.4);
    for (int round = 0; round < 200; ++round) {
        Members a, b;
        std::set<int> both, any, only_a;
        for (int i = 0; i < Members::kMost; ++i) {
            const bool in_a = is_in(random), in_b = is_in(random);
            if (in_a) a = a | Members::only(i);
            if (in_b) b = b | Members::only(i);
            if (in_a && in_b) both.insert(i);
            if (in_a || in_b) any.insert(i);
            if (in_a && !in_b) only_a.insert(i);
            EXPECT_EQ(a.has(i), in_a);
        }
        EXPECT_EQ(items_of(a & b), both);
        EXPECT_EQ(items_of(a | b), any);
        EXPECT_EQ(items_of(a - b), only_a);
        EXPECT_EQ(a.where([&](int i) { return b.has(i); }), a & b);
        EXPECT_EQ(a.has_all(b), (b - a) == Members{});
        EXPECT_EQ(a.any(), !items_of(a).empty());
    }
    EXPECT_EQ(items_of(Members::first(Members::kMost)).size(), std::size_t{Members::kMost});
}

/// Some bodies above each other that fall, hit, slide or rest, around a place.
void add_pile(Bodies& bodies, Random& random, const Vec4& at) {
    const int count = std::uniform_int_distribution<>(1, 6)(random);
    const bool rests = std::bernoulli_distribution(0.3)(random);
    const bool bounces = std::bernoulli_distribution(0.4)(random);
    const bool rough = std::bernoulli_distribution(0.8)(random);
    double height = 0;
    for (int i = 0; i < count; ++i) {
        const Vec4 size = Vec4::Constant(0.8) + random_vector(random, 0.25);
        BodyType type = box_type(size, uniform(random, 1, 20));
        if (i % 4 == 2) type = sphere_type(0.5 * size[1]);
        if (i % 4 == 3 && !rests) type = capsule_type(0.3, size[1] - 0.6);
        type.friction = rough ? uniform(random, 0, 0.9) : 0;
        type.restitution = bounces ? uniform(random, 0, 1) : 0;
        if (rests) {
            add(bodies, type, at + (height + 0.5 * size[1]) * Vec4::UnitY());
        } else {
            add(bodies, type,
                at + (height + 0.5 * size[1]) * Vec4::UnitY() + random_vector(random, 0.02),
                random_vector(random, uniform(random, 0, 3)),
                {uniform(random, -2, 2), uniform(random, -2, 2), 0, uniform(random, -1, 1), 0, 1});
        }
        height += size[1];
    }
}

/// A cluster of balls that falls apart.
void add_balls(Bodies& bodies, Random& random, const Vec4& at) {
    const int count = std::uniform_int_distribution<>(4, 16)(random);
    for (int i = 0; i < count; ++i) {
        const Vec4 place(i % 2, 0.6 + i / 8, i / 2 % 2, i / 4 % 2);
        BodyType type = sphere_type(0.5, uniform(random, 1, 20), uniform(random, 0, 0.7));
        type.restitution = std::max(0.0, uniform(random, -1, 0.5));
        add(bodies, type, at + place + random_vector(random, 0.02), random_vector(random, 0.3));
    }
}

Bodies floor() {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5, 0.5));
    return bodies;
}

/// How many groups of several islands a step had, and batches with lanes of several.
struct Shared {
    std::size_t groups = 0, batches = 0;

    void count(const ColouredIslands& coloured) {
        for (std::size_t i = 0; i + 1 < coloured.first_member.size(); ++i)
            groups += coloured.first_member[i + 1] - coloured.first_member[i] > 1;
        for (const auto* list : {&coloured.round, &coloured.general})
            for (const Batch& batch : *list) {
                if (items_of(batch.members).size() < 2) continue;
                ++batches;
                for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k)
                    EXPECT_EQ(batch.points[k], batch.rows);
            }
    }
};

/// Piles far from each other are in one group; a pile by itself is alone in its group.
TEST(Members, AreSolvedAsEachAlone) {
    for (const ColouredFrom& from : {ColouredFrom{}, ColouredFrom(1)}) {
        Bodies all = floor();
        std::vector<Bodies> alone;
        for (unsigned pile = 0; pile < 40; ++pile) {
            const Vec4 at(20.0 * pile, 0, 0, 0);
            Random random(pile), same(pile);
            const auto add = pile % 2 == 0 ? add_pile : add_balls;
            add(all, random, at);
            alone.push_back(floor());
            add(alone.back(), same, at);
        }
        Stepper together(make_simulation(all, PhysicsSettings{}), from);
        Shared shared;
        for (int i = 0; i < 180; ++i) {
            together.step(kStep);
            shared.count(together.last_step().coloured);
        }
        EXPECT_GT(shared.groups, 180u);
        EXPECT_GT(shared.batches, 180u);
        std::size_t first = 1;
        for (std::size_t pile = 0; pile < alone.size(); ++pile) {
            Stepper world(make_simulation(alone[pile], PhysicsSettings{}), from);
            run(world, 180);
            const std::size_t count = alone[pile].size() - 1;
            const Bodies now = part_of(world.bodies(), 1, count);
            const Bodies there = part_of(together.bodies(), first, count);
            EXPECT_TRUE(same_bits(now, there)) << "pile " << pile;
            first += count;
        }
    }
}

}  // namespace
}  // namespace tesserae
