#include "core/dynamics/stages/step.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "core/dynamics/stages/sleeping.hpp"

namespace tesserae {
namespace {

StepReport report_of(const StepData& step) {
    StepReport report;
    double sum = 0;
    for (const ContactSums& piece : step.sums) {
        report.contacts += piece.contacts;
        sum += piece.sum;
        report.penetration = std::max(report.penetration, piece.penetration);
    }
    if (report.contacts > 0) report.mean_penetration = sum / static_cast<double>(report.contacts);
    for (const double residual : step.residual)
        report.residual = std::max(report.residual, residual);
    if (step.asleep.empty()) return report;
    for (const ContactImpulse& impulse : step.recalled)
        if (is_asleep(step, impulse.a) || is_asleep(step, impulse.b)) ++report.contacts;
    for (BodyId id = 0; id < step.asleep.size(); ++id) report.asleep += is_asleep(step, id);
    return report;
}

/// As end_substep() does with the impulses themselves, which are the last ones still.
void merge_angular_impulses(const Simulation& simulation, StepData& step) {
    const std::vector<ContactImpulse>& last = last_impulses(simulation, step);
    const std::vector<Bivector>& last_angular = last_angular_impulses(simulation, step);
    std::vector<Bivector>& all = step.merged_angular;
    all.clear();
    std::size_t own = 0;
    for (std::size_t i = 0; i < last.size(); ++i) {
        if (!is_asleep(step, last[i].a) && !is_asleep(step, last[i].b)) continue;
        for (; own < step.pushing.size() && key_of(step.pushing[own]) < key_of(last[i]); ++own)
            all.push_back(step.pushing_angular[own]);
        all.push_back(last_angular[i]);
    }
    for (; own < step.pushing.size(); ++own) all.push_back(step.pushing_angular[own]);
    step.recalled_angular.swap(all);
}

}  // namespace

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
    if (settings.substeps < 1)
        throw InputError(fmt::format("{} sub-steps: must be at least 1", settings.substeps));
    for (std::uint32_t type : bodies.type)
        if (type >= bodies.types.size())
            throw InputError(fmt::format("bodies: type {} of {}", type, bodies.types.size()));

    Simulation simulation;
    simulation.types = type_properties(bodies);
    simulation.needs = needs_of(bodies, simulation.types);
    simulation.bodies = std::move(bodies);
    simulation.settings = settings;
    return simulation;
}

void begin_step(const Simulation& simulation, StepData& step, double dt) {
    if (!(std::isfinite(dt) && dt > 0))
        throw InputError(fmt::format("time step = {} s: must be finite and > 0", dt));
    const std::size_t count = simulation.bodies.size();
    step.dt = dt;
    step.h = dt / simulation.settings.substeps;
    step.substep = 0;
    step.asleep = simulation.memory.asleep;
    if (simulation.settings.sleeping) step.asleep.resize(count, kAwake);
    step.position.resize(count);
    step.velocity.resize(count);
    step.bounds.resize(count);
    if (simulation.needs.uneven_inertia) step.inverse_inertia.resize(count);
    if (simulation.needs.restitution) step.blow_motion.resize(count);
    if (simulation.needs.turning) {
        step.rotor.resize(count);
        step.angular_velocity.resize(count);
    } else if (step.rotor.size() != count) {
        step.rotor = simulation.bodies.rotor;
        step.angular_velocity = simulation.bodies.angular_velocity;
    }
}

bool is_finite(const Simulation& simulation, const StepData& step, Range bodies) {
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        double squares = step.position[i].squaredNorm() + step.velocity[i].squaredNorm();
        if (simulation.needs.turning) {
            const Rotor& r = step.rotor[i];
            squares += dot(step.angular_velocity[i], step.angular_velocity[i]) +
                       (r.s * r.s + dot(r.b, r.b) + r.p * r.p);
        }
        if (!std::isfinite(squares)) return false;
    }
    return true;
}

void require_finite(const Simulation& simulation, const StepData& step) {
    for (std::size_t i = 0; i < step.position.size(); ++i)
        if (!is_finite(simulation, step, {i, i + 1}))
            throw LeftFiniteRange(static_cast<BodyId>(i), simulation.memory.time + step.dt);
}

void list_pushing(const StepData& step, Range contacts, std::vector<ContactImpulse>& list) {
    for (std::size_t i = contacts.begin; i < contacts.end; ++i)
        if (step.impulses[i].normal > 0) list.push_back(step.impulses[i]);
}

void list_pushing_angular(const StepData& step, Range contacts, std::vector<Bivector>& list) {
    for (std::size_t i = contacts.begin; i < contacts.end; ++i)
        if (step.impulses[i].normal > 0) list.push_back(step.angular_impulses[i]);
}

void end_substep(const Simulation& simulation, StepData& step) {
    if (step.asleep.empty()) {
        step.recalled.swap(step.pushing);
        step.recalled_angular.swap(step.pushing_angular);
        return;
    }
    if (simulation.needs.rolling) merge_angular_impulses(simulation, step);
    // Merge. The last impulses may be step.recalled, so that the list is another one.
    std::vector<ContactImpulse>& all = step.merged_impulses;
    all.clear();
    auto own = step.pushing.begin();
    for (const ContactImpulse& impulse : last_impulses(simulation, step)) {
        if (!is_asleep(step, impulse.a) && !is_asleep(step, impulse.b)) continue;
        for (; own != step.pushing.end() && key_of(*own) < key_of(impulse); ++own)
            all.push_back(*own);
        all.push_back(impulse);
    }
    // One by one, so that the list has room to grow: inserted at once it would have none, and be
    // moved at each new contact.
    std::copy(own, step.pushing.end(), std::back_inserter(all));
    step.recalled.swap(all);
}

void begin_report(StepData& step) {
    step.sums.resize((step.contacts.size() + kReportPiece - 1) / kReportPiece);
}

void sum_contacts(StepData& step, Range contacts) {
    for (std::size_t begin = contacts.begin; begin < contacts.end; begin += kReportPiece) {
        ContactSums sums;
        for (std::size_t i = begin; i < std::min(begin + kReportPiece, contacts.end); ++i) {
            const double separation = step.contacts[i].separation;
            if (separation > 0 && !(step.impulses[i].normal > 0) && !step.hit[i]) continue;
            const double overlap = std::max(0.0, -separation);
            ++sums.contacts;
            sums.sum += overlap;
            sums.penetration = std::max(sums.penetration, overlap);
        }
        step.sums[begin / kReportPiece] = sums;
    }
}

StepReport commit_step(Simulation& simulation, StepData& step) {
    const StepReport report = report_of(step);
    StepMemory& memory = simulation.memory;
    memory.time += step.dt;
    std::swap(memory.impulses, step.recalled);
    std::swap(memory.angular_impulses, step.recalled_angular);
    if (simulation.settings.sleeping) fall_asleep(simulation, step);
    std::swap(memory.asleep, step.asleep);
    std::swap(memory.kept, step.kept);
    std::swap(simulation.bodies.position, step.position);
    std::swap(simulation.bodies.rotor, step.rotor);
    std::swap(simulation.bodies.velocity, step.velocity);
    std::swap(simulation.bodies.angular_velocity, step.angular_velocity);
    return report;
}

}  // namespace tesserae
