// SPDX-License-Identifier: Apache-2.0
#include "core/contact/cell_clipping.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "tests/core/contact/box_oracle.hpp"

namespace tesserae {
namespace {

using namespace box_oracle;
using Vec3 = Eigen::Vector3d;

/// A pair whose best cell is one of a's, and what is clipped under it.
struct Clip {
    Two two;
    BoxPair pair;
    CellAxis axis;
    BoxPoints points;

    explicit Clip(Random& random, double spread) {
        do {
            two = random_two(random, spread);
            pair = pair_of(two);
            SeparatingAxes axes;
            find_separating_axes(pair, INFINITY, axes);
            axis = axes.cell_a;
            clip_cell(pair, axis, INFINITY, points);
        } while (points.count < 4);
    }
    Vec3 seen(const Vec4& v) const {
        Vec3 s;
        for (int k = 0, at = 0; k < 4; ++k)
            if (k != axis.axis) s[at++] = v[k];
        return s;
    }
};

/// The incident cell of b: the one that faces a's most, and its half-spaces in the three dimensions
/// seen along a's normal: |normal . (x - centre)| <= 1, and a's own sides.
struct Solid {
    Vec3 centre;
    Eigen::Matrix3d edges, inverse;
    Vec3 half;

    explicit Solid(const Clip& clip) {
        const BoxPair& p = clip.pair;
        int facing = 0;
        for (int j = 1; j < 4; ++j)
            if (std::abs(p.rotation(clip.axis.axis, j)) >
                std::abs(p.rotation(clip.axis.axis, facing)))
                facing = j;
        const bool up = p.offset[clip.axis.axis] >= 0;
        const bool along = p.rotation(clip.axis.axis, facing) > 0;
        const double side = up == along ? -1 : 1;
        centre = clip.seen(p.offset + side * p.half_b[facing] * p.rotation.col(facing));
        for (int j = 0, at = 0; j < 4; ++j)
            if (j != facing) edges.col(at++) = p.half_b[j] * clip.seen(p.rotation.col(j));
        inverse = edges.inverse();
        half = clip.seen(p.half_a);
    }
    bool has(const Vec3& x, double slack = 0) const {
        return (x.cwiseAbs() - half).maxCoeff() <= slack &&
               (inverse * (x - centre)).cwiseAbs().maxCoeff() <= 1 + slack;
    }
    /// The half-spaces n . x <= d.
    std::vector<std::pair<Vec3, double>> half_spaces() const {
        std::vector<std::pair<Vec3, double>> all;
        for (int k = 0; k < 3; ++k)
            for (const double side : {-1.0, 1.0}) {
                all.push_back({side * Vec3::Unit(k), half[k]});
                const Vec3 n = side * inverse.row(k).transpose();
                all.push_back({n, 1 + n.dot(centre)});
            }
        return all;
    }
};

/// Volume of the convex hull: for each plane through three points with all others on one side, the
/// cone from the centre over the polygon of the points on it, as a fan sorted by angle.
double hull_volume(const std::vector<Vec3>& points) {
    Vec3 centre = Vec3::Zero();
    for (const Vec3& p : points) centre += p / static_cast<double>(points.size());
    std::vector<std::pair<Vec3, double>> done;
    double volume = 0;
    for (const Vec3& a : points)
        for (const Vec3& b : points)
            for (const Vec3& c : points) {
                Vec3 n = (b - a).cross(c - a);
                if (n.norm() < 1e-9) continue;
                n.normalize();
                const double d = n.dot(a);
                bool is_outer = true, is_new = true;
                for (const Vec3& p : points) is_outer = is_outer && n.dot(p) <= d + 1e-9;
                if (!is_outer) continue;
                for (const auto& [m, e] : done)
                    is_new = is_new && ((m - n).norm() > 1e-6 || std::abs(d - e) > 1e-6);
                if (!is_new) continue;
                done.push_back({n, d});
                const Vec3 u = (b - a).normalized(), v = n.cross(u);
                Vec3 middle = Vec3::Zero();
                std::vector<Vec3> on;
                for (const Vec3& p : points)
                    if (std::abs(n.dot(p) - d) < 1e-8) on.push_back(p), middle += p;
                middle /= static_cast<double>(on.size());
                const auto angle = [&](const Vec3& p) {
                    return std::atan2(v.dot(p - middle), u.dot(p - middle));
                };
                std::sort(on.begin(), on.end(),
                          [&](const Vec3& p, const Vec3& q) { return angle(p) < angle(q); });
                double area = 0;
                for (std::size_t i = 0; i < on.size(); ++i)
                    area += 0.5 * n.dot((on[i] - middle).cross(on[(i + 1) % on.size()] - middle));
                volume += area * (d - n.dot(centre)) / 3;
            }
    return volume;
}

std::vector<Vec3> seen_points(const Clip& clip) {
    std::vector<Vec3> all;
    for (int i = 0; i < clip.points.count; ++i) all.push_back(clip.seen(clip.points.point[i].on_b));
    return all;
}

/// The vertices of the solid another way: every three of the twelve planes, kept if in all others.
std::vector<Vec3> vertices_of(const Solid& solid) {
    const auto planes = solid.half_spaces();
    std::vector<Vec3> all;
    for (std::size_t i = 0; i < 12; ++i)
        for (std::size_t j = i + 1; j < 12; ++j)
            for (std::size_t k = j + 1; k < 12; ++k) {
                Eigen::Matrix3d m;
                m << planes[i].first.normalized().transpose(),
                    planes[j].first.normalized().transpose(),
                    planes[k].first.normalized().transpose();
                if (std::abs(m.determinant()) < 1e-9) continue;
                const Vec3 d(planes[i].second / planes[i].first.norm(),
                             planes[j].second / planes[j].first.norm(),
                             planes[k].second / planes[k].first.norm());
                const Vec3 x = m.inverse() * d;
                if (solid.has(x, 1e-9)) all.push_back(x);
            }
    return all;
}

TEST(CellClipping, GivesTheVerticesOfTheHalfSpacesIntersection) {
    Random random(21);
    for (int i = 0; i < 1000; ++i) {
        const Clip clip(random, 0.9);
        const std::vector<Vec3> found = seen_points(clip), expected = vertices_of(Solid(clip));
        // Both ways: nothing is missing, nothing is too much. Three planes that are 1e-3 from
        // dependent amplify rounding to 1e-12.
        for (const auto& [these, those] : {std::pair{found, expected}, std::pair{expected, found}})
            for (const Vec3& x : these) {
                double nearest = INFINITY;
                for (const Vec3& y : those) nearest = std::min(nearest, (x - y).norm());
                ASSERT_LT(nearest, 1e-8) << i;
            }
    }
}

TEST(CellClipping, GivesTheVolumeOfMonteCarlo) {
    Random random(22);
    int far_off = 0;
    const int solids = 100, samples = 4000;
    for (int i = 0; i < solids; ++i) {
        const Clip clip(random, 0.7);
        const Solid solid(clip);
        // Samples in the incident cell: the fraction inside a's sides is binomial.
        const double cell = 8 * std::abs(solid.edges.determinant());
        const double share = hull_volume(seen_points(clip)) / cell;
        int inside = 0;
        for (int k = 0; k < samples; ++k) {
            const Vec3 t(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            inside += solid.has(solid.centre + solid.edges * t, 1e-12) ? 1 : 0;
        }
        const double sigma = std::sqrt(std::max(share * (1 - share), 1.0 / samples) / samples);
        const double error = std::abs(inside / double(samples) - share) / sigma;
        EXPECT_LT(error, 5) << i;  // 1 in 1.7 million each
        far_off += error > 2 ? 1 : 0;
    }
    EXPECT_LT(far_off, 16);  // 4.6 expected, sigma 2.1
}

TEST(CellClipping, GivesPointsOnTheFacesThatNameThem) {
    Random random(23);
    for (int i = 0; i < 2000; ++i) {
        const Clip clip(random, 1);
        for (int k = 0; k < clip.points.count; ++k) {
            const BoxPoint& p = clip.points.point[k];
            const Vec4 on_a = p.on_b - p.separation * clip.points.normal;
            const Vec4 in_b = clip.pair.rotation.transpose() * (p.on_b - clip.pair.offset);
            int dimension = 8;
            for (int j = 0; j < 4; ++j) {
                dimension -= (p.face_a[j] != 0) + (p.face_b[j] != 0);
                if (p.face_a[j] != 0) {
                    EXPECT_NEAR(on_a[j], p.face_a[j] * clip.pair.half_a[j], 1e-14);
                }
                if (p.face_b[j] != 0) {
                    EXPECT_NEAR(in_b[j], p.face_b[j] * clip.pair.half_b[j], 1e-14);
                }
            }
            EXPECT_EQ(dimension, 3);
            for (int j = 0; j < k; ++j) {
                const BoxPoint& other = clip.points.point[j];
                EXPECT_FALSE(p.face_a == other.face_a && p.face_b == other.face_b);
            }
        }
    }
}

TEST(CellClipping, KeepsVerticesOnClipPlanes) {
    Two two;  // equal cubes, one on the other: every vertex is on three planes
    two.b.position = {0, 1, 0, 0};
    const BoxPair pair = pair_of(two);
    BoxPoints points;
    clip_cell(pair, {1, 0}, 0, points);
    EXPECT_EQ(points.count, 8);
    two.b.position = {1, 1, 0, 0};  // they share a 2-face only
    clip_cell(pair_of(two), {1, 0}, 0, points);
    EXPECT_EQ(points.count, 4);
    two.b.position = {1, 1, 1, 1};  // and a vertex only
    clip_cell(pair_of(two), {1, 0}, 0, points);
    EXPECT_EQ(points.count, 1);
}

}  // namespace
}  // namespace tesserae
