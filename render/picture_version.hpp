// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tesserae::render {

/// The version of how a scene looks. Raise it in the commit in which any golden frame in
/// tests/scenes/golden_test.cpp moves while its bodies stay where they were: frames of different
/// versions are not mixed in one folder.
/// 2: frames after the first have random numbers of their own; adaptive sampling without a bias;
/// while the shutter is open bodies turn at their angular velocities.
/// 3: rays have no end unless max_distance is given, which holds for all rays; filters wider than a
/// pixel lose nothing; a camera may stand in glass; of overlapping glass the last body rules.
/// 4: every sample has a time of its own while the shutter is open; paths take directions by
/// functions of our own in place of the C library's, so their noise is another.
/// 5: glass whose material gives no albedo takes no light.
/// 6: mirrors and glass have a limit of their own and end no path at random that loses no light.
/// 7: in direct pictures the soft shadows of several bodies add up.
constexpr int kPictureVersion = 7;

}  // namespace tesserae::render
