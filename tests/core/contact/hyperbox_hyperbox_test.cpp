// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hyperbox_hyperbox.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "tests/core/contact/box_oracle.hpp"

namespace tesserae {
namespace {

using namespace box_oracle;

/// Of the reach (both bounding radii together): what moving b by the separation may leave. It holds
/// kDistanceError too: sides of 4 units make a reach of 4 units and more.
constexpr double kTouch = 1e-9;

double bias_of(const Two& two) {
    return kCellBias * 0.5 * std::min(two.a.box.size.minCoeff(), two.b.box.size.minCoeff());
}

double surface_distance(const PlacedBox& p, const Vec4& point) {
    return std::abs(signed_distance(p.box, to_matrix(p.rotor).transpose() * (point - p.position)));
}

/// Checks every contact of the pair against what was asked for.
void expect_sound_contacts(const Two& two, const Answer& answer, double margin) {
    const std::vector<Contact> list = contacts_of(two, margin);
    ASSERT_FALSE(list.empty()) << "separation " << answer.value << " margin " << margin;
    ASSERT_LE(list.size(), 8u);
    // Poses far out round the points; the pair's slack (kBoxSlack) is of a unit, below two reaches.
    const double reach = two.reach();
    const double rounding = 4 * kBoxSlack * reach + 1e-15 * two.a.position.norm();
    double least = INFINITY;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Contact& c = list[i];
        ASSERT_TRUE(c.point.allFinite() && c.normal.allFinite() && std::isfinite(c.separation));
        EXPECT_NEAR(c.normal.norm(), 1, 1e-14);
        EXPECT_LE(c.separation, margin + rounding);
        least = std::min(least, c.separation);
        if (i > 0) {
            EXPECT_LT(list[i - 1].feature, c.feature);
        }
        // On b exactly; on a too, but where axes of boxes apart are only nearly parallel.
        const Vec4 half = 0.5 * c.separation * c.normal;
        const double tilt = answer.value > 0 ? bias_of(two) : 0;
        EXPECT_LT(surface_distance(two.a, c.point - half), rounding + tilt);
        EXPECT_LT(surface_distance(two.b, c.point + half), rounding + tilt);
    }
    const double near = bias_of(two) + rounding + kTouch * reach;
    EXPECT_LE(least, answer.value + near);
    const bool sunk = answer.value < -kBoxSunk / kCellBias * bias_of(two) + near;
    const double leaning = sunk ? kSunkLeaning : kLeaning;
    EXPECT_GE(least, std::min(answer.value, answer.value / leaning) - near);
}

void expect_sound(Random& random, const Two& two) {
    const double reach = two.reach();
    const Answer answer = answer_for(two);
    const double facets = static_cast<double>(largest_facet_gap(two));
    if (facets <= 0 && answer.value <= 0) {
        EXPECT_NEAR(answer.value, facets, kGapError * reach);
    } else {
        EXPECT_GE(answer.value, facets - kGapError * reach);
    }
    // Any direction's gap is a lower bound on the separation, the normal's reaches it. (And the
    // witness points, which moving b below brings together, are an upper bound.)
    const Wide normal = answer.normal.cast<Real>();
    EXPECT_NEAR(static_cast<double>(gap_along(two, normal)), answer.value, kTouch * reach);
    for (int i = 0; i < 10; ++i) {
        const Wide near = normal + std::pow(0.1L, i) * random.direction().cast<Real>();
        EXPECT_LE(gap_along(two, near.normalized()), answer.value + kGapError * reach);
    }
    Two moved = two;
    moved.b.position -= answer.value * answer.normal;
    EXPECT_NEAR(answer_for(moved).value, 0, kTouch * reach);
    EXPECT_NEAR(static_cast<double>(largest_facet_gap(moved)), 0, kTouch * reach);

    Two nudged = two;
    nudged.b.position += 1e-9 * reach * random.direction();
    EXPECT_LE(std::abs(answer_for(nudged).value - answer.value), (1e-9 + kTouch) * reach);

    // A margin that rounding can't deny, with nothing else or with much in it.
    const double margin = std::max(0.0, answer.value) + (1e-12 + random.below(2) * 0.1) * reach;
    expect_sound_contacts(two, answer, margin);
    if (answer.value > 1e-12 * reach) {
        EXPECT_TRUE(contacts_of(two, answer.value * (1 - 1e-12)).empty());
    }
}

void sweep_random(std::uint64_t seed, int count) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        SCOPED_TRACE(i);
        expect_sound(random, random_two(random, 1));
        if (::testing::Test::HasFailure()) return;
    }
}

