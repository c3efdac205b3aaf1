// SPDX-License-Identifier: Apache-2.0
#include "render/scene/view_scene.hpp"

#include "core/error.hpp"

namespace tesserae::render {
namespace {

/// The nearest hit of one ray.
class Nearest : public BoundsScene::Search {
  public:
    Nearest(const PlacedBodies& placed, const Settings& settings,
            const std::vector<SliceBounds>& slice, const Ray& ray, FrameStats& stats)
        : placed_(placed), settings_(settings), slice_(slice), ray_(ray), stats_(stats) {}

    double test(std::uint32_t number) override {
        test_body(slice_[number].body);
        return ray_.limit;
    }
    void test_body(std::uint32_t body) {
        if (hit_.take(body, hit_distance(placed_, body, ray_, settings_, stats_)))
            ray_.limit = hit_.distance;
    }
    double limit() const { return ray_.limit; }
    const Hit& hit() const { return hit_; }

  private:
    const PlacedBodies& placed_;
    const Settings& settings_;
    const std::vector<SliceBounds>& slice_;
    Ray ray_;
    FrameStats& stats_;
    Hit hit_;
};

}  // namespace

ViewScene::ViewScene(const PlacedBodies& placed, const Camera& camera, const Settings& settings,
                     const SliceRange& range, double reach)
    : placed_(placed), camera_(camera), settings_(settings), range_(range) {
    // A ray from the side reaches as far as one from the camera that may go farther.
    for (const SliceBounds& s : slice_bounds(placed, camera, settings.ray_limit() + reach, range))
        if (s.radius < kInfinite)
            slice_.push_back(s);
        else
            unbounded_.push_back(s.body);
    bounded_.emplace(slice_, reach);
}

void ViewScene::nearest(std::span<const ViewRay> rays, std::span<Hit> hits,
                        FrameStats& stats) const {
    TSR_ASSERT(rays.size() == hits.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const ViewRay& r = rays[i];
        TSR_ASSERT(r.fourth >= range_.low && r.fourth <= range_.high);
        Nearest nearest(placed_, settings_, slice_, camera_.to_world(r, settings_.ray_limit()),
                        stats);
        for (const std::uint32_t body : unbounded_) nearest.test_body(body);
        bounded_->search(r, nearest.limit(), nearest);
        hits[i] = nearest.hit();
    }
}

}  // namespace tesserae::render
