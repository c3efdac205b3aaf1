// SPDX-License-Identifier: Apache-2.0
#include "render/camera/camera.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/error.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

Mat4 axes_of(const Camera& c) {
    Mat4 m;
    m << c.right(), c.up(), c.forward(), c.fourth();
    return m;
}

TEST(Camera, LookingAlongZHasXOnTheRight) {
    CameraDescription d;
    d.position = {0, 0, -8, 0};
    const Camera camera(d, 640, 480);
    EXPECT_EQ(axes_of(camera), Mat4::Identity());
    // The middle of the film looks forward; the right border's middle to the right, the top up.
    EXPECT_EQ(camera.ray_direction({320, 240}), Vec3::UnitZ());
    EXPECT_GT(camera.ray_direction({640, 240}).x(), 0);
    EXPECT_GT(camera.ray_direction({320, 0}).y(), 0);
}

TEST(Camera, FieldOfViewIsVertical) {
    CameraDescription d;
    d.field_of_view = 90;
    const Camera camera(d, 300, 100);
    // Half of 90 degrees at the top: height over depth 1; pixels are square, so 3 at the side.
    EXPECT_NEAR(camera.ray_direction({150, 0}).y() / camera.ray_direction({150, 0}).z(), 1, 1e-15);
    EXPECT_NEAR(camera.ray_direction({300, 50}).x() / camera.ray_direction({300, 50}).z(), 3,
                1e-15);
}

TEST(Camera, FilmPointInvertsTheRay) {
    const Camera camera(CameraDescription{}, 1920, 1080);
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const Vec2 film(uniform(random, -100, 2000), uniform(random, -100, 1200));
        const Vec3 d = camera.ray_direction(film);
        // A few roundings of coordinates near 1000.
        EXPECT_LT((camera.film_point(d.x() / d.z(), d.y() / d.z()) - film).norm(), 1e-11);
    }
}

TEST(Camera, AxesAreTheDescribedOnesMadeOrthonormal) {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const CameraDescription d = random_camera(random, uniform(random, 1, 20));
        const Camera camera(d, 64, 48);
        const Mat4 m = axes_of(camera);
        EXPECT_LT((m.transpose() * m - Mat4::Identity()).norm(), 1e-14);
        EXPECT_NEAR(m.determinant(), 1, 1e-13);
        // Forward is kept; fourth lies in the span of (forward, d.fourth) on its own side; up in
        // that of (forward, fourth, d.up).
        EXPECT_LT((camera.forward() - (d.look_at - d.position).normalized()).norm(), 1e-14);
        EXPECT_GT(camera.fourth().dot(d.fourth), 0);
        EXPECT_NEAR(camera.right().dot(d.fourth), 0, 1e-13);
        EXPECT_NEAR(camera.up().dot(d.fourth), 0, 1e-13);
        EXPECT_GT(camera.up().dot(d.up), 0);
        EXPECT_NEAR(camera.right().dot(d.up), 0, 1e-13);
    }
}

TEST(Camera, NearlyParallelAxesStayOrthonormal) {
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        CameraDescription d = random_camera(random, 5);
        d.fourth = d.look_at - d.position + 1e-6 * random_direction(random);
        const Mat4 m = axes_of(Camera(d, 64, 48));
        EXPECT_LT((m.transpose() * m - Mat4::Identity()).norm(), 1e-14);
    }
}

TEST(Camera, WorldAndCameraCoordinatesAreInverse) {
    Random random(4);
    const Camera camera(random_camera(random, 5), 64, 48);
    for (int i = 0; i < 100; ++i) {
        const Vec4 v = random_vector(random, 10);
        EXPECT_LT((camera.to_world(camera.to_camera(v)) - v).norm(), 1e-13);
    }
    EXPECT_LT((camera.to_camera(camera.fourth()) - Vec4::UnitW()).norm(), 1e-14);
}

TEST(Camera, RefusesParallelDirections) {
    const auto refused = [](Vec4 forward, Vec4 up, Vec4 fourth) {
        CameraDescription d;
        d.position = {3, 1, 4, 1};
        d.look_at = d.position + forward;
        d.up = up, d.fourth = fourth;
        EXPECT_THROW(Camera(d, 64, 48), InputError) << forward << "\n" << up << "\n" << fourth;
    };
    const Vec4 x = Vec4::UnitX(), y = Vec4::UnitY(), z = Vec4::UnitZ(), w = Vec4::UnitW();
    refused(Vec4::Zero(), y, w);
    refused(z, y, -3 * z);
    refused(z, z, w);
    refused(z, w, w);
    refused(z, z + w, w);
    refused(z, Vec4::Zero(), w);
    refused(x + y, x + y + 2 * z, 1e-3 * z);
    refused(z, y, w + 1e20 * z);
}

}  // namespace
}  // namespace tesserae::render
