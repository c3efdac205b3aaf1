// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/completion.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace tesserae::scenes {
namespace {

/// All options with dashes, by all of their names.
std::string names_of(const std::vector<OptionHelp>& options, const char* separator) {
    std::vector<std::string> names;
    for (const OptionHelp& option : options)
        if (!option.is_positional)
            names.insert(names.end(), option.names.begin(), option.names.end());
    return fmt::format("{}", fmt::join(names, separator));
}

std::vector<OptionHelp> positionals_of(const std::vector<OptionHelp>& options) {
    std::vector<OptionHelp> positionals;
    std::copy_if(options.begin(), options.end(), std::back_inserter(positionals),
                 [](const OptionHelp& option) { return option.is_positional; });
    return positionals;
}

std::string replaced(std::string text, char what, std::string_view by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size())
        text.replace(at, 1, by);
    return text;
}

// ---- bash ----

constexpr const char* kBash =
    R"sh(# Completion of {name} for bash, printed by: {name} reference completion bash

# Offers the arguments that begin as the current word does.
_{name}_words() {{
    mapfile -t COMPREPLY < <(compgen -W "$*" -- "$current")
}}

# Offers folders, and files that end in one of the arguments.
_{name}_files() {{
    local file ending
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$current")
    for ending in "$@"; do
        while IFS= read -r file; do
            [[ $file != *"$ending" || -d $file ]] || COMPREPLY+=("$file")
        done < <(compgen -f -- "$current")
    done
}}

# Offers keys of scene files, to which a value is then typed.
_{name}_keys() {{
    compopt -o nospace 2>/dev/null
    _{name}_words {keys}
}}

_{name}() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
    COMPREPLY=()
    # What is typed as --option=value is three words here.
    if [[ $current == = ]]; then
        current=
    elif [[ $previous == = ]]; then
        previous=${{COMP_WORDS[COMP_CWORD - 2]}}
        # The value of a key: nothing is known of it.
        [[ $previous == -* ]] || return
    fi
    if ((COMP_CWORD == 1)); then
        _{name}_words {commands} {options}
        return
    fi
    case ${{COMP_WORDS[1]}} in
{cases}    esac
}}
complete -F _{name} {name}
)sh";

/// The call that offers what an option takes; empty: nothing is known of it.
std::string bash_call(const OptionHelp& option) {
    if (!option.words.empty()) return fmt::format("words {}", fmt::join(option.words, " "));
    if (!option.endings.empty()) return fmt::format("files {}", fmt::join(option.endings, " "));
    if (option.is_folder) return "files";
    return option.is_key ? "keys" : "";
}

std::string bash_case(const std::string& name, const CommandHelp& command) {
    std::string text = fmt::format("    {})\n        case $previous in\n", command.name);
    std::vector<std::string> unknown;
    for (const OptionHelp& option : command.options) {
        if (option.is_positional || option.value.empty()) continue;
        const std::string names = fmt::format("{}", fmt::join(option.names, " | "));
        const std::string call = bash_call(option);
        if (call.empty())
            unknown.push_back(names);
        else
            text += fmt::format("        {}) _{}_{}; return ;;\n", names, name, call);
    }
    if (!unknown.empty()) text += fmt::format("        {}) return ;;\n", fmt::join(unknown, " | "));
    text += fmt::format(
        "        esac\n        case $current in\n        -*) _{}_words {} ;;\n        *)\n", name,
        names_of(command.options, " "));
    const std::vector<OptionHelp> positionals = positionals_of(command.options);
    const auto call_of = [&](const OptionHelp& option) {
        return fmt::format("_{}_{}", name, bash_call(option));
    };
    if (positionals.size() == 1)
        text += fmt::format("            {}\n", call_of(positionals.front()));
    for (std::size_t i = 0; positionals.size() > 1 && i < positionals.size(); ++i)
        text +=
            fmt::format("            ((COMP_CWORD == {})) && {}\n", i + 2, call_of(positionals[i]));
    return text + "            ;;\n        esac\n        ;;\n";
}

