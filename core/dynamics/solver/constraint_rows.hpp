// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>

#include "core/dynamics/constraints/constraint.hpp"
#include "core/dynamics/constraints/contact_targets.hpp"
#include "core/dynamics/solver/sweep.hpp"

namespace tesserae {

/// The motion of the bodies of an island that is not coloured. A place is a body's id.
class MotionOfState {
  public:
    explicit MotionOfState(StepData& step) : step_(step) {}

    BodyMotion at(std::uint32_t place) const {
        return place == kWorld ? BodyMotion{} : motion_of(step_, place);
    }
    void add(std::uint32_t place, const BodyMotion& change) const {
        step_.velocity[place] += change.velocity;
        step_.angular_velocity[place] += change.angular_velocity;
    }
    /// Returns the motion of a body that at() leaves out.
    BodyMotion left_out(BodyId) const { return {}; }

  private:
    StepData& step_;
};

/// The changes of the motion of the bodies of a coloured island. A place is one in
/// ColouredIslands::bodies.
class MotionOfChanges {
  public:
    explicit MotionOfChanges(StepData& step) : step_(step) {}

    BodyMotion at(std::uint32_t place) const {
        const auto& [v, w, rest] = step_.coloured.changes[place];
        return {assembled(v[0], v[1], v[2], v[3]), {w[0], w[1], w[2], w[3], rest[0], rest[1]}};
    }
    void add(std::uint32_t place, const BodyMotion& change) const {
        BodyChange& record = step_.coloured.changes[place];
        const Bivector& w = change.angular_velocity;
        for (int i = 0; i < 4; ++i)
            record.velocity[static_cast<std::size_t>(i)] += static_cast<float>(change.velocity[i]);
        record.first_planes[0] += static_cast<float>(w.xy);
        record.first_planes[1] += static_cast<float>(w.xz);
        record.first_planes[2] += static_cast<float>(w.xw);
        record.first_planes[3] += static_cast<float>(w.yz);
        record.rest[0] += static_cast<float>(w.yw);
        record.rest[1] += static_cast<float>(w.zw);
    }
    BodyMotion left_out(BodyId id) const {
        return id == kWorld ? BodyMotion{} : motion_of(step_, id);
    }

  private:
    StepData& step_;
};

/// The constraints of an island that are no contacts, or some of them. They are solved one after
/// the other, in double.
template <class Motions>
class ConstraintRows {
  public:
    /// @param which   numbers in step.constraints
    ConstraintRows(const Simulation& simulation, StepData& step,
                   std::span<const std::uint32_t> which)
        : simulation_(simulation), step_(step), motions_(step), which_(which) {}

    /// Prepares them for a cause, and applies the impulses that they start from. An impact keeps
    /// the velocities of the rows as they are; a limit lets them have all that is left of its way.
    void start(Cause cause) const {
        for_all([&](Constraint& c) {
            const RowVector left_out =
                row_velocities(c, motions_.left_out(c.a), motions_.left_out(c.b));
            if (cause == Cause::kLoad) {
                c.aim = c.bias - left_out;
                if (c.starts_anew)
                    c.impulse.setZero(c.size);
                else
                    apply(c, c.impulse = impulses_of(c, step_.joint_impulses[c.part]));
            } else {
                const MotionOfState now(step_);
                c.aim = row_velocities(c, now.at(c.a), now.at(c.b));
                if (c.set == ImpulseSet::kHalfLine) c.aim = c.aim.cwiseMin(c.bias.cwiseMin(0));
                c.aim -= left_out;
                c.impulse.setZero(c.size);
            }
        });
    }

    /// @return the largest change of a row's velocity if it is measured, else 0 [m/s, rad/s]
    double sweep(Sweep sweep, Cause cause) const {
        const bool firm_only = cause == Cause::kImpact || sweep.pass == Pass::kCorrection;
        double residual = 0;
        for (std::size_t i = 0; i < which_.size(); ++i) {
            const std::size_t place = sweep.backward ? which_.size() - 1 - i : i;
            Constraint& c = step_.constraints[which_[place]];
            if (c.in_block || (firm_only && !c.is_firm())) continue;
            if (c.holds_point) {
                const Vec4 change = sweep_point(c);
                if (sweep.measured) residual = std::max(residual, response_of_point(c, change));
                continue;
            }
            const RowVector change = solve_rows(c, velocities(c));
            apply(c, change);
            if (sweep.measured)
                residual = std::max(residual, c.response.lazyProduct(change).cwiseAbs().maxCoeff());
        }
        return residual;
    }

