// SPDX-License-Identifier: Apache-2.0
// The general pair function: against the exact pairs of boxes, against zonotopes and hulls in long
// double, and on what rests.
#include <numbers>

#include "core/contact/convex_views.hpp"
#include "tests/core/contact/pair_sets.hpp"

namespace tesserae {
namespace {

Polychoron as_hull(const Hyperbox& box) {
    std::vector<Vec4> corners;
    for (unsigned signs = 0; signs < 16; ++signs) {
        corners.push_back(0.5 * box.size);
        for (int i = 0; i < 4; ++i)
            if (signs >> i & 1) corners.back()[i] *= -1;
    }
    return hull_shape(corners);
}
const Hypercapsule& as_hull(const Hypercapsule& shape) { return shape; }
const Hypersphere& as_hull(const Hypersphere& shape) { return shape; }

/// What a cell's own normal may give away, so that bodies that lie on a cell keep it.
constexpr double kFlushAccuracy = 2e-11;
/// Of degenerate pairs, with sides 10^4 to 1: there such a normal turns by more.
constexpr double kRandomAccuracy = 1e-10, kThinAccuracy = 2e-7;

/// Boxes as hulls of their corners: the truth is that of boxes.
template <class A, class B>
void expect_hulls_exact(std::pair<Placed<A>, Placed<B>> (*draw)(RandomGeometry&), int count,
                        double accuracy, const char* set) {
    RandomGeometry random(21);
    PairErrors errors;
    for (int i = 0; i < count; ++i) {
        const auto [a, b] = draw(random);
        const auto hull_a = as_hull(a.shape);
        const auto hull_b = as_hull(b.shape);
        const Placed<std::decay_t<decltype(hull_a)>> as{hull_a, a.position, a.rotor};
        const Placed<std::decay_t<decltype(hull_b)>> bs{hull_b, b.position, b.rotor};
        SCOPED_TRACE(i);
        measure(a, b, contacts_of(as, bs), errors);
        if (::testing::Test::HasFatalFailure()) return;
    }
    errors.print(set);
    EXPECT_LT(errors.separation, kFlushAccuracy);
    EXPECT_LT(errors.touch, accuracy);
    EXPECT_LT(errors.surface, accuracy);
    EXPECT_LT(errors.outside, kSideAccuracy);
}

void expect_boxes_on_random_pairs(int pairs) {
    expect_hulls_exact<Hyperbox, Hyperbox>(random_pair, pairs, kRandomAccuracy, "hull, hull");
    expect_hulls_exact<Hyperbox, Hypercapsule>(random_pair, pairs, kRandomAccuracy,
                                               "hull, capsule");
    expect_hulls_exact<Hyperbox, Hypersphere>(random_pair, pairs, kRandomAccuracy, "hull, ball");
}

TEST(PolychoronPairs, AreThoseOfBoxesOnRandomPairs) { expect_boxes_on_random_pairs(100); }
TEST(PolychoronPairsSlow, AreThoseOfBoxesOnRandomPairs) { expect_boxes_on_random_pairs(400); }

void expect_boxes_on_degenerate_pairs(int pairs) {
    expect_hulls_exact<Hyperbox, Hyperbox>(degenerate_pair, pairs, kThinAccuracy, "hull, hull");
    expect_hulls_exact<Hyperbox, Hypercapsule>(degenerate_pair, pairs, kThinAccuracy,
                                               "hull, capsule");
    expect_hulls_exact<Hyperbox, Hypersphere>(degenerate_pair, pairs, kThinAccuracy, "hull, ball");
}

TEST(PolychoronPairs, AreThoseOfBoxesOnDegeneratePairs) { expect_boxes_on_degenerate_pairs(100); }
TEST(PolychoronPairsSlow, AreThoseOfBoxesOnDegeneratePairs) {
    expect_boxes_on_degenerate_pairs(400);
}

/// From the hull of all a - b, in long double where they are apart, by Qhull where they overlap.
double true_separation_of(const Placed<Polychoron>& a, const Placed<Polychoron>& b) {
    const auto at = [](const Placed<Polychoron>& p) {
        std::vector<LVec> points;
        const auto R = to_matrix(p.rotor).cast<long double>().eval();
        for (const Vec4& v : p.shape.body->hull.vertices)
            points.push_back(p.position.cast<long double>() + R * v.cast<long double>());
        return points;
    };
    std::vector<LVec> difference;
    std::vector<Vec4> rounded;
    for (const LVec& p : at(a))
        for (const LVec& q : at(b)) {
            difference.push_back(p - q);
            rounded.push_back((p - q).cast<double>());
        }
    const long double apart = nearest_of_hull(difference).norm();
    if (apart > 1e-12L) return double(apart);
    long double depth = std::numeric_limits<long double>::infinity();
    for (const HullCell& cell : hull_of(rounded).cells) {
        const LVec n = cell.plane.normal.cast<long double>();
        long double reach = n.dot(difference[0]);
        for (const LVec& p : difference) reach = std::max(reach, n.dot(p));
        depth = std::min(depth, reach);
    }
    return double(-depth);
}

void expect_hulls_of_differences(int pairs) {
    RandomGeometry random(22);
    double apart = 0, in_overlap = 0;
    int overlaps = 0;
    for (int i = 0; i < pairs; ++i) {
        const auto draw = [&]() -> Polychoron {
            std::vector<Vec4> points(5 + random.engine() % 10);
            for (Vec4& p : points) p = random.in_box(Vec4::Ones());
            return hull_shape(points);
        };
        const Placed<Polychoron> a{draw(), random.in_box(Vec4::Constant(5)), random_rotor(random)};
        Placed<Polychoron> b{draw(), a.position, random_rotor(random)};
        b.position += random.uniform(0, 2) * random.direction();
        const double truth = true_separation_of(a, b);
        const double error = std::abs(deepest(contacts_of(a, b)).separation - truth);
        (truth > 0 ? apart : in_overlap) = std::max(truth > 0 ? apart : in_overlap, error);
        overlaps += truth < 0;
    }
    printf("[ errors   ] apart %.2g, in overlap %.2g\n", apart, in_overlap);
    EXPECT_GT(overlaps, pairs * 4 / 15);
    EXPECT_LT(overlaps, pairs * 5 / 6);
    EXPECT_LT(apart, kFlushAccuracy);
    EXPECT_LT(in_overlap, kFlushAccuracy);
}

TEST(PolychoronPairs, AreThoseOfTheHullOfAllDifferences) { expect_hulls_of_differences(75); }
TEST(PolychoronPairsSlow, AreThoseOfTheHullOfAllDifferences) { expect_hulls_of_differences(300); }

/// Cells of two bodies flush on each other: all their corners, at one separation.
TEST(PolychoronPairs, OfFlushCellsHaveAllCorners) {
    using enum RegularPolychoron;
    const std::pair<RegularPolychoron, std::size_t> cells[] = {
        {k5Cell, 4}, {k8Cell, 8}, {k16Cell, 4}, {k24Cell, 6}, {k120Cell, 8}, {k600Cell, 4}};
    RandomGeometry random(23);
    for (const auto& [which, corners] : cells)
        for (const double gap : {-1e-3, -1e-6, 0.0, 1e-6, 1e-3}) {
            const Polychoron shape = regular_shape(which, 1.3);
            const auto& all = shape.body->hull.cells;
            const HalfSpace cell = all[random.engine() % all.size()].plane;
            // The other one, mirrored: its cell lies on this one's.
            const Rotor turn = random_rotor(random);
            const Vec4 n = rotate(turn, cell.normal), place = random.in_box(Vec4::Constant(3));
            Mat4 mirror = Mat4::Identity() - 2 * cell.normal * cell.normal.transpose();
            std::vector<Vec4> mirrored;
            for (const Vec4& v : shape.body->hull.vertices) mirrored.push_back(mirror * v);
            const Placed<Polychoron> a{shape, place, turn};
            const Placed<Polychoron> b{hull_shape(mirrored), place + (2 * cell.offset + gap) * n,
                                       turn};
            const std::vector<Contact> list = contacts_of(a, b, 0.01);
            EXPECT_EQ(list.size(), corners) << int(which) << " " << gap;
            for (const Contact& c : list) {
                EXPECT_NEAR(c.separation, gap, 1e-13);
                EXPECT_LT((c.normal - n).norm(), 1e-14);
            }
        }
}

/// A cube's cell lies on a ridge of a larger tesseract, which is a square: they meet in a square,
/// at whose corners the cell's edges cross the ridge. No corner of either is there.
TEST(PolychoronPairs, OfACellOnARidgeHaveTheCornersOfWhereTheyMeet) {
    constexpr double kHalf = 0.2, kDepth = 0.003, kBorder = 1e-9;
    const Polychoron small = as_hull(Hyperbox{Vec4::Constant(2 * kHalf)});
    const Polychoron large = as_hull(Hyperbox{Vec4::Constant(1.2)});
    // In the plane xy, so that the ridge x = y = 0.6 is on top; and how far the cell turns over it.
    const Rotor up = exp(Bivector{-std::numbers::pi / 8});
    for (const double turn : {0.0, 0.3}) {
        const double height = 0.6 * std::sqrt(2.0) + kHalf - kDepth;
        const auto list = contacts_of(
            Placed<Polychoron>{small, height * Vec4::UnitY(), exp(Bivector{0, 0, 0, 0, 0, turn})},
            Placed<Polychoron>{large, Vec4::Zero(), up}, 0.001);
        ASSERT_EQ(list.size(), 4) << turn;
        Vec4 sum = Vec4::Zero();
        for (const Contact& c : list) {
            EXPECT_NEAR(c.separation, -kDepth, kBorder) << turn;
            EXPECT_NEAR(c.normal[1], -1, kBorder) << turn;
            EXPECT_NEAR(c.point[0], 0, kBorder) << turn;
            EXPECT_NEAR(c.point.tail<2>().norm(), std::sqrt(2.0) * kHalf, kBorder) << turn;
            sum += c.point;
        }
        EXPECT_LT(sum.tail<2>().norm(), kBorder) << turn;
    }
}

TEST(PolychoronPairs, OnAPlaneAreTheLowestVertices) {
    RandomGeometry random(24);
    for (int i = 0; i < 500; ++i) {
        const Placed<Polychoron> body{random_shape<Polychoron>(random),
                                      random.in_box(Vec4::Constant(10)), random_rotor(random)};
        Hyperplane plane{random.direction(), random.uniform(-5, 5)};
        complete(plane);
        const std::vector<Contact> list = contacts_of(body, Placed<Hyperplane>{plane});
        double lowest = kMiss;
        for (const Vec4& v : body.shape.body->hull.vertices)
            lowest =
                std::min(lowest, signed_distance(plane, body.position + rotate(body.rotor, v)));
        ASSERT_FALSE(list.empty());
        ASSERT_LE(list.size(), 8u);
        EXPECT_NEAR(deepest(list).separation, lowest, 1e-13);
        for (const Contact& c : list) {
            EXPECT_NEAR(signed_distance(plane, c.point), 0.5 * c.separation, 1e-12);
            EXPECT_EQ(c.normal, -plane.normal);
        }
    }
    // All of a cell that lies on it.
    const Polychoron shape = regular_shape(RegularPolychoron::k24Cell, 1);
    const Placed<Polychoron> standing{shape, {0, std::sqrt(0.5), 0, 0}};
    Hyperplane floor;
    EXPECT_EQ(contacts_of(standing, Placed<Hyperplane>{floor}, 1e-6).size(), 6u);
}

TEST(PolychoronPairs, OfOneBodyTwiceAreNumbers) {
    using enum RegularPolychoron;
    for (const RegularPolychoron which : {k5Cell, k16Cell, k24Cell, k120Cell, k600Cell}) {
        const Placed<Polychoron> body{regular_shape(which, 1), {1, 2, 3, 4}};
        const auto list = contacts_of(body, body);
        ASSERT_FALSE(list.empty());
        // Of a centrally symmetric one twice the inradius.
        if (which != k5Cell) {
            EXPECT_NEAR(deepest(list).separation, -2 * body.shape.body->hull.cells[0].plane.offset,
                        1e-8);
        }
        for (const Contact& c : list) EXPECT_TRUE(c.point.allFinite());
    }
}

TEST(PolychoronPairs, AreReportedUpToTheMargin) {
    RandomGeometry random(25);
    for (int i = 0; i < 300; ++i) {
        const auto [a, b] = random_pair<Polychoron, Polychoron>(random);
        const double truth = deepest(contacts_of(a, b)).separation;
        EXPECT_TRUE(contacts_of(a, b, truth - 1e-6).empty());
        const auto list = contacts_of(a, b, truth + 1e-3);
        ASSERT_FALSE(list.empty());
        EXPECT_NEAR(deepest(list).separation, truth, 1e-9);
        for (std::size_t k = 1; k < list.size(); ++k)
            EXPECT_LT(list[k - 1].feature, list[k].feature);
    }
}

}  // namespace
}  // namespace tesserae
