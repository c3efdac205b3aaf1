// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/description.hpp"
#include "render/ray.hpp"
#include "render/sampling/cap.hpp"

namespace tesserae::render {

/// What a point sees of a light: a disc of directions, and how far away it is.
struct LightDisc {
    Vec4 toward;           ///< unit
    double angle;          ///< half-angle [rad], below pi/2; 0 casts hard shadows
    Cone cone;             ///< of that half-angle
    double limit = kMiss;  ///< what is farther than this is behind the light [m]
};

/// A sun made ready: `toward` is where it stands.
struct SunDisc : LightDisc {
    Color irradiance;  ///< on a facing surface
    Color radiance;    ///< of the disc: irradiance/((4 pi/3) sin^3 angle); 0 for a hard sun
    Cap cap{};         ///< its directions, about the last axis of
    TangentFrame frame{};
    double squared_chord = 0;  ///< of the half-angle: keeps the digits of small ones
};
SunDisc sun_disc(const Sun& sun);

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
    /// The nearest sphere light that a ray meets before its limit; of equally near ones that of the
    /// lowest index.
    Seen first_sphere(const Ray& ray) const { return balls_.empty() ? Seen{} : first_ball(ray); }

  private:
    /// A ball about some of the spheres, followed by those within it: a tree, depth first.
    struct Ball {
        Vec4 centre;
        double radius;
        std::uint32_t sphere;  ///< the one that it is, or kNone
        std::uint32_t past;    ///< the ball after those within this one
    };
    void add_balls(std::span<std::uint32_t> spheres);
    Seen first_ball(const Ray& ray) const;

    std::vector<Ball> balls_;
};

}  // namespace tesserae::render
