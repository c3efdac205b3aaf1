// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/dynamics/constraints/contact_row.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/solver/coloured_rows.hpp"
#include "core/dynamics/solver/kernels/sixteen.hpp"

namespace tesserae {
namespace {

/// Of a body that is isotropic, in a scene where others are not.
InverseInertia packed(double inverse) {
    InverseInertia inertia;
    for (std::size_t k : {0, 6, 11, 15, 18, 20})
        inertia.entry[k / 4][k % 4] = static_cast<float>(inverse);
    return inertia;
}

template <class Change>
Bivector angular_change(const Change& change) {
    const auto& w = change.first_planes;
    return {w[0], w[1], w[2], w[3], change.rest[0], change.rest[1]};
}

template <class Change>
Vec4 velocity_change(const Change& change) {
    const auto& v = change.velocity;
    return assembled(v[0], v[1], v[2], v[3]);
}

InverseInertia packed(const BivectorMap& map, double factor) {
    InverseInertia inertia;
    std::size_t k = 0;
    for (int i = 0; i < 6; ++i)
        for (int j = i; j < 6; ++j, ++k)
            inertia.entry[k / 4][k % 4] = static_cast<float>(map(i, j) * factor);
    return inertia;
}

bool has_sixteen_lanes() {
#ifdef __x86_64__
    return sixteen::kCompiled && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

}  // namespace

LaneCount most_lanes() {
    static const LaneCount most = has_sixteen_lanes() ? LaneCount::kSixteen : LaneCount::kEight;
    return most;
}

void begin_changes(const ColouredStage& stage, Range bodies, double mass_unit) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyId id = coloured.bodies[i];
        const TypeProperties& type = stage.simulation.type_of(id);
        const double inverse = type.isotropic ? type.inverse_inertia.xy * mass_unit : 0;
        coloured.changes[i] = {};
        coloured.changes[i].rest[2] = static_cast<float>(type.inverse_mass * mass_unit);
        coloured.changes[i].rest[3] = static_cast<float>(inverse);
        if (!coloured.turns_unevenly || stage.made) continue;
        coloured.inverse_inertias[i] =
            type.isotropic ? packed(inverse)
                           : packed(without_specks(stage.step.inverse_inertia[id]), mass_unit);
    }
}

void keep_impact_motion(const ColouredStage& stage, Range bodies) {
    StepData& step = stage.step;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyId id = step.coloured.bodies[i];
        const BodyChange& change = step.coloured.changes[i];
        const BodyMotion before = motion_of(step, id);
        step.impact_motion[id] = {
            before, before + BodyMotion{velocity_change(change), angular_change(change)}};
    }
}

std::array<double, 2> energies_of_compression(const ColouredStage& stage, Range bodies) {
    std::array<double, 2> energies = {};
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyId id = stage.step.coloured.bodies[i];
        const BodyChange& change = stage.step.coloured.changes[i];
        const BodyMotion motion = motion_of(stage.step, id);
        energies[0] += twice_kinetic_energy(stage.simulation, stage.step, id, motion);
        energies[1] += twice_kinetic_energy(
            stage.simulation, stage.step, id,
            motion + BodyMotion{velocity_change(change), angular_change(change)});
    }
    return energies;
}

void add_changes(const ColouredStage& stage, Range bodies) {
    StepData& step = stage.step;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyId id = step.coloured.bodies[i];
        step.velocity[id] += velocity_change(step.coloured.changes[i]);
        if (stage.simulation.needs.turning)
            step.angular_velocity[id] += angular_change(step.coloured.changes[i]);
    }
}

void take_warm_start_back(const ColouredStage& stage, Range bodies) {
    StepData& step = stage.step;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyId id = step.coloured.bodies[i];
        const PackedChange& warm_start = step.coloured.warm_start[i];
        step.velocity[id] -= velocity_change(warm_start);
        if (stage.simulation.needs.turning)
            step.angular_velocity[id] = step.angular_velocity[id] - angular_change(warm_start);
    }
}

void begin_correction(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyChange& change = coloured.changes[i];
        coloured.last_changes[i] = {
            change.velocity, change.first_planes, {change.rest[0], change.rest[1]}};
    }
}

void end_correction(const ColouredStage& stage, Range bodies) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        BodyChange& change = coloured.changes[i];
        PackedChange& before = coloured.last_changes[i];
        PackedChange corrected;
        for (std::size_t k = 0; k < 4; ++k) {
            corrected.velocity[k] = change.velocity[k] - before.velocity[k];
            corrected.first_planes[k] = change.first_planes[k] - before.first_planes[k];
        }
        for (std::size_t k = 0; k < 2; ++k) corrected.rest[k] = change.rest[k] - before.rest[k];
        change.velocity = before.velocity, change.first_planes = before.first_planes;
        change.rest[0] = before.rest[0], change.rest[1] = before.rest[1];
        before = corrected;
    }
}

void apply_correction(const ColouredStage& stage, Range bodies) {
    const ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const PackedChange& corrected = coloured.last_changes[i];
        BodyMotion motion{velocity_change(corrected), {}};
        if (stage.simulation.needs.turning) motion.angular_velocity = angular_change(corrected);
        displace(stage.simulation, stage.step, coloured.bodies[i], motion);
    }
}

double energy_of_changes(const ColouredStage& stage, Range bodies) {
    const ColouredIslands& coloured = stage.step.coloured;
    double sum = 0;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyChange& change = coloured.changes[i];
        BodyMotion motion = {velocity_change(change), {}};
        if (stage.simulation.needs.turning) motion.angular_velocity = angular_change(change);
        sum += twice_kinetic_energy(stage.simulation, stage.step, coloured.bodies[i], motion);
    }
    return sum;
}

void leave_part_of_changes(const ColouredStage& stage, Range bodies, float part) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        BodyChange& change = coloured.changes[i];
        for (float& v : change.velocity) v *= part;
        for (float& w : change.first_planes) w *= part;
        change.rest[0] *= part, change.rest[1] *= part;
    }
}

}  // namespace tesserae
