// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "core/dynamics/constraints/joint_rules.hpp"
#include "core/error.hpp"
#include "core/world/check.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/python/record.hpp"
#include "scenes/python/world.hpp"

// Joints of worlds. The keys of each type are those of a scene's [[joint]], in metres and radians.
namespace tesserae::python {
namespace {

using py::arg;

constexpr std::array<std::string_view, 4> kAxes = {"x", "y", "z", "w"};

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

template <class Names>
std::size_t place_in(const Names& names, const std::string& name, const char* what) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    throw InputError(fmt::format("joint: {} \"{}\": expected one of {}", what, name,
                                 joined({names.begin(), names.end()})));
}

/// A table of keys that are read one by one. What is left in the end is an error.
class Keys {
  public:
    /// @param place   of the table
    /// @param of      what its values are called by, if that is not the place
    Keys(std::string place, const py::handle& table, const char* of = nullptr)
        : place_(std::move(place)), of_(of != nullptr ? of : place_) {
        if (!py::isinstance<py::dict>(table))
            throw py::type_error(fmt::format("{}: expected a dict, got {}", place_,
                                             py::repr(table).cast<std::string>()));
        keys_ = py::dict(py::reinterpret_borrow<py::dict>(table).attr("copy")());
    }

    /// Returns the value of a key and takes it out; a null object if it is absent or None.
    py::object take(const char* name) {
        known_.emplace_back(name);
        if (!keys_.contains(name)) return {};
        py::object value = keys_.attr("pop")(name);
        return value.is_none() ? py::object() : value;
    }
    py::object require(const char* name, const char* expected) {
        py::object value = take(name);
        if (value) return value;
        // What was typed instead, if a letter is wrong in it.
        const std::vector<std::string> given = names_left();
        const std::string_view near = scenes::nearest_name(name, viewed(given));
        const std::string instead = near.empty() ? "" : fmt::format(", and there is '{}'", near);
        throw InputError(
            fmt::format("{}: {} is missing{}: expected {}", place_, name, instead, expected));
    }
    void take_real(const char* name, std::optional<double>& value) {
        if (const py::object given = take(name)) value = real_of(given, of_ + "." + name);
    }
    void take_truth(const char* name, bool& value) {
        const py::object given = take(name);
        if (!given) return;
        try {
            value = given.cast<bool>();
        } catch (const py::cast_error&) {
            throw py::type_error(fmt::format("{}.{}: expected True or False, got {}", of_, name,
                                             py::repr(given).cast<std::string>()));
        }
    }
    /// @throws InputError   a key was not taken
    void finish() const {
        for (const std::string& name : names_left())
            throw InputError(fmt::format("{}: unknown key '{}': expected {}{}", place_, name,
                                         joined(known_),
                                         scenes::did_you_mean(name, viewed(known_))));
    }
    /// What its values are called by in errors.
    const std::string& of() const { return of_; }

  private:
    std::vector<std::string> names_left() const {
        std::vector<std::string> names;
        for (const auto& [name, value] : keys_) names.push_back(py::str(name).cast<std::string>());
        return names;
    }
    static std::vector<std::string_view> viewed(const std::vector<std::string>& names) {
        return {names.begin(), names.end()};
    }

