// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/algebra/vector.hpp"
#include "core/simd/simd.hpp"

namespace tesserae {

/// LinearForms holds many functions normal . x - offset and evaluates four at a time.
class LinearForms {
  public:
    void add(const Vec4& normal, double offset) {
        if (count_ % 4 == 0) fours_.emplace_back();
        Four& four = fours_.back();
        // It is repeated in the unused lanes: of equal ones the first counts.
        for (std::size_t lane = count_ % 4; lane < 4; ++lane) {
            for (std::size_t axis = 0; axis < 4; ++axis)
                four.normal[axis][lane] = normal[static_cast<Eigen::Index>(axis)];
            four.offset[lane] = offset;
        }
        ++count_;
    }

    /// A Largest is the function that is largest at a point.
    struct Largest {
        std::uint32_t number;  ///< of the function; of equal ones the lowest
        double value;
    };
    Largest largest_at(const Vec4& x) const {
        using namespace simd;
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        Double4 best = all_four(-kInfinity), place = {};
        Double4 here = {0, 1, 2, 3};
        for (const Four& four : fours_) {
            const Double4 value = slopes(four, x) - four.offset;
            const Mask4 is_larger = value > best;
            best = is_larger ? value : best;
            place = is_larger ? here : place;
            here += 4;
        }
        // No branches: which lane has the largest cannot be predicted.
        const double value = largest_lane(best);
        const double number = smallest_lane(best == value ? place : all_four(kInfinity));
        return {static_cast<std::uint32_t>(number), value};
    }

    /// An Interval is the part of a ray where all functions are at most 0, from `enter` to `leave`.
    /// If leave < enter it is empty.
    struct Interval {
        double enter, leave;
    };
    Interval not_positive_on(const Vec4& origin, const Vec4& direction) const {
        using namespace simd;
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        Double4 enter = all_four(-kInfinity), leave = all_four(kInfinity);
        Mask4 misses = {};
        for (const Four& four : fours_) {
            const Double4 height = slopes(four, origin) - four.offset;
            const Double4 slope = slopes(four, direction);
            const Double4 meets = -height / slope;
            enter = slope < 0 ? larger(meets, enter) : enter;
            leave = slope > 0 ? smaller(meets, leave) : leave;
            misses |= (slope == 0) & (height > 0);
        }
        if (lanes_set(misses) != 0) return {kInfinity, -kInfinity};
        return {largest_lane(enter), smallest_lane(leave)};
    }

  private:
    struct Four {
        std::array<simd::Double4, 4> normal;
        simd::Double4 offset;
    };
    static simd::Double4 slopes(const Four& four, const Vec4& x) {
        return four.normal[0] * x[0] + four.normal[1] * x[1] + four.normal[2] * x[2] +
               four.normal[3] * x[3];
    }

    std::vector<Four> fours_;
    std::size_t count_ = 0;
};

}  // namespace tesserae
