// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/film.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "render/file/copied_frame.hpp"
#include "render/picture_needs.hpp"
#include "scenes/farm/join.hpp"
#include "scenes/film/shots.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/process/progress.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// A finished frame. The next one may look the same: a still camera over a scene at rest, and
/// nothing random in the picture or the noise locked.
struct Shown {
    Exposure exposure;
    render::FrameFiles files;
};

/// That renders one pixel of a frame.
std::string command_for(const Scene& scene, int frame, const render::SampleNumber& s) {
    return fmt::format("tesserae render {} --frames {} --crop {},{},{},{} -o DIR",
                       scene.file.string(), frame, s.x, s.y, s.x + 1, s.y + 1);
}

/// Makes what all processes that render into a folder need: they make the same. One that has waited
/// for another looks at the folder again, as that may have been of another scene.
void prepare_folder(const Scene& scene, Shots& shots, const fs::path& folder, Replace replace,
                    const std::atomic<bool>& stop) {
    create_folder(folder / "frames");
    create_folder(folder / "preview");
    write_when_free(
        [&] {
            const bool is_changed = !require_folder_of(scene, folder, replace).empty();
            if (!fs::exists(folder / kSceneFile) || is_changed || replace == Replace::kAll)
                write_file(folder / kSceneFile, scene.effective);
            shots.name_mattes(folder / "frames");
        },
        stop);
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

std::vector<std::string> picture_warnings(const render::FrameStats& stats, const Scene& scene,
                                          int frame) {
    std::vector<std::string> warnings = {invalid_samples_text(stats, scene, frame),
                                         clamped_pixels_text(stats, scene, frame),
                                         cut_paths_text(stats, scene, frame)};
    std::erase(warnings, "");
    return warnings;
}

FilmReport film(const Scene& scene, const std::vector<int>& frames, const fs::path& trajectory,
                const fs::path& folder, Replace replace, bool quiet,
                std::optional<render::FramePart> part, const Watch& watch) {
    const auto begin = std::chrono::steady_clock::now();
    // Refused before the trajectory is read, which may take long.
    require_folder_of(scene, folder, replace);
    Shots shots(scene, frames, trajectory);
    prepare_folder(scene, shots, folder, replace, *watch.stop);

    FilmReport report;
    report.frames = folder / "frames";

    const int parts = parts_of_frame(scene);
    std::optional<Shown> shown;
    Progress progress("rendering", "frames", frames.size(), quiet);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const int frame = frames[i];
        const std::string stem = fmt::format("{}.{:04}", scene.name, frame);
        const render::FrameFiles files = {report.frames / (stem + ".exr"),
                                          folder / "preview" / (stem + ".png")};
        report.preview = files.preview;
        if (is_done(scene, shots.info(frame), files, replace, shots.painter())) {
            progress.start_at(++report.kept);
            if (parts > 1) remove_parts(files.exr, parts);
            watch.tell(i + 1, frames.size());
            continue;
        }
        Shot shot = shots.shot(frame);
        const render::Picture picture = shots.picture(shot);
        const auto warn = [&](const render::FrameStats& stats) {
            for (const std::string& text : picture_warnings(stats, scene, frame)) tell(text);
            report.stats += stats;
        };
        const bool replaces = replace != Replace::kNothing;
        if (part) {
            const auto stats =
                render_one_part(picture, shot.info, *part, files.exr, replaces, *watch.stop);
            if (stats) warn(*stats), ++report.parts;
        } else if (shown && !render::needs_of(picture).moving_noise &&
                   shot.exposure.looks_like(shown->exposure, scene)) {
            render::copy_frame(shown->files, shots.painter().is_empty(), picture, shot.info, files);
            ++report.copied;
        } else {
            warn(parts > 1
                     ? render_in_parts(picture, shot.info, files, parts, replaces, *watch.stop)
                     : render::render_frame(picture, shot.info, files.exr, files.preview,
                                            *watch.stop));
            ++report.rendered;
            shown.emplace(Shown{std::move(shot.exposure), files});
        }
        progress.update(i + 1);
        watch.tell(i + 1, frames.size());
    }
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return report;
}

}  // namespace tesserae::scenes
