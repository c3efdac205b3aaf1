// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "core/algebra/vector.hpp"
#include "core/simd/simd.hpp"

// Directions of 4D: points of S^3, and how to pick them. Three uniform numbers of [0, 1) make one.
namespace tesserae::render {

using Uniform3 = std::array<double, 3>;

/// Four of them side by side, number by number; and four directions, axis by axis. Each lane's
/// direction has the bits that it has alone.
using FourUniform3 = std::array<simd::Double4, 3>;
struct FourDirections {
    std::array<simd::Double4, 4> axes;

    Vec4 operator[](std::size_t i) const {
        return assembled(axes[0][i], axes[1][i], axes[2][i], axes[3][i]);
    }
};

/// An orthonormal frame whose last axis is a given unit vector: the reflection that swaps it with
/// the last axis (or its opposite, whichever is farther, so that nothing cancels).
class TangentFrame {
  public:
    TangentFrame() : TangentFrame(Vec4::UnitW()) {}
    explicit TangentFrame(const Vec4& axis)
        : mirror_(axis), scale_(1 / (1 + std::abs(axis[3]))), sign_(axis[3] > 0 ? -1 : 1) {
        mirror_[3] -= sign_;
    }

    /// From (tangent, tangent, tangent, along the axis) to where the axis was given, and back.
    Vec4 to_world(const Vec4& local) const {
        const Vec4 v = assembled(local[0], local[1], local[2], sign_ * local[3]);
        return v - (scale_ * mirror_.dot(v)) * mirror_;
    }
    FourDirections to_world(const FourDirections& local) const;
    Vec4 to_local(const Vec4& world) const;

  private:
    Vec4 mirror_;   ///< normal of the reflection
    double scale_;  ///< 2 over its square
    double sign_;   ///< of the last axis' image
};

/// A uniform point of the unit 3-ball.
Eigen::Vector3d uniform_ball(const Uniform3& u);

/// A direction of the hemisphere around the last axis, density 3 cos/(4 pi): a uniform point of the
/// 3-ball lifted to the sphere, whose area element is dV/cos.
Vec4 cosine_direction(const Uniform3& u);
FourDirections cosine_directions(const FourUniform3& u);

/// Solid angle of the cap of directions within `angle` of an axis: 2 pi (angle - sin cos), without
/// the cancellation of small angles. `angle` 0 to pi.
double cap_solid_angle(double angle);

/// The directions within an angle of the last axis.
class Cap {
  public:
    Cap() = default;
    /// @param angle   0 to pi/2
    explicit Cap(double angle);

    double angle() const { return angle_; }
    double solid_angle() const;
    /// Uniform in solid angle, to a few roundings of its coordinates. The angle from the axis has
    /// density 4 pi sin^2; its distribution is inverted by a series, in a wide cap with Halley's
    /// method after it.
    Vec4 direction(const Uniform3& u) const;
    FourDirections directions(const FourUniform3& u) const;

  private:
    double inverted(double part, double versine) const;
    template <class V>
    V versine(V u) const;

    double angle_ = 0;
    double part_ = 0;  ///< angle - sin cos
    double root_ = 0;  ///< of the third power of a small angle, see versine()
};

/// Irradiance under a cap of radiance 1: its projection onto the surface.
/// @param angle      half-angle of the cap, 0 to pi/2
/// @param altitude   of its middle above the surface's horizon, -pi/2 to pi/2
/// (4 pi/3) sin^3(angle) sin(altitude) for a cap wholly above the horizon, 0 for one below. Between
/// them the projection is an ellipsoid's part and a ball's, cut along the axis toward the light:
/// with s = sin(pi/2 - altitude - angle) and a = cos(angle)/cos(altitude) the integral of their
/// sections is pi (2/3 - s + s^3/3 - (1 - s^2)(a - s)/3); exact, here without its cancellation.
double cap_irradiance(double angle, double altitude);

}  // namespace tesserae::render
