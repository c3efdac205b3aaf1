// SPDX-License-Identifier: Apache-2.0
#include "scenes/farm/status.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <sstream>

#include "core/dynamics/motion_version.hpp"
#include "core/error.hpp"
#include "core/file/read_file.hpp"
#include "scenes/farm/estimate.hpp"
#include "scenes/farm/scripts.hpp"
#include "scenes/farm/submit.hpp"
#include "scenes/film/film_folder.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/load/load.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/shell_word.hpp"
#include "scenes/timeline.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// The rate is that of so many last frames, if the latest is not much older than they are apart.
constexpr std::size_t kFramesOfRate = 100;
constexpr double kLongSilence = 20;

/// What was submitted, else what was rendered here.
fs::path scene_file_of(const fs::path& folder) {
    for (const char* name : {"submit/scene.toml", "scene.toml"})
        if (fs::exists(folder / name)) return folder / name;
    throw InputError(fmt::format(
        "{}: holds no film: it has no scene.toml; expected the DIR of tesserae run, render or "
        "submit",
        folder.string()));
}

/// By which version bodies were moved, as frames say it.
int motion_version_of(const fs::path& folder, bool moves) {
    const fs::path trajectory = folder / "trajectory.h5";
    if (!moves || !fs::exists(trajectory)) return kMotionVersion;
    try {
        return TrajectoryReader(trajectory).header().motion_version;
    } catch (const InputError&) {
        return kMotionVersion;
    }
}

/// How many tasks of the submitted jobs run and wait.
void ask_slurm(const fs::path& folder, FilmStatus& status) {
    const fs::path file = folder / "submit" / "jobs";
    std::istringstream in(fs::exists(file) ? read_file(file) : "");
    std::string jobs;
    for (std::string line; std::getline(in, line);)
        if (!line.empty() && line.find_first_not_of("0123456789") == std::string::npos)
            jobs += (jobs.empty() ? "" : ",") + line;
    if (jobs.empty()) {
        status.slurm = "nothing was submitted from this folder";
        return;
    }
    // A job that has left Slurm's memory is an error to squeue, alone or not; no answer at all is
    // one too. sinfo tells them apart.
    const ShellOutput queue =
        shell_output("squeue --noheader --array --format %T --jobs " + jobs + " 2>/dev/null");
    if (queue.status != 0 && shell_output("sinfo --noheader 2>/dev/null").status != 0) {
        status.slurm = "does not answer here (squeue)";
        return;
    }
    status.running = status.queued = 0;
    for (std::size_t at = 0; at < queue.text.size();) {
        const std::size_t end = std::min(queue.text.find('\n', at), queue.text.size());
        const std::string state = queue.text.substr(at, end - at);
        ++(state == "RUNNING" || state == "COMPLETING" ? *status.running : *status.queued);
        at = end + 1;
    }
}

/// Frames a second, of the times at which the last ones came to be.
std::optional<double> rate_of(std::vector<fs::file_time_type> times) {
    if (times.size() < 2) return {};
    std::sort(times.rbegin(), times.rend());
    times.resize(std::min(times.size(), kFramesOfRate));
    const auto seconds = [](auto duration) {
        return std::chrono::duration<double>(duration).count();
    };
    const double span = seconds(times.front() - times.back());
    const double apart = span / static_cast<double>(times.size() - 1);
    const double silence = seconds(fs::file_time_type::clock::now() - times.front());
    if (span <= 0 || silence > 60 + kLongSilence * apart) return {};
    return 1 / apart;
}

/// Whether simulating has still to make or to continue the trajectory.
bool lacks_steps(const Scene& scene, const fs::path& trajectory, const std::vector<int>& frames) {
    const Served served = how_served(scene, trajectory, 0, frames);
    return served == Served::kByNothing || served == Served::kByBeginning;
}

