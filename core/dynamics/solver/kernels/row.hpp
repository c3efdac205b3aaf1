// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/dynamics/solver/kernels/lanes.hpp"
#include "core/dynamics/solver/sweep.hpp"

// Single rows of coloured islands, lane by lane.
namespace tesserae::lanes {

/// Where the normal parts of rows are: in their rows, and in lists of one Eight each.
template <class F>
struct NormalLanes {
    Lane<F> in_row, in_list;
};

/// Writes the normal mass of a row.
/// @param exists     1, or 0 for points that a lane does not have
/// @param response   change of the normal velocity by a unit impulse; up to `least` the mass is 0
template <class F>
[[gnu::always_inline]] inline void make_normal(const Lane<F>& lane, F exists, F response, F least,
                                               NormalRow& row) {
    const F inverse = (F{} + 1.0f) / response;
    lane.store(response > least ? (exists > F{} ? inverse : F{}) : F{}, row.mass);
}
/// Writes the targets and the first normal impulse of a row.
/// @param fours   targets of the first and the second pass, whether the point exists, normal
///                impulse
/// @param place   of the row in `second` and `impulses`
/// @return the impulse to start from
template <class F>
[[gnu::always_inline]] inline F start_normal(const NormalLanes<F>& lanes, const LaneVec4<F>& fours,
                                             std::size_t place, NormalRow& row,
                                             std::vector<Eight>& second,
                                             std::vector<Eight>& impulses) {
    lanes.in_row.store(fours[0], row.target);
    lanes.in_list.store(fours[1], second[place]);
    lanes.in_list.store(fours[3], impulses[place]);
    return fours[3];
}

/// Returns the normal velocity that a pass aims at, less that of the start.
template <class F>
[[gnu::always_inline]] inline F target_of(const NormalLanes<F>& lanes, const NormalRow& row,
                                          const Eight& second, Pass pass) {
    return aims_at_first(pass) ? lanes.in_row.load(row.target) : lanes.in_list.load(second);
}
/// Does one step of a normal impulse.
/// @param left   the target less the present normal velocity
/// @return the change of the impulse
template <class F>
[[gnu::always_inline]] inline F solve_normal(const NormalLanes<F>& lanes, const NormalRow& row,
                                             F left, Eight& impulse) {
    const F old = lanes.in_list.load(impulse);
    const F change =
        larger(lanes.in_row.load(row.mass) * left, -old);  // sooner there than by the impulse
    lanes.in_list.store(old + change, impulse);
    return change;
}

/// Returns the impulse nearest to a given one whose length is at most `most`; zero stays zero.
template <class F, template <class> class Impulse>
[[gnu::always_inline]] inline Impulse<F> clamped(const Impulse<F>& impulse, F most) {
    const F squared = dot(impulse, impulse);
    const F scale = squared > most * most ? most / square_root(squared) : F{} + 1.0f;
    return scale * impulse;
}

/// Returns the velocity that was left to solve [m/s]: a change of impulse over its mass.
template <class F>
[[gnu::always_inline]] inline F velocity_left(F mass, F change) {
    return mass > F{} ? magnitude(change) / mass : F{};
}
/// Returns the square of the velocity that was left to solve, for an impulse across the normal.
template <class F>
[[gnu::always_inline]] inline F squared_velocity_left(F mass, const LaneVec4<F>& change) {
    const LaneVec4<F> left = (mass > F{} ? (F{} + 1.0f) / mass : F{}) * change;
    return dot(left, left);
}

}  // namespace tesserae::lanes
