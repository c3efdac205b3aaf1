// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/algebra/vector.hpp"

namespace tesserae::scenes {

/// The axes of the planes, in their order xy xz xw yz yw zw.
constexpr std::array<std::array<int, 2>, 6> kPlaneAxes = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// How something goes through its time, in the order of the scene format's names: evenly, from
/// rest, to rest, or both.
enum class Ease { kLinear, kIn, kOut, kInOut };

/// The part of the way that is behind after a part of the time, and its derivative.
/// @param part   0 to 1
double eased(Ease ease, double part);
double eased_slope(Ease ease, double part);

/// A way round a point in a plane of the world's axes.
struct CameraOrbit {
    Vec4 about = Vec4::Zero();
    std::size_t plane = 0;  ///< index into kPlaneAxes
    double angle = 0;       ///< turns the first axis of the plane toward the second [degrees]

    /// Where `from` is after a part of the angle: on its circle to rounding, and about where it was
    /// after whole turns. What of it is outside the plane stays as it is.
    Vec4 turned(const Vec4& from, double part) const;
    /// How far `from` is from the axis that it goes round [m].
    double radius(const Vec4& from) const;
};

/// An orbit and its time.
struct CameraArc {
    double begin, end;  ///< [s]
    Vec4 from;
    CameraOrbit orbit;
    Ease ease;

    Vec4 at(double time) const;
    Vec4 velocity(double time) const;  ///< [m/s]

  private:
    double part(double time) const { return (time - begin) / (end - begin); }
};

}  // namespace tesserae::scenes
