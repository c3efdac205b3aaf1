// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Imath/half.h>

#include <optional>

#include "render/camera/camera_rays.hpp"
#include "render/material/surface.hpp"
#include "render/picture.hpp"

namespace tesserae::render {

/// What a pixel has beside Pixel, in the types of the image file: kept where a channel of it is
/// asked for.
struct LayerPixel {
    float plane_depth;        ///< along the camera's forward axis [m]; infinite without a body
    float slice_normal[3];    ///< right, up, forward; unit, or 0: see CentreLayers
    float forward[2];         ///< u, v to where the point is in the next frame [pixels]
    float backward[2];        ///< and was in the last one
    Imath::half direct[3];    ///< radiance, see LightPath::direct
    Imath::half indirect[3];  ///< what the colour has beyond that
    Imath::half ghost[4];     ///< see GhostLight
};

/// From one frame to where what it shows is in another.
class FrameMotion {
  public:
    /// @param camera   of a cell, of the frame itself; `picture` and it must outlive this
    /// @throws InputError   as Camera, for the neighbour's
    FrameMotion(const Picture& picture, const Camera& camera, const SliceSheet& sheet,
                const Neighbour& neighbour);

    /// The way [pixels; right, up] over the film of the material point that a view ray meets: the
    /// body carries it along, and the other frame's camera sees it along its own fourth axis,
    /// wherever on that axis it then is. So it is how the body's matter goes, not how the cut
    /// through the body swells. Where a ray meets no body it is the way of a point at infinity.
    /// Zero where the other camera has the point beside or behind it, or too far off the film for a
    /// float.
    /// @param direction   of the view ray, world axes
    /// @param surface     what it meets; null if nothing
    /// @param body        whose surface it is
    Vec2 way(const Vec4& direction, const Surface* surface, BodyId body) const;

  private:
    Vec4 moved(const Vec4& point, BodyId body) const;

    const Picture& picture_;
    const Camera& camera_;
    const Neighbour& neighbour_;
    Camera other_;
};

/// The layers of the view ray through a pixel's centre.
class CentreLayers {
  public:
    /// @param camera   of a cell; all must outlive this
    CentreLayers(const Picture& picture, const Camera& camera, const SliceSheet& sheet);

    /// The values of a pixel that shows nothing.
    static LayerPixel empty();
    /// All but the light. The normal's part in the slice is no direction where the surface is
    /// parallel to the slice: zero.
    /// @param surface   as in FrameMotion::way
    void store(const Ray& ray, const Surface* surface, BodyId body, LayerPixel& pixel) const;

  private:
    const Camera& camera_;
    std::optional<FrameMotion> next_, last_;  ///< where they are asked for and known
};

}  // namespace tesserae::render
