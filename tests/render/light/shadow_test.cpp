// SPDX-License-Identifier: Apache-2.0
#include "render/light/shadow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/camera/camera.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Sun sun_at(const Vec4& toward, double angle_degrees) {
    Sun sun;
    sun.direction = -toward;
    sun.angle = angle_degrees;
    return sun;
}

/// sin(theta - alpha) of a ball, from the angles themselves in long double.
double ball_rim(const Vec4& centre, double radius, const Vec4& direction) {
    long double d2 = 0, along = 0;
    for (int i = 0; i < 4; ++i) {
        d2 += static_cast<long double>(centre[i]) * centre[i];
        along += static_cast<long double>(centre[i]) * direction[i];
    }
    const long double d = std::sqrt(d2);
    const long double apart = std::acos(along / d) - std::asin(radius / d);
    return apart >= std::numbers::pi / 2 ? 1 : static_cast<double>(std::sin(apart));
}

TEST(RimSine, OfABallIsTheAngleToItsRim) {
    Random random(31);
    FrameStats stats;
    for (int i = 0; i < 5000; ++i) {
        const Vec4 centre = uniform(random, 1, 10) * random_direction(random);
        const double radius = uniform(random, 0.01, 0.99) * centre.norm();
        const Vec4 d = random_direction(random);
        TestScene scene;
        scene.add(Hypersphere{radius}, centre);
        const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
        // acos loses half of long double's digits at worst: 1e-9.
        EXPECT_NEAR(rim_sine(placed, 0, {Vec4::Zero(), d}, -1, 1, stats),
                    ball_rim(centre, radius, d), 1e-8);
    }
    EXPECT_EQ(stats.distance_evaluations, 0u);
}

TEST(RimSine, IsTheLeastRatioOfDistanceAlongTheRay) {
    // The definition, by a dense scan of t and golden section about its best sample.
    Random random(33);
    FrameStats stats;
    int inside_cone = 0;
    for (int i = 0; i < 3000; ++i) {
        const double widest = std::sin(uniform(random, 0.5, 30) * kDegree);
        TestScene scene;
        const Vec4 centre = uniform(random, 3, 10) * random_direction(random);
        scene.add(random_shape(random, 1 + i % 2, 1), centre, random_rotor(random));
        const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
        const Vec4 d = (centre + random_vector(random, 3)).normalized();
        const auto ratio = [&](double t) {
            const Vec4 p = placed.point_to_body(placed.bodies[0], t * d);
            return std::visit([&](const auto& s) { return signed_distance(s, p); },
                              scene.bodies.types[0].shape) /
                   t;
        };
        if (ratio(1e-9) <= 0) continue;
        double best = 0.01;
        for (double t = 0.01; t < 60; t *= 1.02)
            if (ratio(t) < ratio(best)) best = t;
        double a = best / 1.03, b = best * 1.03;
        for (int k = 0; k < 60; ++k) {
            const double u = a + 0.382 * (b - a), v = a + 0.618 * (b - a);
            (ratio(u) < ratio(v) ? b : a) = ratio(u) < ratio(v) ? v : u;
        }
        const double expected = std::min(ratio(a), ratio(best));
        const double found = rim_sine(placed, 0, {Vec4::Zero(), d}, -widest, widest, stats);
        if (std::abs(expected) < widest) {
            ++inside_cone;
            // Golden section on rounded values finds the least to rounding of distance/t.
            EXPECT_NEAR(found, expected, 1e-13) << i;
        } else {
            EXPECT_EQ(found > 0, expected > 0) << i;
            EXPECT_GE(std::abs(found), widest - 1e-13) << i;
        }
    }
    EXPECT_GT(inside_cone, 500);
}

