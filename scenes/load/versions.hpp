// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

// What a file is a result of: a scene's text, and the versions of the program's law of motion
// (kMotionVersion) and of its pictures (kPictureVersion). Version 1 adds nothing to what is hashed:
// the hashes of files that were made before there were versions stay good.
namespace tesserae::scenes {

/// The hash that a trajectory carries: 32 hex digits of what decides how bodies move.
/// @param effective   a scene's effective text; its motion_part() counts
std::string motion_hash(std::string_view effective, int motion_version);

/// The hash that a frame carries: 32 hex digits of all that decides what it shows.
/// @param motion_version   of the trajectory that the frame is rendered from; a still: the
///                         program's
std::string frame_hash(std::string_view effective, int picture_version, int motion_version);

/// What an error says of a trajectory that another version of the program's law of motion has made.
std::string other_motion_version(int there, int here);

}  // namespace tesserae::scenes
