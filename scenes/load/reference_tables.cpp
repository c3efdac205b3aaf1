// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/reference_tables.hpp"

#include <type_traits>
#include <variant>

#include "scenes/load/body_keys.hpp"
#include "scenes/load/joint_keys.hpp"
#include "scenes/load/overlay_keys.hpp"
#include "scenes/load/picture_keys.hpp"

namespace tesserae::scenes {
namespace {

// What a value's type is called.
std::string type_name(bool) { return "boolean"; }
std::string type_name(std::integral auto) { return "integer"; }
std::string type_name(double) { return "real"; }
std::string type_name(const std::string&) { return "string"; }
std::string type_name(const Vec4&) { return "4 reals"; }
std::string type_name(const Vec2&) { return "2 reals"; }
std::string type_name(const render::Color&) { return "3 reals"; }
std::string type_name(const Bivector&) { return "planes"; }
std::string type_name(const std::array<std::int64_t, 2>&) { return "2 integers"; }
std::string type_name(const std::vector<Vec4>&) { return "points"; }
std::string type_name(RegularPolychoron) { return "string"; }

std::string quoted(std::string_view name) { return fmt::format("`\"{}\"`", name); }

// What a rule allows.
std::string allowed_by(Interval i) {
    const bool low = i.low > -kLargest, high = i.high < kLargest;
    if (low && high && !i.low_open && !i.high_open)
        return fmt::format("{} to {}", toml_text(i.low), toml_text(i.high));
    std::string text;
    if (low && i.low == kSmallest)
        text = "> 0";
    else if (low)
        text = fmt::format("{} {}", i.low_open ? ">" : ">=", toml_text(i.low));
    if (high)
        text +=
            fmt::format("{}{} {}", low ? ", " : "", i.high_open ? "<" : "<=", toml_text(i.high));
    return text;
}
std::string allowed_by(IntegerRange range) {
    return range.high == IntegerRange{}.high ? fmt::format(">= {}", range.low)
                                             : fmt::format("{} to {}", range.low, range.high);
}
std::string allowed_by(Rule rule) {
    if (rule == Rule::kNonZero) return "not zero";
    if (rule == Rule::kSides) return ">= 3";
    return allowed_by(interval_of(rule));
}
template <class R>
std::string allowed_by(const R& rule) {
    std::string text;
    if constexpr (requires { R::kAllowed; }) {
        text = R::kAllowed;
    } else if constexpr (requires { rule.names; }) {
        for (std::string_view name : rule.names) text += (text.empty() ? "" : ", ") + quoted(name);
    } else if constexpr (requires { rule.flags; }) {
        for (const auto& flag : rule.flags) text += (text.empty() ? "" : ", ") + quoted(flag.name);
    } else if constexpr (requires { rule.interval; }) {
        text = allowed_by(rule.interval);
    } else if constexpr (requires { rule.range; }) {
        text = allowed_by(rule.range);
    } else {
        text = allowed_by(rule.rule);
    }
    return text;
}

template <class R>
std::string type_by(const R& rule, const auto& value) {
    if constexpr (requires { R::kType; })
        return R::kType;
    else if constexpr (requires { rule.names; })
        return "string";
    else if constexpr (requires { rule.flags; })
        return "strings";
    else if constexpr (requires { rule.rule; })
        return type_by(rule.rule, value);
    else
        return type_name(value);
}

/// A value as scene files have it.
std::string value_text(const Key& key, const auto& value, const auto& rule) {
    EffectiveWriter out;
    WriteKeys{out}(key, value, rule);
    const std::string& line = out.text();
    // Not written at its default.
    if (line.empty()) {
        if constexpr (requires { rule.names; })
            return toml_text(rule.names[static_cast<std::size_t>(value)]);
        else if constexpr (requires { toml_text(value); })
            return toml_text(value);
    }
    const auto begin = line.find(" = ") + 3;
    return line.substr(begin, line.find('\n') - begin);
}

/// Makes a row of each key of a list; the values are the defaults.
struct DescribeKeys {
    std::vector<ReferenceRow>& rows;

