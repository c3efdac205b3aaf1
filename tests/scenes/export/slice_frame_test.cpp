// SPDX-License-Identifier: Apache-2.0
#include "scenes/export/slice_frame.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace tesserae::scenes {
namespace {

render::Camera camera_with(const Vec4& position, const Vec4& look_at, const Vec4& fourth) {
    render::CameraDescription description;
    description.position = position, description.look_at = look_at;
    description.fourth = fourth;
    return {description, 64, 48};
}

/// World to film, of a point in the frame's slice.
Vec3 film_point(const SliceFrame& frame, const Vec4& world) {
    const Vec4 in_frame = frame.point_to_frame(world);
    EXPECT_NEAR(in_frame[3], 0, 1e-12);
    return frame.point_to_film(in_frame.head<3>());
}

TEST(SliceFrame, TheFirstCamerasAxesAreRightForwardAndUp) {
    const render::Camera first = camera_with({0, 0, -8, 0}, {0, 0, 0, 0}, {0, 0, 0, 1});
    const SliceFrame frame(first, first);
    // Looking along +z with +w as fourth and +y up, +x is on the right.
    EXPECT_TRUE(film_point(frame, {1, 0, -8, 0}).isApprox(Vec3(1, 0, 0)));
    EXPECT_TRUE(film_point(frame, {0, 0, -7, 0}).isApprox(Vec3(0, 1, 0)));
    EXPECT_TRUE(film_point(frame, {0, 1, -8, 0}).isApprox(Vec3(0, 0, 1)));
    EXPECT_NEAR(film_point(frame, {0, 0, -8, 0}).norm(), 0, 1e-15);
}

TEST(SliceFrame, AMovedCameraOfTheSameSliceLeavesTheWorldInPlace) {
    const render::Camera first = camera_with({0, 2, -8, 0}, {0, 0, 0, 0}, {0, 0, 0, 1});
    const render::Camera later = camera_with({5, 3, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1});
    const SliceFrame a(first, first), b(later, first);
    for (const Vec4& p : {Vec4(1, 2, 3, 0), Vec4(-4, 0.5, 2, 0)})
        EXPECT_NEAR((film_point(a, p) - film_point(b, p)).norm(), 0, 1e-13);
    // And the camera in its own place.
    EXPECT_NEAR((b.point_to_film(Vec3::Zero()) - film_point(a, {5, 3, 1, 0})).norm(), 0, 1e-13);
}

TEST(SliceFrame, AShiftedSliceIsLaidOverTheFirst) {
    const render::Camera first = camera_with({0, 2, -8, 0}, {0, 0, 0, 0}, {0, 0, 0, 1});
    const render::Camera later = camera_with({0, 2, -8, 0.7}, {0, 0, 0, 0.7}, {0, 0, 0, 1});
    EXPECT_NEAR((film_point(SliceFrame(later, first), {1, 2, 3, 0.7}) -
                 film_point(SliceFrame(first, first), {1, 2, 3, 0}))
                    .norm(),
                0, 1e-13);
}

/// In any two slices: what both show keeps its place, lengths and handedness stay.
TEST(SliceFrame, ATurnedSliceIsTurnedBackAboutWhatItSharesWithTheFirst) {
    std::mt19937_64 rng(1);
    std::normal_distribution<double> normal;
    const auto any = [&] { return Vec4(normal(rng), normal(rng), normal(rng), normal(rng)); };
    for (int i = 0; i < 100; ++i) {
        const render::Camera first = camera_with(any(), any(), any());
        const render::Camera later = camera_with(any(), any(), any());
        const SliceFrame a(first, first), b(later, first);
        Mat3 axes;
        for (int k = 0; k < 3; ++k) axes.col(k) = b.direction_to_film(Vec3::Unit(k));
        EXPECT_TRUE((axes.transpose() * axes).isApprox(Mat3::Identity(), 1e-12));
        EXPECT_NEAR(axes.determinant(), 1, 1e-12);
        // Points of both slices, by least squares from anywhere.
        Eigen::Matrix<double, 2, 4> both;
        both << first.fourth().transpose(), later.fourth().transpose();
        for (int k = 0; k < 3; ++k) {
            const Vec4 from = any();
            const Eigen::Vector2d above(first.fourth().dot(from - first.origin()),
                                        later.fourth().dot(from - later.origin()));
            const Vec4 point =
                from - both.transpose() * (both * both.transpose()).inverse() * above;
            const double size = 1 + point.norm() + first.origin().norm();
            EXPECT_NEAR((film_point(a, point) - film_point(b, point)).norm(), 0, 1e-10 * size);
        }
    }
}

TEST(SliceFrame, AHalfTurnIsInThePlaneOfFourthAndRight) {
    const render::Camera first = camera_with({0, 0, -8, 0}, {0, 0, 0, 0}, {0, 0, 0, 1});
    const render::Camera later = camera_with({0, 0, -8, 0}, {0, 0, 0, 0}, {0, 0, 0, -1});
    const SliceFrame frame(later, first);
    EXPECT_TRUE(film_point(frame, {1, 2, 3, 0}).isApprox(Vec3(-1, 11, 2), 1e-12));
    // The camera's right is the film's: its picture is not mirrored.
    EXPECT_TRUE(frame.direction_to_film(Vec3::UnitX()).isApprox(Vec3::UnitX(), 1e-12));
}

}  // namespace
}  // namespace tesserae::scenes
