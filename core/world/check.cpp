// SPDX-License-Identifier: Apache-2.0
#include "core/world/check.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/ranges.hpp"

namespace tesserae {
namespace {

/// A rotor this far from a unit rotor is a mistake, usual 1e-6; a nearer one has drifted.
constexpr double kDrift = 1e-6;
constexpr std::array kPlanes = {"xy", "xz", "xw", "yz", "yw", "zw"};

/// The values that a number may have.
struct Span {
    double low = -kLargest, high = kLargest;

    bool has(double value) const { return value >= low && value <= high; }
};

void require(bool holds, std::string_view place, double value, std::string_view expected) {
    if (!holds) throw InputError(fmt::format("{} = {}: expected {}", place, value, expected));
}

void require_in(std::string_view place, double value, const Span& span) {
    require(span.has(value), place, value,
            fmt::format("a number from {} to {}", span.low, span.high));
}

Span span_of(Rule rule) {
    if (rule == Rule::kPositive) return {kSmallest, kLargest};
    if (rule == Rule::kNonNegative) return {0, kLargest};
    return {};
}

/// Checks one parameter of a shape, of any type that a parameter has.
class ParameterCheck {
  public:
    explicit ParameterCheck(const char* shape) : shape_(shape) {}

    void operator()(const Key& key, double value, Rule rule) const {
        require_in(place(key), value, span_of(rule));
    }
    template <int kSize>
    void operator()(const Key& key, const Eigen::Matrix<double, kSize, 1>& values,
                    Rule rule) const {
        for (int i = 0; i < kSize; ++i)
            require_in(fmt::format("{}[{}]", place(key), i), values[i], span_of(rule));
        if (rule == Rule::kNonZero && values.cwiseAbs().maxCoeff() < kSmallest)
            throw InputError(place(key) + ": expected a direction, not zero");
    }
    void operator()(const Key& key, const std::vector<Vec4>& points, Rule) const {
        for (std::size_t i = 0; i < points.size(); ++i)
            for (int axis = 0; axis < 4; ++axis)
                require_in(fmt::format("{}[{}][{}]", place(key), i, axis), points[i][axis], {});
    }
    void operator()(const Key& key, const std::array<std::int64_t, 2>& values, Rule) const {
        for (const std::int64_t value : values)
            require_in(place(key), static_cast<double>(value), {3, 1e6});
    }
    void operator()(const Key& key, RegularPolychoron which, Rule) const {
        const auto number = static_cast<int>(which);
        const bool is_known = number >= 0 && number <= static_cast<int>(std::size(kRegularNames));
        require(is_known, place(key), number, "one of RegularPolychoron");
    }

  private:
    std::string place(const Key& key) const { return fmt::format("{}: {}", shape_, key.name); }

