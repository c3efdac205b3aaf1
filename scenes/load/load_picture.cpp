#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "scenes/load/load_parts.hpp"

namespace tesserae::scenes {
namespace {

/// Sine of the angle below which camera directions count as parallel; Camera's own bound is lower.
constexpr double kParallel = 1e-7;

constexpr Interval kUnit{0, 1};
constexpr Interval kNotNegative{0, kLargest};

render::Material load_material(TableReader& reader, EffectiveWriter& out) {
    constexpr std::string_view kKinds[] = {"diffuse", "mirror", "glass", "rough"};
    constexpr std::string_view kPatterns[] = {"none", "checker", "stripes"};
    render::Material m;
    if (reader.require("name", "expected a string") && reader.read("name", m.name) &&
        m.name.empty())
        reader.fail("name", "expected a name that is not empty");
    std::size_t kind = 0, pattern = 0;
    reader.read("kind", kind, kKinds);
    m.kind = static_cast<render::MaterialKind>(kind);
    reader.read("albedo", m.albedo, kUnit);
    reader.read("pattern", pattern, kPatterns);
    m.pattern = static_cast<render::Pattern>(pattern);
    reader.read("pattern_albedo", m.pattern_albedo, kUnit);
    reader.read("pattern_size", m.pattern_size, Rule::kPositive);
    reader.read("ior", m.ior, Interval{1, kLargest, true});
    reader.read("roughness", m.roughness, kUnit);
    reader.read("emission", m.emission, kNotNegative);
    reader.finish();

    out.table("[[material]]");
    out.key("name", m.name);
    out.key("kind", kKinds[kind]);
    out.key("albedo", m.albedo);
    out.key("pattern", kPatterns[pattern]);
    out.key("pattern_albedo", m.pattern_albedo);
    out.key("pattern_size", m.pattern_size);
    out.key("ior", m.ior);
    out.key("roughness", m.roughness);
    out.key("emission", m.emission);
    return m;
}

/// What is left of `v` orthogonal to unit vectors that are orthogonal to each other.
Vec4 orthogonal_part(const Vec4& v, const Vec4& first, const Vec4& second) {
    const Vec4 unit = stable_normalized(v);
    return unit - unit.dot(first) * first - unit.dot(second) * second;
}

void require_frame(TableReader& reader, const render::CameraDescription& c) {
    const Vec4 view = c.look_at - c.position;
    if (view.isZero(0)) {
        const char* key = reader.has("look_at") ? "look_at" : "position";
        reader.fail(key, "position and look_at must differ");
    }
    const Vec4 forward = stable_normalized(view);
    const Vec4 fourth = orthogonal_part(c.fourth, forward, Vec4::Zero());
    if (!(fourth.norm() > kParallel))
        reader.fail(
            reader.has("fourth") || !reader.has("look_at") ? "fourth" : "look_at",
            fmt::format("fourth = {} is parallel to the forward direction; expected another "
                        "direction",
                        toml_text(c.fourth)));
    if (!(orthogonal_part(c.up, forward, fourth.normalized()).norm() > kParallel))
        reader.fail(reader.has("up") || !reader.has("look_at") ? "up" : "look_at",
                    fmt::format("up = {} lies in the plane of the forward direction and fourth; "
                                "expected another direction",
                                toml_text(c.up)));
}

bool read_view(TableReader& reader, render::CameraDescription& camera) {
    bool any = reader.read("position", camera.position, Rule::kFinite);
    any |= reader.read("look_at", camera.look_at, Rule::kFinite);
    any |= reader.read("up", camera.up, Rule::kNonZero);
    any |= reader.read("fourth", camera.fourth, Rule::kNonZero);
    any |= reader.read("field_of_view", camera.field_of_view, Interval{0, 180, true, true});
    return any;
}

void check_camera_keys(TableReader& reader, const Origin& origin,
                       render::CameraDescription camera) {
    const auto keys = reader.tables("key");
    for (std::size_t i = 0; i < keys.size(); ++i) {
        TableReader key(*keys[i], origin, fmt::format("camera key {}", i));
        double time = 0;
        if (key.require("time", "expected a time in s")) key.read("time", time, Interval{});
        const bool any = read_view(key, camera);
        key.finish();
        if (!any) key.fail_here("expected position, look_at, up, fourth or field_of_view");
        key.fail_here("camera keys are not yet built");
    }
}

}  // namespace

MaterialNumbers load_materials(TableReader& root, const Origin& origin, Scene& scene,
                               EffectiveWriter& out) {
    MaterialNumbers numbers;
    scene.materials.emplace_back();
    const auto tables = root.tables("material");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        TableReader reader(*tables[i], origin, fmt::format("material {}", i));
        scene.materials.push_back(load_material(reader, out));
        const auto number = static_cast<std::uint32_t>(i + 1);
        const auto [known, is_new] = numbers.emplace(scene.materials.back().name, number);
        if (!is_new)
            reader.fail("name",
                        fmt::format("is the name of material {} already", known->second - 1));
    }
    return numbers;
}

