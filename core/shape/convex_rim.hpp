// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/shape/hypersphere.hpp"
#include "core/shape/room.hpp"

namespace tesserae {

/// Finds the rim of any convex bounded shape from its distance, normal and support. With s = 1/t
/// the ratio f(t)/t is a convex function of s, and its slope is f - t f'(t). Outside the shape the
/// square of the ratio is a parabola on each feature; inside, the ratio is a line. Between the ends
/// of a bracket the next s is where the slope of the square, or the tangents, place the minimum.
template <class S>
class ConvexRim {
  public:
    ConvexRim(const S& shape, const Vec4& origin, const Vec4& direction, const RimRange& range)
        : shape_(shape), origin_(origin), direction_(direction), range_(range) {}

    Rim run() {
        const double size = bounding_radius(shape_);
        // The ball about the shape is seen under a larger angle.
        const double square = origin_.squaredNorm();
        if (square > size * size && is_plain_square(square) &&
            ball_rim(size, origin_, square, direction_).sine >= range_.high)
            return {range_.high};
        const double distance = signed_distance(shape_, origin_);
        if (distance <= 0)
            return rim_from_inside(distance, normal(shape_, origin_).dot(direction_),
                                   stable_norm(origin_) + size);
        At low = first(), high = at(std::max(2 / distance, 2 * low.s));
        if (!(low.slope < 0)) return {low.value, steps_};
        if (!(high.slope > 0)) return {high.value, steps_};
        for (double width = high.s - low.s; steps_ < kMostSteps; width = high.s - low.s) {
            const double least = std::min(low.value, high.value);
            const double cross = crossing(low, high);
            const double bound = low.value + (cross - low.s) * low.slope;
            if (bound >= range_.high) return {range_.high, steps_};
            if (least <= range_.low || least - bound <= kClose) break;
            double s = low.value > 0 && high.value > 0 ? parabola(low, high) : cross;
            if (halve_ || !(s > low.s && s < high.s)) s = 0.5 * (low.s + high.s);
            if (!(s > low.s && s < high.s)) break;
            const At next = at(s);
            (next.slope < 0 ? low : high) = next;
            if (next.slope == 0) break;
            halve_ = high.s - low.s > 0.5 * width && !halve_;
        }
        return {std::min(low.value, high.value), steps_};
    }

  private:
    static constexpr int kMostSteps = 200;
    /// The search ends when the sine is known to this.
    static constexpr double kClose = 1e-16;

    struct At {
        double s, value, slope;
    };
    At at(double s) {
        ++steps_;
        const double t = 1 / s;
        const Vec4 point = origin_ + t * direction_;
        const double distance = signed_distance(shape_, point);
        return {s, distance * s, distance - t * normal(shape_, point).dot(direction_)};
    }
    /// Returns the values at the far end of the ray. At infinity the shape is a point.
    At first() {
        if (range_.limit < kMiss) return at(1 / range_.limit);
        return {0, 1, direction_.dot(origin_ - support(shape_, direction_))};
    }
    static double crossing(const At& low, const At& high) {
        return low.s +
               (high.value - low.value - (high.s - low.s) * high.slope) / (low.slope - high.slope);
    }
    static double parabola(const At& low, const At& high) {
        const double a = low.value * low.slope, b = high.value * high.slope;
        return low.s - a * (high.s - low.s) / (b - a);
    }

    const S& shape_;
    const Vec4 &origin_, &direction_;
    const RimRange& range_;
    int steps_ = 0;
    bool halve_ = false;
};

/// A ray that meets or misses a shape by more than this part of the lengths involved does so
/// clearly, usual 1e-9. Less, and rounding decides.
constexpr double kClearlyMet = 1e-9;

/// Returns the rim of a ray if it is enough to know whether the ray meets the shape (hard shadows)
/// and if that is clear.
/// @param inside   the part of the ray that is in the shape, enter > leave if it misses
/// @param scale    the lengths involved [m]
inline std::optional<Rim> rim_by_interval(const RayInterval& inside, double scale,
                                          const RimRange& range) {
    const double first = std::max(0.0, inside.enter), last = std::min(range.limit, inside.leave);
    const double clear = kClearlyMet * scale;
    if (range.low >= 0 && last - first > clear) return Rim{-1};
    if (range.high <= 0 && first - last > clear) return Rim{1};
    return {};
}

/// Returns the rim, found by ConvexRim.
template <class S>
Rim convex_rim(const S& shape, const Vec4& origin, const Vec4& direction, const RimRange& range) {
    return ConvexRim<S>(shape, origin, direction, range).run();
}

}  // namespace tesserae
