#include "scenes/film/film.hpp"

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "render/file/copied_frame.hpp"
#include "render/picture_needs.hpp"
#include "scenes/farm/join.hpp"
#include "scenes/film/coast.hpp"
#include "scenes/film/film_camera.hpp"
#include "scenes/film/mattes.hpp"
#include "scenes/film/poses.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/process/version.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

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

/// What of a scene changes from frame to frame.
struct Moment : render::Neighbour {
    bool looks_like(const Moment& other, const Scene& scene) const {
        if (!(camera == other.camera)) return false;
        for (BodyId id = 0; id < bodies.size(); ++id)
            if (scene.appearance[bodies.type[id]].visible &&
                (bodies.position[id] != other.bodies.position[id] ||
                 !(bodies.rotor[id] == other.bodies.rotor[id])))
                return false;
        return true;
    }
};

/// What a frame shows: the shutter opens and, if it is open for any time, closes.
struct Exposure {
    Moment opening;
    std::vector<render::ShutterMoment> path;
    std::optional<Moment> after, before;  ///< the frames beside, for vectors of motion

    Exposure(const Scene& scene, FilmCamera& camera, Poses& poses, int frame)
        : opening(moment(camera, poses, frame_instant(scene, frame))) {
        if (scene.render.channels.motion) {
            after = neighbour(scene, camera, poses, frame, 1);
            before = neighbour(scene, camera, poses, frame, -1);
        }
        if (scene.camera.shutter > 0) open_shutter(scene, camera, poses, frame);
    }

    /// But for what is random in the picture.
    bool looks_like(const Exposure& other, const Scene& scene) const {
        const auto like = [&](const std::optional<Moment>& a, const std::optional<Moment>& b) {
            return a && b ? a->looks_like(*b, scene) : !a && !b;
        };
        return opening.looks_like(other.opening, scene) && path.empty() && other.path.empty() &&
               like(after, other.after) && like(before, other.before);
    }
    render::Picture picture(const Scene& scene, int frame) const {
        return {opening.bodies,
                scene.appearance,
                scene.materials,
                opening.camera,
                scene.lights,
                scene.render,
                path,
                frame,
                after ? &*after : nullptr,
                before ? &*before : nullptr};
    }

  private:
    void open_shutter(const Scene& scene, FilmCamera& camera, Poses& poses, int frame) {
        const double begin = frame_instant(scene, frame).time;
        const double rate = scene.physics ? scene.physics->steps_per_second : 1;
        bool is_still = true;
        const auto add = [&](const FrameInstant& instant) {
            Moment at = moment(camera, poses, instant);
            is_still = is_still && at.looks_like(opening, scene);
            path.push_back({instant.time - begin, std::move(at.bodies), at.camera});
        };
        for (const std::uint64_t step : shutter_steps(scene, frame))
            if (poses.has(step)) add({static_cast<double>(step) / rate, step, 0});
        // Past the last step all stands still.
        const FrameInstant close = closing_instant(scene, frame);
        const double last = static_cast<double>(step_count(scene)) / rate;
        if (close.step == step_count(scene) && begin < last && last < close.time)
            add({last, close.step, 0});
        add(close);
        if (is_still) path.clear();
    }

    /// The frame `by` frames on. Where there is none the bodies of this one go on at their
    /// velocities.
    Moment neighbour(const Scene& scene, FilmCamera& camera, Poses& poses, int frame,
                     int by) const {
        const FrameInstant at = frame_instant(scene, frame + by);
        if (has_frame(scene, frame + by)) return moment(camera, poses, at);
        Moment coasting = {{opening.bodies, {}}};
        coast(coasting.bodies, by / scene.render.frames_per_second);
        coasting.camera = camera.at(at.time, coasting.bodies);
        return coasting;
    }
    static Moment moment(FilmCamera& camera, Poses& poses, const FrameInstant& instant) {
        const Bodies& bodies = poses.at(instant);
        return {{bodies, camera.at(instant.time, bodies)}};
    }
};

/// A finished frame. The next one may look the same: a still camera over a scene at rest, and
/// nothing random in the picture or the noise locked.
struct Shown {
    Exposure exposure;
    render::FrameFiles files;
};

}  // namespace

namespace {

/// That renders one pixel of a frame.
std::string command_for(const Scene& scene, int frame, const render::SampleNumber& s) {
    return fmt::format("tesserae render {} --frames {} --crop {},{},{},{} -o DIR",
                       scene.file.string(), frame, s.x, s.y, s.x + 1, s.y + 1);
}

}  // namespace

std::string clamped_pixels_text(const render::FrameStats& stats, const Scene& scene, int frame) {
    if (stats.clamped_pixels == 0) return {};
    const render::SampleNumber& s = stats.first_clamped;
    return fmt::format(
        "{}: frame {}: {} pixels have a colour beyond 65504, the most that a half holds, and are "
        "stored as that; weaker lights mend it; the first is pixel {},{}; to render it alone: {}",
        scene.file.string(), frame, stats.clamped_pixels, s.x, s.y, command_for(scene, frame, s));
}

