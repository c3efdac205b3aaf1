// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/overrides.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/load/scene_text.hpp"

namespace tesserae::scenes {
namespace {

/// Keys of bodies and joints, each with one that it stands instead of.
constexpr std::pair<std::string_view, std::string_view> kInstead[] = {
    {"mass", "density"},        {"density", "mass"},
    {"frequency", "stiffness"}, {"frequency", "damping_force"},
    {"stiffness", "frequency"}, {"stiffness", "damping"},
    {"speed", "target"},        {"speed", "frequency"},
    {"speed", "damping"},       {"target", "speed"},
};

/// Tables of which there are several. All but lights have names.
constexpr std::string_view kArrays[] = {"body", "lattice", "joint", "material", "light"};

bool is_array_of_tables(std::string_view table) {
    return std::find(std::begin(kArrays), std::end(kArrays), table) != std::end(kArrays);
}

}  // namespace

struct Overrides::Entry {
    std::string place;  ///< "--set KEY=VALUE"
    std::vector<std::string> path;
    toml::table parsed;           ///< the document KEY=VALUE
    toml::node* value = nullptr;  ///< in it
    bool met = false;

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: {}", place, what));
    }

    /// Moves the value into `table`, below the path without its first `skipped` parts; tables on
    /// the way are made.
    void apply_to(toml::table& table, std::size_t skipped) {
        toml::table* at = &table;
        for (std::size_t i = skipped; i + 1 < path.size(); ++i) {
            if (!at->contains(path[i])) at->insert(path[i], toml::table{});
            at = at->get(path[i])->as_table();
            if (at == nullptr) fail(fmt::format("\"{}\" is no table", printable(path[i])));
        }
        // Where two keys say one thing in two ways, the override's way holds.
        if (skipped == 2)
            for (const auto& [key, other] : kInstead)
                if (path.back() == key) at->erase(other);
        std::move(*value).visit(
            [&](auto&& concrete) { at->insert_or_assign(path.back(), std::move(concrete)); });
    }
};

namespace {

/// A word where a string was probably meant: `render.intersector=analytic`.
std::string quotes_hint(std::string_view text) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos) return "; expected KEY=VALUE";
    auto value = text.substr(equals + 1);
    while (value.starts_with(' ')) value.remove_prefix(1);
    const bool is_word = !value.empty() && std::all_of(value.begin(), value.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-' || c == '.';
    });
    if (!is_word) return "";
    return fmt::format("; a string needs quotes: '{}=\"{}\"'", text.substr(0, equals), value);
}

}  // namespace

Overrides::Overrides(std::span<const std::string> sets) {
    for (const std::string& text : sets) {
        auto entry = std::make_unique<Entry>();
        entry->place = "--set " + printable(text, 120);
        for (char c : text)
            if (static_cast<unsigned char>(c) < 0x20 && c != '\t')
                entry->fail("has a control character; expected one KEY=VALUE");
        cut_scene_text(text, entry->place);
        try {
            entry->parsed = toml::parse(text, std::string_view(entry->place));
        } catch (const toml::parse_error& error) {
            entry->fail(fmt::format("not valid TOML: {}{}", printable(error.description(), 300),
                                    printable(quotes_hint(text), 200)));
        }
        // Follow the dots of the key down to the value.
        entry->value = &entry->parsed;
        while (true) {
            auto* table = entry->value->as_table();
            if (table == nullptr || table->is_inline() || table->empty()) break;
            entry->path.emplace_back(table->begin()->first.str());
            entry->value = &table->begin()->second;
        }
        const bool is_value =
            entry->value->as_table() == nullptr || entry->value->as_table()->is_inline();
        if (!is_value || entry->path.empty()) entry->fail("expected KEY=VALUE");
        const std::string& table = entry->path.front();
        if (std::find(std::begin(kSceneTables), std::end(kSceneTables), table) ==
            std::end(kSceneTables))
            entry->fail(fmt::format("no table is called \"{}\"{}", printable(table),
                                    did_you_mean(table, kSceneTables)));
        const bool is_array = is_array_of_tables(table);
        if (entry->path.size() < (is_array ? 3 : 2))
            entry->fail(is_array ? fmt::format("expected {}.{}.KEY=VALUE", table,
                                               table == "light" ? "NUMBER" : "NAME")
                                 : fmt::format("expected {}.KEY=VALUE", table));
        if (table == "body") bodies_[entry->path[1]].push_back(entry.get());
        entries_.push_back(std::move(entry));
    }
}

