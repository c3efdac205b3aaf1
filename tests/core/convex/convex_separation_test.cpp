// SPDX-License-Identifier: Apache-2.0
#include "core/convex/convex_separation.hpp"

#include "tests/core/convex/convex_oracle.hpp"

namespace tesserae {
namespace {

/// Of the points, from their bodies: faces that are parallel but for rounding have no better one.
constexpr double kPointAccuracy = 1e-9;

/// A placed shape as the function under test sees it, relative to an origin.
template <class S>
struct PlacedSupport {
    const Placed<S>& body;
    Mat4 turn;
    Vec4 offset;

    PlacedSupport(const Placed<S>& placed, const Vec4& origin)
        : body(placed), turn(to_matrix(placed.rotor)), offset(placed.position - origin) {}
    Vec4 operator()(const Vec4& direction) const {
        return offset + turn * support(body.shape, Vec4(turn.transpose() * direction));
    }
};

/// What a shape is all points within a radius of.
struct Core {
    PointSet points;
    double radius;
};
Core core_of(const Hypersphere& s) { return {{{Vec4::Zero()}}, s.radius}; }
Core core_of(const Hypercapsule& s) {
    const Vec4 end(0, 0.5 * s.height, 0, 0);
    return {{{end, -end}}, s.radius};
}
Core core_of(const Hyperbox& s) {
    Core core{{}, 0};
    for (int corner = 0; corner < 16; ++corner) {
        Vec4 p = 0.5 * s.size;
        for (int i = 0; i < 4; ++i)
            if (corner >> i & 1) p[i] = -p[i];
        core.points.points.push_back(p);
    }
    return core;
}
template <class S>
Core placed_core(const Placed<S>& body, const Vec4& origin) {
    Core core = core_of(body.shape);
    const Mat4 turn = to_matrix(body.rotor);
    for (Vec4& p : core.points.points) p = turn * p + (body.position - origin);
    return core;
}

enum class By { kSupport, kCores };

template <class A, class B>
void measure_pair(const Placed<A>& a, const Placed<B>& b, By by, ConvexErrors& errors) {
    const double reach = bounding_radius(a.shape) + bounding_radius(b.shape);
    const Vec4 between = b.position - a.position;
    ConvexSeparation s;
    if (by == By::kSupport) {
        s = separation_of(PlacedSupport<A>(a, a.position), PlacedSupport<B>(b, a.position), between,
                          reach);
    } else {
        const Core core_a = placed_core(a, a.position), core_b = placed_core(b, a.position);
        s = widened(separation_of(core_a.points, core_b.points, between, reach), core_a.radius,
                    core_b.radius);
    }

    Zonotope za = a.zonotope(), zb = b.zonotope();
    za.centre.setZero();
    zb.centre = between.cast<long double>();
    const double size = reach + between.norm();
    errors.note_points(s, size);
    if (::testing::Test::HasFatalFailure()) return;
    const long double truth = true_separation(za, zb);
    ConvexErrors::note(s.distance < 0 ? errors.overlap : errors.distance,
                       std::abs(s.distance - truth) / size);
    const LVec n = s.normal.cast<long double>();
    const long double gap = n.dot(zb.centre) - za.extent(n) - zb.extent(n);
    ConvexErrors::note(errors.gap, std::abs(s.distance - gap) / size);
    ConvexErrors::note(errors.outside, true_distance(za, s.on_a.cast<long double>()) / size);
    ConvexErrors::note(errors.outside, true_distance(zb, s.on_b.cast<long double>()) / size);
}

template <class Pair>
class ConvexShapes : public ::testing::Test {};
using ShapePairs =
    ::testing::Types<std::pair<Hyperbox, Hyperbox>, std::pair<Hyperbox, Hypercapsule>,
                     std::pair<Hyperbox, Hypersphere>, std::pair<Hypercapsule, Hypercapsule>,
                     std::pair<Hypercapsule, Hypersphere>, std::pair<Hypersphere, Hypersphere>>;
TYPED_TEST_SUITE(ConvexShapes, ShapePairs);

template <class A, class B>
void expect_true(std::pair<Placed<A>, Placed<B>> (*draw)(RandomGeometry&), By by, const char* set,
                 int count) {
    RandomGeometry random(21);
    ConvexErrors errors;
    // The truth about two boxes takes most of the time.
    if (std::is_same_v<A, Hyperbox> && std::is_same_v<B, Hyperbox>) count /= 10;
    for (int i = 0; i < count; ++i) {
        const auto [a, b] = draw(random);
        SCOPED_TRACE(i);
        measure_pair(a, b, by, errors);
        if (::testing::Test::HasFatalFailure()) break;
    }
    errors.print(set);
    const bool is_round = by == By::kSupport && !std::is_same_v<B, Hyperbox>;
    EXPECT_LT(errors.distance, is_round ? kRoundAccuracy : kConvexAccuracy);
    EXPECT_LT(errors.overlap, is_round ? kRoundOverlapAccuracy : kConvexAccuracy);
    EXPECT_LT(errors.gap, kConvexAccuracy);
    EXPECT_LT(errors.points, kConvexAccuracy);
    if (is_round) return;
    EXPECT_LT(errors.outside, kPointAccuracy);
}

TYPED_TEST(ConvexShapes, MatchZonotopes) {
    using A = typename TypeParam::first_type;
    using B = typename TypeParam::second_type;
    expect_true<A, B>(random_pair, By::kCores, "random", 800);
}
TYPED_TEST(ConvexShapes, MatchZonotopesWhereDegenerate) {
    using A = typename TypeParam::first_type;
    using B = typename TypeParam::second_type;
    expect_true<A, B>(degenerate_pair, By::kCores, "degenerate", 800);
}
TYPED_TEST(ConvexShapes, MatchZonotopesByRoundSupports) {
    using A = typename TypeParam::first_type;
    using B = typename TypeParam::second_type;
    expect_true<A, B>(random_pair, By::kSupport, "random, round", 500);
    expect_true<A, B>(degenerate_pair, By::kSupport, "degenerate, round", 500);
}

template <class Pair>
class ConvexShapesSlow : public ::testing::Test {};
TYPED_TEST_SUITE(ConvexShapesSlow, ShapePairs);

TYPED_TEST(ConvexShapesSlow, MatchZonotopes) {
    using A = typename TypeParam::first_type;
    using B = typename TypeParam::second_type;
    for (const By by : {By::kCores, By::kSupport}) {
        expect_true<A, B>(random_pair, by, "random", 2000);
        expect_true<A, B>(degenerate_pair, by, "degenerate", 2000);
    }
}

/// Points in a ball or on its surface.
PointSet random_points(RandomGeometry& random, int count) {
    PointSet set;
    const bool on_surface = random.uniform(0, 1) < 0.5;
    for (int i = 0; i < count; ++i)
        set.points.push_back((on_surface ? 1 : std::pow(random.uniform(0, 1), 0.25)) *
                             random.direction());
    return set;
}

/// Checks all but the distance itself.
template <class Set>
void expect_consistent(const Set& a, const Set& b, const ConvexSeparation& s, double size,
                       ConvexErrors& errors) {
    errors.note_points(s, size);
    const LVec n = s.normal.template cast<long double>();
    ConvexErrors::note(errors.gap, std::abs(s.distance + overlap_along(a, b, n)) / size);
}

void expect_exchange_of_weights(int pairs) {
    RandomGeometry random(22);
    ConvexErrors errors;
    int known = 0;
    for (int i = 0; i < pairs; ++i) {
        // The exchange takes long for many points.
        const double most = i % 20 == 0 ? 61 : 13;
        const PointSet a = random_points(random, static_cast<int>(random.uniform(1, most)));
        const Vec4 way = random.uniform(0.5, 2.5) * random.direction();
        const PointSet b =
            random_points(random, static_cast<int>(random.uniform(1, most))).moved(way);
        const ConvexSeparation s = separation_of(a, b, way, 2);
        expect_consistent(a, b, s, 2, errors);
        if (s.distance <= 0) continue;
        const ApartBounds truth(a, b, 1e-16L);
        // Where the weights have not settled the bounds still hold.
        EXPECT_GT(s.distance, static_cast<double>(truth.low) - 2 * kConvexAccuracy) << i;
        EXPECT_LT(s.distance, static_cast<double>(truth.high) + 2 * kConvexAccuracy) << i;
        if (truth.high - truth.low > 1e-15L) continue;
        ++known;
        ConvexErrors::note(errors.distance, std::abs(s.distance - truth.high) / 2);
        ConvexErrors::note(errors.outside, ApartBounds(a, PointSet{{s.on_a}}, 1e-15L).low / 2);
        ConvexErrors::note(errors.outside, ApartBounds(b, PointSet{{s.on_b}}, 1e-15L).low / 2);
    }
    errors.print("point sets");
    EXPECT_GT(known, pairs / 5);
    EXPECT_LT(errors.distance, kConvexAccuracy);
    EXPECT_LT(errors.gap, kConvexAccuracy);
    EXPECT_LT(errors.points, kConvexAccuracy);
    EXPECT_LT(errors.outside, kConvexAccuracy);
}

TEST(ConvexPointSets, MatchExchangeOfWeightsWhereApart) { expect_exchange_of_weights(300); }
TEST(ConvexPointSetsSlow, MatchExchangeOfWeightsWhereApart) { expect_exchange_of_weights(1000); }

void expect_facets_of_point_sets(int pairs) {
    RandomGeometry random(23);
    ConvexErrors errors;
    for (int i = 0; i < pairs; ++i) {
        const PointSet a = random_points(random, static_cast<int>(random.uniform(5, 9)));
        const Vec4 way = random.uniform(0, 0.8) * random.direction();
        const PointSet b = random_points(random, static_cast<int>(random.uniform(5, 9))).moved(way);
        const ConvexSeparation s = separation_of(a, b, way, 2);
        expect_consistent(a, b, s, 2, errors);
        if (s.distance >= 0) continue;
        ConvexErrors::note(errors.overlap, std::abs(s.distance + least_overlap_of(a, b)) / 2);
    }
    errors.print("small point sets");
    EXPECT_GT(errors.deep, pairs * 3 / 8);
    EXPECT_LT(errors.overlap, kConvexAccuracy);
    EXPECT_LT(errors.gap, kConvexAccuracy);
    EXPECT_LT(errors.points, kConvexAccuracy);
}

TEST(ConvexPointSets, MatchAllFacetsInOverlap) { expect_facets_of_point_sets(120); }
TEST(ConvexPointSetsSlow, MatchAllFacetsInOverlap) { expect_facets_of_point_sets(400); }

TEST(ConvexCells, MatchAllFacetsInOverlap) {
    RandomGeometry random(24);
    ConvexErrors errors;
    for (int i = 0; i < 40; ++i) {
        const bool is_aligned = i % 4 == 3;
        const Rotor turn = random_rotor(random);
        const Vec4 way = random.uniform(0, 2.8) * random.direction();
        const Cell24 a(turn, 1, Vec4::Zero()),
            b(is_aligned ? turn : random_rotor(random), random.uniform(0.3, 1), way);
        const double size = a.corners.radius() + b.corners.radius();
        const ConvexSeparation s = separation_of(a.corners, b.corners, way, size);
        expect_consistent(a.corners, b.corners, s, size, errors);
        if (s.distance >= 0) continue;
        ConvexErrors::note(errors.overlap, std::abs(s.distance + least_overlap_of(a, b)) / size);
    }
    errors.print("24-cells");
    EXPECT_GT(errors.deep, 10);
    EXPECT_LT(errors.overlap, kConvexAccuracy);
    EXPECT_LT(errors.gap, kConvexAccuracy);
    EXPECT_LT(errors.points, kConvexAccuracy);
}

/// The corners of a box along the axes.
PointSet box_at(const Vec4& centre, const Vec4& half) {
    PointSet box;
    for (int corner = 0; corner < 16; ++corner) {
        Vec4 p = half;
        for (int i = 0; i < 4; ++i)
            if (corner >> i & 1) p[i] = -p[i];
        box.points.push_back(centre + p);
    }
    return box;
}

/// Of any two sets: the same from the other side, and they touch after a move by the separation.
void expect_properties(const PointSet& a, const PointSet& b, const Vec4& guess, double size) {
    ConvexErrors errors;
    const ConvexSeparation s = separation_of(a, b, guess, size);
    expect_consistent(a, b, s, size, errors);
    EXPECT_LT(errors.gap, kConvexAccuracy);
    EXPECT_LT(errors.points, kConvexAccuracy);
    const ConvexSeparation swapped = separation_of(b, a, -guess, size);
    EXPECT_NEAR(swapped.distance, s.distance, 2 * kConvexAccuracy * size);
    const ConvexSeparation moved = separation_of(a, b.moved(-s.distance * s.normal), guess, size);
    EXPECT_NEAR(moved.distance, 0, 2 * kConvexAccuracy * size);
}

TEST(ConvexPointSets, TouchAfterAMoveBySeparation) {
    RandomGeometry random(25);
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE(i);
        const PointSet a = random_points(random, static_cast<int>(random.uniform(1, 30)));
        const Vec4 way = random.uniform(0, 2) * random.direction();
        const PointSet b =
            random_points(random, static_cast<int>(random.uniform(1, 30))).moved(way);
        expect_properties(a, b, random.direction(), 2);
    }
}

TEST(ConvexCells, HaveClosedFormsWhereDegenerate) {
    RandomGeometry random(26);
    const Vec4 one = Vec4::Ones();
    const auto distance = [&](const PointSet& a, const PointSet& b) {
        expect_properties(a, b, random.direction(), 4);
        return separation_of(a, b, random.direction(), 4).distance;
    };
    const auto expect = [](double value, double truth) {
        EXPECT_NEAR(value, truth, 4 * kConvexAccuracy);
    };
    const PointSet cube = box_at(Vec4::Zero(), one);
    const Cell24 cell({}, 1, Vec4::Zero());
    for (int round = 0; round < 20; ++round) {
        // One place: half the sum of the least widths.
        expect(distance(cube, cube), -2);
        expect(distance(cell.corners, cell.corners), -2);
        // Flush, at a vertex, at an edge, and a half shifted.
        expect(distance(cube, box_at({2, 0, 0, 0}, one)), 0);
        expect(distance(cube, box_at({2, 0.3, 0, 1}, one)), 0);
        expect(distance(cube, box_at({2, 2, 2, 2}, one)), 0);
        expect(distance(cube, box_at({2, 2, 2, 1}, one)), 0);
        expect(distance(cube, box_at({1, 1, 1, 1}, one)), -1);
        expect(distance(cube, box_at({3, 3, 3, 3}, one)), 2);
        expect(distance(cell.corners, cell.corners.moved({2, 2, 0, 0})), 0);
        expect(distance(cell.corners, cell.corners.moved({2, 0, 0, 0})), 0);
        // A point, on a corner, on a facet, within and without; two points.
        for (const double x : {0.0, 0.5, 1.0, 3.0})
            expect(distance(cube, PointSet{{Vec4(x, 0, 0, 0)}}), x - 1);
        expect(distance(cube, PointSet{{one}}), 0);
        expect(distance(PointSet{{one}}, PointSet{{one}}), 0);
        expect(distance(PointSet{{one}}, PointSet{{-one}}), 4);
        // Segments: crossing, along one line, parallel, through the cube.
        const PointSet x{{Vec4(-1, 0, 0, 0), Vec4(1, 0, 0, 0)}},
            y{{Vec4(0, -1, 0, 0), Vec4(0, 1, 0, 0)}};
        expect(distance(x, y), 0);
        expect(distance(x, x), 0);
        expect(distance(x, x.moved({3, 0, 0, 0})), 1);
        expect(distance(x, x.moved({1, 0, 3, 0})), 3);
        expect(distance(x, y.moved({0, 0, 0, 2})), 2);
        expect(distance(cube, x), -1);
        expect(distance(cube, x.moved({1, 0, 0, 0})), -1);
        // Flat boxes: crossing in a plane, and of any thinness.
        expect(distance(box_at(Vec4::Zero(), {1, 1, 0, 0}), box_at(Vec4::Zero(), {0, 0, 1, 1})),
               -1);
        expect(distance(box_at(Vec4::Zero(), {1, 1, 1, 0}), cube), -1);
        for (const double thin : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15})
            expect(distance(box_at(Vec4::Zero(), {1, 1, 1, thin}),
                            box_at({0.5, 0, 0, 0}, {1, 1, 1, thin})),
                   -2 * thin);
    }
}

