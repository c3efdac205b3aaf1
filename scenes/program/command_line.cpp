#include "scenes/program/command_line.hpp"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <initializer_list>
#include <sstream>

#include "core/dynamics/motion_version.hpp"
#include "core/error.hpp"
#include "parallel/threads.hpp"
#include "render/picture_version.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/process/messages.hpp"

namespace tesserae::scenes {
namespace {

constexpr int kMaxThreads = 1024;
constexpr int kMostTileParts = 100'000;

/// Whole numbers of `text` between separators, exactly `count` of them.
std::vector<int> numbers(const std::string& option, const std::string& text, char separator,
                         std::size_t count, const char* expected) {
    std::vector<int> values;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (values.size() < count) {
        int value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc()) break;
        values.push_back(value);
        at = next;
        if (at != end && *at == separator && values.size() < count)
            ++at;
        else
            break;
    }
    if (values.size() != count || at != end)
        throw InputError(fmt::format("{} {}: expected {}", option, text, expected));
    return values;
}

/// Options of one subcommand, as typed.
struct Typed {
    std::string size, crop, integrator, intersector, tiles;
    int samples = 0;
};

void add_common(CLI::App& app, CommandLine& line) {
    app.add_option("--threads", line.threads, "threads (default: the cores granted to the process)")
        ->check(CLI::Range(1, kMaxThreads));
    app.add_flag("--quiet", line.quiet, "no progress line");
    app.add_flag("--json", line.json, "one JSON object on standard output, at the end");
}

void add_scene(CLI::App& app, CommandLine& line) {
    add_common(app, line);
    app.add_option("scene", line.file, "scene file (TOML)")->required();
    app.add_option("--set", line.sets,
                   "one scene key, for example physics.iterations=20 or body.NAME.mass=2")
        ->allow_extra_args(false);
}

void add_output(CLI::App& app, CommandLine& line, const char* what) {
    app.add_option("-o,--output", line.output, what)->required();
    app.add_flag("--overwrite", line.overwrite, "replace results of another scene");
}

void add_frames(CLI::App& app, CommandLine& line, const char* what) {
    app.add_option("--frames", line.frames, what);
}

constexpr const char* kFrames = "for example 0-239x2,300 (default: all)";

void add_picture(CLI::App& app, CommandLine& line, Typed& typed) {
    add_frames(app, line, kFrames);
    app.add_option("--size", typed.size, "WIDTHxHEIGHT, instead of the scene's");
    app.add_option("--samples", typed.samples, "a pixel, instead of the scene's");
    app.add_option("--crop", typed.crop, "x0,y0,x1,y1: pixels from the top left, half open");
    app.add_option("--integrator", typed.integrator, "direct or path");
    app.add_option("--intersector", typed.intersector, "trace or analytic");
    app.add_flag("--draft", line.draft,
                 "a tenth of the time: small, few samples, direct, every second frame, into "
                 "DIR/draft");
}

void add_simulation(CLI::App& app, CommandLine& line) {
    app.add_option("--store-every", line.store_every,
                   "store every K-th step (default: the steps that the frames need)")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 53));
    app.add_option("--trace", line.trace,
                   "which thread simulated what when, as JSON for Perfetto or chrome://tracing");
}

void add_view(CLI::App& app, CommandLine& line) {
    CLI::App& view = *app.add_subcommand(
        "view", "one self-contained page, to look around in the slice with a browser");
    add_common(view, line);
    view.add_option("file", line.file,
                    "scene file (TOML), simulated first into FILE.h5 where bodies move; or a "
                    "trajectory (HDF5)")
        ->required();
    view.add_option("--set", line.sets, "one scene key, for example render.frames_per_second=12")
        ->allow_extra_args(false);
    add_output(view, line, "the page: FILE.html");
    add_frames(view, line, "that the page shows, for example 0 or 0-239x2 (default: all)");
    view.add_option("--near-slice", line.near_slice,
                    "leave out bodies that never come as near as this to the film's slice [m]")
        ->check(CLI::NonNegativeNumber);
}

void add_compare(CLI::App& app, CommandLine& line) {
    CLI::App& hash = *app.add_subcommand(
        "hash", "a short hash of what is in files, to compare on different machines");
    add_common(hash, line);
    hash.add_option(
            "files", line.files,
            ".h5, .exr or .toml files, or folders of frames: names, types and values count, "
            "not compression or program version")
        ->required();

    CLI::App& diff = *app.add_subcommand(
        "diff", "where two trajectories, images, scenes or folders of frames first differ");
    add_common(diff, line);
    diff.add_option("files", line.files, "A and B, of one kind; exit status 1 if they differ")
        ->required()
        ->expected(2);
}

