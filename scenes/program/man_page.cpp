// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/man_page.hpp"

#include <fmt/ranges.h>

#include "scenes/process/version.hpp"

namespace tesserae::scenes {
namespace {

/// Text of people, to be set as it is: no character of it is a request or an escape of roff.
std::string plain(const std::string& text) {
    std::string escaped = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
    for (const char c : text) {
        if (c == '\\')
            escaped += "\\e";
        else if (c == '-')
            escaped += "\\-";
        else if (c == '\'')
            escaped += "\\(aq";
        else
            escaped += c;
    }
    return escaped;
}

std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + plain(text) + "\\fR"; }

/// "-o, --output DIR" and what it is.
std::string paragraph(const OptionHelp& option) {
    std::vector<std::string> words;
    for (const std::string& name : option.names)
        words.push_back(option.is_positional ? italic(name) : bold(name));
    std::string head = fmt::format("{}", fmt::join(words, ", "));
    if (!option.value.empty()) head += " " + italic(option.value);
    return fmt::format(".TP\n{}\n{}{}\n", head, plain(option.about),
                       option.is_required ? " (required)" : "");
}

std::string paragraphs(const std::vector<OptionHelp>& options) {
    std::string text;
    for (const bool positional : {true, false})
        for (const OptionHelp& option : options)
            if (option.is_positional == positional) text += paragraph(option);
    return text;
}

}  // namespace

std::string man_page(const ProgramHelp& help) {
    const std::string purpose = help.about.substr(help.about.find(": ") + 2);
    std::string text = fmt::format(
        ".\\\" Printed by: {0} reference man\n"
        ".TH {1} 1 \"\" \"{0} {2}\" \"User Commands\"\n"
        ".SH NAME\n{0} \\- {3}\n"
        ".SH SYNOPSIS\n{4} {5} [{6}]\n.br\n{4} {7} | {8} [{9}]\n"
        ".SH OPTIONS\n{10}.SH COMMANDS\n",
        help.name, "TESSERAE", program_version(), plain(purpose), bold(help.name),
        italic("COMMAND"), italic("ARGUMENTS"), bold("--help"), bold("--version"), bold("--json"),
        paragraphs(help.options));
    for (const CommandHelp& command : help.commands)
        text += fmt::format(".SS \"{} {}\"\n{}\n{}", help.name, command.name, plain(command.about),
                            paragraphs(command.options));
    const std::string statuses = help.exit_statuses.substr(help.exit_statuses.find(": ") + 2);
    return text + fmt::format(".SH EXIT STATUS\n{}\n", plain(statuses));
}

}  // namespace tesserae::scenes
