#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/frame.hpp"
#include "render/slice.hpp"

namespace tesserae::render {

/// How far a ray travels before it enters a body.
/// @param origin      relative to the camera, world axes [m]
/// @param direction   unit, world axes
/// @return distance >= 0 [m], 0 if the origin lies in the body; kMiss if it is missed or farther
///         than `limit`
/// A pure function of ray and body. kAnalytic is the room's closed form. kTrace is sphere tracing
/// in the body's frame from where the ray enters the body's bounding sphere: see `trace`.
double hit_distance(const PlacedBodies& placed, std::uint32_t body, const Vec4& origin,
                    const Vec4& direction, double limit, const Settings& settings,
                    FrameStats& stats);

/// A body that the view rays of a tile can meet.
struct Candidate {
    Vec3 centre;              ///< of the slice's bounding sphere, camera coordinates [m]
    double distance_squared;  ///< from the camera
    double radius_squared;
    double nearest;  ///< lower bound of the hit distance [m]
    std::uint32_t body;
};

struct Hit {
    double distance = kMiss;
    std::uint32_t body = ~std::uint32_t{0};  ///< index into PlacedBodies::bodies

    explicit operator bool() const { return distance < kMiss; }
};

/// The candidates of a tile's list, in its order.
std::vector<Candidate> candidates_of(std::span<const SliceBounds> slice,
                                     std::span<const std::uint32_t> list);

/// The nearest body that a view ray meets; equal distances go to the lower id.
/// @param candidates   ascending by `nearest`
/// @param view         unit direction in camera coordinates
/// @param world        the same direction in world axes
Hit nearest_hit(const PlacedBodies& placed, std::span<const Candidate> candidates, const Vec3& view,
                const Vec4& world, const Settings& settings, FrameStats& stats);

}  // namespace tesserae::render
