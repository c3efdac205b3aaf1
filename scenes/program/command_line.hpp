// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/frame.hpp"
#include "scenes/farm/request.hpp"

namespace tesserae::scenes {

/// What the user typed, checked as far as it can be without the scene.
struct CommandLine {
    std::string command;         ///< "run", ..., or "--version"; empty: only help was asked for
    std::filesystem::path file;  ///< the scene, info's file, or film's folder
    std::vector<std::filesystem::path> files;  ///< hash's, or diff's two
    std::filesystem::path output;
    std::filesystem::path trajectory;
    std::filesystem::path trace;  ///< empty: none
    std::string frames;
    std::uint64_t store_every = 0;  ///< 0: the steps that the frames need
    std::string generator;
    std::string topic;                        ///< of the reference; empty: all of it
    std::string shell;                        ///< of the reference's completion
    std::uint64_t bodies = 0;                 ///< to generate
    std::string format;                       ///< export's: "ply" or "vtk"
    std::optional<double> tolerance, extent;  ///< export's [m]
    std::optional<double> near_slice;         ///< view's [m]
    std::vector<std::string> joints;          ///< plot's: their names
    int threads = 0;
    FarmRequest farm;                        ///< of submit
    std::optional<render::FramePart> tiles;  ///< of render: a part of each frame
    bool quiet = false, json = false, overwrite = false, draft = false;
    /// "key=value" entries for load_scene: --set in order, then the options that override a key.
    std::vector<std::string> sets;
};

/// Parses and checks the command line; prints help itself.
/// @throws InputError   with the reason and where to find help
CommandLine parse_command_line(int argc, const char* const* argv);

}  // namespace tesserae::scenes
