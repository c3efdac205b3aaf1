// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "scenes/load/error_list.hpp"
#include "scenes/load/toml_reader.hpp"

namespace tesserae::scenes {

/// The numbers of the groups of bodies, in the order in which the scene names them. Bodies without
/// a group are of the group "", number 0.
class GroupNumbers {
  public:
    /// Sets what a type collides with from the names in a body's table.
    /// @param collides_with   none: all groups
    /// @throws InputError   there are more than kMostGroups groups
    void set(TableReader& reader, const std::string& group,
             const std::optional<std::vector<std::string>>& collides_with, BodyType& type);

    /// @throws InputError   some body collides with a group that no body is of
    void require_all_met() const;

  private:
    struct Group {
        std::uint8_t number;
        bool is_met = false;  ///< some body is of it
    };
    struct Mention {
        std::string name;
        PlacedError error;
    };

    Group& group_of(TableReader& reader, const char* key, const std::string& name);

    std::unordered_map<std::string, Group> groups_{{"", {0, true}}};
    std::vector<Mention> mentions_;  ///< the first in a collides_with of each name not met before
};

}  // namespace tesserae::scenes
