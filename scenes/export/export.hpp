// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace tesserae::scenes {

enum class MeshFormat { kPly, kVtk };

struct ExportSettings {
    MeshFormat format = MeshFormat::kPly;
    /// How far a round body's mesh and its surface may be apart [m]; none: a thousandth of the
    /// body's diameter.
    std::optional<double> tolerance;
    /// Half the side of the cube about the first frame's camera in which planes end [m]; none:
    /// usual_extent().
    std::optional<double> extent;
};

/// Raised when the same scene gives other meshes.
constexpr int kExportVersion = 1;

struct ExportReport {
    int written = 0, kept = 0;  ///< frames
    std::uint64_t bodies = 0;   ///< meshes of all frames that were written
    std::uint64_t vertices = 0, polygons = 0;
    double seconds = 0;
    std::filesystem::path first_to_open;  ///< the first frame, or the list of all
};

/// Where planes end [m], so far that a picture shows the same horizon: more than a thousand times
/// as far from the first frame's camera as any body is at the start, a power of two.
double usual_extent(const Scene& scene);

/// Writes the slice's bodies of every frame as meshes into folder/NAME.0000.ply or .vtp, and for
/// VTK the list of all frames there with their times, NAME.pvd. Beside them camera.json: the
/// camera's path for all frames of the scene (camera_json.hpp). Frames that are there already are
/// kept. Runs on the threads of the caller's parallel::Threads; the bytes do not depend on their
/// number.
///
/// A frame's meshes are the sections (section.hpp) by the slice of its camera at its time, the
/// middle one of a thick slice or of a sheet, of all visible bodies, also of those behind the
/// camera. Their coordinates are those of SliceFrame. All of a frame are in memory at once, some 60
/// bytes a triangle.
/// @throws InputError   the folder holds another scene's files and not `overwrite`; the trajectory
///                      is of another motion or lacks steps
/// @throws RunError     a file cannot be written
/// @throws Stopped      after a signal; finished frames are kept
ExportReport export_meshes(Scene scene, const std::vector<int>& frames,
                           const std::filesystem::path& trajectory,
                           const std::filesystem::path& folder, const ExportSettings& settings,
                           bool overwrite, bool quiet);

}  // namespace tesserae::scenes
