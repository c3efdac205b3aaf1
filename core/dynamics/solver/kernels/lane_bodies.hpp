// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstring>

#include "core/dynamics/solver/kernels/lanes.hpp"

// The changes of one body for each lane.
namespace tesserae::lanes {

/// The motion of each lane's body.
template <class F>
struct Motion {
    LaneVec4<F> velocity;
    LaneBivector<F> angular_velocity;
    F inverse_mass, inverse_inertia;
};

/// The BodyChange of one body of each lane.
template <class F>
struct LaneChange {
    std::array<F, 4> velocity, first_planes, rest;
};

/// Finds where the records are read and written. The first record of all is only read.
template <class F, std::size_t kCount>
[[gnu::always_inline]] inline void find_records(const Lane<F>& in_batch,
                                                const std::array<std::uint32_t, kLanes>& places,
                                                BodyChange* records, BodyChange* nowhere,
                                                std::array<const BodyChange*, kCount>& from,
                                                std::array<BodyChange*, kCount>& to) {
    for (std::size_t i = 0; i < kCount; ++i) {
        const std::uint32_t place = in_batch.at(places, i);
        from[i] = records + place;
        to[i] = place == 0 ? nowhere : records + place;
    }
}
template <std::array<float, 4> BodyChange::*kPart, class Record, std::size_t kCount>
[[gnu::always_inline]] inline auto parts_of(const std::array<Record*, kCount>& records) {
    std::array<decltype((records[0]->*kPart).data()), kCount> parts;
    for (std::size_t i = 0; i < kCount; ++i) parts[i] = (records[i]->*kPart).data();
    return parts;
}
template <class F, std::size_t kCount>
[[gnu::always_inline]] inline void load_changes(const std::array<const BodyChange*, kCount>& from,
                                                LaneChange<F>& to) {
    load_four(parts_of<&BodyChange::velocity>(from), to.velocity);
    load_four(parts_of<&BodyChange::first_planes>(from), to.first_planes);
    load_four(parts_of<&BodyChange::rest>(from), to.rest);
}
template <class F, std::size_t kCount>
[[gnu::always_inline]] inline void store_changes(const LaneChange<F>& from,
                                                 const std::array<BodyChange*, kCount>& to) {
    store_four(from.velocity, parts_of<&BodyChange::velocity>(to));
    store_four(from.first_planes, parts_of<&BodyChange::first_planes>(to));
    store_four(from.rest, parts_of<&BodyChange::rest>(to));
}

#ifdef __AVX512F__
/// Finds the records of sixteen lanes, eight addresses at a time.
[[gnu::always_inline]] inline void find_records(const Lane<Float16>& in_batch,
                                                const std::array<std::uint32_t, kLanes>& places,
                                                BodyChange* records, BodyChange* nowhere,
                                                std::array<const BodyChange*, 2 * kLanes>& from,
                                                std::array<BodyChange*, 2 * kLanes>& to) {
    using Places = std::uint32_t __attribute__((vector_size(4 * kLanes)));
    using Addresses = std::uint64_t __attribute__((vector_size(8 * kLanes)));
    for (std::size_t i = 0; i < 2 * kLanes; i += kLanes) {
        Places place;
        std::memcpy(&place, &in_batch.at(places, i), sizeof place);
        const Addresses wide = __builtin_convertvector(place, Addresses);
        const Addresses at = wide * sizeof(BodyChange) + reinterpret_cast<std::uintptr_t>(records);
        const Addresses none = Addresses{} + reinterpret_cast<std::uintptr_t>(nowhere);
        const Addresses writable = wide == 0 ? none : at;
        std::memcpy(&from[i], &at, sizeof at);
        std::memcpy(&to[i], &writable, sizeof writable);
    }
    // In memory: to take them out of registers one by one is slower.
    asm("" : "+m"(from), "+m"(to));
}

/// Transposes a matrix of four by four whose entries are fours of lanes.
[[gnu::always_inline]] inline std::array<Float16, 4> fours_transposed(
    const std::array<Float16, 4>& r) {
    const Float16 a = _mm512_shuffle_f32x4(r[0], r[1], 0x44);
    const Float16 b = _mm512_shuffle_f32x4(r[0], r[1], 0xee);
    const Float16 c = _mm512_shuffle_f32x4(r[2], r[3], 0x44);
    const Float16 d = _mm512_shuffle_f32x4(r[2], r[3], 0xee);
    return {_mm512_shuffle_f32x4(a, c, 0x88), _mm512_shuffle_f32x4(a, c, 0xdd),
            _mm512_shuffle_f32x4(b, d, 0x88), _mm512_shuffle_f32x4(b, d, 0xdd)};
}
static_assert(sizeof(BodyChange) == sizeof(Float16));
/// Loads whole records of sixteen bodies: one read for each body instead of three.
[[gnu::always_inline]] inline void load_changes(
    const std::array<const BodyChange*, 2 * kLanes>& from, LaneChange<Float16>& to) {
    std::array<std::array<Float16, 4>, 4> r;  // of four bodies each
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t i = 0; i < 4; ++i) r[k][i] = _mm512_load_ps(from[4 * k + i]);
        r[k] = transposed(r[k]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const std::array<Float16, 4> x = fours_transposed({r[0][i], r[1][i], r[2][i], r[3][i]});
        to.velocity[i] = x[0], to.first_planes[i] = x[1], to.rest[i] = x[2];
    }
}
[[gnu::always_inline]] inline void store_changes(const LaneChange<Float16>& from,
                                                 const std::array<BodyChange*, 2 * kLanes>& to) {
    std::array<std::array<Float16, 4>, 4> r;  // of four bodies each
    for (std::size_t i = 0; i < 4; ++i) {
        const std::array<Float16, 4> x =
            fours_transposed({from.velocity[i], from.first_planes[i], from.rest[i], Float16{}});
        for (std::size_t k = 0; k < 4; ++k) r[k][i] = x[k];
    }
    for (std::size_t k = 0; k < 4; ++k) {
        r[k] = transposed(r[k]);
        for (std::size_t i = 0; i < 4; ++i) _mm512_store_ps(to[4 * k + i], r[k][i]);
    }
}
#endif

