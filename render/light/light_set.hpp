#pragma once

#include <cstdint>
#include <vector>

#include "render/light/light_disc.hpp"

namespace tesserae::render {

/// A light's disc at a point and what it brings there when nothing shades it.
struct LightAt {
    LightDisc disc;
    Color irradiance;  ///< on a surface of the given normal
};

/// The lights of a frame, positions relative to the camera. Dark ones are left out.
struct LightSet {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    LightSet(const Lights& lights, const Vec4& camera_origin);

    bool is_empty() const { return suns.empty() && points.empty() && spheres.empty(); }

    std::vector<SunDisc> suns;
    std::vector<PointLight> points;
    std::vector<SphereLight> spheres;
    Color sky;

    /// flux cos/(2 pi^2 r^3).
    static LightAt at(const PointLight& light, const Vec4& point, const Vec4& normal);
    /// Radiance times the cap's projection, also where a part of the light is below the horizon.
    /// From inside the light all directions are light, and nothing shades it.
    static LightAt at(const SphereLight& light, const Vec4& point, const Vec4& normal);

    struct Seen {
        std::uint32_t sphere = kNone;
        double distance = kMiss;
    };
    /// The nearest sphere light that a ray meets before its limit.
    Seen first_sphere(const Ray& ray) const;
};

}  // namespace tesserae::render
