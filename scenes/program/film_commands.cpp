// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/film_commands.hpp"

#include <algorithm>
#include <optional>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "parallel/threads.hpp"
#include "parallel/trace.hpp"
#include "scenes/film/draft.hpp"
#include "scenes/film/film.hpp"
#include "scenes/film/movie.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/plan/cost.hpp"
#include "scenes/plan/in_slice.hpp"
#include "scenes/plan/overlaps.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/shell_word.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/program/farm_commands.hpp"
#include "scenes/program/work.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json to_json(const SimulateReport& r) {
    return {{"first_step", r.first_step},
            {"last_step", r.last_step},
            {"steps_to_last_frame", r.steps},
            {"rows", r.rows},
            {"seconds", r.seconds}};
}

Json to_json(const FilmReport& r) {
    return {{"frames", r.frames.string()},
            {"rendered", r.rendered},
            {"copied", r.copied},
            {"kept", r.kept},
            {"view_rays", r.stats.view_rays},
            {"shadow_rays", r.stats.shadow_rays},
            {"bounce_rays", r.stats.bounce_rays},
            {"cut_paths", r.stats.cut_paths},
            {"invalid_samples", r.stats.invalid_samples},
            {"clamped_pixels", r.stats.clamped_pixels},
            {"distance_evaluations", r.stats.distance_evaluations},
            {"seconds", r.seconds}};
}

Json to_json(const MovieReport& r) {
    return {{"file", r.file.string()},
            {"frames", r.frames},
            {"frames_per_second", r.frames_per_second},
            {"seconds", r.seconds}};
}

std::string simulated_text(const SimulateReport& r, const fs::path& file) {
    const bool ends_early = r.last_step < r.steps;
    if (r.kept)
        return ends_early ? fmt::format("{}: goes to step {} of {}, which is enough", file.string(),
                                        r.last_step, r.steps)
                          : fmt::format("{}: complete already", file.string());
    return fmt::format("{}: steps {} to {}{}, {} stored, {}", file.string(), r.first_step,
                       r.last_step, ends_early ? fmt::format(" of {}", r.steps) : "", r.rows,
                       duration_text(r.seconds));
}

std::string filmed_text(const FilmReport& r) {
    const std::string copied =
        r.copied > 0 ? fmt::format("{} copied (the same as before), ", r.copied) : "";
    return fmt::format("{} frames rendered, {}{} kept, {}\nframes:  {}\npreview: {}", r.rendered,
                       copied, r.kept, duration_text(r.seconds), r.frames.string(),
                       r.preview.string());
}

std::string movie_text(const MovieReport& r) {
    return fmt::format("film:    {} ({} frames, {:.4g} a second)", r.file.string(), r.frames,
                       r.frames_per_second);
}

/// What a draft's trajectory says that it was made by, until a film takes it: it may be replaced.
constexpr const char* kDraftCreator = "tesserae run --draft";

/// simulate(), and the trace of it where one is asked for.
/// @param frames   to the last of which; empty: to the scene's last
SimulateReport traced_simulate(const CommandLine& line, const Work& work, const fs::path& file,
                               std::vector<int> frames, bool overwrite) {
    std::optional<parallel::Trace> trace;
    if (!line.trace.empty()) {
        trace.emplace();
        // Empty at first, so that a path that cannot be written shows before the work.
        write_file(line.trace, trace->json());
    }
    const SimulateReport report =
        simulate(work.scene, work.plan, file,
                 {line.store_every, std::move(frames), overwrite, line.quiet,
                  trace ? &*trace : nullptr, line.draft ? kDraftCreator : "tesserae"});
    if (trace) write_file(line.trace, trace->json());
    return report;
}

/// A command that films: what the user asked for, or a draft of it.
class Filming {
  public:
    explicit Filming(const CommandLine& line)
        : line_(line),
          is_run_(line.command == "run"),
          folder_(line.draft ? line.output / "draft" : line.output),
          replace_(line.overwrite || is_draft() ? Replace::kAll
                   : is_run_                    ? Replace::kOtherLooks
                                                : Replace::kNothing),
          trajectory_(line.trajectory),
          work_(line_) {
        if (line.draft) {
            for (std::string& set : draft_overrides(work_.scene))
                line_.sets.push_back(std::move(set));
            work_ = Work(line_);
        }
        frames_ = parse_frames(line.frames, frame_count(work_.scene));
        if (line.draft && line.frames.empty()) frames_ = draft_frames();
        if (line.draft) require_draft_folder();
        require_memory(work_.plan, work_.scene);
    }

