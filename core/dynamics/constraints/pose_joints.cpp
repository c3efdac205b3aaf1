// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/pose_joints.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

void list_joints(const Simulation& simulation, StepData& step) {
    const Joints& joints = simulation.joints;
    const auto is_awake = [&](BodyId id) {
        return simulation.is_movable(id) && !is_asleep(step, id);
    };
    step.constraints.resize(joints.parts());
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < joints.all.size(); ++i) {
        if (joints.is_broken(i)) continue;
        if (!is_awake(joints.all[i].a) && !is_awake(joints.all[i].b)) continue;
        for (std::uint32_t part = joints.first_part[i]; part < joints.first_part[i + 1]; ++part) {
            step.constraints[count].joint = i;
            step.constraints[count++].part = part;
        }
    }
    step.constraints.resize(count);
}

namespace {

JointedBody placed(const StepData& step, BodyId id) {
    if (id == kWorld) return {};
    return {step.position[id], step.rotor[id], step.velocity[id], step.angular_velocity[id]};
}

/// One constraint of a joint.
/// @tparam Out   Constraint, or a constant one that is posed
template <class Out>
class PosedPart {
  public:
    PosedPart(const Simulation& simulation, const StepData& step, Out& constraint)
        : simulation_(simulation),
          step_(step),
          joint_(simulation.joints.all[constraint.joint]),
          out_(constraint),
          a_(placed(step, joint_.a)),
          b_(placed(step, joint_.b)),
          coordinates_(std::visit([&](const auto& kind) { return coordinates_of(kind, a_, b_); },
                                  joint_.kind)) {}

    void pose() {
        out_.a = out_.place_a = joint_.a;
        out_.b = out_.place_b = joint_.b;
        place_anchor();
        out_.size = 0;
        out_.compliance = 0;
        out_.most = 0;
        out_.in_block = out_.starts_anew = out_.holds_point = false;
        std::uint32_t part = out_.part - simulation_.joints.first_part[out_.joint];
        if (const auto held = held_of(joint_); held != 0 && part-- == 0)
            hold(held);
        else if (!joint_.limits.empty() && part-- == 0)
            limit();
        else
            drive(joint_.drives[part]);
        set_response(simulation_, step_, out_);
        out_.impulse = impulses_of(out_, step_.joint_impulses[out_.part]);
    }
    RowVector missed() const {
        const RowVector now = held_values(coordinates_.values);
        return held_values(values_at(step_.h)) - (1 - part_taken(now)) * now;
    }

    void pose_ahead() {
        a_ = moved_on(a_, step_.h), b_ = moved_on(b_, step_.h);
        coordinates_ =
            std::visit([&](const auto& kind) { return coordinates_of(kind, a_, b_); }, joint_.kind);
        place_anchor();
        out_.size = 0;
        add_held_rows(held_of(joint_));
    }

  private:
    void place_anchor() {
        out_.r_a = coordinates_.anchor - a_.position;
        out_.r_b = coordinates_.anchor - b_.position;
    }
    void add_held_rows(std::uint16_t held) {
        for (int i = 0; i < coordinates_.size; ++i)
            if ((held >> i & 1) != 0) add_row(i, unit_of(i));
    }
    /// Adds a multiple of a coordinate's row.
    void add_row(int coordinate, double factor) {
        const Wrench& row = coordinates_.rows[static_cast<std::size_t>(coordinate)];
        out_.rows[static_cast<std::size_t>(out_.size++)] = {factor * row.impulse,
                                                            factor * row.moment};
    }
    RowVector rates() const {
        return row_velocities(out_, {a_.velocity, a_.angular_velocity},
                              {b_.velocity, b_.angular_velocity});
    }
    /// After a time in which the bodies go straight on and turn.
    RowVector values_at(double time) const {
        const JointedBody a = moved_on(a_, time), b = moved_on(b_, time);
        return std::visit(
            [&](const auto& kind) { return values_of(kind, a, b, coordinates_.turn); },
            joint_.kind);
    }
    /// Unit wrenches are orthogonal, or nearly so, and wrenches are told by them.
    double unit_of(int coordinate) const {
        const Wrench& row = coordinates_.rows[static_cast<std::size_t>(coordinate)];
        return 1 / std::hypot(row.impulse.norm(), norm(row.moment));
    }
    /// Of the rows that hold.
    RowVector held_values(const RowVector& of_coordinates) const {
        const std::uint16_t held = held_of(joint_);
        RowVector values(std::popcount(held));
        for (int i = 0, row = 0; i < coordinates_.size; ++i)
            if ((held >> i & 1) != 0) values[row++] = unit_of(i) * of_coordinates[i];
        return values;
    }
    /// What the coordinates change in a sub-step in which the bodies go straight on and turn,
    /// beside what they do at their present rates: its even part, so that motions can be reversed.
    /// None in loops: bodies that hold each other from several sides would press each other apart
    /// by it.
    RowVector bends() const {
        if (simulation_.joints.in_loop[out_.joint] != 0) return RowVector::Zero(coordinates_.size);
        return 0.5 * (values_at(step_.h) + values_at(-step_.h)) - coordinates_.values;
    }
    /// Lengths by which a row's error is measured: a moment's acts at the bodies' radii.
    double arm_of(const Wrench& row) const {
        if (!(row.impulse == Vec4::Zero())) return 1;
        double arm = kNoLimit;
        for (const BodyId id : {joint_.a, joint_.b})
            if (simulation_.is_movable(id)) arm = std::min(arm, simulation_.type_of(id).radius);
        return arm;
    }
    /// The greatest speed at which an error is taken away [m/s].
    double fastest_correction() const {
        double slop = kNoLimit;
        for (const BodyId id : {joint_.a, joint_.b})
            if (id != kWorld) slop = std::min(slop, simulation_.type_of(id).slop);
        return kFastestCorrection / kSlop * slop + step_.kick;
    }
    bool is_off(double now) const { return out_.set == ImpulseSet::kAll || now < 0; }
    /// The part of the rows' errors that a sub-step takes away.
    double part_taken(const RowVector& now) const {
        double squared = 0;
        for (int i = 0; i < out_.size; ++i) {
            const double arm = arm_of(out_.rows[static_cast<std::size_t>(i)]);
            if (is_off(now[i])) squared += arm * arm * now[i] * now[i];
        }
        const double far = std::sqrt(squared), fastest = step_.h * fastest_correction();
        return far > fastest ? fastest / far : 1;
    }
    /// The rows aim at no distance after the sub-step.
    /// @param now     distances of the rows
    /// @param bends   see bends()
    void aim(const RowVector& now, const RowVector& bends) {
        const double taken = part_taken(now);
        out_.bias.resize(out_.size);
        for (int i = 0; i < out_.size; ++i)
            out_.bias[i] = -((is_off(now[i]) ? taken : 1) * now[i] + bends[i]) / step_.h;
    }

