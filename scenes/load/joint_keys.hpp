// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/dynamics/constraints/joint.hpp"
#include "core/dynamics/constraints/joint_rules.hpp"
#include "scenes/load/body_keys.hpp"

// The keys of [[joint]], in lists as rules.hpp describes them. Most keys depend on the joint's
// type.
namespace tesserae::scenes {

/// A [[joint]] table, as written: its angles are in degrees.
struct JointTable : JointDescription {
    std::string name;
    bool has_type = false;           ///< false: it is missing or wrong
    std::string a, b;                ///< names of bodies; an empty b is the world
    std::vector<Bivector> turns{1};  ///< of the axes of a general joint [degrees]
};
/// Returns what a table asks for, in radians.
JointDescription in_radians(const JointTable& table);

/// The name of a joint's type. Whether it could be read is in the table's has_type.
struct JointTypeName {
    static constexpr const char* kType = "string";
    static constexpr const char* kAllowed = "one of those below";

    void read(TableReader& reader, const char* key, JointTable& joint) const;
    void write(EffectiveWriter& out, const char* key, const JointTable& joint) const {
        out.key(key, kJointTypeNames[static_cast<std::size_t>(joint.type)]);
    }
};

/// Two directions, or the name of a plane of the world's axes.
struct PlaneOfHinge {
    static constexpr const char* kType = "string or 2 directions";
    static constexpr const char* kAllowed = "a plane such as `\"xy\"`, or two directions in it";

    void read(TableReader& reader, const char* key, JointPlane& plane) const;
    void write(EffectiveWriter& out, const char* key, const JointPlane& plane) const;
};

/// Names of coordinates.
struct FreeCoordinates {
    static constexpr const char* kType = "strings";
    static constexpr const char* kAllowed =
        "`x`, `y`, `z`, `w`, `xy`, `xz`, `xw`, `yz`, `yw`, `zw`";

    void read(TableReader& reader, const char* key, std::uint16_t& free) const;
    void write(EffectiveWriter& out, const char* key, std::uint16_t free) const;
};

// What one coordinate may have.

struct LimitsOf {
    static constexpr const char* kType = "2 reals";
    static constexpr const char* kAllowed = "[low, high], low <= 0 <= high; angles -180 to 180";

    int coordinate = 0;

    void read(TableReader& reader, std::string_view key, Vec2& limits) const;
    std::string text(const Vec2& limits) const { return toml_text(limits); }
    void write(EffectiveWriter& out, const char* key, const Vec2& limits) const {
        out.line(key, text(limits));
    }
};
struct SpringOf {
    int coordinate = 0;

    void read(TableReader& reader, std::string_view key, JointSpring& spring) const;
    std::string text(const JointSpring& spring) const;
};
struct MotorOf {
    static constexpr const char* kType = "table";
    static constexpr const char* kAllowed = "see below";

    int coordinate = 0;

    void read(TableReader& reader, std::string_view key, JointMotor& motor) const;
    std::string text(const JointMotor& motor) const;
    void write(EffectiveWriter& out, const char* key, const JointMotor& motor) const {
        out.line(key, text(motor));
    }
};

/// A table that has something for some of the free coordinates.
template <class R>
struct ForEachFree {
    static constexpr const char* kType = "table";
    static constexpr const char* kAllowed = "a key for each free coordinate that has it";

    std::uint16_t free;
    const char* example;

    void read(TableReader& reader, const char* key, auto& values) const {
        reader.read_inside(key, example, [&](TableReader& inside) {
            for (int i = 0; i < FrameJoint::kSize; ++i) {
                const auto at = static_cast<std::size_t>(i);
                const std::string_view name = kCoordinateNames[at];
                if (!inside.has(name)) continue;
                inside.collect([&] {
                    // Where none is free, that is the error.
                    if (free != 0 && (free >> i & 1) == 0)
                        inside.fail(name, "this coordinate is held; expected one that is free");
                    R{i}.read(inside, name, values[at].emplace());
                });
            }
        });
    }
    void write(EffectiveWriter& out, const char* key, const auto& values) const {
        EffectiveWriter lines;
        for (int i = 0; i < FrameJoint::kSize; ++i)
            if (const auto at = static_cast<std::size_t>(i); values[at])
                lines.line(kCoordinateNames[at], R{i}.text(*values[at]));
        if (!lines.text().empty()) out.line(key, inline_table(lines));
    }
};

/// Where a motor drives a coordinate to.
struct TargetOf {
    static constexpr const char* kAllowed = "angles -180 to 180";

