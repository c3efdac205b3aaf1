#pragma once

#include <array>
#include <cstdint>

#include "core/dynamics/solver/lanes.hpp"
#include "core/dynamics/state/coloured_rows.hpp"

// The bodies of a pair that is not round, lane by lane, and the frame of its contacts.
namespace tesserae::lanes {

/// What an angular impulse does to each lane's body.
template <class F, bool kUneven>
struct Inverse {
    F scalar;
    [[gnu::always_inline]] LaneBivector<F> of(const LaneBivector<F>& moment) const {
        return scalar * moment;
    }
};
template <class F>
struct Inverse<F, true> {
    std::array<F, 24> e;  ///< as BodyInertia
    [[gnu::always_inline]] LaneBivector<F> of(const LaneBivector<F>& m) const {
        const auto row = [&](int i0, int i1, int i2, int i3, int i4, int i5) {
            return fused(e[i0], m[0], fused(e[i1], m[1], e[i2] * m[2])) +
                   fused(e[i3], m[3], fused(e[i4], m[4], e[i5] * m[5]));
        };
        return {row(0, 1, 2, 3, 4, 5),     row(1, 6, 7, 8, 9, 10),    row(2, 7, 11, 12, 13, 14),
                row(3, 8, 12, 15, 16, 17), row(4, 9, 13, 16, 18, 19), row(5, 10, 14, 17, 19, 20)};
    }
};

template <bool kUneven, class F>
[[gnu::always_inline]] inline Inverse<F, kUneven> inverse_of(
    const Lane<F>& lane, const ColouredIslands& coloured,
    const std::array<std::uint32_t, kLanes>& places, const Motion<F>& motion) {
    Inverse<F, kUneven> inverse;
    if constexpr (kUneven) {
        for (std::size_t part = 0; part < 6; ++part) {
            std::array<const float*, Lane<F>::count> from;
            for (std::size_t i = 0; i < from.size(); ++i)
                from[i] = coloured.inertias[places[lane.first + i]].entry[part].data();
            std::array<F, 4> four;
            load_four(from, four);
            for (std::size_t i = 0; i < 4; ++i) inverse.e[4 * part + i] = four[i];
        }
    } else {
        inverse.scalar = motion.inverse_inertia;
    }
    return inverse;
}

/// PairFrame's reflection.
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
    /// B -> B - h ^ (B at h), into the frame and back.
    [[gnu::always_inline]] LaneBivector<F> reflected(const LaneBivector<F>& b) const {
        return b - wedge(h, velocity_at(b, h));
    }
    /// The impulse of these tangent and normal parts, in world axes.
    [[gnu::always_inline]] LaneVec4<F> world(const LaneVec4<F>& tangent, F normal) const {
        return reflected(LaneVec4<F>{tangent[0], tangent[1], tangent[2], g * normal});
    }
};

/// The bodies of each lane's pair, for as long as its points are solved.
template <class F, bool kUneven>
class LanePair {
  public:
    [[gnu::always_inline]] LanePair(const Lane<F>& lane, ColouredIslands& coloured,
                                    const Batch& batch)
        : bodies_a_(lane, coloured.changes.data(), batch.a),
          bodies_b_(lane, coloured.changes.data(), batch.b),
          a_(bodies_a_.template load<true>()),
          b_(bodies_b_.template load<true>()),
          inverse_a_(inverse_of<kUneven>(lane, coloured, batch.a, a_)),
          inverse_b_(inverse_of<kUneven>(lane, coloured, batch.b, b_)) {}

