// SPDX-License-Identifier: Apache-2.0
#include "core/world/check.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/dynamics/constraints/joint_rules.hpp"
#include "core/error.hpp"
#include "core/ranges.hpp"

namespace tesserae {
namespace {

/// A rotor this far from a unit rotor is a mistake, usual 1e-6; a nearer one has drifted.
constexpr double kDrift = 1e-6;
constexpr auto kPlanes = std::span(kCoordinateNames).subspan(kFirstAngle);

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

void check_unit(std::string_view place, const Rotor& rotor) {
    const double square = rotor.s * rotor.s + dot(rotor.b, rotor.b) + rotor.p * rotor.p;
    const double cross = 2 * rotor.s * rotor.p - wedge(rotor.b, rotor.b);
    if (std::abs(square - 1) <= kDrift && std::abs(cross) <= kDrift) return;
    throw InputError(fmt::format(
        "{}: is no rotation: s^2 + |B|^2 + p^2 = {} and 2 s p - B ^ B = {}; expected 1 and 0",
        place, square, cross));
}

/// Checks a joint, and calls its parts by their names in some language.
class JointCheck {
  public:
    JointCheck(JointDescription& joint, NameOfPart name) : joint_(joint), name_(name) {}

    void complete() {
        const auto type = static_cast<int>(joint_.type);
        require(type >= 0 && type < static_cast<int>(kJointTypeNames.size()), name_({"type"}), type,
                "one of JointType");
        check(name_({"anchor"}), joint_.anchor);
        if (joint_.anchor_a) check(name_({"anchor_a"}), *joint_.anchor_a);
        if (joint_.anchor_b) check(name_({"anchor_b"}), *joint_.anchor_b);
        check_number({"length"}, joint_.length,
                     {joint_.type == JointType::kSpring ? 0 : kSmallest, kLargest});
        check_directions();
        check_unit(name_({"rotation"}), joint_.rotation);
        if (joint_.type == JointType::kGeneral &&
            (joint_.free == 0 || joint_.free >> kJointCoordinates != 0))
            fail({"free"}, "expected at least one of ten coordinates; with none it is a weld");
        if (joint_.type == JointType::kSpring) complete_spring({"spring"}, joint_.spring);
        for (std::size_t i = 0; i < kJointCoordinates; ++i) complete_coordinate(i);
        if (joint_.breaks) check_breaks(*joint_.breaks);
    }

  private:
    [[noreturn]] void fail(const JointPart& part, std::string_view what) const {
        throw InputError(fmt::format("{}: {}", name_(part), what));
    }
    /// Returns what tells errors of the members of a part.
    auto failing(const JointPart& part) const {
        return [this, part](const char* key, std::string_view what) {
            fail({part.member, part.coordinate, key}, what);
        };
    }
    void check_number(const JointPart& part, const std::optional<double>& value,
                      const Span& span) const {
        if (value) require_in(name_(part), *value, span);
    }

    void complete_spring(const JointPart& of, JointSpring& spring) const {
        const auto part = [&](const char* key) { return JointPart{of.member, of.coordinate, key}; };
        check_number(part("frequency"), spring.frequency, span_of(Rule::kPositive));
        check_number(part("damping"), spring.damping, span_of(Rule::kNonNegative));
        check_number(part("stiffness"), spring.stiffness, span_of(Rule::kPositive));
        check_number(part("damping_force"), spring.damping_force, span_of(Rule::kNonNegative));
        tesserae::complete(spring, failing(of), failing(of));
    }
    void complete_motor(const JointPart& of, JointMotor& motor, const Span& targets) const {
        const auto part = [&](const char* key) { return JointPart{of.member, of.coordinate, key}; };
        check_number(part("speed"), motor.speed, {});
        check_number(part("target"), motor.target, targets);
        check_number(part("frequency"), motor.frequency, span_of(Rule::kPositive));
        check_number(part("damping"), motor.damping, span_of(Rule::kNonNegative));
        check_number(part("max"), motor.max, span_of(Rule::kPositive));
        tesserae::complete(motor, failing(of), failing(of));
    }

    /// Returns a bit for each coordinate that the joint leaves free, of those that may have limits,
    /// springs and motors.
    unsigned free_of_type() const {
        if (joint_.type == JointType::kSlider) return 1U << kSliding;
        if (joint_.type == JointType::kHinge) return 1U << kTurning;
        return joint_.type == JointType::kGeneral ? joint_.free : 0;
    }

    void complete_coordinate(std::size_t i) {
        auto& limits = joint_.limits[i];
        auto& spring = joint_.springs[i];
        auto& motor = joint_.motors[i];
        // An angle is told from its negative as far as half a turn.
        const Span values = i >= kFirstAngle ? Span{-M_PI, M_PI} : Span{};
        const char* any = limits ? "limits" : spring ? "springs" : motor ? "motors" : nullptr;
        if (any != nullptr && (free_of_type() >> i & 1) == 0)
            fail({any, i}, "this coordinate is held; expected one that is free");
        if (spring && joint_.type != JointType::kGeneral)
            fail({"springs", i}, "expected them in a general joint only");
        if (limits) {
            for (const double limit : {(*limits)[0], (*limits)[1]})
                require_in(name_({"limits", i}), limit, values);
            require_order(*limits, [&](const char*, std::string_view what) {
                fail({"limits", i}, what);
            });
        }
        if (spring) complete_spring({"springs", i}, *spring);
        if (motor) complete_motor({"motors", i}, *motor, values);
    }

    void check_directions() const {
        if (joint_.type == JointType::kSlider || joint_.type == JointType::kSwivel) {
            check(name_({"axis"}), joint_.axis);
            if (joint_.axis.cwiseAbs().maxCoeff() < kSmallest)
                fail({"axis"}, "expected a direction, not zero");
        }
        if (joint_.type != JointType::kHinge) return;
        check(name_({"plane", {}, "first"}), joint_.plane.first);
        check(name_({"plane", {}, "second"}), joint_.plane.second);
        require_span(joint_.plane,
                     [&](const char*, std::string_view what) { fail({"plane"}, what); });
    }

    void check_breaks(const JointBreak& breaks) const {
        check_number({"breaks", {}, "force"}, breaks.force, span_of(Rule::kPositive));
        check_number({"breaks", {}, "torque"}, breaks.torque, span_of(Rule::kPositive));
        require_load(breaks, failing({"breaks"}));
    }

    JointDescription& joint_;
    NameOfPart name_;
};

/// What is unbounded stands still: what moves a body is no part of it.
void check_unbounded(const BodyType& type) {
    const BodyType plain;
    const auto require_plain = [&](const char* member, double value, double default_value) {
        if (value == default_value) return;
        throw InputError(fmt::format("{} = {}: a {} never moves and has none; expected no {}",
                                     member, value, name_of(type.shape), member));
    };
    require_plain("mass", type.mass, plain.mass);
    require_plain("gravity_scale", type.gravity_scale, plain.gravity_scale);
    require_plain("damping", type.damping, plain.damping);
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
    if (is_bounded(type.shape))
        require_in("mass", type.mass, {kLeastMass, kLargestMass});
    else
        check_unbounded(type);
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
    check_unit("rotor", state.rotor);
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

void complete(JointDescription& joint, NameOfPart name) { JointCheck(joint, name).complete(); }

void complete(JointDescription& joint) {
    complete(joint, [](const JointPart& part) {
        std::string name = fmt::format("joint: {}", part.member);
        if (part.coordinate) name += fmt::format("[{}]", *part.coordinate);
        if (!part.key.empty()) name += fmt::format(".{}", part.key);
        return name;
    });
}

}  // namespace tesserae
