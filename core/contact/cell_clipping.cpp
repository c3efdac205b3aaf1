#include "core/contact/cell_clipping.hpp"

#include <cmath>

namespace tesserae {
namespace {

/// Axes other than each.
constexpr int kOthers[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};

/// A parallelepiped's eight corners, bit k of the number set on the positive side of its axis k.
struct Corners {
    Vec4 at[8];          ///< on the cell of b, in a's frame
    double inner[8][3];  ///< in the coordinates in which the other solid is |x_k| <= limit_k
    double limit[3];
};

/// Where on an edge one solid leaves the other.
struct Crossing {
    double t;  ///< 0 at the edge's start, 1 at its end
    int axis;  ///< of the other solid's side; -1: the edge ends inside
    signed char side;
};

bool is_inside(const Corners& corners, int corner) {
    for (int k = 0; k < 3; ++k)
        if (std::abs(corners.inner[corner][k]) > corners.limit[k] + kBoxSlack) return false;
    return true;
}

/// The part of an edge inside the other solid; false if there is none.
bool clip_edge(const Corners& corners, int start, int end, Crossing& in, Crossing& out) {
    in = {0, -1, 0}, out = {1, -1, 0};
    for (int k = 0; k < 3; ++k) {
        const double x0 = corners.inner[start][k], x1 = corners.inner[end][k];
        const double limit = corners.limit[k], reach = limit + kBoxSlack;
        for (const int side : {-1, 1}) {
            const double d0 = side * x0, d1 = side * x1;
            if (d0 > reach && d1 > reach) return false;
            if (d0 > reach) {
                const double t = std::min(1.0, (d0 - limit) / (d0 - d1));
                if (t > in.t) in = {t, k, static_cast<signed char>(side)};
            } else if (d1 > reach) {
                const double t = std::max(0.0, (limit - d0) / (d1 - d0));
                if (t < out.t) out = {t, k, static_cast<signed char>(side)};
            }
        }
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
        const Vec4 direction = pair.rotation.col(incident_);
        incident_side_ = static_cast<signed char>(-side_ * side_of(direction[axis_]));
        centre_ = pair.offset + (incident_side_ * pair.half_b[incident_]) * direction;
        points_.normal = side_ * Vec4::Unit(axis_);
        points_.count = 0;
    }

    void run() {
        const Corners incident = incident_corners(), reference = reference_corners();
        add_corners(incident, true);
        add_corners(reference, false);
        add_crossings(incident, true);
        add_crossings(reference, false);
    }

  private:
    Corners incident_corners() const {
        Corners c;
        for (int k = 0; k < 3; ++k) c.limit[k] = pair_.half_a[kOthers[axis_][k]];
        for (int corner = 0; corner < 8; ++corner) {
            Vec4 at = centre_;
            for (int k = 0; k < 3; ++k) {
                const int axis = kOthers[incident_][k];
                at += (sign_of(corner, k) * pair_.half_b[axis]) * pair_.rotation.col(axis);
            }
            c.at[corner] = at;
            for (int k = 0; k < 3; ++k) c.inner[corner][k] = at[kOthers[axis_][k]];
        }
        return c;
    }

    /// The corners of a's cell, each moved along the normal onto the hyperplane of b's cell.
    Corners reference_corners() const {
        const Vec4 across = pair_.rotation.col(incident_);
        Corners c;
        for (int k = 0; k < 3; ++k) c.limit[k] = pair_.half_b[kOthers[incident_][k]];
        for (int corner = 0; corner < 8; ++corner) {
            Vec4 at = centre_;
            double rest = 0;
            for (int k = 0; k < 3; ++k) {
                const int axis = kOthers[axis_][k];
                at[axis] = sign_of(corner, k) * pair_.half_a[axis];
                rest += across[axis] * (at[axis] - centre_[axis]);
            }
            at[axis_] -= rest / across[axis_];
            c.at[corner] = at;
            const Vec4 seen = pair_.rotation.transpose() * (at - pair_.offset);
            for (int k = 0; k < 3; ++k) c.inner[corner][k] = seen[kOthers[incident_][k]];
        }
        return c;
    }

    static signed char sign_of(int corner, int k) { return (corner >> k & 1) != 0 ? 1 : -1; }

    void add_corners(const Corners& corners, bool of_b) {
        for (int corner = 0; corner < 8; ++corner)
            if (is_inside(corners, corner))
                add(corners.at[corner], sides_of(corner, -1), {0, 0, 0}, of_b);
    }

    void add_crossings(const Corners& corners, bool of_b) {
        for (int along = 0; along < 3; ++along)
            for (int start = 0; start < 8; ++start) {
                if ((start >> along & 1) != 0) continue;
                const int end = start | 1 << along;
                Crossing in, out;
                if (!clip_edge(corners, start, end, in, out)) continue;
                for (const Crossing& c : {in, out}) {
                    if (c.axis < 0) continue;
                    std::array<signed char, 3> other{};
                    other[c.axis] = c.side;
                    const Vec4 at = (1 - c.t) * corners.at[start] + c.t * corners.at[end];
                    add(at, sides_of(start, along), other, of_b);
                }
            }
    }

    /// The sides on which a corner lies, or an edge along an axis.
    static std::array<signed char, 3> sides_of(int corner, int along) {
        std::array<signed char, 3> sides;
        for (int k = 0; k < 3; ++k) sides[k] = k == along ? 0 : sign_of(corner, k);
        return sides;
    }

    /// @param own, other  sides of the solid whose corners are looked at, and of the other
    void add(const Vec4& at, const std::array<signed char, 3>& own,
             const std::array<signed char, 3>& other, bool of_b) {
        const double separation = side_ * at[axis_] - pair_.half_a[axis_];
        if (separation > margin_) return;
        const auto& of_reference = of_b ? other : own;
        const auto& of_incident = of_b ? own : other;
        BoxPoint point{at, separation, {}, {}};
        point.face_a[axis_] = side_;
        point.face_b[incident_] = incident_side_;
        for (int k = 0; k < 3; ++k) {
            point.face_a[kOthers[axis_][k]] = of_reference[k];
            point.face_b[kOthers[incident_][k]] = of_incident[k];
        }
        points_.add_distinct(point);
    }

    const BoxPair& pair_;
    int axis_, incident_ = 0;
    double margin_;
    BoxPoints& points_;
    signed char side_, incident_side_;
    Vec4 centre_;  ///< of the incident cell
};

}  // namespace

void clip_cell(const BoxPair& pair, const CellAxis& axis, double margin, BoxPoints& points) {
    Clipping(pair, axis, margin, points).run();
}

}  // namespace tesserae
