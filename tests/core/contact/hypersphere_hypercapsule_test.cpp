// SPDX-License-Identifier: Apache-2.0
#include "tests/core/contact/pair_sets.hpp"

namespace tesserae {
namespace {

TEST(SphereCapsuleContacts, AreExactOnRandomPairs) {
    expect_exact<Hypersphere, Hypercapsule>(random_pair, 3000, "random");
}
TEST(SphereCapsuleContacts, AreExactOnDegeneratePairs) {
    expect_exact<Hypersphere, Hypercapsule>(degenerate_pair, 3000, "degenerate");
}
TEST(SphereCapsuleContacts, AreTheSameAfterMappingAndSwapping) {
    expect_symmetric<Hypersphere, Hypercapsule>(random_pair, 3000);
    expect_symmetric<Hypersphere, Hypercapsule>(degenerate_pair, 3000);
}
TEST(SphereCapsuleContacts, DoNotJump) { expect_no_jump<Hypersphere, Hypercapsule>(20000); }
TEST(SphereCapsuleContacts, BoundEveryGap) {
    expect_bounds_every_gap<Hypersphere, Hypercapsule>(15);
}
TEST(SphereCapsuleContacts, AreNumbersForOddShapes) { expect_no_nan<Hypersphere, Hypercapsule>(); }
TEST(SphereCapsuleContacts, AreReportedUpToTheMargin) {
    expect_margin_kept<Hypersphere, Hypercapsule>(3000);
}

TEST(SphereCapsuleContactsSlow, AreExactOnManyPairs) {
    expect_exact<Hypersphere, Hypercapsule>(random_pair, 100000, "random");
    expect_exact<Hypersphere, Hypercapsule>(degenerate_pair, 100000, "degenerate");
}

TEST(SphereCapsuleContacts, PushACentreOnTheCoreAcrossIt) {
    for (double along : {-0.5, 0.0, 0.3, 0.5}) {
        const auto list = contacts_of(Placed<Hypersphere>{{0.5}, {1, 2 + along, 3, 4}},
                                      Placed<Hypercapsule>{{0.25, 1}, {1, 2, 3, 4}});
        ASSERT_EQ(list.size(), 1u);
        EXPECT_EQ(list[0].normal, Vec4(-1, 0, 0, 0));
        EXPECT_EQ(list[0].separation, -0.75);
    }
}

}  // namespace
}  // namespace tesserae
