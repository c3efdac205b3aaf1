// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "core/dynamics/solver/kernels/place.hpp"
#include "core/dynamics/solver/kernels/row.hpp"

// The normal impulses at the points of a pair that is not round, in turn. Each impulse changes the
// normal velocities of the other points by their point responses. That takes fewer operations
// between two points than the motion of the pair would.
namespace tesserae::lanes {

/// The normal impulses of a batch's pairs while they are solved.
/// @tparam kPoints   padded_points()
template <std::size_t kPoints, class F>
class PairNormals {
    using All = std::make_index_sequence<kPoints>;
    static constexpr std::size_t kResponses = responses_of(kPoints);

  public:
    /// @param motion   of the pair, along the normal
    [[gnu::always_inline]] PairNormals(const Lane<F>& lane, ColouredIslands& coloured,
                                       const Batch& batch, Pass pass,
                                       const std::array<F, 4>& motion)
        : lane_(lane),
          lanes_{lane.template in_row<GeneralRow>(), lane.template in_row<Eight>()},
          rows_(&coloured.rows[batch.row]),
          impulses_(&coloured.impulses.normal[batch.row]),
          response_(
              first_of<kResponses>(lane.in_responses(), &coloured.point_response[batch.response])),
          count_(batch.rows),
          change_{} {
        see(&coloured.second[batch.row], pass, motion, All());
    }

    /// Goes through all points once.
    /// @tparam kFirst   whether another pass over all points follows
    /// @return the largest velocity that was left to solve, if `measured`
    template <bool kBackward, bool kFirst>
    [[gnu::always_inline]] F solve(bool measured) {
        return solve<kBackward, kFirst>(measured, All());
    }

    /// Adds the changes of the impulses, as an impulse and a moment at the pair's centre.
    [[gnu::always_inline]] void add_impulse(std::array<F, 4>& impulse) const {
        add_impulse(impulse, All());
    }

  private:
    template <std::size_t... k>
    [[gnu::always_inline]] void see(const Eight* second, Pass pass, const std::array<F, 4>& motion,
                                    std::index_sequence<k...>) {
        ((left_[k] = k < count_ ? target_of(lanes_, rows_[k].along, second[k], pass) -
                                      along_at(place_of(lane_, rows_[k]), motion)
                                : F{}),
         ...);
    }
    template <bool kBackward, bool kFirst, std::size_t... i>
    [[gnu::always_inline]] F solve(bool measured, std::index_sequence<i...>) {
        F left{};
        (solve_point < kBackward ? kPoints - 1 - i : i, kBackward, kFirst > (measured, left, All()),
         ...);
        return left;
    }
    template <std::size_t k, bool kBackward, bool kFirst, std::size_t... j>
    [[gnu::always_inline]] void solve_point(bool measured, F& left, std::index_sequence<j...>) {
        if (k >= count_) return;
        const F change = solve_normal(lanes_, rows_[k].along, left_[k], impulses_[k]);
        change_[k] += change;
        ((kFirst || (kBackward ? j < k : j > k)
              ? void(left_[j] = fused(-change, response(k, j), left_[j]))
              : void()),
         ...);
        if (measured) left = larger(left, magnitude(change) * response(k, k));
    }
    template <std::size_t... k>
    [[gnu::always_inline]] void add_impulse(std::array<F, 4>& impulse,
                                            std::index_sequence<k...>) const {
        (add_impulse_at(k, impulse), ...);
    }
    [[gnu::always_inline]] void add_impulse_at(std::size_t k, std::array<F, 4>& impulse) const {
        if (k >= count_) return;
        const Place<F> at = place_of(lane_, rows_[k]);
        impulse = {impulse[0] + change_[k], fused(change_[k], at[0], impulse[1]),
                   fused(change_[k], at[1], impulse[2]), fused(change_[k], at[2], impulse[3])};
    }
    [[gnu::always_inline]] F response(std::size_t i, std::size_t j) const {
        return response_[i < j ? j * (j + 1) / 2 + i : i * (i + 1) / 2 + j];
    }

    const Lane<F>& lane_;
    const NormalLanes<F> lanes_;
    const GeneralRow* const rows_;
    Eight* const impulses_;
    const std::array<F, kResponses> response_;
    const std::uint32_t count_;
    std::array<F, kPoints> left_, change_;
};

}  // namespace tesserae::lanes
