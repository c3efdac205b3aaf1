// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "bench/contact_pairs.hpp"
#include "core/contact/convex_views.hpp"

// Random pairs of convex bodies that are so far apart or overlap by so much, and what the general
// pair function does to them, with a direction to begin with of the caller's choice.
namespace tesserae::bench {

/// One body of a pair.
struct ConvexSolid {
    std::shared_ptr<const Shape> shape;
    double radius = 0;  ///< of the ball about it, in the dimension of the pair [m]
    Vec4 position = Vec4::Zero();
    Rotor rotor;
};

struct ConvexPair {
    ConvexSolid a, b;
    Vec4 last_normal = Vec4::Zero();  ///< of the contact a step ago
    double size() const { return a.radius + b.radius; }
    /// What the pair functions begin with.
    Vec4 between() const { return stable_normalized(b.position - a.position); }
};

/// Of the distance, in parts of the size.
struct Range {
    double least, largest;
    bool holds(double part) const { return least <= part && part <= largest; }
};
constexpr Range kApart{0.01, 0.1}, kOverlapping{-0.02, -0.001};

/// By how much bodies turn about each other in a step: 1 rad/s at 240 steps a second [rad].
constexpr double kHair = 1.0 / 240;

/// A body of a pair about an origin, as the general pair function sees it.
template <class S>
struct PlacedSolid {
    const S& shape;
    Mat4 turn;
    Vec4 offset;

