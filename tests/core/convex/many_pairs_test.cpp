// SPDX-License-Identifier: Apache-2.0
// Distances and depths of 10^5 pairs a kind, random and nearly degenerate, against other roads: in
// long double, and none of them a search by support functions.
#include "core/convex/placed_hull.hpp"
#include "core/shape/polychoron.hpp"
#include "tests/core/convex/convex_oracle.hpp"
#include "tests/core/convex/round_oracle.hpp"

namespace tesserae {
namespace {

constexpr int kManyPairs = 100000;
/// The bounds meet slowly where bodies all but touch, or are round and nearly parallel there.
constexpr double kMostProven = 0.98;

/// A hull somewhere, with its vertices as the function under test rounds them.
struct HullSomewhere {
    PlacedHull placed;
    PointSet corners;
    double radius;

    HullSomewhere(const Polychoron& shape, const Mat4& turn, const Vec4& centre)
        : placed{shape.body->hull.vertices, shape.body->corners, turn, centre},
          radius(shape.body->radius) {
        for (const Vec4& v : placed.vertices) corners.points.push_back(centre + turn * v);
    }
    Vec4 operator()(const Vec4& direction) const { return support(placed, direction); }
    long double height(const LVec& n) const { return corners.height(n); }
    LVec nearest_to(const LVec& p) const {
        std::vector<LVec> seen;
        for (const Vec4& q : corners.points) seen.push_back(q.cast<long double>() - p);
        return p + nearest_of_hull(seen);
    }
};

/// A product of balls somewhere.
struct BallsSomewhere {
    PlacedBalls placed;
    double radius;

    explicit BallsSomewhere(const PlacedBalls& balls) : placed(balls), radius(reach_of(balls)) {}
    Vec4 operator()(const Vec4& direction) const { return support(placed, direction); }
    long double height(const LVec& n) const { return reach_along(placed, n, Vec4::Zero()); }
    LVec nearest_to(const LVec& p) const {
        const LMat turn = placed.turn.cast<long double>();
        const LVec centre = placed.centre.cast<long double>();
        LVec own = turn.transpose() * (p - centre);
        for (int g = 0; g < group_count(placed); ++g) {
            long double square = 0;
            for (std::size_t i = 0; i < 4; ++i)
                if (placed.group[i] == g) square += own[int(i)] * own[int(i)];
            const long double length = std::sqrt(square);
            for (std::size_t i = 0; i < 4 && length > placed.radius[g]; ++i)
                if (placed.group[i] == g) own[int(i)] *= placed.radius[g] / length;
        }
        return centre + turn * own;
    }
};

/// The worst of many pairs, relative to their size and their distance from the origin.
struct ManyErrors {
    int apart = 0, overlaps = 0;
    int proven = 0, solved = 0;  ///< distances by bounds; pairs by slow roads
    double gap = 0;              ///< along the normal
    double distance = 0, depth = 0, depth_by_qhull = 0;  ///< against a solver's

