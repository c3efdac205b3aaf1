// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/dynamics/solver/constraint_rows.hpp"
#include "core/dynamics/solver/impact.hpp"
#include "core/dynamics/solver/joint_block.hpp"
#include "core/dynamics/solver/sweep.hpp"

namespace tesserae {

/// The IslandRows that are solved one by one, in double: contacts, and after them all other
/// constraints. Every impulse changes the bodies' velocities at once. Source: E. Catto, "Iterative
/// dynamics with temporal coherence", 2005; here friction is a block of three directions instead of
/// separate ones.
class PlainRows {
  public:
    PlainRows(const Simulation& simulation, StepData& step, std::size_t island)
        : simulation_(simulation),
          step_(step),
          island_(island),
          others_(simulation, step, step.islands.constraints_in(island)) {}

    const Simulation& simulation() const { return simulation_; }
    StepData& step() const { return step_; }
    std::size_t island() const { return island_; }

    Impact impact() const;
    Effort effort_of(const Impact& impact) const;
    void start(Cause cause);
    void leave_friction_out() { friction_ = false; }
    double iterate(Pass pass, const Effort& effort);
    double energy() { return load().energy; }
    LoadWork load();
    void leave_part(double part);
    std::array<double, 2> energies() const;
    void keep_impact_motion();
    void add_changes() {}
    RestitutionSums restitution() const;
    void leave_part_of_restitution(double part);
    void keep();
    void begin_correction();
    void end_correction();
    void take_correction_back();

  private:
    std::span<ContactRow> rows() const {
        return {step_.rows.data() + step_.islands.first_row[island_],
                step_.islands.contacts[island_]};
    }
    RollingRow& rolling_row_of(const ContactRow& row) const {
        return step_.rolling_rows[static_cast<std::size_t>(&row - step_.rows.data())];
    }
    template <class Visit>
    void for_each_row(const Visit& visit) const;
    void list_bodies();
    void begin_block();
    double sweep_others(Sweep sweep);
    void keep_motions();
    void restore_motions();
    void restore_turning();
    void take_motion_back();
    void swap_motions();
    void make_rows();
    void apply_impulse(const ContactRow& row, const Vec4& impulse);
    void apply_part_of_contacts(double part);
    double work() const;
    template <double ContactTargets::*kTarget, bool kTurning, bool kFriction, bool kRolling>
    double sweep_rows(Sweep sweep);
    template <bool kTurning, bool kRolling>
    double sweep(Sweep sweep);

    const Simulation& simulation_;
    StepData& step_;
    std::size_t island_;
    ConstraintRows<MotionOfState> others_;  ///< the constraints that are no contacts
    JointBlock* block_ = nullptr;           ///< of these, if they are solved as one
    Cause cause_ = Cause::kLoad;
    bool friction_ = true;
    std::span<const BodyId> bodies_;  ///< the movable ones, each once
    std::span<BodyMotion> motions_;   ///< their motions before the rows' impulses or a correction
};

}  // namespace tesserae
