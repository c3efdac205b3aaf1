// SPDX-License-Identifier: Apache-2.0
#include "scenes/export/mesh_file.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"

namespace tesserae::scenes {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie");

/// Most corners of a polygon in a PLY file: their number is a byte, as most programs expect.
constexpr std::size_t kMostCorners = 255;

template <class T>
void append_number(std::string& bytes, T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
}

/// A polygon as a fan of convex ones of few enough corners.
template <class Visit>
void for_each_piece(std::span<const std::uint32_t> face, Visit&& visit) {
    std::vector<std::uint32_t> piece;
    for (std::size_t begin = 1; begin + 1 < face.size(); begin += kMostCorners - 2) {
        const std::size_t count = std::min(kMostCorners - 1, face.size() - begin);
        piece.assign(1, face[0]);
        piece.insert(piece.end(), face.begin() + static_cast<std::ptrdiff_t>(begin),
                     face.begin() + static_cast<std::ptrdiff_t>(begin + count));
        visit(piece);
    }
}

std::uint64_t piece_count(std::span<const BodyMesh> meshes) {
    std::uint64_t pieces = 0;
    for (const BodyMesh& m : meshes)
        for (std::size_t f = 0; f < m.mesh.faces(); ++f)
            pieces += (m.mesh.face(f).size() - 2 + kMostCorners - 3) / (kMostCorners - 2);
    return pieces;
}

std::string ply_header(const MeshFileInfo& info, std::span<const BodyMesh> meshes,
                       std::uint64_t vertices) {
    std::string text = fmt::format(
        "ply\nformat binary_little_endian 1.0\n"
        "comment tesserae {}\ncomment scene {}, frame {}, time {} s\n"
        "comment x right, y forward, z up of the first frame's camera, which is at 0; lengths in "
        "m\n",
        info.hash, info.scene_name, info.frame, info.time);
    for (const NamedIds& n : names_of(meshes, info.names))
        text += n.first == n.last
                    ? fmt::format("comment body {} \"{}\"\n", n.first, n.name)
                    : fmt::format("comment body {}-{} \"{}\"\n", n.first, n.last, n.name);
    text += fmt::format(
        "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "property uint body\nelement face {}\nproperty list uchar int vertex_indices\n"
        "property uint body\nend_header\n",
        vertices, piece_count(meshes));
    return text;
}

}  // namespace

MeshCounts::MeshCounts(std::span<const BodyMesh> meshes, const std::filesystem::path& file) {
    for (const BodyMesh& m : meshes) {
        vertices += m.mesh.vertices.size();
        faces += m.mesh.faces();
        corners += m.mesh.corners.size();
    }
    if (std::max(vertices, corners) > std::numeric_limits<std::int32_t>::max())
        throw RunError(
            fmt::format("{}: {} vertices, {} corners of polygons: more than the format "
                        "can count; a larger --tolerance makes fewer",
                        file.string(), vertices, corners));
}

std::vector<NamedIds> names_of(std::span<const BodyMesh> meshes,
                               std::span<const NamedBodies> names) {
    std::vector<NamedIds> found;
    std::size_t m = 0;
    for (const NamedBodies& n : names) {
        while (m < meshes.size() && meshes[m].body < n.first) ++m;
        if (m == meshes.size()) break;
        if (meshes[m].body - n.first >= n.count) continue;
        // As JSON, so that nothing in a name ends a line; without JSON's quotation marks.
        const std::string quoted =
            nlohmann::json(n.name.substr(0, kMostNameBytes))
                .dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
        found.push_back({std::uint64_t{n.first} + 1, std::uint64_t{n.first} + n.count,
                         quoted.substr(1, quoted.size() - 2)});
    }
    return found;
}

void write_ply(const std::filesystem::path& file, const MeshFileInfo& info,
               std::span<const BodyMesh> meshes) {
    const MeshCounts counts(meshes, file);
    FileWriter writer(file);
    const auto write = [&](std::string& bytes) {
        writer.write(bytes.data(), bytes.size());
        bytes.clear();
    };
    std::string bytes = ply_header(info, meshes, counts.vertices);
    write(bytes);
    for (const BodyMesh& m : meshes) {
        for (const Vec3& v : m.mesh.vertices) {
            for (int axis = 0; axis < 3; ++axis) append_number(bytes, static_cast<float>(v[axis]));
            append_number(bytes, object_id(m.body));
        }
        write(bytes);
    }
    std::uint32_t first = 0;
    for (const BodyMesh& m : meshes) {
        for (std::size_t f = 0; f < m.mesh.faces(); ++f)
            for_each_piece(m.mesh.face(f), [&](const std::vector<std::uint32_t>& piece) {
                append_number(bytes, static_cast<std::uint8_t>(piece.size()));
                for (const std::uint32_t corner : piece) append_number(bytes, first + corner);
                append_number(bytes, object_id(m.body));
            });
        write(bytes);
        first += static_cast<std::uint32_t>(m.mesh.vertices.size());
    }
    writer.finish();
}

bool has_mesh_hash(const std::filesystem::path& file, const std::string& hash) {
    // Within the first lines of either format.
    std::string begin(400, '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    if (in.bad())
        throw InputError(
            fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
    return begin.find(hash) != std::string::npos;
}

}  // namespace tesserae::scenes