    void print(const char* set) const {
        printf(
            "[ errors   ] %s: %d apart, %.4g %% of them proven, %d overlap, %d solved: gap %.2g, "
            "distance %.2g, depth %.2g, by qhull %.2g\n",
            set, apart, 100.0 * proven / apart, overlaps, solved, gap, distance, depth,
            depth_by_qhull);
    }
    /// No distance is less than a gap along some normal, nor more than that of two points of the
    /// bodies: where both agree it is proven, without a solver.
    template <class A, class B>
    void note_bounds(const A& a, const B& b, const ConvexSeparation& s, double size,
                     double accuracy) {
        ASSERT_TRUE(s.normal.allFinite() && std::isfinite(s.distance));
        ASSERT_NEAR(s.normal.norm(), 1, 1e-15);
        const LVec n = s.normal.cast<long double>();
        const long double true_gap = -(a.height(n) + b.height(-n)) / n.norm();
        ConvexErrors::note(gap, std::abs(s.distance - true_gap) / size);
        ++(s.distance < 0 ? overlaps : apart);
        if (s.distance < 0) return;
        // From one to the other they come no farther apart.
        constexpr int kRounds = 30;
        LVec p = a.nearest_to(s.on_a.cast<long double>()),
             q = b.nearest_to(s.on_b.cast<long double>());
        long double most = (p - q).norm();
        for (int round = 0; round < kRounds && most - true_gap > accuracy * size; ++round) {
            p = a.nearest_to(q), q = b.nearest_to(p);
            most = std::min(most, (p - q).norm());
        }
        if (most - true_gap <= accuracy * size) ++proven;
    }
    /// The overlap is one along its normal, as the gap shows: an error is what it is more than the
    /// least. A solver's may be more: Qhull's planes lean where they are merged.
    static void note_depth(double& worst, const ConvexSeparation& s, long double least,
                           double size) {
        ConvexErrors::note(worst, std::max(0.0L, -s.distance - least) / size);
    }
};

/// Hulls of so many random points, on a sphere or in a box; or of points of a lattice, some of them
/// off it by a hair, and thin ones.
std::vector<Polychoron> random_hulls(RandomGeometry& random, int least, int most, int count) {
    std::vector<Polychoron> hulls;
    while (static_cast<int>(hulls.size()) < count) {
        const bool on_lattice = hulls.size() % 2 == 1;
        const double hair = one_of(random, std::vector<double>{0, 0, 1e-15, 1e-12, 1e-8});
        const double thin = one_of(random, std::vector<double>{1, 1, 1, 1e-2, 1e-4});
        std::vector<Vec4> points(static_cast<std::size_t>(random.uniform(least, most + 0.999)));
        for (Vec4& p : points) {
            p = on_lattice ? Vec4(random.in_box(Vec4::Constant(1.5)).array().round())
                           : random.direction();
            if (on_lattice) p[3] *= thin, p += random.in_box(Vec4::Constant(hair));
        }
        try {
            hulls.push_back(hull_shape(points));
        } catch (const std::exception&) {
            // Flat: another.
        }
    }
    return hulls;
}

/// Any turn; or none, a right angle, or a hair of one.
Mat4 some_turn(RandomGeometry& random, bool degenerate) {
    if (!degenerate) return to_matrix(random_rotor(random));
    const double angle =
        one_of(random, std::vector<double>{0, 0, M_PI / 2, M_PI, M_PI / 4, 1e-12, 1e-9, -1e-15});
    return to_matrix(exp(Bivector{angle, 0, 0, 0, 0, 0}));
}

/// Of a second body: from one centre to well apart; or by steps of a half along the axes, give or
/// take a hair.
Vec4 some_way(RandomGeometry& random, bool degenerate, double size) {
    if (!degenerate) return random.uniform(0, 1.2) * size * random.direction();
    const double hair = one_of(random, std::vector<double>{0, 0, 1e-15, 1e-12, 1e-9, 1e-6});
    return 0.5 * Vec4(random.in_box(Vec4::Constant(4.5)).array().round()) +
           random.in_box(Vec4::Constant(hair));
}

struct HullPairs {
    int count;        ///< of pairs
    int solve_every;  ///< pairs that are solved by the slow roads
    int qhull_every;  ///< of these
};

/// Of two 24-cells' 576 differences it takes 57 ms, an hour and a half for 10^5 pairs.
long double depth_by_qhull(const PointSet& a, const PointSet& b) {
    std::vector<Vec4> difference;
    for (const Vec4& p : a.points)
        for (const Vec4& q : b.points) difference.push_back(p - q);
    long double least = std::numeric_limits<long double>::infinity();
    for (const HullCell& cell : hull_of(difference).cells)
        least = std::min(least, overlap_along(a, b, cell.plane.normal.cast<long double>()));
    return least;
}

/// @param depth_of   the exact depth, from two HullSomewhere; negative: not known
template <class DepthOf>
ManyErrors measure_hulls(const std::vector<Polychoron>& hulls, const HullPairs& set,
                         const DepthOf& depth_of) {
    RandomGeometry random(31);
    ManyErrors errors;
    for (int i = 0; i < set.count; ++i) {
        const bool degenerate = i % 2 == 1;
        const Polychoron &of_a = one_of(random, hulls), &of_b = one_of(random, hulls);
        const double size = of_a.body->radius + of_b.body->radius;
        const Vec4 way = some_way(random, degenerate, size);
        const HullSomewhere a(of_a, some_turn(random, degenerate), Vec4::Zero()),
            b(of_b, some_turn(random, degenerate), way);
        const double scale = size + way.norm();
        const ConvexSeparation s = separation_of(a.placed, b.placed, way, size);
        SCOPED_TRACE(i);
        errors.note_bounds(a, b, s, scale, kConvexAccuracy);
        if (::testing::Test::HasFatalFailure()) break;
        if (i / 2 % set.solve_every != 0) continue;
        ++errors.solved;
        if (s.distance > 0) {
            std::vector<LVec> difference;
            for (const Vec4& p : a.corners.points)
                for (const Vec4& q : b.corners.points)
                    difference.push_back(p.cast<long double>() - q.cast<long double>());
            // Of bodies that all but touch it may end early, which its own bounds show.
            const LVec v = nearest_of_hull(difference);
            long double low = v.norm();
            for (const LVec& d : difference) low = std::min(low, v.dot(d) / v.norm());
            if (v.norm() - low > 1e-16L * scale) continue;
            ConvexErrors::note(errors.distance, std::abs(s.distance - v.norm()) / scale);
            continue;
        }
        ManyErrors::note_depth(errors.depth, s, depth_of(a, b), scale);
        if (!degenerate && i / 2 % set.qhull_every == 0)
            ManyErrors::note_depth(errors.depth_by_qhull, s, depth_by_qhull(a.corners, b.corners),
                                   scale);
    }
    return errors;
}

void expect_exact(const ManyErrors& errors, const char* set) {
    errors.print(set);
    EXPECT_GT(errors.overlaps, 0.1 * (errors.apart + errors.overlaps));
    EXPECT_GT(errors.apart, 0.1 * (errors.apart + errors.overlaps));
    EXPECT_LT(errors.gap, kConvexAccuracy);
    EXPECT_GT(errors.proven, kMostProven * errors.apart);
    EXPECT_LT(errors.distance, kConvexAccuracy);
    EXPECT_LT(errors.depth, kConvexAccuracy);
    EXPECT_LT(errors.depth_by_qhull, kConvexAccuracy);
}

/// Every pair is solved: all choices of 5 points whose edges may span a facet.
TEST(ConvexManyPairsSlow, OfFewVerticesAreExact) {
    RandomGeometry random(32);
    expect_exact(measure_hulls(random_hulls(random, 5, 6, 400), {kManyPairs, 1, 40},
                               [](const HullSomewhere& a, const HullSomewhere& b) {
                                   return least_overlap_of(a.corners, b.corners);
                               }),
                 "5 and 6 vertices");
}

TEST(ConvexManyPairsSlow, Of24CellsAreExact) {
    RandomGeometry random(33);
    std::vector<Polychoron> cells;
    for (const double scale : {1.0, 0.5, 1.37}) {
        std::vector<Vec4> points = Cell24({}, 1, Vec4::Zero()).corners.points;
        for (Vec4& p : points) p *= scale;
        cells.push_back(hull_shape(points));
    }
    expect_exact(measure_hulls(cells, {kManyPairs, 500, 2},
                               [](const HullSomewhere& a, const HullSomewhere& b) {
                                   return depth_by_qhull(a.corners, b.corners);
                               }),
                 "24-cells");
}

/// Their differences have up to 17,000 points, of which Qhull's hull is beyond hull_of's bounds:
/// distances alone.
TEST(ConvexManyPairsSlow, OfManyVerticesAreExact) {
    RandomGeometry random(34);
    std::vector<Polychoron> hulls = random_hulls(random, 40, 130, 10);
    hulls.push_back(regular_shape(RegularPolychoron::k600Cell, 1));
    expect_exact(measure_hulls(hulls, {kManyPairs, 1000000, 1},
                               [](const HullSomewhere& a, const HullSomewhere& b) {
                                   return least_overlap_of(a.corners, b.corners);
                               }),
                 "up to 130 vertices");
}

/// Boxes through the general way, by their supports; their differences have 56 normals at most.
struct BoxSomewhere {
    Mat4 turn;
    Vec4 half, centre;
    double radius;

