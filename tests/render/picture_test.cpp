// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/render/test_scene.hpp"

// Whole pictures, from render_frame to OpenEXR's reader, against pictures made another way.
namespace tesserae::render {
namespace {

using Real = long double;
using RealVec4 = Eigen::Matrix<Real, 4, 1>;

/// The camera of scenes/FORMATS.md built again, in long double: Gram-Schmidt, and right by solving
/// for the direction across the other three.
struct OracleCamera {
    RealVec4 origin, right, up, forward, fourth;
    Real half_height;
    int width, height;

    explicit OracleCamera(const TestScene& scene)
        : origin(scene.camera.position.cast<Real>()),
          width(scene.settings.width),
          height(scene.settings.height) {
        const auto across = [](RealVec4 v, std::initializer_list<RealVec4> axes) {
            for (const RealVec4& a : axes) v -= v.dot(a) * a;
            return RealVec4(v.normalized());
        };
        forward = (scene.camera.look_at.cast<Real>() - origin).normalized();
        fourth = across(scene.camera.fourth.cast<Real>(), {forward});
        up = across(scene.camera.up.cast<Real>(), {forward, fourth});
        RealVec4 any = RealVec4(0.3L, -0.5L, 0.7L, 0.2L);
        right = across(any, {forward, fourth, up});
        right = across(right, {forward, fourth, up});
        Eigen::Matrix<Real, 4, 4> m;
        m << right, up, forward, fourth;
        if (m.determinant() < 0) right = -right;
        half_height = std::tan(scene.camera.field_of_view / 2 * std::numbers::pi_v<Real> / 180);
    }
    RealVec4 ray(Real x, Real y) const {
        const Real scale = 2 * half_height / height;
        return (forward + (x - width / Real(2)) * scale * right +
                (height / Real(2) - y) * scale * up)
            .normalized();
    }
};

void expect_spheres_in_closed_form(int width) {
    // A camera in general position. The oracle cuts every sphere with the camera's hyperplane and
    // meets the 3D sphere that results. Pixels whose ray passes within 1e-3 m of a rim are left
    // out; elsewhere float (6e-8) limits the depth, and 1e-3 m beside a rim the hit distance is at
    // most sqrt(2 R / 1e-3) = 50 times as sensitive as the position, still far below a float's
    // digit.
    Random random(51);
    std::size_t compared = 0, background = 0;
    for (int round = 0; round < 4; ++round) {
        TestScene scene;
        scene.settings.width = width, scene.settings.height = width * 9 / 16;
        scene.settings.samples = 1 + round % 2;
        scene.settings.channels.position = true;
        if (round >= 2) scene.settings.intersector = Intersector::kAnalytic;
        scene.camera = random_camera(random, 9);
        const Vec4 shift = round == 3 ? random_vector(random, 1e4) : Vec4::Zero();
        scene.camera.position += shift, scene.camera.look_at += shift;
        for (int i = 0; i < 200; ++i)
            scene.add(Hypersphere{uniform(random, 0.2, 0.8)}, shift + random_vector(random, 2.5));
        const Image image = picture_of(scene);
        const OracleCamera camera(scene);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const RealVec4 ray = camera.ray(x + 0.5L, y + 0.5L);
                Real depth = std::numeric_limits<Real>::infinity(), runner_up = depth;
                std::uint32_t id = 0;
                bool edge = false;
                for (BodyId b = 0; b < scene.bodies.size(); ++b) {
                    const auto& ball = std::get<Hypersphere>(scene.bodies.types[b].shape);
                    const RealVec4 c = scene.bodies.position[b].cast<Real>() - camera.origin;
                    const Real off = c.dot(camera.fourth);
                    const Real square = Real(ball.radius) * ball.radius - off * off;
                    if (square <= 0) continue;
                    const RealVec4 in_slice = c - off * camera.fourth;
                    const Real middle = in_slice.dot(ray);
                    const Real miss = (in_slice - middle * ray).norm();
                    if (middle < 0) continue;
                    if (std::abs(miss - std::sqrt(square)) < 1e-3L) edge = true;
                    if (miss > std::sqrt(square)) continue;
                    const Real t = middle - std::sqrt(square - miss * miss);
                    if (t < depth)
                        runner_up = depth, depth = t, id = b + 1;
                    else
                        runner_up = std::min(runner_up, t);
                }
                // Where two spheres cross, the nearer one changes.
                if (edge || runner_up - depth < 1e-3L) continue;
                ASSERT_EQ(image.id(x, y), id) << round << ": " << x << ", " << y;
                const float z = image.at("Z", x, y);
                if (id == 0) {
                    ++background;
                    EXPECT_EQ(z, std::numeric_limits<float>::infinity());
                    EXPECT_EQ(image.at("N.X", x, y), 0);
                    continue;
                }
                ++compared;
                EXPECT_NEAR(z, static_cast<double>(depth), 1e-6 * static_cast<double>(depth));
                const auto& ball = std::get<Hypersphere>(scene.bodies.types[id - 1].shape);
                const RealVec4 p = camera.origin + depth * ray;
                const RealVec4 n = (p - scene.bodies.position[id - 1].cast<Real>()) / ball.radius;
                const char* const axes[] = {"X", "Y", "Z", "W"};
                for (int k = 0; k < 4; ++k) {
                    EXPECT_NEAR(image.at(std::string("N.") + axes[k], x, y),
                                static_cast<double>(n[k]), 1e-6);
                    EXPECT_NEAR(image.at(std::string("P.") + axes[k], x, y),
                                static_cast<double>(p[k]),
                                1e-6 + 6e-8 * std::abs(static_cast<double>(p[k])));
                }
            }
    }
    EXPECT_GT(compared, 0.34 * width * width);
    EXPECT_GT(background, 0.017 * width * width);
}

TEST(Picture, OfSpheresIsTheClosedForm) { expect_spheres_in_closed_form(112); }
TEST(PictureSlow, OfSpheresIsTheClosedForm) { expect_spheres_in_closed_form(240); }

/// Of a product of balls: how far outside the one that holds a point least.
Real ball_level(const BallProduct& shape, const RealVec4& p) {
    Real most = -std::numeric_limits<Real>::infinity();
    for (const BallFactor& ball : shape)
        most = std::max(most, ball.axes.cast<Real>().cwiseProduct(p).norm() - ball.radius);
    return most;
}
Real hull_level(const HullShape& shape, const RealVec4& p) {
    Real most = -std::numeric_limits<Real>::infinity();
    for (const HullCell& cell : shape.body->hull.cells)
        most = std::max(most, cell.plane.normal.cast<Real>().dot(p) - cell.plane.offset);
    return most;
}

/// The signed distance of a body, written once more: to a segment, from a box, to a point; of the
/// others something else that is convex, and negative inside.
Real oracle_distance(const Shape& shape, const RealVec4& p) {
    if (const auto* s = std::get_if<Hypersphere>(&shape)) return p.norm() - s->radius;
    if (const auto* s = std::get_if<Hyperplane>(&shape))
        return s->normal.cast<Real>().dot(p) - s->offset;
    if (const auto* s = std::get_if<Hypercapsule>(&shape)) {
        RealVec4 q = p;
        const Real half = s->height / 2;
        q[1] = p[1] > half ? p[1] - half : p[1] < -half ? p[1] + half : 0;
        return q.norm() - s->radius;
    }
    if (!std::holds_alternative<Hyperbox>(shape))
        return std::visit(
            [&]<class S>(const S& s) -> Real {
                if constexpr (std::derived_from<S, BallProduct>) return ball_level(s, p);
                if constexpr (std::derived_from<S, HullShape>) return hull_level(s, p);
                return 0;
            },
            shape);
    const auto& box = std::get<Hyperbox>(shape);
    Real outside = 0, inside = -std::numeric_limits<Real>::infinity();
    for (int i = 0; i < 4; ++i) {
        const Real face = std::abs(p[i]) - box.size[i] / 2;
        if (face > 0) outside += face * face;
        inside = std::max(inside, face);
    }
    return outside > 0 ? std::sqrt(outside) : inside;
}

void expect_shapes_by_bisection(int width) {
    // Along a ray a convex body's distance falls, then rises: its least value by golden section,
    // the entry by bisection before it. Rays within 1e-3 m of grazing any body are left out.
    Random random(52);
    std::size_t compared = 0;
    TestScene scene;
    scene.settings.width = width, scene.settings.height = width * 3 / 4;
    scene.settings.samples = 1;
    scene.settings.max_distance = 200;
    scene.camera = random_camera(random, 7);
    for (int i = 0; i < 40; ++i) {
        // One draw after the other: the order of a call's arguments is the compiler's.
        const Rotor rotor = random_rotor(random);
        const Vec4 place = random_vector(random, 2);
        scene.add(random_shape(random, i % kShapeKinds, 0.7), place, rotor);
    }
    scene.add(Hyperplane{Vec4(1, 2, -1, 1).normalized(), -6}, Vec4::Zero());
    const Image image = picture_of(scene);
    const OracleCamera camera(scene);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const RealVec4 ray = camera.ray(x + 0.5L, y + 0.5L);
            Real depth = std::numeric_limits<Real>::infinity(), runner_up = depth;
            std::uint32_t id = 0;
            bool edge = false;
            for (BodyId b = 0; b < scene.bodies.size(); ++b) {
                const auto turn = to_matrix(scene.bodies.rotor[b]).transpose().cast<Real>().eval();
                const RealVec4 o = turn * (camera.origin - scene.bodies.position[b].cast<Real>());
                const RealVec4 d = turn * ray;
                const Shape& shape = scene.bodies.types[b].shape;
                const auto f = [&](Real t) { return oracle_distance(shape, o + t * d); };
                Real low = 0, high = is_bounded(shape) ? 30 : 200;
                constexpr Real golden = 0.6180339887498948482L;
                Real u = high - golden * (high - low), v = low + golden * (high - low);
                Real at_u = f(u), at_v = f(v);
                for (int k = 0; k < 70; ++k) {
                    if (at_u < at_v) {
                        high = v, v = u, at_v = at_u;
                        u = high - golden * (high - low), at_u = f(u);
                    } else {
                        low = u, u = v, at_u = at_v;
                        v = low + golden * (high - low), at_v = f(v);
                    }
                }
                if (std::abs(f(low)) < 1e-3L) edge = true;
                if (f(low) > 0) continue;
                Real outside = 0, inside = low;
                for (int k = 0; k < 60; ++k) {
                    const Real t = (outside + inside) / 2;
                    (f(t) > 0 ? outside : inside) = t;
                }
                if (inside < depth)
                    runner_up = depth, depth = inside, id = b + 1;
                else
                    runner_up = std::min(runner_up, inside);
            }
            if (edge || runner_up - depth < 1e-3L) continue;
            ASSERT_EQ(image.id(x, y), id) << x << ", " << y;
            if (id == 0) continue;
            ++compared;
            EXPECT_NEAR(image.at("Z", x, y), static_cast<double>(depth),
                        1e-6 * static_cast<double>(depth));
        }
    EXPECT_GT(compared, 0.28 * width * width);
}

