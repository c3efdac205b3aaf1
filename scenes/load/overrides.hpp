// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scenes/load/toml_declarations.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// The tables that a scene file may have.
inline constexpr std::string_view kSceneTables[] = {"scene",   "physics", "material", "body",
                                                    "lattice", "joint",   "camera",   "light",
                                                    "render",  "overlay"};

/// The `--set KEY=VALUE` entries of a command line. KEY is a TOML key: `physics.iterations`,
/// `camera.position`, `body.NAME.mass`, `lattice.NAME.count`, `joint.NAME.anchor`,
/// `material.NAME.albedo`, `light.0.strength` (lights have no names: their number in the file, from
/// 0). NAME is the one in the file, or the default name; parts with other characters than A-Z a-z
/// 0-9 - _ are quoted. Later entries win. A key that stands instead of others replaces them: `mass`
/// a `density`, a joint's `stiffness` a `frequency`, a motor's `speed` a `target`, and the other
/// way round.
class Overrides {
  public:
    /// Parses all entries.
    /// @throws InputError   an entry is not KEY=VALUE in TOML, or names no key of a table
    explicit Overrides(std::span<const std::string> sets);
    ~Overrides();
    Overrides(const Overrides&) = delete;
    Overrides& operator=(const Overrides&) = delete;

    /// Applies the entries to a scene's tables, those for bodies in `root` included.
    /// @param body_tables   how many [[body]] tables come before the lattices: their default names
    /// @throws InputError   no material, lattice, joint or light of that name
    void apply(toml::table& root, std::size_t body_tables);

    /// Applies the entries for the bodies of `root`, the first of them being number `first`.
    void apply_to_bodies(toml::table& root, std::size_t first);
    /// @throws InputError   an entry's body was not met
    void require_all_met(std::span<const NamedBodies> bodies) const;

  private:
    struct Entry;

    std::vector<std::unique_ptr<Entry>> entries_;
    std::unordered_map<std::string, std::vector<Entry*>> bodies_;
};

}  // namespace tesserae::scenes