    void operator()() {
        Json json = {{"scene", scene().name}, {"hash", scene().hash}, {"threads", line_.threads}};
        std::string text;
        FilmReport filmed;
        parallel::Threads(line_.threads).run([&] {
            const bool simulates =
                trajectory_.empty() && (is_run_ ? scene().physics.has_value() : work_.plan.moves);
            const bool is_changed = tell_changed_look();
            // Another scene's frames are replaced: all is as at first.
            const bool is_new = line_.overwrite || !fs::exists(folder_ / "frames");
            if (is_run_ && is_new) tell_cost();
            if (simulates) text = simulated(json["simulate"]) + "\n";
            if (is_run_ && (is_new || is_changed)) tell_slice();
            if (line_.draft) {
                create_folder(folder_);
                write_file(folder_ / kFramesFile, frames_text(draft_frames()) + "\n");
            }
            filmed =
                film(scene(), frames_, trajectory_, folder_, replace_, line_.quiet, line_.tiles);
        });
        if (line_.tiles) json["parts"] = filmed.parts;
        json["render"] = to_json(filmed);
        text += line_.tiles ? parts_text(filmed, folder_) : filmed_text(filmed);
        if (is_run_) {
            text += movie(json);
            write_file(folder_ / "report.json", json.dump(2) + "\n");
        }
        print_result(line_, json, text);
    }

  private:
    const Scene& scene() const { return work_.scene; }

    /// The folder holds a draft, which costs seconds: it may be replaced.
    bool is_draft() const { return line_.draft && fs::exists(folder_ / kFramesFile); }
    /// @throws InputError   it holds something else
    void require_draft_folder() const {
        if (!fs::exists(folder_) || is_draft() || fs::exists(folder_ / kSceneFile)) return;
        // A draft that was ended before its first file has left nothing else.
        const auto is_leftover = [](const fs::directory_entry& entry) {
            return entry.path().extension() == ".partial";
        };
        const bool is_begun =
            fs::is_directory(folder_) &&
            std::all_of(fs::directory_iterator(folder_), fs::directory_iterator(), is_leftover);
        if (!is_begun)
            throw InputError(
                fmt::format("{}: is there and no draft; choose another folder", folder_.string()));
    }

    /// Whether a trajectory of another motion may be replaced: where it was asked for, and where a
    /// draft has made it.
    bool may_replace_trajectory() const {
        return line_.overwrite || (line_.draft && is_made_by(trajectory_, kDraftCreator));
    }
    /// @throws InputError   a draft would have to replace the trajectory of a film
    void require_no_film(Served served) const {
        if (line_.draft && served == Served::kByOther && fs::exists(line_.output / "frames"))
            throw InputError(fmt::format(
                "{}: is of the film in {}, whose bodies move otherwise; choose another folder for "
                "the draft",
                trajectory_.string(), line_.output.string()));
    }

    std::vector<int> draft_frames() const {
        std::vector<int> frames = parse_frames("", frame_count(scene()));
        std::erase_if(frames, [](int frame) { return frame % kDraftStride != 0; });
        return frames;
    }

    void tell(const std::string& text) const {
        if (!line_.quiet) scenes::tell(text);
    }

    bool tell_changed_look() const {
        const std::string change = require_folder_of(scene(), folder_, replace_);
        if (!change.empty())
            tell(fmt::format("{}: {}: frames that look otherwise are rendered again",
                             folder_.string(), change));
        return !change.empty();
    }

    /// What a run from nothing will cost.
    void tell_cost() const {
        if (line_.quiet) return;
        if (!line_.draft)
            for (const std::string& warning : work_.plan.warnings)
                tell(fmt::format("warning: {}", warning));
        for (const std::string& warning : overlap_warnings(scene()))
            tell(fmt::format("warning: {}", warning));
        if (fs::exists(line_.output / "trajectory.h5")) return;
        constexpr double kEstimateSeconds = 1;
        Cost cost;
        try {
            cost = measure_cost(scene(), work_.plan, {}, frames_,
                                std::min(kEstimateSeconds, measuring_seconds(scene())));
        } catch (const std::exception& error) {
            // An estimate never ends a run; what is really wrong the run itself will meet.
            if (stop_requested()) throw;
            tell(fmt::format("no estimate of the time: {}", error.what()));
            return;
        }
        tell(fmt::format("about {} to simulate and {} to render{}",
                         duration_text(cost.simulate_seconds), duration_text(cost.render_seconds),
                         cost.is_rough() ? ", partly a guess (tesserae plan tells more)" : ""));
    }

