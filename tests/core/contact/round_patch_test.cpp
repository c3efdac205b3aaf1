// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/contact/find_contacts.hpp"
#include "tests/core/contact/pair_sets.hpp"

// Round products that lie with an area on a flat cell: their points bear on all of it.
namespace tesserae {
namespace {

/// What a point of the piece that touches the floor y = 0 has in z and w, and whether it is there.
struct Lying {
    Shape shape;
    double radius;  ///< of what stands on the floor
    Vec2 half;      ///< in z and w
    bool is_disc;

    bool has(double z, double w) const {
        return is_disc ? std::hypot(z, w) <= half[0]
                       : std::abs(z) <= half[0] && std::abs(w) <= half[1];
    }
};

Lying random_lying(RandomGeometry& random) {
    const double radius = random.log_uniform(0.05, 1);
    if (random.uniform(0, 1) < 0.3) {
        const double disc = random.log_uniform(0.2, 2);
        return {duocylinder({radius, disc}), radius, Vec2::Constant(disc), true};
    }
    const Vec2 size{random.log_uniform(0.2, 2), random.log_uniform(0.2, 2)};
    return {cubinder(radius, size), radius, 0.5 * size, false};
}

/// A box under the floor's plane, turned in it, as such or as a hull.
struct Ground {
    Shape shape;
    Vec4 half, position = Vec4::Zero();
    Rotor turn;

    Ground(RandomGeometry& random, bool is_hull) {
        Hyperbox box;
        for (double& side : box.size) side = random.log_uniform(0.1, 3);
        half = 0.5 * box.size;
        position[1] = -half[1];
        const auto angle = [&] { return random.uniform(-3, 3); };
        turn = exp({0, angle(), angle(), 0, 0, angle()});
        shape = box;
        if (!is_hull) return;
        std::vector<Vec4> corners;
        for (int i = 0; i < 16; ++i)
            corners.push_back(half.cwiseProduct(
                Vec4(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1, i & 8 ? 1 : -1)));
        shape = hull_shape(corners);
    }
    bool is_under(const Vec4& p) const {
        Vec4 own = rotate(reverse(turn), p - position);
        own[1] = 0;
        return ((half - own.cwiseAbs()).array() >= 0).all();
    }
};

void expect_patch_bears_on_cells(int patches) {
    RandomGeometry random(1);
    int seen = 0;
    for (int i = 0; i < patches; ++i) {
        const Lying lying = random_lying(random);
        const Ground ground(random, i % 2 == 1);
        Vec4 at = random.in_box(0.7 * ground.half);
        at[1] = lying.radius - 1e-7;
        // Samples of where both are.
        std::vector<Vec2> samples;
        for (int n = 0; n < 400; ++n) {
            const Vec2 p{random.uniform(-1, 1) * lying.half[0],
                         random.uniform(-1, 1) * lying.half[1]};
            if (lying.has(p[0], p[1]) &&
                ground.is_under(Vec4(at[0], 0, at[2] + p[0], at[3] + p[1])))
                samples.push_back(p);
        }
        // Where a disc ends within the cell a few points of its rim stand for it.
        bool rim = false;
        for (int k = 0; lying.is_disc && k < 64; ++k) {
            const double angle = k * M_PI / 32, r = lying.half[0];
            rim |= ground.is_under(
                Vec4(at[0], 0, at[2] + r * std::cos(angle), at[3] + r * std::sin(angle)));
        }
        if (samples.size() < 20 || rim) continue;
        ++seen;

        const Rotor turn = random_rotor(random);
        const Vec4 shift = random.in_box(Vec4::Constant(3));
        const Pose pose{rotate(turn, at) + shift, turn};
        const Pose under{rotate(turn, ground.position) + shift, turn * ground.turn};
        std::vector<Contact> list;
        if (i % 4 < 2)
            find_contacts(0, lying.shape, pose, 1, ground.shape, under, 1e-4, list);
        else
            find_contacts(0, ground.shape, under, 1, lying.shape, pose, 1e-4, list);
        std::vector<Vec2> points;
        for (const Contact& c : list) {
            const Vec4 own = rotate(reverse(turn), c.point - pose.position);
            points.emplace_back(own[2], own[3]);
            EXPECT_TRUE(lying.has(own[2] * (1 - 1e-6), own[3] * (1 - 1e-6))) << i;
            EXPECT_NEAR(own[0], 0, 1e-6) << i;
        }
        // Of a disc's points, some of which are within it, those that are too many are not chosen.
        const double left_out = (lying.is_disc ? 0.2 : 1e-9) * lying.half.norm();
        for (int k = 0; k < 24; ++k) {
            const Vec2 d{std::cos(k * M_PI / 12), std::sin(k * M_PI / 12)};
            double of_samples = -std::numeric_limits<double>::infinity(), of_points = of_samples;
            for (const Vec2& p : samples) of_samples = std::max(of_samples, d.dot(p));
            for (const Vec2& p : points) of_points = std::max(of_points, d.dot(p));
            EXPECT_GE(of_points, of_samples - left_out) << i << ", direction " << k;
        }
    }
    EXPECT_GT(seen, patches / 3);
}

TEST(RoundPatch, BearsOnAllOfACellThatItCovers) { expect_patch_bears_on_cells(1000); }
TEST(RoundPatchSlow, BearsOnAllOfACellThatItCovers) { expect_patch_bears_on_cells(3000); }

}  // namespace
}  // namespace tesserae
