#include "render/ray_scene.hpp"

namespace tesserae::render {

Hit RayScene::nearest(const Vec4& origin, const Vec4& direction, double limit, std::uint32_t on,
                      FrameStats& stats) const {
    Hit hit;
    const auto visit = [&](std::uint32_t body) {
        if (body == on) return true;
        const double t = hit_distance(placed_, body, origin, direction, limit, settings_, stats);
        if (t < hit.distance || (t == hit.distance && t < kMiss && body < hit.body)) {
            hit = {t, body};
            limit = t;
        }
        return true;
    };
    for (const std::uint32_t body : tree_.unbounded()) visit(body);
    tree_.for_each_on_ray(origin, direction, limit, visit);
    return hit;
}

bool RayScene::is_blocked(const Vec4& origin, const Vec4& direction, double limit, std::uint32_t on,
                          FrameStats& stats) const {
    bool blocked = false;
    const auto clears = [&](std::uint32_t body) {
        blocked = body != on &&
                  hit_distance(placed_, body, origin, direction, limit, settings_, stats) < kMiss;
        return !blocked;
    };
    for (const std::uint32_t body : tree_.unbounded())
        if (!clears(body)) return true;
    tree_.for_each_on_ray(origin, direction, limit, clears);
    return blocked;
}

}  // namespace tesserae::render
