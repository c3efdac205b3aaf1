// SPDX-License-Identifier: Apache-2.0
#include "core/contact/cell_clipping.hpp"

#include <bit>
#include <cmath>

#include "core/contact/branchless.hpp"

namespace tesserae {
namespace {

using Lanes = Eigen::Array4d;

/// Axes other than each.
constexpr int kOthers[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};

double sign_in_cell(int corner, int k) { return (corner >> k & 1) != 0 ? 1 : -1; }

/// What is known of a point in both solids' terms.
struct Place {
    Vec4 at;      ///< on the cell of b, in a's frame
    Lanes inner;  ///< in the coordinates in which the other solid is |x_k| <= limit_k, last one 0

    Place operator+(const Place& o) const { return {at + o.at, inner + o.inner}; }
    Place operator-(const Place& o) const { return {at - o.at, inner - o.inner}; }
};

/// A parallelepiped's eight corners, bit k of the number set on the positive side of its axis k.
struct Corners {
    Place place[8];
    BoxFace face[8];  ///< of the box that the parallelepiped is a cell of
    int axes[3];      ///< of that box
    Lanes limit, reach;
    unsigned out[8] = {};  ///< per side of the other solid, the corners beyond it, one bit each
    unsigned inside = 0;   ///< bits of the corners beyond none

    /// @param edges  half of the parallelepiped's edges
    /// @param limit  half sides of the other solid
    Corners(const Place& centre, const Place (&edges)[3], const Lanes& limits)
        : limit(limits), reach(limits + kBoxSlack) {
        place[0] = centre;
        for (int k = 0; k < 3; ++k)
            for (int corner = 0; corner < 1 << k; ++corner) {
                place[corner | 1 << k] = place[corner] + edges[k];
                place[corner] = place[corner] - edges[k];
            }
        for (int corner = 0; corner < 8; ++corner)
            for (int k = 0; k < 3; ++k) {
                const double x = place[corner].inner[k];
                out[2 * k] |= unsigned(x > reach[k]) << corner;
                out[2 * k + 1] |= unsigned(-x > reach[k]) << corner;
            }
        unsigned outside = 0;
        for (const unsigned beyond : out) outside |= beyond;
        inside = ~outside & 255u;
    }
    /// Names the faces that corners lie on, `side` of `axis` being the cell's.
    void set_faces(int axis, signed char side) {
        std::copy_n(kOthers[axis], 3, axes);
        for (int corner = 0; corner < 8; ++corner) {
            face[corner][axis] = side;
            for (int k = 0; k < 3; ++k)
                face[corner][axes[k]] = static_cast<signed char>(sign_in_cell(corner, k));
        }
    }
    /// The edges that have a part inside and a part outside, as far as their ends tell: bit 8 k +
    /// start for the edge along axis k from that corner.
    unsigned crossing_edges() const {
        static constexpr unsigned kFirstCorners[3] = {0x55, 0x33, 0x0f};
        unsigned edges = 0;
        for (int k = 0; k < 3; ++k) {
            const int step = 1 << k;
            unsigned none = inside & inside >> step;
            for (const unsigned beyond : out) none |= beyond & beyond >> step;
            edges |= (kFirstCorners[k] & ~none) << 8 * k;
        }
        return edges;
    }
};

/// Where on an edge one solid leaves the other.
struct Crossing {
    double t;  ///< 0 at the edge's start, 1 at its end
    int axis;  ///< of the other solid's side; -1: the edge ends inside
    signed char side;
};

/// The part of an edge inside the other solid; false if there is none. The edge has no side of the
/// other solid with both ends beyond.
bool clip_edge(const Corners& corners, int start, int end, Crossing& in, Crossing& out) {
    const Lanes x0 = corners.place[start].inner, x1 = corners.place[end].inner;
    const Lanes length = (x1 - x0).abs();
    // Each is used only where that end is beyond a side, and then the length is not zero.
    const Lanes enter = ((x0.abs() - corners.limit) / length).min(1);
    const Lanes leave = (1 - (x1.abs() - corners.limit) / length).max(0);
    in = {0, -1, 0}, out = {1, -1, 0};
    // One branch each, and seldom the other way than the last time.
    for (int k = 0; k < 3; ++k) {
        if (both(std::abs(x0[k]) > corners.reach[k], enter[k] > in.t))
            in = {enter[k], k, side_of(x0[k])};
        if (both(std::abs(x1[k]) > corners.reach[k], leave[k] < out.t))
            out = {leave[k], k, side_of(x1[k])};
    }
    return in.t <= out.t;
}

/// The reference cell (of a) and the incident cell (of b), and the points where they meet.
class Clipping {
  public:
    Clipping(const BoxPair& pair, const CellAxis& axis, double margin, BoxPoints& points)
        : pair_(pair), axis_(axis.axis), margin_(margin), points_(points) {
        side_ = side_of(pair.offset[axis_]);
        pair.rotation.row(axis_).cwiseAbs().maxCoeff(&incident_);
        across_ = pair.rotation.col(incident_);
        incident_side_ = static_cast<signed char>(-side_ * side_of(across_[axis_]));
        centre_ = pair.offset + (incident_side_ * pair.half_b[incident_]) * across_;
        points_.normal = side_ * Vec4::Unit(axis_);
        points_.clear();
    }

