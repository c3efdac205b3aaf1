#include "core/error.hpp"
#include "render/camera/camera.hpp"
#include "scenes/load/load_parts.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

/// Sine of the angle below which camera directions count as parallel; Camera's own bound is lower.
constexpr double kParallel = 1e-7;

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

constexpr Interval kFieldOfView{0, 180, true, true};

/// A direction, made unit, that the camera can turn to from the last key's in one way only.
bool read_turn(TableReader& reader, std::string_view name, std::optional<Vec4> CameraKey::*part,
               std::span<const CameraKey> before, CameraKey& key) {
    Vec4 direction;
    if (!reader.read(name, direction, Rule::kNonZero)) return false;
    key.*part = stable_normalized(direction);
    for (std::size_t i = before.size(); i-- > 0;) {
        const std::optional<Vec4>& last = before[i].*part;
        if (!last) continue;
        if (!((*last + *(key.*part)).norm() > kParallel))
            reader.fail(name,
                        "is opposite to the last key's; expected another direction, or a "
                        "key between them that says which way to turn");
        break;
    }
    return true;
}

CameraKey load_key(TableReader& reader, std::span<const CameraKey> before, EffectiveWriter& out) {
    CameraKey key;
    out.table("[[camera.key]]");
    if (reader.require("time", "expected a time in s")) reader.read("time", key.time, Interval{});
    if (!before.empty() && reader.has("time") && !(key.time > before.back().time))
        reader.fail("time", fmt::format("expected a time after the last key's, {} s",
                                        toml_text(before.back().time)));
    out.key("time", key.time);
    const auto point = [&](const char* name, std::optional<Vec4>& part) {
        Vec4 value;
        if (!reader.read(name, value, Rule::kFinite)) return false;
        part = value;
        out.key(name, value);
        return true;
    };
    bool any = point("position", key.position);
    any |= point("look_at", key.look_at);
    const auto turn = [&](const char* name, std::optional<Vec4> CameraKey::*part) {
        if (!read_turn(reader, name, part, before, key)) return false;
        out.key(name, *(key.*part));
        return true;
    };
    any |= turn("up", &CameraKey::up);
    any |= turn("fourth", &CameraKey::fourth);
    double degrees = 0;
    if (reader.read("field_of_view", degrees, kFieldOfView)) {
        key.field_of_view = degrees;
        out.key("field_of_view", degrees);
        any = true;
    }
    reader.finish();
    if (!any) reader.fail_here("expected position, look_at, up, fourth or field_of_view");
    return key;
}

void load_keys(TableReader& camera, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    const auto tables = camera.tables("key");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        TableReader reader(*tables[i], origin, fmt::format("camera key {}", i));
        scene.camera_keys.push_back(load_key(reader, scene.camera_keys, out));
    }
}

void read_camera(TableReader& reader, render::CameraDescription& camera) {
    reader.read("position", camera.position, Rule::kFinite);
    reader.read("look_at", camera.look_at, Rule::kFinite);
    reader.read("up", camera.up, Rule::kNonZero);
    reader.read("fourth", camera.fourth, Rule::kNonZero);
    reader.read("field_of_view", camera.field_of_view, kFieldOfView);
    reader.read("aperture", camera.aperture, Rule::kNonNegative);
    reader.read("focus_distance", camera.focus_distance, Rule::kNonNegative);
    reader.read("shutter", camera.shutter, Interval{0, 1});
    reader.read("slice_thickness", camera.slice_thickness, Rule::kNonNegative);
    if (reader.read("slices", camera.slices, 1, 1000) && camera.slices > 1 &&
        camera.slice_thickness == 0)
        reader.fail("slices", "expected a slice_thickness over which they are spread");
}

void write_camera(const render::CameraDescription& camera, EffectiveWriter& out) {
    out.table("[camera]");
    out.key("position", camera.position);
    out.key("look_at", camera.look_at);
    out.key("up", camera.up);
    out.key("fourth", camera.fourth);
    out.key("field_of_view", camera.field_of_view);
    out.key("aperture", camera.aperture);
    out.key("focus_distance", camera.focus_distance);
    out.key("shutter", camera.shutter);
    out.key("slice_thickness", camera.slice_thickness);
    out.key("slices", std::int64_t{camera.slices});
}

}  // namespace

void load_camera(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    const auto* table = root.table("camera");
    if (table == nullptr) {
        write_camera(scene.camera, out);
        return;
    }
    TableReader reader(*table, origin, "[camera]");
    read_camera(reader, scene.camera);
    write_camera(scene.camera, out);
    load_keys(reader, origin, scene, out);
    reader.finish();
    if (scene.camera_keys.empty()) require_frame(reader, scene.camera);
}

void require_view(const Scene& scene, const Origin& origin) {
    if (scene.camera_keys.empty()) return;
    for (int frame = 0, count = frame_count(scene); frame < count; ++frame) {
        const double time = frame_instant(scene, frame).time;
        try {
            const render::Camera camera(camera_at(scene.camera, scene.camera_keys, time), 1, 1);
        } catch (const InputError& error) {
            throw InputError(
                fmt::format("{}: frame {} at {} s: {}; move a [[camera.key]] or add "
                            "one between",
                            origin.place, frame, time, error.what()));
        }
    }
}

}  // namespace tesserae::scenes
