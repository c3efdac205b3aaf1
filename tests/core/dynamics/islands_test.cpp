#include "core/dynamics/islands.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>

#include "core/dynamics/step.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// Lowest movable body that each movable body is joined to: labels spread until none changes.
std::vector<BodyId> spread_labels(const Bodies& bodies, const std::vector<Contact>& contacts) {
    std::vector<BodyId> label(bodies.size());
    for (BodyId id = 0; id < bodies.size(); ++id) label[id] = id;
    for (bool changed = true; changed;) {
        changed = false;
        for (const Contact& c : contacts) {
            if (!bodies.is_movable(c.a) || !bodies.is_movable(c.b)) continue;
            const BodyId lowest = std::min(label[c.a], label[c.b]);
            changed = changed || label[c.a] != lowest || label[c.b] != lowest;
            label[c.a] = label[c.b] = lowest;
        }
    }
    return label;
}

TEST(Islands, AreTheConnectedPartsNumberedByTheirLowestBody) {
    std::mt19937_64 engine(5);
    for (int round = 0; round < 300; ++round) {
        Bodies bodies;
        const auto count = static_cast<BodyId>(2 + engine() % 60);
        BodyType fixed = sphere_type(1);
        fixed.fixed_position = fixed.fixed_rotation = true;
        for (BodyId id = 0; id < count; ++id)
            add(bodies, engine() % 5 == 0 ? fixed : sphere_type(1));
        std::vector<Contact> contacts;
        for (std::uint64_t i = 0, n = engine() % 80; i < n; ++i) {
            Contact c;
            c.a = static_cast<BodyId>(engine() % count);
            c.b = static_cast<BodyId>(engine() % count);
            if (c.a > c.b) std::swap(c.a, c.b);
            if (c.a != c.b && (bodies.is_movable(c.a) || bodies.is_movable(c.b)))
                contacts.push_back(c);
        }
        const auto key = [](const Contact& c) { return std::tie(c.a, c.b); };
        std::sort(contacts.begin(), contacts.end(),
                  [&](const Contact& p, const Contact& q) { return key(p) < key(q); });

        const Simulation simulation = make_simulation(bodies, PhysicsSettings{});
        StepData step;
        step.contacts = contacts;
        IslandBuilder builder;
        builder.build(simulation, step);

        const std::vector<BodyId> label = spread_labels(bodies, contacts);
        std::map<BodyId, std::vector<std::uint32_t>> expected;
        for (std::uint32_t i = 0; i < contacts.size(); ++i) {
            const Contact& c = contacts[i];
            expected[label[bodies.is_movable(c.a) ? c.a : c.b]].push_back(i);
        }
        ASSERT_EQ(step.islands.size(), expected.size());
        std::size_t island = 0;
        for (const auto& [lowest, list] : expected) {
            const auto begin = step.islands.contacts.begin() + step.islands.first[island];
            const auto end = step.islands.contacts.begin() + step.islands.first[island + 1];
            EXPECT_EQ(std::vector<std::uint32_t>(begin, end), list) << "round " << round;
            ++island;
        }
    }
}

/// Body 0 is fixed, body 1 touches all others, and these touch at random.
TEST(Islands, OfManyContactsAreSortedByColoursThatShareNoMovableBody) {
    std::mt19937_64 engine(7);
    Bodies bodies;
    constexpr BodyId kCount = 700;
    BodyType fixed = sphere_type(1);
    fixed.fixed_position = fixed.fixed_rotation = true;
    for (BodyId id = 0; id < kCount; ++id) add(bodies, id == 0 ? fixed : sphere_type(1));
    StepData step;
    for (BodyId a = 0; a < kCount; ++a)
        for (BodyId b = a + 1; b < kCount; ++b)
            if (a < 2 || engine() % 100 == 0) {
                Contact contact;
                contact.a = a, contact.b = b;
                step.contacts.push_back(contact);
            }
    IslandBuilder builder;
    builder.build(make_simulation(bodies, PhysicsSettings{}), step);

    const Islands& islands = step.islands;
    ASSERT_EQ(islands.size(), 1u);
    ASSERT_GE(step.contacts.size(), kColouredFrom);
    ASSERT_TRUE(islands.is_coloured(0));
    std::vector<std::uint32_t> all = islands.contacts;
    std::sort(all.begin(), all.end());
    for (std::uint32_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i) << "a permutation";

    std::size_t begin = 0;
    for (const std::uint32_t end : islands.colours) {
        ASSERT_LT(begin, end);
        std::vector<bool> used(kCount, false);
        for (std::size_t i = begin; i < end; ++i) {
            const Contact& contact = step.contacts[islands.contacts[i]];
            for (const BodyId id : {contact.a, contact.b}) {
                if (id == 0) continue;
                ASSERT_FALSE(used[id]);
                used[id] = true;
            }
            if (i > begin) {
                ASSERT_LT(islands.contacts[i - 1], islands.contacts[i]) << "in their order";
            }
        }
        begin = end;
    }
    // 64 colours hold 64 of body 1's contacts, 700 in all; those of the others fit.
    EXPECT_EQ(islands.colours.size(), 64u);
    EXPECT_EQ(step.contacts.size() - begin, 699u - 64u);
}

}  // namespace
}  // namespace tesserae
