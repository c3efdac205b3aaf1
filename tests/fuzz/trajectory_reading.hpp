// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenes/compare/difference.hpp"
#include "scenes/program/info.hpp"
#include "scenes/trajectory/trajectory.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"
#include "tests/fuzz/reading.hpp"

namespace tesserae::fuzz {

/// Everything that reads a trajectory and needs nothing else: its rows as rendering reads them,
/// what they tell of joints, and `tesserae info`, `hash` and `diff` with a whole one.
inline void read_trajectory(const std::filesystem::path& file, const std::filesystem::path& whole) {
    accepts([&] {
        const scenes::TrajectoryReader reader(file);
        const std::uint64_t rows = std::min<std::uint64_t>(reader.rows(), 100);
        // Only a file with rows shows that it has so many bodies.
        Bodies bodies = scenes::room_for(rows > 0 ? reader.header().bodies : 0);
        for (std::uint64_t row = 0; row < rows; ++row) {
            if (!accepts([&] { reader.read_row(row, bodies); })) break;
            for (const Vec4& position : bodies.position)
                require(position.allFinite(), "a position is not finite");
            accepts([&] {
                const scenes::JointFacts joints = reader.joints(row);
                require(joints.broken.size() == reader.header().joints.size(),
                        "a row tells of other joints than there are");
            });
        }
        reader.facts();
    });
    accepts([&] { scenes::read_content(file).hash(); });
    accepts([&] { scenes::text_of(scenes::compare(file, whole)); });
    accepts([&] {
        for (const scenes::Fact& fact : scenes::facts_about(file, 1))
            fact.value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    });
}

}  // namespace tesserae::fuzz
