// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/constraints/contact_row.hpp"
#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/stepper.hpp"
#include "core/shape/cubinder.hpp"
#include "core/shape/spherinder.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

PhysicsSettings impulse() { return PhysicsSettings{}; }

/// Unit boxes on each other on a floor at place[1].
Bodies tower(const std::vector<double>& masses, const Vec4& place = Vec4::Zero()) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), place[1], 0.5));
    double y = 0.5;
    for (const double mass : masses) {
        BodyType type = box_type(Vec4::Ones(), mass);
        type.friction = 0.5;
        add(bodies, type, place + Vec4(0, y++, 0, 0));
    }
    return bodies;
}

/// How far any centre has moved after a time [m].
double moved(const Bodies& bodies, const PhysicsSettings& settings, double seconds) {
    Stepper world(bodies, settings);
    for (int i = 0; i < 240 * seconds; ++i) world.step(1.0 / 240);
    double most = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        most = std::max(most, (world.bodies().position[i] - bodies.position[i]).norm());
    return most;
}

// The solver leaves overlaps of up to 0.0025 m alone between unit boxes.
constexpr double kSlopOfBox = 0.0025;

TEST(Extreme, ALightBoxStandsOnOneAMillionTimesHeavier) {
    EXPECT_LT(moved(tower({1e6, 1}), impulse(), 2), kSlopOfBox);
    EXPECT_LT(moved(tower({1e6, 1}), substepped_settings(), 2), kSlopOfBox);
}

TEST(Extreme, AHeavyBoxStandsOnOneAHundredTimesLighter) {
    EXPECT_LT(moved(tower({1, 100}), substepped_settings(), 4), 2 * kSlopOfBox);
}

TEST(Extreme, FortyBoxesStand) {
    const Bodies bodies = tower(std::vector<double>(40, 1000.0));
    // It sways: the top by less than a quarter of a box.
    EXPECT_LT(moved(bodies, impulse(), 3), 0.25);
    EXPECT_LT(moved(bodies, substepped_settings(), 3), 0.25);
}

TEST(Extreme, SizesFromAMillimetreToAKilometreRestInOneScene) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    double x = 0;
    for (const double radius : {0.0005, 0.05, 5.0, 500.0}) {
        x += 1.5 * radius;
        add(bodies, sphere_type(radius, 1000 * std::pow(radius, 4), 0.5), {x, radius, 0, 0});
        x += 1.5 * radius;
    }
    EXPECT_LT(moved(bodies, impulse(), 2), 0.005 * 0.0005);
    EXPECT_LT(moved(bodies, substepped_settings(), 2), 0.005 * 0.0005);
}

TEST(Extreme, AThousandTimesTheGravityPressesABoxNoDeeperThanItsSlop) {
    PhysicsSettings settings = substepped_settings();
    settings.gravity = {0, -1e4, 0, 0};
    EXPECT_LT(moved(tower({1000}), settings, 2), kSlopOfBox);
}

TEST(Extreme, ATowerFarFromTheOriginStandsAsWellAsOneNearIt) {
    const std::vector<double> masses(5, 1000.0);
    const double near = moved(tower(masses), substepped_settings(), 2);
    const double far = moved(tower(masses, {1e5, -1e5, 1e5, 1e5}), substepped_settings(), 2);
    // Coordinates are rounded to 1.5e-11 m there, and noise like that is what a tower settles from.
    EXPECT_LT(near, kSlopOfBox);
    EXPECT_LT(far, kSlopOfBox);
}

TEST(Extreme, ElasticSpheresKeepTheirEnergyForAHundredThousandSteps) {
    Bodies bodies;
    for (int axis = 0; axis < 4; ++axis)
        for (const double side : {-1.0, 1.0})
            add(bodies, plane_type(side * Vec4::Unit(axis), -2, 0, 1));
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<> along(-2, 2);
    for (int i = 0; i < 12; ++i) {
        const Vec4 x{1.2 * (i % 3 - 1), 1.2 * (i / 3 % 2), 1.2 * (i / 6 % 2), 0};
        Vec4 v;
        for (int k = 0; k < 4; ++k) v[k] = along(engine);
        add(bodies, sphere_type(0.3, 1, 0, 1), x, v);
    }
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(bodies, settings);
    const double start = kinetic_energy(bodies);
    for (int i = 0; i < 100000; ++i) world.step(1.0 / 240);
    // Single bounces are exact; two at once of the same sphere are solved in turn, which loses or
    // adds a little.
    EXPECT_NEAR(kinetic_energy(world.bodies()) / start, 1, 1e-3);
}

