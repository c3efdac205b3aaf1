// SPDX-License-Identifier: Apache-2.0
#include "render/tile/frame_scene.hpp"

#include <algorithm>
#include <cmath>

namespace tesserae::render {
namespace {

/// A frame holds at most so many bodies, summed over its intervals (some 300 bytes each).
constexpr std::size_t kMostBodies = 1'000'000;
constexpr std::size_t kMostIntervals = 64;
/// How far a body moves in an interval, in parts of its bounding radius: farther, rays meet its
/// bounds more often than it; less, more trees are built than that saves.
constexpr double kTravel = 2;

CameraDescription between(const CameraDescription& a, const CameraDescription& b, double part) {
    if (a == b) return a;
    CameraDescription c = a;
    c.position += part * (b.position - a.position);
    c.look_at += part * (b.look_at - a.look_at);
    c.up = (1 - part) * a.up.normalized() + part * b.up.normalized();
    c.fourth = (1 - part) * a.fourth.normalized() + part * b.fourth.normalized();
    c.field_of_view += part * (b.field_of_view - a.field_of_view);
    return c;
}

CameraDescription camera_at(const Picture& picture, double time) {
    const auto path = picture.path;
    std::size_t i = 0;
    while (i + 1 < path.size() && time >= path[i].time) ++i;
    const double begin = i == 0 ? 0 : path[i - 1].time;
    return between(i == 0 ? picture.camera : path[i - 1].camera, path[i].camera,
                   (time - begin) / (path[i].time - begin));
}

bool camera_moves(const Picture& picture) {
    return std::any_of(picture.path.begin(), picture.path.end(),
                       [&](const ShutterMoment& m) { return !(m.camera == picture.camera); });
}

/// How far from the camera's place at the opening view rays begin.
double reach_of(const Picture& picture, const CameraRays& rays) {
    double way = 0;
    for (const ShutterMoment& moment : picture.path)
        way = std::max(way, (moment.camera.position - picture.camera.position).norm());
    return way + std::hypot(rays.reach(), rays.range().low, rays.range().high);
}

/// For rays that leave the slice, if there are any.
BodyTree tree_of(const Picture& picture, const PlacedBodies& placed) {
    return BodyTree(needs_of(picture).tree() ? placed : PlacedBodies{});
}

int interval_count(const Picture& picture, const Motions& motions, bool camera_moves) {
    if (motions.is_empty() && !camera_moves) return 0;
    const double most = most_intervals(picture.bodies.size());
    return static_cast<int>(std::clamp(std::ceil(motions.most_travel() / kTravel), 1.0, most));
}

}  // namespace

int most_intervals(std::size_t bodies) {
    return static_cast<int>(
        std::clamp<std::size_t>(kMostBodies / std::max<std::size_t>(1, bodies), 1, kMostIntervals));
}

Interval::Interval(const Picture& picture, const Vec4& origin, const ShutterPart& part,
                   const LightSet& lights, const RoughReflections& rough, double reach)
    : placed(place_bodies(picture, origin, part)),
      tree(tree_of(picture, placed)),
      shading(picture, placed, tree, lights, rough),
      integrator(make_integrator(picture, placed, tree, lights, shading)),
      glass_about(integrator->glass().about(Vec4::Zero(), reach)) {}

FrameScene::FrameScene(const Picture& picture, bool wants_color)
    : picture_(picture),
      needs_(needs_of(picture)),
      sheet_(picture.camera, picture.settings.width, picture.settings.height),
      rough_(picture.materials),
      filter_(picture.settings.filter, picture.settings.filter_width),
      pattern_(
          sample_pattern(picture.settings.seed, picture.settings.lock_noise ? 0 : picture.frame)),
      wants_color_(wants_color),
      camera_(picture.camera, sheet_.cell_width(), sheet_.cell_height()),
      rays_(picture.camera, camera_),
      lights_(picture.lights, camera_.origin()),
      motions_(picture, camera_.origin()),
      camera_moves_(camera_moves(picture)),
      opening_(picture, camera_.origin(), {}, lights_, rough_, reach_of(picture, rays_)) {
    const int count = interval_count(picture, motions_, camera_moves_);
    for (int i = 0; i < count; ++i) {
        const double begin = motions_.end() * i / count, end = motions_.end() * (i + 1) / count;
        intervals_.push_back(std::make_unique<Interval>(picture, camera_.origin(),
                                                        ShutterPart{&motions_, begin, end}, lights_,
                                                        rough_, reach_of(picture, rays_)));
    }
    for (int cell = 0; needs_.ghosts && cell < sheet_.cells(); ++cell) {
        const double own = sheet_.fourth(cell);
        ghosts_.push_back(std::make_unique<const Ghosts>(
            opening_.placed, camera_, picture.settings,
            sheet_.cells() > 1 ? SliceRange{own, own} : rays_.range(), rays_.reach()));
    }
    const double far = picture.settings.ray_limit();
    if (!is_pinhole()) {
        view_.emplace(opening_.placed, camera_, picture.settings, rays_.range(), rays_.reach());
        return;
    }
    slice_ = slice_bounds(opening_.placed, camera_, far);
    // What a pixel's samples meet may lie beside the pixel.
    const double reach = filter_.reach();
    for (SliceBounds& s : slice_) s.x0 -= reach, s.y0 -= reach, s.x1 += reach, s.y1 += reach;
}

const Interval& FrameScene::at(double time) const {
    // The same products as those of the bounds, so that rounding puts no time into the wrong one.
    const auto count = intervals_.size();
    const auto begin = [&](std::size_t i) {
        return motions_.end() * static_cast<double>(i) / static_cast<double>(count);
    };
    auto i = std::min(count - 1,
                      static_cast<std::size_t>(time / motions_.end() * static_cast<double>(count)));
    while (i > 0 && time < begin(i)) --i;
    while (i + 1 < count && time >= begin(i + 1)) ++i;
    return *intervals_[i];
}

Ray FrameScene::view_ray(const SliceSheet::Cell& cell, const Vec2& film,
                         const std::array<double, 3>& u, double time) const {
    Ray ray;
    if (camera_moves_) {
        const CameraDescription description = camera_at(picture_, time);
        const Camera camera(description, sheet_.cell_width(), sheet_.cell_height());
        ray = camera.to_world(CameraRays(description, camera).sample(cell, film, u),
                              picture_.settings.ray_limit());
        ray.origin += camera.origin() - camera_.origin();
    } else {
        ray = camera_.to_world(rays_.sample(cell, film, u), picture_.settings.ray_limit());
    }
    ray.time = time;
    return ray;
}

}  // namespace tesserae::render
