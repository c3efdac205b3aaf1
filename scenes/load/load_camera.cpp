// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "render/camera/camera.hpp"
#include "scenes/load/load_parts.hpp"
#include "scenes/load/picture_keys.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

/// What is left of `v` orthogonal to unit vectors that are orthogonal to each other.
Vec4 orthogonal_part(const Vec4& v, const Vec4& first, const Vec4& second) {
    const Vec4 unit = stable_normalized(v);
    return unit - unit.dot(first) * first - unit.dot(second) * second;
}

void require_frame(TableReader& reader, const render::CameraDescription& c) {
    const Vec4 view = c.look_at - c.position;
    if (view.isZero(0)) {
        const char* key = reader.has("look_at") ? "look_at" : "position";
        reader.fail(key, "position and look_at must differ");
    }
    const Vec4 forward = stable_normalized(view);
    const Vec4 fourth = orthogonal_part(c.fourth, forward, Vec4::Zero());
    if (!(fourth.norm() > kParallel))
        reader.fail(
            reader.has("fourth") || !reader.has("look_at") ? "fourth" : "look_at",
            fmt::format("fourth = {} is parallel to the forward direction; expected another "
                        "direction",
                        toml_text(c.fourth)));
    if (!(orthogonal_part(c.up, forward, fourth.normalized()).norm() > kParallel))
        reader.fail(reader.has("up") || !reader.has("look_at") ? "up" : "look_at",
                    fmt::format("up = {} lies in the plane of the forward direction and fourth; "
                                "expected another direction",
                                toml_text(c.up)));
}

/// What the keys of one [[camera.key]] ask of each other.
/// @param here   where the camera is at the key before
void require_orbit(TableReader& reader, const CameraKey& key, const Vec4& here, bool is_first) {
    if (!key.orbit) {
        if (reader.has("ease"))
            reader.fail("ease",
                        "is of an orbit, and this key has none; expected an orbit beside it");
        return;
    }
    if (key.position) reader.fail("orbit", "there is a position too; expected only one of them");
    if (is_first && !(key.time > 0))
        reader.fail("time",
                    "the orbit of the first key takes the time from 0 s to this; expected a time "
                    "> 0, or a key before it that says where the orbit begins");
    if (!(key.orbit->radius(here) > 0))
        reader.fail("orbit",
                    fmt::format("the camera is at {} before, on the axis that it would go round; "
                                "expected an about beside it in the plane",
                                toml_text(here)));
}

void load_keys(TableReader& camera, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    std::vector<const toml::table*> tables;
    camera.collect([&] { tables = camera.tables("key"); });
    Vec4 here = scene.camera.position;
    for (std::size_t i = 0; i < tables.size(); ++i)
        camera.collect([&] {
            const std::vector<CameraKey>& before = scene.camera_keys;
            TableReader reader(*tables[i], origin, fmt::format("camera key {}", i));
            CameraKey key;
            camera_key_keys(key, ReadKeys{reader}, before);
            reader.finish();
            require_orbit(reader, key, here, i == 0);
            if (!key.position && !key.look_at && !key.up && !key.fourth && !key.field_of_view &&
                !key.orbit)
                reader.fail_here("expected position, look_at, up, fourth, field_of_view or orbit");
            out.table("[[camera.key]]");
            camera_key_keys(key, WriteKeys{out}, before);
            if (key.position) here = *key.position;
            if (key.orbit) here = key.orbit->turned(here, 1);
            scene.camera_keys.push_back(key);
        });
}

}  // namespace

void load_camera(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    render::CameraDescription& camera = scene.camera;
    const WriteKeys write{out};
    out.table("[camera]");
    const auto* table = root.table("camera");
    if (table == nullptr) {
        camera_keys(camera, write);
        camera_motion_keys(scene.camera_motion, write);
        return;
    }
    TableReader reader(*table, origin, "[camera]");
    camera_keys(camera, ReadKeys{reader});
    camera_motion_keys(scene.camera_motion, ReadKeys{reader});
    if (reader.has("slices") && camera.slices > 1 && camera.slice_thickness == 0)
        reader.collect([&] {
            reader.fail("slices", "expected a slice_thickness over which they are spread");
        });
    camera_keys(camera, write);
    camera_motion_keys(scene.camera_motion, write);
    load_keys(reader, origin, scene, out);
    if (scene.camera_motion.closed && !reader.has_errors())
        reader.collect([&] {
            const std::string open = open_ends(camera, scene.camera_keys);
            if (!open.empty()) reader.fail("closed", open);
        });
    reader.finish();
    if (scene.camera_keys.empty()) require_frame(reader, camera);
}

namespace {

/// That a closed path comes back with its picture upright, see CarriedUp.
void require_same_up(const CameraPath& path, double begin, double end, const Origin& origin) {
    constexpr double kSameUp = 1e-6;
    const Vec4 first = path.at(begin).up, last = path.at(end).up;
    if ((first - last).norm() <= kSameUp) return;
    throw InputError(fmt::format(
        "{}: [camera]: closed = true: the picture is turned by {:.3g} degrees when the path comes "
        "back, since it looked straight along `up` on its way; expected a path that swings back "
        "too, or keys of up",
        origin.place,
        2 * std::asin(std::min(1.0, 0.5 * (first - last).norm())) * 180 / std::numbers::pi));
}

}  // namespace

void require_view(const Scene& scene, const Origin& origin) {
    if (scene.camera_keys.empty()) return;
    const CameraPath path = scene.camera_path();
    if (scene.camera_motion.closed)
        require_same_up(path, scene.camera_keys.front().time, scene.camera_keys.back().time,
                        origin);
    for (int frame = 0, count = frame_count(scene); frame < count; ++frame) {
        const double time = frame_instant(scene, frame).time;
        try {
            const render::Camera camera(path.at(time), 1, 1);
        } catch (const InputError& error) {
            throw InputError(
                fmt::format("{}: frame {} at {} s: {}; move a [[camera.key]] or add "
                            "one between",
                            origin.place, frame, time, error.what()));
        }
    }
}

}  // namespace tesserae::scenes
