// SPDX-License-Identifier: Apache-2.0
#include "core/contact/manifold.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>
#include <tuple>

#include "core/algebra/rotor.hpp"
#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

using Points = std::vector<ContactPoint>;

Points reduced(Points points, const Vec4& normal) {
    points.resize(reduce_manifold(points, normal));
    return points;
}

/// Points of an ellipsoid in the hyperplane across a normal: no four of them in a plane.
Points points_of_ellipsoid(RandomGeometry& random, std::size_t count, const Mat4& frame) {
    const Vec4 half{0, random.log_uniform(0.2, 1), random.log_uniform(0.2, 1), 1};
    Points points;
    for (std::uint32_t i = 0; i < count; ++i) {
        Vec4 p = random.direction();
        p[0] = 0;
        p = p.normalized().cwiseProduct(half);
        points.push_back({frame * p, random.uniform(-0.1, 0.1), i});
    }
    return points;
}

/// Of the hull of points in general position across the frame's first axis: the sum over the
/// triangles that have all points on one side, each with an inner point.
double hull_volume(const Points& points, const Mat4& frame) {
    std::vector<Eigen::Vector3d> p;
    Eigen::Vector3d inner = Eigen::Vector3d::Zero();
    for (const ContactPoint& c : points) {
        p.push_back((frame.transpose() * c.point).tail<3>());
        inner += p.back() / static_cast<double>(points.size());
    }
    double volume = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = i + 1; j < p.size(); ++j)
            for (std::size_t k = j + 1; k < p.size(); ++k) {
                const auto det = [&](const Eigen::Vector3d& x) {
                    Eigen::Matrix3d m;
                    m << p[j] - p[i], p[k] - p[i], x - p[i];
                    return m.determinant();
                };
                int above = 0, below = 0;
                for (std::size_t l = 0; l < p.size(); ++l) {
                    if (l == i || l == j || l == k) continue;
                    ++(det(p[l]) > 0 ? above : below);
                }
                if (above == 0 || below == 0) volume += std::abs(det(inner)) / 6;
            }
    return volume;
}

TEST(Manifold, KeepsAllUpToEight) {
    RandomGeometry random(1);
    for (std::size_t count = 0; count <= 8; ++count) {
        Points points = points_of_ellipsoid(random, count, Mat4::Identity());
        std::reverse(points.begin(), points.end());
        const Points kept = reduced(points, Vec4::UnitX());
        ASSERT_EQ(kept.size(), count);
        for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(kept[i].feature, i);
    }
}

TEST(Manifold, KeepsTheDeepestAndDoesNotDependOnOrder) {
    RandomGeometry random(2);
    for (int i = 0; i < 2000; ++i) {
        const Mat4 frame = to_matrix(exp(Bivector{random.uniform(-3, 3), 0, random.uniform(-3, 3),
                                                  random.uniform(-3, 3), 0, 1}));
        Points points = points_of_ellipsoid(random, 9 + static_cast<std::size_t>(i) % 56, frame);
        if (i % 3 == 0)
            for (ContactPoint& p : points) p.separation = -0.5;  // ties
        const Points kept = reduced(points, frame.col(0));
        ASSERT_EQ(kept.size(), kManifoldPoints);
        const auto deepest =
            std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
                return std::tie(a.separation, a.feature) < std::tie(b.separation, b.feature);
            });
        bool found = false;
        for (const ContactPoint& p : kept) found |= p.feature == deepest->feature;
        ASSERT_TRUE(found) << i;

        std::shuffle(points.begin(), points.end(), random.engine);
        const Points again = reduced(points, frame.col(0));
        for (std::size_t k = 0; k < kManifoldPoints; ++k) {
            ASSERT_EQ(again[k].feature, kept[k].feature) << i;
            ASSERT_EQ(again[k].point, kept[k].point) << i;
            ASSERT_TRUE(k == 0 || kept[k - 1].feature < kept[k].feature);
        }
    }
}

