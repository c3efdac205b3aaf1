// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/dynamics/solver/kernels/pair.hpp"

// Motions and impulses at the points of a pair that is not round, in the pair's frame.
namespace tesserae::lanes {

/// The place of a point across the normal, from its pair's centre.
template <class F>
using Place = std::array<F, 3>;

template <class F>
[[gnu::always_inline]] inline Place<F> place_of(const Lane<F>& lane, const GeneralRow& row) {
    const auto& in = lane.template in_row<GeneralRow>();
    return {in.load(row.at[0]), in.load(row.at[1]), in.load(row.at[2])};
}
/// Returns the velocity along the normal at a place.
template <class F>
[[gnu::always_inline]] inline F along_at(const Place<F>& at, const std::array<F, 4>& motion) {
    return fused(at[0], motion[1], motion[0]) + fused(at[1], motion[2], at[2] * motion[3]);
}
/// Returns the velocity across the normal at a place.
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> across_at(const Place<F>& at,
                                                    const std::array<F, 6>& motion) {
    const auto& [x, y, z] = at;
    return {fused(-y, motion[3], fused(-z, motion[4], motion[0])),
            fused(x, motion[3], fused(-z, motion[5], motion[1])),
            fused(x, motion[4], fused(y, motion[5], motion[2])), F{}};
}
/// Returns an impulse across the normal at a place as an impulse and a moment at the centre.
template <class F>
[[gnu::always_inline]] inline std::array<F, 6> seen_from_centre(const Place<F>& at,
                                                                const LaneVec4<F>& q) {
    const auto& [x, y, z] = at;
    return {q[0],
            q[1],
            q[2],
            fused(x, q[1], -(y * q[0])),
            fused(x, q[2], -(z * q[0])),
            fused(y, q[2], -(z * q[1]))};
}

template <class F, std::size_t kSize>
[[gnu::always_inline]] inline void add(const std::array<F, kSize>& x, std::array<F, kSize>& to) {
    for (std::size_t i = 0; i < kSize; ++i) to[i] += x[i];
}
template <class F, class Entry, std::size_t... i>
[[gnu::always_inline]] inline std::array<F, sizeof...(i)> first_of(const Lane<F>& lane,
                                                                   const Entry* from,
                                                                   std::index_sequence<i...>) {
    return {lane.load(from[i])...};
}
template <std::size_t kCount, class F, class Entry>
[[gnu::always_inline]] inline std::array<F, kCount> first_of(const Lane<F>& lane,
                                                             const Entry* from) {
    return first_of(lane, from, std::make_index_sequence<kCount>());
}
template <class F, class Entry, std::size_t kSize>
[[gnu::always_inline]] inline std::array<F, kSize> load_all(const Lane<F>& lane,
                                                            const std::array<Entry, kSize>& from) {
    return first_of<kSize>(lane, from.data());
}
template <class F, class Entry, std::size_t kSize>
[[gnu::always_inline]] inline void store_all(const Lane<F>& lane, const std::array<F, kSize>& x,
                                             std::array<Entry, kSize>& to) {
    for (std::size_t i = 0; i < kSize; ++i) lane.store(x[i], to[i]);
}

template <class F, std::size_t kSize>
[[gnu::always_inline]] inline void add_to(const Lane<F>& lane, const std::array<F, kSize>& x,
                                          std::array<Eight, kSize>& to) {
    for (std::size_t i = 0; i < kSize; ++i) lane.store(lane.load(to[i]) + x[i], to[i]);
}

template <class F, std::size_t kSize>
[[gnu::always_inline]] inline std::array<F, kSize> difference(const std::array<F, kSize>& x,
                                                              const std::array<F, kSize>& y) {
    std::array<F, kSize> of;
    for (std::size_t i = 0; i < kSize; ++i) of[i] = x[i] - y[i];
    return of;
}

template <class F>
[[gnu::always_inline]] inline std::array<F, 21> across_response(const Lane<F>& lane,
                                                                ColouredIslands& coloured,
                                                                std::uint32_t index) {
    return load_all(lane.template in_batch<PairFriction>(),
                    coloured.pair_friction[index].response.across);
}

/// Adds k x to `to`.
template <class F, class Entry, std::size_t kSize>
[[gnu::always_inline]] inline void add_scaled(const Lane<F>& lane,
                                              const std::array<Entry, kSize>& x, F k,
                                              std::array<F, kSize>& to) {
    for (std::size_t i = 0; i < kSize; ++i) to[i] = fused(lane.load(x[i]), k, to[i]);
}

}  // namespace tesserae::lanes
