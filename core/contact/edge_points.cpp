// SPDX-License-Identifier: Apache-2.0
#include "core/contact/edge_points.hpp"

#include <cmath>

namespace tesserae {
namespace {

/// An interval, each end with the axis and side of the face that set it.
struct Interval {
    struct End {
        double at;
        bool of_b;
        int axis;
        signed char side;
    };
    End low, high;

    /// Keeps where |start + slope x| <= limit but for rounding, which decides nothing when the
    /// slope is rounding too.
    void cut(double start, double slope, double reach, bool of_b, int axis) {
        if (slope == 0) return;
        const signed char side = side_of(slope);
        const double from = (-side * reach - start) / slope, to = (side * reach - start) / slope;
        if (from > low.at) low = {from, of_b, axis, static_cast<signed char>(-side)};
        if (to < high.at) high = {to, of_b, axis, side};
    }
    bool is_empty() const { return low.at > high.at; }
    double clamped(double x) const { return is_empty() ? x : std::clamp(x, low.at, high.at); }
};

/// The meeting of a 2-face of a and an edge of b, or of the 2-face of b that the edge spans with
/// the axis `extra`.
class Meeting {
  public:
    Meeting(const BoxPair& pair, const EdgeAxis& axis, BoxPoints& points)
        : pair_(pair), axis_(axis), points_(points) {
        normal_ = normal_of(pair, axis);
        points_.normal = normal_;
        points_.clear();
        const Vec4 slope = pair.rotation.transpose() * normal_;
        double least = 0;
        extra_ = -1;
        for (int m = 0; m < 4; ++m) {
            if (m == axis.edge) continue;
            face_b_[m] = static_cast<signed char>(-side_of(slope[m]));
            const double change = 2 * pair.half_b[m] * std::abs(slope[m]);
            if (extra_ < 0 || change < least) extra_ = m, least = change;
        }
        extra_change_ = least;
        height_ = 0;
        for (const int k : {axis.p, axis.q}) {
            face_a_[k] = side_of(normal_[k]);
            height_ += pair.half_a[k] * std::abs(normal_[k]);
        }
    }

    void run(double bias) {
        const double at = face_b_[extra_] * pair_.half_b[extra_];
        const Interval::End end{at, true, extra_, face_b_[extra_]};
        if (extra_change_ > bias) return add(end);
        const Interval shared = shared_segment();
        if (shared.is_empty()) return add(end);
        add(shared.low);
        add(shared.high);
    }

  private:
    /// b's point with coordinate `along` on the edge's axis and `x` on the extra one.
    Vec4 point_of_b(double along, double x) const {
        Vec4 t = Vec4::Zero();
        for (int m = 0; m < 4; ++m) t[m] = face_b_[m] * pair_.half_b[m];
        t[extra_] = x;
        t[axis_.edge] = along;
        return pair_.offset + pair_.rotation * t;
    }

    /// Where along the edge (at x on the extra axis) it is nearest to the plane of the 2-face: in
    /// the plane of p and q, the edge is orthogonal to the normal.
    double nearest(double x) const {
        const Vec4 start = point_of_b(0, x);
        double product = 0, squared = 0;
        for (const int k : {axis_.p, axis_.q}) {
            const double edge = pair_.rotation(k, axis_.edge);
            product += (start[k] - face_a_[k] * pair_.half_a[k]) * edge;
            squared += edge * edge;
        }
        return -product / squared;
    }

    /// Coordinates x on the extra axis at which the nearest point is in both faces.
    Interval shared_segment() const {
        const double half = pair_.half_b[extra_];
        Interval shared{{-half, true, extra_, -1}, {half, true, extra_, 1}};
        const double along = nearest(0), slope = nearest(1) - along;
        shared.cut(along, slope, pair_.half_b[axis_.edge] + kBoxSlack, true, axis_.edge);
        const Vec4 start = point_of_b(along, 0);
        for (int k = 0; k < 4; ++k) {
            if (k == axis_.p || k == axis_.q) continue;
            const double change = pair_.rotation(k, extra_) + slope * pair_.rotation(k, axis_.edge);
            shared.cut(start[k], change, pair_.half_a[k] + kBoxSlack, false, k);
        }
        return shared;
    }

