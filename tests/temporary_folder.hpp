// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace tesserae::testing {

/// An empty folder of a test's own, removed at the end with all that is in it.
class TemporaryFolder {
  public:
    /// @param name   a part of the folder's name, for whoever looks at what a crash left
    explicit TemporaryFolder(const std::string& name) {
        const auto pattern = std::filesystem::temp_directory_path() / ("tesserae-" + name);
        std::string made = pattern.string() + "-XXXXXX";
        if (::mkdtemp(made.data()) == nullptr) throw std::runtime_error("no folder " + made);
        path_ = made;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

}  // namespace tesserae::testing