std::string invalid_samples_text(const render::FrameStats& stats, const Scene& scene, int frame) {
    if (stats.invalid_samples == 0) return {};
    const render::SampleNumber& s = stats.first_invalid;
    return fmt::format(
        "{}: frame {}: {} samples were infinite or no number and count as black; the first is "
        "sample {} of pixel {},{}; to render it alone: {}",
        scene.file.string(), frame, stats.invalid_samples, s.sample, s.x, s.y,
        command_for(scene, frame, s));
}

std::string cut_paths_text(const render::FrameStats& stats, const Scene& scene, int frame) {
    // Less changes no code of a picture by more than clear polychora's long paths always do.
    constexpr double kTold = 1e-3;
    const auto cut = static_cast<double>(stats.cut_paths);
    if (!(cut > kTold * static_cast<double>(stats.view_rays))) return {};
    return fmt::format(
        "{}: frame {}: {:.2g} % of the light paths were cut off at {} mirrors and surfaces of "
        "glass "
        "and are black from there on; a greater render.specular_bounces follows them farther, but "
        "for what is caught in glass or between mirrors for ever",
        scene.file.string(), frame, 100 * cut / static_cast<double>(stats.view_rays),
        scene.render.specular_bounces);
}

FilmReport film(const Scene& scene, const std::vector<int>& frames, const fs::path& trajectory,
                const fs::path& folder, Replace replace, bool quiet,
                std::optional<render::FramePart> part) {
    const auto begin = std::chrono::steady_clock::now();
    const bool is_changed = !require_folder_of(scene, folder, replace).empty();
    Poses poses(scene, frames, trajectory);
    FilmCamera camera(scene, &poses);

    FilmReport report;
    report.frames = folder / "frames";
    create_folder(report.frames);
    create_folder(folder / "preview");
    if (!fs::exists(folder / kSceneFile) || is_changed || replace == Replace::kAll)
        write_file(folder / kSceneFile, scene.effective);

    render::FrameInfo info;
    info.scene_name = scene.name;
    info.motion_version = poses.motion_version();
    info.program_version = program_version();
    info.id_names = id_names(scene);
    std::optional<render::Mattes> mattes;
    if (scene.render.channels.cryptomatte) mattes = mattes_of(scene, report.frames);

    const OverlayPainter painter(scene);
    const int parts = parts_of_frame(scene);
    std::optional<Shown> shown;
    Progress progress("rendering", "frames", frames.size(), quiet);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        info.frame = frames[i];
        info.scene_hash =
            hash_of_frame(scene, info.frame, info.picture_version, info.motion_version);
        info.time = frame_instant(scene, frames[i]).time;
        const std::string stem = fmt::format("{}.{:04}", scene.name, info.frame);
        const render::FrameFiles files = {report.frames / (stem + ".exr"),
                                          folder / "preview" / (stem + ".png")};
        report.preview = files.preview;
        if (is_done(scene, info, files, replace, painter)) {
            progress.start_at(++report.kept);
            if (parts > 1) remove_parts(files.exr, parts);
            continue;
        }
        Exposure exposure(scene, camera, poses, info.frame);
        render::Picture picture = exposure.picture(scene, info.frame);
        if (mattes) picture.mattes = &*mattes;
        std::vector<render::Stamp> overlay;
        if (!painter.is_empty())
            overlay = painter.stamps(info.frame, SlicePose(exposure.opening.camera));
        picture.overlay = overlay;
        const auto warn = [&](const render::FrameStats& stats) {
            for (const std::string& text : {invalid_samples_text(stats, scene, info.frame),
                                            clamped_pixels_text(stats, scene, info.frame),
                                            cut_paths_text(stats, scene, info.frame)})
                if (!text.empty()) tell(text);
            report.stats += stats;
        };
        if (part) {
            const auto stats = render_one_part(picture, info, *part, files.exr,
                                               replace != Replace::kNothing, stop_requested());
            if (stats) warn(*stats), ++report.parts;
            progress.update(i + 1);
            continue;
        }
        if (shown && !render::needs_of(picture).moving_noise &&
            exposure.looks_like(shown->exposure, scene)) {
            render::copy_frame(shown->files, painter.is_empty(), picture, info, files);
            ++report.copied;
        } else {
            warn(parts > 1 ? render_in_parts(picture, info, files, parts,
                                             replace != Replace::kNothing, stop_requested())
                           : render::render_frame(picture, info, files.exr, files.preview,
                                                  stop_requested()));
            ++report.rendered;
            shown.emplace(Shown{std::move(exposure), files});
        }
        progress.update(i + 1);
    }
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return report;
}

}  // namespace tesserae::scenes