void sweep_degenerate(std::uint64_t seed, int count) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        std::string kind;
        const Two two = degenerate_two(random, kind);
        SCOPED_TRACE(kind + " at " + std::to_string(i));
        expect_sound(random, two);
        if (::testing::Test::HasFailure()) return;
    }
}

TEST(HyperboxPair, IsSoundAtRandom) { sweep_random(1, 2000); }
TEST(HyperboxPair, IsSoundWhereNearlyDegenerate) { sweep_degenerate(2, 2000); }
TEST(HyperboxPairSlow, IsSoundAtRandom) { sweep_random(3, 100000); }
TEST(HyperboxPairSlow, IsSoundWhereNearlyDegenerate) { sweep_degenerate(4, 100000); }

TEST(HyperboxPair, HasNoDirectionOfLessOverlap) {
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        const Two two = random_two(random, 0.6);
        const double value = answer_for(two).value;
        for (int k = 0; k < 2000; ++k)
            ASSERT_LE(gap_along(two, random.direction().cast<Real>()), value + 1e-14) << i;
    }
}

TEST(HyperboxPair, HasTheDistanceThatAllFacesGive) {
    Random random(6);
    int apart = 0;
    for (int i = 0; apart < 300; ++i) {
        const Two two = random_two(random, 1.2);
        const Answer answer = answer_for(two);
        if (answer.value <= 0) continue;
        ++apart;
        ASSERT_NEAR(answer.value, static_cast<double>(distance_over_faces(two)), 1e-13) << i;
    }
}

/// Applies a map to both boxes.
template <class Map>
Two mapped(const Two& two, const Map& map) {
    return {map(two.a), map(two.b)};
}

/// Ascending.
std::vector<double> separations_of(const std::vector<Contact>& list) {
    std::vector<double> all;
    for (const Contact& c : list) all.push_back(c.separation);
    std::sort(all.begin(), all.end());
    return all;
}

// Reduction to eight points breaks ties by feature, so manifolds are compared by the deepest point.
void expect_same_pair(const Two& two, const Two& other, const Mat4& turn, int i) {
    const double reach = two.reach(), margin = 0.2 * reach;
    const Answer one = answer_for(two), same = answer_for(other);
    ASSERT_NEAR(one.value, same.value, 1e-13 * reach) << i;
    const std::vector<Contact> first = contacts_of(two, margin),
                               second = contacts_of(other, margin);
    ASSERT_EQ(first.size(), second.size()) << i;
    if (first.empty()) return;
    ASSERT_LT((turn * first[0].normal - second[0].normal).norm(), 1e-10) << i;
    ASSERT_NEAR(separations_of(first)[0], separations_of(second)[0], 1e-12 * reach) << i;
}

TEST(HyperboxPair, IsTheSameAfterARigidMotion) {
    Random random(7);
    for (int i = 0; i < 3000; ++i) {
        const Two two = random_two(random, 0.9);
        const Rotor turn = random.rotor();
        const Vec4 shift = random.direction();
        const Two other = mapped(two, [&](const PlacedBox& p) {
            return PlacedBox{p.box, shift + rotate(turn, p.position), turn * p.rotor};
        });
        expect_same_pair(two, other, to_matrix(turn), i);
        const auto first = contacts_of(two, 0.1), second = contacts_of(other, 0.1);
        for (std::size_t k = 0; k < first.size(); ++k) {
            EXPECT_EQ(first[k].feature, second[k].feature) << i;
            const Vec4 point = shift + rotate(turn, first[k].point);
            EXPECT_LT((point - second[k].point).norm(), 1e-11) << i;
        }
    }
}

