// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// Where two trajectories part, and how far they come apart. Values are compared bit by bit.
namespace tesserae::scenes {

/// Stored steps that only one of two trajectories has.
struct LoneSteps {
    std::uint64_t count = 0, first = 0, last = 0;
};

/// The first value that differs.
struct FirstDifference {
    std::uint64_t step = 0;
    double time = 0;  ///< of trajectory a [s]
    std::optional<std::uint64_t> body;
    std::string body_name;  ///< empty: not known
    std::optional<std::uint64_t> joint;
    std::string joint_name;  ///< in trajectory a
    std::string component;   ///< "position.x", "rotor.xy", "kinetic_energy", "time"
    std::string a, b;        ///< shortest decimals that read back as the same values
    double difference = 0;   ///< |a - b|
};

/// How far two stored states of a step are apart.
struct StepDifference {
    std::uint64_t step = 0;
    double time = 0;                  ///< of trajectory a [s]
    std::uint64_t bodies = 0;         ///< that differ in any bit
    std::array<double, 4> largest{};  ///< |a - b| of any component, in the order of kStateElements
};

struct TrajectoryDifference {
    std::uint64_t bodies_a = 0, bodies_b = 0;  ///< if not equal, no rows are compared
    std::uint64_t joints_a = 0, joints_b = 0;  ///< if not equal, joints are not compared
    std::string scene;                         ///< first_difference() of the effective texts
    std::string motion;                        ///< first_motion_difference() of them
    LoneSteps only_a, only_b;
    std::optional<FirstDifference> first;
    /// Of the steps in both: the first that differs, those 1, 2, 4, 8, ... rows later, the last.
    std::vector<StepDifference> growth;
    std::string not_compared;  ///< why the rows could not be read to their end; empty: they were
};

/// Compares row by row, in memory for a few rows. A row that cannot be read (a value that is not
/// finite) ends the comparison and is named in `not_compared`.
TrajectoryDifference compare_trajectories(const std::filesystem::path& a,
                                          const std::filesystem::path& b);

/// The name of a body in an effective text: that of its [[body]] or [[lattice]]; empty if the text
/// does not tell.
std::string body_name(const std::string& effective, std::uint64_t body);

}  // namespace tesserae::scenes
