#include "scenes/program/commands.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>

#include "core/error.hpp"
#include "parallel/threads.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/plan/cost.hpp"
#include "scenes/plan/in_slice.hpp"
#include "scenes/plan/plan_picture.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/program/compare_commands.hpp"
#include "scenes/program/farm_commands.hpp"
#include "scenes/program/film_commands.hpp"
#include "scenes/program/info.hpp"
#include "scenes/program/tool_commands.hpp"
#include "scenes/program/view_command.hpp"
#include "scenes/program/work.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const InPicture& body) {
    return {{"name", body.name},
            {"bodies", body.bodies},
            {"most_bodies", body.most_bodies},
            {"height", body.largest},
            {"times", body.times}};
}

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
            {"checkpoint_bytes", plan.checkpoint_bytes},
            {"decisions", std::move(decisions)},
            {"warnings", plan.warnings}};
}

std::string gigabytes(auto bytes) {
    return fmt::format("{:.2f} GB", 1e-9 * static_cast<double>(bytes));
}

void print_plan(const Plan& plan, const Cost& cost, std::uint64_t taken) {
    fmt::print("bodies      {} ({} movable)\n", plan.bodies, plan.movable_bodies);
    fmt::print(
        "steps       {}{}\n", plan.steps,
        plan.moves && taken < plan.steps ? fmt::format(" ({} to the last frame)", taken) : "");
    fmt::print("frames      {}\n", plan.frames);
    fmt::print("view rays   {}\n", plan.view_rays);
    if (plan.moves) fmt::print("simulating  about {}\n", duration_text(cost.simulate_seconds));
    fmt::print("rendering   about {}\n", duration_text(cost.render_seconds));
    for (const std::string& text : cost.measured) fmt::print("measured    {}\n", text);
    for (const std::string& text : cost.guessed) fmt::print("guessed     {}\n", text);
    fmt::print("memory      {}\n", gigabytes(plan.memory_bytes));
    fmt::print("trajectory  at most {}\n", gigabytes(plan.trajectory_bytes));
    if (plan.moves)
        fmt::print("checkpoint  about {}, two of them until it is done\n",
                   gigabytes(plan.checkpoint_bytes));
    fmt::print("frames      about {}\n", gigabytes(cost.frame_bytes));
    for (const Decision& d : plan.decisions)
        fmt::print("{:9}   {}: {}\n", d.needed ? "needed" : "left out", d.part, d.reason);
    for (const std::string& warning : plan.warnings) fmt::print("warning     {}\n", warning);
}

void print_names(const SliceReport& slice) {
    constexpr std::size_t kMostNames = 30;
    const std::size_t shown = std::min(kMostNames, slice.names.size());
    for (std::size_t i = 0; i < shown; ++i) fmt::print("seen        {}\n", text_of(slice.names[i]));
    if (shown < slice.names.size())
        fmt::print("seen        and {} names more (--json has all)\n", slice.names.size() - shown);
}

/// The most that a plan takes of the user's time, and the least that it measures for [s].
constexpr double kPlanSeconds = 4, kLeastMeasured = 1;

void plan_command(const CommandLine& line) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    Work work(line);
    count_off_slice(work.scene, work.plan);
    warn_of_hidden_glass(work.scene, work.plan);
    const std::vector<int> frames = parse_frames("", work.plan.frames);
    Cost cost;
    std::optional<SliceReport> slice;
    parallel::Threads(line.threads).run([&] {
        const double left =
            kPlanSeconds - std::chrono::duration<double>(Clock::now() - begin).count();
        cost = measure_cost(work.scene, work.plan, line.trajectory, frames,
                            std::max(kLeastMeasured, left));
        if (line.trajectory.empty() && work.plan.moves) return;
        slice = look_at_slice(work.scene, line.trajectory, frames);
        for (std::string& warning : slice->warnings)
            work.plan.warnings.push_back(std::move(warning));
    });
    const std::uint64_t taken = stored_steps(work.scene, 0).back();
    if (!line.json) {
        print_plan(work.plan, cost, taken);
        if (slice) print_names(*slice);
        return;
    }
    Json json = to_json(work.plan);
    json["steps_to_last_frame"] = taken;
    json["simulate_seconds"] = cost.simulate_seconds;
    json["render_seconds"] = cost.render_seconds;
    json["frame_bytes"] = cost.frame_bytes;
    json["measured"] = cost.measured;
    json["guessed"] = cost.guessed;
    if (slice)
        for (const InPicture& body : slice->names) json["in_picture"].push_back(to_json(body));
    fmt::print("{}\n", json.dump(-1, ' ', false, Json::error_handler_t::replace));
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

void print_result(const CommandLine& line, const Json& json, const std::string& text) {
    fmt::print("{}\n", line.json ? json.dump() : text);
}

int execute(const CommandLine& line) {
    int status = 0;
    if (line.command == "simulate") simulate_command(line);
    if (line.command == "run" || line.command == "render") run_command(line);
    if (line.command == "film") movie_command(line);
    if (line.command == "view") view_command(line);
    if (line.command == "plan") plan_command(line);
    if (line.command == "info") info_command(line);
    if (line.command == "hash") hash_command(line);
    if (line.command == "diff") status = diff_command(line);
    if (line.command == "plot") plot_command(line);
    if (line.command == "export") export_command(line);
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
