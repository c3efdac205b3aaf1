// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "scenes/export/mesh_file.hpp"
#include "scenes/process/base64.hpp"

namespace tesserae::scenes {
namespace {

/// A data array's numbers on their way into the file: base64 in pieces that are whole groups of
/// three bytes, after the length that VTK wants first.
class VtkArray {
  public:
    VtkArray(FileWriter& writer, const std::string& attributes, std::uint64_t bytes)
        : writer_(writer) {
        put(fmt::format("<DataArray {} format=\"binary\">", attributes));
        add(bytes);
    }
    template <class T>
    void add(T number) {
        char raw[sizeof number];
        std::memcpy(raw, &number, sizeof number);
        bytes_.append(raw, sizeof number);
        if (bytes_.size() >= kPiece) flush(bytes_.size() / 3 * 3);
    }
    void end() {
        flush(bytes_.size());
        put("</DataArray>\n");
    }

  private:
    static constexpr std::size_t kPiece = 48 * 1024;

    void put(const std::string& text) { writer_.write(text.data(), text.size()); }
    void flush(std::size_t count) {
        put(base64(std::string_view(bytes_).substr(0, count)));
        bytes_.erase(0, count);
    }

    FileWriter& writer_;
    std::string bytes_;
};

/// Names as VTK writes them: the characters' numbers, 0 after each name.
std::string vtk_names(const std::vector<NamedIds>& names) {
    std::string first, last, text;
    for (const NamedIds& n : names) {
        first += fmt::format("{} ", n.first);
        last += fmt::format("{} ", n.last);
        for (const char c : n.name) text += fmt::format("{} ", static_cast<int>(c));
        text += "0 ";
    }
    const auto ids = [&](const char* name, const std::string& list) {
        return fmt::format(
            "<DataArray type=\"UInt32\" Name=\"{}\" NumberOfTuples=\"{}\" format=\"ascii\">"
            "{}</DataArray>\n",
            name, names.size(), list);
    };
    return ids("first_body", first) + ids("last_body", last) +
           fmt::format(
               "<Array type=\"String\" Name=\"body_name\" NumberOfTuples=\"{}\" format=\"ascii\">"
               "{}</Array>\n",
               names.size(), text);
}

void write_polygons(FileWriter& writer, std::span<const BodyMesh> meshes, std::uint64_t corners,
                    std::uint64_t faces) {
    VtkArray connectivity(writer, "type=\"Int32\" Name=\"connectivity\"", 4 * corners);
    std::int32_t first = 0;
    for (const BodyMesh& m : meshes) {
        for (const std::uint32_t corner : m.mesh.corners)
            connectivity.add(first + static_cast<std::int32_t>(corner));
        first += static_cast<std::int32_t>(m.mesh.vertices.size());
    }
    connectivity.end();
    VtkArray offsets(writer, "type=\"Int32\" Name=\"offsets\"", 4 * faces);
    first = 0;
    for (const BodyMesh& m : meshes) {
        for (const std::uint32_t end : m.mesh.face_end)
            offsets.add(first + static_cast<std::int32_t>(end));
        first += static_cast<std::int32_t>(m.mesh.corners.size());
    }
    offsets.end();
}

}  // namespace

void write_vtp(const std::filesystem::path& file, const MeshFileInfo& info,
               std::span<const BodyMesh> meshes) {
    const MeshCounts counts(meshes, file);
    FileWriter writer(file);
    const auto put = [&](const std::string& text) { writer.write(text.data(), text.size()); };
    put(fmt::format(
        "<?xml version=\"1.0\"?>\n<!-- tesserae {}: x right, y forward, z up of the first frame's "
        "camera, which is at 0; lengths in m -->\n<VTKFile type=\"PolyData\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n"
        "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}"
        "</DataArray>\n",
        info.hash, info.time));
    put(vtk_names(names_of(meshes, info.names)));
    put(
        fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" "
                    "NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n"
                    "<CellData Scalars=\"body\">\n",
                    counts.vertices, counts.faces));
    VtkArray bodies(writer, "type=\"UInt32\" Name=\"body\"", 4 * counts.faces);
    for (const BodyMesh& m : meshes)
        for (std::size_t f = 0; f < m.mesh.faces(); ++f) bodies.add(object_id(m.body));
    bodies.end();
    put("</CellData>\n<Points>\n");
    VtkArray points(writer, "type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\"",
                    12 * counts.vertices);
    for (const BodyMesh& m : meshes)
        for (const Vec3& v : m.mesh.vertices)
            for (int axis = 0; axis < 3; ++axis) points.add(static_cast<float>(v[axis]));
    points.end();
    put("</Points>\n<Polys>\n");
    write_polygons(writer, meshes, counts.corners, counts.faces);
    put("</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n");
    writer.finish();
}

}  // namespace tesserae::scenes
