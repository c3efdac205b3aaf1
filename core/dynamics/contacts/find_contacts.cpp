// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/find_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/constants.hpp"
#include "core/dynamics/contacts/pairs.hpp"
#include "core/dynamics/contacts/rims.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/step/room.hpp"
#include "core/error.hpp"

namespace tesserae {
namespace {

/// The way of a body in a sub-step, in radii of the balls about both of a pair, from which it has
/// no contacts ahead with what its ball does not meet. Usual 16. Less: bodies that others drive
/// towards each other in the sub-step are stopped where they touch more often. More: a step takes
/// longer in which all bodies of a heap are fast.
constexpr double kFarWay = 16;

/// Whether the balls about two bodies meet within the sub-step, as they move or if one is stopped.
bool do_balls_meet(const Simulation& simulation, const StepData& step, const BodyPair& pair) {
    const TypeProperties& type_a = simulation.type_of(pair.a);
    const TypeProperties& type_b = simulation.type_of(pair.b);
    if (!type_a.bounded || !type_b.bounded) return true;
    const Vec4 between = step.position[pair.b] - step.position[pair.a];
    const double slop = std::min(type_a.slop, type_b.slop);
    const double touch = type_a.radius + type_b.radius + slop + step.h * step.kick;
    const auto meet = [&](const Vec4& velocity) {
        const double squared = velocity.squaredNorm();
        const double nearest =
            squared > 0 ? std::clamp(-between.dot(velocity) / squared, 0.0, step.h) : 0;
        return !((between + nearest * velocity).norm() > touch);
    };
    const Vec4 &v_a = step.velocity[pair.a], &v_b = step.velocity[pair.b];
    return meet(v_b - v_a) || meet(v_b) || meet(-v_a);
}

/// How long the points of a body are near the straight ways on which contacts ahead take them to
/// be, at most the sub-step [s]: turning takes them off these by as much as is left to the solver.
double straight_time(const Simulation& simulation, const StepData& step, BodyId id, double spin) {
    const TypeProperties& type = simulation.type_of(id);
    const double off = 0.5 * type.arm * spin * spin, most = 2 * kDeepest / kSlop * type.slop;
    return step.h * step.h * off > most ? std::sqrt(most / off) : step.h;
}

/// Whether two bodies can touch within the sub-step, by where the balls about them can get.
bool may_touch(const Simulation& simulation, const StepData& step, const BodyPair& pair) {
    const auto bounds = [&](BodyId id) {
        return Bounds{step.position[id], reach(simulation, step, id, step.h)};
    };
    const auto& [a, b] = pair;
    if (!simulation.type_of(a).bounded)
        return reaches(bounds(b), simulation.bodies.type_of(a).shape);
    if (!simulation.type_of(b).bounded)
        return reaches(bounds(a), simulation.bodies.type_of(b).shape);
    const Bounds of_a = bounds(a), of_b = bounds(b);
    return !((of_b.centre - of_a.centre).norm() > of_a.radius + of_b.radius);
}

}  // namespace

Margins margins_of(const Simulation& simulation, const StepData& step, BodyId a, BodyId b) {
    const TypeProperties &type_a = simulation.type_of(a), &type_b = simulation.type_of(b);
    const Vec4 &v_a = step.velocity[a], &v_b = step.velocity[b];
    const double relative = (v_b - v_a).norm();
    const double fastest = std::max(v_a.norm(), v_b.norm());
    double speed = relative, time = step.h;
    for (const BodyId id : {a, b}) {
        const double arm = simulation.type_of(id).arm;
        if (!(arm > 0)) continue;
        const double spin = norm(step.angular_velocity[id]);
        speed += arm * spin;
        time = std::min(time, straight_time(simulation, step, id, spin));
    }
    speed += std::abs(type_b.gravity_scale - type_a.gravity_scale) * step.kick;
    const double slop = std::min(type_a.slop, type_b.slop), margin = slop + time * speed;
    if (!may_touch(simulation, step, {a, b})) return {slop, slop};
    if (step.h * fastest > kFarWay * (type_a.radius + type_b.radius) &&
        !do_balls_meet(simulation, step, {a, b}))
        return {slop, slop};
    // What would sink in deeper than this is stopped where it touches.
    const double most = 2 * kDeepest / kSlop * slop;
    return {margin, margin + std::clamp(time * (fastest - relative), 0.0, most)};
}

double find_contacts_of(const Simulation& simulation, const StepData& step, const BodyPair& pair,
                        double margin, std::vector<Contact>& list) {
    const auto [a, b] = pair;
    const Bodies& bodies = simulation.bodies;
    const std::size_t first = list.size();
    const double apart =
        find_contacts(a, bodies.type_of(a).shape, {step.position[a], step.rotor[a]}, b,
                      bodies.type_of(b).shape, {step.position[b], step.rotor[b]}, margin, list);
    if (simulation.needs.rims) add_rim_ahead(simulation, step, pair, first, list);
    return apart;
}

void find_contacts(const Simulation& simulation, const StepData& step, Range pairs,
                   std::vector<Contact>& list) {
    for (std::size_t i = pairs.begin; i < pairs.end; ++i) {
        const BodyPair& pair = step.pairs[i];
        find_contacts_of(simulation, step, pair,
                         margins_of(simulation, step, pair.a, pair.b).if_one_stops, list);
    }
}

void begin_contacts(const Simulation& simulation, StepData& step) {
    resize_anew(step.impulses, step.contacts.size());
    if (simulation.needs.rolling) resize_anew(step.angular_impulses, step.contacts.size());
    resize_anew(step.hit, step.contacts.size());
    std::fill(step.hit.begin(), step.hit.end(), 0.0);
    step.residual.clear();
    step.sweeps.clear();
    if (!simulation.needs.rims) return;
    resize_anew(step.rises, step.contacts.size());
    resize_anew(step.rim_slips, step.contacts.size());
}

void find_warm_starts(const Simulation& simulation, StepData& step, Range contacts) {
    if (contacts.begin == contacts.end) return;
    const KeptImpulses& last = last_impulses(simulation, step);
    const std::vector<Bivector>& angular = last_angular_impulses(simulation, step);
    TSR_ASSERT(!simulation.needs.rolling || angular.size() == last.size());
    const auto bodies_of = [](const KeptImpulses::Run& run) { return BodyPair{run.a, run.b}; };
    // As a pair: clang 14 lets no lambda have a structured binding.
    const auto [a, b] = step.contacts.pair(contacts.begin);
    const BodyPair first = {a, b};
    auto old =
        std::partition_point(last.runs().begin(), last.runs().end(),
                             [&](const KeptImpulses::Run& run) { return bodies_of(run) < first; });
    for (std::size_t begin = contacts.begin; begin < contacts.end;) {
        const ContactList::Run run = step.contacts.run(begin, contacts.end);
        const BodyPair pair = {run.a, run.b};
        while (old != last.runs().end() && bodies_of(*old) < pair) ++old;
        // All of the pair: [place, end).
        std::size_t place = 0, end = 0;
        for (auto of = old; of != last.runs().end() && bodies_of(*of) == pair; ++of) {
            if (of == old) place = of->first;
            end = last.end_of(static_cast<std::size_t>(of - last.runs().begin()));
        }
        for (std::size_t i = run.begin; i < run.end; ++i) {
            const std::uint32_t feature = step.contacts.feature(i);
            while (place < end && last.feature(place) < feature) ++place;
            const bool known = place < end && last.feature(place) == feature;
            step.impulses[i] = known ? last.impulse(place) : ContactImpulse{};
            if (simulation.needs.rolling)
                step.angular_impulses[i] = known ? angular[place] : Bivector{};
        }
        begin = run.end;
    }
}

}  // namespace tesserae
