// SPDX-License-Identifier: Apache-2.0
// Bodies are numbered by their place in storage, and contacts are solved in the order of the
// numbers: the order within an island is part of the result, that of different islands is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

constexpr int kTowers = 15, kSteps = 80;

struct Place {
    int tower, level;
};

/// Towers of one to five bodies of all shapes on a floor, which comes first.
Bodies towers(const std::vector<Place>& order) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (const auto& [tower, level] : order) {
        BodyType type = sphere_type(0.5, 1 + level % 3, 0.5, 0.1);
        if (tower % 3 == 1) type.shape = Hyperbox{{1, 1, 0.9, 1.1}};
        if (tower % 3 == 2) type.shape = Hypercapsule{0.5, 0.3};
        add(bodies, type,
            {3.0 * (tower % 7), 0.52 + 1.02 * level, 3.0 * (tower / 7), 0.03 * (level % 2)},
            {0, 0, 0, 0.02 * tower});
    }
    return bodies;
}

std::vector<Place> tower_by_tower() {
    std::vector<Place> order;
    for (int tower = 0; tower < kTowers; ++tower)
        for (int level = 0; level < 1 + tower % 5; ++level) order.push_back({tower, level});
    return order;
}

/// Towers mixed at random, each one's bodies still from the ground up.
std::vector<Place> mixed() {
    std::vector<Place> order = tower_by_tower();
    std::shuffle(order.begin(), order.end(), std::mt19937_64(19));
    std::map<int, int> next;
    for (Place& place : order) place.level = next[place.tower]++;
    return order;
}

/// The bodies where they are after the run, in the order tower by tower.
Bodies after_run(const std::vector<Place>& order, const PhysicsSettings& settings) {
    Stepper world(towers(order), settings);
    std::uint64_t contacts = 0;
    for (int i = 0; i < kSteps; ++i) contacts += world.step(1.0 / 240).contacts;
    EXPECT_GT(contacts, 100u * kSteps);
    std::vector<BodyId> ids(order.size());
    for (BodyId i = 0; i < ids.size(); ++i) ids[i] = i + 1;
    std::sort(ids.begin(), ids.end(), [&](BodyId i, BodyId j) {
        const Place &p = order[i - 1], &q = order[j - 1];
        return p.tower != q.tower ? p.tower < q.tower : p.level < q.level;
    });
    Bodies sorted;
    for (const BodyId id : ids) {
        sorted.position.push_back(world.bodies().position[id]);
        sorted.rotor.push_back(world.bodies().rotor[id]);
        sorted.velocity.push_back(world.bodies().velocity[id]);
        sorted.angular_velocity.push_back(world.bodies().angular_velocity[id]);
    }
    return sorted;
}

TEST(StorageOrder, OfSeparateIslandsChangesNoBitAndWithinAnIslandDoes) {
    for (PhysicsSettings settings : {PhysicsSettings{}, substepped_settings()})
        for (const bool sleeping : {false, true}) {
            settings.sleeping = sleeping;
            const Bodies one = after_run(tower_by_tower(), settings);
            EXPECT_TRUE(same_bits(one, after_run(mixed(), settings)));
            std::vector<Place> from_the_top = tower_by_tower();
            std::reverse(from_the_top.begin(), from_the_top.end());
            EXPECT_FALSE(same_bits(one, after_run(from_the_top, settings)));
        }
}

}  // namespace
}  // namespace tesserae
