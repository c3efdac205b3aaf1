// SPDX-License-Identifier: Apache-2.0
#include "render/camera/camera_rays.hpp"

#include <gtest/gtest.h>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

constexpr double kRounding = 1e-12;

const SliceSheet::Cell kWhole = {0, 0, 0, 0};

std::array<double, 3> random_numbers(Random& random) {
    std::array<double, 3> u;
    for (double& v : u) v = uniform(random, 0, 1);
    return u;
}

/// The rays of a camera that fills a frame of 200 x 100 pixels.
struct WholeFrame {
    Camera camera;
    CameraRays rays;

    explicit WholeFrame(const CameraDescription& d) : camera(d, 200, 100), rays(d, camera) {}
};

TEST(CameraRays, OfAPinholeAreTheCamerasOwn) {
    Random random(1);
    const WholeFrame frame(random_camera(random, 5));
    EXPECT_TRUE(frame.rays.is_pinhole());
    for (int i = 0; i < 100; ++i) {
        const Vec2 film(uniform(random, 0, 200), uniform(random, 0, 100));
        const ViewRay ray = frame.rays.sample(kWhole, film, random_numbers(random));
        EXPECT_EQ(ray.direction, frame.camera.ray_direction(film));
        EXPECT_EQ(ray.origin, Vec3::Zero());
        EXPECT_EQ(ray.fourth, 0);
    }
}

TEST(CameraRays, ThroughALensMeetInThePlaneInFocus) {
    Random random(2);
    CameraDescription d = random_camera(random, 5);
    d.aperture = 0.3;
    for (const double focus : {0.0, 2.0}) {
        d.focus_distance = focus;
        const WholeFrame frame(d);
        EXPECT_FALSE(frame.rays.is_pinhole());
        EXPECT_EQ(frame.rays.reach(), 0.3);
        const double distance = focus > 0 ? focus : 5;
        const Vec2 film(31, 72);
        const ViewRay middle = frame.rays.middle(kWhole, film);
        const Vec3 sharp = distance / middle.direction.z() * middle.direction;
        Vec3 sum = Vec3::Zero();
        double squares = 0;
        constexpr int kRays = 20000;
        for (int i = 0; i < kRays; ++i) {
            const ViewRay ray = frame.rays.sample(kWhole, film, random_numbers(random));
            EXPECT_NEAR(ray.direction.norm(), 1, kRounding);
            // The point in focus lies on the ray; the ray starts on the lens, in the slice.
            const Vec3 to = sharp - ray.origin;
            EXPECT_LT((to - to.dot(ray.direction) * ray.direction).norm(), 1e-11);
            EXPECT_LE(ray.origin.norm(), d.aperture * (1 + kRounding));
            EXPECT_EQ(ray.origin.z(), 0);
            EXPECT_EQ(ray.fourth, 0);
            sum += ray.origin;
            squares += ray.origin.squaredNorm();
        }
        // Uniform on the disc: mean 0, mean square a^2/2, within five standard errors.
        EXPECT_LT((sum / kRays).norm(), 5 * d.aperture / std::sqrt(2.0 * kRays));
        EXPECT_NEAR(squares / kRays / (d.aperture * d.aperture), 0.5, 5 / std::sqrt(12.0 * kRays));
    }
}

TEST(CameraRays, OfAThickSliceStartAllOverItsThickness) {
    Random random(3);
    CameraDescription d = random_camera(random, 5);
    d.slice_thickness = 0.8;
    const WholeFrame frame(d);
    EXPECT_FALSE(frame.rays.is_pinhole());
    EXPECT_EQ(frame.rays.range().low, -0.4);
    EXPECT_EQ(frame.rays.range().high, 0.4);
    const Vec2 film(31, 72);
    for (const double u : {0.0, 0.25, 0.5, 0.999}) {
        const ViewRay ray = frame.rays.sample(kWhole, film, {0.3, 0.7, u});
        EXPECT_NEAR(ray.fourth, (u - 0.5) * 0.8, kRounding);
        EXPECT_EQ(ray.direction, frame.camera.ray_direction(film));
    }
}

TEST(SliceSheet, OneSliceFillsTheFrame) {
    const SliceSheet sheet({}, 1280, 720);
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(1279, 719)}) {
        const auto cell = sheet.cell_of(x, y);
        ASSERT_TRUE(cell);
        EXPECT_EQ(cell->x0, 0);
        EXPECT_EQ(cell->fourth, 0);
    }
    EXPECT_EQ(sheet.cell_width(), 1280);
    EXPECT_EQ(sheet.cell_height(), 720);
}

TEST(SliceSheet, SpreadsSlicesOverTheThicknessRowByRow) {
    CameraDescription camera;
    camera.slice_thickness = 2;
    camera.slices = 5;
    const SliceSheet sheet(camera, 1000, 401);  // 3 columns of 333, 2 rows of 200
    std::vector<double> seen;
    for (int y = 0; y < 401; ++y)
        for (int x = 0; x < 1000; ++x) {
            const auto cell = sheet.cell_of(x, y);
            const bool shown = x < 999 && y < 400 && !(y >= 200 && x >= 666);
            ASSERT_EQ(cell.has_value(), shown) << x << " " << y;
            if (!cell) continue;
            EXPECT_LE(cell->x0, x);
            EXPECT_LT(x, cell->x0 + 333);
            if (x == cell->x0 && y == cell->y0) seen.push_back(cell->fourth);
        }
    EXPECT_EQ(seen, (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
}

TEST(SliceSheet, EveryCellLooksAlongTheForwardAxisInItsMiddle) {
    CameraDescription d;
    d.slice_thickness = 2;
    d.slices = 4;
    const SliceSheet sheet(d, 400, 200);
    const Camera camera(d, sheet.cell_width(), sheet.cell_height());
    const CameraRays rays(d, camera);
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(200, 0), std::pair(399, 199)}) {
        const auto cell = *sheet.cell_of(x, y);
        const ViewRay ray = rays.sample(cell, Vec2(cell.x0 + 100, cell.y0 + 50), {0.1, 0.2, 0.3});
        EXPECT_LT((ray.direction - Vec3::UnitZ()).norm(), kRounding);
        EXPECT_EQ(ray.fourth, cell.fourth);
    }
}

TEST(SliceSheet, SmallerThanItsSlicesStillHasCells) {
    CameraDescription camera;
    camera.slice_thickness = 1;
    camera.slices = 1000;
    const SliceSheet sheet(camera, 3, 2);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x) EXPECT_TRUE(sheet.cell_of(x, y));
}

}  // namespace
}  // namespace tesserae::render
