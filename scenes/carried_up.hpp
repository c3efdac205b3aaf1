// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "render/description.hpp"

namespace tesserae::scenes {

/// The up of a camera whose path passes near to looking straight along `up`, where an up made anew
/// from `up` at each moment would turn the picture round at once.
///
/// The law: where the view comes within 3 degrees of containing `up` (of the pole), the picture's
/// up is carried along with the view without turning about it (parallel transport), from 15 degrees
/// before to 15 degrees after. There it is again the one made from `up`, or the opposite, whichever
/// is nearer; the rest of the turn is spread over the passage. It stays so until the next passage:
/// a camera that swings over the top comes down upside down.
///
/// It is a function of the path and of time alone. A path without a passage keeps its own up.
class CarriedUp {
  public:
    using Path = std::function<render::CameraDescription(double time)>;

    CarriedUp() = default;
    /// @param times   ascending: moments between which the path is smooth and turns little; it
    ///                stands still before the first and after the last
    CarriedUp(const Path& path, std::span<const double> times);

    /// No view comes near to the pole.
    bool is_empty() const { return passages_.empty(); }
    /// Unit, orthogonal to the view; the camera's own up where its view has none.
    /// @param camera   the path's at that time
    Vec4 at(double time, const render::CameraDescription& camera) const;

  private:
    struct Moment {
        double time;
        render::CameraDescription camera;  ///< its up is the carried one
        double length;                     ///< by how much the view has turned [rad]
    };
    struct Passage {
        double begin, end;            ///< [s]
        std::vector<Moment> moments;  ///< those of different cameras
        double roll = 0;              ///< of the carried up, in all, to meet the one after it [rad]
        double sign_after = 1;        ///< of the up made from `up`

        double turned() const { return moments.back().length; }
    };

    /// @param times    the moments of a passage
    /// @param enters   the path comes from farther away
    /// @param leaves   it goes farther away again
    void add(const Path& path, std::span<const double> times, bool enters, bool leaves);

    std::vector<Passage> passages_;  ///< ascending in time
    double first_ = 0, last_ = 0;
};

}  // namespace tesserae::scenes
