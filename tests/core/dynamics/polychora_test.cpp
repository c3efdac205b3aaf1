// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/diagnostics/momentum.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// A rotor that takes a unit vector to -y.
Rotor laid_down(const Vec4& normal) {
    // Two reflections: in the plane between both, then in the one of the target.
    Vec4 middle = normal - Vec4::UnitY();
    if (middle.norm() < 1e-9) return exp(Bivector{-0.5 * pi});
    middle.normalize();
    const Mat4 first = Mat4::Identity() - 2 * middle * middle.transpose();
    const Mat4 second = Mat4::Identity() - 2 * Vec4::UnitY() * Vec4::UnitY().transpose();
    return to_rotor(second * first);
}

TEST(Polychora, StandOnEachOfTheirCells) {
    using enum RegularPolychoron;
    for (const RegularPolychoron which : {k5Cell, k8Cell, k16Cell, k24Cell, k120Cell, k600Cell}) {
        const BodyType type = regular_type(which, 1);
        const auto& cells = std::get<Polychoron>(type.shape).body->hull.cells;
        // All of them side by side, far apart; of the large ones every fortieth.
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        for (std::size_t i = 0; i<cells.size(); i += cells.size()> 24 ? 40 : 1)
            add(bodies, type, {3.0 * static_cast<double>(i), cells[i].plane.offset, 0, 0},
                Vec4::Zero(), {}, laid_down(cells[i].plane.normal));
        Stepper world(bodies, PhysicsSettings{});
        run(world, 240);
        for (BodyId id = 1; id < bodies.size(); ++id) {
            const Bodies& now = world.bodies();
            EXPECT_LT((now.position[id] - bodies.position[id]).norm(), 0.004) << int(which);
            EXPECT_LT((to_matrix(now.rotor[id]) - to_matrix(bodies.rotor[id])).norm(), 0.01)
                << int(which) << " " << id;
            EXPECT_LT(now.velocity[id].norm() + norm(now.angular_velocity[id]), 1e-6)
                << int(which) << " " << id;
        }
    }
}

/// The middles of a cell's first vertex, edge and face.
std::array<Vec4, 3> features_of(const Hull& hull, const HullCell& cell) {
    const auto at = [&](std::size_t i) { return hull.vertices[cell.vertices[i]]; };
    Vec4 face = Vec4::Zero();
    for (std::size_t i = 0; i < cell.vertices.size(); ++i)
        if (std::abs(cell.sides[0].normal.dot(at(i)) - cell.sides[0].offset) < 1e-9) face += at(i);
    return {at(0), at(cell.edges[0][0]) + at(cell.edges[0][1]), face};
}

/// How far a cell may lean whose points are all so near to a plane that they rest on it.
double resting_lean(const HullCell& cell) {
    const Vec4 middle = cell.plane.offset * cell.plane.normal;
    double width = cell.plane.offset;
    for (const auto& side : cell.sides)
        width = std::min(width, side.offset - side.normal.dot(middle));
    return kRestingGap * kSlop * cell.plane.offset / width;
}

/// From a vertex, an edge or a face, leaning a little toward one of the cells there.
TEST(Polychora, FallOnTheCellThatTheyLeanToward) {
    using enum RegularPolychoron;
    for (const RegularPolychoron which : {k5Cell, k8Cell, k16Cell, k24Cell, k120Cell, k600Cell}) {
        const BodyType type = regular_type(which, 1);
        const Hull& hull = std::get<Polychoron>(type.shape).body->hull;
        const HullCell& cell = hull.cells[0];
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        for (const Vec4& feature : features_of(hull, cell)) {
            const Vec4 down = (0.9 * feature.normalized() + 0.1 * cell.plane.normal).normalized();
            const double height = down.dot(support(std::get<Polychoron>(type.shape), down));
            add(bodies, type, {10.0 * static_cast<double>(bodies.size()), height, 0, 0},
                Vec4::Zero(), {}, laid_down(down));
        }
        Stepper world(bodies, PhysicsSettings{});
        run(world, 2400);
        for (BodyId id = 1; id < bodies.size(); ++id) {
            const Vec4 down = -to_matrix(world.bodies().rotor[id]).row(1).transpose();
            EXPECT_LT((down - cell.plane.normal).norm(), resting_lean(cell))
                << int(which) << " " << id;
            EXPECT_LT(world.bodies().velocity[id].norm(), 1e-6) << int(which) << " " << id;
        }
    }
}

