// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/step/step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/dynamics/motion/sleeping.hpp"
#include "core/dynamics/step/room.hpp"

namespace tesserae {
namespace {

StepReport report_of(const Simulation& simulation, const StepData& step) {
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
    for (const int sweeps : step.sweeps)
        report.sweeps = std::max(report.sweeps, static_cast<std::uint64_t>(sweeps));
    if (step.asleep.empty()) return report;
    for (const KeptImpulse& impulse : simulation.memory.impulses)
        if (is_asleep(step, impulse.a) || is_asleep(step, impulse.b)) ++report.contacts;
    for (BodyId id = 0; id < step.asleep.size(); ++id) report.asleep += is_asleep(step, id);
    return report;
}

KeptImpulse kept_impulse(const StepData& step, std::size_t contact) {
    const Contact c = step.contacts[contact];
    return {step.impulses[contact], c.a, c.b, c.feature};
}

}  // namespace

LeftFiniteRange::LeftFiniteRange(BodyId id, double t)
    : RunError(fmt::format("body {} left the finite range in the step that ends at {} s; the last "
                           "good state is that of the step before",
                           id, t)),
      body(id),
      time(t) {}

Simulation make_simulation(Bodies bodies, const PhysicsSettings& settings,
                           std::vector<Joint> joints, std::span<const BodyId> turned) {
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
    simulation.joints = make_joints(std::move(joints), bodies);
    std::vector<BodyId> not_only_touched(turned.begin(), turned.end());
    for (const Joint& joint : simulation.joints.all)
        for (const BodyId id : {joint.a, joint.b})
            if (id != kWorld) not_only_touched.push_back(id);
    simulation.types = type_properties(bodies, not_only_touched);
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
    step.kick = step.h * simulation.settings.gravity.norm();
    step.substep = 0;
    step.joint_impulses = simulation.memory.joint_impulses;
    step.joint_impulses.resize(simulation.joints.parts());
    step.part_sums.assign(simulation.joints.parts(), {});
    step.asleep = simulation.memory.asleep;
    if (simulation.settings.sleeping) step.asleep.resize(count, kAwake);
    step.position.resize(count);
    step.velocity.resize(count);
    step.bounds.resize(count);
    if (simulation.needs.uneven_inertia) step.inverse_inertia.resize(count);
    if (simulation.needs.restitution) step.impact_motion.resize(count);
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

LeftImpulses left_impulses(Simulation& simulation, StepData& step) {
    if (step.substep + 1 < simulation.settings.substeps)
        return {step.warm_start, step.warm_start_angular};
    return {simulation.memory.impulses, simulation.memory.angular_impulses};
}

KeptImpulses::Size count_pushing(const StepData& step, Range contacts) {
    KeptImpulses::Size count;
    for (std::size_t begin = contacts.begin; begin < contacts.end;) {
        const std::size_t end = step.contacts.run(begin, contacts.end).end, before = count.impulses;
        for (std::size_t i = begin; i < end; ++i)
            count.impulses += step.impulses[i].normal > 0 ? 1 : 0;
        count.runs += count.impulses > before ? 1 : 0;
        begin = end;
    }
    return count;
}

void keep_pushing(const Simulation& simulation, const StepData& step, Range contacts,
                  KeptImpulses::Size first, const LeftImpulses& left) {
    auto [run_place, place] = first;
    for (std::size_t begin = contacts.begin; begin < contacts.end;) {
        const ContactList::Run run = step.contacts.run(begin, contacts.end);
        const std::size_t before = place;
        for (std::size_t i = run.begin; i < run.end; ++i) {
            if (!(step.impulses[i].normal > 0)) continue;
            left.impulses.put(place, step.impulses[i], step.contacts.feature(i));
            if (simulation.needs.rolling) left.angular[place] = step.angular_impulses[i];
            ++place;
        }
        if (place > before)
            left.impulses.put(run_place++,
                              KeptImpulses::Run{run.a, run.b, static_cast<std::uint32_t>(before)});
        begin = run.end;
    }
}

void merge_impulses(const Simulation& simulation, StepData& step, const LeftImpulses& left) {
    const bool rolling = simulation.needs.rolling;
    const KeptImpulses& last = last_impulses(simulation, step);
    const std::vector<Bivector>& last_angular = last_angular_impulses(simulation, step);
    const auto sleeps = [&](const auto& of) {
        return is_asleep(step, of.a) || is_asleep(step, of.b);
    };
    KeptImpulses::Size count = count_pushing(step, {0, step.impulses.size()});
    for (std::size_t run = 0; run < last.runs().size(); ++run)
        if (const KeptImpulses::Run& of = last.runs()[run]; sleeps(of))
            ++count.runs, count.impulses += last.end_of(run) - of.first;
    step.merged_impulses.reserve_anew(count);
    if (rolling) reserve_anew(step.merged_angular, count.impulses);

    std::size_t own = 0;
    const auto add_own = [&](const auto& comes_first) {
        for (; own < step.contacts.size() && comes_first(step.contacts[own]); ++own) {
            if (!(step.impulses[own].normal > 0)) continue;
            step.merged_impulses.push_back(kept_impulse(step, own));
            if (rolling) step.merged_angular.push_back(step.angular_impulses[own]);
        }
    };
    std::size_t place = 0;
    for (const KeptImpulse& impulse : last) {
        const std::size_t i = place++;
        if (!sleeps(impulse)) continue;
        add_own([&](const Contact& c) { return key_of(c) < key_of(impulse); });
        step.merged_impulses.push_back(impulse);
        if (rolling) step.merged_angular.push_back(last_angular[i]);
    }
    add_own([](const Contact&) { return true; });
    std::swap(left.impulses, step.merged_impulses);
    left.angular.swap(step.merged_angular);
}

void begin_report(StepData& step) {
    step.sums.resize((step.contacts.size() + kReportPiece - 1) / kReportPiece);
}

void sum_contacts(StepData& step, Range contacts) {
    for (std::size_t begin = contacts.begin; begin < contacts.end; begin += kReportPiece) {
        ContactSums sums;
        for (std::size_t i = begin; i < std::min(begin + kReportPiece, contacts.end); ++i) {
            // Whether points touch alternates: a branch would be guessed wrong. The overlap of
            // those that do not is 0.
            const double separation = step.contacts.separation(i);
            const double overlap = std::max(0.0, -separation);
            const int touches = !(separation > 0), is_hit = step.hit[i] > 0;
            const int pushes = step.impulses[i].normal > 0;
            sums.contacts += touches | pushes | is_hit;
            sums.sum += overlap;
            sums.penetration = std::max(sums.penetration, overlap);
        }
        step.sums[begin / kReportPiece] = sums;
    }
}

StepReport commit_step(Simulation& simulation, StepData& step) {
    const StepReport report = report_of(simulation, step);
    StepMemory& memory = simulation.memory;
    memory.time += step.dt;
    if (simulation.settings.sleeping) fall_asleep(simulation, step);
    std::swap(memory.asleep, step.asleep);
    std::swap(memory.kept, step.kept);
    std::swap(memory.joint_impulses, step.joint_impulses);
    break_joints(simulation, step);
    std::swap(simulation.bodies.position, step.position);
    std::swap(simulation.bodies.rotor, step.rotor);
    std::swap(simulation.bodies.velocity, step.velocity);
    std::swap(simulation.bodies.angular_velocity, step.angular_velocity);
    return report;
}

}  // namespace tesserae
