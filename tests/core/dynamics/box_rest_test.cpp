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

/// The rotation in the plane of two unit directions that takes `from` to `to`.
Rotor rotor_between(const Vec4& from, const Vec4& to) {
    const Bivector plane = wedge(from, to);
    const double sine = norm(plane);
    // Opposite ones are met here along y only: half a turn that takes y to -y.
    if (sine < 1e-12) return from.dot(to) > 0 ? Rotor{} : exp(Bivector{-0.5 * pi});
    return exp(-0.5 * std::atan2(sine, from.dot(to)) / sine * plane);
}

/// What a box points down with: straight down in its own frame.
Vec4 down_of(const Stepper& world, BodyId id) {
    return rotate(reverse(world.bodies().rotor[id]), -Vec4::UnitY());
}

double speed(const Stepper& world, BodyId id) {
    return world.bodies().velocity[id].norm() + norm(world.bodies().angular_velocity[id]);
}

TEST(BoxOnPlane, StandsOnEachOfItsCells) {
    const Vec4 size{1, 0.8, 1.2, 0.6};
    for (int axis = 0; axis < 4; ++axis)
        for (double side : {-1.0, 1.0}) {
            const Vec4 u = side * Vec4::Unit(axis);
            const Vec4 start{0, 0.5 * size[axis], 0, 0};
            Bodies bodies;
            add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
            add(bodies, box_type(size, 2), start, Vec4::Zero(), {},
                rotor_between(u, -Vec4::UnitY()));
            Stepper world(bodies, PhysicsSettings{});
            run(world, 480);
            // The solver leaves overlaps up to the slop alone: 0.005 of the least half side, 0.3 m.
            EXPECT_LT((world.bodies().position[1] - start).norm(), 0.0015) << u.transpose();
            EXPECT_LT((down_of(world, 1) - u).norm(), 0.0015 / 0.3) << u.transpose();
            EXPECT_LT(speed(world, 1), 1e-6) << u.transpose();
        }
}

/// Balanced on the feature in which the cells of `axes` meet, then tilted toward the cell of axis
/// t.
void expect_fall(const Vec4& size, const std::vector<int>& axes, int t, double side) {
    Vec4 u = Vec4::Zero();
    for (int axis : axes) u[axis] = 0.5 * size[axis];
    u[t] *= 1.05;
    u[t] = std::copysign(u[t], side);
    u.normalize();
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.9));
    const double height = 0.5 * u.cwiseAbs().dot(size);
    add(bodies, box_type(size, 2), {0, height, 0, 0}, Vec4::Zero(), {},
        rotor_between(u, -Vec4::UnitY()));
    Stepper world(bodies, PhysicsSettings{});
    const auto energy = [&] {
        return kinetic_energy(world.bodies()) + potential_energy(world.bodies(), kDown);
    };
    const double before = energy();
    double most = before;
    for (int i = 0; i < 1440; ++i) {
        run(world, 1);
        most = std::max(most, energy());
    }
    const std::string what = fmt::format("{} axes, toward {}", axes.size(), side * t);
    EXPECT_GT(down_of(world, 1)[t] * side, 1 - 1e-4) << what;
    EXPECT_NEAR(world.bodies().position[1][1], 0.5 * size[t], 0.005 * 0.5 * size.minCoeff())
        << what;
    EXPECT_LT(speed(world, 1), 1e-3) << what;
    // Pivoting on a contact gains energy of first order in the time step; over 1248 such falls at
    // 240 Hz the worst gain was 4e-4 of what the fall sets free.
    EXPECT_LT(most - before, 1e-3 * (before - energy())) << what;
}

TEST(BoxOnPlane, FallsFromFacesEdgesAndVerticesToTheSideItIsTilted) {
    // With equal sides the other cells of the feature stay alike, so the fall is along one great
    // circle to the cell of axis t, whatever the feature.
    const Vec4 cube{1, 1, 1, 1};
    for (const std::vector<int>& axes :
         {std::vector{0, 1}, {1, 3}, {0, 2}, {0, 1, 2}, {1, 2, 3}, {0, 1, 2, 3}})
        for (int t : axes)
            for (double side : {-1.0, 1.0}) expect_fall(cube, axes, t, side);
    // On a face only two cells compete, whatever the sides.
    for (int t : {0, 3}) expect_fall({1, 0.8, 1.2, 0.7}, {0, 3}, t, 1);
}

