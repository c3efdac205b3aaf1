// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "render/picture.hpp"
#include "scenes/film/film_camera.hpp"
#include "scenes/film/poses.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// What of a scene changes from frame to frame.
struct Moment : render::Neighbour {
    bool looks_like(const Moment& other, const Scene& scene) const;
};

/// What a frame shows: the shutter opens and, if it is open for any time, closes.
struct Exposure {
    Moment opening;
    std::vector<render::ShutterMoment> path;
    std::optional<Moment> after, before;  ///< the frames beside, for vectors of motion

    /// A frame of a film.
    Exposure(const Scene& scene, FilmCamera& camera, Poses& poses, int frame);
    /// Bodies at any time [s], which go on at their velocities.
    Exposure(const Scene& scene, FilmCamera& camera, Bodies bodies, double time);

    /// But for what is random in the picture.
    bool looks_like(const Exposure& other, const Scene& scene) const;
    /// Without mattes and overlay. It refers to this and the scene.
    render::Picture picture(const Scene& scene, int frame) const;

  private:
    void open_shutter(const Scene& scene, FilmCamera& camera, Poses& poses, int frame);
    Moment neighbour(const Scene& scene, FilmCamera& camera, Poses& poses, int frame, int by) const;
    /// The bodies of the opening as they go on at their velocities.
    /// @param by     for so long [s]
    /// @param time   that it is then [s]
    Moment coasted(FilmCamera& camera, double by, double time) const;
};

}  // namespace tesserae::scenes