    const char* shape_;
};

void check_unit(const Rotor& rotor) {
    const double square = rotor.s * rotor.s + dot(rotor.b, rotor.b) + rotor.p * rotor.p;
    const double cross = 2 * rotor.s * rotor.p - wedge(rotor.b, rotor.b);
    if (std::abs(square - 1) <= kDrift && std::abs(cross) <= kDrift) return;
    throw InputError(fmt::format(
        "rotor: is no rotation: s^2 + |B|^2 + p^2 = {} and 2 s p - B ^ B = {}; expected "
        "1 and 0",
        square, cross));
}

void check_optional(std::string_view place, const std::optional<double>& value, const Span& span) {
    if (value) require_in(place, *value, span);
}
void fail(std::string_view place, std::string_view what) {
    throw InputError(fmt::format("{}: {}", place, what));
}

void complete(std::string_view place, JointSpring& spring) {
    const auto part = [&](const char* name) { return fmt::format("{}.{}", place, name); };
    check_optional(part("frequency"), spring.frequency, span_of(Rule::kPositive));
    check_optional(part("damping"), spring.damping, span_of(Rule::kNonNegative));
    check_optional(part("stiffness"), spring.stiffness, span_of(Rule::kPositive));
    check_optional(part("damping_force"), spring.damping_force, span_of(Rule::kNonNegative));
    if (spring.frequency.has_value() == spring.stiffness.has_value())
        fail(place, "expected a frequency or a stiffness, one of them");
    if (spring.damping && !spring.frequency)
        fail(place, "damping goes with a frequency; expected damping_force beside a stiffness");
    if (spring.damping_force && !spring.stiffness)
        fail(place, "damping_force goes with a stiffness; expected damping beside a frequency");
    auto& damping = spring.frequency ? spring.damping : spring.damping_force;
    if (!damping) damping = 0;
}

void complete(std::string_view place, JointMotor& motor, const Span& targets) {
    const auto part = [&](const char* name) { return fmt::format("{}.{}", place, name); };
    check_optional(part("speed"), motor.speed, {});
    check_optional(part("target"), motor.target, targets);
    check_optional(part("frequency"), motor.frequency, span_of(Rule::kPositive));
    check_optional(part("damping"), motor.damping, span_of(Rule::kNonNegative));
    check_optional(part("max"), motor.max, span_of(Rule::kPositive));
    if (motor.speed.has_value() == motor.target.has_value())
        fail(place, "expected a speed or a target, one of them");
    if (motor.speed && (motor.frequency || motor.damping))
        fail(place, "frequency and damping go with a target, and there is a speed");
    if (motor.speed) return;
    if (!motor.frequency) motor.frequency = kMotorFrequency;
    if (!motor.damping) motor.damping = kMotorDamping;
}

/// Returns a bit for each coordinate that a joint of this type leaves free, of those that may have
/// limits, springs and motors.
unsigned free_of(const JointDescription& joint) {
    if (joint.type == JointType::kSlider) return 1U << kSliding;
    if (joint.type == JointType::kHinge) return 1U << kTurning;
    return joint.type == JointType::kGeneral ? joint.free : 0;
}

void complete_coordinate(JointDescription& joint, std::size_t i) {
    const bool is_angle = i >= kFirstAngle;
    // An angle is told from its negative as far as half a turn.
    const Span values = is_angle ? Span{-M_PI, M_PI} : Span{};
    const auto place = [&](const char* of) { return fmt::format("joint: {}[{}]", of, i); };
    const bool has_any = joint.limits[i] || joint.springs[i] || joint.motors[i];
    if (has_any && (free_of(joint) >> i & 1) == 0)
        fail(place("coordinate"), "is held; expected limits, springs and motors of free ones only");
    if (joint.springs[i] && joint.type != JointType::kGeneral)
        fail(place("springs"), "expected them in a general joint only");
    if (const auto& limits = joint.limits[i]) {
        for (const double limit : {(*limits)[0], (*limits)[1]})
            require_in(place("limits"), limit, values);
        if (!((*limits)[0] < (*limits)[1] && (*limits)[0] <= 0 && (*limits)[1] >= 0))
            fail(place("limits"), "expected low < high, with 0 between them: as it is made");
    }
    if (joint.springs[i]) complete(place("springs"), *joint.springs[i]);
    if (joint.motors[i]) complete(place("motors"), *joint.motors[i], values);
}

void check_directions(const JointDescription& joint) {
    const auto check_direction = [](const char* place, const Vec4& direction) {
        check(place, direction);
        if (direction.cwiseAbs().maxCoeff() < kSmallest)
            fail(place, "expected a direction, not zero");
    };
    if (joint.type == JointType::kSlider || joint.type == JointType::kSwivel)
        check_direction("joint: axis", joint.axis);
    if (joint.type != JointType::kHinge) return;
    check_direction("joint: plane.first", joint.plane.first);
    check_direction("joint: plane.second", joint.plane.second);
    // The sine of the angle below which the two count as parallel.
    constexpr double kParallel = 1e-7;
    const Vec4 first = stable_normalized(joint.plane.first);
    const Vec4 second = stable_normalized(joint.plane.second);
    if (!((second - second.dot(first) * first).norm() > kParallel))
        fail("joint: plane", "the two directions are parallel; expected two that span a plane");
}

}  // namespace

void check(std::string_view place, double value) { require_in(place, value, {}); }

void check(std::string_view place, const Vec4& value) {
    for (int i = 0; i < 4; ++i) check(fmt::format("{}.{}", place, "xyzw"[i]), value[i]);
}

void check(std::string_view place, const Bivector& value) {
    const double parts[] = {value.xy, value.xz, value.xw, value.yz, value.yw, value.zw};
    for (std::size_t i = 0; i < kPlanes.size(); ++i)
        check(fmt::format("{}.{}", place, kPlanes[i]), parts[i]);
}

void check(const Shape& shape) {
    std::visit([](const auto& s) { s.parameters(s, ParameterCheck(s.kName)); }, shape);
}

void make_complete(Shape& shape) {
    check(shape);
    std::visit([](auto& s) { complete(s); }, shape);
}

void check(const BodyType& type) {
    check(type.shape);
    if (is_bounded(type.shape)) require_in("mass", type.mass, {kLeastMass, kLargestMass});
    require_in("friction", type.friction, span_of(Rule::kNonNegative));
    require_in("rolling_friction", type.rolling_friction, span_of(Rule::kNonNegative));
    require_in("restitution", type.restitution, {0, 1});
    check("gravity_scale", type.gravity_scale);
    require_in("damping", type.damping, span_of(Rule::kNonNegative));
    require_in("group", type.group, {0, kMostGroups - 1});
}

void check(const BodyState& state) {
    check("position", state.position);
    check("rotor.s", state.rotor.s);
    check("rotor", state.rotor.b);
    check("rotor.p", state.rotor.p);
    check_unit(state.rotor);
    check("velocity", state.velocity);
    check("angular_velocity", state.angular_velocity);
}

void check(const PhysicsSettings& settings) {
    check("gravity", settings.gravity);
    require_in("duration", settings.duration, span_of(Rule::kNonNegative));
    require_in("steps_per_second", settings.steps_per_second, span_of(Rule::kPositive));
    require_in("substeps", settings.substeps, {1, 1000});
    require_in("iterations", settings.iterations, {1, 10000});
    require_in("tolerance", settings.tolerance, span_of(Rule::kNonNegative));
    const auto integrator = static_cast<int>(settings.integrator);
    require(integrator == 0 || integrator == 1, "integrator", integrator,
            "one of RotationIntegrator");
}

void complete(JointDescription& joint) {
    const auto type = static_cast<int>(joint.type);
    require(type >= 0 && type <= static_cast<int>(JointType::kGeneral), "joint: type", type,
            "one of JointType");
    check("joint: anchor", joint.anchor);
    if (joint.anchor_a) check("joint: anchor_a", *joint.anchor_a);
    if (joint.anchor_b) check("joint: anchor_b", *joint.anchor_b);
    check_optional("joint: length", joint.length,
                   {joint.type == JointType::kSpring ? 0 : kSmallest, kLargest});
    check_directions(joint);
    check_unit(joint.rotation);
    if (joint.type == JointType::kGeneral &&
        (joint.free == 0 || joint.free >> kJointCoordinates != 0))
        fail("joint: free",
             "expected a bit for at least one of ten coordinates; with none it is a weld");
    if (joint.type == JointType::kSpring) complete("joint: spring", joint.spring);
    for (std::size_t i = 0; i < kJointCoordinates; ++i) complete_coordinate(joint, i);
    if (!joint.breaks) return;
    check_optional("joint: breaks.force", joint.breaks->force, span_of(Rule::kPositive));
    check_optional("joint: breaks.torque", joint.breaks->torque, span_of(Rule::kPositive));
    if (!joint.breaks->force && !joint.breaks->torque)
        fail("joint: breaks", "expected a force or a torque");
}

}  // namespace tesserae
