// SPDX-License-Identifier: Apache-2.0
#include "scenes/export/camera_json.hpp"

#include <nlohmann/json.hpp>

#include "scenes/export/slice_frame.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

using OrderedJson = nlohmann::ordered_json;

template <class Vector>
OrderedJson json_list(const Vector& v) {
    OrderedJson list = OrderedJson::array();
    // No -0, which reads as a mistake.
    for (const double number : v) list.push_back(number + 0.0);
    return list;
}

}  // namespace

std::string camera_json(const Scene& scene, FilmCamera& film_camera, const std::string& hash) {
    const int width = scene.render.width, height = scene.render.height;
    const render::Camera first(film_camera.at(0).value(), width, height);
    OrderedJson json = {{"tesserae", hash},
                        {"axes",
                         {{"origin", json_list(first.origin())},
                          {"x", json_list(first.right())},
                          {"y", json_list(first.forward())},
                          {"z", json_list(first.up())},
                          {"fourth", json_list(first.fourth())}}},
                        {"size", {width, height}},
                        {"frames", OrderedJson::array()}};
    for (int frame = 0; frame < frame_count(scene); ++frame) {
        const std::optional<render::CameraDescription> at = film_camera.at(frame);
        if (!at) continue;
        const render::Camera camera(*at, width, height);
        const SliceFrame slice(camera, first);
        json["frames"].push_back(
            {{"frame", frame},
             {"time", frame_instant(scene, frame).time},
             {"position", json_list(slice.point_to_film(Vec3::Zero()))},
             {"right", json_list(slice.direction_to_film(Vec3::UnitX()))},
             {"forward", json_list(slice.direction_to_film(Vec3::UnitY()))},
             {"up", json_list(slice.direction_to_film(Vec3::UnitZ()))},
             {"field_of_view", at->field_of_view},
             {"height", first.fourth().dot(camera.origin() - first.origin()) + 0.0}});
    }
    return json.dump(1) + "\n";
}

}  // namespace tesserae::scenes
