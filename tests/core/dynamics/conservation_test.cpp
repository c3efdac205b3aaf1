// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// Spheres that fly at each other's middle, spinning.
Bodies implosion(double friction, double restitution) {
    std::mt19937_64 engine(11);
    std::normal_distribution<> normal;
    const auto random = [&] {
        return Vec4(normal(engine), normal(engine), normal(engine), normal(engine));
    };
    Bodies bodies;
    for (int i = 0; i < 60; ++i) {
        const Vec4 x = 3 * random();
        const Vec4 v = -x + 0.3 * random(), p = random(), q = random();
        const double radius = 0.2 + 0.3 * std::abs(normal(engine));
        add(bodies, sphere_type(radius, std::exp(normal(engine)), friction, restitution), x, v,
            wedge(p, q));
    }
    return bodies;
}

double mass_of(const Bodies& bodies, BodyId id) { return bodies.type_of(id).mass; }

Vec4 momentum(const Bodies& bodies) {
    Vec4 sum = Vec4::Zero();
    for (BodyId id = 0; id < bodies.size(); ++id) sum += mass_of(bodies, id) * bodies.velocity[id];
    return sum;
}

/// About the origin; I = M R^2 / 3 in every plane of a hypersphere.
Bivector angular_momentum_of(const Bodies& bodies) {
    Bivector sum;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const double m = mass_of(bodies, id);
        const double r = std::get<Hypersphere>(bodies.type_of(id).shape).radius;
        sum += m * wedge(bodies.position[id], bodies.velocity[id]) +
               m * r * r / 3 * bodies.angular_velocity[id];
    }
    return sum;
}

TEST(Collisions, KeepLinearAndAngularMomentum) {
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(implosion(0.6, 0.4), settings);
    const Vec4 p = momentum(world.bodies());
    const Bivector L = angular_momentum_of(world.bodies());
    std::uint64_t contacts = 0;
    for (int i = 0; i < 480; ++i) contacts += world.step(1.0 / 240).contacts;
    ASSERT_GT(contacts, 100u) << "too few collisions to show anything";
    // 480 steps and some 10 impulses a contact, rounded at momenta of some 10 kg m/s and arms of
    // some 10 m: 1e-14 each, adding up as a random walk of 1e4 terms.
    EXPECT_LT((momentum(world.bodies()) - p).norm(), 1e-11);
    EXPECT_LT(norm(angular_momentum_of(world.bodies()) - L), 1e-10);
}

TEST(Collisions, WithoutFrictionLeaveTheSpinAlone) {
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(implosion(0, 0.4), settings);
    const Bodies before = world.bodies();
    for (int i = 0; i < 480; ++i) world.step(1.0 / 240);
    for (BodyId id = 0; id < before.size(); ++id)
        EXPECT_LT(norm(world.bodies().angular_velocity[id] - before.angular_velocity[id]), 1e-11);
}

TEST(Collisions, NeverAddEnergyWhenTheyAreInelastic) {
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(implosion(0.6, 0), settings);
    double energy = kinetic_energy(world.bodies());
    const double start = energy;
    for (int i = 0; i < 480; ++i) {
        // Bodies that start overlapping are pushed apart, which takes energy from nowhere.
        const bool pushed = world.step(1.0 / 240).penetration > 1e-9;
        const double now = kinetic_energy(world.bodies());
        if (!pushed) {
            EXPECT_LE(now, energy * (1 + 1e-12)) << i;
        }
        energy = now;
    }
    EXPECT_LT(energy, 0.5 * start);
}

TEST(Energy, IsThatOfItsDefinition) {
    Bodies bodies;
    Bivector omega;
    omega.xz = 2;
    add(bodies, box_type({1, 2, 3, 4}, 12), {1, 2, 3, 4}, {1, -1, 2, 0}, omega);
    BodyType held = box_type({1, 2, 3, 4}, 12);
    held.fixed_position = true;
    add(bodies, held, {5, 5, 5, 5}, {9, 9, 9, 9}, omega);
    add(bodies, plane_type(Vec4::UnitY(), 0));
    // 12 kg at v^2 = 6, and twice I_xz = 12 (1 + 9)/12 = 10 at omega = 2.
    EXPECT_DOUBLE_EQ(kinetic_energy(bodies), 36 + 2 * 20);
    EXPECT_DOUBLE_EQ(potential_energy(bodies, {0, -10, 1, 0}), -12 * (-20 + 3));
}

}  // namespace
}  // namespace tesserae
