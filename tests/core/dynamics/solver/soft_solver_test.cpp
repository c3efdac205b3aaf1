#include <gtest/gtest.h>

#include <algorithm>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/solver/contact_row.hpp"
#include "core/dynamics/world.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// Two spheres that overlap by `depth`, without gravity.
World overlapping(Solver solver, double depth) {
    Bodies bodies;
    add(bodies, sphere_type(0.5), Vec4::Zero());
    add(bodies, sphere_type(0.5), (1 - depth) * Vec4(1, 2, 0, 2) / 3);
    PhysicsSettings settings = soft_settings();
    settings.solver = solver;
    settings.gravity.setZero();
    return World(bodies, settings);
}

double distance(const World& world) {
    return (world.bodies().position[1] - world.bodies().position[0]).norm();
}

TEST(SoftSolver, PartsOverlappingBodiesWithoutLeavingThemMomentum) {
    for (const double depth : {0.01, 0.1, 0.5, 0.99}) {
        World world = overlapping(Solver::kSoft, depth);
        double fastest = 0;
        for (int i = 0; i < 480; ++i) {
            world.step(1.0 / 240);
            fastest = std::max(fastest, world.bodies().velocity[1].norm());
        }
        // The spring pulls no farther than to the slop, 0.005 of the radius.
        EXPECT_NEAR(distance(world), 1 - 0.0025, 1e-4) << depth;
        EXPECT_LT(fastest, 1e-9) << depth;
    }
}

TEST(ImpulseSolver, LeavesBodiesThatStartInsideEachOtherNoMoreThanTheLargestPush) {
    for (const double depth : {0.1, 0.5, 0.99}) {
        World world = overlapping(Solver::kImpulse, depth);
        for (int i = 0; i < 480; ++i) world.step(1.0 / 240);
        // Relative to each other, half of it each; in half-sizes of 0.5 m a second.
        const double speed = (world.bodies().velocity[1] - world.bodies().velocity[0]).norm();
        EXPECT_LE(speed, kLargestPush * 0.5 * (1 + 1e-12)) << depth;
        EXPECT_GT(distance(world), 1) << depth;
    }
}

TEST(SoftSolver, BouncesToTheSameHeights) {
    // e = 0.8 from 1 m: 0.64 m, exact in energy whatever the solver and the sub-steps.
    for (const int substeps : {1, 4, 7}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0, 0.8));
        add(bodies, sphere_type(0.5, 2, 0, 0.8), {0, 1.5, 0, 0});
        PhysicsSettings settings = soft_settings();
        settings.substeps = substeps;
        World world(bodies, settings);
        while (world.bodies().velocity[1][1] <= 0) world.step(1.0 / 240);
        const double v = world.bodies().velocity[1][1], y = world.bodies().position[1][1] - 0.5;
        EXPECT_NEAR(y + v * v / 20, 0.64, 1e-12) << substeps;
    }
}

TEST(SoftSolver, SlidesAndRollsAsExactlyAsTheOther) {
    // 3/4 of the speed once it rolls: core/FORMULAS.md 6.
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.3));
    add(bodies, sphere_type(0.5, 2, 0.3), {0, 0.5, 0, 0}, {0, 0, 2.16, 2.88});
    World world(bodies, soft_settings());
    for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
    EXPECT_LT((world.bodies().velocity[1] - Vec4(0, 0, 1.62, 2.16)).norm(), 1e-11);
    EXPECT_NEAR(world.bodies().position[1][1], 0.5, 1e-11);
}

TEST(SoftSolver, HoldsATowerOfTenBoxes) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (int i = 0; i < 10; ++i) add(bodies, box_type(Vec4::Ones(), 1000), {0, 0.5 + i, 0, 0});
    World world(bodies, soft_settings());
    for (int i = 0; i < 960; ++i) world.step(1.0 / 240);
    for (BodyId id = 1; id <= 10; ++id) {
        // Ten contacts that may each sink to the slop of 2.5 mm, and lean by that across a box.
        const Vec4 moved = world.bodies().position[id] - Vec4(0, id - 0.5, 0, 0);
        EXPECT_LT(moved.norm(), 0.0025 * id) << id;
    }
}

TEST(SoftSolver, ReportsAResidualThatMoreIterationsLessen) {
    double residual[2];
    for (const int iterations : {2, 20}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0));
        for (int i = 0; i < 10; ++i)
            add(bodies, sphere_type(0.5), {0, 0.5 + i, 0, 0}, {0, i == 9 ? -0.03 : 0, 0, 0});
        PhysicsSettings settings = soft_settings();
        settings.iterations = iterations;
        World world(bodies, settings);
        residual[iterations == 20] = world.step(1.0 / 240).residual;
    }
    EXPECT_GT(residual[0], 2 * residual[1]);
    EXPECT_GT(residual[1], 0);
}

}  // namespace
}  // namespace tesserae