void add_tools(CLI::App& app, CommandLine& line) {
    CLI::App& plot = *app.add_subcommand(
        "plot",
        "energies, momenta, contacts, overlap and residual over time, or what joints do, by "
        "gnuplot");
    add_common(plot, line);
    plot.add_option("file", line.file, "trajectory (HDF5)")->required();
    add_output(plot, line, "the picture: FILE.svg or FILE.png");
    plot.add_option("--joint", line.joints,
                    "a joint's name: its impulses, errors and position instead")
        ->allow_extra_args(false);

    CLI::App& exported = *app.add_subcommand(
        "export", "the slice's bodies as meshes, a frame a file, for other programs");
    add_common(exported, line);
    exported.add_option("file", line.file, "trajectory (HDF5)")->required();
    exported
        .add_option("--set", line.sets,
                    "one key of the trajectory's scene, for example camera.position=[0,2,-8,0.5]")
        ->allow_extra_args(false);
    exported.add_option("--format", line.format, "ply, or vtk (ParaView opens NAME.pvd)")
        ->required()
        ->check(CLI::IsMember({"ply", "vtk"}));
    add_output(exported, line, "folder for the meshes and the camera's path");
    add_frames(exported, line, kFrames);
    exported
        .add_option("--tolerance", line.tolerance,
                    "how far a round body's mesh may be from its surface [m] (default: a "
                    "thousandth of its diameter)")
        ->check(CLI::PositiveNumber);
    exported
        .add_option("--extent", line.extent,
                    "where planes end: half the side of a cube about the first frame's camera [m] "
                    "(default: over a thousand times as far as any body at the start)")
        ->check(CLI::PositiveNumber);
}

void add_farm(CLI::App& app, CommandLine& line, Typed& typed) {
    CLI::App& submit = *app.add_subcommand("submit", "job scripts of a film for Slurm or any farm");
    add_scene(submit, line);
    add_output(submit, line, "folder that all nodes see: job scripts, trajectory, frames");
    add_picture(submit, line, typed);
    FarmRequest& farm = line.farm;
    const auto count = CLI::Range(1, 10'000'000);
    submit.add_flag("--now", farm.now, "submit to Slurm, not only write the scripts");
    submit.add_option("--for", farm.kind, "slurm, or commands: one a task, for any other farm")
        ->check(CLI::IsMember({"slurm", "commands"}));
    submit.add_option("--partition", farm.partition, "Slurm's partition");
    submit.add_option("--account", farm.account, "Slurm's account");
    submit.add_option("--max-running", farm.max_running, "tasks at once")->check(count);
    submit.add_option("--cores", farm.cores, "of a task (default: 4)")->check(count);
    submit.add_option("--chunk", farm.chunk, "frames of a task (default: some minutes of them)")
        ->check(count);
    submit.add_option("--sbatch", farm.sbatch, "any further option of sbatch")
        ->allow_extra_args(false);

    CLI::App& join = *app.add_subcommand("join", "whole frames of the parts of render --tiles");
    add_common(join, line);
    join.add_option("folder", line.file, "DIR of render")->required();

    CLI::App& status = *app.add_subcommand(
        "status", "frames complete, missing, invalid; exit status 0 only when complete");
    add_common(status, line);
    status.add_option("folder", line.file, "DIR of run, render or submit")->required();
}

render::FramePart part_of(const std::string& text) {
    const char* const expected = "K/N, the K-th of N parts, for example 3/8";
    const auto v = numbers("--tiles", text, '/', 2, expected);
    if (v[0] < 1 || v[0] > v[1] || v[1] > kMostTileParts)
        throw InputError(fmt::format("--tiles {}: expected {}, 1 <= K <= N <= {}", text, expected,
                                     kMostTileParts));
    return {v[0], v[1]};
}