TEST(RimSine, InsideAndBehind) {
    FrameStats stats;
    // Narrower than any of the bodies looks from 9 m.
    constexpr double kWidest = 0.01;
    const Vec4 x = Vec4::UnitX();
    for (int kind = 0; kind < 3; ++kind) {
        Random random(34);
        TestScene scene;
        scene.add(random_shape(random, kind, 1), Vec4::Zero());
        const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
        const auto sine = [&](const Vec4& origin, const Vec4& direction) {
            return rim_sine(placed, 0, {origin, direction}, -kWidest, kWidest, stats);
        };
        EXPECT_EQ(sine(Vec4::Zero(), x), -1);
        EXPECT_GE(sine(9 * x, x), kWidest);
        EXPECT_LE(sine(9 * x, -x), -kWidest);
    }
}

/// A point of the unit 3-ball.
Vec3 ball_point(Random& random) {
    for (;;) {
        const Vec3 p(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
        if (p.squaredNorm() <= 1) return p;
    }
}

TEST(VisiblePart, OfABallBeyondAPlane) {
    Random random(35);
    constexpr int kCount = 200000;
    for (double x : {-0.9, -0.5, 0.0, 0.3, 0.8}) {
        int clear = 0;
        for (int i = 0; i < kCount; ++i) clear += ball_point(random).x() < x;
        // Five standard deviations of a count.
        EXPECT_NEAR(static_cast<double>(clear) / kCount, visible_part(x),
                    5 * 0.5 / std::sqrt(kCount));
        const double s = 0.5 * (1 + x);
        EXPECT_NEAR(visible_part(x), s * s * (3 - 2 * s), 1e-15);
    }
    EXPECT_EQ(visible_part(-1.1), 0);
    EXPECT_EQ(visible_part(1.1), 1);
}

/// The visible part of a sun by rays: directions spread evenly over its cap of S^3.
template <class Blocked>
double visible_by_rays(Random& random, const Vec4& toward, double angle, int count,
                       const Blocked& blocked) {
    // Three axes across the sun's direction.
    Vec4 axes[3];
    for (int i = 0; i < 3; ++i) {
        axes[i] = random_direction(random);
        axes[i] -= axes[i].dot(toward) * toward;
        for (int k = 0; k < i; ++k) axes[i] -= axes[i].dot(axes[k]) * axes[k];
        axes[i].normalize();
    }
    int clear = 0;
    for (int i = 0; i < count;) {
        // The angle r from the middle has density sin^2 r, so r^2 from the ball is thinned.
        const Vec3 u = angle * ball_point(random);
        const double r = u.norm();
        if (r > 0 && uniform(random, 0, 1) > std::pow(std::sin(r) / r, 2)) continue;
        const Vec3 v = r > 0 ? Vec3(std::sin(r) / r * u) : u;
        clear +=
            !blocked(std::cos(r) * toward + v.x() * axes[0] + v.y() * axes[1] + v.z() * axes[2]);
        ++i;
    }
    return static_cast<double>(clear) / count;
}

TEST(SunVisibility, BehindAPlaneMatchesRays) {
    // A flat rim: only the disc's curvature, of relative size angle^2, is left out of the formula.
    Random random(36);
    constexpr int kCount = 40000;
    for (double angle : {1.0, 5.0, 10.0})
        for (double x : {-0.7, -0.2, 0.0, 0.4, 0.9}) {
            TestScene scene;
            scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
            const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
            const double height = x * angle * kDegree;
            const Vec4 toward(0.6 * std::cos(height), std::sin(height), 0, 0.8 * std::cos(height));
            FrameStats stats;
            const double visible =
                Shadows(placed, BodyTree(placed))
                    .visibility(sun_disc(sun_at(toward, angle)), Vec4::Zero(), kNoBody, stats);
            const double rays = visible_by_rays(random, toward, angle * kDegree, kCount,
                                                [](const Vec4& d) { return d.y() < 0; });
            EXPECT_NEAR(visible, rays, 5 * 0.5 / std::sqrt(kCount) + std::pow(angle * kDegree, 2))
                << angle << " " << x;
            EXPECT_NEAR(visible, visible_part(x), 1e-9);
        }
}

TEST(SunVisibility, BehindALargeSphereMatchesRays) {
    // The rim of a sphere seen under half-angle alpha bends away from a plane by cot(alpha) s^2/2
    // at distance s <= angle: at most angle cot(alpha)/2 in x, times the slope 3/4 of the formula.
    Random random(37);
    constexpr int kCount = 40000;
    for (double alpha : {20.0, 45.0, 70.0})
        for (double x : {-1.2, -0.6, 0.0, 0.5, 1.2}) {
            const double angle = 2 * kDegree;
            const double theta = alpha * kDegree + x * angle;
            const Vec4 toward(std::sin(theta), 0, 0, std::cos(theta));
            const Vec4 centre(0, 0, 0, 5);
            const double radius = 5 * std::sin(alpha * kDegree);
            TestScene scene;
            scene.add(Hypersphere{radius}, centre);
            const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
            FrameStats stats;
            const double visible =
                Shadows(placed, BodyTree(placed))
                    .visibility(sun_disc(sun_at(toward, 2)), Vec4::Zero(), kNoBody, stats);
            const double rays = visible_by_rays(random, toward, angle, kCount, [&](const Vec4& d) {
                return d.w() > std::cos(alpha * kDegree);
            });
            const double bend = 0.375 * angle / std::tan(alpha * kDegree);
            EXPECT_NEAR(visible, rays, 5 * 0.5 / std::sqrt(kCount) + bend) << alpha << " " << x;
        }
}

TEST(SunVisibility, OfASmallSphereIsItsRimsFormula) {
    // A sphere smaller than the sun, right before its middle: x = -alpha/angle.
    TestScene scene;
    scene.add(Hypersphere{0.05}, {0, 0, 0, 5});
    const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
    FrameStats stats;
    const double visible =
        Shadows(placed, BodyTree(placed))
            .visibility(sun_disc(sun_at(Vec4::UnitW(), 2)), Vec4::Zero(), kNoBody, stats);
    EXPECT_NEAR(visible, visible_part(-std::asin(0.01) / (2 * kDegree)), 1e-12);
}

TEST(RimSine, OfALimitedRayIsTheLeastRatioBeforeTheLimit) {
    // Against f(t)/t at 20000 points of the ray. Where the ratio falls with slope up to 1/t at the
    // limit, the last points are half a step from it.
    Random random(40);
    int cut = 0;
    for (int i = 0; i < 300; ++i) {
        TestScene scene;
        if (i % 4 == 3)
            scene.add(Hyperplane{random_direction(random), -1}, Vec4::Zero());
        else
            scene.add(random_shape(random, i % 4, 1), 4 * random_direction(random),
                      random_rotor(random));
        const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
        const Vec4 toward =
            (placed.bodies[0].centre + random_vector(random, 2) + 1e-3 * Vec4::UnitX())
                .normalized();
        const double limit = uniform(random, 0.5, 6);
        FrameStats stats;
        const double found =
            rim_sine(placed, 0, {Vec4::Zero(), toward, kNoBody, limit}, -1, 1, stats);
        const auto ratio = [&](double t) {
            return std::visit(
                       [&](const auto& s) {
                           return signed_distance(
                               s, placed.point_to_body(placed.bodies[0], t * toward));
                       },
                       *placed.bodies[0].shape) /
                   t;
        };
        double least = 1;
        constexpr int kPoints = 20000;
        for (int k = 1; k <= kPoints; ++k) least = std::min(least, ratio(limit * k / kPoints));
        // From inside, and beyond what is clear, only the side counts.
        if (ratio(1e-9) > 0) {
            EXPECT_NEAR(std::min(found, 1.0), least, 1e-4) << i;
        }
        cut += ratio(limit) == least && least < 0.99;
    }
    EXPECT_GT(cut, 50);
}

/// The bodies of these numbers only, the last one first.
PlacedBodies only(const PlacedBodies& placed, const std::vector<std::uint32_t>& bodies) {
    PlacedBodies some = placed;
    some.bodies.clear();
    for (auto b = bodies.rbegin(); b != bodies.rend(); ++b)
        some.bodies.push_back(placed.bodies[*b]);
    return some;
}

void expect_shadows_of_all_bodies(int points) {
    // Against the rims of all bodies, one by one: the least where a single body covers a part of
    // the disc, and where several do, the same bits without all other bodies and in another order.
    Random random(38);
    int partly = 0, hidden = 0, together = 0;
    for (int round = 0; round < 30; ++round) {
        TestScene scene;
        const int count = round < 10 ? round : 300;
        for (int i = 0; i < count; ++i)
            scene.add(random_shape(random, i % kShapeKinds, std::exp(uniform(random, -3, 0))),
                      random_vector(random, 4), random_rotor(random));
        if (round % 2 == 1) scene.add(Hyperplane{Vec4::UnitY(), -4}, Vec4::Zero());
        const PlacedBodies placed = place_bodies(scene.picture(), random_vector(random, 4));
        const BodyTree tree(placed);
        const Shadows shadows(placed, tree);
        for (int i = 0; i < points; ++i) {
            const Vec4 point = random_vector(random, 6);
            const double angle = i % 4 == 0 ? 0 : uniform(random, 0.1, 30);
            const SunDisc sun = sun_disc(sun_at(random_direction(random), angle));
            const auto on = static_cast<std::uint32_t>(i % 7);
            FrameStats stats;
            double least = 1;
            std::vector<std::uint32_t> covering;
            for (std::uint32_t b = 0; b < placed.bodies.size(); ++b)
                if (b != on) {
                    const double sine = rim_sine(placed, b, {point, sun.toward}, -1, 1, stats);
                    least = std::min(least, sine);
                    if (std::abs(sine) < sun.cone.sine) covering.push_back(b);
                }
            double expected = angle == 0 ? (least > 0) : visible_part(std::asin(least) / sun.angle);
            if (covering.size() > 1 && expected > 0) {
                const PlacedBodies some = only(placed, covering);
                const BodyTree few(some);
                const double bare = Shadows(some, few).visibility(sun, point, kNoBody, stats);
                EXPECT_EQ(shadows.visibility(sun, point, on, stats), bare) << round << " " << i;
                expected = bare;
                ++together;
            }
            // asin of the cone's own sine may round to just inside the cone.
            EXPECT_NEAR(shadows.visibility(sun, point, on, stats), expected, angle == 0 ? 0 : 1e-12)
                << round << " " << i;
            partly += expected > 0 && expected < 1;
            hidden += expected == 0;
        }
    }
    EXPECT_GT(partly, points * 5 / 4);
    EXPECT_GT(hidden, points * 5 / 4);
    EXPECT_GT(together, points / 2);
}
TEST(Shadows, TreeLosesNoBody) { expect_shadows_of_all_bodies(60); }
TEST(ShadowsSlow, TreeLosesNoBody) { expect_shadows_of_all_bodies(200); }

TEST(SunVisibility, OfSeveralBodiesMatchesRays) {
    // Balls and boxes that cover parts of the disc together. A body's outline as that of the ball
    // about it is what is left out for boxes, so that they are large here, and near.
    Random random(41);
    constexpr int kCount = 10000;
    int compared = 0;
    for (int round = 0; compared < 60; ++round) {
        const double angle = 3;
        const Vec4 toward = random_direction(random);
        TestScene scene;
        for (int i = 0; i < 3; ++i) {
            const Vec4 aside = 0.8 * random_direction(random);
            const Vec4 place = uniform(random, 1.5, 4) * toward + aside;
            if (round % 2 == 0)
                scene.add(Hypersphere{uniform(random, 0.1, 0.8)}, place);
            else
                scene.add(Hyperplane{-(aside - aside.dot(toward) * toward).normalized(),
                                     uniform(random, -0.12, 0.05)},
                          Vec4::Zero());
        }
        const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
        const Vec4 point = Vec4::Zero();
        const SunDisc sun = sun_disc(sun_at(toward, angle));
        FrameStats stats;
        int covering = 0, hiding = 0;
        for (std::uint32_t b = 0; b < 3; ++b) {
            const double sine = rim_sine(placed, b, {point, sun.toward}, -1, 1, stats);
            covering += std::abs(sine) < 0.5 * sun.cone.sine;
            hiding += sine <= -sun.cone.sine;
        }
        if (covering < 2 || hiding > 0) continue;
        ++compared;
        const double visible =
            Shadows(placed, BodyTree(placed)).visibility(sun, point, kNoBody, stats);
        const double rays =
            visible_by_rays(random, toward, angle * kDegree, kCount, [&](const Vec4& d) {
                return bool(nearest_of_all(placed, {point, d}, scene.settings, stats));
            });
        EXPECT_NEAR(visible, rays, 0.06 + 5 * 0.5 / std::sqrt(kCount)) << round;
    }
}

TEST(Shadows, SharedSurfacesAreLit) {
    // Bodies that lie in each other with one face or surface in common: points of it, off by
    // rounding to either side, are lit where the sun stands over the surface.
    Random random(39);
    for (int i = 0; i < 3000; ++i) {
        TestScene scene;
        const Vec4 centre = random_vector(random, 100);
        const Rotor rotor = random_rotor(random);
        const Mat4 turn = to_matrix(rotor);
        Vec4 point, normal;
        if (i % 3 == 0) {
            scene.add(Hyperbox{Vec4(2, 4, 6, 2)}, centre, rotor);
            point = turn * (random_vector(random, 0.9) + 2 * Vec4::UnitY());
            point += turn.col(1) * (2 - turn.col(1).dot(point));
            normal = turn.col(1);
        } else {
            normal = random_direction(random);
            point = 2 * normal;
            if (i % 3 == 1)
                scene.add(Hypersphere{2}, centre);
            else
                scene.add(Hypercapsule{2, 0}, centre, rotor);
        }
        point += centre + uniform(random, -1, 1) * 1e-13 * normal;
        const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
        Vec4 toward = random_direction(random);
        if (toward.dot(normal) < 0) toward = -toward;
        FrameStats stats;
        for (double angle : {0.0, 2.0}) {
            // A soft sun is whole from its own half-angle above the surface on.
            if (toward.dot(normal) < std::sin(2.1 * kDegree)) continue;
            EXPECT_EQ(Shadows(placed, BodyTree(placed))
                          .visibility(sun_disc(sun_at(toward, angle)), point, kNoBody, stats),
                      1)
                << i;
            EXPECT_EQ(Shadows(placed, BodyTree(placed))
                          .visibility(sun_disc(sun_at(-toward, angle)), point, kNoBody, stats),
                      0)
                << i;
        }
    }
}

TEST(Shadows, ThatLeaveTheSliceFindBodiesOutsideIt) {
    // The occluder is 3 m away along the fourth axis; the picture never shows it.
    TestScene scene;
    scene.add(Hypersphere{1}, {0, 0, 0, 3});
    const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
    const BodyTree tree(placed);
    const Shadows shadows(placed, tree);
    FrameStats stats;
    for (double angle : {0.0, 5.0}) {
        EXPECT_EQ(shadows.visibility(sun_disc(sun_at(Vec4::UnitW(), angle)), Vec4::Zero(), kNoBody,
                                     stats),
                  0);
        EXPECT_EQ(shadows.visibility(sun_disc(sun_at(-Vec4::UnitW(), angle)), Vec4::Zero(), kNoBody,
                                     stats),
                  1);
    }
}

}  // namespace
}  // namespace tesserae::render