TEST(Picture, OfAllShapesIsFoundByBisection) { expect_shapes_by_bisection(48); }
TEST(PictureSlow, OfAllShapesIsFoundByBisection) { expect_shapes_by_bisection(84); }

TEST(Picture, CoverageConvergesToTheArea) {
    // A sphere straight ahead shows as a circle of radius tan(alpha): its area in pixels is known.
    // The error is that of border pixels alone, at most 1.3 * 2 pi r of them, each with a deviation
    // of at most 0.5/sqrt(samples); five deviations of the sum.
    for (int samples : {4, 64}) {
        TestScene scene;
        scene.settings.width = scene.settings.height = 100;
        scene.settings.samples = samples;
        scene.settings.channels = {true, false, false, true, false, false};
        scene.lights.sky = {0.5, 1, 2};
        scene.camera.position = {0, 0, -5, 0};
        scene.camera.field_of_view = 60;
        scene.add(Hypersphere{1.25}, {0, 0, 0, 0.75});  // its slice: radius 1
        const Image image = picture_of(scene);
        const double radius =
            50 * std::tan(std::asin(1.0 / 5)) / std::tan(30 * std::numbers::pi / 180);
        double area = 0;
        for (float a : image.planes.at("A")) area += a;
        const double border = 1.3 * 2 * std::numbers::pi * radius;
        EXPECT_NEAR(area, std::numbers::pi * radius * radius,
                    5 * 0.5 * std::sqrt(border / samples) + border * 5e-4);
        // Sky light only: bodies send albedo * sky, the background the sky; albedo is
        // premultiplied.
        for (std::size_t i = 0; i < image.planes.at("A").size(); ++i) {
            const float a = image.planes.at("A")[i];
            EXPECT_NEAR(image.planes.at("G")[i], a * 0.8 + (1 - a), 1e-3);
            EXPECT_NEAR(image.planes.at("B")[i], a * 1.6 + (1 - a) * 2, 2e-3);
            EXPECT_NEAR(image.planes.at("albedo.R")[i], 0.8 * a, 1e-3);
        }
    }
}

