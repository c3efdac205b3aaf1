// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/view_command.hpp"

#include "core/error.hpp"
#include "parallel/threads.hpp"
#include "scenes/compare/file_kind.hpp"
#include "scenes/film/film_folder.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/program/work.hpp"
#include "scenes/trajectory/trajectory.hpp"
#include "scenes/view/view.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// The scene that is shown: that of a scene file, or the one in a trajectory.
Scene viewed_scene(const CommandLine& line, bool is_trajectory) {
    if (!is_trajectory) return load_scene(line.file, line.sets);
    return load_scene_text(
        line.file, without_solver(TrajectoryReader(line.file).header().effective), line.sets);
}

/// What view's own trajectories say that they were made by: these may be replaced, as pages may.
constexpr const char* kCreator = "tesserae view";

}  // namespace

void view_command(const CommandLine& line) {
    const bool is_trajectory = kind_of(line.file) == FileKind::kTrajectory;
    const Scene scene = viewed_scene(line, is_trajectory);
    const Plan plan = make_plan(scene, line.threads);
    ViewOptions options;
    options.frames = asked_frames(line, scene);
    options.near_slice = line.near_slice;
    options.quiet = line.quiet;
    require_page(line.output, line.overwrite);
    require_memory(plan, scene);
    create_folder_of(line.output);
    stop_gracefully_on_signals();

    fs::path trajectory = is_trajectory ? line.file : fs::path();
    ViewReport report;
    parallel::Threads(line.threads).run([&] {
        if (!is_trajectory && plan.moves) {
            trajectory = fs::path(line.output).replace_extension(".h5");
            // One that holds more serves as well.
            if (how_served(scene, trajectory, 0, options.frames) != Served::kByMore)
                simulate(scene, plan, trajectory,
                         {0, options.frames, line.overwrite || is_made_by(trajectory, kCreator),
                          line.quiet, nullptr, kCreator});
        }
        report = write_view(scene, trajectory, line.output, options);
    });

    const std::string page = line.output.string();
    nlohmann::ordered_json json = {{"scene", scene.name}, {"hash", scene.hash}, {"page", page}};
    if (!trajectory.empty()) json["trajectory"] = trajectory.string();
    json["bodies"] = report.bodies, json["moments"] = report.moments;
    json["bytes"] = report.bytes, json["seconds"] = report.seconds;
    print_result(
        line, json,
        fmt::format("{}: {} bodies, {} moments, {:.1f} MB, {}", page, report.bodies, report.moments,
                    1e-6 * static_cast<double>(report.bytes), duration_text(report.seconds)));
}

}  // namespace tesserae::scenes
