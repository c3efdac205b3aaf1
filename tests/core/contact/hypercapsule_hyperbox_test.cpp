// SPDX-License-Identifier: Apache-2.0
#include "tests/core/contact/pair_sets.hpp"

namespace tesserae {
namespace {

TEST(CapsuleBoxContacts, AreExactOnRandomPairs) {
    expect_exact<Hypercapsule, Hyperbox>(random_pair, 2000, "random");
}
TEST(CapsuleBoxContacts, AreExactOnDegeneratePairs) {
    expect_exact<Hypercapsule, Hyperbox>(degenerate_pair, 2000, "degenerate");
}
TEST(CapsuleBoxContacts, AreTheSameAfterMappingAndSwapping) {
    expect_symmetric<Hypercapsule, Hyperbox>(random_pair, 2000);
    expect_symmetric<Hypercapsule, Hyperbox>(degenerate_pair, 2000);
}
TEST(CapsuleBoxContacts, DoNotJump) { expect_no_jump<Hypercapsule, Hyperbox>(20000); }
TEST(CapsuleBoxContacts, BoundEveryGap) { expect_bounds_every_gap<Hypercapsule, Hyperbox>(15); }
TEST(CapsuleBoxContacts, AreNumbersForOddShapes) { expect_no_nan<Hypercapsule, Hyperbox>(); }
TEST(CapsuleBoxContacts, AreReportedUpToTheMargin) {
    expect_margin_kept<Hypercapsule, Hyperbox>(3000);
}

TEST(CapsuleBoxContactsSlow, AreExactOnManyPairs) {
    expect_exact<Hypercapsule, Hyperbox>(random_pair, 100000, "random");
    expect_exact<Hypercapsule, Hyperbox>(degenerate_pair, 100000, "degenerate");
}

TEST(CapsuleBoxContacts, AreTwoWhereACapsuleLiesOnACell) {
    // On the cell w = 1 of a box with halves 1; over the border y = 1 by half its core.
    const Placed<Hyperbox> box{{{2, 2, 2, 2}}};
    for (double tilt : {0.0, 1e-9, -1e-9, 1e-17, -1e-17}) {
        const Rotor turn = exp(Bivector{0, 0, 0, 0, tilt / 2, 0});
        const auto inside =
            contacts_of(Placed<Hypercapsule>{{0.25, 1}, {0, 0.25, 0, 1.2}, turn}, box, 0.1);
        ASSERT_EQ(inside.size(), 2u) << tilt;
        EXPECT_EQ(inside[0].feature, 0u);
        EXPECT_EQ(inside[1].feature, 1u);
        const auto over =
            contacts_of(Placed<Hypercapsule>{{0.25, 1}, {0, 1, 0, 1.2}, turn}, box, 0.1);
        ASSERT_EQ(over.size(), 2u) << tilt;
        EXPECT_EQ(over[0].feature, 0u);
        EXPECT_EQ(over[1].feature, 5u);  // the border y = +1
        for (const auto& list : {inside, over})
            for (const Contact& c : list) {
                EXPECT_NEAR(c.separation, -0.05, 2e-9);
                EXPECT_LT((c.normal + Vec4::UnitW()).norm(), 1e-7);
                EXPECT_NEAR(c.point[3], 0.975, 2e-9);
            }
        EXPECT_NEAR(inside[0].point[1], -0.25, 1e-8);
        EXPECT_NEAR(inside[1].point[1], 0.75, 1e-8);
        EXPECT_NEAR(over[0].point[1], 0.5, 1e-8);
        EXPECT_NEAR(over[1].point[1], 1, 1e-8);
    }
}

}  // namespace
}  // namespace tesserae
