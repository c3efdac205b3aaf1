// SPDX-License-Identifier: Apache-2.0
#include "core/convex/hull.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.hpp"
#include "core/shape/polychoron.hpp"
#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

double edge_of(const Hull& hull) {
    const HullCell& cell = hull.cells[0];
    const auto& [from, to] = cell.edges[0];
    return (hull.vertices[cell.vertices[from]] - hull.vertices[cell.vertices[to]]).norm();
}

/// Coxeter, Regular Polytopes (1973), table I: numbers of vertices and cells, a cell's corners,
/// edges and faces; content for edge 1.
TEST(Hull, OfRegularPolychoraHasTheirElementsAndContent) {
    using enum RegularPolychoron;
    const double root = std::sqrt(5.0);
    struct Regular {
        RegularPolychoron which;
        std::size_t vertices, cells, corners, edges, faces;
        double content;
    };
    for (const Regular& r : {Regular{k5Cell, 5, 5, 4, 6, 4, root / 96},
                             {k8Cell, 16, 8, 8, 12, 6, 1},
                             {k16Cell, 8, 16, 4, 6, 4, 1 / 6.0},
                             {k24Cell, 24, 24, 6, 12, 8, 2},
                             {k120Cell, 600, 120, 20, 30, 12, 15 * (105 + 47 * root) / 4},
                             {k600Cell, 120, 600, 4, 6, 4, 25 * (2 + root) / 4}}) {
        const Hull hull = hull_of(regular_vertices(r.which));
        EXPECT_EQ(hull.vertices.size(), r.vertices);
        EXPECT_EQ(hull.cells.size(), r.cells);
        for (const HullCell& cell : hull.cells) {
            EXPECT_EQ(cell.vertices.size(), r.corners);
            EXPECT_EQ(cell.edges.size(), r.edges);
            EXPECT_EQ(cell.sides.size(), r.faces);
            EXPECT_NEAR(cell.plane.offset, hull.cells[0].plane.offset, 1e-15);
        }
        EXPECT_NEAR(hull.content / (r.content * std::pow(edge_of(hull), 4)), 1, 1e-12);
        const double mean = hull.mean_square.trace() / 4;
        EXPECT_LT((hull.mean_square - mean * Mat4::Identity()).cwiseAbs().maxCoeff(), 1e-14);
    }
}

/// Lowest along -y, as scenes/FORMATS.md says: a cell, a vertex or an edge.
TEST(Hull, OfRegularPolychoraStandAsTheyAreSaidTo) {
    using enum RegularPolychoron;
    const std::pair<RegularPolychoron, int> lowest[] = {
        {k5Cell, 2}, {k8Cell, 8}, {k16Cell, 1}, {k24Cell, 6}, {k120Cell, 20}, {k600Cell, 1}};
    for (const auto& [which, expected] : lowest) {
        const auto vertices = regular_vertices(which);
        double low = 1;
        for (const Vec4& v : vertices) low = std::min(low, v[1]);
        const auto count = std::count_if(vertices.begin(), vertices.end(),
                                         [&](const Vec4& v) { return v[1] < low + 1e-9; });
        EXPECT_EQ(count, expected) << int(which);
        for (const Vec4& v : vertices) EXPECT_NEAR(v.norm(), 1, 3e-16);
    }
}

TEST(Hull, IsTheSameHoweverItsPointsAreMovedScaledAndCrowded) {
    RandomGeometry random(31);
    for (int i = 0; i < 200; ++i) {
        std::vector<Vec4> points(static_cast<std::size_t>(random.uniform(5, 40)));
        for (Vec4& p : points) p = random.in_box(Vec4::Ones());
        const Hull hull = hull_of(points);
        std::vector<Vec4> other;
        const double scale = random.log_uniform(1e-6, 1e6);
        const Vec4 shift = scale * random.in_box(Vec4::Constant(10));
        for (const Vec4& p : points) other.push_back(scale * p + shift);
        // Inside, on an edge, twice.
        other.push_back(0.5 * (other[0] + other[1]));
        other.push_back(other[2]);
        const Hull moved = hull_of(other);
        EXPECT_EQ(moved.vertices.size(), hull.vertices.size());
        EXPECT_EQ(moved.cells.size(), hull.cells.size());
        EXPECT_NEAR(moved.content / (hull.content * std::pow(scale, 4)), 1, 1e-9);
        // About the centre of mass.
        EXPECT_LT((moved.vertices[0] / scale - hull.vertices[0]).norm(), 1e-12);
    }
}

