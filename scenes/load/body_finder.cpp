// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/body_finder.hpp"

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "scenes/load/nearest_name.hpp"

namespace tesserae::scenes {
namespace {

/// Returns the number that some text is, if it is one.
std::optional<std::uint32_t> number_of(std::string_view text) {
    std::uint32_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || next != end) return {};
    return number;
}

}  // namespace

BodyFinder::BodyFinder(std::span<const NamedBodies> names) {
    bodies_.reserve(names.size());
    names_.reserve(names.size());
    for (const NamedBodies& bodies : names) {
        bodies_.emplace(bodies.name, &bodies);
        names_.push_back(bodies.name);
    }
}

BodyId BodyFinder::find(TableReader& reader, std::string_view key, std::string_view name) const {
    auto found = bodies_.find(name);
    if (found != bodies_.end() && !found->second->is_lattice) return found->second->first;
    std::optional<std::uint32_t> number;
    if (found == bodies_.end()) {
        const auto dot = name.rfind('.');
        if (dot != std::string_view::npos) number = number_of(name.substr(dot + 1));
        if (number) found = bodies_.find(name.substr(0, dot));
    }
    if (found == bodies_.end() || !found->second->is_lattice)
        reader.fail(key, "no body is called so" + did_you_mean(name, names_));
    const NamedBodies& lattice = *found->second;
    if (!number || *number >= lattice.count)
        reader.fail(key, fmt::format("the lattice has {0} bodies; expected one of them, "
                                     "\"{1}.0\" to \"{1}.{2}\"",
                                     lattice.count, lattice.name, lattice.count - 1));
    return lattice.first + *number;
}

}  // namespace tesserae::scenes
