// SPDX-License-Identifier: Apache-2.0
#include "core/convex/hull.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/convex/qhull_facets.hpp"
#include "core/error.hpp"

namespace tesserae {
namespace {

/// A point farther out than this part of the size was left out by Qhull.
constexpr double kComplete = 1e-6;

using Indices = std::vector<std::uint16_t>;

Indices shared(const Indices& a, const Indices& b) {
    Indices both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return both;
}

/// Orthonormal directions that points span from the first of them, the farthest first: as many as
/// leave the rest by more than the tolerance.
struct Span {
    std::array<Vec4, 4> direction;
    std::size_t dimension = 0;

    Span(const std::vector<Vec4>& points, const Indices& some, std::size_t most, double tolerance) {
        std::vector<Vec4> rest;
        for (const std::uint16_t i : some) rest.push_back(points[i] - points[some[0]]);
        while (dimension < most) {
            const auto farthest = std::max_element(
                rest.begin(), rest.end(),
                [](const Vec4& a, const Vec4& b) { return a.squaredNorm() < b.squaredNorm(); });
            if (!(farthest->norm() > tolerance)) return;
            const Vec4 unit = across(farthest->normalized()).normalized();
            for (Vec4& r : rest) r -= unit.dot(r) * unit;
            direction[dimension++] = unit;
        }
    }
    /// What is orthogonal to all of them.
    Vec4 across(Vec4 v) const {
        for (std::size_t k = 0; k < dimension; ++k) v -= direction[k].dot(v) * direction[k];
        return v;
    }
};

/// The unit vector orthogonal to three orthonormal ones.
Vec4 orthogonal_to(const Span& span) {
    Vec4 best = Vec4::Zero();
    for (int axis = 0; axis < 4; ++axis) {
        const Vec4 v = span.across(Vec4::Unit(axis));
        if (v.squaredNorm() > best.squaredNorm()) best = v;
    }
    return span.across(span.across(best.normalized()).normalized()).normalized();
}

/// The first of each group of points that are about equal, about their mean, in parts of the
/// largest distance from it.
struct Reduced {
    std::vector<Vec4> points;
    Vec4 mean = Vec4::Zero();
    double size = 0;

