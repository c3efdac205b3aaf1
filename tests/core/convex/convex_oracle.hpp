// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/convex/convex_separation.hpp"
#include "tests/core/contact/pair_sets.hpp"

// Separations of the hulls of point sets by other roads than Wolfe's and growing polytopes, in long
// double; and what is measured on any result.
namespace tesserae {

/// The hull of some points.
struct PointSet {
    std::vector<Vec4> points;

    Vec4 operator()(const Vec4& direction) const {
        const Vec4* farthest = &points[0];
        double most = direction.dot(points[0]);
        for (const Vec4& p : points)
            if (const double along = direction.dot(p); along > most) most = along, farthest = &p;
        return *farthest;
    }
    long double height(const LVec& n) const {
        long double most = n.dot(points[0].cast<long double>());
        for (const Vec4& p : points) most = std::max(most, n.dot(p.cast<long double>()));
        return most;
    }
    double radius() const {
        double most = 0;
        for (const Vec4& p : points) most = std::max(most, (p - centre()).norm());
        return most;
    }
    Vec4 centre() const {
        Vec4 sum = Vec4::Zero();
        for (const Vec4& p : points) sum += p;
        return sum / static_cast<double>(points.size());
    }
    PointSet moved(const Vec4& offset) const {
        PointSet result = *this;
        for (Vec4& p : result.points) p += offset;
        return result;
    }
};

/// The overlap along n: of a unit vector, what b must go along it to touch.
inline long double overlap_along(const PointSet& a, const PointSet& b, const LVec& n) {
    return (a.height(n) + b.height(-n)) / n.norm();
}

/// How far two hulls are apart, between bounds: weights move from the worst point to the best
/// (Mitchell, Demyanov, Malozemov 1974), which converges slowly but depends on no basis.
struct ApartBounds {
    long double low = -std::numeric_limits<long double>::infinity(), high = 0;

    ApartBounds(const PointSet& a, const PointSet& b, long double enough) {
        // The hull of all differences.
        std::vector<LVec> d;
        for (const Vec4& p : a.points)
            for (const Vec4& q : b.points)
                d.push_back(p.cast<long double>() - q.cast<long double>());
        std::vector<long double> weight(d.size(), 0);
        weight[0] = 1;
        LVec v = d[0];
        for (int round = 0; round < 4000; ++round) {
            high = v.norm();
            std::size_t best = 0, worst = d.size();
            for (std::size_t i = 0; i < d.size(); ++i) {
                if (v.dot(d[i]) < v.dot(d[best])) best = i;
                if (weight[i] > 0 && (worst == d.size() || v.dot(d[i]) > v.dot(d[worst])))
                    worst = i;
            }
            low = std::max(low, v.dot(d[best]) / high);
            if (high - low < enough) return;
            const LVec step = d[best] - d[worst];
            const long double length = step.squaredNorm();
            if (length == 0) return;
            const long double t = std::clamp(-v.dot(step) / length, 0.0L, weight[worst]);
            weight[best] += t;
            weight[worst] -= t;
            v += t * step;
        }
    }
};

/// The least overlap of two hulls of few points that meet: every facet of the difference is a sum
/// of faces of the two whose dimensions add up to 3, so its normal is orthogonal to the edges of a
/// choice of points. All choices are tried; those that are no facets have no smaller overlap.
inline long double least_overlap_of(const PointSet& a, const PointSet& b) {
    long double least = std::numeric_limits<long double>::infinity();
    const auto choices = [](std::size_t from, std::size_t take) {
        std::vector<std::vector<std::size_t>> all;
        for (std::size_t bits = 0; bits < std::size_t{1} << from; ++bits) {
            std::vector<std::size_t> one;
            for (std::size_t i = 0; i < from; ++i)
                if (bits >> i & 1) one.push_back(i);
            if (one.size() == take) all.push_back(one);
        }
        return all;
    };
    for (std::size_t edges = 0; edges <= 3; ++edges)
        for (const auto& of_a : choices(a.points.size(), edges + 1))
            for (const auto& of_b : choices(b.points.size(), 4 - edges)) {
                std::vector<LVec> e;
                for (std::size_t i = 1; i < of_a.size(); ++i)
                    e.push_back((a.points[of_a[i]] - a.points[of_a[0]]).cast<long double>());
                for (std::size_t i = 1; i < of_b.size(); ++i)
                    e.push_back((b.points[of_b[i]] - b.points[of_b[0]]).cast<long double>());
                const LVec n = orthogonal_to(e[0], e[1], e[2]);
                if (n.isZero(0)) continue;
                least = std::min({least, overlap_along(a, b, n), overlap_along(a, b, -n)});
            }
    return least;
}

/// The worst errors of a set of pairs, relative to the pair's size.
struct ConvexErrors {
    double distance = 0;  ///< against the truth, apart
    double overlap = 0;   ///< the same in overlap
    double gap = 0;       ///< against the gap along the normal
    double points = 0;    ///< of on_b - on_a against distance * normal
    double outside = 0;   ///< of either point from its body
    int pairs = 0, deep = 0;

