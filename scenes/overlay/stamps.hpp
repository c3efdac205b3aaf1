// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "render/file/stamp.hpp"
#include "scenes/camera_path.hpp"
#include "scenes/overlay/text.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// Where the camera of a frame is and what it does not see.
struct SlicePose {
    Vec4 position = Vec4::Zero();  ///< world [m]
    Vec4 fourth = Vec4::UnitW();   ///< unit

    explicit SlicePose(const render::CameraDescription& camera);
    /// As an image's header tells it.
    /// @throws InputError   it does not
    explicit SlicePose(const std::filesystem::path& exr);
};

/// Draws a scene's overlay over previews: the title at the top left, time and w at the bottom left,
/// captions in the middle above them, the dial at the top right.
class OverlayPainter {
  public:
    /// @param scene   must outlive it
    /// @throws InputError   the font cannot be read
    explicit OverlayPainter(const Scene& scene);

    bool is_empty() const { return scene_.overlay.is_empty(); }
    std::vector<render::Stamp> stamps(int frame, const SlicePose& slice) const;

  private:
    bool slice_turns(int frame) const;

    const Scene& scene_;
    CameraPath path_;
    std::optional<Font> font_;  ///< none where nothing is written
};

}  // namespace tesserae::scenes