TEST(ConvexCells, ScaleAndStandAnywhere) {
    RandomGeometry random(27);
    for (int i = 0; i < 300; ++i) {
        const Rotor turn = random_rotor(random);
        const Vec4 way = random.uniform(0, 2.8) * random.direction();
        const Cell24 a({}, 1, Vec4::Zero()), b(turn, 1, way);
        const double unit = separation_of(a.corners, b.corners, way, 2.8).distance;
        for (const double scale : {1e-6, 1e-3, 1e3, 1e6, 1e-60, 1e60}) {
            PointSet large_a = a.corners, large_b = b.corners;
            for (PointSet* set : {&large_a, &large_b})
                for (Vec4& p : set->points) p *= scale;
            EXPECT_NEAR(separation_of(large_a, large_b, way, 2.8 * scale).distance / scale, unit,
                        2.8 * kConvexAccuracy);
        }
        // Far from the origin coordinates are rounded.
        const Vec4 far = 1e4 * random.direction();
        EXPECT_NEAR(separation_of(a.corners.moved(far), b.corners.moved(far), way, 2.8).distance,
                    unit, 1e4 * kConvexAccuracy);
    }
}

TEST(ConvexCells, TakeAnyGuessAndSize) {
    const PointSet cube = box_at(Vec4::Zero(), Vec4::Ones());
    const PointSet other = box_at({1.5, 0.5, 0, 0}, Vec4::Ones());
    for (const Vec4& guess : {Vec4(1, 0, 0, 0), Vec4(-1, 0, 0, 0), Vec4(1e-300, 1e-300, 0, 0),
                              Vec4(0, 1e200, 0, 0), Vec4(0, 0, 0, 0)})
        for (const double size : {0.1, 1.0, 4.0, 40.0})
            EXPECT_NEAR(separation_of(cube, other, guess, size).distance, -0.5, 1e-13);
}

}  // namespace
}  // namespace tesserae
