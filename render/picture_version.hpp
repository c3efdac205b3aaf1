#pragma once

namespace tesserae::render {

/// The version of how a scene looks. Raise it in the commit in which any golden frame in
/// tests/scenes/golden_test.cpp moves while its bodies stay where they were: frames of different
/// versions are not mixed in one folder.
/// 2: frames after the first have random numbers of their own; adaptive sampling without a bias;
/// while the shutter is open bodies turn at their angular velocities.
constexpr int kPictureVersion = 2;

}  // namespace tesserae::render
