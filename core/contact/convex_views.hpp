// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>

#include "core/contact/convex_contacts.hpp"
#include "core/convex/placed_balls.hpp"
#include "core/convex/placed_hull.hpp"
#include "core/shape/ball_product.hpp"
#include "core/shape/hull_shape.hpp"
#include "core/shape/hyperbox.hpp"
#include "core/shape/hypercapsule.hpp"

// This header shows shapes as the general pair function sees them: a core in the body's frame, the
// radius that widens it, and the piece of its surface that faces a direction.
namespace tesserae {

/// Returns the radius [m] that widens the core to the shape.
inline double core_radius(const HullShape&) { return 0; }
void piece_along(const HullShape& shape, const Vec4& direction, SurfacePiece& piece);

inline double core_radius(const Hyperbox&) { return 0; }
void piece_along(const Hyperbox& shape, const Vec4& direction, SurfacePiece& piece);

inline double core_radius(const Hypercapsule& shape) { return shape.radius; }
void piece_along(const Hypercapsule& shape, const Vec4& direction, SurfacePiece& piece);

inline double core_radius(const BallProduct&) { return 0; }
void piece_along(const BallProduct& shape, const Vec4& direction, SurfacePiece& piece);

/// A NamedPoint is a point of a surface, with a name for the contacts that it makes.
struct NamedPoint {
    Vec4 point;
    std::uint16_t name;
};
/// Returns points that span the part of the surface that faces a direction: for every ball that is
/// flat to it the ends of its axes, and the farthest point.
std::vector<NamedPoint> points_along(const BallProduct& shape, const Vec4& direction);

/// Returns the farthest point of the core along a direction.
inline Vec4 core_support(const HullShape& s, const Vec4& direction) {
    return support(s, direction);
}
inline Vec4 core_support(const Hyperbox& s, const Vec4& direction) { return support(s, direction); }
inline Vec4 core_support(const Hypercapsule& s, const Vec4& direction) {
    return Vec4(0, direction[1] < 0 ? -0.5 * s.height : 0.5 * s.height, 0, 0);
}

inline Vec4 core_support(const BallProduct& s, const Vec4& direction) {
    return support(s, direction);
}

/// Returns the core of a shape as a product of balls at a place.
PlacedBalls placed_core(const BallProduct& shape, const Mat4& turn, const Vec4& centre);
PlacedBalls placed_core(const Hyperbox& shape, const Mat4& turn, const Vec4& centre);
PlacedBalls placed_core(const Hypercapsule& shape, const Mat4& turn, const Vec4& centre);
template <class S>
concept HasBallCore = requires(const S& shape, const Mat4& turn, const Vec4& centre) {
    { placed_core(shape, turn, centre) } -> std::same_as<PlacedBalls>;
};
/// kAreBallCores is true if both cores are products of balls and one of them is round. Pairs of
/// boxes and capsules are better treated as polytopes.
template <class A, class B>
constexpr bool kAreBallCores = HasBallCore<A>&& HasBallCore<B> &&
                               (std::derived_from<A, BallProduct> ||
                                std::derived_from<B, BallProduct>);

/// Returns the core of a hull as a polytope at a place.
inline PlacedHull placed_core(const HullShape& shape, const Mat4& turn, const Vec4& centre) {
    return {shape.body->hull.vertices, shape.body->corners, turn, centre};
}

/// A PlacedCore is a core at a place, as a support function.
template <class S>
struct PlacedCore {
    const S& shape;
    const Mat4& turn;
    Vec4 centre;

    Vec4 operator()(const Vec4& direction) const {
        return centre + turn * core_support(shape, turn.transpose() * direction);
    }
};

/// Returns the separation of two cores by the best method for their types.
/// @param guess, size, enough   see convex_separation.hpp
template <class A, class B>
ConvexSeparation core_separation(const PlacedCore<A>& a, const PlacedCore<B>& b, const Vec4& guess,
                                 double size, double enough) {
    if constexpr (kAreBallCores<A, B>)
        return separation_of(placed_core(a.shape, a.turn, a.centre),
                             placed_core(b.shape, b.turn, b.centre));
    else if constexpr (std::derived_from<A, HullShape> && std::derived_from<B, HullShape>)
        return separation_of(placed_core(a.shape, a.turn, a.centre),
                             placed_core(b.shape, b.turn, b.centre), guess, size, enough);
    else
        return separation_of(a, b, guess, size, enough);
}

/// Moves a piece from the body's frame to a place.
void move_to(const Mat4& rotation, const Vec4& position, SurfacePiece& piece);

/// A PlacedBody is a shape as the general pair functions see it, while they work on it.
template <class S>
class PlacedBody {
  public:
    PlacedBody(const S& shape, const Rotor& rotor, const Vec4& centre)
        : turn_(to_matrix(rotor)), core_{shape, turn_, centre} {}
    PlacedBody(const PlacedBody&) = delete;

    const PlacedCore<S>& core() const { return core_; }
    ConvexBody seen() const { return {core_, core_radius(core_.shape), piece_, level_}; }

  private:
    struct PieceAlong {
        const PlacedCore<S>& core;
        void operator()(const Vec4& direction, SurfacePiece& piece) const {
            piece_along(core.shape, core.turn.transpose() * direction, piece);
            move_to(core.turn, core.centre, piece);
        }
    };
    struct LevelAt {
        const PlacedCore<S>& core;
        Level operator()(const Vec4& point) const {
            const Vec4 own = core.turn.transpose() * (point - core.centre);
            return {signed_distance(core.shape, own) + core_radius(core.shape),
                    core.turn * normal(core.shape, own)};
        }
    };

    Mat4 turn_;
    PlacedCore<S> core_;
    PieceAlong piece_{core_};
    LevelAt level_{core_};
};

/// Finds the contacts of two shapes for which these views exist, by the general pair function.
template <class A, class B>
void general_contacts(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b, double margin,
                      PairContacts& out) {
    const Vec4 between = pose_b.position - pose_a.position;
    const double size = bounding_radius(a) + bounding_radius(b);
    out.apart = stable_norm(between) - size;
    if (!(out.apart <= margin)) return;
    const PlacedBody<A> body_a(a, pose_a.rotor, Vec4::Zero());
    const PlacedBody<B> body_b(b, pose_b.rotor, between);
    const Vec4 guess = between.isZero(0) ? Vec4(Vec4::UnitX()) : stable_normalized(between);
    const ConvexSeparation nearest = core_separation(body_a.core(), body_b.core(), guess, size,
                                                     margin + core_radius(a) + core_radius(b));
    convex_contacts(body_a.seen(), body_b.seen(), nearest, size, pose_a.position, margin, out);
}

/// Finds the contacts over a face in the same way, by convex_contacts_over_face().
template <class A, class B>
void general_contacts_over_face(const A& a, const Pose& pose_a, const B& b, const Pose& pose_b,
                                bool face_of_b, const Vec4& outward, double margin,
                                PairContacts& out) {
    const PlacedBody<A> body_a(a, pose_a.rotor, Vec4::Zero());
    const PlacedBody<B> body_b(b, pose_b.rotor, pose_b.position - pose_a.position);
    convex_contacts_over_face(body_a.seen(), body_b.seen(), face_of_b, outward,
                              bounding_radius(a) + bounding_radius(b), pose_a.position, margin,
                              out);
}

}  // namespace tesserae
