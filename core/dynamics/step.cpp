#include "core/dynamics/step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tesserae {

LeftFiniteRange::LeftFiniteRange(BodyId id, double t)
    : RunError(fmt::format("body {} left the finite range in the step that ends at {} s; the last "
                           "good state is that of the step before",
                           id, t)),
      body(id),
      time(t) {}

Simulation make_simulation(Bodies bodies, const PhysicsSettings& settings) {
    const std::size_t count = bodies.size();
    if (bodies.position.size() != count || bodies.rotor.size() != count ||
        bodies.velocity.size() != count || bodies.angular_velocity.size() != count)
        throw InputError(fmt::format("bodies: the arrays of {} bodies differ in length", count));
    if (count >= std::numeric_limits<BodyId>::max())
        throw InputError(fmt::format("{} bodies: at most 2^32 - 2 can be numbered", count));
    for (std::uint32_t type : bodies.type)
        if (type >= bodies.types.size())
            throw InputError(fmt::format("bodies: type {} of {}", type, bodies.types.size()));

    Simulation simulation;
    simulation.types = type_properties(bodies);
    simulation.bodies = std::move(bodies);
    simulation.settings = settings;
    return simulation;
}

void begin_step(const Simulation& simulation, StepData& step, double dt) {
    if (!(std::isfinite(dt) && dt > 0))
        throw InputError(fmt::format("time step = {} s: must be finite and > 0", dt));
    const std::size_t count = simulation.bodies.size();
    step.dt = dt;
    step.position.resize(count);
    step.rotor.resize(count);
    step.velocity.resize(count);
    step.angular_velocity.resize(count);
    step.bounds.resize(count);
}

void begin_contacts(StepData& step) {
    step.rows.resize(step.contacts.size());
    step.impulses.resize(step.contacts.size());
}

void require_finite(const Simulation& simulation, const StepData& step) {
    for (std::size_t i = 0; i < step.position.size(); ++i) {
        const Rotor& r = step.rotor[i];
        const double squares = step.position[i].squaredNorm() + step.velocity[i].squaredNorm() +
                               dot(step.angular_velocity[i], step.angular_velocity[i]) +
                               (r.s * r.s + dot(r.b, r.b) + r.p * r.p);
        if (!std::isfinite(squares))
            throw LeftFiniteRange(static_cast<BodyId>(i), simulation.memory.time + step.dt);
    }
}

StepReport commit_step(Simulation& simulation, StepData& step) {
    std::swap(simulation.bodies.position, step.position);
    std::swap(simulation.bodies.rotor, step.rotor);
    std::swap(simulation.bodies.velocity, step.velocity);
    std::swap(simulation.bodies.angular_velocity, step.angular_velocity);

    StepReport report;
    simulation.memory.time += step.dt;
    simulation.memory.impulses.clear();
    for (std::size_t i = 0; i < step.contacts.size(); ++i) {
        const double separation = step.contacts[i].separation;
        const bool pushed = step.impulses[i].normal > 0;
        if (pushed) simulation.memory.impulses.push_back(step.impulses[i]);
        if (pushed || separation <= 0) ++report.contacts;
        report.penetration = std::max(report.penetration, -separation);
    }
    return report;
}

}  // namespace tesserae
