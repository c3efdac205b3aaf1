#include "render/tile/frame_scene.hpp"

#include <algorithm>
#include <cmath>

namespace tesserae::render {
namespace {

/// A frame holds at most so many bodies, summed over its instants (some 300 bytes each), but two
/// instants of any scene.
constexpr std::size_t kMostBodies = 1'000'000;
constexpr std::size_t kMostInstants = 64;

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

/// How far a body's picture moves at most, about [pixels].
double film_motion(const Picture& picture, BodyId id, const Camera& camera) {
    const Bodies &a = picture.bodies, &b = *picture.closing;
    const double moved = (b.position[id] - a.position[id]).norm();
    double turned = 0;
    if (!(a.rotor[id] == b.rotor[id]))
        turned =
            bounding_radius(a.type_of(id).shape) * norm(log(b.rotor[id] * reverse(a.rotor[id])));
    if (moved + turned == 0) return 0;
    const Vec4 at = camera.to_camera(a.position[id] - camera.origin());
    const double depth = std::max(at.z() - moved, 0.1 * at.head<3>().norm());
    return (moved + turned) / (depth * camera.pixel_size());
}

/// For rays that leave the slice, if there are any.
BodyTree tree_of(const Picture& picture, const PlacedBodies& placed) {
    return BodyTree(needs_of(picture).any_rays_off_slice() ? placed : PlacedBodies{});
}

int instant_count(const Picture& picture, const Camera& camera) {
    if (picture.closing == nullptr) return 1;
    const int most = most_instants(picture.bodies.size(), picture.settings.most_samples());
    if (!(picture.camera == *picture.closing_camera)) return most;
    double pixels = 0;
    for (BodyId id = 0; id < picture.bodies.size(); ++id)
        if (picture.appearance[picture.bodies.type[id]].visible)
            pixels = std::max(pixels, film_motion(picture, id, camera));
    return static_cast<int>(std::min(std::ceil(pixels) + 1, static_cast<double>(most)));
}

}  // namespace

int most_instants(std::size_t bodies, int samples) {
    const std::size_t fit =
        std::max<std::size_t>(2, kMostBodies / std::max<std::size_t>(1, bodies));
    return static_cast<int>(std::min(
        {kMostInstants, fit, std::max<std::size_t>(2, static_cast<std::size_t>(samples))}));
}

Instant::Instant(const Picture& picture, const CameraDescription& d, const SliceSheet& sheet,
                 const Bodies& bodies, const RoughReflections& rough)
    : description(d),
      camera(description, sheet.cell_width(), sheet.cell_height()),
      placed(place_bodies(picture, bodies, camera.origin())),
      lights(picture.lights, camera.origin()),
      tree(tree_of(picture, placed)),
      shading(picture, placed, tree, lights, rough),
      integrator(make_integrator(picture, placed, tree, lights, shading)),
      rays(description, camera) {}

FrameScene::FrameScene(const Picture& picture, bool wants_color)
    : picture_(picture),
      needs_(needs_of(picture)),
      sheet_(picture.camera, picture.settings.width, picture.settings.height),
      rough_(picture.materials),
      filter_(picture.settings.filter, picture.settings.filter_width),
      pattern_(
          sample_pattern(picture.settings.seed, picture.settings.lock_noise ? 0 : picture.frame)),
      wants_color_(wants_color) {
    instants_.push_back(
        std::make_unique<Instant>(picture, picture.camera, sheet_, picture.bodies, rough_));
    const int count = instant_count(picture, opening().camera);
    if (count > 1) {
        Bodies bodies = picture.bodies;
        for (int k = 0; k < count; ++k) {
            const double part = (k + 0.5) / count;
            interpolate_poses(picture.bodies, *picture.closing, part, bodies);
            instants_.push_back(std::make_unique<Instant>(
                picture, between(picture.camera, *picture.closing_camera, part), sheet_, bodies,
                rough_));
        }
    }
    const double far = picture.settings.max_distance;
    if (is_pinhole()) {
        slice_ = slice_bounds(opening().placed, opening().camera, far);
        return;
    }
    for (const auto& instant : instants_)
        instant->view.emplace(instant->placed, instant->camera, picture.settings,
                              instant->rays.range(), instant->rays.reach());
}

const Instant& FrameScene::at(double time) const {
    if (is_still()) return opening();
    const std::size_t count = instants_.size() - 1;
    return *instants_[1 + std::min(count - 1,
                                   static_cast<std::size_t>(time * static_cast<double>(count)))];
}

}  // namespace tesserae::render