    PlacedSolid(const S& of, const ConvexSolid& solid, const Vec4& origin)
        : shape(of), turn(to_matrix(solid.rotor)), offset(solid.position - origin) {}
    PlacedCore<S> core() const { return {shape, turn, offset}; }
    /// The same as convex_contacts() wants it.
    void put_piece(const Vec4& direction, SurfacePiece& piece) const {
        piece_along(shape, turn.transpose() * direction, piece);
        move_to(turn, offset, piece);
    }
    Level level(const Vec4& point) const {
        const Vec4 own = turn.transpose() * (point - offset);
        return {signed_distance(shape, own), turn * normal(shape, own)};
    }
};

/// The distance alone, from poses.
template <class S>
ConvexSeparation separation_of_pair(const ConvexPair& pair, const Vec4& guess) {
    const S &a = std::get<S>(*pair.a.shape), &b = std::get<S>(*pair.b.shape);
    const PlacedSolid<S> in_a(a, pair.a, pair.a.position), in_b(b, pair.b, pair.a.position);
    return core_separation(in_a.core(), in_b.core(), guess, bounding_radius(a) + bounding_radius(b),
                           std::numeric_limits<double>::infinity());
}

/// The same by their support functions alone, which is the way of any two convex bodies.
template <class S>
ConvexSeparation separation_by_supports(const ConvexPair& pair, const Vec4& guess) {
    const S &a = std::get<S>(*pair.a.shape), &b = std::get<S>(*pair.b.shape);
    const PlacedSolid<S> in_a(a, pair.a, pair.a.position), in_b(b, pair.b, pair.a.position);
    return separation_of(in_a.core(), in_b.core(), guess, bounding_radius(a) + bounding_radius(b));
}

/// How often that asks for both bodies' farthest points.
template <class S>
int rounds_of(const ConvexPair& pair, const Vec4& guess) {
    const S &a = std::get<S>(*pair.a.shape), &b = std::get<S>(*pair.b.shape);
    const PlacedSolid<S> in_a(a, pair.a, pair.a.position), in_b(b, pair.b, pair.a.position);
    int rounds = 0;
    const auto counted = [&](const Vec4& direction) -> Vec4 {
        ++rounds;
        return in_a.core()(direction);
    };
    separation_of(counted, in_b.core(), guess, bounding_radius(a) + bounding_radius(b));
    return rounds;
}

/// general_contacts() but for the guess, which is the caller's.
template <class S>
void contacts_from(const ConvexPair& pair, const Vec4& guess, std::vector<Contact>& list) {
    const S &a = std::get<S>(*pair.a.shape), &b = std::get<S>(*pair.b.shape);
    const PlacedSolid<S> in_a(a, pair.a, pair.a.position), in_b(b, pair.b, pair.a.position);
    const auto piece_a = [&](const Vec4& n, SurfacePiece& piece) { in_a.put_piece(n, piece); };
    const auto piece_b = [&](const Vec4& n, SurfacePiece& piece) { in_b.put_piece(n, piece); };
    const auto level_a = [&](const Vec4& p) { return in_a.level(p); };
    const auto level_b = [&](const Vec4& p) { return in_b.level(p); };
    PairContacts out{0, 1, false, list};
    const double size = bounding_radius(a) + bounding_radius(b);
    const PlacedCore<S> core_a = in_a.core(), core_b = in_b.core();
    convex_contacts({core_a, 0, piece_a, level_a}, {core_b, 0, piece_b, level_b},
                    core_separation(core_a, core_b, guess, size, 0), size, pair.a.position, 0, out);
}

/// Uniformly random but for details; in three dimensions w stays.
inline Rotor random_rotor(Random& random, int dimension) {
    Vec4 v[4];
    for (Vec4& one : v) {
        one = random_normals(random);
        if (dimension == 3) one[3] = 0;
    }
    return exp(wedge(3 * v[0], v[1])) * exp(wedge(3 * v[2], v[3]));
}
inline Vec4 random_direction(Random& random, int dimension) {
    Vec4 v = random_normals(random);
    if (dimension == 3) v[3] = 0;
    return v.normalized();
}

/// Two of the solids, turned at random, whose balls overlap and whose distance is in the range, now
/// and before both have turned by a hair.
template <class S>
ConvexPair random_pair(Random& random, const std::vector<ConvexSolid>& solids, Range range,
                       int dimension) {
    std::uniform_int_distribution<std::size_t> which(0, solids.size() - 1);
    for (;;) {
        ConvexPair pair{solids[which(random)], solids[which(random)]};
        pair.a.rotor = random_rotor(random, dimension);
        pair.b.rotor = random_rotor(random, dimension);
        pair.b.position =
            uniform(random, 0.2, 1) * pair.size() * random_direction(random, dimension);
        const ConvexSeparation before = separation_of_pair<S>(pair, pair.between());
        if (!range.holds(before.distance / pair.size())) continue;
        pair.last_normal = before.normal;
        for (ConvexSolid* solid : {&pair.a, &pair.b}) {
            const Bivector plane =
                wedge(random_direction(random, dimension), random_direction(random, dimension));
            solid->rotor = exp(kHair / 2 / norm(plane) * plane) * solid->rotor;
        }
        const ConvexSeparation now = separation_of_pair<S>(pair, pair.between());
        if (range.holds(now.distance / pair.size())) return pair;
    }
}

inline ConvexSolid solid_of(Shape shape) {
    std::visit([](auto& s) { complete(s); }, shape);
    const double radius = bounding_radius(shape);
    ConvexSolid solid;
    solid.shape = std::make_shared<const Shape>(std::move(shape));
    solid.radius = radius;
    return solid;
}

/// 24-cells of circumradius 0.35 to 0.65 m.
inline std::vector<ConvexSolid> cells_24(int count) {
    std::vector<ConvexSolid> solids;
    for (int i = 0; i < count; ++i) {
        Polychoron shape;
        shape.regular = RegularPolychoron::k24Cell;
        shape.radius = 0.35 + 0.3 * (i + 0.5) / count;
        solids.push_back(solid_of(shape));
    }
    return solids;
}

/// Boxes with random sides.
inline std::vector<ConvexSolid> random_boxes(Random& random, int count) {
    std::vector<ConvexSolid> solids;
    for (int i = 0; i < count; ++i) {
        Hyperbox shape;
        randomize(random, shape);
        solids.push_back(solid_of(shape));
    }
    return solids;
}

/// Boxes of which one lies flat on the other, with eight points.
inline ConvexPair resting_boxes(Random& random) {
    static const PairsIn4D kBoxes{Hyperbox{}, Hyperbox{}};
    PairsIn4D pairs = kBoxes;
    for (;;) {
        const PairsIn4D::Pair drawn = pairs.resting_pair(random);
        pairs.find(drawn);
        if (pairs.points() != 8) continue;
        ConvexPair pair{solid_of(drawn.a.shape), solid_of(drawn.b.shape)};
        pair.a.position = drawn.a.position, pair.a.rotor = drawn.a.rotor;
        pair.b.position = drawn.b.position, pair.b.rotor = drawn.b.rotor;
        return pair;
    }
}

}  // namespace tesserae::bench
