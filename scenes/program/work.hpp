// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scenes/load/load.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/program/command_line.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {

/// What commands on a scene share: the checked scene and its plan.
struct Work {
    explicit Work(const CommandLine& line) : Work(load_scene(line.file, line.sets), line) {}
    Work(Scene of, const CommandLine& line)
        : scene(std::move(of)), plan(make_plan(scene, line.threads)) {}

    Scene scene;
    Plan plan;
};

/// The frames that --frames names; empty where it was not given.
/// @throws InputError   as parse_frames()
inline std::vector<int> asked_frames(const CommandLine& line, const Scene& scene) {
    return line.frames.empty() ? std::vector<int>() : parse_frames(line.frames, frame_count(scene));
}

/// Prints the JSON object or the text that ends a command.
void print_result(const CommandLine& line, const nlohmann::ordered_json& json,
                  const std::string& text);

}  // namespace tesserae::scenes