// ---- zsh ----

constexpr const char* kZsh = R"sh(#compdef {name}
# Completion of {name} for zsh, printed by: {name} reference completion zsh

# Offers keys of scene files, to which a value is then typed.
_{name}_keys() {{
    compadd -S '' -- {keys}
}}

_{name}() {{
    local context state state_descr line
    typeset -A opt_args
    local -a commands=(
{commands}    )
    _arguments -C \
{options}        '1:command:->command' \
        '*::argument:->argument'
    case $state in
    command) _describe command commands ;;
    argument)
        case $words[1] in
{cases}        esac
        ;;
    esac
}}

# Sourced it is set as the completion; found in fpath it is called.
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
    _{name} "$@"
else
    compdef _{name} {name}
fi
)sh";

/// Inside '...' of zsh.
std::string zsh_quoted(const std::string& text) { return replaced(text, '\'', R"('\'')"); }

/// A text within a specification of _arguments, whose parts brackets and colons end.
std::string zsh_part(std::string text) {
    text = replaced(replaced(replaced(text, '\\', R"(\\)"), '[', R"(\[)"), ']', R"(\])");
    return zsh_quoted(replaced(text, ':', R"(\:)"));
}

std::string zsh_action(const std::string& name, const OptionHelp& option) {
    if (!option.words.empty()) return fmt::format("({})", fmt::join(option.words, " "));
    // A last group of one name would be read as a question about files, not as an alternative.
    if (option.endings.size() == 1) return fmt::format("_files -g \"*{}\"", option.endings[0]);
    if (!option.endings.empty())
        return fmt::format("_files -g \"*({})\"", fmt::join(option.endings, "|"));
    if (option.is_folder) return "_files -/";
    return option.is_key ? fmt::format("_{}_keys", name) : " ";
}

/// The lines of one option: one a name; of a positional as many as there may be.
std::string zsh_lines(const std::string& name, const OptionHelp& option) {
    const std::string what = zsh_part(option.is_positional ? option.about : option.value);
    const std::string value = fmt::format(":{}:{}", what, zsh_quoted(zsh_action(name, option)));
    std::string text;
    if (option.is_positional) {
        if (option.most == kManyTimes) return fmt::format("            '*{}' \\\n", value);
        for (int i = 0; i < option.most; ++i) text += fmt::format("            '{}' \\\n", value);
        return text;
    }
    for (const std::string& word : option.names) {
        const std::string others =
            option.most > 1 ? "*" : fmt::format("({})", fmt::join(option.names, " "));
        const char* const joined = word.starts_with("--") ? "=" : "+";
        text += fmt::format("            '{}{}{}[{}]{}' \\\n", others, word,
                            option.value.empty() ? "" : joined, zsh_part(option.about),
                            option.value.empty() ? "" : value);
    }
    return text;
}

std::string zsh_lines(const std::string& name, const std::vector<OptionHelp>& options) {
    std::string text;
    for (const OptionHelp& option : options) text += zsh_lines(name, option);
    return text;
}

std::string zsh_case(const std::string& name, const CommandHelp& command) {
    std::string lines = zsh_lines(name, command.options);
    lines.resize(lines.size() - 3);  // the last one's " \" and its end
    return fmt::format("        {})\n            _arguments -s \\\n{}\n            ;;\n",
                       command.name, lines);
}

// ---- fish ----

constexpr const char* kFish =
    R"sh(# Completion of {name} for fish, printed by: {name} reference completion fish

# Whether the command is the argument; without one whether there is none yet.
function __{name}_is
    set -l words (commandline -opc)
    test "$words[2]" = "$argv[1]"
end

# Whether so many words follow the command.
function __{name}_has
    test (count (commandline -opc)) = (math $argv[1] + 2)
end