/// Pushed at 2 m/s while they stand on a cell: the small ones slide v^2 / (2 friction g) far, those
/// of many cells roll three times as far and more.
TEST(Polychora, RollWhereTheyHaveManyCells) {
    using enum RegularPolychoron;
    for (const RegularPolychoron which : {k5Cell, k8Cell, k16Cell, k24Cell, k120Cell, k600Cell}) {
        const BodyType type = regular_type(which, 1);
        const HullCell& cell = std::get<Polychoron>(type.shape).body->hull.cells[0];
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        RandomGeometry random(31);
        for (int i = 0; i < 6; ++i) {
            Vec4 push = random.direction();
            push[1] = 0;
            add(bodies, type, {100.0 * i, cell.plane.offset, 0, 0}, 2 * push.normalized(), {},
                laid_down(cell.plane.normal));
        }
        Stepper world(bodies, PhysicsSettings{});
        run(world, 2400);
        const double slides = 4 / (2 * 0.5 * -PhysicsSettings{}.gravity[1]);
        double mean = 0;
        for (BodyId id = 1; id < bodies.size(); ++id)
            mean += (world.bodies().position[id] - bodies.position[id]).norm() / 6;
        if (which == k120Cell || which == k600Cell)
            EXPECT_GT(mean, 3 * slides) << int(which);
        else
            EXPECT_NEAR(mean, slides, 0.01) << int(which);
    }
}

TEST(Polychora, StandOnOneAnother) {
    using enum RegularPolychoron;
    for (const RegularPolychoron which : {k8Cell, k24Cell, k120Cell}) {
        // A cell down, one up.
        const BodyType type = regular_type(which, 0.7);
        const Polychoron& shape = std::get<Polychoron>(type.shape);
        const Rotor turn = laid_down(shape.body->hull.cells[0].plane.normal);
        const double inradius = shape.body->hull.cells[0].plane.offset;
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        for (int i = 0; i < 3; ++i)
            add(bodies, type, {0, (2 * i + 1) * inradius, 0, 0}, Vec4::Zero(), {}, turn);
        Stepper world(bodies, PhysicsSettings{});
        run(world, 480);
        for (BodyId id = 1; id < bodies.size(); ++id) {
            const Bodies& now = world.bodies();
            EXPECT_LT((now.position[id] - bodies.position[id]).norm(), 0.02) << int(which);
            EXPECT_LT(now.velocity[id].norm() + norm(now.angular_velocity[id]), 1e-3)
                << int(which) << " " << id;
        }
    }
}

/// They lean by less a sweep than the tolerance, and swayed by 3 mm/s for ever at 10, 14 and 40
/// iterations, as their loads ended after two sweeps.
TEST(Polychora, OfManyCellsComeToRestOnOneAnother) {
    const BodyType type = regular_type(RegularPolychoron::k120Cell, 0.7);
    const HullCell& cell = std::get<Polychoron>(type.shape).body->hull.cells[0];
    Bodies bodies;
    for (int i = 0; i < 3; ++i)
        add(bodies, type, {0, (2 * i + 1) * cell.plane.offset, 0, 0}, Vec4::Zero(), {},
            laid_down(cell.plane.normal));
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (const int iterations : {10, 20, 40}) {
        PhysicsSettings settings;
        settings.iterations = iterations;
        Stepper world(bodies, settings);
        run(world, 1200);
        const Bodies& now = world.bodies();
        for (BodyId id = 0; id < 3; ++id)
            EXPECT_LT(now.velocity[id].norm() + norm(now.angular_velocity[id]), 1e-4)
                << iterations << " " << id;
    }
}

/// Flat duoprisms, whose cells have up to 24 corners, of which eight points are kept.
TEST(Polychora, ThatAreFlatLieStill) {
    for (const PhysicsSettings& settings : {PhysicsSettings{}, substepped_settings()})
        for (const auto& [p, q, ratio] : {std::tuple{6, 8, 4.0},
                                          {6, 8, 10.0},
                                          {6, 6, 3.5},
                                          {4, 8, 6.0},
                                          {5, 12, 5.0},
                                          {3, 9, 8.0}}) {
            BodyType type = box_type(Vec4::Ones());
            Duoprism shape;
            shape.polygons = {p, q}, shape.radii = {0.5, 0.5 * ratio};
            complete(shape);
            type.shape = shape;
            type.friction = 0.5;
            // On an edge of the small polygon times the large one.
            const double height = 0.5 * std::cos(pi / p);
            Bodies bodies;
            add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
            add(bodies, type, {0, height, 0, 0}, Vec4::Zero(), {},
                exp(0.5 * Bivector{0.5 * pi + pi / p}));
            Stepper world(bodies, settings);
            run(world, 240);
            const double speed = world.bodies().velocity[1].norm();
            EXPECT_LT(speed, 1e-6) << p << ' ' << q << ' ' << ratio;
            EXPECT_NEAR(world.bodies().position[1][1], height, 1e-4)
                << p << ' ' << q << ' ' << ratio;
        }
}

BodyType duoprism_type(std::int64_t p, std::int64_t q, const Vec2& radii) {
    Duoprism shape;
    shape.polygons = {p, q}, shape.radii = radii;
    complete(shape);
    BodyType type;
    type.shape = shape;
    type.rolling_friction = 0.01;
    return type;
}

