// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "core/dynamics/solver/kernels/coloured_islands.hpp"
#include "core/dynamics/solver/kernels/lane_bodies.hpp"

// The bodies of a pair that is not round, lane by lane, and the frame of its contacts.
namespace tesserae::lanes {

/// Returns the place of entry (i, j) in the upper triangle of a symmetric matrix of kSize, row by
/// row.
template <std::size_t kSize>
constexpr std::size_t in_triangle(std::size_t i, std::size_t j) {
    return i <= j ? i * kSize - i * (i + 1) / 2 + j : in_triangle<kSize>(j, i);
}

/// The inverse inertias of one body of each lane.
/// @tparam kUneven   false: they are one number for each body
template <class F, bool kUneven>
class Inverse {
  public:
    [[gnu::always_inline]] Inverse(const Lane<F>&, const LaneInertia*, F scalar)
        : scalar_(scalar) {}
    [[gnu::always_inline]] LaneBivector<F> of(const LaneBivector<F>& moment) const {
        return scalar_ * moment;
    }
    /// Returns the change of angular velocity by a unit moment in a plane.
    [[gnu::always_inline]] LaneBivector<F> column(std::size_t plane) const {
        LaneBivector<F> w{};
        w[plane] = scalar_;
        return w;
    }

  private:
    F scalar_;
};
template <class F>
class Inverse<F, true> {
  public:
    [[gnu::always_inline]] Inverse(const Lane<F>& lane, const LaneInertia* inertia, F)
        : lane_(lane.template in_batch<PairInertia>()), inertia_(*inertia) {}
    [[gnu::always_inline]] LaneBivector<F> of(const LaneBivector<F>& m) const {
        const auto e = [&](std::size_t i) { return lane_.load(inertia_[i]); };
        const auto row = [&](int i0, int i1, int i2, int i3, int i4, int i5) {
            return fused(e(i0), m[0], fused(e(i1), m[1], e(i2) * m[2])) +
                   fused(e(i3), m[3], fused(e(i4), m[4], e(i5) * m[5]));
        };
        return {row(0, 1, 2, 3, 4, 5),     row(1, 6, 7, 8, 9, 10),    row(2, 7, 11, 12, 13, 14),
                row(3, 8, 12, 15, 16, 17), row(4, 9, 13, 16, 18, 19), row(5, 10, 14, 17, 19, 20)};
    }
    [[gnu::always_inline]] LaneBivector<F> column(std::size_t plane) const {
        LaneBivector<F> w;
        for (std::size_t i = 0; i < 6; ++i) w[i] = lane_.load(inertia_[in_triangle<6>(i, plane)]);
        return w;
    }

  private:
    const Lane<F> lane_;
    const LaneInertia& inertia_;
};

/// Copies the bodies' inverse inertias side by side, so that sweeps need not look for them.
template <class F>
[[gnu::always_inline]] inline void gather_inertias(const Lane<F>& lane,
                                                   const std::vector<InverseInertia>& inertias,
                                                   const std::array<std::uint32_t, kLanes>& places,
                                                   LaneInertia& to) {
    for (std::size_t part = 0; part < 6; ++part) {
        std::array<const float*, Lane<F>::count> from;
        for (std::size_t i = 0; i < from.size(); ++i)
            from[i] = inertias[lane.template in_batch<Batch>().at(places, i)].entry[part].data();
        std::array<F, 4> four;
        load_four(from, four);
        for (std::size_t i = 0; i < 4 && 4 * part + i < to.size(); ++i)
            lane.template in_batch<PairInertia>().store(four[i], to[4 * part + i]);
    }
}

/// The motion of b relative to a at a pair's centre, or an impulse and its moment there, in world
/// axes.
template <class F>
struct Screw {
    LaneVec4<F> straight;
    LaneBivector<F> turning;
};

/// A Screw in its pair's frame, where x, y and z are across the normal n.
template <class F>
struct FrameScrew {
    std::array<F, 4> along;   ///< n; turning in xn yn zn: normal impulses act on these
    std::array<F, 6> across;  ///< x y z; turning in xy xz yz: friction acts on these
};

/// The reflection by which PairFrame leads from world axes to a pair's frame and back.
template <class F>
struct Frame {
    LaneVec4<F> h;
    F g;