    void run() {
        const Corners incident = incident_corners(), reference = reference_corners();
        BoxFace cell_a{}, cell_b{};
        cell_a[axis_] = side_;
        cell_b[incident_] = incident_side_;
        add_corners(incident, [&](const Vec4& at, const BoxFace& own) { add(at, cell_a, own); });
        add_corners(reference, [&](const Vec4& at, const BoxFace& own) { add(at, own, cell_b); });
        add_crossings(
            incident, reference.axes, cell_a,
            [&](const Vec4& at, const BoxFace& own, const BoxFace& other) { add(at, other, own); });
        add_crossings(
            reference, incident.axes, cell_b,
            [&](const Vec4& at, const BoxFace& own, const BoxFace& other) { add(at, own, other); });
    }

  private:
    Corners incident_corners() const {
        const auto seen = [&](const Vec4& at) { return Place{at, others_of(at, axis_)}; };
        Place edges[3];
        for (int k = 0; k < 3; ++k) {
            const int axis = kOthers[incident_][k];
            edges[k] = seen(pair_.half_b[axis] * pair_.rotation.col(axis));
        }
        Corners corners(seen(centre_), edges, others_of(pair_.half_a, axis_));
        corners.set_faces(incident_, incident_side_);
        return corners;
    }

    /// The corners of a's cell, each moved along the normal onto the hyperplane of b's cell.
    Corners reference_corners() const {
        const auto seen = [&](const Vec4& at, const Vec4& from_b) {
            return Place{at, others_of(pair_.rotation.transpose() * from_b, incident_)};
        };
        Vec4 middle = Vec4::Zero();
        middle[axis_] = across_.dot(centre_) / across_[axis_];
        Place edges[3];
        for (int k = 0; k < 3; ++k) {
            const int axis = kOthers[axis_][k];
            Vec4 edge = Vec4::Zero();
            edge[axis] = pair_.half_a[axis];
            edge[axis_] = -across_[axis] * pair_.half_a[axis] / across_[axis_];
            edges[k] = seen(edge, edge);
        }
        Corners corners(seen(middle, middle - pair_.offset), edges,
                        others_of(pair_.half_b, incident_));
        corners.set_faces(axis_, side_);
        return corners;
    }

    static Lanes others_of(const Vec4& v, int axis) {
        const auto& others = kOthers[axis];
        return assembled(v[others[0]], v[others[1]], v[others[2]], 0);
    }

    template <class Add>
    void add_corners(const Corners& corners, Add&& add_point) {
        for (unsigned rest = corners.inside; rest != 0; rest &= rest - 1) {
            const int corner = std::countr_zero(rest);
            add_point(corners.place[corner].at, corners.face[corner]);
        }
    }

    template <class Add>
    void add_crossings(const Corners& corners, const int (&other_axes)[3],
                       const BoxFace& other_cell, Add&& add_point) {
        for (unsigned rest = corners.crossing_edges(); rest != 0; rest &= rest - 1) {
            const int edge = std::countr_zero(rest), along = edge / 8;
            const int start = edge % 8, end = start | 1 << along;
            Crossing in, out;
            if (!clip_edge(corners, start, end, in, out)) continue;
            BoxFace own = corners.face[start];
            own[corners.axes[along]] = 0;
            for (const Crossing& c : {in, out}) {
                if (c.axis < 0) continue;
                BoxFace other = other_cell;
                other[other_axes[c.axis]] = c.side;
                add_point((1 - c.t) * corners.place[start].at + c.t * corners.place[end].at, own,
                          other);
            }
        }
    }

    void add(const Vec4& at, const BoxFace& face_a, const BoxFace& face_b) {
        const double separation = side_ * at[axis_] - pair_.half_a[axis_];
        if (separation <= margin_) points_.add_distinct(at, separation, face_a, face_b);
    }

    const BoxPair& pair_;
    int axis_, incident_ = 0;
    double margin_;
    BoxPoints& points_;
    signed char side_, incident_side_;
    Vec4 across_;  ///< the incident cell's normal, either way
    Vec4 centre_;  ///< of the incident cell
};

}  // namespace

void clip_cell(const BoxPair& pair, const CellAxis& axis, double margin, BoxPoints& points) {
    Clipping(pair, axis, margin, points).run();
}

}  // namespace tesserae
