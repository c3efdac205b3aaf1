// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hypercapsule_hypercapsule.hpp"

#include "tests/core/contact/pair_sets.hpp"

namespace tesserae {
namespace {

/// Capsules side by side: see kSideBySide.
constexpr double kAslant = 0.5 * kSideBySide * kSideBySide;

TEST(CapsuleCapsuleContacts, AreExactOnRandomPairs) {
    expect_exact<Hypercapsule, Hypercapsule>(random_pair, 3000, "random", kAslant);
}
TEST(CapsuleCapsuleContacts, AreExactOnDegeneratePairs) {
    expect_exact<Hypercapsule, Hypercapsule>(degenerate_pair, 3000, "degenerate", kAslant);
}
TEST(CapsuleCapsuleContacts, AreTheSameAfterMappingAndSwapping) {
    expect_symmetric<Hypercapsule, Hypercapsule>(random_pair, 3000);
    expect_symmetric<Hypercapsule, Hypercapsule>(degenerate_pair, 3000);
}
TEST(CapsuleCapsuleContacts, DoNotJump) { expect_no_jump<Hypercapsule, Hypercapsule>(20000); }
TEST(CapsuleCapsuleContacts, BoundEveryGap) {
    expect_bounds_every_gap<Hypercapsule, Hypercapsule>(15);
}
TEST(CapsuleCapsuleContacts, AreNumbersForOddShapes) {
    expect_no_nan<Hypercapsule, Hypercapsule>();
}
TEST(CapsuleCapsuleContacts, AreReportedUpToTheMargin) {
    expect_margin_kept<Hypercapsule, Hypercapsule>(3000);
}

TEST(CapsuleCapsuleContactsSlow, AreExactOnManyPairs) {
    expect_exact<Hypercapsule, Hypercapsule>(random_pair, 100000, "random", kAslant);
    expect_exact<Hypercapsule, Hypercapsule>(degenerate_pair, 100000, "degenerate", kAslant);
}

TEST(CapsuleCapsuleContacts, AreTwoAtTheEndsOfASharedStretch) {
    // Cores y in [-1, 1] and, 0.5 above, y in [0, 4]: they share [0, 1].
    for (double turned : {0.0, M_PI}) {
        const Placed<Hypercapsule> a{{0.25, 2}};
        const Placed<Hypercapsule> b{{0.5, 4}, {0, 2, 0, 0.5}, exp(Bivector{turned / 2})};
        const auto list = contacts_of(a, b);
        ASSERT_EQ(list.size(), 2u);
        for (std::uint32_t end : {0u, 1u}) {
            EXPECT_EQ(list[end].feature, end);
            EXPECT_NEAR(list[end].separation, -0.25, 1e-15);
            EXPECT_LT((list[end].normal - Vec4::UnitW()).norm(), 1e-15);
            EXPECT_LT((list[end].point - Vec4(0, end, 0, 0.125)).norm(), 1e-15);
        }
    }
}
TEST(CapsuleCapsuleContacts, AreOneEndToEndAndCrossing) {
    const Placed<Hypercapsule> a{{0.25, 2}};
    const auto end_to_end = contacts_of(a, Placed<Hypercapsule>{{0.25, 2}, {0, 2.25, 0, 0}});
    ASSERT_EQ(end_to_end.size(), 1u);
    EXPECT_EQ(end_to_end[0].separation, -0.25);
    EXPECT_EQ(end_to_end[0].normal, Vec4::UnitY().eval());
    const auto crossing = contacts_of(
        a, Placed<Hypercapsule>{{0.25, 2}, Vec4::Zero(), exp(Bivector{0, 0, 0, 0.3, 0, 0})});
    ASSERT_EQ(crossing.size(), 1u);
    EXPECT_NEAR(crossing[0].separation, -0.5, 1e-15);
    EXPECT_LT(std::abs(crossing[0].normal[1]) + std::abs(crossing[0].normal[2]), 1e-15);
}

}  // namespace
}  // namespace tesserae