/// Friction has no part in it: a box that has sunk in with one edge turns about its centre, and its
/// edge moves freely.
TEST(Extreme, OverlapIsPushedOutAlongTheNormals) {
    for (const std::uint32_t coloured_from : {1u, 1000u}) {
        BodyType box = box_type(Vec4::Ones());
        box.friction = 1;
        const double lean = 0.1, lowest = 0.5 * (std::cos(lean) + std::sin(lean));
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 1));
        add(bodies, box, {0, lowest - 20 * kSlopOfBox, 0, 0}, Vec4::Zero(), {},
            exp(Bivector{-lean / 2, 0, 0, 0, 0, 0}));
        PhysicsSettings settings;
        settings.gravity.setZero();
        Stepper world(make_simulation(bodies, settings), ColouredFrom(coloured_from));
        world.step(1.0 / 240);
        const Vec4 moved = world.bodies().position[1] - bodies.position[1];
        EXPECT_GT(moved.y(), 1e-4);
        EXPECT_LT(std::abs(moved.x()), 0.02 * moved.y());
    }
}

/// What overlaps rests, and is in what it touches by no more than the solver leaves alone, 4 s on.
void expect_pushed_out(const Bodies& bodies) {
    Stepper world(bodies, impulse());
    StepReport report;
    for (int i = 0; i < 960; ++i) report = world.step(1.0 / 240);
    EXPECT_LT(report.penetration, 0.5 * kSlopOfBox);
    EXPECT_LT(world.bodies().velocity[1].norm(), 1e-3);
}

/// It was pushed out of one overlap into the other: after 4 s 36 mm were left.
TEST(Extreme, OverlapUnderAHeavyBodyIsPushedOut) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (const double mass : {1.0, 100.0}) {
        BodyType board = box_type({2, 0.2, 1, 1}, mass);
        board.friction = 0.5;
        add(bodies, board, {0, mass > 1 ? 0.24 : 0.07, 0, 0});
    }
    expect_pushed_out(bodies);
}

/// Between a fixed box that leans by 20 degrees and a wall: it went deeper in, to a quarter of its
/// size, and trembled there.
TEST(Extreme, OverlapInANarrowWedgeIsPushedOut) {
    BodyType box = box_type({0.45, 0.45, 1, 0.45}), fixed = box;
    fixed.fixed_position = fixed.fixed_rotation = true;
    const Rotor lean = exp(Bivector{-M_PI / 18, 0, 0, 0, 0, 0});
    Bodies bodies;
    add(bodies, fixed, Vec4::Zero(), Vec4::Zero(), {}, lean);
    add(bodies, box, {0.33992, 0.37593, 0, 0}, Vec4::Zero(), {}, lean);
    add(bodies, plane_type(-Vec4::UnitX(), -0.60031));
    expect_pushed_out(bodies);
}

/// Between walls that leave them too little room: every step pressed them together more, until they
/// burst apart at up to 44 m/s. With small
/// steps one is lifted out, and what lies on it rolls off as fast.
TEST(ExtremeSlow, WhatCannotPartDoesNotBurstApart) {
    const double radius = 0.3;
    for (const double steps : {240.0, 960.0})
        for (const double overlap : {0.004, 0.01, 0.02}) {
            const double side = (1 - overlap) * radius, up = std::sqrt(3.0) * side;
            Bodies bodies;
            add(bodies, plane_type(Vec4::UnitY(), 0, 0.3));
            for (const double x : {1.0, -1.0})
                add(bodies, plane_type(x * Vec4::UnitX(), -2 * side, 0.3));
            BodyType log = sphere_type(radius, 1);
            log.friction = 0.3;
            Cubinder shape;
            shape.radius = radius, shape.size = {1.7, 1.7};
            complete(shape);
            log.shape = shape;
            add(bodies, log, {-side, 0.99 * side, 0, 0});
            add(bodies, log, {side, 0.99 * side, 0.01, 0});
            add(bodies, log, {0.02 * side, side + up, 0, 0.01});
            Stepper world(bodies, impulse());
            double fastest = 0;
            for (int i = 0; i < 3 * steps; ++i) {
                world.step(1 / steps);
                for (const Vec4& v : world.bodies().velocity) fastest = std::max(fastest, v.norm());
            }
            EXPECT_LT(fastest, steps < 500 ? 0.2 : kFastestCorrection * radius)
                << steps << " steps/s, overlap " << overlap;
        }
}

