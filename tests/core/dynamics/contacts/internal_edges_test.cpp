// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/internal_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "tests/core/dynamics/contacts/edge_draw.hpp"

// Bodies that go over floors made of several bodies.
namespace tesserae {
namespace {

using namespace tesserae::testing;

const Vec4 kUp = Vec4::UnitY();

/// Of what a floor is made: its top is the plane y = 0.
enum class Floor { kPlane, kGrid, kStaggered, kSunkInPlane, kLoose };

/// A body put down on a floor, on its way.
struct Ride {
    BodyType type;
    double height = 0;  ///< of its centre [m]
    double speed = 0;
    Vec4 along = Vec4::UnitX();
    Bivector omega;
    Rotor rotor;
    double tile = 1;             ///< side [m]
    bool hull_tiles = false;     ///< 8-cells
    Vec4 offset = Vec4::Zero();  ///< of the tiles
    Rotor frame;                 ///< of all there is
    bool body_first = false;

    double distance() const { return std::min(speed, 2 * tile); }
};

/// From the y axis to one across the floor.
Rotor laid_along(const Vec4& across) {
    const Rotor one = exp(0.25 * pi * wedge(kUp, across));
    return y_axis_of(one).dot(across) > 0.5 ? one : reverse(one);
}

/// Angular velocity of rolling.
Bivector rolling(const Vec4& velocity, double radius) {
    const Bivector omega = (1 / radius) * wedge(kUp, velocity);
    const Vec4 below = velocity_at(omega, -radius * kUp);
    return below.dot(velocity) < 0 ? omega : -1.0 * omega;
}

enum class Kind { kBox, kSpinningBox, kBall, kRollingBall, kCapsule, kRollingCapsule, kWedge };

Ride random_ride(Kind kind, double friction, std::uint64_t seed) {
    Draw draw{std::mt19937_64(seed)};
    Ride ride;
    ride.tile = draw.any_size(0.4, 4);
    ride.speed = draw.any_size(0.1, 10);
    ride.offset = random_vector(draw.random, 0.5 * ride.tile);
    if (seed % 3 != 0) ride.along = draw.across();
    if (seed % 2 != 0) ride.frame = draw.turn();
    ride.body_first = seed % 4 < 2;
    const double size = draw.any_size(0.1, 1);
    ride.height = 0.5 * size;
    const Bivector roll = rolling(ride.speed * ride.along, 0.5 * size);
    switch (kind) {
        case Kind::kWedge: {
            // A triangle's prism on one of its sides: its centre is not midway between bottom and
            // top, and its front edge is acute.
            Duoprism shape;
            shape.polygons = {3, 4}, shape.radii = {size, 0.5 * size};
            complete(shape);
            ride.type.shape = shape;
            ride.rotor = exp(draw.spin(1)) * exp(Bivector{pi / 12});
            break;
        }
        case Kind::kBox:
        case Kind::kSpinningBox:
            ride.type = box_type({size * draw.number(0.5, 2), size, size * draw.number(0.5, 2),
                                  size * draw.number(0.5, 2)});
            if (kind == Kind::kSpinningBox) ride.omega = draw.spin(2);
            if (seed % 5 > 1) ride.rotor = exp(draw.spin(1));
            break;
        case Kind::kBall:
        case Kind::kRollingBall:
            ride.type = sphere_type(0.5 * size);
            if (kind == Kind::kRollingBall) ride.omega = roll;
            break;
        case Kind::kCapsule:
        case Kind::kRollingCapsule:
            ride.type = capsule_type(0.5 * size, size * draw.number(0.5, 3));
            Vec4 axis = draw.across();
            if (kind == Kind::kRollingCapsule) {
                axis = (axis - axis.dot(ride.along) * ride.along).normalized();
                ride.omega = roll;
            }
            ride.rotor = laid_along(axis);
    }
    ride.type.friction = friction;
    return ride;
}

void add_tiles(Bodies& bodies, const Ride& ride, Floor floor) {
    const Mat4 turn = to_matrix(ride.frame);
    const double side = ride.tile;
    BodyType type = ride.hull_tiles ? regular_type(RegularPolychoron::k8Cell, side)
                                    : box_type(Vec4::Constant(side), 1000);
    type.friction = ride.type.friction;
    type.fixed_position = type.fixed_rotation = floor != Floor::kLoose;
    bodies.types.push_back(type);
    const auto tile = static_cast<std::uint32_t>(bodies.types.size() - 1);
    const double reach = 3 * 2 * ride.height + 0.9 * side;
    for (int i = -3; i <= 3; ++i)
        for (int j = -3; j <= 3; ++j)
            for (int k = -3; k <= 3; ++k) {
                Vec4 at = ride.offset + side * Vec4(i, 0, j, k);
                if (floor == Floor::kStaggered)
                    at += side *
                          Vec4(std::fmod(0.37 * j + 0.21 * k, 1), 0, std::fmod(0.43 * k, 1), 0);
                if (floor == Floor::kSunkInPlane && (i + j + k) % 2 != 0) continue;
                at[1] = 0;
                const double on_way = std::clamp(at.dot(ride.along), 0.0, ride.distance());
                if ((at - on_way * ride.along).norm() > reach) continue;
                at[1] = -0.5 * side;
                add(bodies, tile, turn * at, Vec4::Zero(), {}, ride.frame);
            }
}

std::pair<Bodies, BodyId> start_of(const Ride& ride, Floor floor) {
    const Mat4 turn = to_matrix(ride.frame);
    Bodies bodies;
    const auto add_body = [&] {
        return add(bodies, ride.type, turn * (ride.height * kUp), turn * (ride.speed * ride.along),
                   rotate(ride.frame, ride.omega), ride.frame * ride.rotor);
    };
    BodyId body = 0;
    if (ride.body_first) body = add_body();
    if (floor != Floor::kGrid && floor != Floor::kStaggered)
        add(bodies,
            plane_type(turn * kUp, floor == Floor::kLoose ? -ride.tile : 0, ride.type.friction));
    if (floor != Floor::kPlane) add_tiles(bodies, ride, floor);
    if (!ride.body_first) body = add_body();
    return {bodies, body};
}

/// The largest differences between a ride over a floor and the same over one plane.
struct Difference {
    double path = 0, hop = 0;  ///< [m]
    double speed = 0;          ///< as a part of the speed at the start
};

Difference difference(const Ride& ride, Floor floor, PhysicsSettings settings) {
    const Mat4 turn = to_matrix(ride.frame);
    settings.gravity = turn * kDown;
    const auto [alone, body_alone] = start_of(ride, Floor::kPlane);
    const auto [tiled, body] = start_of(ride, floor);
    Stepper on_plane(alone, settings), on_tiles(tiled, settings);
    Difference most;
    for (double t = 0; t * ride.speed < ride.distance(); t += kStep) {
        on_plane.step(kStep);
        on_tiles.step(kStep);
        const Bodies &p = on_plane.bodies(), &q = on_tiles.bodies();
        Vec4 apart = turn.transpose() * (q.position[body] - p.position[body_alone]);
        most.hop = std::max(most.hop, std::abs(apart[1]));
        apart[1] = 0;
        most.path = std::max(most.path, apart.norm());
        most.speed =
            std::max(most.speed, (q.velocity[body] - p.velocity[body_alone]).norm() / ride.speed);
    }
    return most;
}

constexpr std::tuple<Kind, double> kRides[] = {
    {Kind::kBox, 0},     {Kind::kBox, 0.3},     {Kind::kSpinningBox, 0},
    {Kind::kBall, 0},    {Kind::kBall, 0.3},    {Kind::kRollingBall, 0.6},
    {Kind::kCapsule, 0}, {Kind::kCapsule, 0.3}, {Kind::kRollingCapsule, 0.6},
};

void expect_as_on_one_plane(Floor floor, int rides) {
    for (const PhysicsSettings& settings : with_and_without_substeps())
        for (const auto& [kind, friction] : kRides)
            for (int i = 0; i < rides; ++i) {
                const Ride ride =
                    random_ride(kind, friction, 100u * static_cast<unsigned>(kind) + unsigned(i));
                const Difference most = difference(ride, floor, settings);
                SCOPED_TRACE(::testing::Message()
                             << "kind " << int(kind) << ", friction " << friction << ", ride " << i
                             << ", sub-steps " << settings.substeps);
                EXPECT_LT(most.path, 1e-3);
                EXPECT_LT(most.hop, 1e-4);
                EXPECT_LT(most.speed, 0.01);
            }
}

void expect_as_on_one_plane(const Ride& ride, Floor floor) {
    for (const PhysicsSettings& settings : with_and_without_substeps()) {
        const Difference most = difference(ride, floor, settings);
        EXPECT_LT(most.path, 1e-3) << "sub-steps " << settings.substeps;
        EXPECT_LT(most.hop, 1e-4);
        EXPECT_LT(most.speed, 0.01);
    }
}

void expect_wedges_cross(std::uint64_t rides) {
    for (const double friction : {0.0, 0.3})
        for (std::uint64_t seed = 0; seed < rides; ++seed) {
            SCOPED_TRACE(seed);
            expect_as_on_one_plane(random_ride(Kind::kWedge, friction, seed),
                                   seed % 2 == 0 ? Floor::kGrid : Floor::kStaggered);
        }
}

TEST(InternalEdges, AreCrossedByWhatHasAnAcuteFrontEdge) { expect_wedges_cross(4); }
TEST(InternalEdgesSlow, AreCrossedByWhatHasAnAcuteFrontEdge) { expect_wedges_cross(12); }

void expect_polychoron_tiles_crossed(std::uint64_t rides) {
    for (const auto& [kind, friction] : kRides)
        for (std::uint64_t seed = 0; seed < rides; ++seed) {
            SCOPED_TRACE(::testing::Message() << int(kind) << ' ' << friction << ' ' << seed);
            Ride ride = random_ride(kind, friction, 500 + 10 * static_cast<unsigned>(kind) + seed);
            ride.hull_tiles = true;
            expect_as_on_one_plane(ride, Floor::kGrid);
        }
}

TEST(InternalEdges, OfPolychoronTilesAreCrossedAsOnePlane) { expect_polychoron_tiles_crossed(1); }
TEST(InternalEdgesSlow, OfPolychoronTilesAreCrossedAsOnePlane) {
    expect_polychoron_tiles_crossed(3);
}

TEST(InternalEdges, OfAGridAreCrossedAsOnePlane) { expect_as_on_one_plane(Floor::kGrid, 1); }
TEST(InternalEdgesSlow, OfAGridAreCrossedAsOnePlane) { expect_as_on_one_plane(Floor::kGrid, 4); }
TEST(InternalEdges, OfStaggeredTilesAreCrossedAsOnePlane) {
    expect_as_on_one_plane(Floor::kStaggered, 1);
}
TEST(InternalEdges, OfTilesSunkInAPlaneAreCrossedAsOnePlane) {
    expect_as_on_one_plane(Floor::kSunkInPlane, 1);
}

/// Tiles that are put down side by side on a plane, and stay flush to some 1e-6 m. Where sliding
/// friction turns a capsule depends on which of them carries it, and is not looked at.
TEST(InternalEdgesSlow, OfLooseTilesAreCrossedAsOnePlane) {
    for (const PhysicsSettings& settings : with_and_without_substeps())
        for (const Kind kind : {Kind::kBox, Kind::kBall, Kind::kCapsule}) {
            Ride ride = random_ride(kind, 0, 7 * static_cast<unsigned>(kind));
            ride.tile = 6 * ride.height;
            ride.speed = 4 * ride.tile;
            const Difference most = difference(ride, Floor::kLoose, settings);
            EXPECT_LT(most.path, 1e-3) << int(kind);
            EXPECT_LT(most.hop, 1e-4) << int(kind);
            EXPECT_LT(most.speed, 0.01) << int(kind);
        }
}

/// Two boxes on a plane that overlap along an edge from bottom to top, of which only a point at the
/// bottom is told, pushing along the plane: what it tells of a side must not be taken for an
/// internal edge.
TEST(InternalEdges, APointOfASideThatRisesIsNone) {
    Bodies bodies;
    add(bodies, plane_type(kUp, 0));
    add(bodies, box_type(Vec4::Ones()), {0, 0.5, 0, 0});
    add(bodies, box_type(Vec4::Ones()), {0.99, 0.5, 0.99, 0});
    const Simulation simulation = make_simulation(bodies, {});
    StepData step;
    begin_step(simulation, step, kStep);
    step.h = kStep;
    step.position = bodies.position;
    step.rotor = bodies.rotor;
    step.velocity = bodies.velocity;
    step.angular_velocity = bodies.angular_velocity;
    for (const BodyId id : {1u, 2u})
        step.contacts.push_back({kUp, bodies.position[id] - 0.5 * kUp, 0, 0, id, 0});
    step.contacts.push_back({Vec4::UnitX(), {0.495, 0, 0.495, 0}, -0.01, 1, 2, 7});
    Schedule serial;
    InternalEdges().correct(simulation, step, serial);
    ASSERT_EQ(step.contacts.size(), 3u);
    EXPECT_EQ(step.contacts[2].feature, 7u);
    EXPECT_EQ(step.contacts[2].normal, Vec4::UnitX());
}

/// A raft of flush boxes: they touch each other at faces, edges and vertices, down to the plane
/// that all stand on.
TEST(InternalEdges, BoxesThatTouchAtEdgesRest) {
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
        Draw draw{std::mt19937_64(seed)};
        Ride ride;
        ride.tile = draw.any_size(0.3, 3);
        ride.height = 0.2 * ride.tile;
        if (seed > 0) ride.frame = draw.turn();
        ride.type.friction = 0;
        const Mat4 turn = to_matrix(ride.frame);
        Bodies bodies;
        add(bodies, plane_type(turn * kUp, -ride.tile, 0));
        add_tiles(bodies, ride, Floor::kLoose);
        ASSERT_GE(bodies.size(), 28u);  // three each way, and the plane
        PhysicsSettings settings;
        settings.gravity = turn * kDown;
        Stepper world(bodies, settings);
        run(world, 480);
        for (BodyId id = 1; id < bodies.size(); ++id)
            // Nothing takes back what a float's rounding moves aside where there is no friction.
            ASSERT_LT((world.bodies().position[id] - bodies.position[id]).norm(), 1e-5) << seed;
    }
}

}  // namespace
}  // namespace tesserae
