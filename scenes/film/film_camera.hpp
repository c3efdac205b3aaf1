// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>

#include "scenes/camera_path.hpp"
#include "scenes/film/poses.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// The camera of a film: on the path of its keys, and carried along by the body that it follows.
///
/// Position and look_at are moved by the body's way since time 0, along the axes that are followed.
/// With a lag it is the mean of that way over the time of the lag that ends now; before time 0 the
/// body counts as standing still. For the mean the way is straight between the instants of frames,
/// and from the last of them to now. So it depends on time and trajectory alone, whichever frames
/// are made.
class FilmCamera {
  public:
    /// @param poses   tells where the body was, and must stay; null: it counts as having come
    ///                evenly from where it was at time 0
    explicit FilmCamera(const Scene& scene, const Poses* poses = nullptr);

    /// @param bodies   at that time
    render::CameraDescription at(double time, const Bodies& bodies);
    /// At a frame's instant; none if it is not known where the body is then.
    std::optional<render::CameraDescription> at(int frame);

  private:
    /// The body's way since time 0 at a frame; none if the trajectory does not hold it.
    const std::optional<Vec4>& way(int frame);
    /// @param now   the body's way until then
    Vec4 mean_way(double time, const Vec4& now);
    render::CameraDescription moved(double time, const Vec4& now);

    const Scene& scene_;
    const Poses* poses_;
    CameraPath path_;
    std::map<int, std::optional<Vec4>> ways_;
};

}  // namespace tesserae::scenes
