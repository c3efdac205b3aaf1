// SPDX-License-Identifier: Apache-2.0
#include "core/convex/placed_balls.hpp"

#include "tests/core/convex/round_oracle.hpp"

namespace tesserae {
namespace {

/// Of the gap along the normal that is returned: it is taken anew from that.
constexpr double kGapAccuracy = 2e-15;

constexpr int kPolytope = 3;

/// The worst errors of a set of pairs, relative to size and distance.
struct RoundErrors {
    double gap = 0;       ///< against the gap along the normal
    double points = 0;    ///< of on_b - on_a against distance * normal
    double surfaces = 0;  ///< of either point from its body's surface, along the normal
    double excess = 0;    ///< of an overlap over the least one near its normal
    double known = 0;     ///< of a distance that is known
    double turned = 0;    ///< of a normal that is known
    int pairs = 0, other = 0;

    static void note(double& worst, long double error) {
        worst = std::max(worst, static_cast<double>(std::abs(error)));
    }
    void note_all(const RoundPair& pair, const ConvexSeparation& s, double scale) {
        ++pairs;
        ASSERT_TRUE(s.normal.allFinite() && std::isfinite(s.distance));
        ASSERT_TRUE(s.on_a.allFinite() && s.on_b.allFinite());
        ASSERT_NEAR(s.normal.norm(), 1, 1e-15);
        const LVec n = s.normal.cast<long double>();
        note(gap, (s.distance + RoundOverlap(pair.a, pair.b).along(n)) / scale);
        note(points, (s.on_b - s.on_a - s.distance * s.normal).norm() / scale);
        note(surfaces, reach_along(pair.a, n, s.on_a) / scale);
        note(surfaces, reach_along(pair.b, -n, s.on_b) / scale);
    }
    void expect_within() const {
        printf(
            "[ errors   ] %d pairs, %d with less overlap elsewhere: gap %.2g, points %.2g, "
            "surfaces %.2g, excess %.2g, known %.2g, turned %.2g\n",
            pairs, other, gap, points, surfaces, excess, known, turned);
        EXPECT_LT(gap, kGapAccuracy);
        EXPECT_LT(points, kGapAccuracy);
        EXPECT_LT(surfaces, kPlacedBallsPointAccuracy);
        EXPECT_LT(excess, kPlacedBallsAccuracy);
        EXPECT_LT(known, kPlacedBallsAccuracy);
    }
};

double scale_of(const RoundPair& pair) {
    return reach_of(pair.a) + reach_of(pair.b) + (pair.b.centre - pair.a.centre).norm();
}

/// Calls visit(pair) for pairs of all kinds but two polytopes.
template <class Visit>
void for_each_pair(int count, double depth, double spread, bool aligned, Visit&& visit) {
    RandomGeometry random(31);
    for (int i = 0; i < count; ++i) {
        const int kind_a = i % 5, kind_b = i / 5 % 5;
        if (kind_a >= kPolytope && kind_b >= kPolytope) continue;
        SCOPED_TRACE(::testing::Message() << "pair " << i << " depth " << depth << " spread "
                                          << spread << " aligned " << aligned);
        visit(random_round_pair(random, kind_a, kind_b, depth, spread, aligned));
        if (::testing::Test::HasFatalFailure()) return;
    }
}

TEST(PlacedBallProducts, HaveKnownDistances) {
    for (const bool aligned : {false, true})
        for (const double spread : {0.3, 3.0}) {
            RoundErrors errors;
            for (const double distance : {1e-3, 0.05, 1.0, 50.0})
                for_each_pair(250, -distance, spread, aligned, [&](const RoundPair& pair) {
                    const ConvexSeparation s = separation_of(pair.a, pair.b);
                    errors.note_all(pair, s, scale_of(pair));
                    const double truth = distance * (reach_of(pair.a) + reach_of(pair.b));
                    RoundErrors::note(errors.known, (s.distance - truth) / scale_of(pair));
                    RoundErrors::note(errors.turned,
                                      distance / (1 + distance) * (s.normal - pair.normal).norm());
                });
            errors.expect_within();
            EXPECT_LT(errors.turned, kPlacedBallsNormalAccuracy);
        }
}

TEST(PlacedBallProducts, OverlapLeastNearTheirNormal) {
    // How far around the normal no direction may have less.
    constexpr long double kNear = 0.05L;
    for (const bool aligned : {false, true})
        for (const double spread : {0.3, 3.0}) {
            RoundErrors errors;
            for (const double depth : {1e-9, 1e-6, 1e-4, 2e-3, 2e-2})
                for_each_pair(100, depth, spread, aligned, [&](const RoundPair& pair) {
                    const ConvexSeparation s = separation_of(pair.a, pair.b);
                    const double size = reach_of(pair.a) + reach_of(pair.b);
                    errors.note_all(pair, s, size);
                    const RoundOverlap truth(pair.a, pair.b);
                    const LVec n = s.normal.cast<long double>();
                    if (s.distance >= 0) return;
                    RoundErrors::note(errors.excess,
                                      (-s.distance - truth.least_near(n, kNear)) / size);
                    if (-s.distance < (depth - kPlacedBallsAccuracy) * size) ++errors.other;
                });
            errors.expect_within();
        }
}

TEST(PlacedBallProducts, OverlapAsKnown) {
    for (const bool aligned : {false, true})
        for (const double spread : {0.3, 3.0}) {
            int pairs = 0, known = 0;
            for (const double depth : {1e-9, 1e-6, 1e-4, 2e-3})
                for_each_pair(1000, depth, spread, aligned, [&](const RoundPair& pair) {
                    const double size = reach_of(pair.a) + reach_of(pair.b);
                    ++pairs;
                    if (-separation_of(pair.a, pair.b).distance <=
                        (depth + kPlacedBallsAccuracy) * size)
                        ++known;
                });
            // Of the others it is another local least overlap.
            EXPECT_GE(known, 0.99 * pairs) << "spread " << spread << " aligned " << aligned;
        }
}

TEST(PlacedBallProducts, OverlapNoMoreThanByTheGeneralMethodWhereDeep) {
    RoundErrors errors;
    for_each_pair(150, 0.2, 0.3, false, [&](const RoundPair& pair) {
        const double size = reach_of(pair.a) + reach_of(pair.b);
        const ConvexSeparation s = separation_of(pair.a, pair.b);
        const ConvexSeparation general =
            separation_of([&](const Vec4& n) { return support(pair.a, n); },
                          [&](const Vec4& n) { return support(pair.b, n); },
                          Vec4(pair.b.centre - pair.a.centre), size);
        EXPECT_GE(s.distance, general.distance - kRoundOverlapAccuracy * size);
        errors.note_all(pair, s, size);
    });
    errors.expect_within();
}

constexpr std::array<std::uint8_t, 4> kSpherinderGroups = kProducts[0],
                                      kCubinderGroups = kProducts[1],
                                      kDuocylinderGroups = kProducts[2], kBoxGroups = kProducts[3],
                                      kBallGroups = kProducts[4];

PlacedBalls product_at(const std::array<std::uint8_t, 4>& group, const Vec4& radius,
                       const Vec4& centre) {
    return {group, radius, Mat4::Identity(), centre};
}

TEST(PlacedBallProducts, HaveClosedForms) {
    const auto expect = [](const PlacedBalls& a, const PlacedBalls& b, double distance,
                           const Vec4& normal) {
        const ConvexSeparation s = separation_of(a, b), swapped = separation_of(b, a);
        EXPECT_NEAR(s.distance, distance, kPlacedBallsAccuracy);
        EXPECT_NEAR(swapped.distance, distance, kPlacedBallsAccuracy);
        EXPECT_LT((s.normal - normal).norm(), 1e-12) << s.normal.transpose();
        EXPECT_LT((swapped.normal + normal).norm(), 1e-12) << swapped.normal.transpose();
        EXPECT_LT((s.on_b - s.on_a - s.distance * s.normal).norm(), 1e-15);
    };
    const Vec4 one = Vec4::Ones(), x = Vec4::UnitX(), y = Vec4::UnitY(), w = Vec4::UnitW();
    for (const double depth : {1e-9, 1e-6, 1e-3, 0.02}) {
        const double d = 2 - depth;
        // Flat on each other, in the middle and aside.
        for (const Vec4& aside : {Vec4(0, 0, 0, 0), Vec4(0.3, 0.4, 0, 0), Vec4(0, 0, 1.2, 0)}) {
            expect(product_at(kSpherinderGroups, one, Vec4::Zero()),
                   product_at(kSpherinderGroups, one, aside + d * w), -depth, w);
            expect(product_at(kCubinderGroups, one, Vec4::Zero()),
                   product_at(kSpherinderGroups, one, aside + d * w), -depth, w);
            expect(product_at(kBoxGroups, one, Vec4::Zero()),
                   product_at(kCubinderGroups, one, aside + d * w), -depth, w);
        }
        // Side by side with parallel axes, level and shifted along them.
        for (const Vec4& aside : {Vec4(0, 0, 0, 0), Vec4(0, 0, 0, 0.7)}) {
            expect(product_at(kSpherinderGroups, one, Vec4::Zero()),
                   product_at(kSpherinderGroups, one, aside + d * x), -depth, x);
            expect(product_at(kCubinderGroups, one, Vec4::Zero()),
                   product_at(kCubinderGroups, one, aside + d * y), -depth, y);
            expect(product_at(kDuocylinderGroups, one, Vec4::Zero()),
                   product_at(kDuocylinderGroups, one, aside + d * x), -depth, x);
        }
        // A side on a face, and balls on everything.
        expect(product_at(kBoxGroups, one, Vec4::Zero()),
               product_at(kDuocylinderGroups, one, d * x), -depth, x);
        expect(product_at(kBallGroups, one, Vec4::Zero()),
               product_at(kSpherinderGroups, one, d * w), -depth, w);
        expect(product_at(kBallGroups, one, Vec4::Zero()), product_at(kBallGroups, one, d * y),
               -depth, y);
        // A spherinder's rim on a box, the normal a diagonal of both.
        PlacedBalls tilted = product_at(kSpherinderGroups, one, Vec4::Zero());
        const double r = std::sqrt(0.5);
        tilted.turn.col(0) = r * (x + w), tilted.turn.col(3) = r * (w - x);
        expect(product_at(kBoxGroups, {9, 9, 9, 1}, Vec4::Zero()),
               {tilted.group, tilted.radius, tilted.turn, (1 + 2 * r - depth) * w}, -depth, w);
    }
}

TEST(PlacedBallProducts, TakeAnySizesAndPlaces) {
    const auto expect_finite = [](const PlacedBalls& a, const PlacedBalls& b) {
        const ConvexSeparation s = separation_of(a, b);
        EXPECT_TRUE(s.normal.allFinite() && std::isfinite(s.distance));
        EXPECT_TRUE(s.on_a.allFinite() && s.on_b.allFinite());
        EXPECT_NEAR(s.normal.norm(), 1, 1e-15);
        return s.distance;
    };
    for (const auto& group_a : kProducts)
        for (const auto& group_b : kProducts)
            for (const double scale : {1e-100, 1e-9, 1.0, 1e9, 1e100}) {
                const PlacedBalls a = product_at(group_a, scale * Vec4::Ones(), Vec4::Zero());
                PlacedBalls b = product_at(group_b, scale * Vec4::Ones(), Vec4::Zero());
                EXPECT_LT(expect_finite(a, b), -1.9 * scale);
                b.centre = Vec4(0, 0, 0, 2 * scale);
                EXPECT_NEAR(expect_finite(a, b) / scale, 0, 4 * kPlacedBallsAccuracy);
                b.centre = Vec4(0, 1e30 * scale, 0, 0);
                EXPECT_NEAR(expect_finite(a, b) / (1e30 * scale), 1, kPlacedBallsAccuracy);
                // A point inside, on the surface, and without.
                b.radius.setZero();
                for (const double place : {0.0, 1.0, 3.0}) {
                    b.centre = Vec4(0, place * scale, 0, 0);
                    EXPECT_NEAR(expect_finite(a, b) / scale, place - 1, 4 * kPlacedBallsAccuracy);
                }
            }
    const PlacedBalls point = product_at(kBoxGroups, Vec4::Zero(), Vec4::Ones());
    EXPECT_EQ(expect_finite(point, point), 0);
    // Segments: crossing, apart, along one line.
    const PlacedBalls along_x = product_at(kBoxGroups, Vec4::UnitX(), Vec4::Zero()),
                      along_y = product_at(kBoxGroups, Vec4::UnitY(), Vec4::Zero());
    EXPECT_NEAR(expect_finite(along_x, along_y), 0, kPlacedBallsAccuracy);
    EXPECT_NEAR(expect_finite(along_x, product_at(kBoxGroups, Vec4::UnitY(), 2 * Vec4::UnitW())), 2,
                1e-13);
    EXPECT_NEAR(expect_finite(along_x, product_at(kBoxGroups, Vec4::UnitX(), 3 * Vec4::UnitX())), 1,
                1e-13);
}

TEST(PlacedBallProducts, HaveTheSameSeparationInAnyUnits) {
    for_each_pair(100, 1e-3, 1, false, [&](const RoundPair& pair) {
        const double unit = separation_of(pair.a, pair.b).distance;
        for (const double scale : {1e-9, 1e9}) {
            RoundPair scaled = pair;
            for (PlacedBalls* body : {&scaled.a, &scaled.b})
                body->radius *= scale, body->centre *= scale;
            EXPECT_NEAR(separation_of(scaled.a, scaled.b).distance / scale, unit,
                        2 * kPlacedBallsAccuracy);
        }
    });
}

}  // namespace
}  // namespace tesserae
