// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "scenes/load/load.hpp"

namespace tesserae::scenes {

/// A bit of everything.
inline const std::string kRich = R"(
[scene]
name = "rich"
[physics]
gravity = [0, -9.81, 0, 0.1]
duration = 3
integrator = "midpoint"
seed = 9223372036854775807
[[material]]
name = "dots \" \\ \t ä"
albedo = [0.1, 0.25, 1]
pattern = "checker"
[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 3, 0, 4]
offset = -0.1
[[body]]
shape = "hypercapsule"
radius = 0.3
height = 0
position = [1, 2, 3, 4]
rotation = { xy = 30, zw = 15 }
velocity = [1e-7, 0, 0, -0.1]
angular_velocity = { xw = 2.0 }
density = 123.456
friction = 0.1
restitution = 0.9
fixed = ["rotation", "position"]
material = "dots \" \\ \t ä"
visible = false
[[lattice]]
name = "rain"
shape = "hyperbox"
size = [0.1, 0.2, 0.3, 0.4]
position = [0, 5, 0, 0]
count = [2, 3, 4, 5]
spacing = [1, 2, 3, 4]
jitter = 0.05
seed = 7
[[material]]
name = "lens"
kind = "glass"
ior = 1.25
roughness = 0.5
emission = [0, 0.5, 2]
[camera]
position = [0, 1, -5, 2]
up = [1, 1, 0, 0]
[[light]]
type = "sun"
direction = [1, -3, 0.5, 0.25]
strength = 2
angle = 0
[[light]]
type = "sky"
color = [0.1, 0.2, 0.3]
[[light]]
type = "sky"
strength = 0.5
[[light]]
type = "point"
position = [1, 2, 3, 4]
color = [1, 0.5, 0]
strength = 40
[[light]]
type = "sphere"
position = [-1, 2, -3, 4]
radius = 0.25
strength = 3
[render]
integrator = "path"
bounces = 7
size = [640, 360]
samples = 4
channels = ["position", "color"]
exposure = -1.5
)";

/// A file that lives as long as the object, called test.toml in a folder of its own.
class SceneFile {
  public:
    explicit SceneFile(std::string_view text) {
        std::string folder = (std::filesystem::temp_directory_path() / "load_test.XXXXXX").string();
        if (::mkdtemp(folder.data()) == nullptr) throw std::runtime_error("mkdtemp");
        folder_ = folder;
        std::ofstream(path(), std::ios::binary) << text;
    }
    ~SceneFile() { std::filesystem::remove_all(folder_); }
    SceneFile(const SceneFile&) = delete;
    SceneFile& operator=(const SceneFile&) = delete;

    std::filesystem::path folder() const { return folder_; }
    std::filesystem::path path() const { return folder_ / "test.toml"; }

  private:
    std::filesystem::path folder_;
};

inline Scene load_text(std::string_view text, const std::vector<std::string>& sets = {}) {
    const SceneFile file(text);
    return load_scene(file.path(), sets);
}

/// The message of the InputError that loading ends with, without the folder; empty if it succeeds.
inline std::string error_of(std::string_view text, const std::vector<std::string>& sets = {}) {
    const SceneFile file(text);
    try {
        load_scene(file.path(), sets);
    } catch (const InputError& error) {
        std::string message = error.what();
        const std::string folder = file.folder().string() + "/";
        if (const auto at = message.find(folder); at != std::string::npos)
            message.erase(at, folder.size());
        return message;
    }
    return {};
}

}  // namespace tesserae::scenes
