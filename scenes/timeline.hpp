// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// Number of time steps: round(duration x steps_per_second); 0 for a still.
/// @throws InputError   more steps than a 53-bit count
std::uint64_t step_count(const Scene& scene);

/// Number of frames: those k with k / frames_per_second < duration, at least frame 0.
/// @throws InputError   more than 10^7
int frame_count(const Scene& scene);

/// Where a frame's instant lies between time steps.
struct FrameInstant {
    double time = 0;         ///< [s]
    std::uint64_t step = 0;  ///< the last step at or before it
    double fraction = 0;     ///< of the way to the next step, in [0, 1); 0: exactly at `step`
};
/// @param frame   also one that the scene does not have: all stands still before the first step and
///                after the last
FrameInstant frame_instant(const Scene& scene, int frame);
/// Whether the frame is one of frame_count().
bool has_frame(const Scene& scene, int frame);
/// When the frame's shutter closes; no later than the last step.
FrameInstant closing_instant(const Scene& scene, int frame);

/// Steps strictly between the opening and the closing of a frame's shutter, ascending: all, but
/// every so many where they would be more than 16, or too many for memory. A picture can do
/// without; with them blurred bodies turn and bounce as they do.
std::vector<std::uint64_t> shutter_steps(const Scene& scene, int frame);

/// Steps that the given frames cannot do without, ascending, without repeats; for vectors of motion
/// those of the frames before and after as well.
std::vector<std::uint64_t> steps_needed(const Scene& scene, const std::vector<int>& frames);

/// The last of them: what a simulation takes steps to where no other frames are asked for.
std::uint64_t last_step_needed(const Scene& scene, const std::vector<int>& frames);

/// The same as steps_needed() with their shutter_steps().
std::vector<std::uint64_t> steps_for_frames(const Scene& scene, const std::vector<int>& frames);

/// Ranges "a-b", "a-bxs" and single numbers, separated by commas, in ascending order without
/// repeats; empty means all frames.
/// @throws InputError   bad syntax, or a frame that the scene does not have
std::vector<int> parse_frames(const std::string& text, int count);

/// A list of frames in the form of --frames: "3,7-9,12-20x2".
/// @param frames   ascending, without repeats
std::string frames_text(const std::vector<int>& frames);

}  // namespace tesserae::scenes
