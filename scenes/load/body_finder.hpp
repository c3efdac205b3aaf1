// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/body_id.hpp"
#include "scenes/load/toml_reader.hpp"
#include "scenes/named_bodies.hpp"

namespace tesserae::scenes {

/// Finds bodies by the names that scene files have for them: NAME, or NAME.k for body k of a
/// lattice.
class BodyFinder {
  public:
    /// @param names   must outlive the finder
    explicit BodyFinder(std::span<const NamedBodies> names);

    /// Returns whether some body or lattice has just this name.
    bool knows(std::string_view name) const { return bodies_.contains(name); }
    /// Returns the body that a key of a table names.
    /// @throws InputError   no body is called so, or the name is that of a whole lattice
    BodyId find(TableReader& reader, std::string_view key, std::string_view name) const;

  private:
    std::unordered_map<std::string_view, const NamedBodies*> bodies_;
    std::vector<std::string_view> names_;
};

}  // namespace tesserae::scenes
