// SPDX-License-Identifier: Apache-2.0
#include "scenes/view/page_scene.hpp"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "render/tint.hpp"
#include "scenes/load/picture_keys.hpp"
#include "scenes/process/base64.hpp"

namespace tesserae::scenes {
namespace {

using Json = nlohmann::ordered_json;

Json json_list(const Vec4& v) { return {v[0], v[1], v[2], v[3]}; }
Json json_list(const render::Color& c) { return {c[0], c[1], c[2]}; }
Json json_list(const std::array<render::Color, 2>& c) { return {json_list(c[0]), json_list(c[1])}; }

/// Hulls take most of the room that shapes take: equal shapes share one.
class Hulls {
  public:
    std::size_t number_of(const HullShape& shape) {
        const auto [at, is_new] = number_.try_emplace(shape.body.get(), hulls_.size());
        if (is_new) hulls_.push_back(described(shape.body->hull));
        return at->second;
    }
    Json take() { return std::move(hulls_); }

  private:
    static Json described(const Hull& hull) {
        Json planes = Json::array(), vertices = Json::array();
        for (const HullCell& cell : hull.cells) {
            planes.push_back(json_list(cell.plane.normal));
            planes.back().push_back(cell.plane.offset);
        }
        for (const Vec4& vertex : hull.vertices) vertices.push_back(json_list(vertex));
        return {{"planes", std::move(planes)}, {"vertices", std::move(vertices)}};
    }

