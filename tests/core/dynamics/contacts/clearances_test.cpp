// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/clearances.hpp"

#include <gtest/gtest.h>

#include "core/contact/find_contacts.hpp"
#include "core/convex/convex_separation.hpp"
#include "core/dynamics/step/step.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

Rotor random_rotor(std::mt19937_64& random, double angle) {
    std::normal_distribution<> part;
    const Bivector plane{part(random), part(random), part(random),
                         part(random), part(random), part(random)};
    return exp(-0.5 * angle / norm(plane) * plane);
}

/// By their supports, whatever the pair's own function does.
double true_distance(const Simulation& simulation, const StepData& step, const BodyPair& pair) {
    const auto support_of = [&](BodyId id) {
        return [&simulation, &step, id, turn = to_matrix(step.rotor[id]),
                centre = Vec4(step.position[id] - step.position[0])](const Vec4& direction) {
            const Vec4 own = turn.transpose() * direction;
            return Vec4(centre +
                        turn * std::visit([&](const auto& s) { return Vec4(support(s, own)); },
                                          simulation.bodies.type_of(id).shape));
        };
    };
    const Vec4 between = step.position[pair.b] - step.position[pair.a];
    return separation_of(support_of(pair.a), support_of(pair.b), between,
                         simulation.type_of(pair.a).radius + simulation.type_of(pair.b).radius)
        .distance;
}

/// Some bodies wherever one puts them.
struct Placed {
    Simulation simulation;
    StepData step;
    Clearances clearances;
    Schedule serial;

    Placed() {
        Bodies bodies;
        add(bodies, box_type({1, 0.8, 0.6, 1.2}));
        add(bodies, box_type({2, 0.1, 0.5, 0.5}));
        add(bodies, regular_type(RegularPolychoron::k24Cell, 0.7));
        add(bodies, regular_type(RegularPolychoron::k5Cell, 0.8));
        simulation = make_simulation(bodies, without_gravity());
        begin_step(simulation, step, kStep);
        step.rotor.assign(4, Rotor{});
    }
    void place(std::mt19937_64& random, const Vec4& middle) {
        for (BodyId id = 0; id < 4; ++id) {
            step.position[id] = middle + random_vector(random, 2);
            step.rotor[id] = random_rotor(random, 3);
        }
    }
    /// All of them by some vector, and each by up to so much on its own.
    void move(std::mt19937_64& random, double together, double apart) {
        const Vec4 all = random_vector(random, together);
        for (BodyId id = 0; id < 4; ++id) {
            step.position[id] += all + random_vector(random, apart);
            step.rotor[id] = random_rotor(random, apart) * step.rotor[id];
        }
    }
};

/// However bodies move and whichever pairs are there, no more is left than the bodies' distance.
TEST(Clearances, AreNoMoreThanTheDistance) {
    std::mt19937_64 random(11);
    int known = 0, good = 0, steps = 0;
    for (int trial = 0; trial < 200; ++trial) {
        Placed bodies;
        StepData& step = bodies.step;
        bodies.place(random,
                     trial % 3 == 0 ? Vec4(random_vector(random, 1e4)) : Vec4(Vec4::Zero()));
        const double apart = std::pow(10.0, -1 - static_cast<int>(random() % 8));
        for (int i = 0; i < 50; ++i) {
            step.pairs.clear();
            for (BodyId a = 0; a < 4; ++a)
                for (BodyId b = a + 1; b < 4; ++b)
                    if (random() % 8 != 0) step.pairs.push_back({a, b});
            bodies.clearances.begin(bodies.simulation, step, bodies.serial);
            if (step.pairs.empty()) continue;
            Clearances::Search search(bodies.clearances, step.pairs[0]);
            for (std::size_t place = 0; place < step.pairs.size(); ++place) {
                const double left = search.left(step.pairs[place]);
                const double distance = true_distance(bodies.simulation, step, step.pairs[place]);
                // That of the two searches is good to a part of 1e-14 of the coordinates.
                EXPECT_LE(left, std::max(0.0, distance) + 1e-11) << trial << ' ' << i;
                known += left > 0, good += left > 0.5 * distance, ++steps;
                const bool searches = left == 0 || random() % 16 == 0;
                bodies.clearances.set(place, searches ? distance : left);
            }
            bodies.clearances.end(step, bodies.serial);
            bodies.move(random, 10, apart * (random() % 4 == 0 ? 1 : 1e-3));
        }
    }
    EXPECT_GT(known, steps / 2);
    EXPECT_GT(good, steps / 4);
}

