// SPDX-License-Identifier: Apache-2.0
#include "render/scene/film_list.hpp"

namespace tesserae::render {

void FilmList::fill(std::span<const SliceBounds> slice, std::span<const std::uint32_t> list,
                    const Crop& window) {
    candidates_.clear();
    for (const std::uint32_t i : list) {
        const SliceBounds& s = slice[i];
        if (s.x0 > window.x1 || s.x1 < window.x0 || s.y0 > window.y1 || s.y1 < window.y0) continue;
        candidates_.push_back(
            {s.centre, s.centre.squaredNorm(), s.radius * s.radius, s.nearest, s.body});
    }
}

Hit FilmList::nearest(const PlacedBodies& placed, const Vec3& view, Ray ray,
                      const Settings& settings, FrameStats& stats) const {
    Hit hit;
    for (const Candidate& c : candidates_) {
        if (c.nearest > ray.limit) break;
        const double middle = c.centre.dot(view);
        const double off = c.distance_squared - middle * middle;
        if (off > c.radius_squared) continue;
        if (middle < 0 && c.distance_squared > c.radius_squared) continue;
        const double past = middle - ray.limit;
        if (past > 0 && past * past > c.radius_squared - off) continue;
        if (hit.take(c.body, hit_distance(placed, c.body, ray, settings, stats)))
            ray.limit = hit.distance;
    }
    return hit;
}

}  // namespace tesserae::render