    /// When bodies are in the picture, and what is wrong with that.
    void tell_slice() const {
        if (line_.quiet || frames_.empty()) return;
        const SliceReport report = look_at_slice(scene(), trajectory_, frames_);
        constexpr std::size_t kMostNames = 12;
        const std::size_t shown = std::min(kMostNames, report.names.size());
        for (std::size_t i = 0; i < shown; ++i) tell(text_of(report.names[i]));
        if (shown < report.names.size())
            tell(fmt::format("and {} names more (tesserae plan --trajectory tells of all)",
                             report.names.size() - shown));
        for (const std::string& warning : report.warnings)
            tell(fmt::format("warning: {}", warning));
    }

    /// Those that were asked for by their numbers; empty: all. Also a draft's trajectory is that of
    /// all frames.
    std::vector<int> frames_by_number() const {
        return line_.frames.empty() ? std::vector<int>() : frames_;
    }

    /// What is there serves where it can. A draft shares the trajectory with the film.
    std::string simulated(Json& json) {
        create_folder(folder_);
        trajectory_ = line_.output / "trajectory.h5";
        const Served served =
            how_served(scene(), trajectory_, line_.store_every, frames_by_number());
        require_no_film(served);
        const std::string file = trajectory_.string();
        SimulateReport report;
        std::string text;
        if (served == Served::kByMore) {
            report = report_of_kept(scene(), trajectory_, line_.store_every);
            text = fmt::format("{}: kept", file);
        } else {
            // Of the same motion nothing is lost.
            const bool anew = is_run_ && served == Served::kByOtherSteps;
            if (anew)
                tell(fmt::format("{}: lacks steps that the frames need: simulated again", file));
            report = traced_simulate(line_, work_, trajectory_, frames_by_number(),
                                     anew || may_replace_trajectory());
            text = simulated_text(report, trajectory_);
        }
        json = to_json(report);
        json["trajectory"] = file;
        return text;
    }

    /// The film of all frames, where they are there. @return a line
    std::string movie(Json& json) {
        const std::vector<int> there = preview_numbers(scene(), folder_);
        const std::size_t wanted = wanted_frames(scene(), folder_).size();
        if (wanted < 2) return {};
        if (there.size() != wanted)
            return fmt::format("\nfilm:    not made: {} of {} frames are there", there.size(),
                               wanted);
        if (is_movie_current(scene(), folder_))
            return fmt::format("\nfilm:    {}", movie_file(scene(), folder_).string());
        if (!has_ffmpeg())
            return fmt::format(
                "\nfilm:    not made: ffmpeg is not installed; with it: tesserae film {}",
                shell_word(folder_.string()));
        try {
            const MovieReport report = make_movie(scene(), folder_, line_.quiet);
            json["film"] = to_json(report);
            return "\n" + movie_text(report);
        } catch (const InputError& error) {
            if (line_.frames.empty()) throw RunError(error.what());
            // Some frames still look as they did before: they were not asked for.
            return fmt::format("\nfilm:    not made: {}", error.what());
        }
    }

    CommandLine line_;
    bool is_run_;
    fs::path folder_;
    Replace replace_;
    fs::path trajectory_;
    Work work_;
    std::vector<int> frames_;
};

}  // namespace

void simulate_command(const CommandLine& line) {
    const Work work(line);
    const std::vector<int> frames = asked_frames(line, work.scene);
    require_memory(work.plan, work.scene);
    create_folder_of(line.output);
    stop_gracefully_on_signals();
    SimulateReport report;
    parallel::Threads(line.threads).run([&] {
        report = traced_simulate(line, work, line.output, frames, line.overwrite);
    });
    Json json = to_json(report);
    json["trajectory"] = line.output.string();
    json["hash"] = work.scene.motion_hash;
    print_result(line, json, simulated_text(report, line.output));
}

void run_command(const CommandLine& line) {
    Filming filming(line);
    stop_gracefully_on_signals();
    filming();
}

void movie_command(const CommandLine& line) {
    const fs::path text = line.file / kSceneFile;
    if (!fs::exists(text))
        throw InputError(fmt::format(
            "{}: has no {}: expected a folder that tesserae run or tesserae render has made",
            line.file.string(), kSceneFile));
    const Scene scene = scene_of_film(text);
    stop_gracefully_on_signals();
    const MovieReport report = make_movie(scene, line.file, line.quiet);
    print_result(line, to_json(report), movie_text(report));
}

}  // namespace tesserae::scenes
