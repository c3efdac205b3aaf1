// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <type_traits>

#include "core/dynamics/solver/kernels/normals.hpp"

// Sweeps over batches of pairs that are not round.
namespace tesserae::lanes {

/// Finds out whether any point of a batch slides. Where some did in the last sweep, most will
/// again. Asking each of them then costs more, by mispredicted branches, than computing how it
/// slides.
template <class F>
struct Sliding {
    bool expected;
    F excess{};  ///< largest excess of a point's squared impulse over what is allowed

    bool any() const { return !simd::nowhere_above(excess, F{}); }
};

/// Returns the friction impulse of a point as friction_impulse() of the one-by-one solver does, in
/// the frame, or the rolling impulse as solve_part() does.
template <class F, class Mass>
[[gnu::always_inline]] inline LaneVec4<F> friction_impulse(
    const Lane<F>& lane, const std::array<Mass, 6>& masses, const Mass& slide_mass,
    const LaneVec4<F>& old, const LaneVec4<F>& slip, F most, Sliding<F>& slides) {
    const LaneVec4<F> sticking = old - times(load_all(lane, masses), slip);
    // Where nothing is allowed there is nothing to find.
    const F squared = dot(sticking, sticking), allowed = most * most;
    const auto holds = most > F{};
    const auto only = [&](auto where, const LaneVec4<F>& v, const LaneVec4<F>& w) {
        return LaneVec4<F>{where ? v[0] : w[0], where ? v[1] : w[1], where ? v[2] : w[2], F{}};
    };
    const F to_hold = holds ? squared : F{};
    if (!slides.expected && simd::nowhere_above(to_hold, allowed)) return only(holds, sticking, {});
    slides.excess = larger(slides.excess, to_hold - allowed);
    const LaneVec4<F> sliding = clamped<F>(sum(old, -lane.load(slide_mass), slip), most);
    return only(holds, only(squared <= allowed, sticking, sliding), {});
}

/// The batch whose points are solved, and the sweep over it.
template <class F>
struct PairSweep {
    ColouredIslands& coloured;
    std::span<Batch, Lane<F>::batches> batches;
    Sweep sweep;
    const Batch& batch = batches[0];

    /// Returns the row of a point, in the order of the sweep.
    [[gnu::always_inline]] std::uint32_t row(std::uint32_t i) const {
        return batch.row + (sweep.backward ? batch.rows - 1 - i : i);
    }
};

/// The motion of a pair while its points are solved, and the impulses on it so far, both at the
/// centre. Impulses along the normal change the motion along it at once and that across it by
/// see_along(); impulses across the normal do the reverse.
template <class F>
struct PairMotion {
    FrameScrew<F> motion, impulse{};