# Offers folders, and files that end in one of the arguments.
function __{name}_files
    set -l endings / (string escape --style=regex -- $argv)
    complete -C "'' "(commandline -ct) | string match -r -- '^[^\t]*(?:'(string join '|' $endings)')(?=\t|$)'
end

complete -c {name} -f
{commands}{options})sh";

/// Inside '...' of fish.
std::string fish_quoted(const std::string& text) {
    return replaced(replaced(text, '\\', R"(\\)"), '\'', R"(\')");
}

/// What a value may be, as the argument of -a.
std::string fish_offer(const std::string& name, const ProgramHelp& help, const OptionHelp& option) {
    if (!option.words.empty()) return fmt::format("{}", fmt::join(option.words, " "));
    if (!option.endings.empty() || option.is_folder)
        return fmt::format("(__{}_files{}{})", name, option.endings.empty() ? "" : " ",
                           fmt::join(option.endings, " "));
    return option.is_key ? fmt::format("{}=", fmt::join(help.keys, "= ")) : "";
}

std::string fish_lines(const ProgramHelp& help, const std::string& command,
                       const std::vector<OptionHelp>& options) {
    std::string text;
    const std::size_t positionals = positionals_of(options).size();
    std::size_t place = 0;
    for (const OptionHelp& option : options) {
        const std::string offer = fish_offer(help.name, help, option);
        std::string condition = fmt::format("__{}_is {}", help.name, command);
        if (option.is_positional && positionals > 1)
            condition += fmt::format("; and __{}_has {}", help.name, place++);
        text += fmt::format("complete -c {} -n '{}'", help.name, condition);
        for (const std::string& word : option.names) {
            if (option.is_positional) continue;
            const bool is_long = word.starts_with("--");
            text += fmt::format(" -{} {}", is_long ? 'l' : 's', word.substr(is_long ? 2 : 1));
        }
        if (!option.is_positional && !option.value.empty()) text += " -x";
        if (!offer.empty()) text += fmt::format(" -a '{}'", fish_quoted(offer));
        if (!option.is_positional) text += fmt::format(" -d '{}'", fish_quoted(option.about));
        text += "\n";
    }
    return text;
}

}  // namespace

std::string bash_completion(const ProgramHelp& help) {
    std::string cases;
    std::vector<std::string> commands;
    for (const CommandHelp& command : help.commands) {
        commands.push_back(command.name);
        cases += bash_case(help.name, command);
    }
    return fmt::format(kBash, fmt::arg("name", help.name),
                       fmt::arg("keys", fmt::format("{}=", fmt::join(help.keys, "= "))),
                       fmt::arg("commands", fmt::join(commands, " ")),
                       fmt::arg("options", names_of(help.options, " ")), fmt::arg("cases", cases));
}

std::string zsh_completion(const ProgramHelp& help) {
    std::string cases, commands;
    for (const CommandHelp& command : help.commands) {
        commands += fmt::format("        '{}:{}'\n", command.name,
                                zsh_quoted(replaced(command.about, ':', R"(\:)")));
        cases += zsh_case(help.name, command);
    }
    return fmt::format(kZsh, fmt::arg("name", help.name),
                       fmt::arg("keys", fmt::format("{}=", fmt::join(help.keys, "= "))),
                       fmt::arg("commands", commands),
                       fmt::arg("options", zsh_lines(help.name, help.options)),
                       fmt::arg("cases", cases));
}

std::string fish_completion(const ProgramHelp& help) {
    std::string commands, options = fish_lines(help, "", help.options);
    for (const CommandHelp& command : help.commands) {
        commands += fmt::format("complete -c {} -n '__{}_is' -a {} -d '{}'\n", help.name, help.name,
                                command.name, fish_quoted(command.about));
        options += fish_lines(help, command.name, command.options);
    }
    return fmt::format(kFish, fmt::arg("name", help.name), fmt::arg("commands", commands),
                       fmt::arg("options", options));
}

}  // namespace tesserae::scenes
