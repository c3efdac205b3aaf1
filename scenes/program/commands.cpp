// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/commands.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>

#include "core/error.hpp"
#include "parallel/threads.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/load/reference.hpp"
#include "scenes/plan/cost.hpp"
#include "scenes/plan/in_slice.hpp"
#include "scenes/plan/overlaps.hpp"
#include "scenes/plan/plan_picture.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/program/compare_commands.hpp"
#include "scenes/program/completion.hpp"
#include "scenes/program/farm_commands.hpp"
#include "scenes/program/film_commands.hpp"
#include "scenes/program/help.hpp"
#include "scenes/program/info.hpp"
#include "scenes/program/man_page.hpp"
#include "scenes/program/tool_commands.hpp"
#include "scenes/program/view_command.hpp"
#include "scenes/program/work.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;
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
            {"joints", plan.joints},
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

/// @param frames   that are asked for
/// @param taken    steps to the last of them
void print_plan(const Plan& plan, const Cost& cost, std::size_t frames, std::uint64_t taken) {
    const bool is_part = frames < static_cast<std::size_t>(plan.frames);
    put_line("bodies      {} ({} movable)", plan.bodies, plan.movable_bodies);
    if (plan.joints > 0) put_line("joints      {}", plan.joints);
    put_line("steps       {}{}", plan.steps,
             plan.moves && taken < plan.steps
                 ? fmt::format(" ({} to the last frame{})", taken, is_part ? " of these" : "")
                 : "");
    put_line("frames      {}{}", plan.frames, is_part ? fmt::format(", {} of them", frames) : "");
    put_line("view rays   {}", plan.view_rays);
    const char* const rough = cost.is_rough() ? ", roughly" : "";
    if (plan.moves) put_line("simulating  about {}{}", duration_text(cost.simulate_seconds), rough);
    put_line("rendering   about {}{}", duration_text(cost.render_seconds), rough);
    for (const std::string& text : cost.measured) put_line("measured    {}", text);
    for (const std::string& text : cost.guessed) put_line("guessed     {}", text);
    put_line("memory      {}", gigabytes(plan.memory_bytes));
    put_line("trajectory  at most {}", gigabytes(plan.trajectory_bytes));
    if (plan.moves)
        put_line("checkpoint  about {}, two of them until it is done",
                 gigabytes(plan.checkpoint_bytes));
    put_line("frames      about {}", gigabytes(cost.frame_bytes));
    for (const Decision& d : plan.decisions)
        put_line("{:9}   {}: {}", d.needed ? "needed" : "left out", d.part, d.reason);
    for (const std::string& warning : plan.warnings) put_line("warning     {}", warning);
}

void print_names(const SliceReport& slice) {
    constexpr std::size_t kMostNames = 30;
    const std::size_t shown = std::min(kMostNames, slice.names.size());
    for (std::size_t i = 0; i < shown; ++i) put_line("seen        {}", text_of(slice.names[i]));
    if (shown < slice.names.size())
        put_line("seen        and {} names more (--json has all)", slice.names.size() - shown);
}

void plan_command(const CommandLine& line) {
    Work work(line);
    count_off_slice(work.scene, work.plan);
    warn_of_hidden_glass(work.scene, work.plan);
    const std::vector<int> frames = parse_frames(line.frames, work.plan.frames);
    narrow_to(work.plan, work.scene, frames);
    Cost cost;
    std::optional<SliceReport> slice;
    parallel::Threads(line.threads).run([&] {
        cost = measure_cost(work.scene, work.plan, line.trajectory, frames,
                            measuring_seconds(work.scene));
        for (std::string& warning : overlap_warnings(work.scene))
            work.plan.warnings.push_back(std::move(warning));
        if (line.trajectory.empty() && work.plan.moves) return;
        slice = look_at_slice(work.scene, line.trajectory, frames);
        for (std::string& warning : slice->warnings)
            work.plan.warnings.push_back(std::move(warning));
    });
    const std::uint64_t taken = last_step_needed(work.scene, frames);
    if (!line.json) {
        print_plan(work.plan, cost, frames.size(), taken);
        if (slice) print_names(*slice);
        return;
    }
    Json json = to_json(work.plan);
    json["frames_asked"] = frames.size();
    json["steps_to_last_frame"] = taken;
    json["simulate_seconds"] = cost.simulate_seconds;
    json["render_seconds"] = cost.render_seconds;
    json["rough"] = cost.is_rough();
    json["frame_bytes"] = cost.frame_bytes;
    json["measured"] = cost.measured;
    json["guessed"] = cost.guessed;
    if (slice)
        for (const InPicture& body : slice->names) json["in_picture"].push_back(to_json(body));
    put_json(json);
}

