// SPDX-License-Identifier: Apache-2.0
#include "scenes/plan/in_slice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <map>

#include "render/camera/camera.hpp"
#include "render/scene/placed_bodies.hpp"
#include "render/scene/slice.hpp"
#include "scenes/film/film_camera.hpp"
#include "scenes/film/poses.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

/// Frames that are looked at, at most.
constexpr std::size_t kMostLooks = 240;
/// A face this near to the slice, relative to the body's size, and this flat to it lies in it.
constexpr double kInSlice = 1e-9;
/// One minus the cosine of what is parallel.
constexpr double kFlat = 1e-15;
/// More frames than this part without a body are told.
constexpr double kMostlyEmpty = 0.5;

std::size_t name_of(const Scene& scene, BodyId id) {
    const auto after =
        std::upper_bound(scene.names.begin(), scene.names.end(), id,
                         [](BodyId body, const NamedBodies& named) { return body < named.first; });
    return static_cast<std::size_t>(after - scene.names.begin() - 1);
}

/// Planes of a shape's flat cells, in its own frame; of round shapes none.
template <class S>
std::vector<HalfSpace> cells_of(const S& shape) {
    std::vector<HalfSpace> cells;
    if constexpr (std::same_as<S, Hyperbox>) {
        for (int axis = 0; axis < 4; ++axis)
            for (const double sign : {-1.0, 1.0})
                cells.push_back({sign * Vec4::Unit(axis), 0.5 * shape.size[axis]});
    } else if constexpr (std::derived_from<S, HullShape>) {
        for (const HullCell& cell : shape.body->hull.cells) cells.push_back(cell.plane);
    }
    return cells;
}

bool has_face_in_slice(const Bodies& bodies, BodyId id, const render::Camera& camera) {
    return std::visit(
        [&](const auto& shape) {
            const Vec4 normal = to_matrix(bodies.rotor[id]).transpose() * camera.fourth();
            const double offset = camera.fourth().dot(camera.origin() - bodies.position[id]);
            const double size = bounding_radius(shape);
            for (const HalfSpace& cell : cells_of(shape)) {
                const double along = cell.normal.dot(normal);
                if (1 - std::abs(along) < kFlat &&
                    std::abs(along * offset - cell.offset) < kInSlice * size)
                    return true;
            }
            return false;
        },
        bodies.type_of(id).shape);
}

/// What has been seen so far.
class Looks {
  public:
    explicit Looks(const Scene& scene) : scene_(scene), names_(scene.names.size()) {
        for (std::size_t i = 0; i < names_.size(); ++i) {
            names_[i].name = scene.names[i].name;
            names_[i].bodies = scene.names[i].count;
        }
    }

    void add(double time, const Bodies& bodies, const render::CameraDescription& description) {
        const render::Settings& s = scene_.render;
        const render::Camera camera(description, s.width, s.height);
        const render::Picture picture = {bodies,      scene_.appearance, scene_.materials,
                                         description, scene_.lights,     s};
        const double half = 0.5 * description.slice_thickness;
        const render::PlacedBodies placed = render::place_bodies(picture, camera.origin());
        std::map<std::size_t, std::uint64_t> seen;
        for (const render::SliceBounds& bounds :
             render::slice_bounds(placed, camera, s.ray_limit(), {-half, half})) {
            const BodyId id = placed.bodies[bounds.body].id;
            if (!is_bounded(bodies.type_of(id).shape)) continue;
            const double low = std::max(bounds.y0, 0.0);
            const double high = std::min(bounds.y1, static_cast<double>(s.height));
            if (!(bounds.x1 > 0 && bounds.x0 < s.width && high > low)) continue;
            const std::size_t name = name_of(scene_, id);
            ++seen[name];
            names_[name].largest = std::max(names_[name].largest, (high - low) / s.height);
            if (in_slice_.empty() && has_face_in_slice(bodies, id, camera))
                in_slice_ = fmt::format(
                    "at {:.4g} s a face of \"{}\" lies in the slice: what is seen of it is decided "
                    "by rounding; move the body or the camera a little along its fourth axis",
                    time, names_[name].name);
        }
        if (seen.empty()) ++empty_;
        ++looks_;
        for (const auto& [name, count] : seen) {
            InPicture& body = names_[name];
            body.most_bodies = std::max(body.most_bodies, count);
            if (body.times.empty() || last_[name] != looks_ - 1) body.times.push_back({time, time});
            body.times.back().second = time;
            last_[name] = looks_;
        }
    }

    SliceReport report() && {
        SliceReport report;
        for (std::size_t i = 0; i < names_.size(); ++i) {
            const BodyType& type = scene_.bodies.type_of(scene_.names[i].first);
            const auto number = scene_.bodies.type[scene_.names[i].first];
            if (is_bounded(type.shape) && scene_.appearance[number].visible)
                report.names.push_back(std::move(names_[i]));
        }
        if (!in_slice_.empty()) report.warnings.push_back(in_slice_);
        if (!report.names.empty() && static_cast<double>(empty_) > kMostlyEmpty * looks_)
            report.warnings.push_back(
                fmt::format("{} of {} frames that were looked at show no body but hyperplanes",
                            empty_, looks_));
        return report;
    }

  private:
    const Scene& scene_;
    std::vector<InPicture> names_;
    std::map<std::size_t, int> last_;  ///< the number of the look that saw the name last
    std::string in_slice_;
    int looks_ = 0, empty_ = 0;
};

}  // namespace

SliceReport look_at_slice(const Scene& scene, const std::filesystem::path& trajectory,
                          const std::vector<int>& frames) {
    std::vector<int> chosen;
    const std::size_t count = std::min(kMostLooks, frames.size());
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(frames[i * frames.size() / count]);
    Poses poses(scene, chosen, trajectory);
    Looks looks(scene);
    FilmCamera camera(scene, &poses);
    for (const int frame : chosen) {
        const FrameInstant at = frame_instant(scene, frame);
        const Bodies& bodies = poses.at(at);
        looks.add(at.time, bodies, camera.at(at.time, bodies));
    }
    return std::move(looks).report();
}

std::string text_of(const InPicture& body) {
    std::string text = toml_text(body.name);
    if (body.times.empty()) return text + " is never in the picture";
    if (body.bodies > 1) text += fmt::format(": up to {} of {}", body.most_bodies, body.bodies);
    constexpr std::size_t kMostTimes = 4;
    const std::size_t shown = std::min(kMostTimes, body.times.size());
    for (std::size_t i = 0; i < shown; ++i)
        text += fmt::format("{} {:.4g} to {:.4g} s", i == 0 ? " in the picture from" : ",",
                            body.times[i].first, body.times[i].second);
    if (shown < body.times.size())
        text += fmt::format(" and {} times more", body.times.size() - shown);
    return text + fmt::format(", up to {:.2g} % of its height", 100 * body.largest);
}

}  // namespace tesserae::scenes
