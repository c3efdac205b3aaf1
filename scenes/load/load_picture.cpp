#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "scenes/load/load_parts.hpp"

namespace tesserae::scenes {
namespace {

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
