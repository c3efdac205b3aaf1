#pragma once

#include <utility>

#include "core/dynamics/solver/coloured_place.hpp"
#include "core/dynamics/solver/coloured_points.hpp"

// The normal impulses of a pair that is not round, on all of its points in turn. Each changes the
// normal velocities of the others by their point responses: so much shorter a way from one to the
// next than by the motion of the pair.
namespace tesserae::lanes {

/// @tparam kPoints   padded_points()
template <std::size_t kPoints, class F>
class PairNormals {
    using All = std::make_index_sequence<kPoints>;
    static constexpr std::size_t kResponses = responses_of(kPoints);

  public:
    /// @param motion   of the pair, along the normal
    [[gnu::always_inline]] PairNormals(const Lane<F>& lane, ColouredIslands& coloured,
                                       const Batch& batch, const std::array<F, 4>& motion)
        : lane_(lane),
          rows_(&coloured.rows[batch.row]),
          relax_targets_(&coloured.relax.target[batch.row]),
          keep_(keep_from(coloured.relax, batch.row)),
          impulses_(&coloured.impulses.normal[batch.row]),
          response_(first_of<kResponses>(lane, &coloured.point_response[batch.response])),
          count_(batch.rows),
          change_{} {
        see(motion, All());
    }

    /// Once through all points.
    /// @tparam kFirst   else what a point does to those before it is of no use any more
    /// @return the largest velocity that was left to solve, if `measured`
    template <bool kBackward, bool kFirst>
    [[gnu::always_inline]] F solve(Pass pass, bool measured) {
        return solve<kBackward, kFirst>(pass, measured, All());
    }

    /// What the impulses have changed by, seen from the centre.
    [[gnu::always_inline]] void add_impulse(std::array<F, 4>& impulse) const {
        add_impulse(impulse, All());
    }

  private:
    template <std::size_t... k>
    [[gnu::always_inline]] void see(const std::array<F, 4>& motion, std::index_sequence<k...>) {
        ((velocity_[k] = k < count_ ? along_at(place_of(lane_, rows_[k]), motion) : F{}), ...);
    }
    template <bool kBackward, bool kFirst, std::size_t... i>
    [[gnu::always_inline]] F solve(Pass pass, bool measured, std::index_sequence<i...>) {
        F left{};
        (solve_point < kBackward ? kPoints - 1 - i : i, kBackward,
         kFirst > (pass, measured, left, All()), ...);
        return left;
    }
    template <std::size_t k, bool kBackward, bool kFirst, std::size_t... j>
    [[gnu::always_inline]] void solve_point(Pass pass, bool measured, F& left,
                                            std::index_sequence<j...>) {
        if (k >= count_) return;
        const F change =
            solve_normal(lane_, rows_[k].along, relax_targets_[k], keep_ ? keep_ + k : nullptr,
                         velocity_[k], pass, impulses_[k]);
        change_[k] += change;
        ((kFirst || (kBackward ? j < k : j > k)
              ? void(velocity_[j] = fused(change, response(k, j), velocity_[j]))
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
    const GeneralRow* const rows_;
    const Eight *const relax_targets_, *const keep_;
    Eight* const impulses_;
    const std::array<F, kResponses> response_;
    const std::uint32_t count_;
    std::array<F, kPoints> velocity_, change_;
};

}  // namespace tesserae::lanes