    explicit Reduced(std::span<const Vec4> given) {
        // In parts of the count: a sum of huge ones stays finite.
        for (const Vec4& p : given) mean += p / static_cast<double>(given.size());
        for (const Vec4& p : given) size = std::max(size, stable_norm(p - mean));
        if (!(size > 0)) {
            if (!given.empty()) points.push_back(Vec4::Zero());
            return;
        }
        std::vector<std::size_t> by_x(given.size());
        for (std::size_t i = 0; i < by_x.size(); ++i) by_x[i] = i;
        std::sort(by_x.begin(), by_x.end(), [&](std::size_t i, std::size_t j) {
            return given[i][0] != given[j][0] ? given[i][0] < given[j][0] : i < j;
        });
        const double near = kHullAccuracy * size;
        std::vector<bool> is_twin(given.size());
        for (std::size_t i = 0; i < by_x.size(); ++i)
            for (std::size_t j = i + 1; j < by_x.size(); ++j) {
                const Vec4 &a = given[by_x[i]], &b = given[by_x[j]];
                if (b[0] - a[0] > near) break;
                if (stable_norm(b - a) <= near) is_twin[std::max(by_x[i], by_x[j])] = true;
            }
        for (std::size_t i = 0; i < given.size(); ++i)
            if (!is_twin[i]) points.push_back((given[i] - mean) / size);
    }
};

constexpr const char* kNoContent =
    "the points lie in one three-dimensional space, or nearly: the body has no content";

void require(bool condition, const std::string& message) {
    if (!condition) throw InputError(message);
}

/// Cells by their vertices, from planes of which several may be about the same.
std::vector<HullCell> cells_of(const std::vector<Vec4>& vertices,
                               const std::vector<HalfSpace>& planes) {
    std::set<Indices> all;
    for (const HalfSpace& plane : planes) {
        Indices on;
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (std::abs(plane.normal.dot(vertices[i]) - plane.offset) <= kHullAccuracy)
                on.push_back(static_cast<std::uint16_t>(i));
        all.insert(std::move(on));
    }
    std::vector<HullCell> cells;
    for (const Indices& on : all) {
        // The plane of a sliver may hold a part of a cell's vertices only.
        const bool is_part = std::any_of(all.begin(), all.end(), [&](const Indices& other) {
            return other.size() > on.size() && shared(on, other).size() == on.size();
        });
        const Span span(vertices, on, 3, kHullAccuracy);
        if (is_part || span.dimension < 3) continue;
        HullCell cell;
        cell.vertices = on;
        cell.plane.normal = orthogonal_to(span);
        double offset = 0;
        for (const std::uint16_t i : on) offset += cell.plane.normal.dot(vertices[i]);
        if (offset < 0) offset = -offset, cell.plane.normal = -cell.plane.normal;
        cell.plane.offset = offset / static_cast<double>(on.size());
        cells.push_back(std::move(cell));
    }
    return cells;
}

/// A face between two cells.
struct Ridge {
    Indices vertices;
    std::size_t cell;  ///< across it
};

std::vector<Ridge> ridges_of(const std::vector<Vec4>& vertices, const std::vector<HullCell>& cells,
                             const std::vector<std::vector<std::size_t>>& cells_at,
                             std::size_t cell) {
    std::vector<std::size_t> near;
    for (const std::uint16_t v : cells[cell].vertices)
        near.insert(near.end(), cells_at[v].begin(), cells_at[v].end());
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    std::vector<Ridge> ridges;
    for (const std::size_t other : near) {
        if (other == cell) continue;
        Ridge ridge{shared(cells[cell].vertices, cells[other].vertices), other};
        if (ridge.vertices.size() < 3) continue;
        if (Span(vertices, ridge.vertices, 2, kHullAccuracy).dimension == 2)
            ridges.push_back(std::move(ridge));
    }
    return ridges;
}

/// The two of collinear vertices that are farthest apart.
std::array<std::uint16_t, 2> ends_of(const std::vector<Vec4>& vertices, const Indices& on) {
    std::array<std::uint16_t, 2> ends = {on[0], on[1]};
    for (const std::uint16_t a : on)
        for (const std::uint16_t b : on)
            if (a < b && (vertices[a] - vertices[b]).squaredNorm() >
                             (vertices[ends[0]] - vertices[ends[1]]).squaredNorm())
                ends = {a, b};
    return ends;
}

Vec4 mean_of(const std::vector<Vec4>& vertices, const Indices& some) {
    Vec4 sum = Vec4::Zero();
    for (const std::uint16_t i : some) sum += vertices[i];
    return sum / static_cast<double>(some.size());
}

/// Content and moments of simplices with a corner at the origin.
struct Integrals {
    double content = 0;
    Vec4 first = Vec4::Zero();   ///< integral of x
    Mat4 second = Mat4::Zero();  ///< integral of x x^T

