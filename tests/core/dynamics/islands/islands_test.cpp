// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/islands/islands.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>

#include "core/dynamics/step/step.hpp"
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
        step.contacts = ContactList(contacts);
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
            std::vector<std::uint32_t> found;
            for (const std::uint32_t n : step.islands.runs_in(island)) {
                const ContactList::Run run = step.contacts.nth_run(n);
                for (std::size_t i = run.begin; i < run.end; ++i)
                    found.push_back(static_cast<std::uint32_t>(i));
            }
            EXPECT_EQ(found, list) << "round " << round;
            EXPECT_EQ(step.islands.contacts[island], list.size()) << "round " << round;
            ++island;
        }
    }
}

/// A row of spheres; the first one touches a fixed one, or not.
TEST(Islands, AreColouredFromFewerContactsWhereABodyIsHeld) {
    for (const bool held : {true, false})
        for (const std::uint32_t count :
             {kColouredFrom - 1, kColouredFrom, kFreeColouredFrom - 1, kFreeColouredFrom}) {
            Bodies bodies;
            BodyType first = sphere_type(1);
            first.fixed_position = first.fixed_rotation = held;
            add(bodies, first);
            std::vector<Contact> contacts(count);
            for (BodyId id = 0; id < count; ++id) {
                add(bodies, sphere_type(1));
                contacts[id].a = id, contacts[id].b = id + 1;
            }
            const Simulation simulation = make_simulation(bodies, PhysicsSettings{});
            StepData step;
            step.contacts = ContactList(contacts);
            IslandBuilder builder;
            builder.build(simulation, step);
            ASSERT_EQ(step.islands.size(), 1u);
            EXPECT_EQ(step.islands.held[0], held);
            EXPECT_EQ(step.islands.is_coloured(0),
                      count >= (held ? kColouredFrom : kFreeColouredFrom))
                << count;
        }
}

/// A sphere on another on a fixed one, or on one that is free.
TEST(Islands, OfUnequalMassesAreColouredWhereTheyGoAlongConjugateDirections) {
    for (const double friction : {0.5, 3.0})
        for (const bool held : {true, false})
            for (const double mass : {0.3, 0.5, 2.0, 3.0}) {
                Bodies bodies;
                BodyType first = sphere_type(1);
                first.fixed_position = first.fixed_rotation = held;
                add(bodies, first);
                add(bodies, sphere_type(1, 1, friction));
                add(bodies, sphere_type(1, mass, friction));
                std::vector<Contact> contacts(2);
                contacts[0].b = contacts[1].a = 1, contacts[1].b = 2;
                const Simulation simulation = make_simulation(bodies, {});
                StepData step;
                step.contacts = ContactList(contacts);
                IslandBuilder().build(simulation, step);
                ASSERT_EQ(step.islands.size(), 1u);
                EXPECT_EQ(step.islands.is_coloured(0),
                          held && std::abs(std::log(mass)) > std::log(kUnequalMasses) &&
                              friction <= kMostConjugateFriction)
                    << mass << " " << held;
            }
}

/// What grips or resists rolling elsewhere does not matter, nor what does not touch its like.
TEST(Islands, GoAlongConjugateDirectionsEachByItsOwnPairs) {
    const auto rough = [](double friction, double rolling) {
        BodyType type = sphere_type(1, 1, friction);
        type.rolling_friction = rolling;
        return type;
    };
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    add(bodies, rough(0.5, 0)), add(bodies, rough(3, 0));    // sqrt(0.5 3) of friction
    add(bodies, rough(3, 0)), add(bodies, rough(3, 0));      // 3
    add(bodies, rough(0.5, 0)), add(bodies, rough(0.5, 1));  // rolling friction
    std::vector<Contact> contacts(3);
    for (BodyId i = 0; i < 3; ++i) contacts[i].a = 1 + 2 * i, contacts[i].b = 2 + 2 * i;
    StepData step;
    step.contacts = ContactList(contacts);
    IslandBuilder().build(make_simulation(bodies, {}), step);
    ASSERT_EQ(step.islands.size(), 3u);
    EXPECT_EQ(step.islands.conjugates, (std::vector<std::uint8_t>{1, 0, 0}));
}

