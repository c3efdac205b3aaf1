// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/lost_time.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/dynamics/contacts/find_contacts.hpp"
#include "core/dynamics/contacts/pairs.hpp"
#include "core/dynamics/motion/free_rotation.hpp"
#include "core/dynamics/motion/motion.hpp"

namespace tesserae {
namespace {

/// The most rounds of a sub-step. Usual 8. Fewer: what whirls on other bodies is slowed down.
/// More: a step takes longer in which something does.
constexpr int kRounds = 8;

}  // namespace

void LostTime::add(const Simulation& simulation, const StepData& step,
                   const FastBodies& fast_bodies) {
    if (fast_bodies.stopped().empty()) return;
    left_.resize(simulation.bodies.size());
    for (const BodyId id : fast_bodies.stopped())
        if (simulation.joints.connected_with(id).empty())
            left_[id] += 0.5 * step.h - fast_bodies.moved_for(id);
}

/// A round in which bodies stop early, as it would cost too much, is the last one.
void LostTime::regain(const Simulation& simulation, StepData& step, Schedule& schedule,
                      FastBodies& fast_bodies, FunctionRef<void(StepData&)> solve_impacts) {
    swap_bodies(step);
    round_.dt = step.dt, round_.substep = step.substep;
    round_.kick = 0;
    std::size_t gaps = fast_bodies.gaps();
    for (int round = 0; round < kRounds && gaps < fast_bodies.most_gaps(); ++round) {
        schedule.look_for_stop();
        round_.h = *std::max_element(left_.begin(), left_.end());
        if (!(round_.h > 0)) break;
        find_contacts(simulation);
        solve_impacts(round_);
        advance(simulation, schedule);
        fast_bodies.stop(simulation, round_, schedule, left_);
        end_round(simulation, fast_bodies);
        gaps += fast_bodies.gaps();
    }
    swap_bodies(step);
}

/// Rounds go on from where the bodies are, and have contacts and islands of their own.
void LostTime::swap_bodies(StepData& step) {
    const auto swap = [&](auto... members) { (std::swap(round_.*members, step.*members), ...); };
    swap(&StepData::position, &StepData::rotor, &StepData::velocity, &StepData::angular_velocity,
         &StepData::inverse_inertia, &StepData::bounds, &StepData::pairs, &StepData::asleep,
         &StepData::impact_motion);
}

/// Finds the contacts of the bodies that have time left, and those of what they touch, which bear
/// it. A sleeping body wakes in the next step; what touches it waits.
void LostTime::find_contacts(const Simulation& simulation) {
    contacts_.clear();
    const auto find = [&](const BodyPair& pair) {
        const std::size_t first = contacts_.size();
        const double margin = margins_of(simulation, round_, pair.a, pair.b).as_they_move;
        find_contacts_of(simulation, round_, pair, margin, contacts_);
        if (contacts_.size() == first) return false;
        for (const BodyId id : {pair.a, pair.b})
            if (simulation.type_of(id).bounded && !is_asleep(round_, id))
                set_inverse_inertia(simulation, round_, id);
        if (!is_asleep(round_, pair.a) && !is_asleep(round_, pair.b)) return true;
        left_[pair.a] = left_[pair.b] = 0;
        contacts_.resize(first);
        return false;
    };
    is_late_.assign(left_.size(), 0), is_met_.assign(left_.size(), 0);
    for (BodyId id = 0; id < left_.size(); ++id) is_late_[id] = left_[id] > 0;
    for (const BodyPair& pair : round_.pairs)
        if ((is_late_[pair.a] || is_late_[pair.b]) && find(pair))
            for (const BodyId id : {pair.a, pair.b}) is_met_[id] = simulation.type_of(id).movable;
    for (const BodyPair& pair : round_.pairs)
        if (!is_late_[pair.a] && !is_late_[pair.b] && (is_met_[pair.a] || is_met_[pair.b]))
            find(pair);
    std::sort(contacts_.begin(), contacts_.end(),
              [](const Contact& c, const Contact& d) { return key_of(c) < key_of(d); });
    round_.contacts = ContactList(contacts_);
}

void LostTime::advance(const Simulation& simulation, Schedule& schedule) {
    for (BodyId id = 0; id < left_.size(); ++id) {
        if (!(left_[id] > 0)) continue;
        round_.position[id] += left_[id] * round_.velocity[id];
        if (simulation.needs.turning)
            turn_freely(simulation.type_of(id), simulation.settings.integrator, left_[id],
                        round_.rotor[id], round_.angular_velocity[id]);
    }
    const Range all = {0, left_.size()};
    if (!has_left_bounds(simulation, round_, all)) return;
    update_bounds(simulation, round_, all);
    schedule.find_pairs(simulation, round_);
    leave_jointed_pairs_out(simulation, round_);
}

/// Of the time that was left, what is left now. Gravity's work changes the speed of what moved.
void LostTime::end_round(const Simulation& simulation, const FastBodies& fast_bodies) {
    moved_.swap(left_);
    left_.assign(moved_.size(), 0);
    for (const BodyId id : fast_bodies.stopped()) {
        left_[id] = std::max(0.0, moved_[id] - fast_bodies.moved_for(id));
        moved_[id] -= left_[id];
    }
    for (BodyId id = 0; id < moved_.size(); ++id) {
        Vec4& v = round_.velocity[id];
        const double squared = v.squaredNorm();
        if (!(moved_[id] > 0 && squared > 0)) continue;
        const Vec4 gravity = simulation.type_of(id).gravity_scale * simulation.settings.gravity;
        v *= std::sqrt(std::max(0.0, 1 + 2 * moved_[id] * gravity.dot(v) / squared));
    }
}

}  // namespace tesserae
