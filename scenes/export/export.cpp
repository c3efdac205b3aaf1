// SPDX-License-Identifier: Apache-2.0
#include "scenes/export/export.hpp"

#include <tbb/parallel_for.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "scenes/export/camera_json.hpp"
#include "scenes/export/mesh_file.hpp"
#include "scenes/export/section.hpp"
#include "scenes/film/film.hpp"
#include "scenes/film/film_camera.hpp"
#include "scenes/film/poses.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/hash.hpp"
#include "scenes/load/versions.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// Beyond every body by this: a floor's horizon in a picture of 1000 lines is then a pixel away
/// from where it should be, at most.
constexpr double kBeyondBodies = 1000;

render::Camera camera_of_frame(const Scene& scene, FilmCamera& camera, int frame) {
    return render::Camera(camera.at(frame).value(), scene.render.width, scene.render.height);
}

/// Of the text, the law of motion, and what only meshes depend on.
std::string export_hash(const Scene& scene, const ExportSettings& settings, double extent,
                        int motion_version) {
    return hex_hash(fmt::format("{} export {} format {} tolerance {} extent {}",
                                frame_hash(scene.effective, 1, motion_version), kExportVersion,
                                static_cast<int>(settings.format),
                                toml_text(settings.tolerance.value_or(0)), toml_text(extent)));
}

/// A file of this name and hash is there.
bool is_exported(const fs::path& file, const std::string& hash, bool overwrite) {
    if (!fs::exists(file)) return false;
    if (has_mesh_hash(file, hash)) return true;
    if (overwrite) return false;
    throw InputError(fmt::format(
        "{}: is of another scene, or was made with other options; choose another folder, or "
        "--overwrite",
        file.string()));
}

/// Sections of all visible bodies that the slice meets, ascending.
std::vector<BodyMesh> meshes_of(const Scene& scene, const Bodies& bodies, const Sections& sections,
                                const SliceFrame& frame) {
    std::vector<Mesh> each(bodies.size());
    tbb::parallel_for(std::size_t{0}, each.size(), [&](std::size_t i) {
        if (stop_requested()) throw Stopped();  // very many bodies take seconds
        const auto id = static_cast<BodyId>(i);
        if (scene.appearance[bodies.type[id]].visible) each[i] = sections.of(bodies, id, frame);
    });
    std::vector<BodyMesh> meshes;
    for (std::size_t i = 0; i < each.size(); ++i)
        if (!each[i].is_empty()) meshes.push_back({static_cast<BodyId>(i), std::move(each[i])});
    return meshes;
}

fs::path mesh_file(const Scene& scene, int frame, MeshFormat format) {
    return fmt::format("{}.{:04}.{}", scene.name, frame,
                       format == MeshFormat::kPly ? "ply" : "vtp");
}

/// ParaView's list of frames, of those that the folder holds; names need no escapes, since a
/// scene's name has letters, digits and . _ - only.
void write_list(const Scene& scene, const fs::path& folder, const std::string& hash) {
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n<!-- tesserae {} -->\n<VTKFile type=\"Collection\" "
        "version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
        hash);
    for (int frame = 0; frame < frame_count(scene); ++frame) {
        const fs::path file = mesh_file(scene, frame, MeshFormat::kVtk);
        if (fs::exists(folder / file))
            text += fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n",
                                frame_instant(scene, frame).time, file.string());
    }
    write_file(folder / (scene.name + ".pvd"), text + "</Collection>\n</VTKFile>\n");
}

}  // namespace

double usual_extent(const Scene& scene) {
    const Vec4 eye = scene.camera_path().at(0).position;
    double farthest = 1;
    for (BodyId id = 0; id < scene.bodies.size(); ++id) {
        const Shape& shape = scene.bodies.type_of(id).shape;
        if (is_bounded(shape))
            farthest = std::max(farthest,
                                (scene.bodies.position[id] - eye).norm() + bounding_radius(shape));
    }
    return std::exp2(std::ceil(std::log2(kBeyondBodies * farthest)));
}

ExportReport export_meshes(Scene scene, const std::vector<int>& frames, const fs::path& trajectory,
                           const fs::path& folder, const ExportSettings& settings, bool overwrite,
                           bool quiet) {
    const auto begin = std::chrono::steady_clock::now();
    // A frame is an instant here: steps beside it are not asked for.
    scene.render.channels.motion = false;
    scene.camera.shutter = 0;
    Poses poses(scene, frames, trajectory);
    FilmCamera camera(scene, &poses);
    const double extent = settings.extent.value_or(usual_extent(scene));
    const std::string hash = export_hash(scene, settings, extent, poses.motion_version());
    create_folder(folder);
    const fs::path camera_file = folder / "camera.json";
    is_exported(camera_file, hash, overwrite);
    write_file(camera_file, camera_json(scene, camera, hash));

    const Sections sections(scene.bodies, {settings.tolerance.value_or(0), extent});
    const render::Camera first = camera_of_frame(scene, camera, 0);
    ExportReport report;
    Progress progress("exporting", "frames", frames.size(), quiet);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (stop_requested()) throw Stopped();
        const fs::path file = folder / mesh_file(scene, frames[i], settings.format);
        if (i == 0) report.first_to_open = file;
        if (is_exported(file, hash, overwrite)) {
            progress.start_at(++report.kept);
            continue;
        }
        const FrameInstant instant = frame_instant(scene, frames[i]);
        const SliceFrame frame(camera_of_frame(scene, camera, frames[i]), first);
        const auto meshes = meshes_of(scene, poses.at(instant), sections, frame);
        const MeshFileInfo info{scene.name, hash, frames[i], instant.time, scene.names};
        const MeshCounts counts(meshes, file);
        (settings.format == MeshFormat::kPly ? write_ply : write_vtp)(file, info, meshes);
        ++report.written;
        report.bodies += meshes.size();
        report.vertices += counts.vertices, report.polygons += counts.faces;
        progress.update(i + 1);
    }
    if (settings.format == MeshFormat::kVtk) {
        write_list(scene, folder, hash);
        report.first_to_open = folder / (scene.name + ".pvd");
    }
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return report;
}

}  // namespace tesserae::scenes