TEST(BoxOnPlane, WithUnequalSidesFallsToTheCellItIsTiltedToward) {
    // The other cells of the feature stay in balance along the great circle from the feature to the
    // cell, whatever the sides; these are alike enough for the fall to keep near it though the
    // inertia differs, and for no cell to be so narrow that the landing carries on over it.
    const Vec4 size{1, 0.9, 1.1, 0.95};
    for (const std::vector<int>& axes :
         {std::vector{0, 2}, {1, 3}, {0, 1, 2}, {1, 2, 3}, {0, 1, 2, 3}})
        for (int t : axes)
            for (double side : {-1.0, 1.0}) expect_fall(size, axes, t, side);
}

TEST(CapsuleOnBox, LiesLevel) {
    BodyType capsule;
    capsule.shape = Hypercapsule{0.2, 0.8};
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    add(bodies, box_type({1, 1, 1.4, 1}, 5), {0, 0.5, 0, 0});
    // Along z over the box's middle, dropped from 20 mm.
    const Rotor along_z = rotor_between(Vec4::UnitY(), Vec4::UnitZ());
    const BodyId id = add(bodies, capsule, {0, 1.22, 0, 0}, Vec4::Zero(), {}, along_z);
    // Ten iterations leave a tilt of 1e-6 m, twenty 2e-8, eighty rounding: in float, as the box has
    // five times the mass.
    PhysicsSettings settings;
    settings.iterations = 160;
    settings.tolerance = 0;
    Stepper world(bodies, settings);
    const auto end_height = [&](double end) {
        const Vec4 axis = rotate(world.bodies().rotor[id], Vec4::UnitY());
        return world.bodies().position[id][1] + end * 0.4 * axis[1];
    };
    // The slop of the capsule: 0.005 of its radius.
    const double slop = 0.001;
    double tilt = 0;
    for (int i = 0; i < 480; ++i) {
        run(world, 1);
        // Nothing but the solver's order tells one end from the other.
        tilt = std::max(tilt, std::abs(end_height(-1) - end_height(1)));
        if (i < 240) continue;
        ASSERT_NEAR(end_height(0), 1.2, slop) << i;
    }
    EXPECT_LT(tilt, 1e-9);
    EXPECT_LT((world.bodies().position[id] - Vec4(0, 1.2, 0, 0)).norm(), slop);
    EXPECT_LT((world.bodies().position[1] - Vec4(0, 0.5, 0, 0)).norm(), slop);
    EXPECT_LT(speed(world, id), 1e-4);
}

TEST(Stack, OfTwoBoxesStands) {
    for (const Vec4& upper : {Vec4(1, 1, 1, 1), Vec4(0.6, 0.5, 0.8, 0.7)}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        add(bodies, box_type({1, 1, 1, 1}, 2), {0, 0.5, 0, 0});
        add(bodies, box_type(upper, 1), {0.05, 1 + 0.5 * upper[1], -0.1, 0.1});
        Stepper world(bodies, PhysicsSettings{});
        run(world, 720);
        for (BodyId id : {1, 2}) {
            EXPECT_LT((world.bodies().position[id] - bodies.position[id]).norm(), 1e-3) << id;
            EXPECT_LT(speed(world, id), 1e-4) << id;
        }
    }
}