Overrides::~Overrides() = default;

namespace {

std::string name_of(const toml::table& table, std::size_t number, std::string_view fallback) {
    const auto name = table["name"].value<std::string>();
    return name ? *name : fmt::format("{}{}", fallback, number);
}

/// Returns what entries call table number `index` of a kind that is not "body".
std::string name_in(std::string_view kind, const toml::table& table, std::size_t index,
                    std::size_t body_tables) {
    if (kind == "light") return fmt::format("{}", index);
    if (kind == "lattice") return name_of(table, index + body_tables, "body-");
    return name_of(table, index, kind == "joint" ? "joint-" : "material ");
}

}  // namespace

void Overrides::apply(toml::table& root, std::size_t body_tables) {
    if (body_tables == 0) {
        // Bodies may stand here as an array of inline tables.
        apply_to_bodies(root, 0);
        if (const auto* bodies = root["body"].as_array()) body_tables = bodies->size();
    }
    // Names as they are in the file, before any entry changes one.
    std::unordered_map<std::string, std::vector<toml::node*>> targets;
    std::unordered_map<std::string, std::vector<std::string>> names;
    for (const char* kind : {"material", "lattice", "joint", "light"}) {
        auto* array = root[kind].as_array();
        if (array == nullptr) continue;
        for (std::size_t i = 0; i < array->size(); ++i) {
            auto* table = array->get(i)->as_table();
            if (table == nullptr) continue;
            names[kind].push_back(name_in(kind, *table, i, body_tables));
            targets[kind].push_back(table);
        }
    }
    for (const auto& entry : entries_) {
        const std::string& kind = entry->path.front();
        if (kind == "body") continue;
        const bool is_array = is_array_of_tables(kind);
        toml::table* target = &root;
        if (is_array) {
            const auto& known = names[kind];
            const auto at = std::find(known.begin(), known.end(), entry->path[1]);
            if (at == known.end()) {
                const std::vector<std::string_view> views(known.begin(), known.end());
                entry->fail(fmt::format("no {} is called \"{}\"{}", kind, printable(entry->path[1]),
                                        did_you_mean(entry->path[1], views)));
            }
            target = targets[kind][static_cast<std::size_t>(at - known.begin())]->as_table();
        }
        entry->apply_to(*target, is_array ? 2 : 0);
    }
}

void Overrides::apply_to_bodies(toml::table& root, std::size_t first) {
    if (bodies_.empty()) return;
    auto* array = root["body"].as_array();
    if (array == nullptr) return;
    for (std::size_t i = 0; i < array->size(); ++i) {
        auto* body = array->get(i)->as_table();
        if (body == nullptr) continue;
        const auto found = bodies_.find(name_of(*body, first + i, "body-"));
        if (found == bodies_.end()) continue;
        for (Entry* entry : found->second)
            // A second body of that name is an error anyway.
            if (!std::exchange(entry->met, true)) entry->apply_to(*body, 2);
    }
}

void Overrides::require_all_met(std::span<const NamedBodies> bodies) const {
    for (const auto& entry : entries_) {
        if (entry->path.front() != "body" || entry->met) continue;
        std::vector<std::string_view> names;
        for (const NamedBodies& body : bodies) names.push_back(body.name);
        entry->fail(fmt::format("no body is called \"{}\"{}", printable(entry->path[1]),
                                did_you_mean(entry->path[1], names)));
    }
}

}  // namespace tesserae::scenes
