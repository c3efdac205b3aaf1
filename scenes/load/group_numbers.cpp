// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/group_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/load/effective.hpp"
#include "scenes/load/nearest_name.hpp"

namespace tesserae::scenes {

GroupNumbers::Group& GroupNumbers::group_of(TableReader& reader, const char* key,
                                            const std::string& name) {
    const std::size_t next = groups_.size();
    const auto [found, is_new] = groups_.emplace(name, Group{static_cast<std::uint8_t>(next)});
    if (is_new && next >= kMostGroups) {
        groups_.erase(found);
        reader.fail(key, fmt::format("is group {}; expected at most {} in a scene, with that of "
                                     "bodies without a group",
                                     next + 1, kMostGroups));
    }
    return found->second;
}

void GroupNumbers::set(TableReader& reader, const std::string& group,
                       const std::optional<std::vector<std::string>>& collides_with,
                       BodyType& type) {
    Group& own = group_of(reader, "group", group);
    own.is_met = true;
    type.group = own.number;
    if (!collides_with) return;
    type.collides_with = 0;
    for (const std::string& name : *collides_with) {
        const bool is_known = groups_.contains(name);
        type.collides_with |= std::uint64_t{1} << group_of(reader, "collides_with", name).number;
        if (is_known) continue;
        try {
            reader.fail("collides_with",
                        fmt::format("no body is of the group \"{}\"", printable(name)));
        } catch (const PlacedError& error) {
            mentions_.push_back({name, error});
        }
    }
}

void GroupNumbers::require_all_met() const {
    std::vector<std::string_view> met;
    for (const auto& [name, group] : groups_)
        if (group.is_met && !name.empty()) met.push_back(name);
    std::sort(met.begin(), met.end());
    ErrorList errors;
    for (const Mention& mention : mentions_)
        if (!groups_.at(mention.name).is_met)
            errors.collect([&] {
                throw PlacedError(mention.error.what() + did_you_mean(mention.name, met),
                                  mention.error.line, mention.error.column);
            });
    errors.require_none();
}

}  // namespace tesserae::scenes
