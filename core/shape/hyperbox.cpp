// SPDX-License-Identifier: Apache-2.0
#include "core/shape/hyperbox.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/simd/simd.hpp"

namespace tesserae {
namespace {

using namespace simd;
using Four = Double4;

Four four_of(const Vec4& v) {
    Four four;
    std::memcpy(&four, v.data(), sizeof four);
    return four;
}

/// All four at once: one by one they would be stored, and to read them back as one vector stalls.
Vec4 signs_of(const Vec4& v) {
    Four four = four_of(v);
    four = four < 0 ? Four{-1, -1, -1, -1} : Four{1, 1, 1, 1};
    Vec4 signs;
    std::memcpy(signs.data(), &four, sizeof four);
    return signs;
}

/// Signed distances from the nearer of the two faces across every axis.
Vec4 face_distances(const Hyperbox& shape, const Vec4& point) {
    return point.cwiseAbs() - 0.5 * shape.size;
}

}  // namespace

double volume(const Hyperbox& shape) { return shape.size.prod(); }

/// M s_i^2 / 12.
Vec4 second_moments(const Hyperbox& shape, double mass) {
    return (mass * shape.size).cwiseProduct(shape.size) / 12;
}

/// Half the diagonal.
double bounding_radius(const Hyperbox& shape) { return stable_norm(0.5 * shape.size); }

Vec4 half_extents(const Hyperbox& shape, const Mat4& rotation) {
    return rotation.cwiseAbs() * (0.5 * shape.size);
}

double half_extent_along(const Hyperbox& shape, const Vec4& direction) {
    return direction.cwiseAbs().dot(0.5 * shape.size);
}

/// A vertex; across an axis that the direction has no part along, the one on the positive side.
Vec4 support(const Hyperbox& shape, const Vec4& direction) {
    return 0.5 * shape.size.cwiseProduct(signs_of(direction));
}

bool is_face_normal(const Hyperbox& shape, const Vec4& direction) {
    return (direction - face_along(shape, direction).normal).norm() <= kFaceNormal;
}

Face face_along(const Hyperbox& shape, const Vec4& direction) {
    int axis;
    direction.cwiseAbs().maxCoeff(&axis);
    return {std::copysign(1.0, direction[axis]) * Vec4::Unit(axis), 0.5 * shape.size[axis]};
}

std::uint64_t faces_near(const Hyperbox& shape, const Vec4& point, double depth) {
    std::uint64_t faces = 0;
    for (int axis = 0; axis < 4; ++axis) {
        const double rim = 0.5 * shape.size[axis] - depth;
        faces |= std::uint64_t{point[axis] >= rim} << 2 * axis;
        faces |= std::uint64_t{-point[axis] >= rim} << (2 * axis + 1);
    }
    return faces;
}

double signed_distance(const Hyperbox& shape, const Vec4& point) {
    const Vec4 faces = face_distances(shape, point);
    const double deepest = faces.maxCoeff();
    return deepest <= 0 ? deepest : stable_norm(faces.cwiseMax(0));
}

/// Inside, where several faces are equally near: the one across the lowest axis; in the middle
/// between two opposite faces: the positive one.
Vec4 normal(const Hyperbox& shape, const Vec4& point) {
    const Vec4 faces = face_distances(shape, point), sides = signs_of(point);
    if (faces.maxCoeff() > 0) return stable_normalized(faces.cwiseMax(0)).cwiseProduct(sides);
    int axis;
    faces.maxCoeff(&axis);
    return sides[axis] * Vec4::Unit(axis);
}

/// Source: Kay and Kajiya 1986, slabs; surfaces count as inside.
double ray_hit(const Hyperbox& shape, const Vec4& origin, const Vec4& direction) {
    const Vec4 faces = face_distances(shape, origin);
    if (faces.maxCoeff() <= 0) return 0;

    // The usual ray slants along every axis: all quotients at once.
    const Vec4 sides = 0.5 * signs_of(direction).cwiseProduct(shape.size);
    double enter = 0, leave = kMiss;
    if ((direction.array() != 0).all()) {
        enter = std::max(enter, (-sides - origin).cwiseQuotient(direction).maxCoeff());
        leave = std::min(leave, (sides - origin).cwiseQuotient(direction).minCoeff());
        return enter <= leave ? enter : kMiss;
    }
    for (int i = 0; i < 4; ++i) {
        if (direction[i] == 0) {
            if (faces[i] > 0) return kMiss;
            continue;
        }
        enter = std::max(enter, (-sides[i] - origin[i]) / direction[i]);
        leave = std::min(leave, (sides[i] - origin[i]) / direction[i]);
    }
    return enter <= leave ? enter : kMiss;
}

/// The first of the faces ahead.
double ray_exit(const Hyperbox& shape, const Vec4& origin, const Vec4& direction) {
    double leave = kMiss;
    for (int i = 0; i < 4; ++i) {
        if (direction[i] == 0) continue;
        const double side = sign_of(direction[i]) * 0.5 * shape.size[i];
        leave = std::min(leave, (side - origin[i]) / direction[i]);
    }
    return std::max(0.0, leave);
}

namespace {

Four part_of(Four v, Mask4 where) { return where ? v : Four{}; }

/// A box as seen from a ray's start, every axis turned so that the start is on its positive side.
/// As a function of s = 1/t the ratio f(t)/t is the norm of the positive ones among the eight
/// linear functions
///     heading + s near ("rising": most of them do), -heading - s far (falling),
/// or the largest of them where none is positive: so it is convex in s.
class BoxView {
  public:
    BoxView(Four half, Four origin, Four direction) {
        const Mask4 turned = origin < 0;
        heading_ = turned ? -direction : direction;
        const Four from_centre = turned ? -origin : origin;
        near_ = from_centre - half, far_ = from_centre + half;
        scale_ = largest_lane(far_);
    }
    double nearest_face() const { return largest_lane(near_); }
    /// The lengths involved.
    double scale() const { return scale_; }