    void print(const char* set) const {
        printf(
            "[ errors   ] %s, %d pairs, %d overlap: distance %.2g, overlap %.2g, gap %.2g, "
            "points %.2g, outside %.2g\n",
            set, pairs, deep, distance, overlap, gap, points, outside);
    }
    static void note(double& worst, long double error) {
        worst = std::max(worst, static_cast<double>(error));
    }
    void note_points(const ConvexSeparation& s, double size) {
        ++pairs;
        if (s.distance < 0) ++deep;
        ASSERT_TRUE(s.normal.allFinite() && std::isfinite(s.distance));
        ASSERT_TRUE(s.on_a.allFinite() && s.on_b.allFinite());
        ASSERT_NEAR(s.normal.norm(), 1, 1e-15);
        note(points, (s.on_b - s.on_a - s.distance * s.normal).norm() / size);
    }
};

/// The 24-cell whose corners are the permutations of (+-1, +-1, 0, 0), with the directions that
/// decide: of its edges, and the normals of its facets.
struct Cell24 {
    PointSet corners;
    std::vector<LVec> edges, normals;
    std::vector<std::pair<LVec, LVec>> triangles;

    Cell24(const Rotor& rotor, double scale, const Vec4& centre) {
        const Mat4 turn = scale * to_matrix(rotor);
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j)
                for (int signs = 0; signs < 4; ++signs) {
                    const Vec4 p =
                        (signs & 1 ? -1 : 1) * Vec4::Unit(i) + (signs & 2 ? -1 : 1) * Vec4::Unit(j);
                    corners.points.push_back(centre + turn * p);
                }
        // Corners sqrt(2) apart are joined, three joined ones are a face, and the 24 facets are
        // octahedra around the axes and the diagonals.
        const auto edge = [&](std::size_t i, std::size_t j) {
            return LVec((corners.points[j] - corners.points[i]).cast<long double>());
        };
        const auto joined = [&](std::size_t i, std::size_t j) {
            return std::abs(edge(i, j).norm() - scale * std::sqrt(2.0L)) < 1e-9 * scale;
        };
        for (std::size_t i = 0; i < 24; ++i)
            for (std::size_t j = i + 1; j < 24; ++j) {
                if (!joined(i, j)) continue;
                edges.push_back(edge(i, j));
                for (std::size_t k = j + 1; k < 24; ++k)
                    if (joined(i, k) && joined(j, k))
                        triangles.emplace_back(edge(i, j), edge(i, k));
            }
        for (int i = 0; i < 4; ++i) normals.push_back((turn * Vec4::Unit(i)).cast<long double>());
        for (int signs = 0; signs < 8; ++signs)
            normals.push_back(
                (turn * Vec4(1, signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, signs & 4 ? -1 : 1))
                    .cast<long double>());
    }
};

/// Facets of the difference of two polytopes are those of either, and sums of an edge of one and a
/// face of the other.
inline long double least_overlap_of(const Cell24& a, const Cell24& b) {
    long double least = std::numeric_limits<long double>::infinity();
    const auto note = [&](const LVec& n) {
        if (n.isZero(0)) return;
        least = std::min({least, overlap_along(a.corners, b.corners, n),
                          overlap_along(a.corners, b.corners, -n)});
    };
    for (const Cell24* of : {&a, &b})
        for (const LVec& n : of->normals) note(n);
    for (const auto& [p, q] : {std::pair(&a, &b), std::pair(&b, &a)})
        for (const LVec& e : p->edges)
            for (const auto& [u, v] : q->triangles) note(orthogonal_to(e, u, v));
    return least;
}

}  // namespace tesserae
