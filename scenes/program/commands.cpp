#include "scenes/program/commands.hpp"

#include <cstdio>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "parallel/threads.hpp"
#include "parallel/trace.hpp"
#include "scenes/film/film.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/load/load.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/plan/plan_picture.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/program/compare_commands.hpp"
#include "scenes/program/farm_commands.hpp"
#include "scenes/program/info.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json to_json(const Plan& plan) {
    Json decisions = Json::array();
    for (const Decision& d : plan.decisions)
        decisions.push_back({{"part", d.part}, {"needed", d.needed}, {"reason", d.reason}});
    return {{"bodies", plan.bodies},
            {"movable_bodies", plan.movable_bodies},
            {"steps", plan.steps},
            {"frames", plan.frames},
            {"view_rays", plan.view_rays},
            {"memory_bytes", plan.memory_bytes},
            {"trajectory_bytes", plan.trajectory_bytes},
            {"decisions", std::move(decisions)},
            {"warnings", plan.warnings}};
}

Json to_json(const SimulateReport& r) {
    return {{"first_step", r.first_step},
            {"last_step", r.last_step},
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
            {"invalid_samples", r.stats.invalid_samples},
            {"clamped_pixels", r.stats.clamped_pixels},
            {"distance_evaluations", r.stats.distance_evaluations},
            {"seconds", r.seconds}};
}

void print_plan(const Plan& plan) {
    fmt::print("bodies      {} ({} movable)\n", plan.bodies, plan.movable_bodies);
    fmt::print("steps       {}\n", plan.steps);
    fmt::print("frames      {}\n", plan.frames);
    fmt::print("view rays   {}\n", plan.view_rays);
    fmt::print("memory      {:.2f} GB\n", 1e-9 * static_cast<double>(plan.memory_bytes));
    fmt::print("trajectory  at most {:.2f} GB\n",
               1e-9 * static_cast<double>(plan.trajectory_bytes));
    for (const Decision& d : plan.decisions)
        fmt::print("{:9}   {}: {}\n", d.needed ? "needed" : "left out", d.part, d.reason);
    for (const std::string& warning : plan.warnings) fmt::print("warning     {}\n", warning);
}

/// What commands on a scene share: the checked scene, its plan, and the threads to work on.
struct Work {
    explicit Work(const CommandLine& line)
        : scene(load_scene(line.file, line.sets)), plan(make_plan(scene, line.threads)) {}

    Scene scene;
    Plan plan;
};

/// Prints the JSON object or the text that ends a command.
void print_result(const CommandLine& line, const Json& json, const std::string& text) {
    fmt::print("{}\n", line.json ? json.dump() : text);
}

std::string simulated_text(const SimulateReport& r, const fs::path& file) {
    if (r.first_step == r.last_step) return fmt::format("{}: complete already", file.string());
    return fmt::format("{}: steps {} to {}, {} stored, {}", file.string(), r.first_step,
                       r.last_step, r.rows, duration_text(r.seconds));
}

std::string filmed_text(const FilmReport& r) {
    const std::string copied =
        r.copied > 0 ? fmt::format("{} copied (the same as before), ", r.copied) : "";
    return fmt::format("{} frames rendered, {}{} kept, {}\nframes:  {}\npreview: {}", r.rendered,
                       copied, r.kept, duration_text(r.seconds), r.frames.string(),
                       r.preview.string());
}

/// simulate(), and the trace of it where one is asked for.
SimulateReport traced_simulate(const CommandLine& line, const Work& work, const fs::path& file) {
    std::optional<parallel::Trace> trace;
    if (!line.trace.empty()) {
        trace.emplace();
        // Empty at first, so that a path that cannot be written shows before the work.
        write_file(line.trace, trace->json());
    }
    const SimulateReport report = simulate(work.scene, work.plan, file, line.store_every,
                                           line.overwrite, line.quiet, trace ? &*trace : nullptr);
    if (trace) write_file(line.trace, trace->json());
    return report;
}

