// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/command_line.hpp"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <initializer_list>
#include <sstream>

#include "core/error.hpp"
#include "parallel/threads.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/program/options.hpp"

namespace tesserae::scenes {
namespace {

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

/// Completion is of a shell, and nothing else is.
void require_known_shell(const CommandLine& line) {
    constexpr std::string_view kShells[] = {"bash", "zsh", "fish"};
    if (line.topic != "completion") {
        if (line.shell.empty()) return;
        throw InputError(
            fmt::format("reference {} {}: expected one topic", line.topic, toml_text(line.shell)));
    }
    if (std::find(std::begin(kShells), std::end(kShells), line.shell) != std::end(kShells)) return;
    throw InputError(fmt::format("reference completion {}: expected one of {}{}",
                                 toml_text(line.shell), fmt::join(kShells, ", "),
                                 did_you_mean(line.shell, kShells)));
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
    } catch (const CLI::CallForVersion&) {
        line.command = "--version";
        line.json = app["--json"]->count() > 0;
        return line;
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
    if (line.command == "reference") require_known_shell(line);
    if (!typed.tiles.empty()) line.tiles = part_of(typed.tiles);
    append_overrides(chosen, typed, line.sets);
    if (line.threads == 0) line.threads = parallel::granted_cores();
    return line;
}

}  // namespace tesserae::scenes
