#include "render/film_list.hpp"

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

Hit FilmList::nearest(const PlacedBodies& placed, const Vec3& view, const Vec4& world,
                      const Settings& settings, FrameStats& stats) const {
    Hit hit;
    double limit = settings.max_distance;
    for (const Candidate& c : candidates_) {
        if (c.nearest > limit) break;
        const double middle = c.centre.dot(view);
        const double off = c.distance_squared - middle * middle;
        if (off > c.radius_squared) continue;
        if (middle < 0 && c.distance_squared > c.radius_squared) continue;
        const double past = middle - limit;
        if (past > 0 && past * past > c.radius_squared - off) continue;
        const double t = hit_distance(placed, c.body, Vec4::Zero(), world, limit, settings, stats);
        if (t < hit.distance || (t == hit.distance && t < kMiss && c.body < hit.body)) {
            hit = {t, c.body};
            limit = t;
        }
    }
    return hit;
}

}  // namespace tesserae::render