    std::map<const HullBody*, std::size_t> number_;  // asked only, never walked through
    Json hulls_ = Json::array();
};

Json form_of(const Hypersphere& s, Hulls&) { return {{"kind", "sphere"}, {"radius", s.radius}}; }
Json form_of(const Hypercapsule& s, Hulls&) {
    return {{"kind", "capsule"}, {"radius", s.radius}, {"half", 0.5 * s.height}};
}
Json form_of(const Hyperbox& s, Hulls&) {
    return {{"kind", "box"}, {"half", json_list(Vec4(0.5 * s.size))}};
}
Json form_of(const Hyperplane& s, Hulls&) {
    return {{"kind", "plane"}, {"normal", json_list(s.normal)}, {"offset", s.offset}};
}
Json form_of(const HullShape& s, Hulls& hulls) {
    return {{"kind", "hull"}, {"hull", hulls.number_of(s)}};
}
Json form_of(const BallProduct& s, Hulls&) {
    Json axes = Json::array(), radii = Json::array();
    for (const BallFactor& factor : s) {
        axes.push_back(json_list(factor.axes));
        radii.push_back(factor.radius);
    }
    return {{"kind", "product"}, {"axes", std::move(axes)}, {"radii", std::move(radii)}};
}

Json types_of(const Scene& scene, Hulls& hulls) {
    Json types = Json::array();
    for (std::size_t i = 0; i < scene.bodies.types.size(); ++i) {
        const Shape& shape = scene.bodies.types[i].shape;
        Json type = std::visit([&](const auto& s) { return form_of(s, hulls); }, shape);
        type["shape"] = name_of(shape);
        if (is_bounded(shape)) type["bound"] = bounding_radius(shape);
        type["material"] = scene.appearance[i].material;
        types.push_back(std::move(type));
    }
    return types;
}

Json materials_of(const Scene& scene) {
    Json materials = Json::array();
    for (const render::Material& m : scene.materials)
        materials.push_back({{"name", m.name},
                             {"kind", kMaterialKinds[static_cast<std::size_t>(m.kind)]},
                             {"albedo", json_list(m.albedo)},
                             {"pattern", kPatterns[static_cast<std::size_t>(m.pattern)]},
                             {"pattern_albedo", json_list(m.pattern_albedo)},
                             {"pattern_size", m.pattern_size},
                             {"line_width", m.line_width},
                             {"w_of", kWOf[static_cast<std::size_t>(m.w_of)]},
                             {"emission", json_list(m.emission)}});
    return materials;
}

/// What bodies' albedos are multiplied by and how far their hues are turned, in 256ths of the
/// colour circle, four bytes a body: what a screen tells apart. Empty where no body differs.
std::string tints_of(const Scene& scene) {
    std::string bytes;
    const auto add = [&](double value) {
        bytes += static_cast<char>(static_cast<unsigned char>(std::lround(value) & 0xff));
    };
    bool any = false;
    for (BodyId id = 0; id < scene.bodies.size(); ++id) {
        const render::Appearance& look = scene.appearance[scene.bodies.type[id]];
        const double variation = scene.materials[look.material].albedo_variation;
        any = any || variation > 0 || look.hue_jitter > 0;
        const render::Color tint = render::tint_of(id, variation);
        for (int i = 0; i < 3; ++i) add(255 * tint[i]);
        add(256 * render::hue_turn_of(id, look.hue_jitter));
    }
    return any ? bytes : std::string();
}

Json lights_of(const render::Lights& lights) {
    Json suns = Json::array(), lamps = Json::array();
    for (const render::Sun& sun : lights.suns)
        if ((sun.irradiance > 0).any())
            suns.push_back({{"toward", json_list(Vec4(-sun.direction))},
                            {"irradiance", json_list(sun.irradiance)}});
    for (const render::PointLight& l : lights.points)
        lamps.push_back(
            {{"position", json_list(l.position)}, {"radius", 0}, {"power", json_list(l.flux)}});
    for (const render::SphereLight& l : lights.spheres)
        lamps.push_back({{"position", json_list(l.position)},
                         {"radius", l.radius},
                         {"power", json_list(l.radiance)}});
    return {{"suns", std::move(suns)}, {"lamps", std::move(lamps)}, {"sky", json_list(lights.sky)}};
}

Json joints_of(const Scene& scene, const std::vector<PageJoint>& joints) {
    Json names = Json::array();
    for (const PageJoint& joint : joints) names.push_back(scene.joint_names[joint.number]);
    return {{"names", std::move(names)}, {"data", base64(joint_bytes(joints))}};
}

Json cameras_of(const std::vector<ViewMoment>& moments) {
    Json cameras = Json::array();
    const auto add = [&](const render::CameraDescription& c) {
        cameras.push_back({{"position", json_list(c.position)},
                           {"look_at", json_list(c.look_at)},
                           {"up", json_list(c.up)},
                           {"fourth", json_list(c.fourth)},
                           {"field_of_view", c.field_of_view}});
    };
    for (const ViewMoment& moment : moments) add(moment.camera);
    return cameras;
}

}  // namespace

std::string page_scene(const Scene& scene, const std::vector<ViewMoment>& moments,
                       std::optional<double> near_slice, const std::vector<PageJoint>& joints) {
    Hulls hulls;
    Json json = {{"name", scene.name}, {"bodies", scene.bodies.size()}};
    if (near_slice) json["near_slice"] = *near_slice;
    json["frames_per_second"] = scene.render.frames_per_second;
    json["size"] = {scene.render.width, scene.render.height};
    json["exposure"] = scene.render.exposure;
    json["max_distance"] = scene.render.max_distance;
    json["ghost_depth"] = scene.render.ghost_depth;
    json["ghosts_over"] = scene.render.ghosts == render::GhostsIn::kOver;
    json["ghost_colors"] = json_list(scene.render.ghost_colors);
    json["side_colors"] = json_list(render::kSideColors);
    json["times"] = Json::array();
    for (const ViewMoment& moment : moments) json["times"].push_back(moment.time);
    // A camera that stands still is there once.
    json["cameras"] =
        cameras_of(scene.has_moving_camera() ? moments : std::vector{moments.front()});
    json["key_times"] = Json::array();
    for (const CameraKey& key : scene.camera_keys) json["key_times"].push_back(key.time);
    json["names"] = Json::array();
    for (const NamedBodies& named : scene.names)
        json["names"].push_back({named.name, named.first, named.count, named.is_lattice});
    json["types"] = types_of(scene, hulls);
    json["hulls"] = hulls.take();
    json["materials"] = materials_of(scene);
    if (const std::string tints = tints_of(scene); !tints.empty()) json["tints"] = base64(tints);
    json["lights"] = lights_of(scene.lights);
    if (!joints.empty()) json["joints"] = joints_of(scene, joints);

    // Names need not be UTF-8 where a file is damaged; ASCII only; no tag can begin.
    std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;)
        text.replace(at, 1, "\\u003c");
    return text;
}

}  // namespace tesserae::scenes
