// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hyperbox_hyperbox.hpp"

#include "core/contact/box_distance.hpp"
#include "core/contact/cell_clipping.hpp"
#include "core/contact/edge_points.hpp"
#include "core/contact/manifold.hpp"

namespace tesserae {
namespace {

constexpr std::uint32_t kFaces = 81;

/// The vertices of the contact solid under a cell of either box.
void find_under_cell(const BoxPair& pair, const CellAxis& axis, bool of_b, double margin,
                     BoxPoints& points) {
    if (!of_b) return clip_cell(pair, axis, margin, points);
    const BoxPair other = swapped(pair);
    clip_cell(other, axis, margin, points);
    points.swap_boxes(other);
}

/// The vertices under one cell; false if they do not reach the pair's separation, so that another
/// feature touches first.
/// @param best   the pair's normal: what overlaps by so much along it does so by no more than
///               that over the cosine at any point under a cell, however far the boxes reach
bool meet_at_cell(const BoxPair& pair, const CellAxis& axis, bool of_b, double separation,
                  const Vec4& best, double margin, BoxPoints& points) {
    const Vec4 normal = of_b ? normal_b(pair, axis) : normal_a(pair, axis);
    const bool sunk = separation < -kBoxSunk / kCellBias * cell_bias(pair);
    const double leaning = sunk ? kSunkLeaning : kLeaning;
    if (axis.gap < separation - cell_bias(pair) && normal.dot(best) < leaning) return false;
    find_under_cell(pair, axis, of_b, margin, points);
    return points.least_separation() <= separation + cell_bias(pair);
}

void meet_at_edges(const BoxPair& pair, const EdgeAxis& axis, BoxPoints& points) {
    if (!axis.face_of_b) return meet_at_edge(pair, axis, cell_bias(pair), points);
    const BoxPair other = swapped(pair);
    EdgeAxis seen = axis;
    seen.face_of_b = false;
    meet_at_edge(other, seen, cell_bias(pair), points);
    points.swap_boxes(other);
}

/// b's vertex farthest against the normal: what is left where rounding empties the solid under the
/// best cell.
void meet_at_vertex(const BoxPair& pair, const SeparatingAxes& axes, BoxPoints& points) {
    points.normal = best_normal(pair, axes);
    const Vec4 slope = pair.rotation.transpose() * points.normal;
    Vec4 vertex = pair.offset;
    BoxFace face;
    for (int j = 0; j < 4; ++j) {
        face[j] = static_cast<signed char>(-side_of(slope[j]));
        vertex += (face[j] * pair.half_b[j]) * pair.rotation.col(j);
    }
    points.clear();
    points.add_distinct(vertex, axes.gap(), {}, face);
}

void find_points(const BoxPair& pair, const SeparatingAxes& axes, const BoxSeparation& separation,
                 double margin, BoxPoints& points) {
    // A cell of a goes first when it is nearly as good, so that rounding does not choose.
    const double value = separation.value;
    const bool b_first = axes.cell_b.gap > axes.cell_a.gap + cell_bias(pair);
    const Vec4 best = separation.is_axis ? best_normal(pair, axes) : separation.witness.normal;
    for (const bool of_b : {b_first, !b_first})
        if (meet_at_cell(pair, of_b ? axes.cell_b : axes.cell_a, of_b, value, best, margin, points))
            return;
    if (value > 0 && !(separation.is_axis && axes.is_edge()))
        meet_at_witness(pair, separation.witness, cell_bias(pair), points);
    else if (axes.is_edge())
        meet_at_edges(pair, axes.edge, points);
    else
        meet_at_vertex(pair, axes, points);
}

/// In the world, at most eight, those beyond the margin (in units) left out: never the deepest,
/// which rounding may take there.
void report(const BoxPair& pair, const BoxPoints& points, const Vec4& position, const Mat4& axes,
            double margin, PairContacts& out) {
    std::array<ContactPoint, kManifoldInput> list;
    std::size_t count = 0;
    const double most = std::max(margin, points.least_separation());
    for (int i = 0; i < points.count; ++i) {
        const BoxPoint& p = points.point[i];
        if (p.separation > most) continue;
        list[count++] = {p.on_b - (0.5 * p.separation) * points.normal, p.separation,
                         kFaces * code_of(p.face_a) + code_of(p.face_b)};
    }
    const std::size_t kept = reduce_manifold({list.data(), count}, points.normal);
    const Vec4 normal = axes * points.normal;
    for (std::size_t i = 0; i < kept; ++i)
        out.add(list[i].feature, normal, pair.unit * list[i].separation,
                position + pair.unit * (axes * list[i].point));
}

}  // namespace

void contacts_between(const Hyperbox& a, const Pose& pose_a, const Hyperbox& b, const Pose& pose_b,
                      double margin, PairContacts& out) {
    const double distance = stable_norm(pose_b.position - pose_a.position);
    const double reach = bounding_radius(a) + bounding_radius(b);
    const auto say_apart = [&](double by) { out.apart = by; };
    if (!(distance <= reach + margin)) return say_apart(distance - reach);

    const Mat4 axes_a = to_matrix(pose_a.rotor), axes_b = to_matrix(pose_b.rotor);
    const BoxPair pair = box_pair(a, pose_a.position, axes_a, b, pose_b.position, axes_b);
    const double scaled_margin = margin / pair.unit;
    SeparatingAxes axes;
    if (!find_separating_axes(pair, scaled_margin, axes)) return say_apart(pair.unit * axes.gap());
    const BoxSeparation separation = separation_of(pair, axes);
    if (separation.value > scaled_margin) return say_apart(pair.unit * separation.value);

    BoxPoints points;
    find_points(pair, axes, separation, scaled_margin, points);
    report(pair, points, pose_a.position, axes_a, scaled_margin, out);
}

void contacts_over_face(const Hyperbox& a, const Pose& pose_a, const Hyperbox& b,
                        const Pose& pose_b, bool face_of_b, const Vec4& outward, double margin,
                        PairContacts& out) {
    const Mat4 axes_a = to_matrix(pose_a.rotor), axes_b = to_matrix(pose_b.rotor);
    const BoxPair pair = box_pair(a, pose_a.position, axes_a, b, pose_b.position, axes_b);
    CellAxis cell;
    ((face_of_b ? axes_b : axes_a).transpose() * outward).cwiseAbs().maxCoeff(&cell.axis);
    BoxPoints points;
    find_under_cell(pair, cell, face_of_b, margin / pair.unit, points);
    if (points.count > 0) report(pair, points, pose_a.position, axes_a, margin / pair.unit, out);
}

std::uint32_t feature_over_cell(const Hyperbox&, const Hyperbox&, bool face_of_b,
                                const Vec4& normal, std::uint32_t vertex) {
    BoxFace corner{}, cell{};
    for (int i = 0; i < 4; ++i) corner[i] = (vertex >> i & 1u) != 0 ? 1 : -1;
    int axis;
    normal.cwiseAbs().maxCoeff(&axis);
    cell[axis] = side_of(normal[axis]);
    return face_of_b ? kFaces * code_of(corner) + code_of(cell)
                     : kFaces * code_of(cell) + code_of(corner);
}

}  // namespace tesserae
