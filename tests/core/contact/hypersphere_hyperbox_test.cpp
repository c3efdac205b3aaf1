// SPDX-License-Identifier: Apache-2.0
#include "tests/core/contact/pair_sets.hpp"

namespace tesserae {
namespace {

TEST(SphereBoxContacts, AreExactOnRandomPairs) {
    expect_exact<Hypersphere, Hyperbox>(random_pair, 2000, "random");
}
TEST(SphereBoxContacts, AreExactOnDegeneratePairs) {
    expect_exact<Hypersphere, Hyperbox>(degenerate_pair, 2000, "degenerate");
}
TEST(SphereBoxContacts, AreTheSameAfterMappingAndSwapping) {
    expect_symmetric<Hypersphere, Hyperbox>(random_pair, 2000);
    expect_symmetric<Hypersphere, Hyperbox>(degenerate_pair, 2000);
}
TEST(SphereBoxContacts, DoNotJump) { expect_no_jump<Hypersphere, Hyperbox>(20000); }
TEST(SphereBoxContacts, BoundEveryGap) { expect_bounds_every_gap<Hypersphere, Hyperbox>(15); }
TEST(SphereBoxContacts, AreNumbersForOddShapes) { expect_no_nan<Hypersphere, Hyperbox>(); }
TEST(SphereBoxContacts, AreReportedUpToTheMargin) {
    expect_margin_kept<Hypersphere, Hyperbox>(3000);
}

TEST(SphereBoxContactsSlow, AreExactOnManyPairs) {
    expect_exact<Hypersphere, Hyperbox>(random_pair, 100000, "random");
    expect_exact<Hypersphere, Hyperbox>(degenerate_pair, 100000, "degenerate");
}

TEST(SphereBoxContacts, PushACentreInsideThroughTheNearestCell) {
    const Placed<Hyperbox> box{{{2, 4, 6, 8}}};
    for (int axis = 0; axis < 4; ++axis)
        for (double side : {-1.0, 1.0}) {
            const double half = axis + 1;
            const Vec4 centre = side * (half - 0.125) * Vec4::Unit(axis);
            const auto list = contacts_of(Placed<Hypersphere>{{0.5}, centre}, box);
            ASSERT_EQ(list.size(), 1u);
            EXPECT_EQ(list[0].normal, -side * Vec4::Unit(axis));
            EXPECT_EQ(list[0].separation, -0.625);
            // Midway between the cell and the sphere's innermost point.
            EXPECT_EQ(list[0].point, side * (half - 0.3125) * Vec4::Unit(axis));
        }
}

}  // namespace
}  // namespace tesserae
