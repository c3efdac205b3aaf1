// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/joint_keys.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace tesserae::scenes {
namespace {

/// The plane names, in the order of Bivector.
constexpr std::span<const std::string_view> kHingePlanes =
    std::span(kCoordinateNames).subspan(kFirstAngle);

Vec4 axis_of(char letter) {
    return Vec4::Unit(static_cast<Eigen::Index>(std::string_view("xyzw").find(letter)));
}

constexpr double kDegree = std::numbers::pi / 180;

}  // namespace

JointDescription in_radians(const JointTable& table) {
    JointDescription joint = table;
    joint.rotation = rotor_of(table.turns);
    for (std::size_t i = kFirstAngle; i < kJointCoordinates; ++i) {
        if (joint.limits[i]) *joint.limits[i] *= kDegree;
        if (joint.motors[i] && joint.motors[i]->target) *joint.motors[i]->target *= kDegree;
    }
    return joint;
}

void JointTypeName::read(TableReader& reader, const char* key, JointTable& joint) const {
    std::string expected = "expected one of";
    for (const std::string_view name : kJointTypeNames) expected += fmt::format(" \"{}\"", name);
    std::size_t type = 0;
    if (!reader.require(key, expected) || !reader.read(key, type, kJointTypeNames)) return;
    joint.type = static_cast<JointType>(type);
    joint.has_type = true;
}

void PlaneOfHinge::read(TableReader& reader, const char* key, JointPlane& plane) const {
    if (!reader.is_array(key)) {
        std::size_t index = 0;
        reader.read(key, index, kHingePlanes);
        plane = {axis_of(kHingePlanes[index][0]), axis_of(kHingePlanes[index][1])};
        return;
    }
    std::vector<Vec4> directions;
    reader.read(key, directions);
    if (directions.size() != 2)
        reader.fail(key, fmt::format("has {} directions; expected two, four numbers each",
                                     directions.size()));
    plane = {directions[0], directions[1]};
    require_span(plane, [&](const char*, std::string_view what) { reader.fail(key, what); });
}

void PlaneOfHinge::write(EffectiveWriter& out, const char* key, const JointPlane& plane) const {
    for (const std::string_view name : kHingePlanes)
        if (plane.first == axis_of(name[0]) && plane.second == axis_of(name[1]))
            return out.key(key, name);
    out.key(key, std::vector<Vec4>{plane.first, plane.second});
}

void FreeCoordinates::read(TableReader& reader, const char* key, std::uint16_t& free) const {
    std::vector<std::string> given;
    reader.read(key, given, kCoordinateNames);
    if (given.empty())
        reader.fail(key, "expected at least one coordinate; a joint without any is a \"weld\"");
    for (std::size_t i = 0; i < kCoordinateNames.size(); ++i)
        if (std::find(given.begin(), given.end(), kCoordinateNames[i]) != given.end())
            free = static_cast<std::uint16_t>(free | 1 << i);
}

void FreeCoordinates::write(EffectiveWriter& out, const char* key, std::uint16_t free) const {
    std::string text;
    for (std::size_t i = 0; i < kCoordinateNames.size(); ++i)
        if ((free >> i & 1) != 0)
            text += (text.empty() ? "" : ", ") + toml_text(kCoordinateNames[i]);
    out.line(key, "[" + text + "]");
}

void LimitsOf::read(TableReader& reader, std::string_view key, Vec2& limits) const {
    if (!reader.read(key, limits, Rule::kFinite)) return;
    require_order(limits, [&](const char*, std::string_view what) { reader.fail(key, what); });
    if (coordinate >= kFirstAngle && limits.cwiseAbs().maxCoeff() > 180)
        reader.fail(key, "expected angles from -180 to 180 degrees");
}

void SpringOf::read(TableReader& reader, std::string_view key, JointSpring& spring) const {
    reader.read_inside(key, "{ frequency = 2, damping = 0.1 }", [&](TableReader& inside) {
        spring_keys(spring, ReadKeys{inside});
        inside.collect([&] { complete_in(inside, spring); });
    });
}

std::string SpringOf::text(const JointSpring& spring) const {
    EffectiveWriter lines;
    spring_keys(spring, WriteKeys{lines});
    return inline_table(lines);
}

void MotorOf::read(TableReader& reader, std::string_view key, JointMotor& motor) const {
    reader.read_inside(key, "{ speed = 1, max = 10 }", [&](TableReader& inside) {
        motor_keys(motor, ReadKeys{inside}, coordinate);
        inside.collect([&] { complete_in(inside, motor); });
    });
}

std::string MotorOf::text(const JointMotor& motor) const {
    EffectiveWriter lines;
    motor_keys(motor, WriteKeys{lines}, coordinate);
    return inline_table(lines);
}

void BreakOf::read(TableReader& reader, const char* key, JointBreak& breaks) const {
    reader.read_inside(key, "{ force = 100, torque = 20 }", [&](TableReader& inside) {
        break_keys(breaks, ReadKeys{inside});
        require_load(breaks, [&](const char* name, std::string_view expected) {
            if (!inside.has("torque")) inside.require(name, expected);
        });
    });
}

void BreakOf::write(EffectiveWriter& out, const char* key, const JointBreak& breaks) const {
    EffectiveWriter lines;
    break_keys(breaks, WriteKeys{lines});
    out.line(key, inline_table(lines));
}

}  // namespace tesserae::scenes
