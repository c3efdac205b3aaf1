// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/plain_directions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/dynamics/islands/islands.hpp"
#include "core/dynamics/solver/plain_rows.hpp"
#include "core/dynamics/step/step.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace tesserae::testing;

/// A row of balls of random masses on a fixed one. All move towards it, each at a speed of its own;
/// the last is the fastest.
struct Row {
    Simulation simulation;
    StepData step;
};
Row random_row(std::mt19937_64& random, BodyId balls) {
    Bodies bodies;
    BodyType wall = sphere_type(0.5);
    wall.fixed_position = wall.fixed_rotation = true;
    add(bodies, wall);
    for (BodyId id = 1; id <= balls; ++id) {
        const double mass = std::pow(10, uniform(random, -1.5, 1.5)), place = id;
        add(bodies, sphere_type(0.5, mass, 0.3), {place, 0, 0, 0}, {-place, 0, 0, 0});
    }
    std::vector<Contact> contacts(balls);
    for (BodyId id = 0; id < balls; ++id) {
        contacts[id].a = id, contacts[id].b = id + 1;
        contacts[id].normal = Vec4::UnitX();
        contacts[id].point = {id + 0.5, 0, 0, 0};
    }
    Row row{make_simulation(bodies, {}), {}};
    begin_step(row.simulation, row.step, kStep);
    row.step.position = row.simulation.bodies.position;
    row.step.rotor = row.simulation.bodies.rotor;
    row.step.velocity = row.simulation.bodies.velocity;
    row.step.angular_velocity = row.simulation.bodies.angular_velocity;
    row.step.contacts = ContactList(contacts);
    IslandBuilder(ColouredFrom(1000)).build(row.simulation, row.step);
    row.step.impulses.assign(balls, {});
    row.step.hit.assign(balls, 0);
    return row;
}

/// Returns the fastest ball once the compression has been swept so often.
double fastest_after(Row row, int sweeps, bool along) {
    PlainRows rows(row.simulation, row.step, 0);
    rows.start(Cause::kImpact, PlainRows::members());
    PerMember<Effort> efforts;
    efforts[0] = {sweeps, -1};
    if (along)
        rows.iterate_along_directions(Pass::kSolve, efforts, PlainRows::members(), [](Members) {});
    else
        rows.iterate(Pass::kSolve, efforts, PlainRows::members());
    double fastest = 0;
    for (const Vec4& velocity : row.step.velocity) fastest = std::max(fastest, velocity.norm());
    return fastest;
}

/// All balls stop, whatever they weigh. A row of n balls takes about n pairs of sweeps along
/// directions, and without them as many as the ratio of the masses. Where a step would lead too
/// far, directions are given up for a while, and the row takes longer.
TEST(PlainDirections, StopRowsOfUnequalMasses) {
    std::mt19937_64 random(61);
    int stop = 0, stop_without = 0;
    constexpr int kRows = 300;
    for (int i = 0; i < kRows; ++i) {
        const BodyId balls = 2 + static_cast<BodyId>(i) % 7;
        const Row row = random_row(random, balls);
        const int sweeps = 8 * static_cast<int>(balls);
        const double along = fastest_after(row, sweeps, true);
        const double without = fastest_after(row, sweeps, false);
        EXPECT_LE(along, without + 1e-9) << balls << " balls, row " << i;
        stop += along < 1e-9, stop_without += without < 1e-9;
    }
    EXPECT_GT(stop, kRows / 2);
    EXPECT_LT(stop_without, kRows / 20);
}

/// What a pair of sweeps changes of the bodies is what it changes of the impulses.
TEST(PlainDirections, KeepTheMomentumOfImpulses) {
    std::mt19937_64 random(62);
    for (int i = 0; i < 100; ++i) {
        Row row = random_row(random, 6);
        const std::vector<Vec4> before(row.step.velocity.begin(), row.step.velocity.end());
        PlainRows rows(row.simulation, row.step, 0);
        rows.start(Cause::kImpact, PlainRows::members());
        PerMember<Effort> efforts;
        efforts[0] = {30, -1};
        rows.iterate_along_directions(Pass::kSolve, efforts, PlainRows::members(), [](Members) {});
        rows.keep(PlainRows::members());
        for (BodyId id = 1; id <= 6; ++id) {
            const double mass = row.simulation.type_of(id).mass;
            const double pushes = row.step.hit[id - 1] - (id < 6 ? row.step.hit[id] : 0);
            EXPECT_NEAR(mass * (row.step.velocity[id][0] - before[id][0]), pushes,
                        1e-12 * (1 + row.step.hit[id - 1]));
        }
    }
}

}  // namespace
}  // namespace tesserae
