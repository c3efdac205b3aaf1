// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/export/mesh.hpp"
#include "scenes/named_bodies.hpp"

namespace tesserae::scenes {

/// What a file of meshes says of itself.
struct MeshFileInfo {
    std::string scene_name;
    std::string hash;  ///< of all that decides what is in it
    int frame = 0;
    double time = 0;  ///< [s]
    std::span<const NamedBodies> names;
};

/// What a body is called in a file: its number + 1, as in the channel objectid of a picture.
inline std::uint32_t object_id(BodyId body) { return static_cast<std::uint32_t>(body) + 1; }

/// Sums over a frame's bodies.
struct MeshCounts {
    std::uint64_t vertices = 0, faces = 0, corners = 0;

    /// @throws RunError   more than the formats' indices of 31 bits can count; names the file
    MeshCounts(std::span<const BodyMesh> meshes, const std::filesystem::path& file);
};

/// Bodies' names that occur in a frame, as runs of ids (body number + 1).
struct NamedIds {
    std::uint64_t first, last;
    std::string
        name;  ///< printable ASCII without line ends, as in JSON; at most kMostNameBytes of it
};
constexpr std::size_t kMostNameBytes = 200;
std::vector<NamedIds> names_of(std::span<const BodyMesh> meshes,
                               std::span<const NamedBodies> names);

/// Stanford's PLY, binary, little-endian: coordinates as float, polygons of at most 255 corners
/// (larger ones are cut), `body` of every vertex and polygon: the body's number + 1. Names are in
/// comments.
void write_ply(const std::filesystem::path& file, const MeshFileInfo& info,
               std::span<const BodyMesh> meshes);

/// VTK's XML PolyData: coordinates as Float32, `body` of every polygon, and names as field data.
void write_vtp(const std::filesystem::path& file, const MeshFileInfo& info,
               std::span<const BodyMesh> meshes);

/// What can be told of a file from its beginning: that it was written with this hash.
bool has_mesh_hash(const std::filesystem::path& file, const std::string& hash);

}  // namespace tesserae::scenes
