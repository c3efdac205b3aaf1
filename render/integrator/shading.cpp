// SPDX-License-Identifier: Apache-2.0
#include "render/integrator/shading.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/material/pattern.hpp"
#include "render/picture_needs.hpp"
#include "render/tint.hpp"

namespace tesserae::render {
namespace {

/// Lights are left out that add less than this part of a surface's light, all together.
constexpr double kLeftOut = 1e-4;

}  // namespace

Shading::Shading(const Picture& picture, const PlacedBodies& placed, const BodyTree& tree,
                 const LightSet& lights, const RoughReflections& rough)
    : picture_(picture), placed_(placed), lights_(lights), rough_(rough) {
    if (needs_of(picture).shadow_rays) shadows_.emplace(placed, tree, picture.settings.ray_limit());
}

void Shading::find_surface(const Hit& hit, const Ray& ray, Surface& s) const {
    const PlacedBody& body = placed_.bodies[hit.body];
    s.distance = hit.distance;
    s.body = hit.body;
    s.point = ray.at(hit.distance);
    const Vec4 local = placed_.point_to_body(body, s.point, ray.time);
    const Vec4 out = surface_normal(*body.shape, local);
    const std::uint32_t type = picture_.bodies.type[body.id];
    const Material& material = picture_.materials[picture_.appearance[type].material];
    s.normal = placed_.direction_to_world(body, out, ray.time);
    s.material = &material;
    s.rough = rough_.of(material);
    s.time = ray.time;
    if (material.pattern == Pattern::kNone) {
        s.albedo = material.albedo;
    } else {
        const double origin = picture_.camera.position[3];
        const double centre =
            body.moves() ? placed_.pose(body, ray.time).centre[3] : body.centre[3];
        s.albedo = pattern_albedo(material,
                                  {*body.shape, local, out, origin + s.point[3], origin + centre});
    }
    const double jitter = picture_.appearance[type].hue_jitter;
    if (jitter > 0) s.albedo = turned_hue(s.albedo, hue_turn_of(body.id, jitter));
    if (material.albedo_variation > 0) s.albedo *= tint_of(body.id, material.albedo_variation);
}

Color Shading::radiance(const Surface& s, const Vec4& out, FrameStats& stats) const {
    const Bsdf bsdf(s, out);
    Color sum = s.material->emission + s.albedo * lights_.sky;
    for (const SunDisc& sun : lights_.suns)
        sum += reflected(s, bsdf, sun, s.normal.dot(sun.toward) * sun.irradiance, stats);
    add_lamps(s, bsdf, sum, stats);
    return sum;
}

/// Adds point and sphere lights, the brightest first, until all that are left could not add a ten
/// thousandth.
void Shading::add_lamps(const Surface& s, const Bsdf& bsdf, Color& sum, FrameStats& stats) const {
    struct Unshaded {
        LightDisc disc;
        Color radiance;
        double brightest;
        std::size_t number;
    };
    thread_local std::vector<Unshaded> lamps;  // keeps its memory: this is asked at every sample
    lamps.clear();
    Color left = Color::Zero();
    const auto gather = [&](const auto& lights) {
        for (const auto& light : lights) {
            const LightAt at = LightSet::at(light, s.point, s.normal);
            if (!(at.irradiance > 0).any()) continue;
            const Color radiance = bsdf.value(at.disc.toward) * at.irradiance;
            const double most = radiance.maxCoeff();  // no number where infinity meets black
            lamps.push_back({at.disc, radiance, most >= 0 ? most : kMiss, lamps.size()});
            left += radiance;
        }
    };
    gather(lights_.points);
    gather(lights_.spheres);
    std::sort(lamps.begin(), lamps.end(), [](const Unshaded& a, const Unshaded& b) {
        return a.brightest != b.brightest ? a.brightest > b.brightest : a.number < b.number;
    });
    for (const Unshaded& lamp : lamps) {
        if ((left <= kLeftOut * sum).all()) return;
        sum += shadows_->visibility(lamp.disc, s.point, s.body, stats, s.time) * lamp.radiance;
        left -= lamp.radiance;
    }
}

Color Shading::reflected(const Surface& s, const Bsdf& bsdf, const LightDisc& light,
                         const Color& irradiance, FrameStats& stats) const {
    if (!(irradiance > 0).any()) return Color::Zero();
    const double visible = shadows_->visibility(light, s.point, s.body, stats, s.time);
    return visible * bsdf.value(light.toward) * irradiance;
}

}  // namespace tesserae::render