void load_camera(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    render::CameraDescription& camera = scene.camera;
    double aperture = 0, focus_distance = 0, shutter = 0, slice_thickness = 0;
    int slices = 1;
    if (const auto* table = root.table("camera")) {
        TableReader reader(*table, origin, "[camera]");
        read_view(reader, camera);
        const auto unbuilt = [&](const char* key, double& value, Interval interval) {
            if (reader.read(key, value, interval)) require_built(reader, key, value == 0);
        };
        unbuilt("aperture", aperture, kNotNegative);
        unbuilt("focus_distance", focus_distance, kNotNegative);
        unbuilt("shutter", shutter, kUnit);
        unbuilt("slice_thickness", slice_thickness, kNotNegative);
        if (reader.read("slices", slices, 1, 1000)) require_built(reader, "slices", slices == 1);
        check_camera_keys(reader, origin, camera);
        reader.finish();
        require_frame(reader, camera);
    }
    out.table("[camera]");
    out.key("position", camera.position);
    out.key("look_at", camera.look_at);
    out.key("up", camera.up);
    out.key("fourth", camera.fourth);
    out.key("field_of_view", camera.field_of_view);
    out.key("aperture", aperture);
    out.key("focus_distance", focus_distance);
    out.key("shutter", shutter);
    out.key("slice_thickness", slice_thickness);
    out.key("slices", std::int64_t{slices});
}

namespace {

constexpr std::string_view kLightTypes[] = {"sun", "point", "sphere", "sky"};
enum LightType : std::size_t { kSun, kPoint, kSphere, kSky };

void load_light(TableReader& reader, Scene& scene, EffectiveWriter& out) {
    render::Color color = render::Color::Ones();
    double strength = 1;
    std::size_t type = kSky;
    if (reader.require("type", R"(expected "sun", "point", "sphere" or "sky")"))
        reader.read("type", type, kLightTypes);
    reader.read("color", color, kNotNegative);
    reader.read("strength", strength, kNotNegative);
    out.table("[[light]]");
    out.key("type", kLightTypes[type]);
    if (type == kSun) {
        render::Sun sun;
        if (reader.require("direction", "expected four numbers: the way that the light travels"))
            reader.read("direction", sun.direction, Rule::kNonZero);
        reader.read("angle", sun.angle, Interval{0, 30});
        out.key("direction", sun.direction);
        out.key("angle", sun.angle);
        sun.direction = stable_normalized(sun.direction);
        sun.irradiance = color * strength;
        scene.lights.suns.push_back(sun);
    } else if (type == kSky) {
        scene.lights.sky += color * strength;
    } else {
        Vec4 position = Vec4::Zero();
        double radius = 1;
        if (reader.require("position", "expected four numbers"))
            reader.read("position", position, Rule::kFinite);
        out.key("position", position);
        if (type == kPoint) {
            scene.lights.points.push_back({position, color * strength});
        } else {
            if (reader.require("radius", "expected a number > 0"))
                reader.read("radius", radius, Rule::kPositive);
            out.key("radius", radius);
            scene.lights.spheres.push_back({position, radius, color * strength});
        }
    }
    reader.finish();
    out.key("color", color);
    out.key("strength", strength);
}

}  // namespace

void load_lights(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    const auto tables = root.tables("light");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        TableReader reader(*tables[i], origin, fmt::format("light {}", i));
        load_light(reader, scene, out);
    }
    if (!tables.empty()) return;
    // A scene without lights is lit by a sky of 1.
    scene.lights.sky = render::Color::Ones();
    out.table("[[light]]");
    out.key("type", kLightTypes[kSky]);
    out.key("color", scene.lights.sky);
    out.key("strength", 1.0);
}

}  // namespace tesserae::scenes
