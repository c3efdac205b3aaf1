// SPDX-License-Identifier: Apache-2.0
// Scenes in which users of this and of other engines found bodies to behave badly, each measured
// by what is wrong in it, so that an improvement shows.

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/gate/gate.hpp"
#include "bench/gate/watch.hpp"
#include "bench/resting_scenes.hpp"
#include "core/dynamics/diagnostics/energy.hpp"

namespace tesserae::bench::gate {
namespace {

/// How far the bodies have moved aside, at most [m].
double moved_aside(const Bodies& start, const Bodies& now) {
    double most = 0;
    for (BodyId id = 0; id < start.size(); ++id) {
        Vec4 moved = now.position[id] - start.position[id];
        moved[1] = 0;
        most = std::max(most, moved.norm());
    }
    return most;
}

/// Of bodies that bounce once without gravity [%].
std::vector<double> energy_changed(Bodies bodies, const Run& run) {
    shake(bodies, run.shake);
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(bodies, settings);
    watch(world, 0.5);
    return {100 * std::abs(kinetic_energy(world.bodies()) / kinetic_energy(bodies) - 1)};
}

/// A spherinder, cubinder or duocylinder that bounces from a floor on its rim, without friction
/// and gravity and with restitution 1: its energy should stay.
std::vector<double> rim_bounce(const Run& run) {
    std::mt19937_64 engine(8000 + static_cast<std::uint64_t>(run.scene));
    BodyType type = drawn_type(engine, 5 + run.scene % 3, 0.3);
    type.friction = 0, type.restitution = 1;
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0, 1));
    add(bodies, type, 0.4 * Vec4::UnitY(), -1.5 * Vec4::UnitY(), drawn_plane(engine, 5),
        drawn_rotor(engine));
    return energy_changed(bodies, run);
}

/// A duocylinder that lost 7 % of its energy so.
std::vector<double> one_rim_bounce(const Run& run) {
    BodyType type;
    Duocylinder shape;
    shape.radii = {0.1, 0.16};
    complete(shape);
    type.shape = shape;
    type.friction = 0, type.restitution = 1;
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0, 1));
    add(bodies, type, 0.4 * Vec4::UnitY(), -1.5 * Vec4::UnitY(),
        {2.06, 1.43, 2.09, 4.16, 0.24, -4.86},
        exp(-0.5 * pi / 180 * Bivector{-140.5, 34.2, 138.3, 76.9, 171.4, 166.0}));
    return energy_changed(bodies, run);
}

/// A press comes down at 0.5 m/s on two boxes in a pit, until there is no room for both. Nothing
/// should get much faster than the press.
std::vector<double> press(const Run& run) {
    std::mt19937_64 engine(8100 + static_cast<std::uint64_t>(run.scene));
    Bodies bodies = floor_and();
    add_walls(bodies, {0, 2, 3}, 0.6, 0.5);
    const BodyType box = box_type(Vec4::Constant(0.5), 1);
    for (const double y : {0.3, 0.92})
        add(bodies, box, y * Vec4::UnitY(), Vec4::Zero(), {}, drawn_rotor(engine));
    BodyType plate = box_type({3, 0.4, 3, 3}, 1);
    plate.fixed_position = plate.fixed_rotation = true;
    add(bodies, plate, 1.64 * Vec4::UnitY(), -0.5 * Vec4::UnitY());
    shake(bodies, run.shake);
    Stepper world(bodies, gravity_of_10());
    double fastest = 0;
    for (int i = 0; i < 576; ++i) {
        world.step(1 / kDefaultRate);
        fastest = std::max(fastest, fastest_of(world.bodies()));
    }
    return {fastest};
}

/// A box falls flat on a smaller one, restitution 1: it should neither turn nor come aside.
std::vector<double> flat_on_smaller(const Run& run) {
    Bodies bodies;
    BodyType below = box_type({0.75, 0.5, 0.75, 0.75}, 1), box = box_type(Vec4::Ones(), 1);
    below.fixed_position = below.fixed_rotation = true;
    below.restitution = box.restitution = 1;
    add(bodies, below, {0, -0.25, 0, 0});
    add(bodies, box, {0, 2.5, 0, 0});
    shake(bodies, run.shake);
    Stepper world(bodies, gravity_of_10());
    double spin = 0;
    for (int i = 0; i < 10 * 240; ++i) {
        world.step(1 / kDefaultRate);
        if (i < 240) spin = std::max(spin, norm(world.bodies().angular_velocity[1]));
    }
    return {1e3 * spin, 1e3 * moved_aside(bodies, world.bodies())};
}

/// Nine boxes of 0.1 and 100 kg in turn, 0.5 mm apart: the top one should come down by 4.5 mm.
std::vector<double> unequal_tower(const Run& run, double rate) {
    Bodies bodies = floor_and();
    for (int i = 0; i < 9; ++i)
        add(bodies, box_type(Vec4::Constant(0.4), i % 2 == 0 ? 0.1 : 100),
            {0, 0.2005 + 0.4005 * i, 0, 0});
    shake(bodies, run.shake);
    Stepper world(bodies, gravity_of_10());
    const double deepest = watch(world, 10, rate).last_deepest;
    const double fallen = bodies.position.back()[1] - world.bodies().position.back()[1];
    return {1e3 * std::abs(fallen - 0.0045), 1e3 * deepest};
}

/// Five cubes without friction that rest on each other should stay so, whatever their restitution.
std::vector<double> slippery_cubes(const Run& run, double restitution) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0, restitution));
    BodyType cube = box_type(Vec4::Ones(), 1);
    cube.friction = 0, cube.restitution = restitution;
    for (int i = 0; i < 5; ++i) add(bodies, cube, {0, 0.5 + i, 0, 0});
    shake(bodies, run.shake);
    Stepper world(bodies, gravity_of_10());
    const double fastest = watch(world, 10).last_fastest;
    return {1e3 * moved_aside(bodies, world.bodies()), 1e3 * fastest};
}