/// Ways far below the last place of a float that holds the distance add up.
TEST(Clearances, SeeWhatCreeps) {
    Placed bodies;
    bodies.step.position = {Vec4::Zero(), Vec4::Constant(50), Vec4::Constant(100),
                            Vec4{2, 0, 0, 0}};
    bodies.step.pairs = {{0, 3}};
    const double first = true_distance(bodies.simulation, bodies.step, {0, 3});
    bodies.clearances.begin(bodies.simulation, bodies.step, bodies.serial);
    bodies.clearances.set(0, first);
    bodies.clearances.end(bodies.step, bodies.serial);
    const double way = 1e-9 * first;
    double left = first;
    for (int i = 1; i <= 100000; ++i) {
        bodies.step.position[3][0] -= way;
        bodies.clearances.begin(bodies.simulation, bodies.step, bodies.serial);
        left = Clearances::Search(bodies.clearances, {0, 3}).left({0, 3});
        ASSERT_LE(left, first - i * way + 1e-12);
        bodies.clearances.set(0, left);
        bodies.clearances.end(bodies.step, bodies.serial);
    }
    EXPECT_GT(left, 0.9 * first);
}

/// What moves together keeps its clearance; what is too far away for a float has none.
TEST(Clearances, AreOfBodiesAgainstEachOther) {
    for (const double far : {1.0, 1e35}) {
        Placed bodies;
        bodies.step.position = {Vec4::Zero(), Vec4::Constant(50), Vec4::Constant(100),
                                Vec4{3, 0, 0, 0}};
        bodies.step.pairs = {{0, 1}, {0, 3}};
        bodies.clearances.begin(bodies.simulation, bodies.step, bodies.serial);
        bodies.clearances.set(0, 40), bodies.clearances.set(1, 1);
        bodies.clearances.end(bodies.step, bodies.serial);
        for (Vec4& position : bodies.step.position) position += far * Vec4{1, -2, 3, 4};
        bodies.step.position[1] -= Vec4::Constant(1);
        bodies.clearances.begin(bodies.simulation, bodies.step, bodies.serial);
        Clearances::Search search(bodies.clearances, {0, 1});
        const double left[] = {search.left({0, 1}), search.left({0, 3})};
        EXPECT_NEAR(left[0], far == 1 ? 38 : 0, 1e-4);
        EXPECT_NEAR(left[1], far == 1 ? 1 : 0, 1e-5);
    }
}

/// The pair functions know how far bodies are apart of which they find no contacts.
TEST(Clearances, OfASearchAreTrue) {
    std::mt19937_64 random(12);
    int apart_pairs = 0;
    std::vector<Contact> list;
    Placed bodies;
    for (int trial = 0; trial < 3000; ++trial) {
        bodies.place(random, Vec4::Zero());
        const StepData& step = bodies.step;
        for (BodyId a = 0; a < 4; ++a)
            for (BodyId b = a + 1; b < 4; ++b) {
                const double margin = trial % 3 * 0.01;
                list.clear();
                const double apart = find_contacts(a, bodies.simulation.bodies.type_of(a).shape,
                                                   {step.position[a], step.rotor[a]}, b,
                                                   bodies.simulation.bodies.type_of(b).shape,
                                                   {step.position[b], step.rotor[b]}, margin, list);
                const double distance = true_distance(bodies.simulation, step, {a, b});
                EXPECT_LE(apart, std::max(0.0, distance) + 1e-8);
                if (!list.empty()) continue;
                EXPECT_GT(apart, margin);
                ++apart_pairs;
            }
    }
    EXPECT_GT(apart_pairs, 5000);
}

/// Boxes and polychora between walls, turning.
Bodies falling_heap(int fallen) {
    Bodies bodies = heap_of_spheres(fallen, 3);
    for (BodyId id = 0; id < bodies.size(); ++id) {
        if (!is_bounded(bodies.type_of(id).shape)) continue;
        BodyType type = id % 3 == 0 ? regular_type(RegularPolychoron::k16Cell, 0.5)
                                    : box_type({0.5, 0.6, 0.7, 0.4}, 60);
        type.friction = 0.5;
        bodies.rotor[id] = exp({0.1 * id, 0.2, 0.05 * id, -0.1, 0.3, 0.02 * id});
        bodies.angular_velocity[id] = {1, -0.5, 0.3, 0.2, -1, 0.7};
        give_type(bodies, id, type);
    }
    return bodies;
}

/// A world that has none in any step goes the same way.
void expect_clearances_change_no_motion(int fallen) {
    for (const int substeps : {1, 3}) {
        PhysicsSettings settings;
        settings.substeps = substeps;
        Stepper world(falling_heap(fallen), settings);
        for (int i = 0; i < 240; ++i) {
            Stepper without(world.bodies(), settings);
            without.memory() = world.memory();
            world.step(kStep);
            without.step(kStep);
            ASSERT_TRUE(same_bits(world.bodies(), without.bodies())) << i;
            ASSERT_TRUE(same_values(world.memory(), without.memory())) << i;
        }
    }
}

TEST(Clearances, ChangeNoMotion) { expect_clearances_change_no_motion(24); }
TEST(ClearancesSlow, ChangeNoMotion) { expect_clearances_change_no_motion(54); }

}  // namespace
}  // namespace tesserae
