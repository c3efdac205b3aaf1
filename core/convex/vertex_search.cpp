// SPDX-License-Identifier: Apache-2.0
#include "core/convex/vertex_search.hpp"

#include <bit>
#include <cstring>

namespace tesserae {
namespace {

using simd::Double4;

/// A gap that is this part less than the distance is rounding here.
constexpr double kSameGap = 1e-11;
/// Squared, of a point outside of the span of the others: less is in it.
constexpr double kInSpan = 1e-14;
/// In the first rounds the direction leans toward the guess: so few points tell little of where the
/// nearest ones are, and straight to the nearest of theirs takes two rounds more. (Of the momentum
/// of Montaut et al., Collision Detection Accelerated, 2022, this is what pays in so few.)
constexpr int kLeaningRounds = 3;
/// The part of their own direction in it, to one of the guess.
constexpr double kOwn = 0.4;
/// Most take 4 to 9; what goes in circles by rounding ends here.
constexpr int kMostRounds = 40;

[[gnu::always_inline]] inline Double4 loaded(const double* from) {
    Double4 v;
    std::memcpy(&v, from, sizeof v);
    return v;
}
[[gnu::always_inline]] inline Vec4 vector_of(Double4 v) {
    Vec4 x;
    std::memcpy(x.data(), &v, sizeof v);
    return x;
}
template <int kLane>
[[gnu::always_inline]] inline Double4 all_of_lane(Double4 v) {
    return __builtin_shufflevector(v, v, kLane, kLane, kLane, kLane);
}
/// The sum of columns times components.
[[gnu::always_inline]] inline Double4 combined(const std::array<Double4, 4>& columns, Double4 x) {
    return (columns[0] * all_of_lane<0>(x) + columns[1] * all_of_lane<1>(x)) +
           (columns[2] * all_of_lane<2>(x) + columns[3] * all_of_lane<3>(x));
}
[[gnu::always_inline]] inline double dot(Double4 x, Double4 y) { return simd::sum_of_lanes(x * y); }

/// 1 in one lane.
constexpr Double4 kUnit[4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

}  // namespace

VertexSearch::VertexSearch(const PlacedHull& a, const PlacedHull& b) : a_(a), b_(b) {
    const auto columns = [](const Mat4& m) {
        return std::array<Double4, 4>{loaded(m.data()), loaded(m.data() + 4), loaded(m.data() + 8),
                                      loaded(m.data() + 12)};
    };
    const Mat4 back = a.turn.transpose();
    const std::array<Double4, 4> to_a = columns(back), of_b = columns(b.turn);
    for (std::size_t i = 0; i < 4; ++i) turn_[i] = combined(to_a, of_b[i]);
    for (std::size_t i = 0; i < 4; ++i)
        turn_back_[i] = Double4{turn_[0][i], turn_[1][i], turn_[2][i], turn_[3][i]};
    const Vec4 between = b.centre - a.centre;
    between_ = combined(to_a, loaded(between.data()));
}

VertexSearch::Point VertexSearch::support(Double4 toward_origin) const {
    const std::uint32_t of_a = a_.corners.largest_at(vector_of(toward_origin)).number;
    const std::uint32_t of_b =
        b_.corners.largest_at(vector_of(combined(turn_back_, -toward_origin))).number;
    const Double4 on_a = loaded(a_.vertices[of_a].data());
    const Double4 on_b = between_ + combined(turn_, loaded(b_.vertices[of_b].data()));
    return {on_a - on_b, {of_a, of_b}};
}

void VertexSearch::start(const Point& point) {
    square_ = 1 / dot(point.at, point.at);
    sum_ = point.at * square_;
    dual_ = {};
    for (std::size_t i = 0; i < 4; ++i) dual_[i][0] = sum_[i];
    weight_ = kUnit[0] * square_;
    for (Point& each : point_) each.at = Double4{};
    point_[0] = point;
    taken_ = 1;
}

/// The scalar products of all r_i with x.
inline Double4 VertexSearch::parts_of(Double4 x) const { return combined(dual_, x); }

inline Double4 VertexSearch::own_of(std::size_t slot) const {
    return Double4{dual_[0][slot], dual_[1][slot], dual_[2][slot], dual_[3][slot]};
}

/// A point goes into a slot, whose r becomes `own`.
/// @param slope   the point by u
/// @param parts   the point by all r
inline void VertexSearch::put(std::size_t slot, const Point& point, Double4 own, double slope,
                              Double4 parts) {
    const Double4 less = parts - kUnit[slot];
    dual_[0] -= less * all_of_lane<0>(own);
    dual_[1] -= less * all_of_lane<1>(own);
    dual_[2] -= less * all_of_lane<2>(own);
    dual_[3] -= less * all_of_lane<3>(own);
    sum_ += (1 - slope) * own;
    point_[slot] = point;
    taken_ |= 1u << slot;
    weight_ = parts_of(sum_);
    square_ = dot(sum_, sum_);
}

inline void VertexSearch::drop(std::size_t slot) {
    const Double4 own = own_of(slot), products = parts_of(own);
    const double inverse = 1 / products[slot];
    const Double4 less = products * inverse;
    const double weight = weight_[slot];
    dual_[0] -= less * all_of_lane<0>(own);
    dual_[1] -= less * all_of_lane<1>(own);
    dual_[2] -= less * all_of_lane<2>(own);
    dual_[3] -= less * all_of_lane<3>(own);
    sum_ -= (weight * inverse) * own;
    weight_ -= less * weight;
    square_ -= weight * weight * inverse;
    for (Double4& one : dual_) one *= 1 - kUnit[slot];
    weight_ *= 1 - kUnit[slot];
    point_[slot].at = Double4{};
    taken_ &= ~(1u << slot);
}

/// Of the lanes in a set the first of the least value. Mostly there is one.
static inline std::size_t least_of(Double4 value, simd::Mask4 lanes) {
    auto set = static_cast<unsigned>(simd::lanes_set(lanes));
    auto best = static_cast<std::size_t>(std::countr_zero(set));
    for (set &= set - 1; set != 0; set &= set - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(set));
        if (value[lane] < value[best]) best = lane;
    }
    return best;
}

/// Toward the weights from old ones, none of which is negative: whichever comes to 0 goes.
/// @param old     times the square that follows
inline bool VertexSearch::leave_out_negative(Double4 old, double square) {
    for (int left = 3; left > 0; --left) {
        const simd::Mask4 set = weight_ < 0;
        if (simd::lanes_set(set) == 0) return true;
        old *= square_ / square;
        square = square_;
        const Double4 until = old / (old - weight_);
        const std::size_t first = least_of(until, set);
        old += until[first] * (weight_ - old);
        old *= 1 - kUnit[first];
        drop(first);
    }
    return taken_ != 0;
}

/// False: the origin is among the points.
inline bool VertexSearch::take_in(const Point& point, double slope) {
    const Double4 parts = parts_of(point.at);
    if (taken_ != 15) {
        const Double4 outside =
            point.at -
            ((point_[0].at * all_of_lane<0>(parts) + point_[1].at * all_of_lane<1>(parts)) +
             (point_[2].at * all_of_lane<2>(parts) + point_[3].at * all_of_lane<3>(parts)));
        const double square = dot(outside, outside);
        if (square > kInSpan * dot(point.at, point.at)) {
            const Double4 old = weight_;
            const double old_square = square_;
            put(static_cast<std::size_t>(std::countr_one(taken_)), point, outside / square, slope,
                parts);
            return leave_out_negative(old, old_square);
        }
    }
    // In the span of the others: it goes into the place of the one whose weight comes to 0 first
    // as its own rises.
    const simd::Mask4 set = parts > 0;
    if (simd::lanes_set(set) == 0) return false;
    const Double4 until = weight_ / parts;
    const std::size_t first = least_of(until, set);
    Double4 old =
        (weight_ - until[first] * parts) * (1 - kUnit[first]) + until[first] * kUnit[first];
    const double old_square = simd::sum_of_lanes(old);
    put(first, point, own_of(first) / parts[first], slope, parts);
    return leave_out_negative(old, old_square);
}

bool VertexSearch::is_enough(Double4 toward, const Point& point, double enough) {
    const double along = -dot(toward, point.at);
    if (!(along > 0 && along * along > enough * enough * dot(toward, toward))) return false;
    const Vec4 own = vector_of(toward);
    far_direction_ = (a_.turn * own).normalized();
    found_[0] = point.pair;
    count_ = 1;
    return true;
}

VertexSearch::End VertexSearch::run(const Vec4& guess, double enough) {
    const Vec4 own_guess = a_.turn.transpose() * guess;
    const Double4 ahead = loaded(own_guess.data());
    Point point = support(ahead);
    if (is_enough(ahead, point, enough)) return End::kFar;
    start(point);
    for (int round = 0; round < kMostRounds; ++round) {
        const bool leans = round < kLeaningRounds;
        const Double4 toward = leans ? ahead - (kOwn / std::sqrt(square_)) * sum_ : -sum_;
        point = support(toward);
        if (is_enough(toward, point, enough)) return End::kFar;
        const double slope = dot(sum_, point.at);
        if (slope < 1 - kSameGap) {
            if (take_in(point, slope)) continue;
            gather();
            found_[static_cast<std::size_t>(count_++)] = point.pair;
            return End::kNear;
        }
        if (!leans) break;
        round = kLeaningRounds - 1;
    }
    gather();
    return End::kNear;
}

void VertexSearch::gather() {
    count_ = 0;
    double most = 0;
    for (std::size_t i = 0; i < kSlots; ++i) {
        if ((taken_ >> i & 1u) == 0) continue;
        const auto place = static_cast<std::size_t>(count_++);
        found_[place] = point_[i].pair;
        if (weight_[i] > most) most = weight_[i], std::swap(found_[0], found_[place]);
    }
}

}  // namespace tesserae