TEST(Extreme, BodiesThatStartDeepInEachOtherDoNotExplode) {
    for (const PhysicsSettings& given : {impulse(), substepped_settings()}) {
        PhysicsSettings settings = given;
        settings.gravity.setZero();
        Bodies bodies;
        for (int i = 0; i < 8; ++i)
            add(bodies, sphere_type(0.5, 1000, 0.5), {0.01 * i, 0.01 * i, 0.005 * (i % 3), 0});
        Stepper world(bodies, settings);
        double fastest = 0;
        for (int i = 0; i < 960; ++i) {
            world.step(1.0 / 240);
            for (const Vec4& v : world.bodies().velocity) fastest = std::max(fastest, v.norm());
        }
        // In a row of eight, neighbours part at the largest push of 4 half-sizes a second, 2 m/s:
        // the outer ones at 7/2 of it.
        EXPECT_LT(fastest, 3.5 * kFastestCorrection * 0.5);
        for (BodyId a = 0; a < 8; ++a)
            for (BodyId b = a + 1; b < 8; ++b)
                EXPECT_GT((world.bodies().position[a] - world.bodies().position[b]).norm(),
                          1 - 1.1 * 0.005 * 0.5);
    }
}

TEST(Extreme, ACapsuleTenThousandTimesAsLongAsWideLiesStill) {
    Bodies bodies;
    BodyType type;
    type.shape = Hypercapsule{0.01, 200};
    type.mass = 10;
    type.friction = 0.5;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    add(bodies, type, {0, 0.01, 0, 0}, Vec4::Zero(), {}, exp(Bivector{0.25 * pi}));
    // 0.005 of its radius is left alone.
    EXPECT_LT(moved(bodies, impulse(), 2), 0.005 * 0.01);
    EXPECT_LT(moved(bodies, substepped_settings(), 2), 0.005 * 0.01);
}

/// How far a body dropped from 0.3 m gets below a floor at 0, and how much energy it wins.
std::pair<double, double> sunk_and_won(const BodyType& type, const Rotor& rotor, bool on_box,
                                       const PhysicsSettings& settings) {
    Bodies bodies;
    if (on_box) {
        BodyType floor = box_type({20, 1, 20, 20});
        floor.friction = type.friction;
        floor.fixed_position = floor.fixed_rotation = true;
        add(bodies, floor, {0.3, -0.5, 0.2, 0.1});
    } else {
        add(bodies, plane_type(Vec4::UnitY(), 0, type.friction));
    }
    const auto height = [&](const Rotor& r) {
        return std::visit([&](const auto& s) { return half_extents(s, to_matrix(r))[1]; },
                          type.shape);
    };
    const BodyId body =
        add(bodies, type, {0, height(rotor) + 0.3, 0, 0}, {0.3, 0, 0.1, 0}, {}, rotor);
    Stepper world(bodies, settings);
    const auto energy = [&] {
        return kinetic_energy(world.bodies()) -
               type.mass * kDown.dot(world.bodies().position[body]);
    };
    const double start = energy();
    double most = start;
    for (int i = 0; i < 360; ++i) {
        world.step(kStep);
        most = std::max(most, energy());
    }
    return {height(world.bodies().rotor[body]) - world.bodies().position[body][1], most - start};
}

