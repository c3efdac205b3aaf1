#include "core/dynamics/motion.hpp"

#include <limits>

namespace tesserae {
namespace {

/// The rotor after turning at a constant world angular velocity for a time h.
Rotor turned(const Rotor& rotor, const Bivector& omega, double h) {
    return projected_to_spin4(exp(-0.5 * h * omega) * rotor);
}

/// Turns a body freely for a time h: its angular momentum stays.
void turn(const TypeProperties& type, Integrator integrator, double h, Rotor& rotor,
          Bivector& omega) {
    if (omega == Bivector{}) return;
    if (type.isotropic) {
        rotor = turned(rotor, omega, h);
        return;
    }
    const Bivector momentum = angular_momentum(type, rotor, omega);
    Bivector mean = omega;
    if (integrator == Integrator::kMidpoint)
        mean = angular_response(type, turned(rotor, omega, 0.5 * h), momentum);
    rotor = turned(rotor, mean, h);
    omega = angular_response(type, rotor, momentum);
}

void advance_half(const Simulation& simulation, StepData& step, BodyId id) {
    const double h = 0.5 * step.dt;
    step.position[id] += h * step.velocity[id];
    turn(simulation.type_of(id), simulation.settings.integrator, h, step.rotor[id],
         step.angular_velocity[id]);
}

}  // namespace

void advance_first_half(const Simulation& simulation, StepData& step, Range bodies) {
    const Bodies& last = simulation.bodies;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const auto id = static_cast<BodyId>(i);
        step.position[id] = last.position[id];
        step.rotor[id] = last.rotor[id];
        step.velocity[id] = last.velocity[id];
        step.angular_velocity[id] = last.angular_velocity[id];
        if (simulation.type_of(id).bounded) advance_half(simulation, step, id);
    }
}

void advance_second_half(const Simulation& simulation, StepData& step, Range bodies) {
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const auto id = static_cast<BodyId>(i);
        if (simulation.type_of(id).bounded) advance_half(simulation, step, id);
    }
}

void integrate_velocities(const Simulation& simulation, StepData& step, Range bodies) {
    const Vec4 change = step.dt * simulation.settings.gravity;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const auto id = static_cast<BodyId>(i);
        if (simulation.type_of(id).falls) step.velocity[id] += change;
    }
}

void update_bounds(const Simulation& simulation, StepData& step, Range bodies) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const auto id = static_cast<BodyId>(i);
        const TypeProperties& type = simulation.type_of(id);
        Vec4 reach = Vec4::Constant(kInfinity);
        Vec4 centre = Vec4::Zero();
        if (type.bounded) {
            centre = step.position[id];
            reach.setConstant(type.radius + type.slop + step.dt * step.velocity[id].norm());
        }
        step.bounds[id] = {centre - reach, centre + reach};
    }
}

}  // namespace tesserae