// Mirrors and odd permutations are not rotations: axes are renamed in the world and in the bodies.
TEST(HyperboxPair, IsTheSameInAMirrorAndWithAxesPermuted) {
    Random random(8);
    for (int i = 0; i < 3000; ++i) {
        const Two two = random_two(random, 0.9);
        Mat4 map = Mat4::Zero();
        int order[4] = {0, 1, 2, 3};
        std::shuffle(order, order + 4, random.engine);
        for (int k = 0; k < 4; ++k) map(order[k], k) = random.below(2) == 0 ? 1 : -1;
        const Two other = mapped(two, [&](const PlacedBox& p) {
            return PlacedBox{Hyperbox{map.cwiseAbs() * p.box.size}, map * p.position,
                             to_rotor(map * to_matrix(p.rotor) * map.transpose())};
        });
        expect_same_pair(two, other, map, i);
    }
}

TEST(HyperboxPair, IsTheSameSwappedButForTheSideOfTheNormal) {
    Random random(9);
    for (int i = 0; i < 3000; ++i) {
        const Two two = random_two(random, 0.9);
        const Two other{two.b, two.a};
        ASSERT_NEAR(answer_for(two).value, answer_for(other).value, 1e-14);
        const auto first = contacts_of(two, 0.1), second = contacts_of(other, 0.1);
        ASSERT_EQ(first.empty(), second.empty());
        if (first.empty()) continue;
        // Which cell is the reference may differ where two are within the bias.
        ASSERT_NEAR(separations_of(first)[0], separations_of(second)[0], 2 * bias_of(two)) << i;
        if (first[0].normal.dot(second[0].normal) > -0.99999) continue;
        EXPECT_LT((first[0].normal + second[0].normal).norm(), 1e-2) << i;
    }
}

/// The least overlap of two 3D boxes by the textbook's 15 axes, minus; a lower bound if apart.
double overlap_3d(const Two& two) {
    using Axis = Eigen::Vector3d;
    std::vector<Axis> axes;
    const Mat4 a = to_matrix(two.a.rotor), b = to_matrix(two.b.rotor);
    for (int i = 0; i < 3; ++i) {
        axes.push_back(a.col(i).head<3>());
        axes.push_back(b.col(i).head<3>());
        for (int j = 0; j < 3; ++j) axes.push_back(a.col(i).head<3>().cross(b.col(j).head<3>()));
    }
    const Axis between = (two.b.position - two.a.position).head<3>();
    double best = -INFINITY;
    for (const Axis& axis : axes) {
        const Axis n = axis.normalized();
        double gap = std::abs(n.dot(between));
        for (int k = 0; k < 3; ++k)
            gap -= 0.5 * (two.a.box.size[k] * std::abs(n.dot(a.col(k).head<3>())) +
                          two.b.box.size[k] * std::abs(n.dot(b.col(k).head<3>())));
        best = std::max(best, gap);
    }
    return best;
}

// Boxes that are long along w and turned in xyz only are 3D boxes: no normal leaves xyz, and their
// points reach both ends in w, so that nothing turns them out of xyz.
TEST(HyperboxPair, IsThatOf3DBoxesInSlabsAlongW) {
    Random random(10);
    int touching = 0;
    for (int i = 0; i < 3000; ++i) {
        Two two = random_two(random, 0.7);
        for (PlacedBox* p : {&two.a, &two.b}) {
            p->box.size[3] = 8;
            p->position[3] = 0;
            p->rotor = exp({random.normal(), random.normal(), 0, random.normal(), 0, 0});
        }
        const double value = answer_for(two).value, flat = overlap_3d(two);
        if (flat <= 0) {
            ASSERT_NEAR(value, flat, 1e-14) << i;
        } else {
            ASSERT_GE(value, flat - 1e-14) << i;
        }
        const auto list = contacts_of(two, 0.05);
        double lowest = 0, highest = 0;
        for (const Contact& c : list) {
            EXPECT_NEAR(c.normal[3], 0, 1e-14) << i;
            lowest = std::min(lowest, c.point[3]);
            highest = std::max(highest, c.point[3]);
        }
        if (list.empty()) continue;
        ++touching;
        EXPECT_EQ(list.size() % 2, 0u) << i;
        EXPECT_NEAR(lowest, -4, 1e-11) << i;
        EXPECT_NEAR(highest, 4, 1e-11) << i;
    }
    EXPECT_GT(touching, 1000);
}