/// The command that makes the rest on this machine.
std::string finishing_command(const FilmStatus& status, const Scene& scene, const fs::path& folder,
                              const fs::path& scene_file, bool moves) {
    const auto word = [](const fs::path& path) { return shell_word(path.string()); };
    std::vector<int> frames = status.missing;
    frames.insert(frames.end(), status.other.begin(), status.other.end());
    frames.insert(frames.end(), status.invalid.begin(), status.invalid.end());
    std::sort(frames.begin(), frames.end());
    const fs::path trajectory = folder / "trajectory.h5";
    std::string text;
    if (moves && lacks_steps(scene, trajectory, frames))
        text = fmt::format("tesserae simulate {} -o {} && ", word(scene_file), word(trajectory));
    text += fmt::format("tesserae render {}", word(scene_file));
    if (moves) text += fmt::format(" --trajectory {}", word(trajectory));
    text += fmt::format(" --frames {} -o {}", frames_text(frames), word(folder));
    // Of another scene is replaced what is in the way, only these frames.
    if (!status.other.empty()) text += " --overwrite";
    return text;
}

}  // namespace

FilmStatus film_status(const fs::path& folder) {
    const fs::path scene_file = scene_file_of(folder);
    const Scene scene = scene_of_film(scene_file);
    const bool moves = make_plan(scene, 1).moves;
    const int motion_version = motion_version_of(folder, moves);
    FilmStatus status;
    status.scene = scene.name;
    std::vector<fs::file_time_type> times;
    for (const int frame : wanted_frames(scene, folder)) {
        ++status.frames;
        const std::string stem = fmt::format("{}.{:04}", scene.name, frame);
        const fs::path exr = folder / "frames" / (stem + ".exr");
        const render::FrameFiles files = {exr, folder / "preview" / (stem + ".png")};
        switch (check_frame(scene, frame, motion_version, files).state) {
            case FrameState::kComplete: {
                std::error_code gone;
                times.push_back(fs::last_write_time(exr, gone));
                break;
            }
            case FrameState::kMissing:
            case FrameState::kLacksPreview:
                status.missing.push_back(frame);
                break;
            case FrameState::kOther:
            case FrameState::kOfOtherVersion:
                status.other.push_back(frame);
                break;
            case FrameState::kDamaged:
                status.invalid.push_back(frame);
                break;
        }
    }
    ask_slurm(folder, status);
    if (status.is_complete()) return status;
    status.frames_per_second = rate_of(std::move(times));
    const auto left =
        static_cast<double>(status.missing.size() + status.other.size() + status.invalid.size());
    if (status.frames_per_second) status.seconds_left = left / *status.frames_per_second;
    status.command = finishing_command(status, scene, folder, scene_file, moves);
    if (fs::exists(folder / "submit" / "submit.sh"))
        status.submit = "bash " + shell_word((folder / "submit" / "submit.sh").string());
    return status;
}

std::string status_text(const FilmStatus& s, const fs::path& folder) {
    std::string text =
        fmt::format("film         {} in {}: {} frames\n", s.scene, folder.string(), s.frames);
    const auto line = [&](const char* name, const std::vector<int>& frames) {
        text += fmt::format("{:<12} {}{}\n", name, frames.size(),
                            frames.empty() ? "" : ": " + frames_text(frames));
    };
    const auto bad = s.missing.size() + s.other.size() + s.invalid.size();
    text += fmt::format("complete     {}\n", static_cast<std::size_t>(s.frames) - bad);
    line("missing", s.missing);
    line("other scene", s.other);
    line("invalid", s.invalid);
    text += s.running
                ? fmt::format("Slurm        {} tasks running, {} queued\n", *s.running, *s.queued)
                : fmt::format("Slurm        {}\n", s.slurm);
    if (s.seconds_left)
        text += fmt::format("rate         {:.3g} frames a minute, {} left\n",
                            60 * *s.frames_per_second, duration_text(*s.seconds_left));
    if (!s.command.empty()) text += fmt::format("finish here  {}\n", s.command);
    if (!s.submit.empty()) text += fmt::format("or by Slurm  {}\n", s.submit);
    if (text.ends_with('\n')) text.pop_back();
    return text;
}

}  // namespace tesserae::scenes
