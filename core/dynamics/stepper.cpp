// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/stepper.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "core/dynamics/constraints/pose_joints.hpp"
#include "core/dynamics/contacts/find_contacts.hpp"
#include "core/dynamics/contacts/kept_manifolds.hpp"
#include "core/dynamics/contacts/rims.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/motion/sleeping.hpp"
#include "core/dynamics/solver/impact.hpp"
#include "core/dynamics/step/room.hpp"

namespace tesserae {
namespace {

/// Items of a range at least: some 10 to 50 us of work, far more than a thread costs that takes it.
constexpr std::size_t kBodyGrain = 256, kPairGrain = 64, kContactGrain = 1024, kJointGrain = 16;

}  // namespace

/// A stage from its beginning to its end.
class Stepper::Observed {
  public:
    Observed(const Stepper& world, Stage stage, std::size_t items)
        : observer_(world.observer_), stage_(stage) {
        if (observer_) observer_->begin(stage, items, world.simulation_, world.step_);
    }
    ~Observed() {
        if (observer_) observer_->end(stage_);
    }
    Observed(const Observed&) = delete;
    Observed& operator=(const Observed&) = delete;

  private:
    StageObserver* observer_;
    Stage stage_;
};

Stepper::Stepper(Bodies bodies, const PhysicsSettings& settings)
    : Stepper(make_simulation(std::move(bodies), settings)) {}

Stepper::Stepper(Simulation simulation, ColouredFrom coloured_from)
    : simulation_(std::move(simulation)), island_builder_(coloured_from) {}

StepReport Stepper::step(double dt) {
    Schedule serial;
    return step(dt, serial);
}

StepReport Stepper::step(double dt, Schedule& schedule, const StopQuestion* stop) {
    schedule.ask(stop);
    schedule.look_for_stop();
    try {
        return whole_step(dt, schedule);
    } catch (const Stopped&) {
        clearances_ = {};  // they may be half of this step and half of the last one
        throw;
    }
}

StepReport Stepper::whole_step(double dt, Schedule& schedule) {
    if (simulation_.joints.broken != memory().broken)
        set_broken(simulation_.joints, bodies(), memory().broken);
    begin_step(simulation_, step_, dt);
    for (step_.substep = 0; step_.substep < simulation_.settings.substeps; ++step_.substep) {
        advance_first_half(schedule);  // free motion to the middle, where contacts act
        find_pairs(schedule);          // broad phase
        stop_fast_bodies(schedule, FastBodies::Half::kFirst);  // nothing passes through
        find_contacts(schedule);  // narrow phase, contacts keyed by feature id
        pose_joints(schedule);
        build_islands();
        solve_impacts(schedule);         // what hits: compression, restitution
        integrate_velocities(schedule);  // gravity
        solve_islands(schedule);         // what rests: sequential impulses, warm started
        advance_second_half(schedule);   // rotors projected to unit rotors
        stop_fast_bodies(schedule, FastBodies::Half::kSecond);
        regain_lost_time(schedule);   // impacts of what was stopped, which goes on
        apply_corrections(schedule);  // what only took overlap away is in no velocity
    }
    return finish_step(schedule);
}

void Stepper::put_back_arrays() {
    const auto put_back = [](auto& result, auto& begun_with) {
        result.swap(begun_with);
        result = begun_with;
    };
    put_back(simulation_.bodies.position, step_.position);
    put_back(simulation_.bodies.rotor, step_.rotor);
    put_back(simulation_.bodies.velocity, step_.velocity);
    put_back(simulation_.bodies.angular_velocity, step_.angular_velocity);
}

void Stepper::advance_first_half(Schedule& schedule) {
    const Observed stage(*this, Stage::kAdvanceFirstHalf, simulation_.bodies.size());
    step_.rows_in_use = false;
    lost_time_.begin();
    has_fast_.assign(simulation_.bodies.size() / kBodyGrain + 1, 0);
    schedule.for_each_range(simulation_.bodies.size(), kBodyGrain, [&](Range bodies) {
        has_fast_[bodies.begin / kBodyGrain] =
            tesserae::advance_first_half(simulation_, step_, bodies);
    });
    require_finite(schedule);
}

void Stepper::find_pairs(Schedule& schedule) {
    const std::size_t count = simulation_.bodies.size();
    const Observed stage(*this, Stage::kFindPairs, count);
    const auto outgrows = [&](Range bodies) { return outgrows_bounds(simulation_, step_, bodies); };
    if (step_.substep > 0 && !schedule.any_range(count, kBodyGrain, outgrows)) return;
    find_pairs_anew(schedule);
}

void Stepper::find_pairs_anew(Schedule& schedule) {
    schedule.for_each_range(simulation_.bodies.size(), kBodyGrain,
                            [&](Range bodies) { update_bounds(simulation_, step_, bodies); });
    schedule.find_pairs(simulation_, step_);
    leave_jointed_pairs_out(simulation_, step_);
}

void Stepper::find_contacts(Schedule& schedule) {
    const Observed stage(*this, Stage::kFindContacts, step_.pairs.size());
    if (step_.substep > 0) step_.last_kept.swap(step_.kept);
    do find_manifolds(schedule);
    while (wake_touched(schedule));
    if (simulation_.needs.manifolds) clearances_.end(step_, schedule);
    if (simulation_.needs.internal_edges) internal_edges_.correct(simulation_, step_, schedule);
    find_warm_starts(schedule);
    if (simulation_.needs.rims) aim_rims(schedule);
    first_loads_.guess(simulation_, step_, schedule);
}

/// What the sub-step before this one kept.
const std::vector<KeptManifolds>& Stepper::last_kept() const {
    return step_.substep > 0 ? step_.last_kept : simulation_.memory.kept;
}

void Stepper::find_manifolds(Schedule& schedule) {
    if (simulation_.needs.manifolds) {
        begin_kept(step_, kPairGrain, last_kept(), spare_manifolds_);
        clearances_.begin(simulation_, step_, schedule);
    }
    step_.contacts.restart();
    const auto for_each_range = [&](auto... of) { schedule.for_each_range(of...); };
    const auto find = [&](Range pairs, auto& list) { find_contacts_of(pairs, list); };
    const auto append = [&](const auto&... of) { step_.contacts.append(for_each_range, of...); };
    contacts_.for_each_wave(for_each_range, step_.pairs.size(), kPairGrain, find, append);
}

void Stepper::find_contacts_of(Range pairs, std::vector<Contact>& list) {
    if (!simulation_.needs.manifolds)
        return tesserae::find_contacts(simulation_, step_, pairs, list);
    const std::size_t first = pairs.begin / kPairGrain;
    const std::size_t end = (pairs.end + kPairGrain - 1) / kPairGrain;
    find_kept_contacts(simulation_, step_, pairs, last_kept(),
                       std::span(step_.kept).subspan(first, end - first), spare_manifolds_,
                       clearances_, list);
}

/// @return whether any body woke: then there are other pairs
bool Stepper::wake_touched(Schedule& schedule) {
    const auto touches = [&](Range contacts) { return touches_sleeper(step_, contacts); };
    const bool wakes = schedule.any_range(step_.contacts.size(), kContactGrain, touches) &&
                       tesserae::wake_touched(simulation_, step_);
    if (wakes) {
        schedule.choose_pairs(simulation_, step_);
        leave_jointed_pairs_out(simulation_, step_);
    }
    return wakes;
}

void Stepper::find_warm_starts(Schedule& schedule) {
    begin_contacts(simulation_, step_);
    schedule.for_each_range(step_.contacts.size(), kContactGrain, [&](Range contacts) {
        tesserae::find_warm_starts(simulation_, step_, contacts);
    });
}

void Stepper::aim_rims(Schedule& schedule) {
    count_company(simulation_, step_);
    const auto aim = [&](Range runs) { tesserae::aim_rims(simulation_, step_, runs); };
    schedule.for_each_range(step_.contacts.run_count(), kContactGrain, aim);
}

void Stepper::pose_joints(Schedule& schedule) {
    list_joints(simulation_, step_);
    schedule.for_each_range(step_.constraints.size(), kJointGrain, [&](Range joints) {
        tesserae::pose_joints(simulation_, step_, joints.begin, joints.end);
    });
}

void Stepper::build_islands() {
    const Observed stage(*this, Stage::kBuildIslands, step_.contacts.size());
    island_builder_.build(simulation_, step_);
    step_.rows_in_use = true;
}

void Stepper::solve_impacts(Schedule& schedule) {
    const Observed stage(*this, Stage::kSolveImpacts, step_.islands.size());
    solve_impacts_of(step_, schedule);
}

void Stepper::solve_impacts_of(StepData& step, Schedule& schedule) {
    const std::size_t count = step.contacts.size();
    hits_.resize(count / kContactGrain + 1);
    for (std::vector<std::uint32_t>& list : hits_) list.clear();
    schedule.for_each_range(count, kContactGrain, [&](Range contacts) {
        list_impacts(simulation_, step, contacts, hits_[contacts.begin / kContactGrain]);
    });
    if (std::all_of(hits_.begin(), hits_.end(), [](const auto& list) { return list.empty(); }))
        return;
    impact_patches_.begin(simulation_, step, hits_);
    schedule.solve_impacts(simulation_, step);
    if (impact_patches_.end(simulation_, step)) schedule.solve_impacts(simulation_, step);
}

void Stepper::integrate_velocities(Schedule& schedule) {
    const Observed stage(*this, Stage::kIntegrateVelocities, simulation_.bodies.size());
    schedule.for_each_range(simulation_.bodies.size(), kBodyGrain, [&](Range bodies) {
        tesserae::integrate_velocities(simulation_, step_, bodies);
    });
}

void Stepper::solve_islands(Schedule& schedule) {
    const Observed stage(*this, Stage::kSolveIslands, step_.islands.size());
    schedule.solve_islands(simulation_, step_);
}

void Stepper::advance_second_half(Schedule& schedule) {
    const Observed stage(*this, Stage::kAdvanceSecondHalf, simulation_.bodies.size());
    has_fast_.assign(simulation_.bodies.size() / kBodyGrain + 1, 0);
    schedule.for_each_range(simulation_.bodies.size(), kBodyGrain, [&](Range bodies) {
        has_fast_[bodies.begin / kBodyGrain] =
            tesserae::advance_second_half(simulation_, step_, bodies);
    });
}

/// What an impact made fast may have come out of the bounds that the pairs were found by.
void Stepper::stop_fast_bodies(Schedule& schedule, FastBodies::Half half) {
    if (std::find(has_fast_.begin(), has_fast_.end(), 1) == has_fast_.end()) return;
    const std::size_t count = simulation_.bodies.size();
    const Observed stage(*this, Stage::kStopFastBodies, step_.pairs.size());
    const auto left = [&](Range bodies) { return has_left_bounds(simulation_, step_, bodies); };
    if (half == FastBodies::Half::kSecond) {
        require_finite(schedule);
        if (schedule.any_range(count, kBodyGrain, left)) find_pairs_anew(schedule);
    }
    fast_bodies_.stop(simulation_, step_, schedule, half);
    lost_time_.add(simulation_, step_, fast_bodies_);
}

void Stepper::regain_lost_time(Schedule& schedule) {
    if (!lost_time_.any()) return;
    const Observed stage(*this, Stage::kRegainLostTime, step_.pairs.size());
    lost_time_.regain(simulation_, step_, schedule, fast_bodies_, [&](StepData& round) {
        if (simulation_.needs.internal_edges) internal_edges_.correct(simulation_, round, schedule);
        begin_contacts(simulation_, round);
        round.rises.clear(), round.rim_slips.clear();  // these are for the next sub-step
        island_builder_.build(simulation_, round);
        solve_impacts_of(round, schedule);
    });
}

void Stepper::apply_corrections(Schedule& schedule) {
    const Observed stage(*this, Stage::kApplyCorrections, step_.islands.size());
    schedule.apply_corrections(simulation_, step_);
    if (simulation_.needs.damping)
        schedule.for_each_range(simulation_.bodies.size(), kBodyGrain,
                                [&](Range bodies) { damp_half(simulation_, step_, bodies); });
    if (step_.substep + 1 < simulation_.settings.substeps) keep_impulses(schedule);
}

/// For the next sub-step, or the next step once nothing can go wrong in this one: these are the
/// memory's. Both are written over what this sub-step started from.
void Stepper::keep_impulses(Schedule& schedule) {
    const LeftImpulses left = left_impulses(simulation_, step_);
    if (!step_.asleep.empty()) return merge_impulses(simulation_, step_, left);
    const std::size_t count = step_.impulses.size();
    first_pushing_.assign(count / kContactGrain + 2, {});  // of no contacts there is a range too
    schedule.for_each_range(count, kContactGrain, [&](Range contacts) {
        first_pushing_[contacts.begin / kContactGrain + 1] = count_pushing(step_, contacts);
    });
    std::partial_sum(first_pushing_.begin(), first_pushing_.end(), first_pushing_.begin());
    left.impulses.resize_anew(first_pushing_.back());
    if (simulation_.needs.rolling) resize_anew(left.angular, first_pushing_.back().impulses);
    schedule.for_each_range(count, kContactGrain, [&](Range contacts) {
        keep_pushing(simulation_, step_, contacts, first_pushing_[contacts.begin / kContactGrain],
                     left);
    });
}

StepReport Stepper::finish_step(Schedule& schedule) {
    const Observed stage(*this, Stage::kFinishStep, step_.contacts.size());
    require_finite(schedule);
    schedule.ask(nullptr);  // from here on the memory changes
    begin_report(step_);
    schedule.for_each_range(step_.contacts.size(), kReportPiece,
                            [&](Range contacts) { sum_contacts(step_, contacts); });
    step_.substep = simulation_.settings.substeps - 1;  // the one that ends here
    keep_impulses(schedule);
    return commit_step(simulation_, step_);
}

/// Ranges find out whether any body is not finite, and only then the lowest is looked for.
void Stepper::require_finite(Schedule& schedule) const {
    const auto has_none = [&](Range bodies) { return !is_finite(simulation_, step_, bodies); };
    if (schedule.any_range(simulation_.bodies.size(), kBodyGrain, has_none))
        tesserae::require_finite(simulation_, step_);
}

}  // namespace tesserae
