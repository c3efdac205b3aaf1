// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tesserae::scenes {

/// How far a film is.
struct FilmStatus {
    std::string scene;
    int frames = 0;                            ///< wanted
    std::vector<int> missing, other, invalid;  ///< other: of another scene or version
    std::optional<int> running, queued;        ///< jobs' tasks; none: Slurm does not answer
    std::string slurm;                         ///< why it does not
    std::optional<double> frames_per_second;   ///< lately
    std::optional<double> seconds_left;        ///< at that rate
    std::string command;                       ///< that finishes the rest here; empty: complete
    std::string submit;  ///< the same by Slurm; empty: complete, or never submitted

    bool is_complete() const { return missing.empty() && other.empty() && invalid.empty(); }
};

/// Looks at every frame of a film's folder.
/// @throws InputError   the folder holds no film, with the reason
FilmStatus film_status(const std::filesystem::path& folder);

/// As a person reads it.
std::string status_text(const FilmStatus& status, const std::filesystem::path& folder);

}  // namespace tesserae::scenes
