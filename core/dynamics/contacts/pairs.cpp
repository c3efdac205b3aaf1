// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/pairs.hpp"

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

bool is_pair_of_overlapping(const Simulation& simulation, const StepData& step, BodyId a,
                            BodyId b) {
    const TypeProperties& type_a = simulation.type_of(a);
    const TypeProperties& type_b = simulation.type_of(b);
    if (!type_a.movable && !type_b.movable) return false;
    if (!collide(type_a, type_b)) return false;
    if (!step.asleep.empty() && !is_active(simulation, step, a) && !is_active(simulation, step, b))
        return false;
    if (!type_a.bounded) return reaches(step.bounds[b], simulation.bodies.type_of(a).shape);
    if (!type_b.bounded) return reaches(step.bounds[a], simulation.bodies.type_of(b).shape);
    return true;
}

void test_all_pairs(const Simulation& simulation, StepData& step) {
    step.pairs.clear();
    const auto count = static_cast<BodyId>(simulation.bodies.size());
    for (BodyId a = 0; a < count; ++a)
        for (BodyId b = a + 1; b < count; ++b)
            if (is_pair(simulation, step, a, b)) step.pairs.push_back({a, b});
}

}  // namespace tesserae
