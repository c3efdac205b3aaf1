#include "render/tile/frame_scene.hpp"

#include <algorithm>
#include <cmath>

namespace tesserae::render {
namespace {

/// A frame holds at most so many bodies, summed over its instants (some 300 bytes each), but two
/// instants of any scene.
constexpr std::size_t kMostBodies = 1'000'000;
constexpr std::size_t kMostInstants = 256;

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

/// The scene at the opening and at the moments after it, one after the other.
class OpenShutter {
  public:
    explicit OpenShutter(const Picture& picture) : picture_(picture) {}

    std::size_t parts() const { return picture_.path.size(); }
    double time(std::size_t i) const { return i == 0 ? 0 : picture_.path[i - 1].time; }
    const Bodies& bodies(std::size_t i) const {
        return i == 0 ? picture_.bodies : picture_.path[i - 1].bodies;
    }
    const CameraDescription& camera(std::size_t i) const {
        return i == 0 ? picture_.camera : picture_.path[i - 1].camera;
    }
    /// @param part   of the time from opening to closing
    /// @param poses   get the bodies'
    CameraDescription at(double part, Bodies& poses) const {
        const double now = part * time(parts());
        std::size_t i = 0;
        while (i + 1 < parts() && now >= time(i + 1)) ++i;
        const double length = time(i + 1) - time(i), in_part = (now - time(i)) / length;
        follow_poses(bodies(i), bodies(i + 1), length, in_part, poses);
        return between(camera(i), camera(i + 1), in_part);
    }

  private:
    const Picture& picture_;
};

/// How far a body's picture moves at most, about [pixels].
double film_motion(const Picture& picture, BodyId id, const Camera& camera) {
    const OpenShutter open(picture);
    const double radius = bounding_radius(picture.bodies.type_of(id).shape);
    double moved = 0, turned = 0;
    for (std::size_t i = 0; i < open.parts(); ++i) {
        const Bodies &a = open.bodies(i), &b = open.bodies(i + 1);
        moved += (b.position[id] - a.position[id]).norm();
        if (a.rotor[id] == b.rotor[id]) continue;
        const double length = open.time(i + 1) - open.time(i);
        turned += radius * std::max(norm(b.angular_velocity[id]) * length,
                                    2 * norm(log(b.rotor[id] * reverse(a.rotor[id]))));
    }
    if (moved + turned == 0) return 0;
    const Vec4 at = camera.to_camera(picture.bodies.position[id] - camera.origin());
    const double depth = std::max(at.z() - moved, 0.1 * at.head<3>().norm());
    return (moved + turned) / (depth * camera.pixel_size());
}

/// For rays that leave the slice, if there are any.
BodyTree tree_of(const Picture& picture, const PlacedBodies& placed) {
    return BodyTree(needs_of(picture).any_rays_off_slice() ? placed : PlacedBodies{});
}

int instant_count(const Picture& picture, const Camera& camera) {
    if (picture.path.empty()) return 1;
    const int most = most_instants(picture.bodies.size(), picture.settings.most_samples());
    for (const ShutterMoment& moment : picture.path)
        if (!(moment.camera == picture.camera)) return most;
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
      rays(description, camera),
      glass_about(integrator->glass().about(
          Vec4::Zero(), std::hypot(rays.reach(), rays.range().low, rays.range().high))) {}

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
            const CameraDescription camera = OpenShutter(picture).at((k + 0.5) / count, bodies);
            instants_.push_back(std::make_unique<Instant>(picture, camera, sheet_, bodies, rough_));
        }
    }
    const double far = picture.settings.ray_limit();
    if (is_pinhole()) {
        slice_ = slice_bounds(opening().placed, opening().camera, far);
        // What a pixel's samples meet may lie beside the pixel.
        const double reach = filter_.reach();
        for (SliceBounds& s : slice_) s.x0 -= reach, s.y0 -= reach, s.x1 += reach, s.y1 += reach;
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
