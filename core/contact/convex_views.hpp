#pragma once

#include <concepts>

#include "core/contact/convex_contacts.hpp"
#include "core/convex/placed_balls.hpp"
#include "core/convex/placed_hull.hpp"
#include "core/shape/ball_product.hpp"
#include "core/shape/hull_shape.hpp"
#include "core/shape/hyperbox.hpp"
#include "core/shape/hypercapsule.hpp"

// Shapes as the general pair function sees them: a core in the body's frame, what it is widened by,
// and the piece of its surface that looks along a direction.
namespace tesserae {

inline double core_radius(const HullShape&) { return 0; }
void piece_along(const HullShape& shape, const Vec4& direction, SurfacePiece& piece);

inline double core_radius(const Hyperbox&) { return 0; }
void piece_along(const Hyperbox& shape, const Vec4& direction, SurfacePiece& piece);

inline double core_radius(const Hypercapsule& shape) { return shape.radius; }
void piece_along(const Hypercapsule& shape, const Vec4& direction, SurfacePiece& piece);

inline double core_radius(const BallProduct&) { return 0; }
void piece_along(const BallProduct& shape, const Vec4& direction, SurfacePiece& piece);

/// A point of a surface, named for the contacts that it makes.
struct NamedPoint {
    Vec4 point;
    std::uint16_t name;
};
/// Points of the surface that span what looks along a direction: of every ball that is flat to it
/// the ends of its axes, and the farthest point.
std::vector<NamedPoint> points_along(const BallProduct& shape, const Vec4& direction);

/// Farthest point of the core.
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

/// Cores that are products of balls.
PlacedBalls placed_core(const BallProduct& shape, const Mat4& turn, const Vec4& centre);
PlacedBalls placed_core(const Hyperbox& shape, const Mat4& turn, const Vec4& centre);
PlacedBalls placed_core(const Hypercapsule& shape, const Mat4& turn, const Vec4& centre);
template <class S>
concept HasBallCore = requires(const S& shape, const Mat4& turn, const Vec4& centre) {
    { placed_core(shape, turn, centre) } -> std::same_as<PlacedBalls>;
};
/// Two such, of which one is round: boxes and capsules are better off as polytopes.
template <class A, class B>
constexpr bool kAreBallCores = HasBallCore<A>&& HasBallCore<B> &&
                               (std::derived_from<A, BallProduct> ||
                                std::derived_from<B, BallProduct>);

/// Cores that are polytopes of many vertices.
inline PlacedHull placed_core(const HullShape& shape, const Mat4& turn, const Vec4& centre) {
    return {shape.body->hull.vertices, shape.body->corners, turn, centre};
}

/// A core somewhere, as a support function.
template <class S>
struct PlacedCore {
    const S& shape;
    const Mat4& turn;
    Vec4 centre;

    Vec4 operator()(const Vec4& direction) const {
        return centre + turn * core_support(shape, turn.transpose() * direction);
    }
};

/// The separation of two cores, by the best way that there is for them.
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

/// Moves a piece from the body's frame.
void move_to(const Mat4& rotation, const Vec4& position, SurfacePiece& piece);

/// A shape as the general pair functions see it, for as long as they work on it.
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

/// The general pair function for two shapes of which these views exist.
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

/// The same for convex_contacts_over_face().
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