/// Lands bodies much thinner across two or three axes than along the others.
void expect_slender_bodies_stay(double thin, double friction, bool on_box,
                                const PhysicsSettings& settings) {
    const Rotor turned = exp(Bivector{0.1, 0.2, 0, 0.1, 0.05, 0.3});
    const std::pair<BodyType, Rotor> bodies[] = {{box_type({1, thin, thin, 1}), {}},
                                                 {box_type({1, 1, thin, thin}), turned},
                                                 {box_type({1, thin, 1, 1}), {}},
                                                 {capsule_type(thin, 1), exp(Bivector{0.25 * pi})}};
    for (auto [type, rotor] : bodies) {
        type.friction = friction;
        const auto [sunk, won] = sunk_and_won(type, rotor, on_box, settings);
        // Less than it falls in the step in which it lands (1.7 mm were seen).
        EXPECT_LT(sunk, std::sqrt(2 * 10 * 0.3) * kStep)
            << thin << " m " << friction << " " << on_box;
        EXPECT_LT(won, 1e-9) << thin << " m " << friction << " " << on_box;
    }
}

/// Every two of width, friction, floor and solver together, of which the slow test has all four.
TEST(Extreme, SlenderBodiesLandAndStay) {
    expect_slender_bodies_stay(1e-4, 0, false, impulse());
    expect_slender_bodies_stay(1e-4, 0.5, true, substepped_settings());
    expect_slender_bodies_stay(1e-9, 0, true, substepped_settings());
    expect_slender_bodies_stay(1e-9, 0.5, false, substepped_settings());
    expect_slender_bodies_stay(1e-9, 0.5, true, impulse());
}

/// Corners of the upper face took the places of those of the lower one: every fourth lay in the
/// floor, whole, for ever.
void expect_cards_lie(int bodies_thrown) {
    std::mt19937_64 random(3);
    for (int i = 0; i < bodies_thrown; ++i) {
        const double thin = std::pow(10, uniform(random, -5, -3)), size = uniform(random, 0.2, 1.5);
        BodyType type = box_type({size, thin, 0.8 * size, 0.6 * size});
        Cubinder disc;
        disc.radius = 0.5 * size, disc.size = {thin, size};
        complete(disc);
        Spherinder coin;
        coin.radius = 0.5 * size, coin.height = thin;
        complete(coin);
        if (i % 3 == 1) type.shape = disc;
        if (i % 3 == 2) type.shape = coin;
        type.friction = 0.5;
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        const Vec4 a = random_vector(random, 2), b = random_vector(random, 2);
        const BodyId body = add(bodies, type, {0, 1.2 * size + 0.1, 0, 0}, Vec4::Zero(), {},
                                exp(Bivector{a[0], a[1], a[2], b[0], b[1], b[2]}));
        Stepper world(bodies, impulse());
        run(world, 960);
        EXPECT_GT(world.bodies().position[body][1], 0.3 * thin)
            << i << ": " << thin << " m, " << size << " m";
    }
}

TEST(Extreme, CardsAndDiscsThatTumbleOntoAPlaneLieOnIt) { expect_cards_lie(12); }
TEST(ExtremeSlow, CardsAndDiscsThatTumbleOntoAPlaneLieOnIt) { expect_cards_lie(36); }

/// The most energy that bodies win from any time on, as a part of what they begin with.
double part_won(const Bodies& bodies, double seconds, double step) {
    Stepper world(bodies, impulse());
    const auto energy = [&] {
        return kinetic_energy(world.bodies()) + potential_energy(world.bodies(), kDown);
    };
    const double start = energy();
    double least = start, most_won = 0;
    for (double t = 0; t < seconds; t += step) {
        world.step(step);
        least = std::min(least, energy());
        most_won = std::max(most_won, energy() - least);
    }
    return most_won / start;
}

/// Rods and boards poured on each other: what turns them about their length is up to a million
/// times what turns them across it, which rounding must not mix up.
void expect_rods_gain_nothing(int scenes) {
    std::mt19937_64 random(5);
    for (int scene = 0; scene < scenes; ++scene) {
        const double thin = std::pow(10, uniform(random, -3, -1.5));
        const double step = scene % 2 == 0 ? 1.0 / 60 : kStep;
        const double friction = uniform(random, 0.2, 0.9);
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, friction));
        for (int i = 0; i < 5; ++i) {
            Vec4 size = Vec4::Constant(thin);
            size[i % 4] = 1;
            if (scene % 4 == 3) size[(i + 1) % 4] = 1;
            BodyType type = box_type(size, uniform(random, 0.5, 5));
            type.friction = friction;
            const Vec4 a = random_vector(random, 2), b = random_vector(random, 2);
            const Vec4 aside = random_vector(random, 0.2);
            add(bodies, type, {aside[0], 0.8 + 0.7 * i, aside[2], aside[3]}, Vec4::Zero(), {},
                exp(Bivector{a[0], a[1], a[2], b[0], b[1], b[2]}));
        }
        EXPECT_LT(part_won(bodies, 1.5, step), 1e-3) << scene << ": " << thin << " m";
    }
}

