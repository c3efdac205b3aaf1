// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {

/// What a trajectory needs beside its rows to be continued bit for bit, as of a flush.
struct ResumeRecord {
    std::uint64_t rows = 0;                  ///< that the file had
    std::uint64_t first = 0;                 ///< the first row since the flush before
    std::array<std::uint64_t, 2> hash = {};  ///< of the rows from `first` on: see hash_with_row()
    std::uint64_t step = 0;                  ///< of the last row
    StepMemory memory;                       ///< after that step; its time is that of the step
};

/// The record as bytes, with their own length and hash in front.
std::string to_bytes(const ResumeRecord& record);
/// None if the bytes are not those of a whole record; what follows them is ignored.
std::optional<ResumeRecord> to_record(std::string_view bytes);

/// Whether all that the memory names is one of so many bodies, and what is of every body is of that
/// many: a step looks them up without another check.
bool is_of_bodies(const StepMemory& memory, std::uint64_t bodies);

/// Whether what the memory has of every joint, and of every part of one, is of so many: see core's
/// Joints. Before the first step it has nothing.
bool is_of_joints(const StepMemory& memory, std::uint64_t joints, std::uint64_t parts);

/// The hash of a run of rows, from that of the rows before and one row more.
std::array<std::uint64_t, 2> hash_with_row(const std::array<std::uint64_t, 2>& before,
                                           const StepFacts& facts, const Bodies& bodies);

}  // namespace tesserae::scenes