    int coordinate;

    void read(TableReader& reader, const char* key, double& target) const {
        reader.read(key, target, coordinate < kFirstAngle ? Interval{} : Interval{-180, 180});
    }
};

/// Forces that a joint does not survive.
struct BreakOf {
    static constexpr const char* kType = "table";
    static constexpr const char* kAllowed = "see below";

    void read(TableReader& reader, const char* key, JointBreak& breaks) const;
    void write(EffectiveWriter& out, const char* key, const JointBreak& breaks) const;
};

/// Checks which keys of a spring or motor are there, and sets the defaults of the others.
template <class Part>
void complete_in(TableReader& reader, Part& part) {
    complete(
        part, [&](const char* key, std::string_view what) { reader.fail(key, what); },
        [&](const char* key, std::string_view expected) { reader.require(key, expected); });
}

/// [[joint]]: what it is and what it joins
void joint_keys(auto& self, const auto& visit) {
    visit({"name", "",
           "Reports, trajectories and --set call the joint by this; no two have the same.",
           "joint- and its number"},
          self.name);
    visit({"type", "", "The joint is of this type; each type has keys of its own.", "required"},
          self, JointTypeName{});
    visit({"a", "", "The joint holds this body.", "required"}, self.a,
          Required{"expected a body's name", BodyName{}});
    visit({"b", "", "The joint joins the body to this one.", "the world"}, self.b, BodyName{});
}
/// [[joint]]: what all types have after their own
void joint_end_keys(auto& self, const auto& visit) {
    visit({"break", "", "The joint breaks where its load in a step is more than this.", "never"},
          self.breaks, BreakOf{});
    visit({"collide", "", "The two bodies have contacts with each other too."}, self.collide);
}

/// The keys of a spring
void spring_keys(auto& self, const auto& visit) {
    visit({"frequency", "Hz",
           "The spring is so stiff that the bodies would swing at this frequency on it, without "
           "damping and all else.",
           "or a stiffness"},
          self.frequency, Rule::kPositive);
    visit({"damping", "",
           "With a frequency, the damping is this part of the critical one, at which nothing "
           "swings.",
           "`0.0`"},
          self.damping, Rule::kNonNegative);
    visit({"stiffness", "N/m, N m/rad",
           "The force of the spring is this much a metre, or its moment this much a radian.",
           "or a frequency"},
          self.stiffness, Rule::kPositive);
    visit({"damping_force", "N s/m, N m s/rad",
           "With a stiffness, the force of the damping is this much for a speed of one.", "`0.0`"},
          self.damping_force, Rule::kNonNegative);
}

/// motor = { ... }
void motor_keys(auto& self, const auto& visit, int coordinate) {
    visit({"speed", "m/s, rad/s", "The motor drives the joint at this speed.", "or a target"},
          self.speed, Rule::kFinite);
    visit({"target", "m, deg", "The motor drives the joint to this place and holds it there.",
           "or a speed"},
          self.target, TargetOf{coordinate});
    visit({"frequency", "Hz", "With a target, the motor is as stiff as a spring of this frequency.",
           "`5.0`"},
          self.frequency, Rule::kPositive);
    visit({"damping", "", "With a target, the motor's damping is this part of the critical one.",
           "`1.0`"},
          self.damping, Rule::kNonNegative);
    visit({"max", "N, N m", "The motor has no greater force, or moment, than this.", "no limit"},
          self.max, Rule::kPositive);
}

/// break = { ... }
void break_keys(auto& self, const auto& visit) {
    visit({"force", "N", "The joint breaks where its mean force in a step is more than this.",
           "no limit"},
          self.force, Rule::kPositive);
    visit({"torque", "N m", "The joint breaks where its mean moment in a step is more than this.",
           "no limit"},
          self.torque, Rule::kPositive);
}

// The keys of the types.

void anchor_key(auto& self, const auto& visit) {
    visit({"anchor", "m", "The joint is at this point of the world, at time 0."}, self.anchor,
          Required{"expected four numbers: the point where the joint is", Rule::kFinite});
}
void anchors_keys(auto& self, const auto& visit) {
    visit({"anchor_a", "m", "The joint is tied to body a at this point of the world, at time 0.",
           "the centre of a"},
          self.anchor_a, Rule::kFinite);
    visit({"anchor_b", "m", "The joint is tied to body b, or the world, at this point, at time 0.",
           "the centre of b; of the world required"},
          self.anchor_b, Rule::kFinite);
}
void one_free_keys(auto& self, const auto& visit, int coordinate) {
    const auto at = static_cast<std::size_t>(coordinate);
    visit({"limits", "m, deg",
           "The joint moves only between these two values; 0 is where the bodies are placed.",
           "none"},
          self.limits[at], LimitsOf{coordinate});
    visit({"motor", "", "The joint is driven to a speed or a place.", "none"}, self.motors[at],
          MotorOf{coordinate});
}
void hinge_keys(auto& self, const auto& visit) {
    anchor_key(self, visit);
    visit({"plane", "",
           "The bodies turn against each other in this plane only; an angle is positive from its "
           "first direction toward its second."},
          self.plane,
          Required{R"(expected the plane to turn in, such as "xy", or two directions)",
                   PlaneOfHinge{}});
    one_free_keys(self, visit, kTurning);
}
void general_keys(auto& self, const auto& visit) {
    anchor_key(self, visit);
    visit({"rotation", "deg",
           "The joint's axes are the world's, turned by this as a body is; all coordinates are "
           "along them."},
          self.turns, Turns{});
    visit({"free", "",
           "These coordinates are not held. They say how far b, or a in the world, is moved along "
           "the axes and turned in their planes."},
          self.free, Required{R"(expected a list such as ["x", "yz"])", FreeCoordinates{}});
    visit({"limits", "m, deg",
           "Free coordinates stay between two values each; 0 is where the bodies are placed.",
           "none"},
          self.limits, ForEachFree<LimitsOf>{self.free, "{ x = [-1, 1], xy = [-30, 30] }"});
    visit({"spring", "", "Springs pull free coordinates to 0; each has the keys below.", "none"},
          self.springs, ForEachFree<SpringOf>{self.free, "{ x = { frequency = 2 } }"});
    visit({"motor", "", "Free coordinates are driven; each motor has the keys below.", "none"},
          self.motors, ForEachFree<MotorOf>{self.free, "{ xy = { speed = 1, max = 10 } }"});
}
/// [[joint]]: what its type has
void joint_type_keys(auto& self, const auto& visit) {
    switch (self.type) {
        case JointType::kPoint:
        case JointType::kWeld:
            return anchor_key(self, visit);
        case JointType::kDistance:
            anchors_keys(self, visit);
            visit({"length", "m", "The anchors stay this far apart.", "as they are placed"},
                  self.length, Rule::kPositive);
            return;
        case JointType::kRope:
            anchors_keys(self, visit);
            visit({"length", "m", "The anchors come at most so far apart.", "as they are placed"},
                  self.length, Rule::kPositive);
            return;
        case JointType::kSpring:
            anchors_keys(self, visit);
            visit({"length", "m", "The spring pulls and pushes to this length.",
                   "as the anchors are placed"},
                  self.length, Rule::kNonNegative);
            return spring_keys(self.spring, visit);
        case JointType::kSlider:
            visit({"axis", "", "The bodies slide along this direction and do not turn."}, self.axis,
                  Required{"expected four numbers: the direction to slide along", Rule::kNonZero});
            return one_free_keys(self, visit, kSliding);
        case JointType::kHinge:
            return hinge_keys(self, visit);
        case JointType::kSwivel:
            anchor_key(self, visit);
            visit({"axis", "",
                   "The bodies turn against each other in all ways that leave this direction."},
                  self.axis,
                  Required{"expected four numbers: the direction that stays", Rule::kNonZero});
            return;
        case JointType::kGeneral:
            return general_keys(self, visit);
    }
}

}  // namespace tesserae::scenes
