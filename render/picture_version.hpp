#pragma once

namespace tesserae::render {

/// The version of how a scene looks. Raise it in the commit that changes the pixels of a frame
/// whose scene file stays the same: frames of different versions are not mixed in one folder.
constexpr int kPictureVersion = 1;

}  // namespace tesserae::render
