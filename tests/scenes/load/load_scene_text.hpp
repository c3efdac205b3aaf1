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