/// A prism is wedged between the ground and another one, on a ridge of which one of its cells lies.
TEST(Polychora, RestOnARidgeOfAnother) {
    const auto turned = [](const Bivector& degrees) { return exp(-0.5 * pi / 180 * degrees); };
    BodyType body = duoprism_type(5, 8, {0.07, 0.21}), held = duoprism_type(4, 3, {0.285, 0.074});
    body.mass = 20, body.friction = 0.25, held.friction = 0.5;
    held.fixed_position = held.fixed_rotation = true;
    for (const double rate : {60.0, 240.0, 960.0}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        add(bodies, body, {0.4132, 0.1214, -1.0723, 0.9483}, Vec4::Zero(), {},
            turned({8.70, -88.99, -83.53, -6.08, 18.75, 13.21}));
        add(bodies, held, {0.4344, 0.0368, -0.9611, 0.8834}, Vec4::Zero(), {},
            turned({21.22, -24.42, 11.72, -75.35, -54.91, 53.59}));
        Stepper world(bodies, PhysicsSettings{});
        for (int i = 0; i < 2 * rate; ++i) world.step(1 / rate);
        const Vec4 place = world.bodies().position[1];
        double moved = 0;
        for (int i = 0; i < 4 * rate; ++i) {
            world.step(1 / rate);
            moved = std::max(moved, (world.bodies().position[1] - place).norm());
        }
        EXPECT_LT(moved, 0.01 * world.simulation().type_of(2).slop) << rate;
    }
}

/// A body whose principal axes are not its own flies as the same body does whose axes are.
TEST(Polychora, FlyAlikeWhateverAxesTheyAreGivenIn) {
    const Rotor turn = exp(Bivector{0.3, -0.5, 0.7, 0.2, 0.4, -0.6});
    Polychoron straight, turned;
    straight.regular = turned.regular = RegularPolychoron::kNone;
    for (unsigned signs = 0; signs < 16; ++signs) {
        Vec4 corner(0.5, 0.3, 0.9, 0.7);
        for (int i = 0; i < 4; ++i)
            if (signs >> i & 1) corner[i] = -corner[i];
        straight.vertices.push_back(corner);
        turned.vertices.push_back(rotate(turn, corner));
    }
    complete(straight), complete(turned);
    ASSERT_EQ(principal_axes(straight), nullptr);
    ASSERT_NE(principal_axes(turned), nullptr);
    for (const RotationIntegrator integrator :
         {RotationIntegrator::kEuler, RotationIntegrator::kMidpoint}) {
        PhysicsSettings settings = without_gravity();
        settings.integrator = integrator;
        const auto flown = [&](const Polychoron& shape, const Rotor& rotor) {
            BodyType type;
            type.shape = shape;
            Bodies bodies;
            add(bodies, type, Vec4::Zero(), Vec4::Zero(), Bivector{3, -1, 2, 0.5, 1, -2}, rotor);
            Stepper world(bodies, settings);
            run(world, 240);
            return world.bodies();
        };
        const Rotor start = exp(Bivector{0.1, 0.2, -0.3, 0.4, 0.5, 0.6});
        const Bodies one = flown(straight, start), other = flown(turned, start * reverse(turn));
        EXPECT_LT((to_matrix(one.rotor[0]) - to_matrix(other.rotor[0] * turn)).norm(), 1e-9);
        EXPECT_LT(norm(one.angular_velocity[0] - other.angular_velocity[0]), 1e-9);
    }
}

/// Those whose vertices lie on the axes are as wide as a ball along these, and no balls: what hits
/// them beside the centre turns them, without friction too, by as much as from any other side.
TEST(Polychora, AreTurnedByContactsWithoutFriction) {
    using enum RegularPolychoron;
    for (const RegularPolychoron which : {k5Cell, k8Cell, k16Cell, k24Cell, k120Cell, k600Cell}) {
        BodyType type = regular_type(which, 1);
        const auto& cell = std::get<Polychoron>(type.shape).body->hull.cells[0];
        const Vec4 into = -cell.plane.normal;
        // Beside the middle of a cell by half of the way to one of its corners.
        const Vec4 corner = std::get<Polychoron>(type.shape).body->hull.vertices[cell.vertices[0]];
        const Vec4 middle = -cell.plane.offset * into;
        const Vec4 place = middle + 0.5 * (corner - middle);
        Bodies bodies;
        add(bodies, type);
        add(bodies, sphere_type(0.1, 0.5), place - 0.2 * into, 2 * into);
        Stepper world(bodies, without_gravity());
        run(world, 60);
        const Bodies& now = world.bodies();
        // From J = impulse, L = place ^ J and the bodies' momenta.
        const Vec4 impulse = 0.5 * (bodies.velocity[1] - now.velocity[1]);
        EXPECT_GT(impulse.norm(), 0.1) << int(which);
        const TypeProperties& properties = world.simulation().types[0];
        EXPECT_FALSE(properties.inverse_inertia == Bivector{}) << int(which);
        const Bivector omega = properties.inverse_inertia.xy * wedge(place, impulse);
        EXPECT_GT(norm(omega), 0.01) << int(which);
        EXPECT_LT(norm(now.angular_velocity[0] - omega), 0.02 * norm(omega)) << int(which);
    }
}

}  // namespace
}  // namespace tesserae
