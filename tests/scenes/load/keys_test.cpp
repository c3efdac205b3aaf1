// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>
#include <sstream>

#include "scenes/load/body_keys.hpp"
#include "scenes/load/joint_keys.hpp"
#include "scenes/load/overlay_keys.hpp"
#include "scenes/load/picture_keys.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

constexpr const char* kScene = R"(
[physics]
[camera]
slice_thickness = 0.5
[[material]]
name = "m"
[[light]]
type = "sky"
[[light]]
type = "sun"
direction = [0, -1, 0, 0]
[[light]]
type = "point"
position = [0, 5, 0, 0]
[[light]]
type = "sphere"
position = [0, 5, 0, 0]
radius = 1
[overlay]
title = "t"
[[overlay.caption]]
text = "c"
[[body]]
name = "b"
shape = "hypersphere"
radius = 1
[[lattice]]
name = "l"
shape = "hypersphere"
radius = 1
count = [2, 2, 1, 1]
spacing = 3
)";

/// A joint of every type, called as its type.
const std::string kJointScene = std::string(kScene) + R"(
[[body]]
name = "j"
shape = "hypersphere"
radius = 1
position = [9, 0, 0, 0]
[[joint]]
name = "point"
type = "point"
a = "j"
anchor = [0, 0, 0, 0]
[[joint]]
name = "distance"
type = "distance"
a = "j"
anchor_a = [0, 0, 0, 0]
anchor_b = [0, 3, 0, 0]
[[joint]]
name = "rope"
type = "rope"
a = "j"
anchor_a = [0, 0, 0, 0]
anchor_b = [0, 3, 0, 0]
[[joint]]
name = "spring"
type = "spring"
a = "j"
anchor_a = [0, 0, 0, 0]
anchor_b = [0, 3, 0, 0]
frequency = 1
[[joint]]
name = "weld"
type = "weld"
a = "j"
anchor = [0, 0, 0, 0]
[[joint]]
name = "slider"
type = "slider"
a = "j"
axis = [1, 0, 0, 0]
[[joint]]
name = "hinge"
type = "hinge"
a = "j"
anchor = [0, 0, 0, 0]
plane = "xy"
[[joint]]
name = "swivel"
type = "swivel"
a = "j"
anchor = [0, 0, 0, 0]
axis = [1, 0, 0, 0]
[[joint]]
name = "general"
type = "general"
a = "j"
anchor = [0, 0, 0, 0]
free = ["x"]
)";

// other(value, rule): a value, in TOML, that the rule allows and that changes the scene.
constexpr const char* kOtherVector = "[0.25, 1, 2, 3]";

std::string other(double value, Interval interval) {
    for (const double v : {0.25, 0.75, 1.5, 20.0})
        if (v != value && v > interval.low && v < interval.high) return toml_text(v);
    return "no value";
}
std::string other(double value, Rule rule) { return other(value, interval_of(rule)); }
std::string other(double value, NextTime) { return other(value, Interval{}); }
std::string other(double value, RealOrUnwritten rule) { return other(value, rule.interval); }
std::string other(const Vec4&, Rule) { return kOtherVector; }
std::string other(const Vec4&, Turn) { return kOtherVector; }
std::string other(const Vec4&, Spacing) { return kOtherVector; }
std::string other(const render::Color&, Interval) { return "[0.25, 0.5, 1]"; }
std::string other(const Bivector&, TurningPlanes) { return "{ xy = 30, zw = 0.5 }"; }
std::string other(const std::vector<Bivector>&, Turns) {
    return "[{ xy = 30, zw = 0.5 }, { yz = 20 }]";
}
std::string other(const render::Color&, ColorOrUnwritten) { return "[0.25, 0.5, 1]"; }
std::string other(const std::string&, OneLine) { return "\"other\""; }
std::string other(const render::Color&, AlbedoOf) { return "[0.25, 0.5, 1]"; }
std::string other(const std::string&, BodyName) { return "\"b\""; }
std::string other(bool value, FalseOrUnwritten) { return toml_text(!value); }
std::string other(std::integral auto value, IntegerOrUnwritten) { return toml_text(value + 1); }
std::string other(bool value) { return toml_text(!value); }
std::string other(const std::string&) { return "\"other\""; }
std::string other(const std::string&, NotEmpty) { return "\"other\""; }
std::string other(const std::string&, FileName) { return "\"other\""; }
std::string other(const std::string&, const MaterialName&) { return "\"m\""; }
std::string other(const std::string&, GroupName) { return "\"other\""; }
std::string other(const std::vector<std::string>&, GroupNames) { return "[\"\"]"; }
std::string other(std::integral auto value, IntegerRange) { return toml_text(value + 1); }
std::string other(auto value, Names names) {
    return toml_text(names.names[static_cast<std::size_t>(value) == 0 ? 1 : 0]);
}
template <class T>
std::string other(const T&, const Flags<T>& flags) {
    return "[" + toml_text(flags.flags.back().name) + "]";
}
std::string other(const render::Settings&, FrameSize) { return "[64, 48]"; }
std::string other(int, PreviewWidth) { return "640"; }
std::string other(const render::Crop&, CropOf) { return "[0, 0, 3, 2]"; }
std::string other(const CameraOrbit&, OrbitTable) {
    return "{ about = [0, 1, 0, 0], plane = \"yw\", angle = 40 }";
}
std::string other(const Shape&, AnyShape) { return "\"hypercapsule\""; }
std::string other(const BodyTable&, MassOfBody) { return "3"; }
std::string other(const BodyTable&, DensityOfBody) { return "3"; }
std::string other(const std::array<std::uint32_t, 4>&, LatticeCount) { return "[1, 2, 3, 4]"; }
std::string other(const JointPlane&, PlaneOfHinge) { return "\"zw\""; }
std::string other(std::uint16_t, FreeCoordinates) { return "[\"x\", \"zw\"]"; }
std::string other(const Vec2&, LimitsOf) { return "[-1, 2]"; }
std::string other(const JointMotor&, MotorOf) { return "{ target = 1 }"; }
std::string other(const JointBreak&, BreakOf) { return "{ force = 2 }"; }
std::string other(const auto&, ForEachFree<LimitsOf>) { return "{ x = [-1, 2] }"; }
std::string other(const auto&, ForEachFree<SpringOf>) { return "{ x = { stiffness = 2 } }"; }
std::string other(const auto&, ForEachFree<MotorOf>) { return "{ x = { speed = 2 } }"; }
template <class T>
std::string other(const std::optional<T>& value, const auto& rule) {
    return other(value.value_or(T{}), rule);
}
template <class R>
std::string other(const auto& value, const Required<R>& required) {
    return other(value, required.rule);
}

