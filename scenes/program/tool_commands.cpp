// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/tool_commands.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "parallel/threads.hpp"
#include "scenes/compare/file_kind.hpp"
#include "scenes/export/export.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/load.hpp"
#include "scenes/plot/plot.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/timeline.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {
namespace {

using Json = nlohmann::ordered_json;

/// The scene in a trajectory, with what the command line changes of it.
Scene scene_in(const CommandLine& line) {
    if (kind_of(line.file) != FileKind::kTrajectory)
        throw InputError(fmt::format("{}: expected a trajectory; tesserae simulate makes one",
                                     line.file.string()));
    return load_scene_text(
        line.file, without_solver(TrajectoryReader(line.file).header().effective), line.sets);
}

Json to_json(const ExportReport& report, const CommandLine& line) {
    return {{"folder", line.output.string()},
            {"written", report.written},
            {"kept", report.kept},
            {"bodies", report.bodies},
            {"vertices", report.vertices},
            {"polygons", report.polygons},
            {"seconds", report.seconds}};
}

}  // namespace

void plot_command(const CommandLine& line) {
    const bool is_new = plot(line.file, line.output, line.joints, line.overwrite);
    if (line.json)
        put_json({{"file", line.output.string()}, {"written", is_new}});
    else
        put_line("{}{}", line.output.string(), is_new ? "" : ": complete already");
}

void export_command(const CommandLine& line) {
    const Scene scene = scene_in(line);
    const std::vector<int> frames = parse_frames(line.frames, frame_count(scene));
    const ExportSettings settings{line.format == "vtk" ? MeshFormat::kVtk : MeshFormat::kPly,
                                  line.tolerance, line.extent};
    stop_gracefully_on_signals();
    ExportReport report;
    parallel::Threads(line.threads).run([&] {
        report = export_meshes(scene, frames, line.file, line.output, settings, line.overwrite,
                               line.quiet);
    });
    if (line.json)
        put_json(to_json(report, line));
    else
        put_line("{} frames written, {} kept, {}\nopen:   {}", report.written, report.kept,
                 duration_text(report.seconds), report.first_to_open.string());
}

}  // namespace tesserae::scenes
