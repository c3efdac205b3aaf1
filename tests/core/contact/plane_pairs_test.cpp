// SPDX-License-Identifier: Apache-2.0
#include "tests/core/contact/pair_sets.hpp"

// Against a plane the truth is a list: in long double, the ends or corners of the body and their
// heights.
namespace tesserae {
namespace {

struct Corner {
    std::uint32_t feature;
    LVec core;
    long double separation;
};

/// Every corner of the core, less the radius. Bit k of the feature: generator k is added.
std::vector<Corner> corners(const Zonotope& body, const LVec& normal, long double offset) {
    std::vector<Corner> list;
    const bool sphere = body.generators.empty() || body.generators[0].isZero(0);
    const std::uint32_t count = sphere ? 1 : 1u << body.generators.size();
    for (std::uint32_t feature = 0; feature < count; ++feature) {
        LVec core = body.centre;
        for (std::size_t k = 0; k < body.generators.size(); ++k)
            core += (feature >> k & 1 ? 1 : -1) * body.generators[k];
        list.push_back({feature, core, normal.dot(core) - offset - body.rho});
    }
    return list;
}

template <class S>
void expect_corners(int count) {
    RandomGeometry random(21);
    for (int i = 0; i < count; ++i) {
        const auto [body, other] =
            i % 2 ? random_pair<S, Hypersphere>(random) : degenerate_pair<S, Hypersphere>(random);
        Placed<Hyperplane> plane;
        plane.shape.normal =
            i % 3 ? random.direction() : Vec4(to_matrix(body.rotor).col(i / 3 % 4));
        plane.shape.offset = plane.shape.normal.dot(body.position) +
                             random.uniform(-1.5, 1.5) * bounding_radius(body.shape);
        const double margin = random.uniform(0, 1) < 0.5
                                  ? kAlways
                                  : random.uniform(-1, 1) * bounding_radius(body.shape);

        const Zonotope zonotope = body.zonotope();
        const LVec n = plane.shape.normal.cast<long double>();
        std::vector<Corner> expected = corners(zonotope, n, plane.shape.offset);
        const double error = kPairAccuracy * (body.position.norm() + bounding_radius(body.shape));
        std::erase_if(expected, [&](const Corner& c) { return c.separation > margin + error; });
        const std::vector<Contact> list = contacts_of(body, plane, margin);
        const auto swapped = contacts_of(plane, body, margin);
        ASSERT_EQ(swapped.size(), list.size());

        // All of them up to eight, of more those that are not behind others (a corner at the margin
        // or behind another by a hair may be in or out by rounding).
        const auto is_behind = [&](const Corner& c, const Corner& deeper) {
            const LVec from = c.core - deeper.core;
            const long double along = n.dot(from), higher = c.separation - deeper.separation;
            return (from - along * n).norm() < higher + 4 * error;
        };
        std::size_t sure = 0;
        for (const Corner& c : expected)
            if (c.separation < margin - error &&
                (expected.size() <= 8 ||
                 std::none_of(expected.begin(), expected.end(), [&](const Corner& deeper) {
                     return &c != &deeper && is_behind(c, deeper);
                 })))
                ++sure;
        ASSERT_GE(list.size(), std::min<std::size_t>(8, sure)) << i;
        ASSERT_LE(list.size(), std::min<std::size_t>(8, expected.size())) << i;
        for (std::size_t k = 0; k < list.size(); ++k) {
            const Contact& c = list[k];
            ASSERT_TRUE(k == 0 || list[k - 1].feature < c.feature);
            const auto corner =
                std::find_if(expected.begin(), expected.end(),
                             [&](const Corner& e) { return e.feature == c.feature; });
            ASSERT_NE(corner, expected.end()) << i;
            ASSERT_NEAR(c.separation, static_cast<double>(corner->separation), error) << i;
            const LVec point = corner->core - (zonotope.rho + 0.5L * corner->separation) * n;
            ASSERT_LT((c.point - point.cast<double>()).norm(), 4 * error) << i;
            ASSERT_EQ(c.normal, -plane.shape.normal);
            ASSERT_EQ(swapped[k].normal, plane.shape.normal);
        }
        if (sure == 0) continue;
        long double lowest = expected[0].separation;
        for (const Corner& c : expected) lowest = std::min(lowest, c.separation);
        ASSERT_NEAR(deepest(list).separation, static_cast<double>(lowest), error) << i;
    }
}

TEST(CapsulePlaneContacts, AreItsEnds) { expect_corners<Hypercapsule>(20000); }
TEST(BoxPlaneContacts, AreItsCorners) { expect_corners<Hyperbox>(20000); }
TEST(CapsulePlaneContactsSlow, AreItsEnds) { expect_corners<Hypercapsule>(200000); }
TEST(BoxPlaneContactsSlow, AreItsCorners) { expect_corners<Hyperbox>(200000); }

TEST(BoxPlaneContacts, AreTheEightCornersOfACellAtRest) {
    // The cell y = -1 lies 0.01 deep; the other cell's corners, 2 higher, are within the margin.
    Placed<Hyperplane> plane;
    const Placed<Hyperbox> box{{{2, 2, 2, 2}}, {5, 0.99, 0, 0}};
    const auto list = contacts_of(box, plane, 3);
    ASSERT_EQ(list.size(), 8u);
    for (const Contact& c : list) {
        EXPECT_EQ(c.feature & 2u, 0u);
        EXPECT_NEAR(c.separation, -0.01, 1e-15);
        EXPECT_NEAR(c.point[1], -0.005, 1e-15);
    }
}

TEST(PlaneContacts, AreNumbersForOddShapes) {
    for (double offset : {0.0, 1e-300, 1.0, -1e150, 1e300}) {
        Placed<Hyperplane> plane;
        plane.shape.offset = offset;
        const auto expect_numbers = [&](const auto& body) {
            for (const Contact& c : contacts_of(body, plane)) {
                EXPECT_FALSE(std::isnan(c.separation));
                EXPECT_FALSE(c.point.hasNaN());
            }
        };
        for (const Hypercapsule& s : odd_shapes<Hypercapsule>())
            expect_numbers(Placed<Hypercapsule>{s});
        for (const Hyperbox& s : odd_shapes<Hyperbox>()) expect_numbers(Placed<Hyperbox>{s});
    }
}

}  // namespace
}  // namespace tesserae
