// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/coordinates.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>

#include "core/dynamics/constraints/joint.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

Bivector random_plane(std::mt19937_64& random, double size) {
    const Vec4 a = random_vector(random, size), b = random_vector(random, size);
    return {a[0], a[1], a[2], a[3], b[0], b[1]};
}

JointedBody random_body(std::mt19937_64& random) {
    return {random_vector(random, 2), exp(random_plane(random, 1.5)), random_vector(random, 3),
            random_plane(random, 3)};
}

std::vector<JointKind> random_kinds(std::mt19937_64& random) {
    const Vec4 a = random_vector(random, 1), b = random_vector(random, 1);
    return {PointJoint{a, b}, LineJoint{a, b, 0.7},
            FrameJoint{a, b, exp(random_plane(random, 1)), exp(random_plane(random, 1))}};
}

/// The derivative of a coordinate along both bodies' free motion, by differences, is the velocity
/// of its row. This holds at any angles, not only at small ones.
TEST(Coordinates, ChangeByTheVelocitiesOfTheirRows) {
    std::mt19937_64 random(1);
    constexpr double kTime = 1e-5;
    for (int i = 0; i < 2000; ++i) {
        const JointedBody b = random_body(random);
        const JointedBody a = i % 4 == 0 ? JointedBody{} : random_body(random);
        for (JointKind kind : random_kinds(random)) {
            // A point's rows are exact where the points meet.
            if (auto* const point = std::get_if<PointJoint>(&kind))
                point->on_b = point_in(b, a.position + rotate(a.rotor, point->on_a));
            const Coordinates all =
                std::visit([&](const auto& of) { return coordinates_of(of, a, b); }, kind);
            const auto after = [&](double time) {
                return std::visit(
                    [&](const auto& of) {
                        return values_of(of, moved_on(a, time), moved_on(b, time), all.turn);
                    },
                    kind);
            };
            Constraint constraint;
            constraint.size = all.size;
            constraint.rows = all.rows;
            constraint.r_a = all.anchor - a.position;
            constraint.r_b = all.anchor - b.position;
            const RowVector rates = row_velocities(constraint, {a.velocity, a.angular_velocity},
                                                   {b.velocity, b.angular_velocity});
            EXPECT_LT((after(0) - all.values).norm(), 1e-12);
            const RowVector slope = (after(kTime) - after(-kTime)) / (2 * kTime);
            // Angles near whole turns change fast for little motion.
            const double scale = 1 + rates.norm();
            EXPECT_LT((slope - rates).norm(), 1e-5 * scale * scale) << i << " " << kind.index();
        }
    }
}

/// What a joint holds takes so many of the ten ways in which two bodies can move.
TEST(Coordinates, HoldAsManyFreedomsAsThereAreRows) {
    struct Case {
        std::uint16_t held;
        int rank;
    };
    std::mt19937_64 random(2);
    for (const auto& [held, rank] : {Case{kAllHeld, 10},
                                     {0x3fe, 9},
                                     {0x3ef, 9},
                                     {0x07f, 7},
                                     {0x00f, 4},
                                     {0x3f0, 6},
                                     {0x155, 5}})
        for (int i = 0; i < 50; ++i) {
            const JointedBody a = random_body(random), b = random_body(random);
            const auto kind = std::get<FrameJoint>(random_kinds(random)[2]);
            const Coordinates all = coordinates_of(kind, a, b);
            Eigen::MatrixXd rows(0, 10);
            for (int k = 0; k < 10; ++k) {
                if ((held >> k & 1) == 0) continue;
                const Wrench& row = all.rows[static_cast<std::size_t>(k)];
                const Bivector moment =
                    wedge(Vec4(all.anchor - b.position), row.impulse) + row.moment;
                rows.conservativeResize(rows.rows() + 1, 10);
                rows.row(rows.rows() - 1) << row.impulse.transpose(), moment.xy, moment.xz,
                    moment.xw, moment.yz, moment.yw, moment.zw;
            }
            Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows);
            svd.setThreshold(1e-6);
            EXPECT_EQ(svd.rank(), rank) << held;
        }
}

}  // namespace
}  // namespace tesserae
