#pragma once

namespace tesserae::render {

/// The version of how a scene looks. Raise it in the commit in which any golden frame in
/// tests/scenes/golden_test.cpp moves while its bodies stay where they were: frames of different
/// versions are not mixed in one folder.
constexpr int kPictureVersion = 1;

}  // namespace tesserae::render