    void add(const Interval::End& end) {
        // An edge that is nearly parallel to the 2-face leaves the place on it to rounding: any
        // place that is in both faces is right.
        Interval along{{-pair_.half_b[axis_.edge], true, 0, 0},
                       {pair_.half_b[axis_.edge], true, 0, 0}};
        const Vec4 start = point_of_b(0, end.at);
        for (int k = 0; k < 4; ++k) {
            if (k == axis_.p || k == axis_.q) continue;
            along.cut(start[k], pair_.rotation(k, axis_.edge), pair_.half_a[k] + 2 * kBoxSlack,
                      false, 0);
        }
        const Vec4 on_b = point_of_b(along.clamped(nearest(end.at)), end.at);
        BoxFace face_a = face_a_, face_b = face_b_;
        face_b[extra_] = 0;
        (end.of_b ? face_b : face_a)[end.axis] = end.side;
        points_.add_distinct(on_b, normal_.dot(on_b) - height_, face_a, face_b);
    }

    const BoxPair& pair_;
    const EdgeAxis& axis_;
    BoxPoints& points_;
    Vec4 normal_;
    int extra_;            ///< axis of b that is most nearly orthogonal to the normal
    double extra_change_;  ///< of the separation along it
    double height_;        ///< of the 2-face along the normal
    BoxFace face_a_{}, face_b_{};
};

}  // namespace

void meet_at_edge(const BoxPair& pair, const EdgeAxis& axis, double bias, BoxPoints& points) {
    Meeting(pair, axis, points).run(bias);
}

void meet_at_witness(const BoxPair& pair, const BoxWitness& witness, double bias,
                     BoxPoints& points) {
    points.normal = witness.normal;
    // Each of `points` with both coordinates, so that it can be moved along a pair of axes.
    std::array<BoxWitness, 8> corner;
    corner[0] = witness;
    int count = 1;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            const double cosine = pair.rotation(i, j);
            const double length = 2 * std::min(pair.half_a[i], pair.half_b[j]);
            Vec4 across = pair.rotation.col(j);
            across[i] = 0;
            if (count == 8 || std::abs(cosine) < 0.5 || across.norm() * length > bias) continue;
            if (std::abs(witness.normal[i]) * length > bias) continue;
            const signed char same = side_of(cosine);
            Interval shift{{-1e300, false, 0, 0}, {1e300, false, 0, 0}};
            shift.cut(witness.on_a[i], 1, pair.half_a[i], false, i);
            shift.cut(witness.on_b[j], same, pair.half_b[j], true, j);
            if (!(shift.high.at - shift.low.at > 4 * kBoxSlack)) continue;
            for (int c = 0; c < count; ++c) {
                const BoxWitness from = corner[c];
                for (const bool high : {false, true}) {
                    const Interval::End& end = high ? shift.high : shift.low;
                    BoxWitness moved = from;
                    moved.on_a[i] += end.at;
                    moved.on_b[j] += same * end.at;
                    moved.face_a[i] = moved.face_b[j] = 0;
                    (end.of_b ? moved.face_b[j] : moved.face_a[i]) = end.side;
                    corner[high ? count + c : c] = moved;
                }
            }
            count *= 2;
        }
    points.clear();
    for (int c = 0; c < count; ++c) {
        const Vec4 on_b = pair.offset + pair.rotation * corner[c].on_b;
        const double separation = witness.normal.dot(on_b - corner[c].on_a);
        points.add_distinct(on_b, separation, corner[c].face_a, corner[c].face_b);
    }
}

}  // namespace tesserae
