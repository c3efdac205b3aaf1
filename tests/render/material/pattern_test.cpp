// SPDX-License-Identifier: Apache-2.0
#include "render/material/pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/algebra/rotor.hpp"
#include "render/tint.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

Material material_of(Pattern pattern) {
    Material m;
    m.pattern = pattern;
    m.albedo = {0.9, 0.6, 0.3};
    m.pattern_albedo = {0.1, 0.2, 0.3};
    return m;
}

/// A point of a box's surface, and the axis of its cell.
Vec4 on_box(Random& random, const Vec4& half, int axis, double side) {
    Vec4 point;
    for (int i = 0; i < 4; ++i) point[i] = uniform(random, -half[i], half[i]);
    point[axis] = side * half[axis];
    return point;
}

TEST(PatternEdges, OfABoxAreWhereTheNextCellIsNear) {
    Random random(1);
    Material m = material_of(Pattern::kEdges);
    m.line_width = 0.2;
    const Vec4 half = {0.5, 0.8, 1.1, 0.3};
    const Shape box = Hyperbox{2 * half};
    for (int i = 0; i < 1000; ++i) {
        const int axis = i % 4;
        const double side = i % 8 < 4 ? 1 : -1;
        const Vec4 at = on_box(random, half, axis, side);
        bool is_line = false;
        for (int other = 0; other < 4; ++other)
            is_line |= other != axis && half[other] - std::abs(at[other]) < 0.1;
        const Color c = pattern_albedo(m, {box, at, side * Vec4::Unit(axis), 0, 0});
        EXPECT_TRUE((c == (is_line ? m.pattern_albedo : m.albedo)).all()) << i;
        EXPECT_EQ(cell_number(box, side * Vec4::Unit(axis)), 2 * axis + (side > 0 ? 1 : 0));
    }
}

/// The distance along the own cell, by walking: the nearest boundary over many directions in it.
TEST(PatternEdges, OfPolytopesAreAsFarAsAWalkAlongTheCellTakes) {
    Random random(2);
    for (const auto regular : {RegularPolychoron::k5Cell, RegularPolychoron::k8Cell,
                               RegularPolychoron::k16Cell, RegularPolychoron::k24Cell}) {
        Polychoron polychoron;
        polychoron.regular = regular;
        polychoron.radius = 1.3;
        complete(polychoron);
        const Hull& hull = polychoron.body->hull;
        const Shape shape = polychoron;
        for (int round = 0; round < 20; ++round) {
            const auto own = static_cast<std::size_t>(random() % hull.cells.size());
            const HullCell& cell = hull.cells[own];
            Vec4 at = Vec4::Zero();
            double sum = 0;
            for (const auto v : cell.vertices) {
                const double weight = uniform(random, 0.05, 1);
                at += weight * hull.vertices[v], sum += weight;
            }
            at /= sum;
            double walk = kMiss;
            for (int i = 0; i < 4000; ++i) {
                Vec4 d = random_direction(random);
                d = (d - d.dot(cell.plane.normal) * cell.plane.normal).normalized();
                for (std::size_t other = 0; other < hull.cells.size(); ++other) {
                    const double slope = hull.cells[other].plane.normal.dot(d);
                    const double left =
                        hull.cells[other].plane.offset - hull.cells[other].plane.normal.dot(at);
                    if (other != own && slope > 1e-9) walk = std::min(walk, left / slope);
                }
            }
            const double found = distance_to_edge(shape, at, cell.plane.normal);
            EXPECT_LE(found, walk * (1 + 1e-12));
            EXPECT_GT(found, 0.97 * walk);
            EXPECT_EQ(cell_number(shape, cell.plane.normal), static_cast<int>(own));
        }
    }
}

TEST(PatternEdges, AndCellsLeaveOtherShapesPlain) {
    for (const Pattern pattern : {Pattern::kEdges, Pattern::kCells}) {
        const Material m = material_of(pattern);
        const Shape ball = Hypersphere{1};
        EXPECT_TRUE(
            (pattern_albedo(m, {ball, Vec4::UnitX(), Vec4::UnitX(), 0, 0}) == m.albedo).all());
    }
}

