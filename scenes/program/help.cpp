// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/help.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "scenes/load/reference_tables.hpp"
#include "scenes/program/options.hpp"

namespace tesserae::scenes {
namespace {

std::vector<std::string> parts(std::string_view text, char separator) {
    std::vector<std::string> found;
    for (std::size_t end = 0; end != text.npos; text.remove_prefix(std::min(text.size(), end + 1)))
        found.emplace_back(text.substr(0, end = text.find(separator)));
    return found;
}

/// Reads what the name of an option's value tells: see options.hpp.
void read_value(OptionHelp& option, const std::vector<std::string>& topics) {
    const std::string_view value = option.value;
    constexpr std::string_view kFile = "FILE.";
    const std::size_t open = value.find('{'), close = value.find('}');
    if (close != value.npos) option.words = parts(value.substr(open + 1, close - open - 1), ',');
    if (value == "TOPIC") option.words = topics;
    if (value.starts_with(kFile))
        for (const std::string& kind : parts(value.substr(kFile.size()), '|'))
            option.endings.push_back("." + kind);
    option.is_folder = value == "DIR";
    option.is_key = value == "KEY=VALUE";
}

std::vector<OptionHelp> options_of(const CLI::App& app, const std::vector<std::string>& topics) {
    std::vector<OptionHelp> options;
    for (const CLI::Option* option : app.get_options()) {
        OptionHelp help;
        help.is_positional = option->get_positional();
        if (help.is_positional) help.names.push_back(option->get_name(true));
        for (const std::string& name : option->get_snames()) help.names.push_back("-" + name);
        for (const std::string& name : option->get_lnames()) help.names.push_back("--" + name);
        if (option->get_items_expected_max() > 0) help.value = option->get_type_name();
        help.about = option->get_description();
        help.is_required = option->get_required();
        help.most = std::clamp(option->get_items_expected_max(), 1, kManyTimes);
        read_value(help, topics);
        options.push_back(std::move(help));
    }
    return options;
}

/// What `tesserae reference` prints a page of.
std::vector<std::string> topics_of(const std::vector<ReferenceTable>& tables) {
    std::vector<std::string> topics = {"commands", "completion", "man"};
    for (const ReferenceTable& table : tables) {
        topics.push_back(table.name);
        for (const ReferencePart& part : table.parts)
            for (const ReferenceRow& row : part.rows) topics.push_back(table.name + "." + row.key);
    }
    std::sort(topics.begin(), topics.end());
    topics.erase(std::unique(topics.begin(), topics.end()), topics.end());
    return topics;
}

/// The keys of tables that stand alone: bodies, lights and the like are reached by names of a
/// scene.
std::vector<std::string> keys_of(const std::vector<ReferenceTable>& tables) {
    std::vector<std::string> keys;
    for (const ReferenceTable& table : tables)
        if (!table.header.starts_with("[["))
            for (const ReferencePart& part : table.parts)
                for (const ReferenceRow& row : part.rows)
                    keys.push_back(table.name + "." + row.key);
    return keys;
}

/// All commands, in the order in which --help lists them.
std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

}  // namespace

ProgramHelp program_help() {
    CommandLine line;
    Typed typed;
    CLI::App app(kAbout, "tesserae");
    add_commands(app, line, typed);
    const std::vector<ReferenceTable> tables = all_reference_tables();
    const std::vector<std::string> topics = topics_of(tables);
    ProgramHelp help = {
        app.get_name(), app.get_description(), app.get_footer(), options_of(app, topics), {},
        keys_of(tables)};
    for (const CLI::App* command : commands_of(app))
        help.commands.push_back(
            {command->get_name(), command->get_description(), options_of(*command, topics)});
    return help;
}

std::string commands_page() {
    CommandLine line;
    Typed typed;
    CLI::App app(kAbout, "tesserae");
    add_commands(app, line, typed);
    std::string page =
        "# Commands\n\nWhat every command does and which options it has. The program prints this "
        "page: `tesserae reference commands`.\n";
    for (const CLI::App* command : commands_of(app)) {
        std::string help = command->help();
        // The library's versions end it with one empty line or none.
        help.erase(help.find_last_not_of('\n') + 1);
        page += fmt::format("\n## tesserae {}\n\n```text\n{}\n```\n", command->get_name(), help);
    }
    return page;
}

}  // namespace tesserae::scenes
