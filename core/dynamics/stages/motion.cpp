#include "core/dynamics/stages/motion.hpp"

#include <limits>

#include "core/dynamics/stages/free_path.hpp"
#include "core/dynamics/stages/free_rotation.hpp"

namespace tesserae {
namespace {

void advance_half(const Simulation& simulation, StepData& step, BodyId id) {
    const TypeProperties& type = simulation.type_of(id);
    if (!type.bounded) return;
    const double half = 0.5 * step.h;
    step.position[id] += half * step.velocity[id];
    if (!simulation.needs.turning) return;
    turn_freely(type, simulation.settings.integrator, half, step.rotor[id],
                step.angular_velocity[id]);
}

/// How far from where it is a body's surface can get within a time.
double reach(const Simulation& simulation, const StepData& step, BodyId id, double time) {
    const TypeProperties& type = simulation.type_of(id);
    double speed = step.velocity[id].norm();
    if (type.falls) speed += time * simulation.settings.gravity.norm();
    return type.radius + type.slop + time * speed;
}

}  // namespace

bool advance_first_half(const Simulation& simulation, StepData& step, Range bodies) {
    const Bodies& last = simulation.bodies;
    bool any_fast = false;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const auto id = static_cast<BodyId>(i);
        if (step.substep == 0) {
            step.position[id] = last.position[id];
            step.velocity[id] = last.velocity[id];
            if (simulation.needs.turning) {
                step.rotor[id] = last.rotor[id];
                step.angular_velocity[id] = last.angular_velocity[id];
            }
        }
        advance_half(simulation, step, id);
        any_fast = is_fast(simulation, step, id) || any_fast;
        if (!is_asleep(step, id)) set_inverse_inertia(simulation, step, id);
    }
    return any_fast;
}

bool advance_second_half(const Simulation& simulation, StepData& step, Range bodies) {
    bool any_fast = false;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const auto id = static_cast<BodyId>(i);
        advance_half(simulation, step, id);
        any_fast = is_fast(simulation, step, id) || any_fast;
    }
    return any_fast;
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
        if (simulation.type_of(id).falls && !is_asleep(step, id)) step.velocity[id] += change;
    }
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