    [[gnu::always_inline]] void store() {
        bodies_a_.template store<true>(a_);
        bodies_b_.template store<true>(b_);
    }
    [[gnu::always_inline]] LaneVec4<F> relative_velocity(const LaneVec4<F>& r_a,
                                                         const LaneVec4<F>& r_b) const {
        return (b_.velocity - a_.velocity) +
               (velocity_at(b_.angular_velocity, r_b) - velocity_at(a_.angular_velocity, r_a));
    }
    [[gnu::always_inline]] void apply(const LaneVec4<F>& r_a, const LaneVec4<F>& r_b,
                                      const LaneVec4<F>& impulse) {
        a_.velocity = sum(a_.velocity, -a_.inverse_mass, impulse);
        b_.velocity = sum(b_.velocity, b_.inverse_mass, impulse);
        a_.angular_velocity = a_.angular_velocity - inverse_a_.of(wedge(r_a, impulse));
        b_.angular_velocity = b_.angular_velocity + inverse_b_.of(wedge(r_b, impulse));
    }
    [[gnu::always_inline]] LaneBivector<F> relative_turning() const {
        return b_.angular_velocity - a_.angular_velocity;
    }
    [[gnu::always_inline]] void turn(const LaneBivector<F>& impulse) {
        a_.angular_velocity = a_.angular_velocity - inverse_a_.of(impulse);
        b_.angular_velocity = b_.angular_velocity + inverse_b_.of(impulse);
    }
    /// Change of the relative turning by an angular impulse.
    [[gnu::always_inline]] LaneBivector<F> response(const LaneBivector<F>& impulse) const {
        return inverse_a_.of(impulse) + inverse_b_.of(impulse);
    }
    /// Change of the relative velocity by an impulse.
    [[gnu::always_inline]] LaneVec4<F> response(const LaneVec4<F>& r_a, const LaneVec4<F>& r_b,
                                                const LaneVec4<F>& impulse) const {
        return (a_.inverse_mass + b_.inverse_mass) * impulse +
               (velocity_at(inverse_a_.of(wedge(r_a, impulse)), r_a) +
                velocity_at(inverse_b_.of(wedge(r_b, impulse)), r_b));
    }

  private:
    LaneBodies<F> bodies_a_, bodies_b_;
    Motion<F> a_, b_;
    Inverse<F, kUneven> inverse_a_, inverse_b_;
};

template <class F>
[[gnu::always_inline]] inline LaneVec4<F> times(const std::array<F, 6>& symmetric,
                                                const LaneVec4<F>& v) {
    const auto& s = symmetric;
    return {fused(s[0], v[0], fused(s[1], v[1], s[2] * v[2])),
            fused(s[1], v[0], fused(s[3], v[1], s[4] * v[2])),
            fused(s[2], v[0], fused(s[4], v[1], s[5] * v[2])), F{}};
}

/// Below this part of the cube of the mean response a tangent block is not inverted in float: some
/// direction hardly yields, as that towards a centre whose place is fixed.
constexpr float kLeastDeterminant = 1e-4f;

/// The inverses of the tangent block K (xx xy xz yy yz zz) and of its norm.
template <class F>
[[gnu::always_inline]] inline void invert(const std::array<F, 6>& K, F rounding,
                                          std::array<F, 6>& inverse, F& slide) {
    const F one = F{} + 1.0f;
    const F xx = K[3] * K[5] - K[4] * K[4], xy = K[2] * K[4] - K[1] * K[5];
    const F xz = K[1] * K[4] - K[2] * K[3], yy = K[0] * K[5] - K[2] * K[2];
    const F yz = K[1] * K[2] - K[0] * K[4], zz = K[0] * K[3] - K[1] * K[1];
    const F determinant = K[0] * xx + K[1] * xy + K[2] * xz;
    const F mean = (K[0] + K[3] + K[5]) / (F{} + 3.0f);
    const F norm = square_root((K[0] * K[0] + K[3] * K[3] + K[5] * K[5]) +
                               (F{} + 2.0f) * (K[1] * K[1] + K[2] * K[2] + K[4] * K[4]));
    const auto yields = mean > rounding;
    const auto inverts = determinant > kLeastDeterminant * (mean * mean * mean);
    slide = yields ? one / norm : F{};
    const F scale = one / determinant;
    inverse = {inverts ? scale * xx : slide, inverts ? scale * xy : F{},
               inverts ? scale * xz : F{},   inverts ? scale * yy : slide,
               inverts ? scale * yz : F{},   inverts ? scale * zz : slide};
    for (F& entry : inverse) entry = yields ? entry : F{};
}

}  // namespace tesserae::lanes
