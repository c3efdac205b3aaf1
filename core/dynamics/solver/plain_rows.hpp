// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/dynamics/solver/constraint_rows.hpp"
#include "core/dynamics/solver/impact.hpp"
#include "core/dynamics/solver/joint_block.hpp"
#include "core/dynamics/solver/plain_directions.hpp"
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
    /// There is one island, number 0 of one.
    static Members members() { return Members::only(0); }
    std::size_t island(int) const { return island_; }

    Impact impact(int) const;
    Effort effort_of(int, const Impact& impact) const;
    static constexpr bool kDropsGains = false;
    bool along_directions() const {
        return step_.islands.conjugates[island_] && step_.islands.constraints_in(island_).empty();
    }
    void start(Cause cause, Members);
    PerMember<PassEnd> iterate(Pass pass, const PerMember<Effort>& efforts, Members some);
    template <class Instead>
    PerMember<PassEnd> iterate_along_directions(Pass pass, const PerMember<Effort>& efforts,
                                                Members some, const Instead& instead) {
        PlainDirections directions(simulation_, step_, rows(), bodies_, pass);
        return AlongDirections(*this, directions, pass, efforts).solve(some, instead);
    }
    double energy(int) { return load(0).energy; }
    LoadWork load(int);
    void leave_part(const PerMember<double>& parts, Members);
    std::array<double, 2> energies(int) const;
    void keep_impact_motion(Members);
    void add_changes(Members) {}
    RestitutionSums restitution(int) const;
    void leave_part_of_restitution(int, double part);
    void keep(Members);
    void begin_correction(Members);
    void end_correction(Members);
    void apply_correction(Members);
    /// Does one sweep. Returns the residual if it is measured.
    PerMember<double> sweep(Sweep sweep, Members);
    PerMember<double> sweep(Sweep one, Members some, const PlainDirections&) {
        return sweep(one, some);
    }
    static double rounding_of_loads(int) { return 0; }

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
    void swap_motions();
    void make_rows();
    void apply_impulse(const ContactRow& row, const Vec4& impulse);
    void apply_part_of_contacts(double part);
    double work() const;
    template <double ContactTargets::*kTarget, bool kTurning, bool kFriction, bool kRolling>
    double sweep_rows(Sweep sweep);
    template <bool kTurning, bool kRolling>
    double sweep_contacts(Sweep sweep);

    const Simulation& simulation_;
    StepData& step_;
    std::size_t island_;
    ConstraintRows<MotionOfState> others_;  ///< the constraints that are no contacts
    JointBlock* block_ = nullptr;           ///< of these, if they are solved as one
    Cause cause_ = Cause::kLoad;
    std::span<const BodyId> bodies_;  ///< the movable ones, each once
    std::span<BodyMotion> motions_;   ///< their motions before the rows' impulses or a correction
};

}  // namespace tesserae