    [[gnu::always_inline]] explicit Frame(const LaneVec4<F>& vector) : h(vector) {
        const F one = F{} + 1.0f;
        g = h[3] < F{} ? one : -one;
    }
    [[gnu::always_inline]] LaneVec4<F> reflected(const LaneVec4<F>& v) const {
        return sum(v, -dot(h, v), h);
    }
    /// Returns B - h ^ (velocity of B at h): a bivector in the frame, or back in the world.
    [[gnu::always_inline]] LaneBivector<F> reflected(const LaneBivector<F>& b) const {
        return b - wedge(h, velocity_at(b, h));
    }
    [[gnu::always_inline]] FrameScrew<F> from_world(const Screw<F>& screw) const {
        const LaneVec4<F> v = reflected(screw.straight);
        const LaneBivector<F> w = reflected(screw.turning);
        return {{g * v[3], g * w[2], g * w[4], g * w[5]}, {v[0], v[1], v[2], w[0], w[1], w[3]}};
    }
    [[gnu::always_inline]] Screw<F> to_world(const FrameScrew<F>& s) const {
        const std::array<F, 4>& n = s.along;
        const std::array<F, 6>& t = s.across;
        return {reflected(LaneVec4<F>{t[0], t[1], t[2], g * n[0]}),
                reflected(LaneBivector<F>{t[3], t[4], g * n[1], t[5], g * n[2], g * n[3]})};
    }
};

/// The bodies of each lane's pair, for as long as its points are solved.
template <class F, bool kUneven>
class LanePair {
  public:
    /// @param index   of the batch, whose frame has been made
    [[gnu::always_inline]] LanePair(const Lane<F>& lane, ColouredIslands& coloured,
                                    std::uint32_t index)
        : lane_(lane),
          frame_(coloured.frames[index]),
          inertia_(kUneven ? &coloured.pair_inertias[index] : nullptr),
          bodies_a_(lane, coloured.changes.data(), coloured.general[index].a),
          bodies_b_(lane, coloured.changes.data(), coloured.general[index].b),
          a_(bodies_a_.template load<true>()),
          b_(bodies_b_.template load<true>()) {}

    /// Returns the change of the motion of b relative to a since the start.
    [[gnu::always_inline]] Screw<F> motion() const {
        return {(b_.velocity - a_.velocity) + (velocity_at(b_.angular_velocity, centre_b()) -
                                               velocity_at(a_.angular_velocity, centre_a())),
                b_.angular_velocity - a_.angular_velocity};
    }
    /// Applies an impulse to b and its opposite to a.
    [[gnu::always_inline]] void apply(const Screw<F>& impulse) {
        const LaneVec4<F>& p = impulse.straight;
        a_.velocity = sum(a_.velocity, -a_.inverse_mass, p);
        b_.velocity = sum(b_.velocity, b_.inverse_mass, p);
        a_.angular_velocity =
            a_.angular_velocity - inverse_a().of(impulse.turning + wedge(centre_a(), p));
        b_.angular_velocity =
            b_.angular_velocity + inverse_b().of(impulse.turning + wedge(centre_b(), p));
        bodies_a_.template store<true>(a_);
        bodies_b_.template store<true>(b_);
    }

    [[gnu::always_inline]] LaneVec4<F> centre_a() const {
        return load(lane_.template in_batch<PairFrame>(), frame_.centre_a);
    }
    [[gnu::always_inline]] LaneVec4<F> centre_b() const {
        return load(lane_.template in_batch<PairFrame>(), frame_.centre_b);
    }
    [[gnu::always_inline]] Inverse<F, kUneven> inverse_a() const {
        return {lane_, kUneven ? &inertia_->a : nullptr, a_.inverse_inertia};
    }
    [[gnu::always_inline]] Inverse<F, kUneven> inverse_b() const {
        return {lane_, kUneven ? &inertia_->b : nullptr, b_.inverse_inertia};
    }
    [[gnu::always_inline]] F inverse_mass() const { return a_.inverse_mass + b_.inverse_mass; }