    /// Changes the motion across the normal by impulses along it.
    /// @param change   change of the impulses since the last call
    [[gnu::always_inline]] void see_along(const Lane<F>& lane, ColouredIslands& coloured,
                                          std::uint32_t index, const std::array<F, 4>& change) {
        const AcrossResponse& response = coloured.pair_friction[index].response;
        for (std::size_t i = 0; i < 4; ++i)
            add_scaled(lane.template in_batch<PairFriction>(), response.along[i], change[i],
                       motion.across);
    }
    [[gnu::always_inline]] void see_across(const Lane<F>& lane, ColouredIslands& coloured,
                                           std::uint32_t index) {
        const auto& in = lane.template in_batch<PairFriction>();
        const AcrossResponse& response = coloured.pair_friction[index].response;
        for (std::size_t j = 0; j < 6; ++j)
            for (std::size_t i = 0; i < 4; ++i)
                motion.along[i] =
                    fused(in.load(response.along[i][j]), impulse.across[j], motion.along[i]);
    }
};

/// Solves the normal impulses of all points, in the order of the sweep and then in reverse, which
/// is its own adjoint. The points that come last get closest to their aim, so that pairs lean if
/// they are gone through in one order only. It is not inlined: the points' velocities then have all
/// registers.
/// @return the largest velocity that was left to solve, if it is measured
template <std::size_t kPoints, class F>
[[gnu::noinline]] F solve_normals_of(const PairSweep<F>& pair, const Lane<F>& lane,
                                     PairMotion<F>& of) {
    const auto& [pass, backward, measured, adjoint] = pair.sweep;
    PairNormals<kPoints, F> normals(lane, pair.coloured, pair.batch, pass, of.motion.along);
    F left;
    if (backward) {
        left = normals.template solve<true, true>(measured);
        normals.template solve<false, false>(false);
    } else {
        left = normals.template solve<false, true>(measured);
        normals.template solve<true, false>(false);
    }
    normals.add_impulse(of.impulse.along);
    return left;
}
template <class F>
[[gnu::always_inline]] inline void solve_normals(const Lane<F>& lane, const PairSweep<F>& pair,
                                                 PairMotion<F>& of, F& left) {
    const auto solve = [&] {
        switch (padded_points(pair.batch.rows)) {
            case 1:
                return solve_normals_of<1>(pair, lane, of);
            case 2:
                return solve_normals_of<2>(pair, lane, of);
            case 4:
                return solve_normals_of<4>(pair, lane, of);
            default:
                return solve_normals_of<8>(pair, lane, of);
        }
    };
    left = larger(left, solve());
}

/// The friction of one point.
template <class F>
struct FrictionPoint {
    std::array<Eight, 3>& impulse;
    const GeneralFriction& row;
    Place<F> at;
    F most;

    [[gnu::always_inline]] FrictionPoint(const Lane<F>& lane, const PairSweep<F>& pair, F mu,
                                         std::uint32_t k)
        : impulse(pair.coloured.impulses.tangent[k]),
          row(pair.coloured.general_friction[k]),
          at(place_of(lane, pair.coloured.rows[k])),
          // A step along a direction may have made a normal impulse negative.
          most(mu *
               larger(lane.template in_row<Eight>().load(pair.coloured.impulses.normal[k]), F{})) {}

