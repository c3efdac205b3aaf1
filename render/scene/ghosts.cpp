// SPDX-License-Identifier: Apache-2.0
#include "render/scene/ghosts.hpp"

#include <algorithm>
#include <cmath>

#include "render/tint.hpp"

namespace tesserae::render {
namespace {

/// What a ghost's colour is multiplied by where its surface is edge-on to the ray.
constexpr double kEdgeOn = 0.4;

SliceRange extent_of(const PlacedBodies& placed, const PlacedBody& body, const Camera& camera) {
    const Vec4 axis = placed.direction_to_body(body, camera.fourth());
    const double centre = camera.fourth().dot(body.centre);
    return std::visit(
        [&](const auto& shape) {
            return SliceRange{centre + axis.dot(support(shape, -axis)),
                              centre + axis.dot(support(shape, axis))};
        },
        *body.shape);
}

/// A ghost's light does not depend on the scene's: it is brightest where it faces the ray.
Color color_at(const Color& facing, const Vec4& normal, const Vec4& direction,
               const Camera& camera) {
    const double part = camera.to_camera(normal).head<3>().norm();
    const double cosine = part > 0 ? std::min(1.0, std::abs(normal.dot(direction)) / part) : 1;
    return (kEdgeOn + (1 - kEdgeOn) * cosine) * facing;
}

std::vector<SliceBounds> bounds_of(std::vector<Ghost>& ghosts, const PlacedBodies& placed,
                                   const Camera& camera, double max_distance) {
    std::vector<SliceBounds> bounds;
    std::vector<Ghost> seen;
    for (const Ghost& ghost : ghosts) {
        const auto of_ghost =
            slice_bounds_of(placed, ghost.body, camera, max_distance, {ghost.fourth, ghost.fourth});
        if (!of_ghost) continue;
        bounds.push_back(*of_ghost);
        seen.push_back(ghost);
    }
    ghosts = std::move(seen);
    return bounds;
}

}  // namespace

std::vector<Ghost> ghosts_beside(const PlacedBodies& placed, const Camera& camera,
                                 const SliceRange& slice, double depth,
                                 const std::array<Color, 2>& color) {
    std::vector<Ghost> ghosts;
    for (std::uint32_t i = 0; i < placed.bodies.size(); ++i) {
        const PlacedBody& body = placed.bodies[i];
        if (body.radius == kInfinite) continue;
        const SliceRange extent = extent_of(placed, body, camera);
        const double gap = std::max(extent.low - slice.high, slice.low - extent.high);
        if (!(gap > 0 && gap < depth)) continue;
        const double centre = camera.fourth().dot(body.centre);
        ghosts.push_back({i, std::clamp(centre, slice.low - depth, slice.high + depth),
                          1 - gap / depth, color[extent.low > slice.high ? 1 : 0]});
    }
    return ghosts;
}

/// The ghosts that one ray meets.
class Ghosts::Met : public BoundsScene::Search {
  public:
    struct One {
        Hit hit;
        const Ghost* ghost;
    };

    Met(const Ghosts& ghosts, const ViewRay& ray, double limit, FrameStats& stats,
        std::vector<One>& met)
        : ghosts_(ghosts), ray_(ray), limit_(limit), stats_(stats), met_(met) {}

    double test(std::uint32_t number) override {
        const Ghost& ghost = ghosts_.ghosts_[number];
        const double distance =
            hit_distance(ghosts_.placed_, ghost.body, ray_of(ghost), ghosts_.settings_, stats_);
        if (distance > 0 && distance < kMiss) met_.push_back({{distance, ghost.body}, &ghost});
        return limit_;
    }
    Ray ray_of(const Ghost& ghost) const {
        return ghosts_.camera_.to_world({ray_.origin, ray_.direction, ghost.fourth}, limit_);
    }

  private:
    const Ghosts& ghosts_;
    const ViewRay& ray_;
    double limit_;
    FrameStats& stats_;
    std::vector<One>& met_;
};

Ghosts::Ghosts(const PlacedBodies& placed, const Camera& camera, const Settings& settings,
               const SliceRange& slice, double reach)
    : placed_(placed),
      camera_(camera),
      settings_(settings),
      ghosts_(ghosts_beside(placed, camera, slice, settings.ghost_depth, settings.ghost_colors)),
      bounds_(bounds_of(ghosts_, placed, camera, settings.ray_limit() + reach)),
      scene_(bounds_, reach) {}

GhostLight Ghosts::along(const ViewRay& ray, const Hit& solid, FrameStats& stats) const {
    if (ghosts_.empty()) return {};
    thread_local std::vector<Met::One> met;  // keeps its memory: this is asked at every sample
    met.clear();
    const double limit = std::min(solid.distance, settings_.ray_limit());
    Met search(*this, ray, limit, stats, met);
    scene_.search(ray, limit, search);
    std::sort(met.begin(), met.end(), [](const Met::One& a, const Met::One& b) {
        return a.hit.distance != b.hit.distance ? a.hit.distance < b.hit.distance
                                                : a.hit.body < b.hit.body;
    });
    GhostLight light;
    for (const auto& [hit, ghost] : met) {
        if (hit.distance == solid.distance && hit.body > solid.body) break;
        const PlacedBody& body = placed_.bodies[hit.body];
        const Ray in_world = search.ray_of(*ghost);
        const Vec4 local = placed_.point_to_body(body, in_world.at(hit.distance));
        const Vec4 normal = placed_.direction_to_world(body, surface_normal(*body.shape, local));
        const double share = (1 - light.alpha) * ghost->alpha;
        light.color += share * color_at(ghost->color, normal, in_world.direction, camera_);
        light.alpha += share;
    }
    return light;
}

}  // namespace tesserae::render