TEST(Picture, OfNothingIsSky) {
    TestScene scene;
    scene.settings.width = 20, scene.settings.height = 10;
    scene.lights.sky = {0.25, 1, 1e9};
    const Image image = picture_of(scene);
    for (int i = 0; i < 200; ++i) {
        const auto k = static_cast<std::size_t>(i);
        EXPECT_EQ(image.planes.at("R")[k], 0.25f);
        EXPECT_EQ(image.planes.at("B")[k], 65504);  // the largest half
        EXPECT_EQ(image.planes.at("A")[k], 0);
        EXPECT_EQ(image.planes.at("Z")[k], std::numeric_limits<float>::infinity());
        EXPECT_EQ(image.ids[k], 0u);
    }
}

TEST(Picture, FromInsideABodyIsThatBody) {
    TestScene scene;
    scene.settings.width = 20, scene.settings.height = 10;
    scene.add(Hypersphere{0.1}, {0, 2, -6, 0});
    scene.add(Hyperbox{Vec4::Constant(4)}, scene.camera.position);
    const Image image = picture_of(scene);
    for (std::size_t i = 0; i < 200; ++i) {
        EXPECT_EQ(image.ids[i], 2u);
        EXPECT_EQ(image.planes.at("Z")[i], 0);
    }
}

