#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/body_tree.hpp"
#include "render/frame.hpp"

namespace tesserae::render {

/// A sun made ready: `toward` is where it stands.
struct SunDisc {
    Vec4 toward;       ///< unit
    Color irradiance;  ///< on a facing surface
    double angle;      ///< half-angle [rad]; 0 casts hard shadows
    Cone cone;         ///< of that half-angle
};
SunDisc sun_disc(const Sun& sun);

/// The sine of the angle by which a ray misses a body: between the ray's direction and the nearest
/// direction from `origin` that touches the body, negative when the ray enters it, -1 from inside,
/// 1 where the body lies behind. It is the least f(t)/t over t > 0, f(t) being the body's signed
/// distance along the ray, and exact for every convex body the ray misses (for a hypersphere it is
/// sin(theta - alpha) on both sides; FORMULAS 7).
/// @param cone   which values matter: the result has the right value within +-cone.sine (to 1e-6 of
///               it), and beyond only the right side of it. With angle 0 only the sign matters
double rim_sine(const PlacedBodies& placed, std::uint32_t body, const Vec4& origin,
                const Vec4& direction, const Cone& cone, FrameStats& stats);

/// The part of a sun's disc that lies beyond a flat rim at angle x * half-angle from its middle,
/// x in [-1, 1] (0 hidden, 1 clear). The disc is a 3-ball of directions, and a plane cuts
/// (2 + 3x - x^3)/4 of a ball off, which is smoothstep((1 + x)/2).
double visible_part(double x);

/// How much of a sun reaches a point: 0 to 1. The rim of the body that covers most of the sun
/// decides, as in a distance field of the whole scene; the rim counts as flat, and a small disc of
/// directions as a Euclidean ball. A hard sun is hidden or not.
class Shadows {
  public:
    /// @param placed   must outlive it
    explicit Shadows(const PlacedBodies& placed);

    /// @param point   relative to the camera, world axes, on the surface of body `on`. A convex
    /// body
    ///                never shades its own lit side, so that body is left out and no ray needs to
    ///                be moved off its surface.
    double visibility(const SunDisc& sun, const Vec4& point, std::uint32_t on,
                      FrameStats& stats) const;

  private:
    bool is_hidden(const SunDisc& sun, const Vec4& point, std::uint32_t on,
                   FrameStats& stats) const;

    const PlacedBodies& placed_;
    BodyTree tree_;
    std::vector<std::uint32_t> unbounded_;
};

}  // namespace tesserae::render