TEST(Extreme, RodsThatFallAcrossEachOtherGainNoEnergy) { expect_rods_gain_nothing(12); }
TEST(ExtremeSlow, RodsThatFallAcrossEachOtherGainNoEnergy) { expect_rods_gain_nothing(40); }

/// A coin, a disc, a needle or a card.
Shape thin_shape(int kind, double thin) {
    Spherinder coin, needle;
    coin.radius = 0.15, coin.height = thin;
    needle.radius = 0.5 * thin, needle.height = 0.3;
    Cubinder disc;
    disc.radius = 0.15, disc.size = {thin, thin};
    complete(coin), complete(needle), complete(disc);
    if (kind % 4 == 0) return coin;
    if (kind % 4 == 1) return needle;
    if (kind % 4 == 2) return disc;
    return box_type({0.3, thin, 0.3, 0.3}).shape;
}

/// Discs, coins and needles of 0.3 to 10 % of their width, poured: masses of up to 1:10^4, of which
/// sweeps do not find the load. What they find then is no gain.
void expect_thin_bodies_gain_nothing(int scenes) {
    std::mt19937_64 random(7);
    for (int scene = 0; scene < scenes; ++scene) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        for (int i = 0; i < 8; ++i) {
            const double thin = 0.3 * std::pow(10, uniform(random, -2.5, -1));
            BodyType type;
            type.shape = thin_shape(i, thin);
            type.friction = 0.5;
            type.mass = 1000 * std::visit([](const auto& of) { return volume(of); }, type.shape);
            const Vec4 a = random_vector(random, 2), b = random_vector(random, 2);
            const Vec4 aside = random_vector(random, 0.1);
            add(bodies, type, {aside[0], 0.2 + 0.1 * i, aside[2], aside[3]}, Vec4::Zero(), {},
                exp(Bivector{a[0], a[1], a[2], b[0], b[1], b[2]}));
        }
        EXPECT_LT(part_won(bodies, 1, kStep), 1e-3) << scene;
    }
}

TEST(Extreme, ThinBodiesOfUnequalMassesThatArePouredGainNoEnergy) {
    expect_thin_bodies_gain_nothing(1);
}

TEST(ExtremeSlow, ThinBodiesOfUnequalMassesThatArePouredGainNoEnergy) {
    expect_thin_bodies_gain_nothing(5);
}

TEST(ExtremeSlow, SlenderBodiesOfAnyWidthLandAndStay) {
    for (const double thin : {1e-4, 1e-5, 1e-6, 1e-9})
        for (const double friction : {0.0, 0.5})
            for (const bool on_box : {false, true})
                for (const PhysicsSettings& settings : {impulse(), substepped_settings()})
                    expect_slender_bodies_stay(thin, friction, on_box, settings);
}

TEST(Extreme, InertiaIsThatOfTheShapeDownToAspectsOfAThousand) {
    const double thin = 1e-3;
    Bodies bodies;
    add(bodies, box_type({1, thin, thin, 1}, 3));
    add(bodies, box_type({1, 1e-7, 1e-7, 1}, 3));
    const auto types = type_properties(bodies);
    const Vec4 moments = second_moments(Hyperbox{{1, thin, thin, 1}}, 3);
    EXPECT_EQ(types[0].inertia.yz, moments[1] + moments[2]);
    EXPECT_EQ(types[0].inertia.xw, moments[0] + moments[3]);
    EXPECT_NEAR(types[1].inertia.yz, kLeastInertia * 3 * 0.5, 1e-20);
}

}  // namespace
}  // namespace tesserae
