// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/dynamics/diagnostics/energy.hpp"
#include "tests/core/dynamics/contacts/edge_draw.hpp"

// Steps, walls and corners among flush boxes: what is none of their internal edges, and what is.
namespace tesserae {
namespace {

using namespace tesserae::testing;

/// Tiles of which those from `edge` on are higher by a step.
void add_stairs(Bodies& bodies, double side, int edge, double step) {
    BodyType type = box_type(Vec4::Constant(side));
    type.fixed_position = type.fixed_rotation = true;
    bodies.types.push_back(type);
    const auto tile = static_cast<std::uint32_t>(bodies.types.size() - 1);
    for (int i = 0; i <= edge; ++i)
        for (int j = -1; j <= 1; ++j)
            for (int k = -1; k <= 1; ++k)
                add(bodies, tile,
                    {(i + 0.5) * side, (i >= edge ? step : 0) - 0.5 * side, (j + 0.3) * side,
                     (k - 0.2) * side});
}

TEST(InternalEdges, AStepOfAMillimetreIsNone) {
    for (const PhysicsSettings& settings : with_and_without_substeps())
        for (std::uint64_t seed = 0; seed < 8; ++seed) {
            Draw draw{std::mt19937_64(seed)};
            const double side = draw.any_size(0.4, 2), size = draw.any_size(0.1, 0.6);
            // Slow enough not to tip over the step.
            const double speed = draw.any_size(0.3, 1) * std::sqrt(size), edge = 2 * side;
            BodyType type = box_type({size * draw.number(1, 2), size, size * draw.number(0.5, 2),
                                      size * draw.number(0.5, 2)});
            type.friction = 0;
            const Rotor rotor = seed % 2 == 0 ? Rotor{} : exp(draw.spin(0.5));
            const double reach = half_extent_along(std::get<Hyperbox>(type.shape),
                                                   to_matrix(rotor).transpose() * Vec4::UnitX());
            Bodies bodies;
            add_stairs(bodies, side, 2, 1e-3);
            const BodyId body = add(bodies, type, {edge - reach - 0.4 * side, 0.5 * size, 0, 0},
                                    {speed, 0, 0, 0}, {}, rotor);
            Stepper world(bodies, settings);
            double farthest = -kMiss;
            for (double t = 0; t < 0.6 * side / speed; t += kStep) {
                world.step(kStep);
                farthest = std::max(farthest, world.bodies().position[body][0]);
            }
            EXPECT_GT(farthest, edge - 1.01 * reach) << seed;
            // It leans over the edge, tips and falls back, or turns as its corner strikes.
            const double least = 0.5 * std::get<Hyperbox>(type.shape).size.minCoeff();
            EXPECT_LT(farthest, edge - 0.9 * (seed % 2 == 0 ? reach : least)) << seed;
        }
}

/// A box that slides along a wall of flush boxes whose lower edges lie in the floor, or beside it.
/// It has sunk into the floor by a hair, and leans against the wall by another.
TEST(InternalEdgesSlow, OfAWallOnAFloorAreNone) {
    for (const PhysicsSettings& settings : with_and_without_substeps())
        for (std::uint64_t seed = 0; seed < 60; ++seed) {
            Draw draw{std::mt19937_64(seed)};
            const double side = draw.any_size(0.5, 2), size = side * draw.number(0.2, 0.4);
            BodyType tile = box_type(Vec4::Constant(side));
            tile.fixed_position = tile.fixed_rotation = true;
            tile.friction = 0;
            Bodies bodies;
            bodies.types.push_back(tile);
            const double first = -side * draw.number(0, 1), height = seed % 3 == 0 ? 0.3 : 0.5;
            for (int i = 0; i < 4; ++i)
                for (int k = -1; k <= 1; ++k)
                    add(bodies, 0, {first + i * side, height * side, 0.5 * side, (k + 0.2) * side});
            add(bodies, plane_type(Vec4::UnitY(), 0));
            BodyType type = box_type({size * draw.number(1, 2), size, size, size});
            type.friction = 0;
            const double lean = (seed % 2 == 0 ? 1 : -1) * draw.any_size(1e-5, 1e-3);
            const Rotor rotor = exp(Bivector{0, 0, 0, lean, 0, 0});
            const double speed = draw.any_size(0.3, 10), gap = draw.any_size(1e-6, 1e-3);
            const BodyId body = add(bodies, type, {0, 0.5 * size, -0.5 * size - gap, 0},
                                    {speed, 0, 0, 0}, {}, rotor);
            PhysicsSettings downward = settings;
            downward.gravity = kDown;
            Stepper world(bodies, downward);
            for (double t = 0; t * speed < 2 * side; t += kStep) world.step(kStep);
            const Vec4 v = world.bodies().velocity[body];
            EXPECT_LT(std::abs(v[0] - speed), 1e-6 * speed) << seed;
            EXPECT_LT(std::abs(v[2]), 0.01) << seed;
        }
}

/// What lies in the corner of a floor and walls, on edges and vertices too, stays there.
void expect_contacts_in_corners(std::uint64_t seeds) {
    for (const PhysicsSettings& settings : with_and_without_substeps())
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            Draw draw{std::mt19937_64(seed)};
            const double side = draw.any_size(0.3, 2);
            BodyType tile = box_type(Vec4::Constant(side));
            tile.fixed_position = tile.fixed_rotation = true;
            tile.friction = 0.3;
            Bodies bodies;
            bodies.types.push_back(tile);
            for (int i = -1; i <= 2; ++i)  // a floor, and walls that stand beside and below it
                for (int j = -1; j <= 2; ++j)
                    for (int k = -1; k <= 2; ++k)
                        for (int y = -1; y <= 3; ++y)
                            if (y == -1 || i == -1 || j == -1)
                                add(bodies, 0, side * Vec4(i + 0.5, y + 0.5, j + 0.5, k - 0.5));
            const double size = side * draw.number(0.4, 1.2);
            const std::array<BodyType, 3> types{box_type(Vec4::Constant(size)),
                                                capsule_type(0.4 * size, 0.5 * size),
                                                sphere_type(0.5 * size)};
            BodyType type = types[seed % 3];
            type.friction = 0.3;
            const Vec4 towards{draw.number(-3, 0), -1, draw.number(-3, 0), 0};
            const BodyId body = add(bodies, type, {1.2 * size, 1.2 * size, 1.2 * size, 0}, towards,
                                    {}, draw.turn());
            Stepper world(bodies, settings);
            const auto energy = [&] {
                return kinetic_energy(world.bodies()) - kDown.dot(world.bodies().position[body]);
            };
            const double at_start = energy();
            for (int i = 0; i < 480; ++i) {
                const StepReport report = world.step(kStep);
                ASSERT_LT(report.penetration, 0.05 * size) << seed << " step " << i;
                ASSERT_LT(energy(), at_start + 1e-9) << seed << " step " << i;
            }
            EXPECT_GT(world.bodies().position[body].head<3>().minCoeff(), 0.2 * size) << seed;
        }
}

TEST(InternalEdges, NobodyInACornerIsLeftWithoutContacts) { expect_contacts_in_corners(3); }
TEST(InternalEdgesSlow, NobodyInACornerIsLeftWithoutContacts) { expect_contacts_in_corners(9); }

}  // namespace
}  // namespace tesserae