    void hold(std::uint16_t held) {
        out_.set = ImpulseSet::kAll;
        add_held_rows(held);
        out_.holds_point =
            std::holds_alternative<PointJoint>(joint_.kind) && out_.size == PointJoint::kSize;
        aim(held_values(coordinates_.values), held_values(bends()));
    }

    /// Each towards its nearer end.
    void limit() {
        out_.set = ImpulseSet::kHalfLine;
        const RowVector all_bends = bends();
        const auto size = static_cast<Eigen::Index>(joint_.limits.size());
        RowVector now(size), bends(size);
        for (const auto& [coordinate, low, high] : joint_.limits) {
            const double value = coordinates_.values[coordinate];
            const bool at_low = value - low < high - value;
            const double factor = at_low ? 1 : -1, end = at_low ? low : high;
            now[out_.size] = factor * (value - end);
            bends[out_.size] = factor * all_bends[coordinate];
            add_row(coordinate, factor);
        }
        aim(now, bends);
    }

    /// It ends where the coordinate's limits are, so that a motor without a bound does not drive
    /// through them.
    double speed_within_limits(const JointDrive& drive) const {
        double speed = drive.speed;
        const double value = coordinates_.values[drive.coordinate];
        for (const auto& [coordinate, low, high] : joint_.limits)
            if (coordinate == drive.coordinate)
                speed = std::clamp(speed, std::min(0.0, (low - value) / step_.h),
                                   std::max(0.0, (high - value) / step_.h));
        return speed;
    }
    /// From the force at the mean of the sub-step's ends, x + h/4 (v1 - v0) and (v0 + v1) / 2 for
    /// the coordinate x now and its velocities before and after.
    void drive(const JointDrive& drive) {
        out_.set = ImpulseSet::kBox;
        out_.most = step_.h * drive.most;
        add_row(drive.coordinate, 1);
        const double h = step_.h, spring = 0.25 * h * h * drive.stiffness;
        const double damper = 0.5 * h * drive.damping, gives = spring + damper;
        if (drive.holds_speed) {
            out_.bias = RowVector::Constant(1, speed_within_limits(drive));
        } else if (gives > 0) {
            out_.compliance = 1 / gives;
            const double off = coordinates_.values[drive.coordinate] - drive.target;
            const double impulse = (spring - damper) * rates()[0] - h * drive.stiffness * off +
                                   2 * damper * drive.speed;
            out_.bias = RowVector::Constant(1, impulse / gives);
        } else {
            out_.most = 0;
            out_.bias = RowVector::Zero(1);
        }
    }

    const Simulation& simulation_;
    const StepData& step_;
    const Joint& joint_;
    Out& out_;
    JointedBody a_, b_;
    Coordinates coordinates_;
};

}  // namespace

void pose_joints(const Simulation& simulation, StepData& step, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
        PosedPart(simulation, step, step.constraints[i]).pose();
}

RowVector missed_by(const Simulation& simulation, const StepData& step, const Constraint& held) {
    return PosedPart(simulation, step, held).missed();
}

void pose_ahead(const Simulation& simulation, const StepData& step, Constraint& held) {
    PosedPart(simulation, step, held).pose_ahead();
}

}  // namespace tesserae