  private:
    const Lane<F>& lane_;
    const PairFrame& frame_;
    const PairInertia* const inertia_;
    LaneBodies<F> bodies_a_, bodies_b_;
    Motion<F> a_, b_;
};

template <std::size_t kSize, std::size_t kRow, class F, std::size_t kEntries,
          std::size_t... kColumn>
[[gnu::always_inline]] inline F row_product(const std::array<F, kEntries>& symmetric,
                                            const std::array<F, kSize>& x, F to,
                                            std::index_sequence<kColumn...>) {
    constexpr std::size_t kHalf = kSize / 2;
    F other = symmetric[in_triangle<kSize>(kRow, 0)] * x[0];
    ((kColumn == 0 ? void()
      : kColumn < kHalf
          ? void(other = fused(symmetric[in_triangle<kSize>(kRow, kColumn)], x[kColumn], other))
          : void(to = fused(symmetric[in_triangle<kSize>(kRow, kColumn)], x[kColumn], to))),
     ...);
    return to + other;
}
/// Adds S x to `to`, with the symmetric matrix S.
template <std::size_t kSize, class F, std::size_t kEntries, std::size_t... kRow>
[[gnu::always_inline]] inline void add_product(const std::array<F, kEntries>& symmetric,
                                               const std::array<F, kSize>& x,
                                               std::array<F, kSize>& to,
                                               std::index_sequence<kRow...> rows) {
    to = {row_product<kSize, kRow>(symmetric, x, to[kRow], rows)...};
}
template <std::size_t kSize, class F, std::size_t kEntries>
[[gnu::always_inline]] inline void add_product(const std::array<F, kEntries>& symmetric,
                                               const std::array<F, kSize>& x,
                                               std::array<F, kSize>& to) {
    static_assert(kEntries == kSize * (kSize + 1) / 2);
    add_product(symmetric, x, to, std::make_index_sequence<kSize>());
}

/// Returns the symmetric block xx xy xz yy yz zz times v.
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> times(const std::array<F, 6>& symmetric,
                                                const LaneVec4<F>& v) {
    const auto& s = symmetric;
    return {fused(s[0], v[0], fused(s[1], v[1], s[2] * v[2])),
            fused(s[1], v[0], fused(s[3], v[1], s[4] * v[2])),
            fused(s[2], v[0], fused(s[4], v[1], s[5] * v[2])), F{}};
}

/// The largest condition number of a tangent block, about. Above it the norm over kMostCondition is
/// added to the diagonal. The block is inverted in float, and the inverse is rounded to one part in
/// 500; neither may make the inverse much larger than it is. Such blocks come from thin bodies that
/// are touched far from their centre, and from directions that do not yield at all, as that towards
/// a centre that is fixed.
constexpr float kMostCondition = 100;

/// Returns the inverse of a symmetric block xx xy xz yy yz zz times its determinant.
template <class F>
[[gnu::always_inline]] inline std::array<F, 6> adjugate(const std::array<F, 6>& K) {
    return {K[3] * K[5] - K[4] * K[4], K[2] * K[4] - K[1] * K[5], K[1] * K[4] - K[2] * K[3],
            K[0] * K[5] - K[2] * K[2], K[1] * K[2] - K[0] * K[4], K[0] * K[3] - K[1] * K[1]};
}
/// Returns the Frobenius norm of a symmetric block xx xy xz yy yz zz.
template <class F>
[[gnu::always_inline]] inline F norm_of(const std::array<F, 6>& K) {
    return square_root((K[0] * K[0] + K[3] * K[3] + K[5] * K[5]) +
                       (F{} + 2.0f) * (K[1] * K[1] + K[2] * K[2] + K[4] * K[4]));
}

/// Computes the inverse of the tangent block K and of its norm; both are 0 where only rounding
/// yields.
template <class F>
[[gnu::always_inline]] inline void invert(std::array<F, 6> K, F rounding, std::array<F, 6>& inverse,
                                          F& slide) {
    const F one = F{} + 1.0f, norm = norm_of(K);
    const auto yields = (K[0] + K[3] + K[5]) / (F{} + 3.0f) > rounding;
    inverse = adjugate(K);
    const auto determinant = [&] {
        return K[0] * inverse[0] + K[1] * inverse[1] + K[2] * inverse[2];
    };
    const F least = norm * norm_of(inverse) / (F{} + kMostCondition);
    if (!simd::nowhere_above(least, determinant())) {
        const F more = least <= determinant() ? F{} : norm / (F{} + kMostCondition);
        for (const std::size_t diagonal : {0, 3, 5}) K[diagonal] += more;
        inverse = adjugate(K);
    }
    slide = yields ? one / norm : F{};
    const F scale = one / determinant();
    for (F& entry : inverse) entry = yields ? scale * entry : F{};
}

}  // namespace tesserae::lanes