/// "energy, first row" as "energy_first_row".
std::string json_key(std::string name) {
    std::erase(name, ',');
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

void info_command(const CommandLine& line) {
    const auto facts = facts_about(line.file, line.threads);
    if (line.json) {
        Json json = Json::object();
        for (const Fact& fact : facts) json[json_key(fact.name)] = fact.value;
        // The names that the keys had, until version 0.3.
        for (const Fact& fact : facts) json[fact.name] = fact.value;
        // A file's texts need not be UTF-8.
        put_json(json);
    } else {
        for (const Fact& fact : facts) put_line("{:<24} {}", fact.name, fact.text);
    }
}

/// A page of the manual, or what is made of the same lists for a shell and for man.
std::string reference_text(const CommandLine& line) {
    if (line.topic == "commands") return commands_page();
    if (line.topic == "man") return man_page(program_help());
    if (line.topic != "completion") return reference(line.topic);
    if (line.shell == "zsh") return zsh_completion(program_help());
    return line.shell == "fish" ? fish_completion(program_help()) : bash_completion(program_help());
}

/// Says what is kept, after a signal.
int report_stop() {
    const int signal = stop_signal();
    tell(fmt::format("stopped by signal {}; what is finished is kept, the same command continues",
                     signal));
    return 128 + signal;
}

}  // namespace

void print_result(const CommandLine& line, const Json& json, const std::string& text) {
    if (line.json)
        put_json(json);
    else
        put_line("{}", text);
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
    if (line.command == "reference") put(reference_text(line));
    if (line.command == "generate") put(generated_scene(line.generator, line.bodies));
    return status;
}

namespace {

/// A path that the system does not follow, for example a loop of links: the command line's fault
/// where it was to be read, else that of the place.
int report_path(const fs::filesystem_error& error, const CommandLine& line) {
    tell(fmt::format("{}: {}", error.path1().string(), error.code().message()));
    const bool is_input = error.path1().string().starts_with(line.file.string());
    return is_input && !line.file.empty() ? 2 : 1;
}

/// A line for each of several errors.
void tell_lines(std::string_view text) {
    for (std::size_t end = 0; end != text.npos; text.remove_prefix(std::min(text.size(), end + 1)))
        tell(text.substr(0, end = text.find('\n')));
}

}  // namespace

int program(int argc, const char* const* argv, const Commit& commit) {
    open_standard_streams();
    handle_signals();
    CommandLine line;
    try {
        line = parse_command_line(argc, argv);
        if (line.command != "--version") return execute(line);
        if (line.json)
            put_json(version_json(commit));
        else
            put(version_text(commit));
        return 0;
    } catch (const fs::filesystem_error& error) {
        return report_path(error, line);
    } catch (const Stopped&) {
        return report_stop();
    } catch (const InputError& error) {
        tell_lines(error.what());
        return 2;
    } catch (const std::bad_alloc&) {
        tell("out of memory");
        return 1;
    } catch (const std::exception& error) {
        tell(error.what());
        return 1;
    }
}

}  // namespace tesserae::scenes