    Rim rim(const RimRange& range) {
        // A face that the start is on counts as just ahead of it or behind, so that no quotient is
        // 0/0.
        constexpr double kLeast = 1e-300;
        near_ = larger(near_, -near_) < kLeast ? all_four(kLeast) : near_;
        far_ = larger(far_, all_four(kLeast));
        per_near_ = 1 / near_, per_far_ = 1 / far_;

        const double first = 1 / range.limit;
        if (below(range.high, first).is_empty()) return {1};
        const Interval inside = below(0, first);
        if (inside.is_empty()) return rim_of_passing(first, inside);
        if (!below(range.low, first).is_empty()) return {-1};
        return rim_of_entering(inside);
    }

  private:
    /// Of values of s; empty also where both ends are one: a ray that only touches does not enter.
    struct Interval {
        double low, high;
        bool is_empty() const { return !(low < high); }
    };
    /// Where from `first` on no function is above the level.
    Interval below(double level, double first) const {
        const Four falls = (-level - heading_) * per_far_, rises = (level - heading_) * per_near_;
        const Mask4 ahead = near_ > 0;
        return {std::max(first, largest_lane(larger(falls, ahead ? falls : rises))),
                smallest_lane(ahead ? rises : all_four(kMiss))};
    }

    /// Half the square of f(t)/t outside the box, and its derivatives: a parabola between the zeros
    /// of the functions, one for every set of them that are positive.
    struct Square {
        double ratio, slope, bend;
        int positive;
    };
    Square square_at(double s) const {
        const Four rising = heading_ + s * near_, falling = -heading_ - s * far_;
        const Mask4 is_up = rising > 0, is_down = falling > 0;
        const Four up = part_of(rising, is_up), down = part_of(falling, is_down);
        return {std::sqrt(sum_of_lanes(up * up + down * down)),
                sum_of_lanes(up * near_ - down * far_),
                sum_of_lanes(part_of(near_ * near_, is_up) + part_of(far_ * far_, is_down)),
                lanes_set(is_up) | lanes_set(is_down) << 4};
    }
    Rim rim_of_passing(double first, const Interval& inside) const;

