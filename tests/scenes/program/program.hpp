// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/content.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes::testing {

/// What a run of the program `tesserae` left.
struct Outcome {
    int status = -1;       ///< exit status; 1000 + signal if a signal ended it
    int milliseconds = 0;  ///< how long it took
    std::string out, err;
};

/// While one lives `tesserae run` finds ffmpeg, which takes longer than all else in a small run.
class WithFilms {
  public:
    WithFilms();
    ~WithFilms();
    WithFilms(const WithFilms&) = delete;
    WithFilms& operator=(const WithFilms&) = delete;
};

/// Runs the program to its end; sends `signal` after `milliseconds` if that is not 0.
Outcome tesserae(const std::vector<std::string>& arguments, int signal = 0, int milliseconds = 0);

/// Whether the shell finds another program.
bool is_installed(const std::string& program);

class Folder : public tesserae::testing::TemporaryFolder {
  public:
    using TemporaryFolder::TemporaryFolder;

    std::string file(const std::string& name) const { return (*this / name).string(); }
    /// Writes a text file into it and returns its path.
    std::string write(const std::string& name, const std::string& text) const;
};

using tesserae::testing::content;

/// All files below a folder, relative to it, ascending.
std::vector<std::string> files_below(const std::filesystem::path& folder);

/// A small scene that moves: 27 spheres of two sizes fall onto a plane, at 60 steps a second.
std::string small_scene(double duration);

}  // namespace tesserae::scenes::testing