    std::string place_, of_;
    py::dict keys_;
    std::vector<std::string> known_;
};

void read_spring(Keys& keys, JointSpring& spring) {
    keys.take_real("frequency", spring.frequency);
    keys.take_real("damping", spring.damping);
    keys.take_real("stiffness", spring.stiffness);
    keys.take_real("damping_force", spring.damping_force);
}

JointSpring spring_of(const std::string& place, const py::handle& value) {
    Keys keys(place, value);
    JointSpring spring;
    read_spring(keys, spring);
    keys.finish();
    return spring;
}
JointMotor motor_of(const std::string& place, const py::handle& value) {
    Keys keys(place, value);
    JointMotor motor;
    keys.take_real("speed", motor.speed);
    keys.take_real("target", motor.target);
    keys.take_real("frequency", motor.frequency);
    keys.take_real("damping", motor.damping);
    keys.take_real("max", motor.max);
    keys.finish();
    return motor;
}
Vec2 limits_of(const std::string& place, const py::handle& value) {
    return vec2_of(value, place.c_str());
}

/// Reads what free coordinates of a general joint have.
template <class T, class Read>
void read_coordinates(Keys& keys, const char* name, std::uint16_t free, OfCoordinates<T>& values,
                      Read&& read) {
    const py::object table = keys.take(name);
    if (!table) return;
    Keys inside(keys.of() + "." + name, table);
    for (std::size_t i = 0; i < kJointCoordinates; ++i) {
        const std::string coordinate(kCoordinateNames[i]);
        const py::object value = inside.take(coordinate.c_str());
        if (!value) continue;
        if ((free >> i & 1) == 0)
            throw InputError(
                fmt::format("{}.{}: this coordinate is held; expected one that is free",
                            inside.of(), coordinate));
        values[i] = read(inside.of() + "." + coordinate, value);
    }
    inside.finish();
}

JointPlane plane_of(const py::object& value) {
    if (py::isinstance<py::str>(value)) {
        const auto name = value.cast<std::string>();
        if (name.size() != 2 || name[0] == name[1])
            throw InputError(
                fmt::format("joint.plane = \"{}\": expected two axes, such as \"xy\"", name));
        const auto axis = [&](std::size_t i) {
            return Vec4::Unit(static_cast<int>(place_in(kAxes, name.substr(i, 1), "axis")));
        };
        return {axis(0), axis(1)};
    }
    constexpr const char* kExpected =
        "joint.plane: expected two axes, such as \"xy\", or two directions";
    if (numbers_of(value, "joint.plane").ndim() != 2) throw InputError(kExpected);
    const Rows directions(value, "joint.plane", 4);
    if (directions.count() != 2) throw InputError(kExpected);
    return {directions.vec4(0), directions.vec4(1)};
}

void read_anchors(Keys& keys, JointDescription& joint) {
    if (const auto point = keys.take("anchor_a")) joint.anchor_a = vec4_of(point, "joint.anchor_a");
    if (const auto point = keys.take("anchor_b")) joint.anchor_b = vec4_of(point, "joint.anchor_b");
    keys.take_real("length", joint.length);
}
void read_anchor(Keys& keys, JointDescription& joint) {
    joint.anchor = vec4_of(keys.require("anchor", "the point where the joint is"), "joint.anchor");
}
void read_one_free(Keys& keys, JointDescription& joint, std::size_t coordinate) {
    if (const auto limits = keys.take("limits"))
        joint.limits[coordinate] = limits_of("joint.limits", limits);
    if (const auto motor = keys.take("motor"))
        joint.motors[coordinate] = motor_of("joint.motor", motor);
}
void read_general(Keys& keys, JointDescription& joint) {
    read_anchor(keys, joint);
    if (const auto rotor = keys.take("rotor")) joint.rotation = rotor_of(rotor, "joint.rotor");
    const py::object free = keys.require("free", "a list such as [\"x\", \"yz\"]");
    if (py::isinstance<py::str>(free) || !py::isinstance<py::iterable>(free))
        throw InputError("joint.free: expected a list such as [\"x\", \"yz\"]");
    for (const py::handle name : free) {
        const auto text = py::str(name).cast<std::string>();
        joint.free = static_cast<std::uint16_t>(
            joint.free | 1u << place_in(kCoordinateNames, text, "free coordinate"));
    }
    read_coordinates(keys, "limits", joint.free, joint.limits, limits_of);
    read_coordinates(keys, "spring", joint.free, joint.springs, spring_of);
    read_coordinates(keys, "motor", joint.free, joint.motors, motor_of);
}

void read_type(Keys& keys, JointDescription& joint) {
    const auto axis = [&](const char* expected) {
        joint.axis = vec4_of(keys.require("axis", expected), "joint.axis");
    };
    switch (joint.type) {
        case JointType::kPoint:
        case JointType::kWeld:
            return read_anchor(keys, joint);
        case JointType::kSpring:
            read_spring(keys, joint.spring);
            return read_anchors(keys, joint);
        case JointType::kDistance:
        case JointType::kRope:
            return read_anchors(keys, joint);
        case JointType::kSlider:
            axis("the direction to slide along");
            return read_one_free(keys, joint, kSliding);
        case JointType::kHinge:
            read_anchor(keys, joint);
            joint.plane = plane_of(keys.require("plane", "the plane to turn in, such as \"xy\""));
            return read_one_free(keys, joint, kTurning);
        case JointType::kSwivel:
            read_anchor(keys, joint);
            return axis("the direction that stays");
        case JointType::kGeneral:
            return read_general(keys, joint);
    }
}

/// Returns a part of a joint as the keys of join() name it.
std::string key_of(const JointDescription& joint, const JointPart& part) {
    std::string name = "joint";
    const auto append = [&](std::string_view key) { name += fmt::format(".{}", key); };
    // The keys of a spring stand beside those of its joint.
    const bool is_beside = joint.type == JointType::kSpring && part.member == "spring";
    if (part.member == "springs")
        append("spring");
    else if (part.member == "motors")
        append("motor");
    else if (part.member == "rotation")
        append("rotor");
    else if (!is_beside)
        append(part.member);
    if (part.coordinate && joint.type == JointType::kGeneral)
        append(kCoordinateNames[*part.coordinate]);
    if (!part.key.empty()) append(part.key);
    return name;
}

JointId join(SharedWorld& self, const std::string& type, const py::object& a, const py::object& b,
             const py::kwargs& given) {
    JointDescription joint;
    joint.type = static_cast<JointType>(place_in(kJointTypeNames, type, "type"));
    Keys keys(type + " joint", given, "joint");
    read_type(keys, joint);
    if (const auto breaks = keys.take("breaks")) {
        Keys inside("joint.breaks", breaks);
        joint.breaks.emplace();
        inside.take_real("force", joint.breaks->force);
        inside.take_real("torque", joint.breaks->torque);
        inside.finish();
    }
    keys.take_truth("collide", joint.collide);
    keys.finish();
    if (a.is_none()) throw InputError("joint: a = None: expected a body; the world may be b");
    // The world checks it, too, and would name its parts in C++.
    complete(joint, [&](const JointPart& part) { return key_of(joint, part); });
    return self.get().join(joint, body_of(a, "a"), body_of(b, "b"));
}

py::object number_of(BodyId body) {
    return body == kWorld ? py::object(py::none()) : py::object(py::int_(body));
}
JointId joint_of(const py::object& joint) { return body_of(joint, "joint"); }

py::object joint(const SharedWorld& self, const py::object& number) {
    const JointReading reading = self.get().joint(joint_of(number));
    return record("JointReading", number_of(reading.a), number_of(reading.b), reading.broken,
                  reading.impulse, reading.angular_impulse, reading.error, reading.angular_error,
                  reading.position);
}

}  // namespace