    void add(const Mat4& corners) {
        const double volume = std::abs(corners.determinant()) / 24;
        const Vec4 sum = corners.rowwise().sum();
        content += volume;
        first += volume / 5 * sum;
        second += volume / 30 * (corners * corners.transpose() + sum * sum.transpose());
    }
};

/// Sides and edges of every cell, and the hull's integrals about the origin.
Integrals connect(const std::vector<Vec4>& vertices, std::vector<HullCell>& cells) {
    std::vector<std::vector<std::size_t>> cells_at(vertices.size());
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (const std::uint16_t v : cells[c].vertices) cells_at[v].push_back(c);
    Integrals integrals;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        HullCell& cell = cells[c];
        const Vec4 middle = mean_of(vertices, cell.vertices), &n = cell.plane.normal;
        const std::vector<Ridge> ridges = ridges_of(vertices, cells, cells_at, c);
        std::set<std::array<std::uint16_t, 2>> edges;
        for (const Ridge& ridge : ridges) {
            const Vec4 centre = mean_of(vertices, ridge.vertices);
            const Vec4& across = cells[ridge.cell].plane.normal;
            const Vec4 side = (across - across.dot(n) * n).normalized();
            cell.sides.push_back({side, side.dot(centre)});
            for (const Ridge& other : ridges) {
                const Indices both = shared(ridge.vertices, other.vertices);
                if (&other == &ridge || both.size() < 2) continue;
                const auto ends = ends_of(vertices, both);
                edges.insert(ends);
                Mat4 corners;
                corners << middle, centre, vertices[ends[0]], vertices[ends[1]];
                integrals.add(corners);
            }
        }
        const auto place = [&](std::uint16_t vertex) {
            const auto found = std::lower_bound(cell.vertices.begin(), cell.vertices.end(), vertex);
            return static_cast<std::uint16_t>(found - cell.vertices.begin());
        };
        for (const auto& [from, to] : edges) cell.edges.push_back({place(from), place(to)});
    }
    return integrals;
}

/// Moves the origin.
void shift(const Vec4& to, std::vector<Vec4>& vertices, std::vector<HullCell>& cells) {
    for (Vec4& v : vertices) v -= to;
    for (HullCell& cell : cells) {
        cell.plane.offset -= cell.plane.normal.dot(to);
        for (HalfSpace& side : cell.sides) side.offset -= side.normal.dot(to);
    }
}

}  // namespace

Hull hull_of(std::span<const Vec4> points) {
    require(points.size() <= kMostPoints,
            fmt::format("{} points; at most {} are allowed", points.size(), kMostPoints));
    Reduced reduced(points);
    require(reduced.points.size() >= 5,
            fmt::format("{} different points; a body in four dimensions has at least 5",
                        reduced.points.size()));
    const QhullFacets facets = qhull_facets(reduced.points);
    require(!facets.planes.empty(), kNoContent);
    Hull hull;
    for (const std::size_t i : facets.vertices) hull.vertices.push_back(reduced.points[i]);
    require(hull.vertices.size() <= kMostVertices,
            fmt::format("the hull has more than {} vertices, which is too many", kMostVertices));
    // Planes of slivers come on top.
    const bool are_few = facets.planes.size() <= 2 * kMostCells;
    if (are_few) hull.cells = cells_of(hull.vertices, facets.planes);
    require(
        are_few && hull.cells.size() <= kMostCells,
        fmt::format("the hull has more than {} cells, which is too many (points that should lie "
                    "in one cell do so to {} of the size, or split it)",
                    kMostCells, kHullAccuracy));
    for (const HullCell& cell : hull.cells)
        for (const Vec4& point : reduced.points)
            require(cell.plane.normal.dot(point) - cell.plane.offset <= kComplete,
                    "the hull has too many vertices");

    const Integrals about_mean = connect(hull.vertices, hull.cells);
    // Of what is a hair thicker than Qhull takes for flat, cells may be one to our accuracy.
    require(about_mean.content > 0, kNoContent);
    const Vec4 centre = about_mean.first / about_mean.content;
    const double size = reduced.size;
    shift(centre, hull.vertices, hull.cells);
    for (Vec4& v : hull.vertices) v *= size;
    for (HullCell& cell : hull.cells) {
        cell.plane.offset *= size;
        for (HalfSpace& side : cell.sides) side.offset *= size;
    }
    const double square = size * size;
    hull.content = about_mean.content * square * square;
    hull.size = size;
    hull.mean_square = about_mean.second / about_mean.content - centre * centre.transpose();
    return hull;
}

}  // namespace tesserae