    void operator()(const Key& key, const auto& value) const { (*this)(key, value, Any{}); }
    template <class T, class R>
    void operator()(const Key& key, const T& value, const R& rule) const {
        std::string otherwise = "required";
        if (key.otherwise != nullptr)
            otherwise = key.otherwise;
        else if constexpr (!requires { rule.expected; })
            otherwise = "`" + value_text(key, value, rule) + "`";
        rows.push_back(
            {key.name, type_by(rule, value), key.unit, otherwise, allowed_by(rule), key.meaning});
    }
    template <class T>
    void operator()(const Key& key, const std::optional<T>&, const auto& rule) const {
        (*this)(key, T(), rule);
    }

  private:
    struct Any {
        static constexpr const char* kAllowed = "";
        void write(EffectiveWriter& out, const char* key, const auto& value) const {
            out.key(key, value);
        }
    };
};

/// The rows of some lists of keys: `part` calls them with a DescribeKeys.
std::vector<ReferenceRow> rows_of(const auto& part) {
    std::vector<ReferenceRow> rows;
    part(DescribeKeys{rows});
    return rows;
}

/// A part of a table; `keys` visits lists of keys with a DescribeKeys.
ReferencePart part_of(std::string heading, const auto& keys) {
    ReferencePart part{std::move(heading), {}};
    keys(DescribeKeys{part.rows});
    return part;
}

template <class S>
void add_sizes(const S& shape, std::vector<ReferenceRow>& rows) {
    shape.parameters(shape, [&](const Key& key, const auto& value, Rule rule) {
        rows.push_back({key.name, type_name(value), key.unit,
                        rule == Rule::kFinite ? "`0.0`" : "required", allowed_by(rule),
                        key.meaning});
    });
}
/// Points, or a regular one's name and radius.
void add_sizes(Polychoron shape, std::vector<ReferenceRow>& rows) {
    for (const auto which : {RegularPolychoron::kNone, RegularPolychoron::k8Cell}) {
        shape.regular = which;
        shape.parameters(shape, [&](const Key& key, const auto& value, Rule rule) {
            rows.push_back({key.name, type_name(value), key.unit,
                            which == RegularPolychoron::kNone ? "or a regular one" : "or vertices",
                            allowed_by(rule), key.meaning});
        });
    }
    for (ReferenceRow& row : rows)
        if (row.key == "regular")
            for (std::string_view name : kRegularNames)
                row.allowed += (row.allowed.empty() ? "" : ", ") + quoted(name);
}

template <std::size_t... I>
void add_shapes(std::vector<ReferencePart>& parts, std::index_sequence<I...>) {
    const auto add = [&]<class S>(const S& shape) {
        parts.push_back({fmt::format("shape = \"{}\"", S::kName), {}});
        add_sizes(shape, parts.back().rows);
    };
    (add(std::variant_alternative_t<I, Shape>()), ...);
}

ReferenceTable body_table() {
    const BodyTable body;
    ReferenceTable table{
        "body",
        "[[body]]",
        "A body, with the sizes of its shape. A hyperplane never moves: it takes no "
        "position, rotation, "
        "velocity or mass.",
        {}};
    table.parts.push_back(part_of("", [&](const DescribeKeys& visit) {
        name_keys(body, visit), shape_keys(body, visit), placing_keys(body, visit);
        mass_keys(body, visit), moving_keys(body, visit),
            surface_keys(body, visit, MaterialNumbers());
    }));
    add_shapes(table.parts, std::make_index_sequence<std::variant_size_v<Shape>>());
    return table;
}

ReferenceTable joint_table() {
    JointTable joint;
    ReferenceTable table{
        "joint",
        "[[joint]]",
        "A joint between two bodies, or a body and the world. Points and directions are "
        "the world's at time 0; the joint holds the bodies as they are placed then.",
        {}};
    table.parts.push_back(part_of("", [&](const DescribeKeys& visit) {
        joint_keys(joint, visit), joint_end_keys(joint, visit);
    }));
    for (std::size_t i = 0; i < std::size(kJointTypeNames); ++i) {
        joint.type = static_cast<JointType>(i);
        table.parts.push_back(
            part_of(fmt::format("type = \"{}\"", kJointTypeNames[i]),
                    [&](const DescribeKeys& visit) { joint_type_keys(joint, visit); }));
    }
    const JointSpring spring;
    const JointMotor motor;
    const JointBreak breaks;
    using Visit = const DescribeKeys&;
    table.parts.push_back(
        part_of("spring = { x = { ... } }", [&](Visit visit) { spring_keys(spring, visit); }));
    table.parts.push_back(
        part_of("motor = { ... }", [&](Visit visit) { motor_keys(motor, visit, kTurning); }));
    table.parts.push_back(
        part_of("break = { ... }", [&](Visit visit) { break_keys(breaks, visit); }));
    return table;
}

ReferenceTable light_table() {
    ReferenceTable table{"light", "[[light]]", "A light; a scene without any has a sky of 1.", {}};
    LightTable light;
    table.parts.push_back(part_of("", [&](const DescribeKeys& visit) {
        light_type_keys(light, visit), light_color_keys(light, visit);
    }));
    for (const auto type : {LightType::kSun, LightType::kPoint, LightType::kSphere}) {
        light.type = type;
        table.parts.push_back(
            part_of(fmt::format("type = \"{}\"", kLightTypes[static_cast<std::size_t>(type)]),
                    [&](const DescribeKeys& visit) { light_place_keys(light, visit); }));
    }
    return table;
}

}  // namespace

std::vector<ReferenceTable> all_reference_tables() {
    struct {
        std::string name;
    } const scene;
    const PhysicsSettings physics;
    const render::Material material;
    const Lattice lattice;
    const render::CameraDescription camera;
    const CameraKey key;
    const CameraOrbit orbit;
    const CameraMotion motion;
    const render::Settings settings;
    const Overlay overlay;
    const Caption caption;
    using Visit = const DescribeKeys&;
    return {
        {"scene",
         "[scene]",
         "What the scene is called.",
         {part_of("", [&](Visit visit) { scene_keys(scene, visit); })}},
        {"physics",
         "[physics]",
         "How bodies move; without this table the scene is a still.",
         {part_of("", [&](Visit visit) { physics_keys(physics, visit); })}},
        {"material",
         "[[material]]",
         "How the bodies that name it look.",
         {part_of("", [&](Visit visit) { material_keys(material, visit); })}},
        body_table(),
        {"lattice",
         "[[lattice]]",
         "A grid of equal bodies: all keys of a body but a hyperplane, whose position is the "
         "grid's centre, and "
         "these.",
         {part_of("", [&](Visit visit) { lattice_keys(lattice, visit, kMaxBodies); })}},
        joint_table(),
        {"camera",
         "[camera]",
         "Where the camera is and what slice it sees.",
         {part_of(
             "",
             [&](Visit visit) { camera_keys(camera, visit), camera_motion_keys(motion, visit); })}},
        {"camera.key",
         "[[camera.key]]",
         "What the camera is like at a time; it moves smoothly from key to key. Each has at least "
         "one key beside its time.",
         {part_of("", [&](Visit visit) { camera_key_keys(key, visit, {}); }),
          part_of("orbit = { ... }", [&](Visit visit) { orbit_keys(orbit, visit); })}},
        light_table(),
        {"render",
         "[render]",
         "The frames: size, samples, how light is found, what files hold.",
         {part_of("",
                  [&](Visit visit) {
                      frame_keys(settings, visit), pixel_keys(settings, visit);
                      ray_keys(settings, visit), ghost_keys(settings, visit);
                      file_keys(settings, visit);
                  })}},
        {"overlay",
         "[overlay]",
         "What is written over previews and films; the EXR files stay as they are.",
         {part_of("", [&](Visit visit) { overlay_keys(overlay, visit); })}},
        {"overlay.caption",
         "[[overlay.caption]]",
         "A line of text that is shown for some time.",
         {part_of("", [&](Visit visit) { caption_keys(caption, visit); })}},
    };
}

}  // namespace tesserae::scenes
