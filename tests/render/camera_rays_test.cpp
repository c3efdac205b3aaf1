#include "render/camera_rays.hpp"

#include <gtest/gtest.h>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

constexpr double kRounding = 1e-12;

const SliceSheet::Cell kWhole = {0, 0, 0};

std::array<double, 4> random_numbers(Random& random) {
    std::array<double, 4> u;
    for (double& v : u) v = uniform(random, 0, 1);
    return u;
}

TEST(CameraRays, OfAPinholeAreTheCamerasOwn) {
    Random random(1);
    const CameraDescription d = random_camera(random, 5);
    const CameraRays rays(d, d, 200, 100);
    EXPECT_TRUE(rays.is_pinhole());
    const Camera camera(d, 200, 100);
    for (int i = 0; i < 100; ++i) {
        const Vec2 film(uniform(random, 0, 200), uniform(random, 0, 100));
        const Ray ray = rays.sample(kWhole, film, random_numbers(random));
        const Vec3 view = camera.ray_direction(film);
        EXPECT_EQ(ray.direction, camera.to_world({view.x(), view.y(), view.z(), 0}));
        EXPECT_EQ(ray.origin, Vec4::Zero());
        EXPECT_EQ(ray.time, 0);
    }
}

TEST(CameraRays, ThroughALensMeetInThePlaneInFocus) {
    Random random(2);
    CameraDescription d = random_camera(random, 5);
    d.aperture = 0.3;
    for (const double focus : {0.0, 2.0}) {
        d.focus_distance = focus;
        const CameraRays rays(d, d, 200, 100);
        const Camera& camera = rays.camera();
        const double distance = focus > 0 ? focus : 5;
        const Vec2 film(31, 72);
        const Ray middle = rays.middle(kWhole, film);
        const double far = distance / middle.direction.dot(camera.forward());
        const Vec4 sharp = far * middle.direction;
        Vec4 sum = Vec4::Zero();
        double squares = 0;
        constexpr int kRays = 20000;
        for (int i = 0; i < kRays; ++i) {
            const Ray ray = rays.sample(kWhole, film, random_numbers(random));
            EXPECT_NEAR(ray.direction.norm(), 1, kRounding);
            // The point in focus lies on the ray; the ray starts on the lens, in the slice.
            const Vec4 to = sharp - ray.origin;
            EXPECT_LT((to - to.dot(ray.direction) * ray.direction).norm(), 1e-11);
            EXPECT_LE(ray.origin.norm(), d.aperture * (1 + kRounding));
            EXPECT_NEAR(ray.origin.dot(camera.forward()), 0, kRounding);
            EXPECT_NEAR(ray.origin.dot(camera.fourth()), 0, kRounding);
            EXPECT_NEAR(ray.direction.dot(camera.fourth()), 0, kRounding);
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
    const CameraRays rays(d, d, 200, 100);
    EXPECT_FALSE(rays.is_pinhole());
    const Vec2 film(31, 72);
    const Ray middle = rays.middle(kWhole, film);
    for (const double u : {0.0, 0.25, 0.5, 0.999}) {
        const Ray ray = rays.sample(kWhole, film, {0.3, 0.7, u, 0.2});
        EXPECT_LT((ray.origin - (u - 0.5) * 0.8 * rays.camera().fourth()).norm(), kRounding);
        EXPECT_LT((ray.direction - middle.direction).norm(), kRounding);
    }
}

TEST(CameraRays, GoFromTheOpeningToTheClosingCamera) {
    Random random(4);
    CameraDescription a = random_camera(random, 5), b = a;
    a.shutter = b.shutter = 0.5;
    b.position += Vec4(0.1, 0, 0.2, 0);
    b.fourth = (a.fourth + 0.05 * random_direction(random)).eval();
    const CameraRays rays(a, b, 200, 100);
    const Camera opening(a, 200, 100), closing(b, 200, 100);
    const Vec2 film(31, 72);
    const auto world = [&](const Camera& c) {
        const Vec3 v = c.ray_direction(film);
        return c.to_world({v.x(), v.y(), v.z(), 0});
    };
    const Ray first = rays.sample(kWhole, film, {0, 0, 0, 0});
    EXPECT_LT((first.direction - world(opening)).norm(), kRounding);
    EXPECT_EQ(first.time, 0);
    const double last_time = 1 - 0x1p-32;
    const Ray last = rays.sample(kWhole, film, {0, 0, 0, last_time});
    EXPECT_LT((last.direction - world(closing)).norm(), 1e-9);
    EXPECT_LT((last.origin - (b.position - a.position)).norm(), 1e-9);
    EXPECT_EQ(last.time, last_time);
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
    const CameraRays rays(d, d, 400, 200);
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(200, 0), std::pair(399, 199)}) {
        const auto cell = *rays.sheet().cell_of(x, y);
        const Ray ray = rays.sample(cell, Vec2(cell.x0 + 100, cell.y0 + 50), {0.1, 0.2, 0.3, 0.4});
        EXPECT_LT((ray.direction - rays.camera().forward()).norm(), kRounding);
        EXPECT_LT((ray.origin - cell.fourth * rays.camera().fourth()).norm(), kRounding);
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
