// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/make_joint.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

namespace tesserae {
namespace {

/// A distance may differ from that of the anchors as placed by this part of it: what is left of
/// decimals. The solver then takes the difference away.
constexpr double kSameLength = 1e-6;

/// What is left of a direction orthogonal to the first columns of a matrix.
Vec4 orthogonal_part(const Mat4& axes, int columns, const Vec4& direction) {
    Vec4 rest = direction;
    // The second pass removes what the first one's rounding left.
    for (int pass = 0; pass < 2; ++pass)
        for (int i = 0; i < columns; ++i) rest -= rest.dot(axes.col(i)) * axes.col(i);
    return rest;
}

/// Returns axes of which the first ones are as some directions: made unit, and each orthogonal to
/// those before it. The others are the world's axes that need the least turning for it.
Rotor axes_along(std::span<const Vec4> directions) {
    Mat4 axes = Mat4::Zero();
    const int given = static_cast<int>(directions.size());
    for (int i = 0; i < 4; ++i) {
        Vec4 best = Vec4::Zero();
        if (i < given) {
            best = orthogonal_part(axes, i,
                                   stable_normalized(directions[static_cast<std::size_t>(i)]));
        } else {
            for (int axis = 0; axis < 4; ++axis) {
                const Vec4 rest = orthogonal_part(axes, i, Vec4::Unit(axis));
                if (rest.squaredNorm() > best.squaredNorm()) best = rest;
            }
        }
        axes.col(i) = best.normalized();
    }
    if (axes.determinant() < 0) axes.col(3) *= -1;
    return to_rotor(axes);
}

/// Makes one joint: core's a and b, with the motion of b relative to a.
class JointMaker {
  public:
    JointMaker(const JointDescription& asked, const Bodies& bodies, BodyId a, BodyId b,
               FailJoint fail)
        : asked_(asked), bodies_(bodies), fail_(fail), of_world_(b == kWorld) {
        joint_.a = of_world_ ? kWorld : a;
        joint_.b = of_world_ ? a : b;
        joint_.collide = asked.collide;
        if (!asked.breaks) return;
        joint_.break_force = asked.breaks->force.value_or(kNoLimit);
        joint_.break_torque = asked.breaks->torque.value_or(kNoLimit);
    }

    Joint made() {
        if (is_line(asked_.type))
            add_line();
        else if (asked_.type == JointType::kPoint)
            joint_.kind = PointJoint{on(joint_.a, asked_.anchor), on(joint_.b, asked_.anchor)};
        else
            add_frame();
        return std::move(joint_);
    }

  private:
    Vec4 on(BodyId body, const Vec4& point) const { return point_in(placed(bodies_, body), point); }

    void add_line() {
        const Vec4& at_a = of_world_ ? *asked_.anchor_b : *asked_.anchor_a;
        const Vec4& at_b = of_world_ ? *asked_.anchor_a : *asked_.anchor_b;
        const Vec4 on_a = on(joint_.a, at_a), on_b = on(joint_.b, at_b);
        joint_.kind = LineJoint{on_a, on_b, *asked_.length};
        if (asked_.type == JointType::kDistance) return;
        joint_.held = 0;
        if (asked_.type == JointType::kRope) {
            joint_.limits = {{0, -kNoLimit, 0}};
            return;
        }
        // Along the line, or where there is none the mean of all directions.
        double mass = mass_at(0);
        const int size = *asked_.length > 0 ? 1 : PointJoint::kSize;
        if (size > 1) joint_.kind = PointJoint{on_a, on_b};
        if (at_a == at_b) {
            double responses = 0;
            for (int i = 0; i < size; ++i) responses += 1 / mass_at(i);
            mass = size / responses;
        }
        for (int i = 0; i < size; ++i)
            joint_.drives.push_back(spring("frequency", asked_.spring, mass, i));
    }

    void add_frame() {
        const Frame placed_frame = frame();
        joint_.held = static_cast<std::uint16_t>(kAllHeld & ~placed_frame.free);
        const auto axes_in = [&](BodyId id) {
            return reverse(placed(bodies_, id).rotor) * placed_frame.axes;
        };
        joint_.kind =
            FrameJoint{on(joint_.a, placed_frame.origin), on(joint_.b, placed_frame.origin),
                       axes_in(joint_.a), axes_in(joint_.b)};
        for (int i = 0; i < kMostRows; ++i) {
            const auto at = static_cast<std::size_t>(i);
            if (const auto& limits = asked_.limits[at])
                joint_.limits.push_back({i, (*limits)[0], (*limits)[1]});
            if (const auto& spring_at = asked_.springs[at])
                joint_.drives.push_back(spring("spring", *spring_at, mass_at(i), i));
            if (const auto& motor_at = asked_.motors[at])
                joint_.drives.push_back(motor(*motor_at, i));
        }
    }