/// Each option that overrides a scene key becomes an entry of the same kind as --set.
void append_overrides(const CLI::App& app, const Typed& typed, std::vector<std::string>& sets) {
    const auto given = [&](const char* name) {
        const CLI::Option* option = app.get_option_no_throw(name);
        return option != nullptr && option->count() > 0;
    };
    if (given("--size")) {
        const auto v = numbers("--size", typed.size, 'x', 2, "WIDTHxHEIGHT, for example 1920x1080");
        sets.push_back(fmt::format("render.size=[{}, {}]", v[0], v[1]));
    }
    if (given("--samples")) sets.push_back(fmt::format("render.samples={}", typed.samples));
    if (given("--crop")) {
        const auto v = numbers("--crop", typed.crop, ',', 4, "x0,y0,x1,y1, for example 0,0,64,64");
        sets.push_back(fmt::format("render.crop=[{}, {}, {}, {}]", v[0], v[1], v[2], v[3]));
    }
    if (given("--integrator")) sets.push_back("render.integrator=" + toml_text(typed.integrator));
    if (given("--intersector"))
        sets.push_back("render.intersector=" + toml_text(typed.intersector));
}

/// The library's own message for a misspelt command names neither it nor its neighbour.
void require_known_command(const CLI::App& app, const std::string& word) {
    std::vector<std::string> offered;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        if (word == command->get_name()) return;
        if (!command->get_group().empty()) offered.push_back(command->get_name());
    }
    if (word.starts_with('-')) return;
    if (word == "help")
        throw InputError(
            "unknown command \"help\": expected tesserae --help, or tesserae COMMAND "
            "--help");
    const std::vector<std::string_view> names(offered.begin(), offered.end());
    throw InputError(fmt::format("unknown command {}: expected one of {}{}", toml_text(word),
                                 fmt::join(names, ", "), did_you_mean(word, names)));
}

/// The library's own message for a misspelt option names no neighbour.
std::string meant_option(const CLI::App& app, const std::vector<std::string>& left) {
    const CLI::App& command = app.get_subcommands().empty() ? app : *app.get_subcommands().front();
    std::vector<std::string> offered;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) offered.push_back("--" + name);
    const std::vector<std::string_view> names(offered.begin(), offered.end());
    for (const std::string& word : left) {
        const std::string option = word.substr(0, word.find('='));
        if (!option.starts_with("--")) continue;
        if (std::string hint = did_you_mean(option, names); !hint.empty()) return hint;
        // The beginning of one: --out.
        for (std::string_view name : names)
            if (option.size() > 3 && name.starts_with(option))
                return fmt::format("; did you mean \"{}\"?", name);
    }
    return {};
}

/// A folder or file that is written must not be named as something else is.
void require_output_kind(const CommandLine& line) {
    const std::string extension = line.output.extension().string();
    const auto is_one_of = [&](std::initializer_list<std::string_view> known) {
        return std::find(known.begin(), known.end(), extension) != known.end();
    };
    const bool is_other_file = is_one_of({".csv", ".exr", ".html", ".json", ".mov", ".mp4", ".ply",
                                          ".png", ".svg", ".toml", ".txt", ".vtk"});
    const auto refuse = [&](const char* what) {
        throw InputError(fmt::format("-o {}: expected {}", line.output.string(), what));
    };
    const std::string& command = line.command;
    if (command == "simulate" && is_other_file)
        refuse("a file of HDF5: simulate writes a trajectory, FILE.h5");
    if ((command == "run" || command == "render" || command == "submit") &&
        (is_other_file || extension == ".h5") && !std::filesystem::is_directory(line.output))
        refuse("a folder: frames are written as DIR/frames/NAME.0000.exr");
    if (command == "export" && (is_other_file || extension == ".h5") &&
        !std::filesystem::is_directory(line.output))
        refuse("a folder: meshes are written into it, a frame a file");
}

void require_known_generator(const std::string& name) {
    if (std::find(std::begin(kGenerators), std::end(kGenerators), name) != std::end(kGenerators))
        return;
    throw InputError(fmt::format("generate {}: expected one of {}{}", toml_text(name),
                                 fmt::join(kGenerators, ", "), did_you_mean(name, kGenerators)));
}

constexpr const char* kAbout = "tesserae: rigid bodies in four dimensions, simulated and filmed";

