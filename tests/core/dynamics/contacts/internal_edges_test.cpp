// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/internal_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

// Bodies that go over floors made of several bodies.
namespace tesserae {
namespace {

using namespace tesserae::testing;

const Vec4 kUp = Vec4::UnitY();

/// Of what a floor is made: its top is the plane y = 0.
enum class Floor { kPlane, kGrid, kStaggered, kSunkInPlane, kLoose };

struct Draw {
    std::mt19937_64 random;

    double number(double least, double most) {
        return std::uniform_real_distribution<>(least, most)(random);
    }
    double any_size(double least, double most) {
        return std::exp(number(std::log(least), std::log(most)));
    }
    /// Unit, across the floor.
    Vec4 across() {
        Vec4 v = random_vector(random, 1);
        v[1] = 0;
        return v.normalized();
    }
    /// Of a turn across the floor.
    Bivector spin(double most) {
        return {0, number(-most, most), number(-most, most), 0, 0, number(-most, most)};
    }
    Rotor turn() {
        const Vec4 a = random_vector(random, 1.5), b = random_vector(random, 1.5);
        return exp(Bivector{a[0], a[1], a[2], b[0], b[1], b[2]});
    }
};

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

std::array<PhysicsSettings, 2> with_and_without_substeps() {
    return {PhysicsSettings{}, substepped_settings()};
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
            add(bodies, plane_type(kUp, 0));
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