    /// The joint's axes and their origin in the world, and a bit for each coordinate that is free.
    struct Frame {
        Rotor axes;
        Vec4 origin;
        unsigned free;
    };
    Frame frame() const {
        const auto bit = [](int coordinate) { return 1U << coordinate; };
        switch (asked_.type) {
            case JointType::kSlider: {
                // A hyperplane has no centre.
                const BodyId centre = bodies_.is_movable(joint_.b) ? joint_.b : joint_.a;
                return {axes_along({&asked_.axis, 1}), bodies_.position[centre], bit(kSliding)};
            }
            case JointType::kHinge: {
                const Vec4 sides[] = {asked_.plane.first, asked_.plane.second};
                return {axes_along(sides), asked_.anchor, bit(kTurning)};
            }
            case JointType::kSwivel:
                // The turnings in the planes yz, yw and zw leave x.
                return {axes_along({&asked_.axis, 1}), asked_.anchor, bit(7) | bit(8) | bit(9)};
            case JointType::kGeneral:
                return {asked_.rotation, asked_.anchor, asked_.free};
            default:
                return {Rotor(), asked_.anchor, 0};
        }
    }

    double mass_at(int coordinate) const { return mass_along(joint_, coordinate, bodies_); }

    /// @param key    what has the frequency, for the error
    /// @param mass   [kg, kg m^2]
    JointDrive spring(const char* key, const JointSpring& s, double mass, int coordinate) {
        JointDrive drive;
        drive.coordinate = coordinate;
        if (!s.frequency) {
            drive.stiffness = *s.stiffness;
            drive.damping = *s.damping_force;
            return drive;
        }
        const double rate = 2 * std::numbers::pi * *s.frequency;
        drive.stiffness = mass * rate * rate;
        drive.damping = 2 * *s.damping * mass * rate;
        if (!std::isfinite(drive.stiffness))
            fail_(key,
                  "what is joined cannot move so, and has no frequency; expected a stiffness, or a "
                  "body that is not fixed");
        return drive;
    }

    JointDrive motor(const JointMotor& m, int coordinate) {
        JointDrive drive;
        drive.coordinate = coordinate;
        if (m.speed) {
            drive.holds_speed = true;
            drive.speed = *m.speed;
        } else {
            drive =
                spring("motor", {m.frequency, m.damping, {}, {}}, mass_at(coordinate), coordinate);
            drive.target = *m.target;
        }
        drive.most = m.max.value_or(kNoLimit);
        return drive;
    }

    const JointDescription& asked_;
    const Bodies& bodies_;
    FailJoint fail_;
    bool of_world_;
    Joint joint_;
};

}  // namespace

void set_length(JointDescription& joint, const Bodies& bodies, BodyId a, BodyId b, FailJoint fail) {
    if (!is_line(joint.type)) return;
    if (!joint.anchor_a) joint.anchor_a = bodies.position[a];
    if (!joint.anchor_b) joint.anchor_b = bodies.position[b];
    const double apart = stable_norm(*joint.anchor_b - *joint.anchor_a);
    const bool is_given = joint.length.has_value();
    if (!is_given) joint.length = apart;
    const double length = *joint.length, slack = kSameLength * length;
    const std::string placed = fmt::format("the anchors are placed {} m apart", apart);
    const bool has_no_way = apart == 0 && length > 0 && joint.type != JointType::kRope;
    if (has_no_way || (length == 0 && joint.type != JointType::kSpring))
        fail(
            joint.type == JointType::kSpring ? "length" : "anchor_b",
            "both anchors are at one point, where a length has no direction; expected anchors that "
            "are apart");
    if (joint.type == JointType::kDistance && !(std::abs(length - apart) <= slack))
        fail("length", placed + "; expected this, or no length");
    if (joint.type == JointType::kRope && !(apart <= length + slack))
        fail("length", placed + "; expected no less");
}

Joint make_joint(const JointDescription& joint, const Bodies& bodies, BodyId a, BodyId b,
                 FailJoint fail) {
    return JointMaker(joint, bodies, a, b, fail).made();
}

}  // namespace tesserae
