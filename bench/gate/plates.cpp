// SPDX-License-Identifier: Apache-2.0
// Whirling plates and coins that are thrown at each other, beside 16 times as many steps, and at a
// thin wall.

#include <algorithm>
#include <cmath>

#include "bench/gate/gate.hpp"
#include "bench/gate/watch.hpp"
#include "bench/resting_scenes.hpp"
#include "core/dynamics/diagnostics/energy.hpp"

namespace tesserae::bench::gate {
namespace {

constexpr double kRate = 60;

/// How two bodies meet.
struct Meeting {
    double time = -1;    ///< at the end of the step in which their motion first changes [s], or -1
    double kept = 0;     ///< of the speed at which they come nearer, 0.2 s later
    bool apart = false;  ///< they are as they were: a still on the side of a
};

Meeting meet(const Bodies& bodies, double rate) {
    PhysicsSettings settings;
    settings.gravity.setZero();
    settings.steps_per_second = rate;
    Stepper world(bodies, settings);
    const Vec4 closing = bodies.velocity[0] - bodies.velocity[1];
    Meeting meeting;
    for (int i = 1; i <= std::lround(0.2 * rate); ++i) {
        world.step(1 / rate);
        const Vec4 changed = world.bodies().velocity[0] - bodies.velocity[0];
        if (meeting.time < 0 && changed.norm() > 1e-3 * closing.norm()) meeting.time = i / rate;
    }
    const Bodies& now = world.bodies();
    meeting.kept = (now.velocity[0] - now.velocity[1]).dot(closing) / closing.squaredNorm();
    meeting.apart = now.position[0][0] < now.position[1][0];
    return meeting;
}

std::vector<double> met(const Run& run) {
    constexpr int kFiner = 16;
    std::mt19937_64 engine(7000 + static_cast<std::uint64_t>(run.scene));
    const double thickness = drawn_decade(engine, 0.005, 0.05);
    const BodyType type = thin_type(run.scene % 2 == 0 ? 0 : 3, 1, thickness);
    const double speed = testing::uniform(engine, 30, 100);
    Bodies bodies;
    for (const double side : {-1.0, 1.0}) {
        Vec4 place = random_vector(engine, 0.1);
        place[0] = side * (0.1 * speed + 1);
        add(bodies, type, place, -side * speed * Vec4::UnitX(), drawn_plane(engine, 30),
            drawn_rotor(engine));
    }
    shake(bodies, run.shake);
    const Meeting coarse = meet(bodies, kRate), fine = meet(bodies, kFiner * kRate);
    const bool early =
        coarse.time >= 0 && (fine.time < 0 || coarse.time < fine.time - 1 / (kFiner * kRate));
    return {static_cast<double>(early), std::abs(coarse.kept - fine.kept),
            static_cast<double>(fine.apart && !coarse.apart)};
}

std::vector<double> thrown(const Run& run) {
    std::mt19937_64 engine(7500 + static_cast<std::uint64_t>(run.scene));
    BodyType wall = box_type({0.001, 200, 200, 200}, 1);
    wall.fixed_position = wall.fixed_rotation = true;
    BodyType type = thin_type(run.scene % kThinShapes, 0.3, drawn_decade(engine, 0.003, 0.03));
    type.restitution = 0.5 * static_cast<double>(engine() % 3);
    const double speed = 0.3 * kDefaultRate * drawn_decade(engine, 0.3, 20);
    Bodies bodies;
    add(bodies, wall);
    add(bodies, type, {-0.4 - testing::uniform(engine, 0, 3) * speed / kDefaultRate, 0, 0, 0},
        speed * (Vec4::UnitX() + random_vector(engine, 0.4)), drawn_plane(engine, 100),
        drawn_rotor(engine));
    shake(bodies, run.shake);
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(bodies, settings);
    const double start = kinetic_energy(bodies);
    double gain = 0;
    for (int i = 0; i < 24; ++i) {
        world.step(1 / kDefaultRate);
        gain = std::max(gain, kinetic_energy(world.bodies()) / start - 1);
    }
    return {static_cast<double>(world.bodies().position[1][0] > 0), 100 * gain};
}

}  // namespace

std::vector<Family> plate_families() {
    return {{"plates that meet",
             80,
             40,
             2,
             {count_of("react before they touch"),
              spread_of("speed kept differs from small steps", "of the speed"),
              count_of("pass, but not with small steps")},
             met},
            {"plates thrown at a wall",
             200,
             100,
             2,
             {count_of("passed through"), {"largest gain of energy", "%", {Statistic::kNinth}}},
             thrown}};
}

}  // namespace tesserae::bench::gate