    /// The largest function at s.
    struct Line {
        double s, value, slope;
    };
    /// @param side   of several the one with the least slope (1) or the greatest (-1)
    Line largest_at(double s, double side) const {
        const Four rising = heading_ + s * near_, falling = -heading_ - s * far_;
        const double value = largest_lane(larger(rising, falling));
        const Four near = rising == value ? side * near_ : all_four(kMiss);
        const Four far = falling == value ? -side * far_ : all_four(kMiss);
        return {s, value, side * smallest_lane(smaller(near, far))};
    }
    Rim rim_of_entering(const Interval& inside) const;

    Four heading_, near_, far_, per_near_, per_far_;
    double scale_;
};

/// Newton's steps for the least square: exact from any point of its parabola, so that the search
/// ends where a step stays on one. A step that leaves the bracket is a bisection instead.
/// @param inside   empty, its ends in reverse: at the upper one no function falls to zero any more,
///                 at the lower one none has risen yet, so that the least lies between
Rim BoxView::rim_of_passing(double first, const Interval& inside) const {
    // Enough to halve any bracket down to rounding.
    constexpr int kMaxSteps = 60;
    // Wide of the ends, so that a step onto one of them is a step.
    double low = (1 - 1e-12) * inside.high, high = (1 + 1e-12) * inside.low;
    int steps = 0;
    if (low <= first) {
        low = first;
        const Square square = square_at(first);
        ++steps;
        if (square.slope >= 0) return {square.ratio, steps};
    }
    double s = 0.5 * (low + high);
    for (int parabola = -1;;) {
        const Square square = square_at(s);
        ++steps;
        // No tangent of the ratio lets it fall by more than the bracket is wide.
        const double rounding = 1e-15 * scale_ * s;
        const double fall = std::abs(square.slope) * (high - low);
        if (square.positive == parabola || square.ratio <= rounding ||
            fall <= rounding * square.ratio || steps == kMaxSteps)
            return {square.ratio, steps};
        (square.slope > 0 ? high : low) = s;
        s -= square.slope / square.bend;
        parabola = square.positive;
        if (!(s > low && s < high)) s = 0.5 * (low + high), parabola = -1;
    }
}

/// From both ends: where the line of the one crosses that of the other, no line lies above, or the
/// one that does takes the place of one of them.
Rim BoxView::rim_of_entering(const Interval& inside) const {
    Line down = largest_at(inside.low, 1), up = largest_at(inside.high, -1);
    for (int steps = 3;; ++steps) {
        if (!(down.slope < 0)) return {down.value, steps - 1};
        if (!(up.slope > 0)) return {up.value, steps - 1};
        const double s =
            down.s + (up.value - down.value + up.slope * (down.s - up.s)) / (down.slope - up.slope);
        if (!(s > down.s && s < up.s)) return {std::min(down.value, up.value), steps - 1};
        const Line top = largest_at(s, 1);
        if (top.slope == down.slope || top.slope == up.slope) return {top.value, steps};
        (top.slope < 0 ? down : up) = top;
    }
}

}  // namespace

Rim rim(const Hyperbox& shape, const Vec4& origin, const Vec4& direction, const RimRange& range) {
    BoxView view(0.5 * four_of(shape.size), four_of(origin), four_of(direction));
    const double scale = view.scale();
    if (!(scale > 1e-100 && scale < 1e100)) {
        const double unit = std::max(origin.cwiseAbs().maxCoeff(), shape.size.maxCoeff());
        return rim(Hyperbox{shape.size / unit}, origin / unit, direction,
                   {range.low, range.high, range.limit / unit});
    }
    if (view.nearest_face() <= 0)
        return rim_from_inside(view.nearest_face(), normal(shape, origin).dot(direction), scale);
    return view.rim(range);
}

}  // namespace tesserae
