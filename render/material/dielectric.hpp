// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/algebra/vector.hpp"

// Smooth surfaces: mirrors and interfaces between two refractive indices. A direction is the way
// that light (or a ray, backwards) travels; the normal points against it.
namespace tesserae::render {

/// The mirrored direction; one that would leave the surface by rounding only is kept.
Vec4 reflected(const Vec4& direction, const Vec4& normal);

/// Snell's law in the plane of incidence, the only one in which anything changes.
/// @param ratio   index where the ray comes from over the index where it goes
/// @return nothing under total reflection
std::optional<Vec4> refracted(const Vec4& direction, const Vec4& normal, double ratio);

/// The part of unpolarised light that an interface reflects, 0 to 1. In four dimensions a wave has
/// three polarisations: one in the plane of incidence (p) and two across it (s), each of which
/// meets the interface as in three dimensions. So the mean is (R_p + 2 R_s)/3.
/// @param cosine   between the direction that the light comes from and the normal, 0 to 1
double fresnel(double cosine, double ratio);

/// What radiance is multiplied with when it crosses from index b into index a, beside what is not
/// reflected: (a/b)^3. Light that crosses keeps its power; with Snell's law n^3 sin^2 cos dtheta,
/// that is n^3 times projected solid angle in four dimensions, is the same on both sides, so L/n^3
/// is what stays. `ratio` as above for a ray traced from the eye: index where it comes from (a)
/// over where it goes (b).
inline double radiance_scale(double ratio) { return ratio * ratio * ratio; }

}  // namespace tesserae::render
