// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/contacts/chunked_list.hpp"
#include "core/dynamics/contacts/internal_edges.hpp"
#include "core/dynamics/contacts/kept_manifolds.hpp"
#include "core/dynamics/islands/impact_patches.hpp"
#include "core/dynamics/islands/islands.hpp"
#include "core/dynamics/motion/fast_bodies.hpp"
#include "core/dynamics/motion/lost_time.hpp"
#include "core/dynamics/solver/first_loads.hpp"
#include "core/dynamics/step/schedule.hpp"
#include "core/dynamics/step/step.hpp"

namespace tesserae {

/// A world of moving bodies, and the only text of the time step. By itself the step is serial,
/// tests every two bodies for contacts and solves islands one by one; a Schedule shares out the
/// same work, with the same bits.
///
/// A step depends on bodies() and memory() only: a world that is made from both as saved continues
/// with the same bits.
class Stepper {
  public:
    /// @throws InputError   as make_simulation()
    Stepper(Bodies bodies, const PhysicsSettings& settings);
    /// @param coloured_from   for tests and measurements
    explicit Stepper(Simulation simulation, ColouredFrom coloured_from = {});

    /// Advances by dt [s].
    /// @throws InputError        dt is not finite or not > 0
    /// @throws LeftFiniteRange   bodies() and memory() are then as before the call
    StepReport step(double dt);
    /// Advances by dt [s], with the work shared out by a schedule.
    /// @param stop       is asked first and amid the step; null: nothing is
    /// @throws Stopped   it was true; bodies() and memory() are then as before the call
    StepReport step(double dt, Schedule& schedule, const StopQuestion* stop = nullptr);

    /// Lets an observer see every stage from the next step on; null ends this. It changes no
    /// result.
    void observe(StageObserver* observer) { observer_ = observer; }

    const Simulation& simulation() const { return simulation_; }
    /// For who moves bodies between steps. What is computed from them has to fit afterwards.
    Simulation& simulation() { return simulation_; }
    /// Returns what the stages of the last step handed on, as its last sub-step left it.
    const StepData& last_step() const { return step_; }
    /// Copies the last step's result into the arrays of bodies that the step began with: a step
    /// writes to other arrays, and those who look at the first ones would see old states.
    void put_back_arrays();

    const Bodies& bodies() const { return simulation_.bodies; }
    const StepMemory& memory() const { return simulation_.memory; }
    StepMemory& memory() { return simulation_.memory; }
    /// Returns what every joint's impulses were in the last step: on body b, of all sub-steps and
    /// impacts.
    std::span<const Wrench> joint_impulses() const { return step_.joint_sums; }

  private:
    class Observed;

    StepReport whole_step(double dt, Schedule& schedule);
    void advance_first_half(Schedule& schedule);
    void find_pairs(Schedule& schedule);
    void find_pairs_anew(Schedule& schedule);
    void find_contacts(Schedule& schedule);
    void find_manifolds(Schedule& schedule);
    void find_contacts_of(Range pairs, std::vector<Contact>& list);
    bool wake_touched(Schedule& schedule);
    void find_warm_starts(Schedule& schedule);
    void aim_rims(Schedule& schedule);
    const std::vector<KeptManifolds>& last_kept() const;
    void pose_joints(Schedule& schedule);
    void build_islands();
    void solve_impacts(Schedule& schedule);
    void solve_impacts_of(StepData& step, Schedule& schedule);
    void integrate_velocities(Schedule& schedule);
    void solve_islands(Schedule& schedule);
    void advance_second_half(Schedule& schedule);
    void stop_fast_bodies(Schedule& schedule, FastBodies::Half half);
    void regain_lost_time(Schedule& schedule);
    void apply_corrections(Schedule& schedule);
    void keep_impulses(Schedule& schedule);
    StepReport finish_step(Schedule& schedule);
    void require_finite(Schedule& schedule) const;

    Simulation simulation_;
    StepData step_;
    IslandBuilder island_builder_;
    SpareManifolds spare_manifolds_;
    Clearances clearances_;
    ChunkedList<Contact> contacts_;
    InternalEdges internal_edges_;
    FirstLoads first_loads_;
    ImpactPatches impact_patches_;
    FastBodies fast_bodies_;
    LostTime lost_time_;
    std::vector<std::vector<std::uint32_t>> hits_;  ///< impacts of every range of contacts
    std::vector<std::uint8_t> has_fast_;            ///< of every range of kBodyGrain bodies
    /// The first kept impulse of every range of contacts, and the end.
    std::vector<KeptImpulses::Size> first_pushing_;
    StageObserver* observer_ = nullptr;
};

}  // namespace tesserae