void add_joints(WorldClass& world) {
    world.def("join", &join, arg("type"), arg("a"), arg("b") = py::none(),
              R"(join(self, type, a, b=None, **keys)
--

Joins two bodies where they are now, or a body and the world, and returns the joint's number. Types
and keys are those of a scene's [[joint]], with points and directions of the world, in metres and
radians:

  point, weld       anchor
  distance, rope    anchor_a, anchor_b, length
  spring            the same and frequency, damping or stiffness, damping_force
  slider            axis, limits, motor
  hinge             anchor, plane, limits, motor
  swivel            anchor, axis
  general           anchor, rotor, free, and limits, spring, motor by coordinate
  all               breaks={"force": N, "torque": N m}, collide=True

>>> world = ts.World()
>>> bar = world.add(ts.Hyperbox([2, 0.2, 0.2, 0.2]), position=[1, 0, 0, 0])
>>> hinge = world.join("hinge", bar, anchor=[0, 0, 0, 0], plane="xy", limits=(-1, 1))
>>> report = world.step(steps=240)
>>> round(world.joint(hinge).position, 2)
-1.0
)");
    world.def(
        "remove_joint",
        [](SharedWorld& self, const py::object& number) {
            self.get().remove_joint(joint_of(number));
        },
        arg("joint"), R"(remove_joint(self, joint)
--

Removes a joint.
)");
    world.def(
        "has_joint",
        [](const SharedWorld& self, const py::object& number) {
            const std::optional<JointId> id = number_in(number);
            return id && self.get().has_joint(*id);
        },
        arg("joint"), R"(has_joint(self, joint)
--

Returns whether the world has a joint of this number.
)");
    world.def("joint", &joint, arg("joint"), R"(joint(self, joint)
--

Returns what a joint is and did in the last step, a JointReading.
)");
    world.def_property_readonly(
        "joint_ids",
        [](const SharedWorld& self) {
            const auto ids = self.get().joint_ids();
            return py::array_t<JointId>(static_cast<py::ssize_t>(ids.size()), ids.data());
        },
        "The numbers of the joints (m,), ascending.");
}

}  // namespace tesserae::python
