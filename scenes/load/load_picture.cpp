// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/error.hpp"
#include "scenes/load/load_parts.hpp"
#include "scenes/load/picture_keys.hpp"

namespace tesserae::scenes {

void load_materials(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out,
                    MaterialNumbers& numbers) {
    scene.materials.emplace_back();
    const auto tables = root.tables("material");
    ErrorList errors;
    for (std::size_t i = 0; i < tables.size(); ++i)
        errors.collect([&] {
            TableReader reader(*tables[i], origin, fmt::format("material {}", i));
            render::Material& material = scene.materials.emplace_back();
            material_keys(material, ReadKeys{reader});
            const auto number = static_cast<std::uint32_t>(i + 1);
            const auto known = numbers.emplace(material.name, number);
            if (!known.second && !material.name.empty())
                reader.collect([&] {
                    reader.fail("name", fmt::format("is the name of material {} already",
                                                    known.first->second - 1));
                });
            reader.finish();
            out.table("[[material]]");
            material_keys(material, WriteKeys{out});
        });
    numbers.is_complete = errors.is_empty();
    errors.require_none();
}

namespace {

/// Where the type is not known any type's keys may be there: it is the type that is wrong.
void know_all_places(TableReader& reader) {
    LightTable any;
    for (const LightType type : {LightType::kSun, LightType::kSphere}) {
        any.type = type;
        light_place_keys(any, [&](const Key& key, const auto&...) { reader.has(key.name); });
    }
}

void add_light(const LightTable& light, render::Lights& lights) {
    const render::Color color = light.color * light.strength;
    switch (light.type) {
        case LightType::kSun:
            lights.suns.push_back({stable_normalized(light.direction), color, light.angle});
            break;
        case LightType::kPoint:
            lights.points.push_back({light.position, color});
            break;
        case LightType::kSphere:
            lights.spheres.push_back({light.position, light.radius, color});
            break;
        case LightType::kSky:
            lights.sky += color;
            break;
    }
}

}  // namespace

void load_lights(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    std::vector<LightTable> lights;
    ErrorList errors;
    for (const auto* table : root.tables("light"))
        errors.collect([&] {
            TableReader reader(*table, origin, fmt::format("light {}", lights.size()));
            const ReadKeys read{reader};
            LightTable& light = lights.emplace_back();
            light_type_keys(light, read);
            if (reader.has("type") && !reader.has_errors())
                light_place_keys(light, read);
            else
                know_all_places(reader);
            light_color_keys(light, read);
            reader.finish();
        });
    errors.require_none();
    // A scene without lights is lit by a sky of 1.
    if (lights.empty()) lights.emplace_back();
    const WriteKeys write{out};
    for (const LightTable& l : lights) {
        out.table("[[light]]");
        light_type_keys(l, write), light_place_keys(l, write), light_color_keys(l, write);
        add_light(l, scene.lights);
    }
}

void load_render(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    render::Settings& s = scene.render;
    if (const auto* table = root.table("render")) {
        TableReader reader(*table, origin, "[render]");
        const ReadKeys read{reader};
        s.max_samples = 1;
        scene.gives_ghost_depth = reader.has("ghost_depth");
        frame_keys(s, read), pixel_keys(s, read), ray_keys(s, read), ghost_keys(s, read);
        file_keys(s, read);
        // At least `samples`, so that --samples alone can ask for more than the scene's most.
        s.max_samples = std::max(s.samples, s.max_samples);
        reader.finish();
    }
    const WriteKeys write{out};
    out.table("[render]");
    frame_keys(s, write), ray_keys(s, write), pixel_keys(s, write), ghost_keys(s, write);
    file_keys(s, write);
}

}  // namespace tesserae::scenes