TEST(PatternCells, HaveColoursThatCanBeToldApart) {
    Material m = material_of(Pattern::kCells);
    m.albedo = Color::Ones();
    const Shape box = Hyperbox{Vec4::Ones()};
    std::vector<Color> colors;
    for (int axis = 0; axis < 4; ++axis)
        for (const double side : {-1.0, 1.0})
            colors.push_back(pattern_albedo(
                m, {box, 0.5 * side * Vec4::Unit(axis), side * Vec4::Unit(axis), 0, 0}));
    for (std::size_t i = 0; i < colors.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GT((colors[i] - colors[j]).abs().maxCoeff(), 0.15) << i << " " << j;
}

TEST(PatternGrid, HasLinesOfItsWidthOnAnySurface) {
    // Along a line in the surface the share of line is width over the distance between lines.
    Random random(4);
    Material m = material_of(Pattern::kGrid);
    m.pattern_size = 0.5, m.line_width = 0.05;
    for (int round = 0; round < 50; ++round) {
        const double angle = uniform(random, 0, 1.5);
        const Vec4 normal(std::cos(angle), std::sin(angle), 0, 0);
        const Vec4 along(-std::sin(angle), std::cos(angle), 0, 0);
        const Shape plane = Hyperplane{normal, 0.123};
        int lines = 0, expected = 0;
        for (int i = 0; i < 2000; ++i) {
            const double s = 0.01 * i;
            const Vec4 at = 0.123 * normal + s * along + Vec4(0, 0, 0.2, 0.2);
            lines += (pattern_albedo(m, {plane, at, normal, 0, 0}) == m.pattern_albedo).all();
            // The grid's own origin is the plane's point nearest to the world's.
            bool is_line = false;
            for (int axis = 0; axis < 2; ++axis) {
                const double step = m.pattern_size / std::abs(along[axis]);
                const double off = s - step * std::round(s / step);
                is_line |= std::abs(off) < 0.5 * m.line_width;
            }
            expected += is_line;
        }
        EXPECT_NEAR(lines, expected, 2) << angle;
    }
    // A face that lies in a hyperplane of the grid is no line.
    const Shape box = Hyperbox{Vec4::Ones()};
    EXPECT_TRUE(
        (pattern_albedo(m, {box, {0.5, 0.1, 0.1, 0.1}, Vec4::UnitX(), 0, 0}) == m.albedo).all());
}

TEST(PatternNoise, IsSmoothAndTakesBothColours) {
    Random random(5);
    Material m = material_of(Pattern::kNoise);
    m.albedo.setZero(), m.pattern_albedo.setOnes();
    double low = 1, high = 0, sum = 0;
    for (int i = 0; i < 5000; ++i) {
        const Vec4 at = random_vector(random, 50);
        const double value = colour_in_space(m, at)[0];
        low = std::min(low, value), high = std::max(high, value), sum += value;
        const double beside = colour_in_space(m, at + 1e-5 * random_direction(random))[0];
        EXPECT_NEAR(beside, value, 1e-3);
    }
    EXPECT_LT(low, 0.05);
    EXPECT_GT(high, 0.95);
    EXPECT_NEAR(sum / 5000, 0.5, 0.03);
    EXPECT_TRUE(colour_in_space(m, Vec4::Constant(1e300)).isFinite().all());
}

TEST(PatternW, GoesFromBlueThroughWhiteToOrange) {
    Material m = material_of(Pattern::kW);
    m.pattern_size = 2;
    const Shape ball = Hypersphere{1};
    const auto at = [&](double w, double body_w) {
        return Color(pattern_albedo(m, {ball, Vec4::UnitX(), Vec4::UnitX(), w, body_w}));
    };
    EXPECT_TRUE((at(0, 9) == m.albedo).all());
    EXPECT_TRUE(at(2, 0).isApprox(m.albedo * kSideColors[1]));
    EXPECT_TRUE(at(-7, 0).isApprox(m.albedo * kSideColors[0]));
    EXPECT_TRUE(at(1, 0).isApprox(m.albedo * (0.5 + 0.5 * kSideColors[1])));
    m.w_of = WOf::kBody;
    EXPECT_TRUE(at(9, -2).isApprox(m.albedo * kSideColors[0]));
}

/// Bodies that stand, and those that a ray meets while they move, at their own time.
TEST(PatternW, OfAPictureIsTheWorldsWhereverTheCameraIs) {
    Random random(6);
    for (const WOf of : {WOf::kPoint, WOf::kBody}) {
        TestScene scene;
        scene.materials[0] = material_of(Pattern::kW);
        scene.materials[0].albedo.setOnes();
        scene.materials[0].pattern_size = 3;
        scene.materials[0].w_of = of;
        scene.camera = random_camera(random, 7);
        scene.camera.position[3] += 2;
        for (int i = 0; i < 12; ++i)
            scene.add(random_shape(random, i % kShapeKinds, 1), random_vector(random, 2),
                      random_rotor(random));
        scene.settings.samples = 1;
        scene.settings.width = 40, scene.settings.height = 30;
        scene.settings.channels.position = true;
        const Image image = picture_of(scene);
        int seen = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (image.id(x, y) == 0) continue;
                const double w = of == WOf::kPoint ? image.at("P.W", x, y)
                                                   : scene.bodies.position[image.id(x, y) - 1][3];
                const double part = std::clamp(w / 3, -1.0, 1.0);
                const Color expected = 1 + std::abs(part) * (kSideColors[part > 0 ? 1 : 0] - 1);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(image.at(std::string("albedo.") + "RGB"[c], x, y), expected[c],
                                1e-3);
                ++seen;
            }
        EXPECT_GT(seen, 50);
    }
}

TEST(Hue, TurnsKeepBrightnessAndSaturation) {
    Random random(7);
    for (int i = 0; i < 1000; ++i) {
        const Color c(uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1));
        const double turn = uniform(random, -1, 1);
        const Color turned = turned_hue(c, turn);
        EXPECT_NEAR(turned.maxCoeff(), c.maxCoeff(), 1e-12);
        EXPECT_NEAR(turned.minCoeff(), c.minCoeff(), 1e-12);
        EXPECT_TRUE(turned_hue(turned, -turn).isApprox(c, 1e-9));
        EXPECT_TRUE(turned_hue(c, 1).isApprox(c, 1e-9));
        // A third of the circle exchanges the channels.
        EXPECT_TRUE(turned_hue(c, 1 / 3.0).isApprox(Color(c[2], c[0], c[1]), 1e-9));
    }
    double low = 1, high = -1;
    for (BodyId id = 0; id < 2000; ++id) {
        const double turn = hue_turn_of(id, 0.3);
        low = std::min(low, turn), high = std::max(high, turn);
    }
    EXPECT_NEAR(low, -0.15, 0.001);
    EXPECT_NEAR(high, 0.15, 0.001);
}

}  // namespace
}  // namespace tesserae::render