/// Where a key's line stands in the canonical text, if not under its own name.
std::string written_as(const auto&...) { return ""; }
std::string written_as(const BodyTable&, DensityOfBody) { return "mass"; }

/// The line of a key in the table number `index` of those with a header.
std::string line_of(const std::string& effective, const std::string& header, int index,
                    const std::string& key) {
    std::istringstream text(effective);
    bool is_inside = false;
    for (std::string line; std::getline(text, line);) {
        if (line.starts_with('[')) is_inside = line == header && index-- == 0;
        if (is_inside && line.starts_with(key + " = ")) return line;
    }
    return {};
}

/// A table of kScene.
struct Table {
    std::string header;  ///< in the canonical text
    int index = 0;       ///< among those of its header
    /// The override that sets a key of it.
    std::function<std::string(const std::string& key, const std::string& value)> set;
    std::map<std::string, std::string> also = {};  ///< what another key's new value asks for
    std::set<std::string> lists_of_others = {};    ///< keys that are not in the table's own list
    std::string scene = kScene;
};

std::function<std::string(const std::string&, const std::string&)> set_in(const std::string& path) {
    return [=](const std::string& key, const std::string& value) {
        return fmt::format("{}.{}={}", path, key, value);
    };
}

/// In a list of one table that has the others too.
std::function<std::string(const std::string&, const std::string&)> set_in_list(
    const std::string& path, const std::map<std::string, std::string>& others) {
    return [=](const std::string& key, const std::string& value) {
        std::map<std::string, std::string> all = others;
        all[key] = value;
        std::string text;
        for (const auto& [part, v] : all)
            text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", part, v);
        return path + "=[{ " + text + " }]";
    };
}

/// A key's new value changes its line.
void expect_written(const Table& table, const std::string& key, const std::string& base,
                    const auto& value, const auto&... rule) {
    std::vector<std::string> sets = {table.set(key, other(value, rule...))};
    if (table.also.contains(key)) sets.push_back(table.also.at(key));
    const std::string alias = written_as(value, rule...);
    const std::string line = alias.empty() ? key : alias;
    const std::string changed = load_text(table.scene, sets).effective;
    EXPECT_NE(line_of(changed, table.header, table.index, line), "") << key;
    EXPECT_NE(line_of(changed, table.header, table.index, line),
              line_of(base, table.header, table.index, line))
        << sets.front();
}
/// The one key that is taken and not written.
void expect_written(const Table& table, const std::string& key, const std::string& base,
                    const std::string& value, const OnlySolver&) {
    const std::string changed = load_text(kScene, {table.set(key, toml_text(value))}).effective;
    EXPECT_EQ(changed, base);
}
/// Another type has other keys, and a table of its own here.
void expect_written(const Table&, const std::string&, const std::string&, const JointTable&,
                    const JointTypeName&) {}

/// Every key of a list changes its line of the canonical text, and every key that the loader looks
/// for is in the list.
/// @param list   called with a visitor of the list's keys
void expect_all_written(const Table& table, const auto& list) {
    std::set<std::string> listed = table.lists_of_others;
    const std::string base = load_text(table.scene).effective;
    list([&](const Key& listed_key, const auto& value, const auto&... rule) {
        const std::string key = listed_key.name;
        listed.insert(key);
        expect_written(table, key, base, value, rule...);
    });

    const std::string error = error_of(table.scene, {table.set("zzz", "1")});
    const auto at = error.find("known here:");
    ASSERT_NE(at, std::string::npos) << error;
    std::istringstream known(error.substr(at + 11));
    for (std::string key; known >> key;)
        EXPECT_TRUE(listed.contains(key)) << key << " of " << table.header << " is in no list";
}