/// A duoprism wedged between the ground and a fixed one should come to rest.
std::vector<double> wedged_duoprism(const Run& run) {
    const auto prism = [](std::int64_t p, std::int64_t q, double r, double s) {
        Duoprism shape;
        shape.polygons = {p, q}, shape.radii = {r, s};
        complete(shape);
        BodyType type;
        type.shape = shape;
        type.rolling_friction = 0.01;
        return type;
    };
    const auto turned = [](const Bivector& degrees) { return exp(-0.5 * pi / 180 * degrees); };
    BodyType body = prism(5, 8, 0.06993778338623952, 0.2092669180184);
    body.mass = 21.34680661180921, body.friction = 0.23133646387576087;
    BodyType held = prism(4, 3, 0.2853168162297032, 0.07366325970387733);
    held.friction = 0.4880443406614209;
    held.fixed_position = held.fixed_rotation = true;
    Bodies bodies = floor_and();
    add(bodies, body,
        {0.4131637419414057, 0.12143217490279588, -1.072258279436598, 0.9482854862530683},
        {-0.004, -0.0278, 0.0116, -0.00078}, {0.16, -0.0516, 0.0187, 0.257, 0.0297, -0.0482},
        turned({8.696836479173871, -88.99160935780026, -83.53071517387642, -6.081098092209241,
                18.75171991125067, 13.207070908854995}));
    add(bodies, held,
        {0.43441323909698887, 0.036810427028761285, -0.9611013708481686, 0.8833615778656438},
        Vec4::Zero(), {},
        turned({21.217621982777384, -24.421291867121973, 11.72189306623795, -75.34981994993544,
                -54.910669436387, 53.59051203422568}));
    shake(bodies, run.shake);
    Stepper world(bodies, gravity_of_10());
    const Watched seen = watch(world, 20);
    return {1e3 * seen.last_fastest, 1e3 * seen.last_deepest};
}

/// A pallet with two layers of boxes is pulled away at 1 m/s: they should slide v^2 / (2 mu g)
/// and rise by nothing.
std::vector<double> pallet(const Run& run) {
    constexpr double kSpeed = 1, kFriction = 0.5, kGravity = 10;
    Bodies bodies;
    BodyType board = box_type({3, 0.1, 3, 3}, 1);
    board.fixed_position = board.fixed_rotation = true;
    add(bodies, board, {0, -0.05, 0, 0}, kSpeed * Vec4::UnitX());
    bodies.types.push_back(box_type({0.4, 0.2, 0.4, 0.4}, 1));
    for (int i = 0; i < 16; ++i)
        add(bodies, 1u,
            {0.5 * (i % 2) - 0.25, i / 8 == 0 ? 0.1 : 0.3, 0.5 * (i / 2 % 2) - 0.25,
             0.5 * (i / 4 % 2) - 0.25});
    shake(bodies, run.shake);
    Stepper world(bodies, gravity_of_10());
    double rises = 0, off = 0;
    constexpr int kSteps = 240;
    for (int i = 0; i < kSteps; ++i) {
        world.step(1 / kDefaultRate);
        for (BodyId id = 1; id < bodies.size(); ++id)
            rises = std::max(rises, world.bodies().position[id][1] - bodies.position[id][1]);
    }
    const double slides = kSpeed * kSpeed / (2 * kFriction * kGravity);
    for (BodyId id = 1; id < bodies.size(); ++id) {
        const double moved = world.bodies().position[id][0] - bodies.position[id][0];
        off = std::max(off, std::abs(kSpeed * kSteps / kDefaultRate - moved - slides));
    }
    return {1e3 * rises, 1e3 * off};
}

}  // namespace

std::vector<Family> found_families() {
    const Quantity spin{"spin after the first impact", "mrad/s"};
    const Quantity aside{"moved aside", "mm"}, overlap{"overlap at the end", "mm"};
    const Quantity fastest{"fastest in the last second", "mm/s"};
    const Quantity sinks{"sinks, or rises", "mm"};
    std::vector<Family> all{
        {"found: bounce on a rim, restitution 1",
         60,
         30,
         2,
         {spread_of("energy changed", "%")},
         rim_bounce},
        {"found: duocylinder on its rim, restitution 1",
         1,
         1,
         3,
         {{"energy changed", "%"}},
         one_rim_bounce},
        {"found: press that closes on two boxes",
         20,
         8,
         2,
         {spread_of("largest speed", "m/s")},
         press},
        {"found: box falls flat on a smaller one", 1, 1, 3, {spin, aside}, flat_on_smaller},
        {"found: wedged duoprism", 1, 1, 3, {fastest, overlap}, wedged_duoprism},
        {"found: pallet pulled away",
         1,
         1,
         3,
         {{"a box rises", "mm"}, {"a box slides too far or too little", "mm"}},
         pallet}};
    for (const double rate : {100.0, kDefaultRate})
        all.push_back({"found: nine boxes of 0.1 and 100 kg in turn, steps of 1/" +
                           std::to_string(static_cast<int>(rate)) + " s",
                       1,
                       1,
                       12,
                       {sinks, overlap},
                       [rate](const Run& run) { return unequal_tower(run, rate); }});
    for (const double restitution : {0.5, 1.0})
        all.push_back({std::string("found: five cubes without friction, restitution ") +
                           (restitution < 1 ? "0.5" : "1"),
                       1,
                       1,
                       12,
                       {aside, fastest},
                       [restitution](const Run& run) { return slippery_cubes(run, restitution); }});
    return all;
}

}  // namespace tesserae::bench::gate
