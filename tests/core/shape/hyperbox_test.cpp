// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

const Hyperbox kBox{{2, 4, 6, 8}};

TEST(Hyperbox, HasTheClosedFormsOfItsSides) {
    EXPECT_EQ(volume(kBox), 384);
    EXPECT_EQ(second_moments(kBox, 3), Vec4(1, 4, 9, 16));  // 3 s^2 / 12
    EXPECT_DOUBLE_EQ(bounding_radius(kBox), std::sqrt(30.0));
    EXPECT_EQ(half_extents(kBox, Mat4::Identity()), Vec4(1, 2, 3, 4));
    EXPECT_EQ(support(kBox, {1, -1, 0, -0.0}), Vec4(1, -2, 3, 4));
}

TEST(Hyperbox, MeasuresFromFacesEdgesAndVertices) {
    EXPECT_EQ(signed_distance(kBox, Vec4::Zero()), -1);
    EXPECT_EQ(signed_distance(kBox, {0, 0, 0, 3.75}), -0.25);
    EXPECT_EQ(signed_distance(kBox, {1, 2, 3, 4}), 0);
    EXPECT_EQ(signed_distance(kBox, {-2, 0, 0, 0}), 1);
    EXPECT_EQ(signed_distance(kBox, {4, -6, 0, 0}), 5);  // 3, 4
    EXPECT_EQ(signed_distance(kBox, {2, 3, 4, -5}), 2);  // 1, 1, 1, 1
}

TEST(Hyperbox, ChoosesTheLowestAxisAndThePositiveSideWhereFacesTie) {
    const Hyperbox cube{2 * Vec4::Ones()};
    EXPECT_EQ(normal(cube, Vec4::Zero()), Vec4::UnitX());
    EXPECT_EQ(normal(cube, {-0.0, 0.5, 0.5, -0.5}), Vec4::UnitY());
    EXPECT_EQ(normal(cube, {0.1, 0.2, -0.5, 0.5}), -Vec4::UnitZ());
    EXPECT_EQ(normal(cube, {1, 1, 1, 1}), Vec4::UnitX());
    EXPECT_EQ(normal(cube, {0, 1, -1, 1}), Vec4::UnitY());
    EXPECT_EQ(normal(cube, {-2, 0, 0, 0}), -Vec4::UnitX());
    EXPECT_EQ(normal(cube, {-2, 2, 2, -2}), Vec4(-0.5, 0.5, 0.5, -0.5));
}

TEST(Hyperbox, IsHitByRaysAlongItsFaces) {
    const Vec4 x = Vec4::UnitX();
    EXPECT_EQ(ray_hit(kBox, {-5, 0, 0, 0}, x), 4);
    EXPECT_EQ(ray_hit(kBox, {-5, 2, -3, 4}, x), 4);  // along an edge: the surface belongs to it
    EXPECT_EQ(ray_hit(kBox, {-5, std::nextafter(2, 3), 0, 0}, x), kMiss);
    EXPECT_EQ(ray_hit(kBox, {-5, 0, 0, 0}, -x), kMiss);
    EXPECT_EQ(ray_hit(kBox, {0.5, 0, 0, 0}, x), 0);
    EXPECT_EQ(ray_hit(kBox, {1, 0, 0, 0}, x), 0);
    EXPECT_EQ(ray_hit(kBox, {std::nextafter(1, 2), 0, 0, 0}, x), kMiss);
    EXPECT_EQ(ray_hit(kBox, {-5, 0, 0, 0}, {1, -0.0, 0.0, -0.0}), 4);
    EXPECT_EQ(ray_hit(kBox, {-5, 0, 0, 0}, {1, 1e-320, -1e-320, 1e-200}), 4);
    EXPECT_EQ(ray_hit(kBox, {-5, 2, 0, 0}, {1, 1e-320, 0, 0}), kMiss);  // on the face, leaving it
    EXPECT_EQ(ray_hit(kBox, {-5, 2, 0, 0}, {1, -1e-320, 0, 0}), 4);     // on the face, entering
    EXPECT_EQ(ray_hit(kBox, {-3, -4, 0, 0}, Vec4(0.5, 0.5, 0.5, 0.5)), 4);  // both slabs at t = 4
    // Past the edge x = -1, y = 2, which it only touches: it leaves one slab as it enters the
    // other.
    EXPECT_EQ(ray_hit(kBox, {-3, 0, 0, 0}, Vec4(0.5, 0.5, 0.5, 0.5)), 4);
}

}  // namespace
}  // namespace tesserae