    /// Applies a part of the impulses.
    void apply_part(double part) const {
        for_all([&](Constraint& c) { apply(c, part * c.impulse); });
    }
    void leave_part(double part) const {
        for_all([&](Constraint& c) { c.impulse *= part; });
    }
    /// Returns the impulses times their rows' velocities, less those times the aims [J].
    double work() const {
        double sum = 0;
        for_all([&](Constraint& c) { sum += c.impulse.dot(velocities(c) - c.aim); });
        return sum;
    }
    /// Returns twice the energy of what gives way under the impulses [J].
    double twice_give() const {
        double sum = 0;
        for_all([&](Constraint& c) { sum += c.compliance * c.impulse.squaredNorm(); });
        return sum;
    }
    /// Writes the impulses of a load to step.joint_impulses, and adds all to step.part_sums.
    void keep(Cause cause) const {
        for_all([&](Constraint& c) {
            const Wrench wrench = wrench_of(c, c.impulse);
            if (cause == Cause::kLoad) step_.joint_impulses[c.part] = wrench;
            step_.part_sums[c.part].impulse += wrench.impulse;
            step_.part_sums[c.part].moment += wrench.moment;
        });
    }
    /// Makes the changes so far a part of what at() leaves out.
    void take_warm_start() const {
        for_all([&](Constraint& c) { c.aim -= velocities(c); });
    }

    /// Calls visit(constraint) for all.
    template <class Visit>
    void for_all(const Visit& visit) const {
        for (const std::uint32_t i : which_) visit(step_.constraints[i]);
    }

  private:
    using PointMatrix = Eigen::Map<const Mat4>;

    /// Does what the sweep does of any constraint, with the same bits, in a tenth of the time: the
    /// rows of a held point are the axes.
    Vec4 sweep_point(Constraint& c) const {
        const BodyMotion a = motions_.at(c.place_a), b = motions_.at(c.place_b);
        const Vec4 velocity = b.velocity + velocity_at(b.angular_velocity, c.r_b) - a.velocity -
                              velocity_at(a.angular_velocity, c.r_a);
        Eigen::Map<Vec4> impulse(c.impulse.data());
        const Vec4 before = impulse;
        const Vec4 left = Eigen::Map<const Vec4>(c.aim.data()) - velocity - c.compliance * before;
        impulse = before + PointMatrix(c.mass.data()).lazyProduct(left);
        const Vec4 change = impulse - before;
        push(c.a, c.place_a, c.r_a, -change);
        push(c.b, c.place_b, c.r_b, change);
        return change;
    }
    double response_of_point(const Constraint& c, const Vec4& change) const {
        return PointMatrix(c.response.data()).lazyProduct(change).cwiseAbs().maxCoeff();
    }
    /// What contacts do not move may be in many islands, which other threads solve.
    void push(BodyId id, std::uint32_t place, const Vec4& r, const Vec4& impulse) const {
        if (!simulation_.is_movable(id)) return;
        BodyMotion motion{simulation_.type_of(id).inverse_mass * impulse, {}};
        if (simulation_.needs.turning)
            motion.angular_velocity = angular_response(simulation_, step_, id, wedge(r, impulse));
        motions_.add(place, motion);
    }

    RowVector velocities(const Constraint& c) const {
        return row_velocities(c, motions_.at(c.place_a), motions_.at(c.place_b));
    }
    void apply(const Constraint& c, const RowVector& impulses) const {
        const auto [of_a, of_b] = motion_by(simulation_, step_, c, impulses);
        // What contacts do not move may be in many islands, which other threads solve.
        if (simulation_.is_movable(c.a)) motions_.add(c.place_a, of_a);
        if (simulation_.is_movable(c.b)) motions_.add(c.place_b, of_b);
    }

    const Simulation& simulation_;
    StepData& step_;
    Motions motions_;
    std::span<const std::uint32_t> which_;
};

}  // namespace tesserae