/// The records of one body of each lane.
template <class F>
class LaneBodies {
    static constexpr std::size_t kCount = Lane<F>::count;

  public:
    [[gnu::always_inline]] LaneBodies(const Lane<F>& lane, BodyChange* records,
                                      const std::array<std::uint32_t, kLanes>& places) {
        find_records(lane.template in_batch<Batch>(), places, records, &nowhere_, from_, to_);
    }
    LaneBodies(const LaneBodies&) = delete;
    LaneBodies& operator=(const LaneBodies&) = delete;

    /// Loads the bodies' motion.
    /// @tparam kTurns   with the angular velocity
    template <bool kTurns>
    [[gnu::always_inline]] Motion<F> load() const {
        LaneChange<F> of;
        load_changes(from_, of);
        const std::array<F, 4>&w = of.first_planes, &last = of.rest;
        Motion<F> m{{of.velocity}, {}, last[2], last[3]};
        if constexpr (kTurns) m.angular_velocity = {w[0], w[1], w[2], w[3], last[0], last[1]};
        return m;
    }
    template <bool kTurns>
    [[gnu::always_inline]] void store(const Motion<F>& m) {
        if constexpr (kTurns) {
            const LaneBivector<F>& w = m.angular_velocity;
            const LaneChange<F> of = {m.velocity.c,
                                      {w[0], w[1], w[2], w[3]},
                                      {w[4], w[5], m.inverse_mass, m.inverse_inertia}};
            store_changes(of, to_);
        } else {
            store_four(m.velocity.c, parts_of<&BodyChange::velocity>(to_));
        }
    }

  private:
    BodyChange nowhere_;
    std::array<const BodyChange*, kCount> from_;
    std::array<BodyChange*, kCount> to_;
};

}  // namespace tesserae::lanes