TEST(Stack, CapsulesSideBySideCarryABox) {
    BodyType capsule;
    capsule.shape = Hypercapsule{0.3, 1.5};
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    // Both along z; the box spans them in x and lies on their cores in z. In w everything is alone
    // in its plane, so nothing pushes it that way.
    const Rotor along_z = rotor_between(Vec4::UnitY(), Vec4::UnitZ());
    for (double x : {-0.4, 0.4}) add(bodies, capsule, {x, 0.3, 0, 0}, Vec4::Zero(), {}, along_z);
    add(bodies, box_type({1.4, 0.4, 1, 1}, 1), {0, 0.8, 0, 0});
    Stepper world(bodies, PhysicsSettings{});
    run(world, 480);
    // Less than the slop of the thinnest, the box: 0.005 of 0.2 m. Rollers do creep, at the rate
    // that the last bit of tilt gives.
    for (BodyId id : {1, 2, 3})
        EXPECT_LT((world.bodies().position[id] - bodies.position[id]).norm(), 1e-3) << id;
}

/// Turned about the vertical.
Rotor crosswise(std::mt19937_64& random) {
    const double xz = uniform(random, -1.5, 1.5), xw = uniform(random, -1.5, 1.5);
    return exp(Bivector{0, xz, xw, 0, 0, uniform(random, -1.5, 1.5)});
}

/// Rulers, boards, sheets and cards that fall on each other crosswise: a thin box that lands a
/// little aslant must not turn about one point after the other until both are one.
void expect_crosswise_boxes_part(std::uint64_t seeds) {
    const Vec4 sizes[] = {{0.3, 0.003, 0.03, 0.03},  {2, 0.1, 0.2, 0.2},     {2, 0.05, 0.4, 0.4},
                          {0.09, 0.001, 0.06, 0.06}, {0.9, 0.1, 0.45, 0.45}, {1.8, 0.2, 0.9, 0.9}};
    for (const PhysicsSettings& settings : {PhysicsSettings{}, substepped_settings(10)})
        for (const Vec4& size : sizes)
            for (std::uint64_t seed = 0; seed < seeds; ++seed) {
                std::mt19937_64 random(seed);
                Bodies bodies;
                add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
                BodyType type = box_type(size);
                type.friction = 0.5;
                const double fall = uniform(random, 0.1, 3) * size[1];
                add(bodies, type, {0, 0.5 * size[1], 0, 0});
                add(bodies, type, {0, 1.5 * size[1] + fall, 0, 0}, Vec4::Zero(), {},
                    crosswise(random));
                Stepper world(bodies, settings);
                for (int i = 0; i < 480; ++i)
                    ASSERT_LT(world.step(kStep).penetration, 0.2 * size[1]) << size[1] << seed;
                const Bodies& now = world.bodies();
                EXPECT_GT(now.position[2][1], 1.45 * size[1]) << size[1] << ' ' << seed;
                EXPECT_LT(now.velocity[2].norm(), 3e-3) << size[1] << ' ' << seed;
            }
}

TEST(Stack, OfThinBoxesDroppedCrosswiseDoesNotMerge) { expect_crosswise_boxes_part(2); }
TEST(StackSlow, OfThinBoxesDroppedCrosswiseDoesNotMerge) { expect_crosswise_boxes_part(6); }

/// Piles of eight sheets that lean and are turned against each other, of which some turned into
/// each other, one end after the other.
TEST(StackSlow, OfSheetsThatFallAslantDoesNotMerge) {
    const Vec4 size{0.1, 0.1, 1, 1};
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        std::mt19937_64 random(seed);
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        BodyType type = box_type(size);
        type.friction = 0.5;
        double height = 0;
        for (int i = 0; i < 8; ++i) {
            const Rotor rotor = crosswise(random) *
                                exp(Bivector{uniform(random, -0.2, 0.2), uniform(random, -0.2, 0.2),
                                             0, uniform(random, -0.2, 0.2), 0, 0});
            const double half = 0.5 * size.dot(to_matrix(rotor).row(1).cwiseAbs());
            height += half + uniform(random, 1e-4, 0.1);
            add(bodies, type,
                {uniform(random, -0.01, 0.01), height, uniform(random, -0.01, 0.01), 0},
                Vec4::Zero(), {}, rotor);
            height += half;
        }
        Stepper world(bodies, PhysicsSettings{});
        for (int i = 0; i < 959; ++i) world.step(kStep);
        EXPECT_LT(world.step(kStep).penetration, 0.1 * size[1]) << seed;
    }
}

}  // namespace
}  // namespace tesserae