void simulate_command(const CommandLine& line) {
    const Work work(line);
    require_memory(work.plan, work.scene);
    stop_gracefully_on_signals();
    SimulateReport report;
    parallel::Threads(line.threads).run([&] { report = traced_simulate(line, work, line.output); });
    Json json = to_json(report);
    json["trajectory"] = line.output.string();
    json["hash"] = work.scene.motion_hash;
    print_result(line, json, simulated_text(report, line.output));
}

/// `run`, and `render` without a trajectory of a scene that moves: simulate, then render.
void film_command(const CommandLine& line) {
    const Work work(line);
    const Scene& scene = work.scene;
    const std::vector<int> frames = parse_frames(line.frames, frame_count(scene));
    require_memory(work.plan, scene);
    stop_gracefully_on_signals();

    Json json = {{"scene", scene.name}, {"hash", scene.hash}, {"threads", line.threads}};
    fs::path trajectory = line.trajectory;
    FilmReport filmed;
    parallel::Threads(line.threads).run([&] {
        const bool simulates =
            trajectory.empty() &&
            (line.command == "run" ? scene.physics.has_value() : work.plan.moves);
        if (simulates) {
            require_folder_of(scene, line.output, line.overwrite);
            create_folder(line.output);
            trajectory = line.output / "trajectory.h5";
            json["simulate"] = to_json(traced_simulate(line, work, trajectory));
            json["simulate"]["trajectory"] = trajectory.string();
        }
        filmed =
            film(scene, frames, trajectory, line.output, line.overwrite, line.quiet, line.tiles);
    });
    if (line.tiles) json["parts"] = filmed.parts;
    json["render"] = to_json(filmed);
    if (line.command == "run") write_file(line.output / "report.json", json.dump(2) + "\n");
    print_result(line, json, line.tiles ? parts_text(filmed, line.output) : filmed_text(filmed));
}

void plan_command(const CommandLine& line) {
    Work work(line);
    count_off_slice(work.scene, work.plan);
    warn_of_hidden_glass(work.scene, work.plan);
    if (line.json)
        fmt::print("{}\n", to_json(work.plan).dump());
    else
        print_plan(work.plan);
}

void info_command(const CommandLine& line) {
    const auto facts = facts_about(line.file, line.threads);
    if (line.json) {
        Json json = Json::object();
        for (const Fact& fact : facts) json[fact.name] = fact.value;
        // A file's texts need not be UTF-8.
        fmt::print("{}\n", json.dump(-1, ' ', false, Json::error_handler_t::replace));
    } else {
        for (const Fact& fact : facts) fmt::print("{:<24} {}\n", fact.name, fact.text);
    }
}

/// Says what is kept, after a signal.
int report_stop() {
    const int signal = stop_signal();
    fmt::print(
        stderr,
        "tesserae: stopped by signal {}; what is finished is kept, the same command continues\n",
        signal);
    return 128 + signal;
}

}  // namespace

int execute(const CommandLine& line) {
    int status = 0;
    if (line.command == "simulate") simulate_command(line);
    if (line.command == "run" || line.command == "render") film_command(line);
    if (line.command == "plan") plan_command(line);
    if (line.command == "info") info_command(line);
    if (line.command == "hash") hash_command(line);
    if (line.command == "diff") status = diff_command(line);
    if (line.command == "submit") submit_command(line);
    if (line.command == "join") status = join_command(line);
    if (line.command == "status") status = status_command(line);
    if (line.command == "generate") fmt::print("{}", generated_scene(line.generator, line.bodies));
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        throw RunError("standard output: cannot be written");
    return status;
}

int program(int argc, const char* const* argv) {
    handle_signals();
    try {
        return execute(parse_command_line(argc, argv));
    } catch (const Stopped&) {
        return report_stop();
    } catch (const InputError& error) {
        fmt::print(stderr, "tesserae: {}\n", error.what());
        return 2;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "tesserae: out of memory\n");
        return 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "tesserae: {}\n", error.what());
        return 1;
    }
}

}  // namespace tesserae::scenes