TEST(Keys, OfTheFilmAreReadAndWritten) {
    const Scene scene = load_text(kScene);
    expect_all_written({"[scene]", 0, set_in("scene")},
                       [&](const auto& visit) { scene_keys(scene, visit); });
    expect_all_written({"[physics]", 0, set_in("physics")},
                       [&](const auto& visit) { physics_keys(*scene.physics, visit); });
    expect_all_written({"[camera]",
                        0,
                        set_in("camera"),
                        {{"closed",
                          "camera.key=[{ time = 0, position = [0, 2, -8, 0] }, { time = 1, "
                          "position = [0, 2, -8, 0] }]"}},
                        {"key"}},
                       [&](const auto& visit) {
                           camera_keys(scene.camera, visit);
                           camera_motion_keys(scene.camera_motion, visit);
                       });
    expect_all_written({"[render]", 0, set_in("render")}, [&](const auto& visit) {
        frame_keys(scene.render, visit), pixel_keys(scene.render, visit);
        ray_keys(scene.render, visit), ghost_keys(scene.render, visit);
        file_keys(scene.render, visit);
    });
    const CameraKey key;
    const auto set_in_key = [](const std::string& name, const std::string& value) {
        std::map<std::string, std::string> others = {{"time", "0"}, {"position", "[1, 1, -8, 0]"}};
        if (name == "orbit" || name == "ease")
            others = {{"time", "1"}, {"orbit", other(CameraOrbit(), OrbitTable())}};
        return set_in_list("camera.key", others)(name, value);
    };
    expect_all_written({"[[camera.key]]", 0, set_in_key},
                       [&](const auto& visit) { camera_key_keys(key, visit, {}); });
    expect_all_written({"[overlay]", 0, set_in("overlay"), {}, {"caption"}},
                       [&](const auto& visit) { overlay_keys(scene.overlay, visit); });
    const Caption caption;
    expect_all_written(
        {"[[overlay.caption]]", 0, set_in_list("overlay.caption", {{"text", "\"d\""}})},
        [&](const auto& visit) { caption_keys(caption, visit); });
}

TEST(Keys, OfMaterialsAndLightsAreReadAndWritten) {
    const Scene scene = load_text(kScene);
    expect_all_written({"[[material]]", 0, set_in("material.m")},
                       [&](const auto& visit) { material_keys(scene.materials[1], visit); });
    const LightType types[] = {LightType::kSky, LightType::kSun, LightType::kPoint,
                               LightType::kSphere};
    for (int i = 0; i < 4; ++i) {
        const LightTable light = {types[i]};
        const Table table = {"[[light]]", i, set_in(fmt::format("light.{}", i)), {}, {"type"}};
        expect_all_written(table, [&](const auto& visit) {
            light_color_keys(light, visit), light_place_keys(light, visit);
        });
    }
    const LightTable light;
    const Table sky = {"[[light]]",
                       0,
                       set_in("light.0"),
                       {{"type", "light.0.direction=[0, 1, 0, 0]"}},
                       {"color", "strength"}};
    expect_all_written(sky, [&](const auto& visit) { light_type_keys(light, visit); });
}

TEST(Keys, OfBodiesAndLatticesAreReadAndWritten) {
    const MaterialNumbers materials;
    const BodyTable body;
    const Lattice lattice;
    for (const std::string path : {"body.b", "lattice.l"}) {
        const bool is_lattice = path == "lattice.l";
        const Table table = {is_lattice ? "[[lattice]]" : "[[body]]",
                             0,
                             set_in(path),
                             {{"shape", path + ".height=1"}},
                             {"radius"}};
        expect_all_written(table, [&](const auto& visit) {
            name_keys(body, visit), shape_keys(body, visit), placing_keys(body, visit);
            mass_keys(body, visit), moving_keys(body, visit), surface_keys(body, visit, materials);
            if (is_lattice) lattice_keys(lattice, visit, kMaxBodies);
        });
    }
}

TEST(Keys, OfJointsAreReadAndWritten) {
    JointTable joint;
    for (std::size_t i = 0; i < std::size(kJointTypeNames); ++i) {
        joint.type = static_cast<JointType>(i);
        const std::string path = "joint." + std::string(kJointTypeNames[i]);
        std::map<std::string, std::string> also = {{"damping_force", path + ".stiffness=1"},
                                                   {"length", path + ".anchor_b=[0.25, 0, 0, 0]"}};
        const Table table = {"[[joint]]", static_cast<int>(i), set_in(path), std::move(also),
                             {"type"},    kJointScene};
        expect_all_written(table, [&](const auto& visit) {
            joint_keys(joint, visit);
            joint_type_keys(joint, visit), joint_end_keys(joint, visit);
        });
    }
}

}  // namespace
}  // namespace tesserae::scenes