void add_commands(CLI::App& app, CommandLine& line, Typed& typed) {
    app.set_version_flag("--version",
                         fmt::format("tesserae {} (motion version {}, picture version {})",
                                     TESSERAE_VERSION, kMotionVersion, render::kPictureVersion));
    app.require_subcommand(1);
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::Throw);

    CLI::App& run = *app.add_subcommand("run", "simulate, render, preview: the main job");
    add_scene(run, line);
    add_output(run, line, "folder for the trajectory, frames, previews and report");
    add_picture(run, line, typed);
    add_simulation(run, line);

    CLI::App& simulate = *app.add_subcommand("simulate", "move the bodies, store a trajectory");
    add_scene(simulate, line);
    add_output(simulate, line, "trajectory file (HDF5)");
    add_frames(simulate, line,
               "to the last of these, for example 0-9 (default: to the last of all)");
    add_simulation(simulate, line);

    CLI::App& render = *app.add_subcommand("render", "frames of a still, or of a trajectory");
    add_scene(render, line);
    add_output(render, line, "folder for the frames and previews");
    render.add_option("--trajectory", line.trajectory,
                      "made by tesserae simulate (default: simulates first where bodies move)");
    render.add_option("--tiles", typed.tiles,
                      "K/N: the K-th of N parts of each frame, for tesserae join");
    add_picture(render, line, typed);

    CLI::App& film = *app.add_subcommand("film", "an MP4 of a folder's previews, by ffmpeg");
    add_common(film, line);
    film.add_option("folder", line.file, "that run or render has made")->required();

    add_view(app, line);

    CLI::App& plan =
        *app.add_subcommand("plan", "what a scene needs, what is left out, what it costs");
    add_scene(plan, line);
    add_frames(plan, line, kFrames);
    plan.add_option("--trajectory", line.trajectory,
                    "made by tesserae simulate: tells when bodies are in the picture");

    CLI::App& info = *app.add_subcommand("info", "a summary of a scene, trajectory or image");
    add_common(info, line);
    info.add_option("file", line.file, "a .toml, .h5 or .exr file")->required();

    add_compare(app, line);
    add_tools(app, line);

    CLI::App& generate =
        *app.add_subcommand("generate", "a many-body scene, as TOML on standard output");
    generate.add_option("name", line.generator, fmt::format("{}", fmt::join(kGenerators, ", ")))
        ->required();
    generate.add_option("--bodies", line.bodies, "how many, beside floor and walls")
        ->required()
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000}));

    CLI::App& reference = *app.add_subcommand(
        "reference", "every table and key of scene files: unit, default, range, meaning");
    reference.add_option("topic", line.topic,
                         "a table, key or shape, for example render, body.friction, hyperbox; or "
                         "commands (default: all of scene files)");

    add_farm(app, line, typed);
}

}  // namespace

CommandLine parse_command_line(int argc, const char* const* argv) {
    CommandLine line;
    Typed typed;
    CLI::App app(kAbout, "tesserae");
    add_commands(app, line, typed);
    if (argc > 1) require_known_command(app, argv[1]);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        std::ostringstream text;
        app.exit(help, text, text);
        put(text.str());
        return line;
    } catch (const CLI::ParseError& error) {
        throw InputError(
            fmt::format("{}{} (tesserae --help, or tesserae COMMAND --help, tells more)",
                        error.what(), meant_option(app, app.remaining(true))));
    }
    const CLI::App& chosen = *app.get_subcommands().front();
    line.command = chosen.get_name();
    if (const auto* frames = chosen.get_option_no_throw("--frames");
        frames != nullptr && frames->count() > 0 && line.frames.empty())
        throw InputError("--frames \"\": expected frames, for example 0-239x2,300");
    for (const CLI::Option* option : chosen.get_options()) {
        const auto& values = option->results();
        if (std::find(values.begin(), values.end(), "") != values.end())
            throw InputError(fmt::format("{} \"\": expected a value", option->get_name()));
    }
    require_output_kind(line);
    if (line.command == "generate") require_known_generator(line.generator);
    if (!typed.tiles.empty()) line.tiles = part_of(typed.tiles);
    append_overrides(chosen, typed, line.sets);
    if (line.threads == 0) line.threads = parallel::granted_cores();
    return line;
}

std::string commands_page() {
    CommandLine line;
    Typed typed;
    CLI::App app(kAbout, "tesserae");
    add_commands(app, line, typed);
    std::string page =
        "# Commands\n\nWhat every command does and which options it has. The program prints this "
        "page: `tesserae reference commands`.\n";
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        std::string help = command->help();
        // The library's versions end it with one empty line or none.
        help.erase(help.find_last_not_of('\n') + 1);
        page += fmt::format("\n## tesserae {}\n\n```text\n{}\n```\n", command->get_name(), help);
    }
    return page;
}

}  // namespace tesserae::scenes