    /// Does one step of the point's friction.
    /// @param share   part of the slip that it ends
    /// @return the change of the impulse
    [[gnu::always_inline]] LaneVec4<F> solve(const Lane<F>& lane, const std::array<F, 6>& motion,
                                             F share, Sliding<F>& slides) const {
        const auto& in = lane.template in_row<std::array<Eight, 3>>();
        const LaneVec4<F> old = load(in, impulse);
        const LaneVec4<F> slip = share * across_at(at, motion);
        const LaneVec4<F> all = friction_impulse(lane.template in_row<GeneralFriction>(), row.mass,
                                                 row.slide_mass, old, slip, most, slides);
        store(in, all, impulse);
        return all - old;
    }
    /// Returns the square of the velocity that was left to solve.
    [[gnu::always_inline]] F squared_left(const Lane<F>& lane, const LaneVec4<F>& change,
                                          F share) const {
        const auto& in = lane.template in_row<GeneralFriction>();
        return squared_velocity_left(share * in.load(row.slide_mass), change);
    }
};

/// Solves the friction of all points, two at a time: the first and the last, and so on inward. Each
/// ends half of its slip if both bear a load. This does not overshoot, as their response to each
/// other is at most the mean of their own responses. Two points need not wait for each other, and
/// the pair's motion is computed half as often.
template <class F>
[[gnu::always_inline]] inline void solve_friction(const Lane<F>& lane, const PairSweep<F>& pair,
                                                  std::uint32_t index, PairMotion<F>& of, F& left) {
    const auto& in = lane.template in_batch<PairFriction>();
    const F mu = in.load(pair.coloured.pair_friction[index].friction), one = F{} + 1.0f;
    const std::array<F, 21> response = across_response(lane, pair.coloured, index);
    const std::uint32_t rows = pair.batch.rows, twos = rows / 2, steps = rows - twos;
    F squared_left{};
    Sliding<F> slides{false};
    for (const Batch& batch : pair.batches) slides.expected |= batch.slides;
    for (std::uint32_t i = 0; i < steps; ++i) {
        const std::uint32_t k = pair.sweep.backward ? steps - 1 - i : i;
        const FrictionPoint<F> first(lane, pair, mu, pair.batch.row + k);
        std::array<F, 6> seen;
        if (k < twos) {
            const FrictionPoint<F> last(lane, pair, mu, pair.batch.row + rows - 1 - k);
            const F least = first.most < last.most ? first.most : last.most;
            const F share = least > F{} ? F{} + 0.5f : one;
            const LaneVec4<F> change = first.solve(lane, of.motion.across, share, slides);
            const LaneVec4<F> other = last.solve(lane, of.motion.across, share, slides);
            seen = seen_from_centre(first.at, change);
            add(seen_from_centre(last.at, other), seen);
            if (pair.sweep.measured)
                squared_left = larger(squared_left, larger(first.squared_left(lane, change, share),
                                                           last.squared_left(lane, other, share)));
        } else {
            const LaneVec4<F> change = first.solve(lane, of.motion.across, one, slides);
            seen = seen_from_centre(first.at, change);
            if (pair.sweep.measured)
                squared_left = larger(squared_left, first.squared_left(lane, change, one));
        }
        add(seen, of.impulse.across);
        add_product(response, seen, of.motion.across);
    }
    if (pair.sweep.measured) left = larger(left, square_root(squared_left));
    const bool any = slides.any();
    for (Batch& batch : pair.batches) batch.slides = any;
}

/// Solves the rolling or the twisting of all points.
/// @param motion, impulse, response   along or across the normal; the three from `first` on turn
/// @param part                        place of a row's first impulse
template <class F, std::size_t kSize, std::size_t kEntries>
[[gnu::always_inline]] inline void solve_turning(const Lane<F>& lane, const PairSweep<F>& pair,
                                                 std::size_t first, F arm,
                                                 const std::array<Eight, 6>& mass,
                                                 const Eight& step_mass,
                                                 const std::array<F, kEntries>& response,
                                                 std::size_t part, std::array<F, kSize>& motion,
                                                 std::array<F, kSize>& impulse) {
    Sliding<F> slides{false};
    const auto& in = lane.template in_row<GeneralRolling>();
    for (std::uint32_t i = 0; i < pair.batch.rows; ++i) {
        const std::uint32_t k = pair.row(i);
        GeneralRolling& row = pair.coloured.general_rolling[k];
        LaneVec4<F> old{};
        for (std::size_t j = 0; j < 3; ++j) old[j] = in.load(row.impulse[part + j]);
        const LaneVec4<F> slip = {motion[first], motion[first + 1], motion[first + 2], F{}};
        const F normal = lane.template in_row<Eight>().load(pair.coloured.impulses.normal[k]);
        const LaneVec4<F> all = friction_impulse(lane.template in_batch<PairRolling>(), mass,
                                                 step_mass, old, slip, arm * normal, slides);
        std::array<F, kSize> change{};
        for (std::size_t j = 0; j < 3; ++j) {
            in.store(all[j], row.impulse[part + j]);
            change[first + j] = all[j] - old[j];
        }
        add(change, impulse);
        add_product(response, change, motion);
    }
}
template <class F>
[[gnu::always_inline]] inline void solve_rolling(const Lane<F>& lane, const PairSweep<F>& pair,
                                                 const PairRolling& rolling, PairMotion<F>& of) {
    const auto& in = lane.template in_batch<PairRolling>();
    solve_turning(lane, pair, 1, in.load(rolling.arm), rolling.rolling_mass, rolling.rolling_step,
                  load_all(in, rolling.response), 0, of.motion.along, of.impulse.along);
}
template <class F>
[[gnu::always_inline]] inline void solve_twisting(const Lane<F>& lane, const PairSweep<F>& pair,
                                                  const PairRolling& rolling, std::uint32_t index,
                                                  PairMotion<F>& of) {
    const F arm = lane.template in_batch<PairRolling>().load(rolling.arm);
    solve_turning(lane, pair, 3, arm, rolling.twisting_mass, rolling.twisting_step,
                  across_response(lane, pair.coloured, index), 3, of.motion.across,
                  of.impulse.across);
}

/// Solves normal impulses, friction, rolling and twisting in this order; each sees the changes by
/// those before it.
template <bool kFriction, bool kRolling, class F>
[[gnu::always_inline]] inline void solve_parts(const Lane<F>& lane, const PairSweep<F>& pair,
                                               std::uint32_t index, PairMotion<F>& of, F& left) {
    solve_normals(lane, pair, of, left);
    if constexpr (kFriction) {
        of.see_along(lane, pair.coloured, index, of.impulse.along);
        solve_friction(lane, pair, index, of, left);
        if constexpr (kRolling) {
            const PairRolling& rolling = pair.coloured.pair_rolling[index];
            add_product(load_all(lane.template in_batch<PairRolling>(), rolling.response),
                        of.impulse.along, of.motion.along);
            of.see_across(lane, pair.coloured, index);
            const std::array<F, 4> seen = of.impulse.along;
            solve_rolling(lane, pair, rolling, of);
            of.see_along(lane, pair.coloured, index, difference(of.impulse.along, seen));
            solve_twisting(lane, pair, rolling, index, of);
        }
    }
}
/// Solves friction and then normal impulses: the adjoint of solve_parts(). It has no rolling, with
/// which there is no adjoint.
template <bool kFriction, class F>
[[gnu::always_inline]] inline void solve_parts_adjoint(const Lane<F>& lane,
                                                       const PairSweep<F>& pair,
                                                       std::uint32_t index, PairMotion<F>& of,
                                                       F& left) {
    if constexpr (kFriction) {
        solve_friction(lane, pair, index, of, left);
        of.see_across(lane, pair.coloured, index);
    }
    solve_normals(lane, pair, of, left);
}

/// Does one sweep over a batch, or over two.
/// @return the largest velocity that was left to solve, if it is measured
template <bool kFriction, bool kRolling, bool kUneven, class F>
[[gnu::always_inline]] inline F solve_points(ColouredIslands& coloured, const Lane<F>& lane,
                                             std::uint32_t index, Sweep sweep) {
    const PairFrame& pair_frame = coloured.frames[index];
    LanePair<F, kUneven> bodies(lane, coloured, index);
    const auto& in_frame = lane.template in_batch<PairFrame>();
    const Frame<F> frame(load(in_frame, pair_frame.h));
    const std::span<Batch, Lane<F>::batches> batches(&coloured.general[index], Lane<F>::batches);
    const PairSweep<F> pair = {coloured, batches, sweep};
    PairMotion<F> of = {frame.from_world(bodies.motion())};
    add(load_all(in_frame, pair_frame.motion), of.motion.along);
    if constexpr (kFriction)
        add(load_all(lane.template in_batch<PairFriction>(), coloured.pair_friction[index].motion),
            of.motion.across);
    F left{};
    if (sweep.adjoint)
        solve_parts_adjoint<kFriction>(lane, pair, index, of, left);
    else
        solve_parts<kFriction, kRolling>(lane, pair, index, of, left);
    bodies.apply(frame.to_world(of.impulse));
    if (sweep.measured) lane.template in_batch<Eight>().store(left, coloured.general_left[index]);
    return left;
}

/// Calls sweep(as kFriction, as kRolling, as kUneven), each a std::bool_constant.
template <class Call>
auto with_kind_of_general(const ColouredIslands& coloured, Pass pass, const Call& call) {
    constexpr std::true_type yes;
    constexpr std::false_type no;
    const bool by_normals = is_by_normals(pass);
    if (coloured.rolling && !by_normals)
        return coloured.turns_unevenly ? call(yes, yes, yes) : call(yes, yes, no);
    if (coloured.friction && !by_normals)
        return coloured.turns_unevenly ? call(yes, no, yes) : call(yes, no, no);
    return coloured.turns_unevenly ? call(no, no, yes) : call(no, no, no);
}

}  // namespace tesserae::lanes
