// SPDX-License-Identifier: Apache-2.0
#include "core/convex/placed_hull.hpp"

#include "core/shape/polychoron.hpp"
#include "tests/core/convex/convex_oracle.hpp"

namespace tesserae {
namespace {

PlacedHull placed(const Polychoron& shape, const Mat4& turn, const Vec4& centre) {
    return {shape.body->hull.vertices, shape.body->corners, turn, centre};
}

ConvexSeparation by_supports(const PlacedHull& a, const PlacedHull& b, const Vec4& guess,
                             double size) {
    return separation_of([&](const Vec4& n) { return support(a, n); },
                         [&](const Vec4& n) { return support(b, n); }, guess, size);
}

TEST(PlacedHulls, SeparateAsTheirSupportsDo) {
    RandomGeometry random(41);
    std::vector<Polychoron> large, small;
    // The overlap of a 120-cell and a 600-cell that are one in the other is not the same by any
    // way: their difference has more facets than ExpandingPolytope grows.
    for (int which = 1; which <= 4; ++which) {
        large.push_back(regular_shape(static_cast<RegularPolychoron>(which), 1));
        small.push_back(regular_shape(static_cast<RegularPolychoron>(which), 0.7));
    }
    for (int i = 0; i < 400; ++i) {
        SCOPED_TRACE(i);
        const Polychoron &of_a = one_of(random, large), &of_b = one_of(random, small);
        // Every fourth pair is turned alike: faces are parallel and many vertices equally far.
        const Mat4 turn = to_matrix(random_rotor(random));
        const Vec4 way = random.uniform(0, 2.2) * random.direction();
        const double scale = std::pow(10, random.uniform(-60, 60));
        const PlacedHull a = placed(of_a, turn, Vec4::Zero()),
                         b = placed(of_b, i % 4 == 3 ? turn : to_matrix(random_rotor(random)), way);
        const double truth = by_supports(a, b, way, 1.7).distance;
        EXPECT_NEAR(separation_of(a, b, way, 1.7).distance, truth, 2 * kConvexAccuracy);
        EXPECT_NEAR(separation_of(b, a, random.direction(), 1.7).distance, truth,
                    2 * kConvexAccuracy);
        std::vector<Vec4> large_a = of_a.body->hull.vertices, large_b = of_b.body->hull.vertices;
        LinearForms corners_a, corners_b;
        for (Vec4& p : large_a) corners_a.add(p *= scale, 0);
        for (Vec4& p : large_b) corners_b.add(p *= scale, 0);
        EXPECT_NEAR(
            separation_of(PlacedHull{large_a, corners_a, a.turn, a.centre},
                          PlacedHull{large_b, corners_b, b.turn, scale * way}, way, 1.7 * scale)
                    .distance /
                scale,
            truth, 4 * kConvexAccuracy);
    }
}

TEST(PlacedHulls, TakeAnyGuess) {
    const Polychoron cell = regular_shape(RegularPolychoron::k24Cell, 1);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const PlacedHull a = placed(cell, Mat4::Identity(), Vec4::Zero());
    for (const Vec4& way : {Vec4(0, 0, 0, 0), Vec4(1.9, 0.3, 0, 0), Vec4(3, 0, 0, 0)}) {
        const PlacedHull b = placed(cell, Mat4::Identity(), way);
        const double truth = by_supports(a, b, Vec4::UnitX(), 2).distance;
        for (const Vec4& guess : {Vec4(1, 0, 0, 0), Vec4(-1, 0, 0, 0), Vec4(1e-300, 0, 1e-300, 0),
                                  Vec4(0, 1e200, 0, 0), Vec4(0, 0, 0, 0), Vec4(nan, 0, 0, 0)})
            EXPECT_NEAR(separation_of(a, b, guess, 2).distance, truth, 2 * kConvexAccuracy);
    }
}

/// What is farther apart than asked may be said to be so by less than the distance.
TEST(PlacedHulls, AreToldApartByATrueGap) {
    RandomGeometry random(42);
    const Polychoron cell = regular_shape(RegularPolychoron::k24Cell, 1);
    for (int i = 0; i < 1000; ++i) {
        SCOPED_TRACE(i);
        const Vec4 way = random.uniform(0.5, 2.5) * random.direction();
        const PlacedHull a = placed(cell, to_matrix(random_rotor(random)), Vec4::Zero()),
                         b = placed(cell, to_matrix(random_rotor(random)), way);
        const double enough = random.uniform(0, 0.3);
        const double truth = by_supports(a, b, way, 2).distance;
        const ConvexSeparation s = separation_of(a, b, way, 2, enough);
        if (truth < enough) {
            EXPECT_NEAR(s.distance, truth, 2 * kConvexAccuracy);
        } else if (truth > enough + kConvexAccuracy) {
            EXPECT_GT(s.distance, enough);
        }
        EXPECT_LE(s.distance, truth + 2 * kConvexAccuracy);
        const double gap = s.normal.dot(support(b, -s.normal) - support(a, s.normal));
        EXPECT_NEAR(s.distance, gap, 2 * kConvexAccuracy);
        EXPECT_LT((s.on_b - s.on_a - s.distance * s.normal).norm(), kConvexAccuracy);
    }
}

}  // namespace
}  // namespace tesserae
