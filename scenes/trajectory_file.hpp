// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/world/readings.hpp"

namespace tesserae {

/// A trajectory, finished or not, open for reading. Steps are read when they are asked for. Files
/// of unknown origin are safe to open: shapes, types and sizes are checked before anything is read.
/// Use trajectories from one thread at a time. Everything throws InputError with the path and the
/// reason.
class Trajectory {
  public:
    explicit Trajectory(const std::filesystem::path& file);

    std::size_t size() const;                      ///< number of stored steps
    std::span<const std::uint64_t> steps() const;  ///< numbers of the stored steps, ascending
    std::span<const double> times() const;         ///< of the stored steps [s]
    /// Returns the state of all bodies at stored step i < size().
    BodyArrays state(std::size_t i) const;

    std::size_t bodies() const;  ///< number of bodies
    /// Returns each body's name. Those of a lattice share theirs.
    /// @throws InputError   also if the file, of an older program, has none
    std::vector<std::string> names() const;
    /// Returns each body's mass [kg]: infinite for a hyperplane.
    /// @throws InputError   as names()
    std::vector<double> masses() const;

    const std::string& scene_name() const;
    /// Returns the effective text of the scene that was simulated: Scene::parse() reads it.
    const std::string& scene_text() const;
    /// Returns the hash of what moves bodies: that of Scene::motion_hash().
    const std::string& motion_hash() const;

  private:
    struct Inside;
    std::shared_ptr<const Inside> inside_;
};

}  // namespace tesserae
