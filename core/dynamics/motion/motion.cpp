// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/motion/free_path.hpp"
#include "core/dynamics/motion/free_rotation.hpp"

namespace tesserae {
namespace {

/// Of one body or of two.
void advance_half(const Simulation& simulation, StepData& step, Range bodies) {
    const double half = 0.5 * step.h;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i)
        if (simulation.type_of(static_cast<BodyId>(i)).bounded)
            step.position[i] += half * step.velocity[i];
    if (!simulation.needs.turning) return;
    const auto turning = [&](std::size_t i) {
        return FreeBody{simulation.type_of(static_cast<BodyId>(i)), step.rotor[i],
                        step.angular_velocity[i]};
    };
    const RotationIntegrator integrator = simulation.settings.integrator;
    const FreeBody a = turning(bodies.begin), b = turning(bodies.end - 1);
    if (bodies.end - bodies.begin == 2 && a.type.bounded && b.type.bounded)
        return turn_freely(a, b, integrator, half);
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const FreeBody body = turning(i);
        if (body.type.bounded) turn_freely(body.type, integrator, half, body.rotor, body.omega);
    }
}

/// Calls visit(one body or two) for all.
template <class Visit>
void for_twos(Range bodies, const Visit& visit) {
    for (std::size_t i = bodies.begin; i < bodies.end; i += 2)
        visit(Range{i, std::min(i + 2, bodies.end)});
}

}  // namespace

bool advance_first_half(const Simulation& simulation, StepData& step, Range bodies) {
    const Bodies& last = simulation.bodies;
    bool any_fast = false;
    for_twos(bodies, [&](Range some) {
        for (std::size_t i = some.begin; step.substep == 0 && i < some.end; ++i) {
            step.position[i] = last.position[i];
            step.velocity[i] = last.velocity[i];
            if (!simulation.needs.turning) continue;
            step.rotor[i] = last.rotor[i];
            step.angular_velocity[i] = last.angular_velocity[i];
        }
        if (simulation.needs.damping) damp_half(simulation, step, some);
        advance_half(simulation, step, some);
        for (std::size_t i = some.begin; i < some.end; ++i) {
            const auto id = static_cast<BodyId>(i);
            any_fast = is_fast(simulation, step, id) || any_fast;
            if (!is_asleep(step, id)) set_inverse_inertia(simulation, step, id);
        }
    });
    return any_fast;
}

bool advance_second_half(const Simulation& simulation, StepData& step, Range bodies) {
    bool any_fast = false;
    for_twos(bodies, [&](Range some) {
        advance_half(simulation, step, some);
        for (std::size_t i = some.begin; i < some.end; ++i)
            any_fast = is_fast(simulation, step, static_cast<BodyId>(i)) || any_fast;
    });
    return any_fast;
}

void displace(const Simulation& simulation, StepData& step, BodyId id, const BodyMotion& motion) {
    const TypeProperties& type = simulation.type_of(id);
    const double most = kDeepest / kSlop * type.slop;
    const double speed = motion.velocity.norm() + type.arm * norm(motion.angular_velocity);
    double time = 0.5 * step.h;
    if (time * speed > most) time = most / speed;
    step.position[id] += time * motion.velocity;
    if (motion.angular_velocity == Bivector{}) return;
    const Rotor turn = exp(-0.5 * time * motion.angular_velocity);
    step.rotor[id] = projected_to_spin4(turn * step.rotor[id]);
    if (!type.isotropic) step.angular_velocity[id] = rotate(turn, step.angular_velocity[id]);
}

void set_inverse_inertia(const Simulation& simulation, StepData& step, BodyId id) {
    const TypeProperties& type = simulation.type_of(id);
    if (!type.isotropic)
        step.inverse_inertia[id] = world_map(type.inverse_inertia, type, step.rotor[id]);
}

void integrate_velocities(const Simulation& simulation, StepData& step, Range bodies) {
    const Vec4 change = step.h * simulation.settings.gravity;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const auto id = static_cast<BodyId>(i);
        const double scale = simulation.type_of(id).gravity_scale;
        if (scale != 0 && !is_asleep(step, id)) step.velocity[id] += scale * change;
    }
    if (simulation.forces.empty()) return;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const TypeProperties& type = simulation.type_of(static_cast<BodyId>(i));
        const auto& [force, moment] = simulation.forces[i];
        step.velocity[i] += step.h * type.inverse_mass * force;
        if (moment == Bivector{}) continue;
        const Bivector impulse = step.h * moment;
        step.angular_velocity[i] += angular_response(type, step.rotor[i], impulse);
    }
}

void damp_half(const Simulation& simulation, StepData& step, Range bodies) {
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const TypeProperties& type = simulation.type_of(static_cast<BodyId>(i));
        if (type.damping > 0) step.velocity[i] *= std::exp(-0.5 * step.h * type.damping);
        if (type.angular_damping > 0 && simulation.needs.turning)
            step.angular_velocity[i] =
                std::exp(-0.5 * step.h * type.angular_damping) * step.angular_velocity[i];
    }
}

double reach(const Simulation& simulation, const StepData& step, BodyId id, double time) {
    const TypeProperties& type = simulation.type_of(id);
    double speed = step.velocity[id].norm();
    speed += time * std::abs(type.gravity_scale) * simulation.settings.gravity.norm();
    return type.radius + type.slop + time * speed;
}

void update_bounds(const Simulation& simulation, StepData& step, Range bodies) {
    const double rest = step.dt - step.substep * step.h;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const auto id = static_cast<BodyId>(i);
        if (simulation.type_of(id).bounded)
            step.bounds[id] = {step.position[id], reach(simulation, step, id, rest)};
        else
            step.bounds[id] = {Vec4::Zero(), std::numeric_limits<double>::infinity()};
    }
}

bool outgrows_bounds(const Simulation& simulation, const StepData& step, Range bodies) {
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const auto id = static_cast<BodyId>(i);
        if (!simulation.type_of(id).bounded) continue;
        const Bounds& bounds = step.bounds[id];
        const double moved = (step.position[id] - bounds.centre).norm();
        if (moved + reach(simulation, step, id, step.h) > bounds.radius) return true;
    }
    return false;
}

bool has_left_bounds(const Simulation& simulation, const StepData& step, Range bodies) {
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const TypeProperties& type = simulation.type_of(static_cast<BodyId>(i));
        if (!type.bounded) continue;
        const double moved = (step.position[i] - step.bounds[i].centre).norm();
        if (moved + type.radius > step.bounds[i].radius) return true;
    }
    return false;
}

}  // namespace tesserae
