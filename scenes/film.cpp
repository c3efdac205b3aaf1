#include "scenes/film.hpp"

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.hpp"
#include "render/copied_frame.hpp"
#include "render/file/file_writer.hpp"
#include "render/file/image_info.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/poses.hpp"
#include "scenes/progress.hpp"
#include "scenes/signals.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSceneFile = "scene.toml";

std::string read_text(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// A whole frame of this scene is there already.
bool is_done(const Scene& scene, const fs::path& exr, const fs::path& png, bool overwrite) {
    if (!fs::exists(exr)) return false;
    std::string hash;
    try {
        hash = render::read_image_info(exr).scene_hash;
    } catch (const InputError&) {
        if (!overwrite) throw;
    }
    if (hash != scene.hash && !overwrite)
        throw InputError(
            fmt::format("{}: is a frame of another scene (hash {}, here {}); choose "
                        "another folder, or --overwrite",
                        exr.string(), hash, scene.hash));
    return hash == scene.hash && fs::exists(png);
}

/// The bodies' names by object id (body number + 1), as a JSON object: "first-last" for lattices.
std::string id_names(const Scene& scene) {
    // Enough for a person and for mattes; a header is read whole by every viewer.
    constexpr std::size_t kMaxNames = 10'000;
    auto names = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < std::min(scene.names.size(), kMaxNames); ++i) {
        const NamedBodies& n = scene.names[i];
        const std::string ids = n.count > 1 ? fmt::format("{}-{}", n.first + 1, n.first + n.count)
                                            : fmt::format("{}", n.first + 1);
        names[ids] = n.name;
    }
    return names.dump();
}

/// A finished frame and what decided its pixels. The next frame may look the same: a still camera
/// over a scene at rest.
struct Shown {
    std::vector<Vec4> position;
    std::vector<Rotor> rotor;
    render::CameraDescription camera;
    render::FrameFiles files;

    bool is_same_as(const Scene& scene, const Bodies& bodies,
                    const render::CameraDescription& other) const {
        if (position.empty() || !(camera == other)) return false;
        for (BodyId id = 0; id < bodies.size(); ++id)
            if (scene.appearance[bodies.type[id]].visible &&
                (position[id] != bodies.position[id] || !(rotor[id] == bodies.rotor[id])))
                return false;
        return true;
    }
};

}  // namespace

void create_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw RunError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
}

void require_folder_of(const Scene& scene, const fs::path& folder, bool overwrite) {
    const fs::path file = folder / kSceneFile;
    if (overwrite || !fs::exists(file)) return;
    const std::string other = read_text(file);
    if (other != scene.effective)
        throw InputError(fmt::format(
            "{}: holds frames of another scene: {}; choose another folder, or --overwrite",
            folder.string(), first_difference(other, scene.effective)));
}

std::string invalid_samples_text(const render::FrameStats& stats, const Scene& scene, int frame) {
    if (stats.invalid_samples == 0) return {};
    const render::SampleNumber& s = stats.first_invalid;
    return fmt::format(
        "{}: frame {}: {} samples were infinite or no number and count as black; the first is "
        "sample "
        "{} of pixel {},{}; to render it alone: tesserae render {} --frames {} --crop {},{},{},{} "
        "-o DIR",
        scene.file.string(), frame, stats.invalid_samples, s.sample, s.x, s.y, scene.file.string(),
        frame, s.x, s.y, s.x + 1, s.y + 1);
}

FilmReport film(const Scene& scene, const std::vector<int>& frames, const fs::path& trajectory,
                const fs::path& folder, bool overwrite, bool quiet) {
    const auto begin = std::chrono::steady_clock::now();
    require_folder_of(scene, folder, overwrite);
    Poses poses(scene, frames, trajectory);

    FilmReport report;
    report.frames = folder / "frames";
    create_folder(report.frames);
    create_folder(folder / "preview");
    if (!fs::exists(folder / kSceneFile) || overwrite)
        render::write_file(folder / kSceneFile, scene.effective);

    render::FrameInfo info;
    info.scene_name = scene.name;
    info.scene_hash = scene.hash;
    info.program_version = TESSERAE_VERSION;
    info.id_names = id_names(scene);

    Shown shown;
    Progress progress("rendering", "frames", frames.size(), quiet);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        info.frame = frames[i];
        info.time = frame_instant(scene, frames[i]).time;
        const std::string stem = fmt::format("{}.{:04}", scene.name, info.frame);
        const render::FrameFiles files = {report.frames / (stem + ".exr"),
                                          folder / "preview" / (stem + ".png")};
        report.preview = files.preview;
        if (is_done(scene, files.exr, files.preview, overwrite)) {
            progress.start_at(++report.kept);
            continue;
        }
        const Bodies& bodies = poses.at(info.frame);
        const render::CameraDescription camera =
            camera_at(scene.camera, scene.camera_keys, info.time);
        const render::Picture picture = {bodies, scene.appearance, scene.materials,
                                         camera, scene.lights,     scene.render};
        if (shown.is_same_as(scene, bodies, camera)) {
            render::copy_frame(shown.files, picture, info, files);
            ++report.copied;
        } else {
            const render::FrameStats stats =
                render::render_frame(picture, info, files.exr, files.preview, stop_requested());
            const std::string invalid = invalid_samples_text(stats, scene, info.frame);
            if (!invalid.empty()) fmt::print(stderr, "tesserae: {}\n", invalid);
            report.stats += stats;
            ++report.rendered;
            shown = {bodies.position, bodies.rotor, camera, files};
        }
        progress.update(i + 1);
    }
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return report;
}

}  // namespace tesserae::scenes
