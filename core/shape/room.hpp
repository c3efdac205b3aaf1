// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>

#include "core/algebra/rotor.hpp"
#include "core/algebra/vector.hpp"
#include "core/key.hpp"

namespace tesserae {

/// A Rule says what a shape's parameter must be, besides finite. kSides is for the numbers of sides
/// of polygons.
enum class Rule { kFinite, kNonNegative, kPositive, kNonZero, kSides };

/// ray_hit returns this for a ray that misses.
constexpr double kMiss = std::numeric_limits<double>::infinity();

/// The error of signed_distance is at most this, relative to |point| plus the shape's size
/// (bounding radius; for a hyperplane |offset|). The tests use this number.
constexpr double kDistanceAccuracy = 1e-15;
/// The points that ray_hit and ray_exit find lie this close to the surface, relative to |origin|
/// plus the shape's size. A ray that misses stays outside, or enters by no more than this.
constexpr double kRayAccuracy = 2e-15;

/// A RayInterval is a part of a ray, given by distances from its start [m]. If enter > leave, it is
/// empty.
struct RayInterval {
    double enter, leave;
};

/// A RimRange says which rims matter to the caller.
struct RimRange {
    double low = -1, high = 1;  ///< outside of these only the side of a sine need be right
    double limit = kMiss;       ///< only what comes before this distance along the ray counts [m]
};

/// A Rim is the angle between a ray and the nearest direction from its start that touches a shape.
/// It is given by its sine, which is negative where the ray enters the shape. The sine is the least
/// f(t)/t over 0 < t <= limit, where f(t) is the signed distance along the ray. It is exact for
/// every convex shape that the ray misses (core/FORMULAS.md 7). It is 1 where the shape lies behind
/// and -1 from inside it. From the surface it is f'(0), that of the tangent half-space.
struct Rim {
    double sine;    ///< <= low, >= high, or exact: see RimRange, kRimAccuracy
    int steps = 0;  ///< evaluations of the distance; 0 in closed form
};

/// The error of a rim's sine is at most this times the lengths involved (|origin| plus the shape's
/// size) over the distance from the origin to the shape.
constexpr double kRimAccuracy = 1e-14;
/// A start inside by less than this part of the lengths involved counts as on the surface, usual
/// 1e-9. Where two bodies share a piece of surface, rounding puts its points inside or outside at
/// random.
constexpr double kSurfaceDepth = 1e-9;

/// Returns the rim of a ray that starts inside the shape or on its surface.
/// @param distance   signed distance of the start [m], <= 0
/// @param slope      f'(0), see Rim
/// @param scale      the lengths involved [m]
inline Rim rim_from_inside(double distance, double slope, double scale) {
    return {distance >= -kSurfaceDepth * scale ? slope : -1};
}

/// A Face is a flat part of a shape's surface. The shape lies in the half-space normal . x <=
/// offset.
struct Face {
    Vec4 normal;  ///< unit, outward
    double offset;
};

/// Accepts every parameter that S::parameters hands out.
struct AnyParameter {
    template <class T>
    void operator()(const Key& key, T& member, Rule rule) const;
};

/// A ShapeRoom is a shape S with all functions that a shape must provide, in its own body frame
/// (for a hyperplane: in the world). No finite input gives a NaN.
template <class S>
concept ShapeRoom = requires(S& own, const S& s, double mass, const Mat4& turn, const Vec4& point,
                             const Vec4& direction, const RimRange& range) {
    /// Scene files call the shape by this name.
    { S::kName } -> std::convertible_to<const char*>;
    /// True if the shape is bounded. Others are infinite, never move and have no mass.
    { S::kBounded } -> std::convertible_to<bool>;
    /// Calls visit(key, member, Rule) for every parameter, also of a constant shape.
    S::parameters(own, AnyParameter{});
    S::parameters(s, AnyParameter{});
    { s == s } -> std::same_as<bool>;
    /// Computes the derived values, once the parameters have passed their rules.
    { complete(own) } -> std::same_as<void>;
    /// Returns the 4D content [m^4], infinite if not bounded.
    { volume(s) } -> std::same_as<double>;
    /// Returns J_i = integral of rho x_i^2 [kg m^2] along the body's axes, or along its principal
    /// axes (HasPrincipalAxes).
    { second_moments(s, mass) } -> std::same_as<Vec4>;
    /// Returns the radius of the sphere about the centre that holds the shape [m].
    { bounding_radius(s) } -> std::same_as<double>;
    /// Returns the half sides of the box that holds the rotated shape [m].
    { half_extents(s, turn) } -> std::same_as<Vec4>;
    /// Returns the maximum of |direction . x| over the shape [m].
    { half_extent_along(s, direction) } -> std::same_as<double>;
    /// Returns a point of the shape that is farthest along the direction.
    { support(s, direction) } -> std::same_as<Vec4>;
    /// Returns the exact signed distance [m], 1-Lipschitz and convex: see kDistanceAccuracy.
    { signed_distance(s, point) } -> std::same_as<double>;
    /// Returns the unit gradient of the distance; a fixed choice where there is none.
    { normal(s, point) } -> std::same_as<Vec4>;
    /// Returns, in closed form, the first t >= 0 with point + t direction in the shape: 0 if the
    /// point is inside, kMiss if there is none. The direction is unit. See kRayAccuracy.
    { ray_hit(s, point, direction) } -> std::same_as<double>;
    /// Returns, in closed form, the last t >= 0 with point + t direction in the shape: 0 if there
    /// is none, kMiss if the ray never leaves. The direction is unit. The point is in the shape or,
    /// to rounding, on its surface.
    { ray_exit(s, point, direction) } -> std::same_as<double>;
    /// Returns the rim: the angle by which the ray misses the shape. The direction is unit.
    { rim(s, point, direction, range) } -> std::same_as<Rim>;
};

/// A Level is the value of a function at a point, and its gradient there.
struct Level {
    double value;
    Vec4 gradient;
};

/// HasQuickLevel holds for a shape whose distance is slow to compute outside. Rays then use
/// quick_level, a convex function that is at most 0 in the shape and nowhere else.
template <class S>
concept HasQuickLevel = requires(const S& s, const Vec4& point) {
    { quick_level(s, point) } -> std::same_as<Level>;
};

/// HasShadingNormal holds for a shape whose surface may have several equally good normals at a
/// point.
template <class S>
concept HasShadingNormal = requires(const S& s, const Vec4& point) {
    { shading_normal(s, point) } -> std::same_as<Vec4>;
};

/// HasPrincipalAxes holds for a shape whose second_moments() are not along the body's axes.
template <class S>
concept HasPrincipalAxes = requires(const S& s) {
    /// Returns the rotor from the principal axes to the body's axes, or null if they are the same.
    { principal_axes(s) } -> std::same_as<const Rotor*>;
};

/// A unit vector this close to the normal of a face counts as that normal, usual 1e-6.
constexpr double kFaceNormal = 1e-6;

/// IsPolytope holds for a shape with only flat faces. The manifold of two such shapes moves with
/// them.
template <class S>
concept IsPolytope = requires(const S& s, const Vec4& direction) {
    /// Returns whether a unit vector is the normal of a face, to kFaceNormal.
    { is_face_normal(s, direction) } -> std::same_as<bool>;
};

/// HasFaces holds for a shape with flat faces. Bodies slide over several faces that lie in one
/// plane as over one.
template <class S>
concept HasFaces = requires(const S& s, const Vec4& direction, const Vec4& point, double depth) {
    /// Returns the face whose normal is nearest to the direction.
    { face_along(s, direction) } -> std::same_as<Face>;
    /// Returns a bit for each face whose plane is at most `depth` [m] above the point. A face has
    /// the same bit for every point. All bits are set where there are more faces than bits.
    { faces_near(s, point, depth) } -> std::same_as<std::uint64_t>;
};

}  // namespace tesserae