TEST(Picture, OfAPlaneEndsAtTheDistanceLimit) {
    TestScene scene;
    scene.settings.width = 20, scene.settings.height = 200;
    scene.settings.samples = 1;
    scene.settings.max_distance = 50;
    scene.camera.position = {0, 2, 0, 0};
    scene.camera.look_at = {0, 2, 1, 0};
    scene.camera.field_of_view = 90;
    scene.add(Hyperplane{}, Vec4::Zero());
    const Image image = picture_of(scene);
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 20; ++x) {
            // Below the horizon the depth is 2 m over the sine of the ray's fall.
            const double u = (x + 0.5 - 10) / 100, v = (y + 0.5 - 100) / 100;
            const double depth = 2 * std::sqrt(u * u + v * v + 1) / v;
            const bool seen = v > 0 && depth <= 50;
            EXPECT_EQ(image.id(x, y), seen ? 1u : 0u) << x << ", " << y;
            if (seen) {
                EXPECT_NEAR(image.at("Z", x, y), depth, 1e-6 * depth);
            }
        }
}

TEST(Picture, OfAPlaneParallelToTheSliceIsAllOrNothing) {
    for (double offset : {-1.0, 1.0}) {
        TestScene scene;
        scene.settings.width = 20, scene.settings.height = 10;
        scene.add(Hyperplane{Vec4::UnitW(), offset}, Vec4::Zero());
        const Image image = picture_of(scene);
        for (std::uint32_t id : image.ids) EXPECT_EQ(id, offset > 0 ? 1u : 0u);
    }
}

}  // namespace
}  // namespace tesserae::render
