// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/diagnostics/momentum.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

TEST(Momentum, IsThatOfItsDefinition) {
    Bodies bodies;
    Bivector omega;
    omega.xz = 2;
    add(bodies, box_type({1, 2, 3, 4}, 12), {1, 2, 3, 4}, {1, -1, 2, 0}, omega);
    EXPECT_EQ(total_momentum(bodies), Vec4(12, -12, 24, 0));
    // 12 (x_i v_j - x_j v_i), and I_xz = 12 (1 + 9)/12 = 10 at omega = 2.
    const Bivector once{12 * (-1 - 2), 12 * (2 - 3) + 20, 12 * (0 - 4),
                        12 * (4 + 3),  12 * (0 + 4),      12 * (0 - 8)};
    EXPECT_EQ(total_angular_momentum(bodies), once);

    // What a constraint holds has no momentum of its own: it takes whatever it is given.
    BodyType held = box_type({1, 2, 3, 4}, 12);
    held.fixed_position = true;
    add(bodies, held, {5, 5, 5, 5}, {9, 9, 9, 9}, omega);
    Bivector spin;
    spin.xz = 20;
    EXPECT_EQ(total_momentum(bodies), Vec4(12, -12, 24, 0));
    EXPECT_EQ(total_angular_momentum(bodies), once + spin);
    held.fixed_rotation = true;
    add(bodies, held, {5, 5, 5, 5}, {9, 9, 9, 9}, omega);
    add(bodies, plane_type(Vec4::UnitY(), 0));
    EXPECT_EQ(total_momentum(bodies), Vec4(12, -12, 24, 0));
    EXPECT_EQ(total_angular_momentum(bodies), once + spin);
}

/// The same by cutting a turned box into cells: sum over cells of m x ^ v, with v by rigid motion.
TEST(Momentum, OfATurningBoxIsThatOfItsParts) {
    const Vec4 size{1, 2, 0.5, 0.7};
    const Bivector omega{0.3, -1, 2, 0.5, 0.1, -0.7};
    const Rotor rotor = exp(Bivector{0.2, 0.4, -0.3, 0.6, 0.1, -0.5});
    const Vec4 centre{1, -2, 0.5, 3}, velocity{0.3, 0.1, -2, 1};
    Bodies bodies;
    add(bodies, box_type(size, 5), centre, velocity, omega, rotor);
    // The second moment of n equal cells is (1 - 1/n^2) of the whole's: two grids give the limit.
    const auto of_cells = [&](int n) {
        Bivector sum;
        for (int cell = 0; cell < n * n * n * n; ++cell) {
            Vec4 place;
            for (int axis = 0, rest = cell; axis < 4; ++axis, rest /= n)
                place[axis] = size[axis] * ((rest % n + 0.5) / n - 0.5);
            const Vec4 r = rotate(rotor, place);
            sum += 5.0 / (n * n * n * n) * wedge(centre + r, velocity + velocity_at(omega, r));
        }
        return sum;
    };
    const Bivector limit = 1.0 / 3 * (4 * of_cells(4) - of_cells(2));
    // [kg m^2/s]: 256 terms of some 0.1 rounded at 1e-16 each.
    EXPECT_LT(norm(total_angular_momentum(bodies) - limit), 1e-13);
}

/// Boxes, capsules and spheres without gravity fly at each other's middle, spinning.
TEST(Momentum, StaysInFreeFlightAndCollisions) {
    std::mt19937_64 engine(5);
    std::normal_distribution<> normal;
    const auto random = [&] {
        return Vec4(normal(engine), normal(engine), normal(engine), normal(engine));
    };
    Bodies bodies;
    for (int i = 0; i < 40; ++i) {
        BodyType type = sphere_type(0.5, 1 + i % 3, 0.5, 0.2);
        if (i % 3 == 1) type.shape = Hyperbox{{0.5, 1, 0.7, 1.2}};
        if (i % 3 == 2) type.shape = Hypercapsule{0.3, 0.8};
        const Vec4 x = 3 * random(), p = random(), q = random();
        add(bodies, type, x, -x + 0.3 * random(), wedge(p, q));
    }
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(bodies, settings);
    const Vec4 p = total_momentum(bodies);
    const Bivector L = total_angular_momentum(bodies);
    std::uint64_t contacts = 0;
    for (int i = 0; i < 480; ++i) contacts += world.step(1.0 / 240).contacts;
    ASSERT_GT(contacts, 100u) << "too few collisions to show anything";
    // As in Collisions.KeepLinearAndAngularMomentum: 1e4 roundings of some 1e-14.
    EXPECT_LT((total_momentum(world.bodies()) - p).norm(), 1e-11);
    EXPECT_LT(norm(total_angular_momentum(world.bodies()) - L), 1e-10);
}

TEST(Momentum, GrowsByGravityAlone) {
    Bodies bodies;
    add(bodies, sphere_type(0.5, 3), {1, 2, 3, 4}, {0, 1, 0, 2});
    add(bodies, box_type({1, 1, 2, 1}, 2), {-9, 0, 0, 5}, {1, 0, 0, 0}, {0, 1, 0, 0, 2, 0});
    Stepper world(bodies, PhysicsSettings{});
    const Vec4 p = total_momentum(bodies);
    const Bivector L = total_angular_momentum(bodies);
    for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
    const double t = 1;
    const Vec4 g{0, -10, 0, 0};
    EXPECT_LT((total_momentum(world.bodies()) - p - 5 * t * g).norm(), 1e-11);
    // dL/dt is the sum of m x ^ g with x = x0 + v0 t + g t^2 / 2, whose last part is along g.
    const Bivector torque = 3 * wedge(Vec4(1, 2, 3, 4) + 0.5 * t * Vec4(0, 1, 0, 2), g) +
                            2 * wedge(Vec4(-9, 0, 0, 5) + 0.5 * t * Vec4(1, 0, 0, 0), g);
    EXPECT_LT(norm(total_angular_momentum(world.bodies()) - L - t * torque), 1e-10);
}

}  // namespace
}  // namespace tesserae
