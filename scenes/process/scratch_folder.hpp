// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace tesserae::scenes {

/// A folder for files of this process alone, below that for temporary files; gone in the end. Its
/// name cannot be foreseen, and only its owner can look into it. What killed processes have left of
/// the same kind is removed.
class ScratchFolder {
  public:
    /// @param prefix   of the name, for example "tesserae-plan-"
    /// @throws RunError   it cannot be made
    explicit ScratchFolder(const std::string& prefix);
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
    int lock_ = -1;  ///< the folder itself, locked while its process lives
};

}  // namespace tesserae::scenes
