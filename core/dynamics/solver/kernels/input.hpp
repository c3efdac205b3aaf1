// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/dynamics/solver/kernels/lanes.hpp"

// Contacts as they are put into rows: lane by lane, not yet side by side.
namespace tesserae::lanes {

/// Four floats of each lane, as they are put into rows.
using Fours = std::array<std::array<float, 4>, kLanes>;

/// The motions from which slip_by_turning() is computed. If only one body's turning counts, both a
/// and b have it.
struct EightTurning {
    Fours a, b;     ///< angular velocities: xy xz xw yz
    Fours last;     ///< yw zw of a, of b
    Fours against;  ///< velocity of b relative to a, before gravity
};

/// One contact of round bodies for each lane. It is all zero where a lane has none.
struct alignas(32) EightPoints {
    Fours normal, r_a, r_b;
    Fours velocity;  ///< relative velocity at the start
    Fours impulse;   ///< the tangent impulse to start from
    Fours along;     ///< targets of both passes, whether there is one (1), normal impulse
    EightTurning turning;
};

/// A pair of any bodies and its points for each lane. It is all zero where a lane has no pair or
/// point.
struct alignas(32) EightPairs {
    struct Points {
        Fours place;  ///< from the centre
        Fours impulse, along;
    };
    Fours normal;
    Fours centre_a, centre_b;      ///< from the bodies' centres
    Fours velocity;                ///< of b relative to a at the centre, at the start
    std::array<Eight, 6> turning;  ///< relative angular velocity at the start
    Eight rounding;                ///< see least_response()
    std::array<Points, kManifoldPoints> points;
};

template <class F>
[[gnu::always_inline]] inline LaneVec4<F> load(const Lane<F>& lane, const Fours& fours) {
    std::array<const float*, Lane<F>::count> from;
    for (std::size_t i = 0; i < from.size(); ++i) from[i] = lane.at(fours, i).data();
    LaneVec4<F> v;
    load_four(from, v.c);
    return v;
}

}  // namespace tesserae::lanes
