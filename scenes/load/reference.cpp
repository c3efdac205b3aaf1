// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/reference.hpp"

#include <vector>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/load/reference_tables.hpp"

namespace tesserae::scenes {
namespace {

std::string markdown(const std::vector<ReferenceRow>& rows) {
    std::string text =
        "| key | type | unit | default | allowed | meaning |\n|---|---|---|---|---|---|\n";
    for (const ReferenceRow& row : rows)
        text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.key, row.type, row.unit,
                            row.otherwise, row.allowed, row.meaning);
    return text;
}
std::string markdown(const ReferencePart& part) {
    const std::string heading =
        part.heading.empty() ? "" : fmt::format("### `{}`\n\n", part.heading);
    return heading + markdown(part.rows);
}
std::string markdown(const ReferenceTable& table) {
    std::string text = fmt::format("## `{}`\n\n{}\n", table.header, table.about);
    for (const ReferencePart& part : table.parts) text += "\n" + markdown(part);
    return text;
}

constexpr std::string_view kIntroduction =
    R"(# Scene files: every table and key

A scene file is [TOML](https://toml.io). This page lists all that it can hold. The program prints it:
`tesserae reference` all of it, `tesserae reference render` one table, `tesserae reference body.friction` one key,
`tesserae reference hyperbox` the sizes of a shape.

- Lengths are in metres, times in seconds, masses in kilograms, angles in degrees, angular velocities in radians a second.
  Colours are red, green and blue, linear.
- A point or direction is `[x, y, z, w]`. Planes are a table such as `{ xy = 30, zw = 15 }`; those that are left out are 0.
- An integer may stand for a real. Every key has a default unless the table says *required*. An unknown key is an error.
- `--set TABLE.KEY=VALUE` on the command line replaces one key. Bodies, lattices, joints and materials are reached by name and
  lights by number: `--set body.NAME.mass=2`, `--set light.0.strength=3`.
- No real is larger than 10^15, and what must be > 0 is at least 10^-15; only masses may be.
)";

/// The parts of one shape or type. Those of several tables may be called the same.
std::string markdown_of_parts(const std::vector<ReferenceTable>& tables, std::string_view name) {
    std::vector<ReferencePart> parts;
    std::vector<std::string> headers;
    const std::string ending = fmt::format(" = \"{}\"", name);
    for (const ReferenceTable& table : tables)
        for (const ReferencePart& part : table.parts)
            if (part.heading.ends_with(ending))
                parts.push_back(part), headers.push_back(table.header);
    std::string text;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts.size() > 1) parts[i].heading = headers[i] + ", " + parts[i].heading;
        text += (text.empty() ? "" : "\n") + markdown(parts[i]);
    }
    return text;
}

/// The rows of a key, each with the part that it belongs to; empty: there is no such key.
std::string markdown_of_key(const ReferenceTable& table, std::string_view key) {
    std::string text;
    for (const ReferencePart& part : table.parts)
        for (const ReferenceRow& row : part.rows)
            if (row.key == key)
                text += (text.empty() ? "" : "\n") + markdown({part.heading, {row}});
    return text;
}

/// A key by its name alone, in every table and part that has it; after a dot, in those of a part.
std::string markdown_of_bare_key(const std::vector<ReferenceTable>& tables,
                                 std::string_view topic) {
    const auto dot = topic.rfind('.');
    const std::string_view key = dot == topic.npos ? topic : topic.substr(dot + 1);
    const std::string part_name =
        dot == topic.npos ? "" : fmt::format("\"{}\"", topic.substr(0, dot));
    std::string text;
    for (const ReferenceTable& table : tables)
        for (const ReferencePart& part : table.parts) {
            if (part.heading.find(part_name) == std::string::npos) continue;
            const std::string heading =
                table.header + (part.heading.empty() ? "" : ", ") + part.heading;
            for (const ReferenceRow& row : part.rows)
                if (row.key == key) text += (text.empty() ? "" : "\n") + markdown({heading, {row}});
        }
    return text;
}

}  // namespace

std::string reference(std::string_view topic) {
    const std::vector<ReferenceTable> tables = all_reference_tables();
    // [[body]] as body.
    while (topic.starts_with('[') && topic.ends_with(']'))
        topic = topic.substr(1, topic.size() - 2);
    if (topic.empty()) {
        std::string text(kIntroduction);
        for (const ReferenceTable& table : tables) text += "\n" + markdown(table);
        return text;
    }
    std::vector<std::string> known;
    for (const ReferenceTable& table : tables) {
        if (topic == table.name) return markdown(table);
        known.push_back(table.name);
        for (const ReferencePart& part : table.parts) {
            // shape = "hyperbox" is also found as hyperbox.
            const auto quote = part.heading.find('"');
            if (quote != std::string::npos)
                known.push_back(part.heading.substr(quote + 1, part.heading.size() - quote - 2));
            for (const ReferenceRow& row : part.rows) known.push_back(table.name + "." + row.key);
        }
    }
    if (std::string text = markdown_of_parts(tables, topic); !text.empty()) return text;
    const auto dot = topic.rfind('.');
    const std::string_view name = topic.substr(0, dot);
    for (const ReferenceTable& table : tables) {
        const bool has_body_keys = name == "lattice" && table.name == "body";
        if (dot == std::string_view::npos || (name != table.name && !has_body_keys)) continue;
        if (std::string text = markdown_of_key(table, topic.substr(dot + 1)); !text.empty())
            return text;
    }
    if (std::string text = markdown_of_bare_key(tables, topic); !text.empty()) return text;
    const std::vector<std::string_view> names(known.begin(), known.end());
    std::string hint = did_you_mean(topic, names);
    if (hint.empty()) {
        hint = "; tables:";
        for (const ReferenceTable& table : tables) hint += " " + table.name;
    }
    throw InputError(fmt::format("reference {}: no table or key is called so{}",
                                 toml_text(printable(topic)), hint));
}

}  // namespace tesserae::scenes
