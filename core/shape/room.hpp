#pragma once

#include <limits>

#include "core/algebra/vector.hpp"

// What every shape's room provides, for a shape S in its own body frame (a hyperplane: in the
// world):
//
//   static constexpr const char* S::kName   as in scene files
//   static constexpr bool S::kBounded       false: infinite, never moves, has no mass
//   S::parameters(self, visit)              calls visit(key, member, Rule) for every parameter
//   void complete(S&)                       derived values, once the parameters passed their rules
//   double volume(S)                        4D content [m^4]; infinite if not bounded
//   Vec4 second_moments(S, double mass)     J_i = integral of rho x_i^2 [kg m^2]
//   double bounding_radius(S)               of the sphere about the centre that holds the shape [m]
//   Vec4 half_extents(S, Mat4 R)            of the box that holds the shape turned by R [m]
//   double half_extent_along(S, Vec4 d)     max of |d . x| over the shape [m]
//   Vec4 support(S, Vec4 d)                 a point of the shape that is farthest along d
//   double signed_distance(S, Vec4 p)       exact inside and outside [m], 1-Lipschitz, convex
//   Vec4 normal(S, Vec4 p)                  its gradient, unit; a fixed choice where it has none
//   double ray_hit(S, Vec4 o, Vec4 d)       closed form: first t >= 0 with o + t d in the shape (0
//                                           if o is inside), kMiss if there is none; d unit
//   double ray_exit(S, Vec4 o, Vec4 d)      closed form: last t >= 0 with o + t d in the shape, 0
//                                           if there is none, kMiss if it never leaves; d unit;
//                                           o in the shape or, to rounding, on its surface
//   Rim rim(S, o, d, RimRange)              by what angle the ray misses the shape; d unit
//
// No finite input gives a NaN.
namespace tesserae {

/// What a shape's parameter must be, beside finite.
enum class Rule { kFinite, kNonNegative, kPositive, kNonZero };

/// What ray_hit returns for a ray that misses.
constexpr double kMiss = std::numeric_limits<double>::infinity();

/// Error bound of signed_distance, relative to |point| plus the shape's size (bounding radius; a
/// hyperplane: |offset|). Tested as it stands.
constexpr double kDistanceAccuracy = 1e-15;
/// Error bound of ray_hit: the point that it hits lies this close to the surface, relative to
/// |origin| plus the shape's size; so does that of ray_exit. A ray that misses stays outside, or
/// enters by no more than this.
constexpr double kRayAccuracy = 2e-15;

/// Which rims matter to the caller.
struct RimRange {
    double low = -1, high = 1;  ///< a sine outside of these is told by its side alone
    double limit = kMiss;       ///< only what comes before this distance along the ray counts [m]
};

/// The angle between a ray and the nearest direction that touches a shape from the ray's start, by
/// its sine: negative where the ray enters the shape. It is the least f(t)/t over 0 < t <= limit,
/// f(t) being the signed distance along the ray, and exact for every convex shape that the ray
/// misses (FORMULAS 7): 1 where the shape lies behind, -1 from inside it, and from its surface the
/// tangent half-space's, f'(0).
struct Rim {
    double sine;    ///< at most low, at least high, or the right one: see kRimAccuracy
    int steps = 0;  ///< distances that were taken on the way; 0 in closed form
};

/// Error bound of a rim's sine, relative to what rounding makes of the angles: the lengths involved
/// (|origin| plus the shape's size) over the distance from the origin.
constexpr double kRimAccuracy = 1e-14;
/// Within this part of the lengths involved a start inside counts as on the surface. Where two
/// bodies share a piece of surface, rounding puts its points inside or outside at random.
constexpr double kSurfaceDepth = 1e-9;

/// The rim from inside.
/// @param distance   the start's, <= 0
/// @param slope      f'(0)
inline Rim rim_from_inside(double distance, double slope, double scale) {
    return {distance >= -kSurfaceDepth * scale ? slope : -1};
}

}  // namespace tesserae