/// Every point is behind every plane, every cell's vertices are on its plane and within its sides.
TEST(Hull, HoldsItsPoints) {
    RandomGeometry random(32);
    for (int i = 0; i < 100; ++i) {
        const Polychoron shape = random_shape<Polychoron>(random);
        const Hull& hull = shape.body->hull;
        const double error = 1e-13 * shape.body->radius;
        for (const HullCell& cell : hull.cells) {
            EXPECT_GT(cell.plane.offset, 0);
            for (const Vec4& v : hull.vertices)
                EXPECT_LE(cell.plane.normal.dot(v) - cell.plane.offset, error);
            for (const auto k : cell.vertices) {
                EXPECT_NEAR(cell.plane.normal.dot(hull.vertices[k]), cell.plane.offset, error);
                for (const HalfSpace& side : cell.sides)
                    EXPECT_LE(side.normal.dot(hull.vertices[k]) - side.offset, 10 * error);
            }
            // Euler's formula.
            EXPECT_EQ(cell.vertices.size() + cell.sides.size(), cell.edges.size() + 2);
        }
    }
}

std::string error_of_hull(const std::vector<Vec4>& points) {
    try {
        hull_of(points);
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

/// On a curve that is neighbourly: each pair of vertices has an edge.
std::vector<Vec4> neighbourly_points(int count) {
    std::vector<Vec4> curve;
    for (int i = 0; i < count; ++i) {
        const double t = 2 * std::numbers::pi * i / count;
        curve.emplace_back(std::cos(t), std::sin(t), std::cos(2 * t), std::sin(2 * t));
    }
    return curve;
}

TEST(Hull, RefusesWhatIsFlatOrTooMuch) {
    EXPECT_NE(error_of_hull({}).find("at least 5"), std::string::npos);
    EXPECT_NE(error_of_hull(std::vector<Vec4>(9, Vec4::Ones())).find("1 different"),
              std::string::npos);
    RandomGeometry random(33);
    std::vector<Vec4> flat(50), sphere;
    const Vec4 n = random.direction();
    for (Vec4& p : flat) {
        p = random.in_box(Vec4::Ones());
        p -= (n.dot(p) - 3) * n;
    }
    EXPECT_NE(error_of_hull(flat).find("three-dimensional"), std::string::npos);
    // Thicker than flat by what planes may differ and be one.
    const Vec4 hair(0, 1e-12, 0, 0);
    const std::vector<Vec4> thin = {{-1, -1, -1, 0.01},
                                    Vec4(-1, 0, 1, 0.01) + 0.5 * hair,
                                    Vec4(0, -1, 0, -0.01) + hair,
                                    {1, 0, 1, -0.01},
                                    {1, 1, 1, 0.01}};
    EXPECT_NE(error_of_hull(thin).find("three-dimensional"), std::string::npos);
    EXPECT_NE(error_of_hull(neighbourly_points(200)).find("cells, which is too many"),
              std::string::npos);
    EXPECT_NE(error_of_hull(neighbourly_points(10001)).find("10001 points"), std::string::npos);
    for (int i = 0; i < 3000; ++i) sphere.push_back(random.direction());
    EXPECT_NE(error_of_hull(sphere).find("too many"), std::string::npos);
}

/// 10^4 of these points have fifty million cells.
TEST(HullSlow, RefusesFiftyMillionCells) {
    EXPECT_NE(error_of_hull(neighbourly_points(10000)).find("too many"), std::string::npos);
}

}  // namespace
}  // namespace tesserae
