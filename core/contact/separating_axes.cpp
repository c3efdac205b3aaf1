// SPDX-License-Identifier: Apache-2.0
#include "core/contact/separating_axes.hpp"

#include <cmath>
#include <limits>

namespace tesserae {
namespace {

using Lanes = Eigen::Array4d;

/// The length below which an axis has no direction left to make unit. Longer ones are never wrong,
/// however near to degenerate: the gap along any unit direction is a valid bound. Skipping more
/// than this would be: a facet of two edges that are 1e-14 rad from parallel can be where plates of
/// aspect 10^4 have an overlap that differs by 1e-10 of their size.
constexpr double kNoDirection = 1e-100;

constexpr int kPlanes[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

/// The gaps along the axes of a 2-face of the box `face` and an edge of the other, for all four
/// edges at once. With p and q the axes on which the 2-face stands, in the face's frame the axis is
/// the edge's projection on that plane turned by 90 degrees, (edge_q, -edge_p), all else zero.
/// @param edge_p, edge_q  coordinates p and q of the four edges' directions
Lanes edge_gaps(int p, int q, const Vec4& half_face, const Vec4& half_edge, const Vec4& offset,
                const Lanes& edge_p, const Lanes& edge_q) {
    Lanes gap = (offset[p] * edge_q - offset[q] * edge_p).abs();
    gap -= half_face[p] * edge_q.abs() + half_face[q] * edge_p.abs();
    for (int m = 0; m < 4; ++m)  // an edge's product with itself is exactly 0
        gap -= half_edge[m] * (edge_p[m] * edge_q - edge_q[m] * edge_p).abs();
    const Lanes squared = edge_p.square() + edge_q.square();
    // Without a branch: where there is no direction left the gap is far below any other.
    constexpr double kLeast = kNoDirection * kNoDirection, kFarBelow = 1e307;
    return gap / squared.max(kLeast).sqrt() - kFarBelow * (kLeast - squared).max(0);
}

/// Edge axes with 2-faces of a (whose frame the arguments are in) or of b, best kept in `best`.
/// @param edges  column p: coordinate p of the four edges
bool find_edge_axis(bool face_of_b, const Vec4& half_face, const Vec4& half_edge,
                    const Vec4& offset, const Mat4& edges, double margin, EdgeAxis& best) {
    Lanes gaps[6];
    Lanes largest = Lanes::Constant(-std::numeric_limits<double>::infinity());
    for (int k = 0; k < 6; ++k) {
        const auto [p, q] = kPlanes[k];
        gaps[k] = edge_gaps(p, q, half_face, half_edge, offset, edges.col(p), edges.col(q));
        largest = largest.max(gaps[k]);
    }
    const double gap = largest.maxCoeff();
    if (gap > margin) {
        best.gap = gap;
        return false;
    }
    if (!(gap > best.gap)) return true;
    // Ties go to the first plane, then to the first edge.
    for (int k = 0; k < 6; ++k)
        for (int edge = 0; edge < 4; ++edge)
            if (gaps[k][edge] == gap) {
                best = {face_of_b, kPlanes[k][0], kPlanes[k][1], edge, gap};
                return true;
            }
    return true;
}

CellAxis largest_of(const Vec4& gaps) {
    CellAxis best;
    best.gap = gaps.maxCoeff(&best.axis);
    return best;
}

/// Of a 2-face of the pair's first box, in its frame.
Vec4 edge_normal(const BoxPair& pair, const EdgeAxis& axis) {
    Vec4 normal = Vec4::Zero();
    normal[axis.p] = pair.rotation(axis.q, axis.edge);
    normal[axis.q] = -pair.rotation(axis.p, axis.edge);
    normal /= std::hypot(normal[axis.p], normal[axis.q]);
    return normal.dot(pair.offset) < 0 ? Vec4(-normal) : normal;
}

}  // namespace

bool find_separating_axes(const BoxPair& pair, double margin, SeparatingAxes& axes) {
    axes = {};
    const Mat4& r = pair.rotation;
    const Mat4 transposed = r.transpose();
    const Mat4 size = r.cwiseAbs();

    axes.cell_a = largest_of(pair.offset.cwiseAbs() - pair.half_a - size * pair.half_b);
    if (axes.cell_a.gap > margin) return false;
    const Vec4 offset_b = transposed * pair.offset;
    axes.cell_b = largest_of(offset_b.cwiseAbs() - pair.half_b - size.transpose() * pair.half_a);
    if (axes.cell_b.gap > margin) return false;

    axes.edge.gap = -std::numeric_limits<double>::infinity();
    return find_edge_axis(false, pair.half_a, pair.half_b, pair.offset, transposed, margin,
                          axes.edge) &&
           find_edge_axis(true, pair.half_b, pair.half_a, offset_b, r, margin, axes.edge);
}

Vec4 normal_a(const BoxPair& pair, const CellAxis& axis) {
    return side_of(pair.offset[axis.axis]) * Vec4::Unit(axis.axis);
}

Vec4 normal_b(const BoxPair& pair, const CellAxis& axis) {
    const Vec4 direction = pair.rotation.col(axis.axis);
    return side_of(direction.dot(pair.offset)) * direction;
}

Vec4 normal_of(const BoxPair& pair, const EdgeAxis& axis) {
    if (!axis.face_of_b) return edge_normal(pair, axis);
    return -(pair.rotation * edge_normal(swapped(pair), axis));
}

Vec4 best_normal(const BoxPair& pair, const SeparatingAxes& axes) {
    if (axes.is_edge()) return normal_of(pair, axes.edge);
    return axes.cell_b.gap > axes.cell_a.gap ? normal_b(pair, axes.cell_b)
                                             : normal_a(pair, axes.cell_a);
}

}  // namespace tesserae