/// Where a driven body and another one that contacts do not move may squeeze a body, there may be
/// no motion that suits both.
TEST(Islands, GoAlongConjugateDirectionsWhereNothingIsSqueezed) {
    for (const bool driven : {false, true})
        for (const bool second : {false, true}) {
            BodyType held = sphere_type(1);
            held.fixed_position = held.fixed_rotation = true;
            Bodies bodies;
            add(bodies, held, Vec4::Zero(), (driven ? 0.5 : 0.0) * Vec4::UnitX());
            add(bodies, sphere_type(1)), add(bodies, sphere_type(1));
            add(bodies, held);
            std::vector<Contact> contacts(second ? 3 : 2);
            for (BodyId i = 0; i < contacts.size(); ++i) contacts[i].a = i, contacts[i].b = i + 1;
            StepData step;
            step.contacts = ContactList(contacts);
            IslandBuilder().build(make_simulation(bodies, {}), step);
            ASSERT_EQ(step.islands.size(), 1u);
            EXPECT_EQ(step.islands.conjugates[0], !(driven && second)) << driven << second;
        }
}

/// Body 0 is fixed, body 1 touches all others, and these touch at random, spheres and boxes, in one
/// to eight points.
TEST(Islands, OfManyContactsAreMadeIntoBatchesThatShareNoMovableBody) {
    std::mt19937_64 engine(7);
    Bodies bodies;
    constexpr BodyId kCount = 700;
    BodyType fixed = sphere_type(1);
    fixed.fixed_position = fixed.fixed_rotation = true;
    for (BodyId id = 0; id < kCount; ++id)
        add(bodies, id == 0 ? fixed : id % 2 == 0 ? sphere_type(1) : box_type({1, 2, 3, 4}));
    StepData step;
    std::size_t pairs = 0;
    for (BodyId a = 0; a < kCount; ++a)
        for (BodyId b = a + 1; b < kCount; ++b)
            if (a < 2 || engine() % 100 == 0) {
                const std::uint64_t points = a % 2 == 0 && b % 2 == 0 ? 1 : 1 + engine() % 8;
                for (std::uint32_t i = 0; i < points; ++i) {
                    Contact contact;
                    contact.a = a, contact.b = b, contact.feature = i;
                    step.contacts.push_back(contact);
                }
                ++pairs;
            }
    const Simulation simulation = make_simulation(bodies, PhysicsSettings{});
    IslandBuilder builder;
    builder.build(simulation, step);
    const std::vector<Batch> first_time = step.coloured.general;
    builder.build(simulation, step);
    ASSERT_TRUE(same_bits(step.coloured.general, first_time)) << "depends on the step before";

    ASSERT_EQ(step.islands.size(), 1u);
    ASSERT_TRUE(step.islands.is_coloured(0));
    const ColouredIslands& coloured = step.coloured;
    std::vector<int> seen(step.contacts.size());
    std::size_t batched_pairs = 0, left_over = 0;
    for (std::size_t colour = 0; colour < coloured.colours.size(); ++colour) {
        const bool is_leftover = colour + 1 == coloured.colours.size();
        std::vector<bool> used(kCount, false);
        const auto check = [&](const std::vector<Batch>& batches, BatchRange range, bool round) {
            for (std::uint32_t i = range.begin; i < range.end; ++i)
                for (std::size_t k = 0; k < kLanes && batches[i].points[k] > 0; ++k) {
                    const Batch& batch = batches[i];
                    const Contact& first = step.contacts[batch.contact[k]];
                    ASSERT_LE(batch.points[k], batch.rows);
                    for (std::uint32_t p = 0; p < batch.points[k]; ++p) {
                        const Contact& contact = step.contacts[batch.contact[k] + p];
                        ASSERT_EQ(contact.a, first.a);
                        ASSERT_EQ(contact.b, first.b);
                        ++seen[batch.contact[k] + p];
                    }
                    ASSERT_EQ(round, first.a % 2 == 0 && first.b % 2 == 0);
                    ASSERT_EQ(coloured.bodies[batch.b[k]], first.b);
                    ASSERT_EQ(batch.a[k] == 0, first.a == 0) << "only body 0 does not move";
                    if (first.a > 0) {
                        ASSERT_EQ(coloured.bodies[batch.a[k]], first.a);
                    }
                    ++batched_pairs, left_over += is_leftover;
                    for (const BodyId id : {first.a, first.b}) {
                        if (id == 0 || is_leftover) continue;
                        ASSERT_FALSE(used[id]);
                        used[id] = true;
                    }
                }
        };
        check(coloured.round, coloured.colours[colour].round, true);
        check(coloured.general, coloured.colours[colour].general, false);
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ssize(seen)) << "each contact once";
    EXPECT_EQ(batched_pairs, pairs);
    // 64 colours hold 64 of body 1's pairs, 699 in all; those of the others fit.
    EXPECT_EQ(coloured.colours.size(), 65u);
    EXPECT_EQ(left_over, 699u - 64u);
}

}  // namespace
}  // namespace tesserae
