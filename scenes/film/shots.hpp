// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "render/mattes.hpp"
#include "render/picture.hpp"
#include "scenes/film/exposure.hpp"
#include "scenes/film/film_camera.hpp"
#include "scenes/film/poses.hpp"
#include "scenes/overlay/stamps.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// A frame of a film and all that it shows. It is not copied, as its picture refers to it.
struct Shot {
    render::FrameInfo info;
    Exposure exposure;
    std::vector<render::Stamp> overlay;
};

/// What frames of a scene are to show, for whoever renders them.
class Shots {
  public:
    /// As Poses; the scene must outlive it.
    Shots(const Scene& scene, const std::vector<int>& frames,
          const std::filesystem::path& trajectory);
    Shots(const Shots&) = delete;
    Shots& operator=(const Shots&) = delete;

    /// Makes the names for Cryptomatte, where it is asked for: see mattes_of().
    void name_mattes(const std::filesystem::path& folder);

    const OverlayPainter& painter() const { return painter_; }
    /// What a frame's header says.
    render::FrameInfo info(int frame) const;
    Shot shot(int frame);
    /// Refers to the shot and to this.
    render::Picture picture(const Shot& shot) const;

  private:
    const Scene& scene_;
    Poses poses_;
    FilmCamera camera_;
    OverlayPainter painter_;
    std::optional<render::Mattes> mattes_;
    render::FrameInfo info_;
};

/// What the headers of all pictures of a scene say.
render::FrameInfo common_info(const Scene& scene);

}  // namespace tesserae::scenes
