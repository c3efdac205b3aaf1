// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/farm_commands.hpp"

#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "parallel/threads.hpp"
#include "scenes/farm/join.hpp"
#include "scenes/farm/scripts.hpp"
#include "scenes/farm/status.hpp"
#include "scenes/farm/submit.hpp"
#include "scenes/load/load.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/shell_word.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

using FarmJson = nlohmann::ordered_json;

/// The commands on standard output, what goes before and after them on standard error.
void print_commands(const FarmReport& report) {
    const auto script = [&](const char* name) {
        return shell_word(std::filesystem::absolute(report.scripts / name).string());
    };
    if (report.moves)
        write_error(terminal_text(
            fmt::format("before all others, once: bash {}\n", script("simulate.sh"))));
    put_line("{}", fmt::join(report.commands, "\n"));
    write_error(
        terminal_text(fmt::format("after all others, once:  bash {}\n", script("finish.sh"))));
}

FarmJson submit_json(const FarmReport& report) {
    const FarmEstimate& e = report.estimate;
    return {{"scripts", report.scripts.string()}, {"tasks", report.commands.size()},
            {"frames_of_a_task", e.chunk},        {"cores", e.cores},
            {"memory_mib", e.memory_mib},         {"frame_seconds", e.frame_seconds},
            {"minutes", e.frame_minutes},         {"simulate_minutes", e.simulate_minutes}};
}

}  // namespace

void submit_command(const CommandLine& line) {
    const Scene scene = load_scene(line.file, line.sets);
    const std::vector<int> frames = parse_frames(line.frames, frame_count(scene));
    const FarmReport report = write_farm(scene, frames, line.output, line.farm, line.overwrite);
    const std::string said = line.farm.now ? submit_farm(report.scripts) : "";
    if (line.json) {
        FarmJson json = submit_json(report);
        if (line.farm.kind == "commands") json["commands"] = report.commands;
        if (line.farm.now) json["slurm"] = said;
        put_json(json);
    } else if (line.farm.kind == "commands") {
        print_commands(report);
    } else {
        const FarmEstimate& e = report.estimate;
        put_line("{} tasks of up to {} frames, each on {} cores with {} MB for at most {}",
                 report.commands.size(), e.chunk, e.cores, e.memory_mib,
                 duration_text(60.0 * e.frame_minutes));
        put_line("{}", line.farm.now ? said
                                     : "to submit: bash " +
                                           shell_word((report.scripts / "submit.sh").string()));
    }
}

std::string parts_text(const FilmReport& report, const std::filesystem::path& folder) {
    return fmt::format("{} parts rendered, {}\nonce all are there: tesserae join {}", report.parts,
                       duration_text(report.seconds), shell_word(folder.string()));
}

int join_command(const CommandLine& line) {
    JoinReport report;
    parallel::Threads(line.threads).run([&] { report = join_folder(line.file); });
    if (line.json)
        put_json({{"joined", report.joined},
                  {"removed", report.removed},
                  {"missing", report.missing},
                  {"wrong", report.wrong}});
    else
        put_line("{} frames joined{}", report.joined,
                 report.removed > 0
                     ? fmt::format(", {} parts of whole frames removed", report.removed)
                     : "");
    for (const std::string& missing : report.missing)
        tell(fmt::format("{} are missing: tesserae render --tiles makes them", missing));
    for (const std::string& wrong : report.wrong) tell(wrong);
    if (!report.wrong.empty()) return 2;
    return report.missing.empty() ? 0 : 1;
}

int status_command(const CommandLine& line) {
    const FilmStatus s = film_status(line.file);
    if (!line.json) {
        if (!line.quiet) put_line("{}", status_text(s, line.file));
        return s.is_complete() ? 0 : 1;
    }
    const auto number = [](const auto& value) { return value ? FarmJson(*value) : FarmJson(); };
    const auto bad = static_cast<int>(s.missing.size() + s.other.size() + s.invalid.size());
    const FarmJson json = {{"scene", s.scene},
                           {"frames", s.frames},
                           {"complete", s.frames - bad},
                           {"missing", s.missing},
                           {"other_scene", s.other},
                           {"invalid", s.invalid},
                           {"running", number(s.running)},
                           {"queued", number(s.queued)},
                           {"frames_per_second", number(s.frames_per_second)},
                           {"seconds_left", number(s.seconds_left)},
                           {"command", s.command},
                           {"submit", s.submit}};
    put_json(json);
    return s.is_complete() ? 0 : 1;
}

}  // namespace tesserae::scenes
