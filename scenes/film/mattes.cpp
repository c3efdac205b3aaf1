// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/mattes.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/file/file_writer.hpp"

namespace tesserae::scenes {
namespace {

/// A header is read whole by every viewer.
constexpr std::size_t kMostInHeader = 10'000;

/// @param folder, file   of the manifest where the header is too small for it
render::MatteNames manifest_of(const nlohmann::json& names, const std::filesystem::path& folder,
                               const std::string& file) {
    if (names.size() <= kMostInHeader || folder.empty()) return {names.dump(), false};
    write_file(folder / file, names.dump(0));
    return {file, true};
}

std::string in_hex(std::uint32_t id) { return fmt::format("{:08x}", id); }

}  // namespace

render::Mattes mattes_of(const Scene& scene, const std::filesystem::path& folder) {
    render::Mattes mattes;
    for (const render::Material& material : scene.materials)
        mattes.materials.push_back(
            render::matte_id(material.name.empty() ? "default" : material.name));
    mattes.objects.resize(scene.bodies.size());

    auto objects = nlohmann::json::object(), materials = objects;
    const auto add = [&](BodyId id, const std::string& name) {
        const render::Appearance& look = scene.appearance[scene.bodies.type[id]];
        mattes.objects[id] = render::matte_id(name);
        if (!look.visible) return;
        objects[name] = in_hex(mattes.objects[id]);
        const std::string& material = scene.materials[look.material].name;
        materials[material.empty() ? "default" : material] =
            in_hex(mattes.materials[look.material]);
    };
    for (const NamedBodies& bodies : scene.names)
        if (bodies.is_lattice)
            for (std::uint32_t i = 0; i < bodies.count; ++i)
                add(bodies.first + i, fmt::format("{}.{}", bodies.name, i));
        else
            add(bodies.first, bodies.name);
    mattes.object_names = manifest_of(objects, folder, scene.name + ".CryptoObject.json");
    mattes.material_names = manifest_of(materials, folder, scene.name + ".CryptoMaterial.json");
    return mattes;
}

}  // namespace tesserae::scenes
