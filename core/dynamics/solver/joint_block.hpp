// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/constraints/contact_targets.hpp"
#include "core/dynamics/solver/joint_gain.hpp"
#include "core/dynamics/solver/motion_roots.hpp"
#include "core/dynamics/solver/sweep.hpp"

namespace tesserae {

/// All joints of an island as one block, if they join few bodies, which is solved directly. Sweeps
/// take a joint after the other and need thousands where a light chain bears a heavy load; the
/// block takes one factor a sub-step, and two or three solutions of it a sweep.
///
/// The change of the bodies' motion is the least of 1/2 |u|^2 + 1/2 s |J u - left|^2, in the norm
/// of the kinetic energy, with stiff s; its impulses are s (left - J u). What is left after it is
/// less by a factor of about 1 + s/m, and it is repeated (method of multipliers: Nocedal and
/// Wright, "Numerical optimization", 2006, 17.3). A spring gives way by its compliance: its s is
/// less.
///
/// Joints hold in the middle of the next sub-step (Newton's method). Where light links whip round
/// so fast that no impulses along the present rows achieve this, the rows are those at that time.
///
/// A light body between strong pulls swings across them faster than the step can follow. Where it
/// would, its inertia gets the part h^2/4 K, with K the moment of the pulls by an angle (geometric
/// stiffness: M. Tournier et al., "Stable constrained dynamics", ACM Trans. Graph. 34, 2015): the
/// moments are then those at the mean of the sub-step's ends, and the swing is slower, not wilder.
///
/// Limits, and motors whose force has a bound, are solved one after the other. The block answers to
/// each: what it holds stays held.
class JointBlock {
  public:
    /// Prepares the block for an island whose constraints are posed.
    /// @param constraints   numbers in step.constraints
    /// @param follows_impact   of a load: an impact of the island preceded it
    /// @return whether it is one to solve so: few blocks have to be eliminated. Then
    ///         Constraint::in_block is set.
    bool begin(const Simulation& simulation, StepData& step,
               std::span<const std::uint32_t> constraints, Cause cause, bool follows_impact);

    /// Solves all rows at the bodies' present motion, and applies what their impulses change.
    /// @return the largest change of a row's velocity [m/s, rad/s]
    double sweep(const Simulation& simulation, StepData& step, Pass pass);
    /// Takes back what the block has added to the bodies that joints do not: see JointGain.
    void end(const Simulation& simulation, StepData& step);

    /// Returns whether bodies have got geometric stiffness.
    bool has_stiffness() const { return !stiffness_.empty(); }

  private:
    using Part = BlockCholesky::Part;

    using Angles = Eigen::Matrix<double, 6, 6>;

    /// One row of a constraint: what its unit impulse does to both bodies.
    struct Row {
        Part a, b;
        double left = 0;    ///< aim less its velocity
        double change = 0;  ///< of its impulse
    };
    /// A constraint and its rows.
    struct Joint {
        std::uint32_t constraint = 0, first = 0, end = 0;  ///< its rows
        std::size_t a = 0, b = 0;                          ///< places of the bodies
        double stiffness = 0;                              ///< [kg]
    };
    /// A row whose impulse has a bound.
    struct Bounded {
        std::uint32_t constraint = 0;
        int row = 0;             ///< of the constraint
        double response = 0;     ///< of its velocity, with the block's answer
        std::size_t answer = 0;  ///< where the changes of rows_ by its unit impulse are in answers_
    };

    void list_bodies(const Simulation& simulation, const StepData& step);
    bool is_direct(const Constraint& constraint) const;
    std::size_t place_of(const Simulation& simulation, BodyId id) const;
    bool arrange(const Simulation& simulation, const StepData& step);
    void list_rows(const Simulation& simulation, const StepData& step);
    void list_bounded(const Simulation& simulation, const StepData& step);
    void list_stiffness(const StepData& step);
    void factorize();
    void solve();
    void set_changes();
    double answer_of(const Joint& joint, const Row& row) const;
    double solve_direct(const Simulation& simulation, StepData& step);
    void solve_directly(const Simulation& simulation, StepData& step);
    double farthest_miss(const Simulation& simulation, const StepData& step);
    static RowVector velocities_of(const StepData& step, const Constraint& c);
    /// What is left of its aim.
    static RowVector left_of(const StepData& step, const Constraint& c);
    bool turns_far(const Simulation& simulation, const StepData& step) const;
    void list_rows_ahead(const Simulation& simulation, const StepData& step);
    void add_moments_of_rows_ahead(const StepData& step);
    void project(const Simulation& simulation, StepData& step);
    void aim_again(const Simulation& simulation, StepData& step);
    double solve_bounded(const Simulation& simulation, StepData& step, const Bounded& bounded);
    void apply(const Simulation& simulation, StepData& step) const;
    void apply_motion(StepData& step);

    Cause cause_ = Cause::kLoad;
    std::vector<BodyId> bodies_;  ///< movable ones that have joints, ascending
    std::span<const std::uint32_t> constraints_;
    std::vector<MotionRoots> roots_;  ///< of the bodies, and of all that does not move
    std::vector<Joint> joints_;
    std::vector<Row> rows_;
    std::vector<Bounded> bounded_;
    std::vector<double> answers_;
    std::vector<std::pair<std::size_t, Part>> stiffness_;  ///< of a body: the sum of part part^T
    std::vector<double> moments_;                          ///< along stiffness_
    std::vector<Angles> pulls_;                            ///< K of every body
    std::vector<Part> motion_;
    std::vector<RowVector> aims_;       ///< of joints_
    std::vector<RowVector> missed_by_;  ///< of joints_; empty where they do not aim again
    int projections_ = 0;               ///< of the load so far
    bool has_uneven_work_ = false;      ///< it may gain energy
    JointGain gain_;
    BlockCholesky matrix_;
};

}  // namespace tesserae
