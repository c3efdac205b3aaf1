#include "core/dynamics/pairs.hpp"

#include <algorithm>

#include "core/contact/find_contacts.hpp"

namespace tesserae {
namespace {

bool is_active(const Simulation& simulation, const StepData& step, BodyId id) {
    return (simulation.type_of(id).movable && !is_asleep(step, id)) || is_driven(simulation, id);
}

}  // namespace

bool reaches(const Bounds& bounded, const Shape& unbounded) {
    return std::visit(
        [&](const auto& shape) { return signed_distance(shape, bounded.centre) <= bounded.radius; },
        unbounded);
}

bool is_pair(const Simulation& simulation, const StepData& step, BodyId a, BodyId b) {
    if (!overlap(step.bounds[a], step.bounds[b])) return false;  // the unbounded's are infinite
    const TypeProperties& type_a = simulation.type_of(a);
    const TypeProperties& type_b = simulation.type_of(b);
    if (!type_a.movable && !type_b.movable) return false;
    if (!step.asleep.empty() && !is_active(simulation, step, a) && !is_active(simulation, step, b))
        return false;
    if (!type_a.bounded) return reaches(step.bounds[b], simulation.bodies.type_of(a).shape);
    if (!type_b.bounded) return reaches(step.bounds[a], simulation.bodies.type_of(b).shape);
    return true;
}

void find_pairs(const Simulation& simulation, StepData& step) {
    step.pairs.clear();
    const auto count = static_cast<BodyId>(simulation.bodies.size());
    for (BodyId a = 0; a < count; ++a)
        for (BodyId b = a + 1; b < count; ++b)
            if (is_pair(simulation, step, a, b)) step.pairs.push_back({a, b});
}

void find_contacts(const Simulation& simulation, const StepData& step, Range pairs,
                   std::vector<Contact>& list) {
    const Bodies& bodies = simulation.bodies;
    const double h = step.h, gravity = simulation.settings.gravity.norm();
    for (std::size_t i = pairs.begin; i < pairs.end; ++i) {
        const auto [a, b] = step.pairs[i];
        const TypeProperties &type_a = simulation.type_of(a), &type_b = simulation.type_of(b);
        double speed = (step.velocity[b] - step.velocity[a]).norm();
        if (type_a.arm > 0) speed += type_a.arm * norm(step.angular_velocity[a]);
        if (type_b.arm > 0) speed += type_b.arm * norm(step.angular_velocity[b]);
        if (type_a.falls != type_b.falls) speed += h * gravity;
        const double margin = std::min(type_a.slop, type_b.slop) + h * speed;
        find_contacts(a, bodies.type_of(a).shape, {step.position[a], step.rotor[a]}, b,
                      bodies.type_of(b).shape, {step.position[b], step.rotor[b]}, margin, list);
    }
}

}  // namespace tesserae