TEST(HyperboxPair, OfEqualBoxesStackedHasTheCornersOfACell) {
    for (int axis = 0; axis < 4; ++axis)
        for (const double gap : {-1e-3, -1e-9, 0.0, 1e-14, 1e-9, 1e-3}) {
            Two two;
            two.a.box.size = two.b.box.size = {1, 2, 0.5, 1.5};
            two.b.position[axis] = two.a.box.size[axis] + gap;
            const auto list = contacts_of(two, 2e-3);
            ASSERT_EQ(list.size(), 8u) << axis << " " << gap;
            for (const Contact& c : list) {
                EXPECT_NEAR(c.separation, gap, 1e-15);
                EXPECT_EQ(c.normal, Vec4::Unit(axis).eval());
                for (int k = 0; k < 4; ++k) {
                    const double at =
                        k == axis ? 0.5 * (two.a.box.size[k] + gap) : 0.5 * two.a.box.size[k];
                    EXPECT_NEAR(std::abs(c.point[k]), at, 1e-14);
                }
            }
        }
}

// A manifold whose points renamed themselves would lose its impulses in every step.
TEST(HyperboxPair, KeepsItsFeaturesUnderRounding) {
    Random random(11);
    for (int i = 0; i < 500; ++i) {
        Two two;
        two.a.box.size = two.b.box.size = random.sizes(-0.5, 0.5);
        two.a.rotor = two.b.rotor = random.rotor();
        const int axis = random.below(4);
        two.b.position = (two.a.box.size[axis] - 1e-4) * to_matrix(two.a.rotor).col(axis);
        const auto before = contacts_of(two, 1e-3);
        two.b.position += 1e-15 * random.direction();
        two.b.rotor = projected_to_spin4(two.b.rotor * exp(random.bivector(1e-16)));
        const auto after = contacts_of(two, 1e-3);
        ASSERT_EQ(before.size(), 8u);
        ASSERT_EQ(after.size(), 8u);
        for (int k = 0; k < 8; ++k) EXPECT_EQ(before[k].feature, after[k].feature) << i;
    }
}

TEST(HyperboxPair, HasNoNaNForCoincidentAndExtremeBoxes) {
    for (const double size : {1e-300, 1e-150, 1e-3, 1.0, 1e3, 1e150, 1e300})
        for (const double other : {1e-300, 1e-3, 1.0, 1e300})
            for (const double at : {0.0, 1e-300, 1.0, 1e4, 1e300}) {
                Two two;
                two.a.box.size = size * Vec4(1, 2, 1, 1);
                two.b.box.size = other * Vec4(1, 1, 3, 1);
                two.b.position = {at, 0, at, 0};
                for (const Contact& c : contacts_of(two, 1)) {
                    EXPECT_TRUE(c.point.allFinite() && c.normal.allFinite());
                    EXPECT_TRUE(std::isfinite(c.separation)) << size << " " << other << " " << at;
                }
            }
}

TEST(HyperboxPair, IsNoneWhereTheDistanceOverflows) {
    Two two;
    two.a.position[0] = 1e308;
    two.b.position[0] = -1e308;
    EXPECT_TRUE(contacts_of(two, 1e10).empty());
}

}  // namespace
}  // namespace tesserae
