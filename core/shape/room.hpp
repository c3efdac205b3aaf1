#pragma once

#include <concepts>
#include <cstdint>
#include <limits>

#include "core/algebra/rotor.hpp"
#include "core/algebra/vector.hpp"
#include "core/key.hpp"

namespace tesserae {

/// What a shape's parameter must be, beside finite. kSides: numbers of polygons' sides.
enum class Rule { kFinite, kNonNegative, kPositive, kNonZero, kSides };

/// What ray_hit returns for a ray that misses.
constexpr double kMiss = std::numeric_limits<double>::infinity();

/// Error bound of signed_distance, relative to |point| plus the shape's size (bounding radius; a
/// hyperplane: |offset|). Tested as it stands.
constexpr double kDistanceAccuracy = 1e-15;
/// Error bound of ray_hit: the point that it hits lies this close to the surface, relative to
/// |origin| plus the shape's size; so does that of ray_exit. A ray that misses stays outside, or
/// enters by no more than this.
constexpr double kRayAccuracy = 2e-15;

/// A part of a ray, by distances from its start; empty where enter > leave.
struct RayInterval {
    double enter, leave;
};

/// Which rims matter to the caller.
struct RimRange {
    double low = -1, high = 1;  ///< a sine outside of these is told by its side alone
    double limit = kMiss;       ///< only what comes before this distance along the ray counts [m]
};

/// The angle between a ray and the nearest direction that touches a shape from the ray's start, by
/// its sine: negative where the ray enters the shape. It is the least f(t)/t over 0 < t <= limit,
/// f(t) being the signed distance along the ray, and exact for every convex shape that the ray
/// misses (core/FORMULAS.md 7): 1 where the shape lies behind, -1 from inside it, and from its
/// surface the tangent half-space's, f'(0).
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

/// A flat part of a shape's surface, in whose half-space normal . x <= offset the shape lies.
struct Face {
    Vec4 normal;  ///< unit, outward
    double offset;
};

/// Accepts what S::parameters hands out.
struct AnyParameter {
    template <class T>
    void operator()(const Key& key, T& member, Rule rule) const;
};

/// What every shape's room provides, for a shape S in its own body frame (a hyperplane: in the
/// world). No finite input gives a NaN.
template <class S>
concept ShapeRoom = requires(S& own, const S& s, double mass, const Mat4& turn, const Vec4& point,
                             const Vec4& direction, const RimRange& range) {
    /// As in scene files.
    { S::kName } -> std::convertible_to<const char*>;
    /// False: infinite, never moves, has no mass.
    { S::kBounded } -> std::convertible_to<bool>;
    /// Calls visit(key, member, Rule) for every parameter, of a constant shape too.
    S::parameters(own, AnyParameter{});
    S::parameters(s, AnyParameter{});
    { s == s } -> std::same_as<bool>;
    /// Derived values, once the parameters passed their rules.
    { complete(own) } -> std::same_as<void>;
    /// 4D content [m^4]; infinite if not bounded.
    { volume(s) } -> std::same_as<double>;
    /// J_i = integral of rho x_i^2 [kg m^2], along the body's axes, or those of HasPrincipalAxes.
    { second_moments(s, mass) } -> std::same_as<Vec4>;
    /// Of the sphere about the centre that holds the shape [m].
    { bounding_radius(s) } -> std::same_as<double>;
    /// Of the box that holds the shape turned by a rotation [m].
    { half_extents(s, turn) } -> std::same_as<Vec4>;
    /// Max of |direction . x| over the shape [m].
    { half_extent_along(s, direction) } -> std::same_as<double>;
    /// A point of the shape that is farthest along the direction.
    { support(s, direction) } -> std::same_as<Vec4>;
    /// Exact inside and outside [m], 1-Lipschitz, convex: see kDistanceAccuracy.
    { signed_distance(s, point) } -> std::same_as<double>;
    /// Its gradient, unit; a fixed choice where it has none.
    { normal(s, point) } -> std::same_as<Vec4>;
    /// Closed form: first t >= 0 with point + t direction in the shape (0 if the point is inside),
    /// kMiss if there is none; direction unit: see kRayAccuracy.
    { ray_hit(s, point, direction) } -> std::same_as<double>;
    /// Closed form: last t >= 0 with point + t direction in the shape, 0 if there is none, kMiss if
    /// it never leaves; direction unit; the point in the shape or, to rounding, on its surface.
    { ray_exit(s, point, direction) } -> std::same_as<double>;
    /// By what angle the ray misses the shape; direction unit.
    { rim(s, point, direction, range) } -> std::same_as<Rim>;
};

/// What a function is at a point, and its gradient.
struct Level {
    double value;
    Vec4 gradient;
};

/// A shape whose distance takes long outside, with a quicker function for rays to go along: convex,
/// at most 0 in the shape and nowhere else.
template <class S>
concept HasQuickLevel = requires(const S& s, const Vec4& point) {
    { quick_level(s, point) } -> std::same_as<Level>;
};

/// A shape whose surface may have several normals at a point, of which none is to be preferred.
template <class S>
concept HasShadingNormal = requires(const S& s, const Vec4& point) {
    { shading_normal(s, point) } -> std::same_as<Vec4>;
};

/// A shape whose second_moments() are not along the body's axes.
template <class S>
concept HasPrincipalAxes = requires(const S& s) {
    /// What takes the principal axes to the body's; null if they are those.
    { principal_axes(s) } -> std::same_as<const Rotor*>;
};

/// How far a unit vector may be from the normal of a face that it is.
constexpr double kFaceNormal = 1e-6;

/// A shape that has nothing but flat faces: the manifold of two such moves with them.
template <class S>
concept IsPolytope = requires(const S& s, const Vec4& direction) {
    /// Whether a unit vector is the normal of a face, to kFaceNormal.
    { is_face_normal(s, direction) } -> std::same_as<bool>;
};

/// A shape with flat parts: bodies slide over several of them that lie in one plane as over one.
template <class S>
concept HasFaces = requires(const S& s, const Vec4& direction, const Vec4& point, double depth) {
    /// The face whose normal is nearest to the direction.
    { face_along(s, direction) } -> std::same_as<Face>;
    /// A bit for each face whose plane is no deeper than this above a point: the same for every
    /// point, or all where there are more faces than bits.
    { faces_near(s, point, depth) } -> std::same_as<std::uint64_t>;
};

}  // namespace tesserae
