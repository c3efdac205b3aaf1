// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/film_camera.hpp"

#include <algorithm>
#include <cmath>

namespace tesserae::scenes {

FilmCamera::FilmCamera(const Scene& scene, const Poses* poses)
    : scene_(scene), poses_(poses), path_(scene.camera_path()) {}

render::CameraDescription FilmCamera::at(double time, const Bodies& bodies) {
    if (!scene_.follows()) return path_.at(time);
    const BodyId body = *scene_.camera_motion.followed;
    return moved(time, bodies.position[body] - scene_.bodies.position[body]);
}

std::optional<render::CameraDescription> FilmCamera::at(int frame) {
    const double time = frame_instant(scene_, frame).time;
    if (!scene_.follows()) return path_.at(time);
    const std::optional<Vec4>& now = way(frame);
    if (!now) return {};
    return moved(time, *now);
}

const std::optional<Vec4>& FilmCamera::way(int frame) {
    const auto [at, is_new] = ways_.try_emplace(frame);
    if (is_new && poses_ != nullptr) {
        const BodyId body = *scene_.camera_motion.followed;
        at->second = poses_->position(frame_instant(scene_, frame), body);
        if (at->second) *at->second -= scene_.bodies.position[body];
    }
    return at->second;
}

Vec4 FilmCamera::mean_way(double time, const Vec4& now) {
    const double lag = scene_.camera_motion.follow_lag, rate = scene_.render.frames_per_second;
    if (!(time > 0)) return Vec4::Zero();
    // Trapezia from now back: between the frames before, as far as the lag goes.
    const double begin = time - lag;
    if (!(begin < time)) return now;
    Vec4 sum = Vec4::Zero(), after = now;
    double end = time;
    auto frame = static_cast<int>(std::min(std::ceil(time * rate), frame_count(scene_) + 0.0));
    while (frame >= 0 && !(frame / rate < time)) --frame;
    for (; frame >= 0 && end > begin; --frame) {
        const double at = frame / rate;
        const std::optional<Vec4>& known = way(frame);
        if (!known && frame > 0) continue;
        const Vec4 here = known.value_or(Vec4::Zero());
        const double part = std::max(0.0, (begin - at) / (end - at));
        const Vec4 before = here + part * (after - here);
        sum += 0.5 * (end - std::max(begin, at)) * (before + after);
        after = here;
        end = at;
    }
    return sum / (time - begin);
}

render::CameraDescription FilmCamera::moved(double time, const Vec4& now) {
    const CameraMotion& motion = scene_.camera_motion;
    const Vec4 way = motion.follow_lag > 0 ? mean_way(time, now) : now;
    const bool follows[] = {motion.follow_axes.x, motion.follow_axes.y, motion.follow_axes.z,
                            motion.follow_axes.w};
    render::CameraDescription camera = path_.at(time);
    for (int axis = 0; axis < 4; ++axis)
        if (follows[axis]) camera.position[axis] += way[axis], camera.look_at[axis] += way[axis];
    return camera;
}

}  // namespace tesserae::scenes