    BoxSomewhere(const Placed<Hyperbox>& box, const Vec4& origin)
        : turn(to_matrix(box.rotor)),
          half(0.5 * box.shape.size),
          centre(box.position - origin),
          radius(bounding_radius(box.shape)) {}
    Vec4 operator()(const Vec4& direction) const {
        const Vec4 own = turn.transpose() * direction;
        Vec4 corner = half;
        for (int i = 0; i < 4; ++i) corner[i] *= sign_of(own[i]);
        return centre + turn * corner;
    }
    LVec axis(int i) const { return turn.col(i).cast<long double>(); }
    long double height(const LVec& n) const {
        long double sum = n.dot(centre.cast<long double>());
        for (int i = 0; i < 4; ++i) sum += half[i] * std::abs(n.dot(axis(i)));
        return sum;
    }
    LVec nearest_to(const LVec& p) const {
        LVec q = centre.cast<long double>();
        for (int i = 0; i < 4; ++i) {
            const long double along = axis(i).dot(p - centre.cast<long double>());
            q += std::clamp<long double>(along, -half[i], half[i]) * axis(i);
        }
        return q;
    }
};

/// The normals are orthogonal to three edges, of either box.
long double depth_of(const BoxSomewhere& a, const BoxSomewhere& b) {
    long double least = std::numeric_limits<long double>::infinity();
    LVec edges[8];
    for (int i = 0; i < 4; ++i) edges[i] = a.axis(i), edges[4 + i] = b.axis(i);
    for (int i = 0; i < 8; ++i)
        for (int j = i + 1; j < 8; ++j)
            for (int k = j + 1; k < 8; ++k) {
                const LVec n = orthogonal_to(edges[i], edges[j], edges[k]);
                if (n.isZero(0)) continue;
                for (const LVec& one : {n, LVec(-n)})
                    least = std::min(least, (a.height(one) + b.height(-one)) / one.norm());
            }
    return least;
}

TEST(ConvexManyPairsSlow, OfBoxesAreExact) {
    RandomGeometry random(35);
    ManyErrors errors;
    for (int i = 0; i < kManyPairs; ++i) {
        const auto [of_a, of_b] = i % 2 == 0 ? random_pair<Hyperbox, Hyperbox>(random)
                                             : degenerate_pair<Hyperbox, Hyperbox>(random);
        const BoxSomewhere a(of_a, of_a.position), b(of_b, of_a.position);
        const double size = a.radius + b.radius, scale = size + b.centre.norm();
        const ConvexSeparation s = separation_of(a, b, b.centre, size);
        SCOPED_TRACE(i);
        errors.note_bounds(a, b, s, scale, kConvexAccuracy);
        if (::testing::Test::HasFatalFailure()) break;
        if (s.distance >= 0) continue;
        ++errors.solved;
        ManyErrors::note_depth(errors.depth, s, depth_of(a, b), scale);
    }
    expect_exact(errors, "boxes");
}

/// A random spherinder, cubinder, duocylinder, box or ball, any how turned.
BallsSomewhere some_balls(RandomGeometry& random, bool degenerate, const Vec4& centre) {
    PlacedBalls balls;
    balls.group = kProducts[random.engine() % kProducts.size()];
    for (double& radius : balls.radius) radius = degenerate ? 0.5 : random.uniform(0.2, 1);
    balls.turn = some_turn(random, degenerate);
    balls.centre = centre;
    return BallsSomewhere(balls);
}

/// What a search finds that goes from the best of many directions to better ones nearby, ever
/// nearer: the depth is no more.
template <class A, class B>
double depth_by_trial(RandomGeometry& random, const A& a, const B& b, const Vec4& start) {
    const auto along = [&](const Vec4& n) { return n.dot(a(n) - b(Vec4(-n))); };
    Vec4 best = start;
    double least = along(best);
    const auto consider = [&](const Vec4& direction) {
        const Vec4 n = direction.normalized();
        if (const double depth = along(n); depth < least) least = depth, best = n;
    };
    for (int i = 0; i < 200; ++i) consider(random.direction());
    double reach = 0.5;
    for (int i = 0; i < 300; ++i, reach *= 0.97) consider(best + reach * random.direction());
    return least;
}

/// Round bodies that touch or overlap have no closed form here, and no depth is proven: what trial
/// finds is no less but for kRoundOverlapAccuracy.
template <class Draw, class Separate>
void expect_round(const char* set, const Draw& draw, const Separate& separate) {
    RandomGeometry random(36);
    ManyErrors errors;
    for (int i = 0; i < kManyPairs; ++i) {
        const bool degenerate = i % 2 == 1;
        const auto [a, b, way] = draw(random, degenerate);
        const double size = a.radius + b.radius, scale = size + way.norm();
        const ConvexSeparation s = separate(a, b, way, size);
        SCOPED_TRACE(i);
        errors.note_bounds(a, b, s, scale, kRoundAccuracy);
        if (::testing::Test::HasFatalFailure()) break;
        if (s.distance >= 0) continue;
        ++errors.solved;
        ManyErrors::note_depth(errors.depth, s, depth_by_trial(random, a, b, s.normal), scale);
    }
    errors.print(set);
    EXPECT_LT(errors.gap, kRoundAccuracy);
    EXPECT_GT(errors.proven, kMostProven * errors.apart);
    EXPECT_LT(errors.depth, kRoundOverlapAccuracy);
}

struct HullAndBalls {
    HullSomewhere a;
    BallsSomewhere b;
    Vec4 way;
};
TEST(ConvexManyPairsSlow, OfHullsAndRoundProductsAreExact) {
    RandomGeometry random(37);
    const std::vector<Polychoron> hulls = random_hulls(random, 6, 24, 200);
    expect_round(
        "hulls, round products",
        [&](RandomGeometry& r, bool degenerate) -> HullAndBalls {
            const Polychoron& hull = one_of(r, hulls);
            const Vec4 way = some_way(r, degenerate, hull.body->radius + 1);
            return {{hull, some_turn(r, degenerate), Vec4::Zero()},
                    some_balls(r, degenerate, way),
                    way};
        },
        [](const auto& a, const auto& b, const Vec4& way, double size) {
            return separation_of(a, b, way, size);
        });
}

struct BallsAndBalls {
    BallsSomewhere a, b;
    Vec4 way;
};
TEST(ConvexManyPairsSlow, OfRoundProductsAreExact) {
    expect_round(
        "round products",
        [](RandomGeometry& r, bool degenerate) -> BallsAndBalls {
            const Vec4 way = some_way(r, degenerate, 2);
            return {some_balls(r, degenerate, Vec4::Zero()), some_balls(r, degenerate, way), way};
        },
        [](const auto& a, const auto& b, const Vec4&, double) {
            return separation_of(a.placed, b.placed);
        });
}

}  // namespace
}  // namespace tesserae
