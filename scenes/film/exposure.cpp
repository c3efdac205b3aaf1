// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/exposure.hpp"

#include <utility>

#include "scenes/film/coast.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

Moment moment(FilmCamera& camera, Poses& poses, const FrameInstant& instant) {
    const Bodies& bodies = poses.at(instant);
    return {{bodies, camera.at(instant.time, bodies)}};
}

Moment moment(FilmCamera& camera, Bodies bodies, double time) {
    const render::CameraDescription view = camera.at(time, bodies);
    return {{std::move(bodies), view}};
}

}  // namespace

bool Moment::looks_like(const Moment& other, const Scene& scene) const {
    if (!(camera == other.camera)) return false;
    for (BodyId id = 0; id < bodies.size(); ++id)
        if (scene.appearance[bodies.type[id]].visible &&
            (bodies.position[id] != other.bodies.position[id] ||
             !(bodies.rotor[id] == other.bodies.rotor[id])))
            return false;
    return true;
}

Exposure::Exposure(const Scene& scene, FilmCamera& camera, Poses& poses, int frame)
    : opening(moment(camera, poses, frame_instant(scene, frame))) {
    if (scene.render.channels.motion) {
        after = neighbour(scene, camera, poses, frame, 1);
        before = neighbour(scene, camera, poses, frame, -1);
    }
    if (scene.camera.shutter > 0) open_shutter(scene, camera, poses, frame);
}

Exposure::Exposure(const Scene& scene, FilmCamera& camera, Bodies bodies, double time)
    : opening(moment(camera, std::move(bodies), time)) {
    const double frame = 1 / scene.render.frames_per_second;
    if (scene.render.channels.motion) {
        after = coasted(camera, frame, time + frame);
        before = coasted(camera, -frame, time - frame);
    }
    if (scene.camera.shutter > 0) {
        const double open = scene.camera.shutter * frame;
        Moment closing = coasted(camera, open, time + open);
        if (!closing.looks_like(opening, scene))
            path.push_back({open, std::move(closing.bodies), closing.camera});
    }
}

bool Exposure::looks_like(const Exposure& other, const Scene& scene) const {
    const auto like = [&](const std::optional<Moment>& a, const std::optional<Moment>& b) {
        return a && b ? a->looks_like(*b, scene) : !a && !b;
    };
    return opening.looks_like(other.opening, scene) && path.empty() && other.path.empty() &&
           like(after, other.after) && like(before, other.before);
}

render::Picture Exposure::picture(const Scene& scene, int frame) const {
    return {opening.bodies,
            scene.appearance,
            scene.materials,
            opening.camera,
            scene.lights,
            scene.render,
            path,
            frame,
            after ? &*after : nullptr,
            before ? &*before : nullptr};
}

void Exposure::open_shutter(const Scene& scene, FilmCamera& camera, Poses& poses, int frame) {
    const double begin = frame_instant(scene, frame).time;
    const double rate = scene.physics ? scene.physics->steps_per_second : 1;
    bool is_still = true;
    const auto add = [&](const FrameInstant& instant) {
        Moment at = moment(camera, poses, instant);
        is_still = is_still && at.looks_like(opening, scene);
        path.push_back({instant.time - begin, std::move(at.bodies), at.camera});
    };
    for (const std::uint64_t step : shutter_steps(scene, frame))
        if (poses.has(step)) add({static_cast<double>(step) / rate, step, 0});
    // Past the last step all stands still.
    const FrameInstant close = closing_instant(scene, frame);
    const double last = static_cast<double>(step_count(scene)) / rate;
    if (close.step == step_count(scene) && begin < last && last < close.time)
        add({last, close.step, 0});
    add(close);
    if (is_still) path.clear();
}

/// The frame `by` frames on. Where there is none the bodies of this one go on at their velocities.
Moment Exposure::neighbour(const Scene& scene, FilmCamera& camera, Poses& poses, int frame,
                           int by) const {
    const FrameInstant at = frame_instant(scene, frame + by);
    if (has_frame(scene, frame + by)) return moment(camera, poses, at);
    return coasted(camera, by / scene.render.frames_per_second, at.time);
}

Moment Exposure::coasted(FilmCamera& camera, double by, double time) const {
    Bodies bodies = opening.bodies;
    coast(bodies, by);
    return moment(camera, std::move(bodies), time);
}

}  // namespace tesserae::scenes