// The yardstick is chance: the mean of 100 choices of eight points.
TEST(Manifold, KeepsMoreVolumeThanChance) {
    RandomGeometry random(3);
    double kept_share = 0, chance_share = 0, least = 1;
    constexpr int kCases = 200;
    for (int i = 0; i < kCases; ++i) {
        const Mat4 frame = to_matrix(exp(Bivector{random.uniform(-3, 3), 1, 0, 0, 0, 1}));
        Points points = points_of_ellipsoid(random, 20, frame);
        const double all = hull_volume(points, frame);
        const double kept = hull_volume(reduced(points, frame.col(0)), frame) / all;
        double chance = 0;
        for (int choice = 0; choice < 100; ++choice) {
            std::shuffle(points.begin(), points.end(), random.engine);
            chance += hull_volume({points.begin(), points.begin() + 8}, frame) / all / 100;
        }
        kept_share += kept / kCases;
        chance_share += chance / kCases;
        least = std::min(least, kept);
    }
    printf("[ volume   ] kept %.3f, least %.3f; by chance %.3f\n", kept_share, least, chance_share);
    EXPECT_GT(kept_share, chance_share);
}

// Two layers of the same corners, seen along the normal: one of each pair, the deeper, is enough.
TEST(Manifold, TakesTheDeeperOfTwoPointsAboveEachOther) {
    Points points;
    for (std::uint32_t i = 0; i < 16; ++i) {
        const Vec4 corner((i & 8) != 0 ? 1 : -1, (i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1,
                          (i & 4) != 0 ? 1 : -1);
        points.push_back({corner, (i & 8) != 0 ? 2 : 0.0, i});
    }
    const Points kept = reduced(points, Vec4::UnitX());
    for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(kept[i].feature, i);
}

// A long prism's corners, in pairs nearer to each other than to the next: the side that is lower by
// a hair must not get all of the points, nor the one that is far lower few.
TEST(Manifold, SpreadsOverWhatLeansByAHair) {
    for (const double lean : {0.0, 1e-12, 1e-6, -1e-6, 1e-4}) {
        Points points;
        for (std::uint32_t i = 0; i < 16; ++i) {
            const double angle = 0.25 * std::numbers::pi * (i / 2),
                         side = i % 2 == 0 ? 0.25 : -0.25;
            points.push_back(
                {Vec4(0, side, 2 * std::cos(angle), 2 * std::sin(angle)), lean * side, i});
        }
        int low = 0;
        for (const ContactPoint& p : reduced(points, Vec4::UnitX())) low += p.point[1] > 0 ? 1 : 0;
        EXPECT_GE(low, 3) << lean;
        EXPECT_LE(low, 5) << lean;
    }
}

// The 16 corners of a box that has sunk in to half its height.
TEST(Manifold, TakesWhatIsDeepWhereABodyHasSunkIn) {
    for (const double lean : {0.0, 1e-3, 0.02}) {
        Points points;
        for (std::uint32_t i = 0; i < 16; ++i) {
            const Vec4 corner(0, (i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1,
                              (i & 4) != 0 ? 1 : -1);
            const double top = (i & 8) != 0 ? 1.0 : 0.0;
            points.push_back({(1 + 0.1 * top) * corner, 0.5 * (top - 1) + lean * corner[1], i});
        }
        const Points kept = reduced(points, Vec4::UnitX());
        for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(kept[i].feature, i) << lean;
    }
}

TEST(Manifold, ManagesPointsOnALineAndInOnePlace) {
    for (double step : {0.0, 1e-320, 1e-9, 1.0, 1e300}) {
        Points points;
        for (std::uint32_t i = 0; i < 20; ++i)
            points.push_back({Vec4(0, i * step / 20, 0, 0), 0.0, i});
        const Points kept = reduced(points, Vec4::UnitX());
        ASSERT_EQ(kept.size(), kManifoldPoints);
        EXPECT_EQ(kept[0].feature, 0u);  // the deepest, by feature
        for (std::size_t k = 1; k < kept.size(); ++k)
            EXPECT_LT(kept[k - 1].feature, kept[k].feature);
    }
}

}  // namespace
}  // namespace tesserae
