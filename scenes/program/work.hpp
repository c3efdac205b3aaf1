#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scenes/load/load.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/program/command_line.hpp"

namespace tesserae::scenes {

/// What commands on a scene share: the checked scene and its plan.
struct Work {
    explicit Work(const CommandLine& line)
        : scene(load_scene(line.file, line.sets)), plan(make_plan(scene, line.threads)) {}

    Scene scene;
    Plan plan;
};

/// Prints the JSON object or the text that ends a command.
void print_result(const CommandLine& line, const nlohmann::ordered_json& json,
                  const std::string& text);

}  // namespace tesserae::scenes
