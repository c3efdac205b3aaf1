// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "core/dynamics/solver/kernels/lane_bodies.hpp"
#include "core/dynamics/solver/kernels/row.hpp"

// Sweeps over batches of pairs that are round on both sides.
namespace tesserae::lanes {

template <class F>
[[gnu::always_inline]] inline void apply(const LaneVec4<F>& impulse, Motion<F>& a, Motion<F>& b) {
    a.velocity = sum(a.velocity, -a.inverse_mass, impulse);
    b.velocity = sum(b.velocity, b.inverse_mass, impulse);
}

/// Applies the turning by a tangent impulse to both bodies, whose offsets are arm_a n and -arm_b n.
template <class F>
[[gnu::always_inline]] inline void turn(const LaneVec4<F>& n, const LaneVec4<F>& tangent, F arm_a,
                                        F arm_b, Motion<F>& a, Motion<F>& b) {
    const LaneBivector<F> moment = wedge(n, tangent);
    a.angular_velocity = a.angular_velocity - (a.inverse_inertia * arm_a) * moment;
    b.angular_velocity = b.angular_velocity - (b.inverse_inertia * arm_b) * moment;
}

/// Returns an angular impulse whose rolling and twisting parts are each clamped to a length.
template <class F>
[[gnu::always_inline]] inline LaneBivector<F> clamped_parts(const LaneVec4<F>& n,
                                                            const LaneBivector<F>& impulse,
                                                            F most) {
    const LaneBivector<F> rolling = wedge(n, velocity_at(impulse, n));
    return clamped<F>(rolling, most) + clamped<F>(impulse - rolling, most);
}

/// Does one step as solve_rolling_row() does. The response is the same in every plane, so that both
/// parts are solved at once, each by the clamped impulse that ends its turning.
template <class F>
[[gnu::always_inline]] inline void solve_rolling(const Lane<F>& lane, const LaneVec4<F>& n,
                                                 F normal_impulse, RoundRolling& rolling,
                                                 Motion<F>& a, Motion<F>& b) {
    const auto& in = lane.template in_batch<RoundRolling>();
    const LaneBivector<F> turning =
        load(in, rolling.turning) + (b.angular_velocity - a.angular_velocity);
    const LaneBivector<F> old = load(in, rolling.impulse);
    const LaneBivector<F> impulse = clamped_parts(n, old - in.load(rolling.mass) * turning,
                                                  in.load(rolling.arm) * normal_impulse);
    store(in, impulse, rolling.impulse);
    const LaneBivector<F> change = impulse - old;
    a.angular_velocity = a.angular_velocity - a.inverse_inertia * change;
    b.angular_velocity = b.angular_velocity + b.inverse_inertia * change;
}

/// Returns the change of the slip by the changes of the bodies.
/// @param v, along   velocity of b relative to a, and its part along the normal
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> slip_of(const Lane<F>& lane, const LaneVec4<F>& n,
                                                  const LaneVec4<F>& v, F along,
                                                  const RoundFriction& friction, const Motion<F>& a,
                                                  const Motion<F>& b) {
    const auto& in = lane.template in_batch<RoundFriction>();
    const LaneBivector<F> w =
        in.load(friction.arm_a) * a.angular_velocity + in.load(friction.arm_b) * b.angular_velocity;
    return sum(v, -along, n) - velocity_at(w, n);
}

/// Solves the normal impulses of a batch, then friction, as solve_row() does. The response is the
/// same along every tangent, so that friction is the clamped impulse that ends the slip. Neither
/// changes the other's velocity, so that without rolling this is its own adjoint.
template <bool kFriction, bool kRolling, class F>
[[gnu::always_inline]] inline F solve_batch(ColouredIslands& coloured, const Lane<F>& lane,
                                            std::uint32_t batch, Sweep sweep) {
    LaneBodies<F> bodies_a(lane, coloured.changes.data(), coloured.round[batch].a);
    LaneBodies<F> bodies_b(lane, coloured.changes.data(), coloured.round[batch].b);
    Motion<F> a = bodies_a.template load<kFriction>(), b = bodies_b.template load<kFriction>();
    const RoundRow& row = coloured.round_rows[batch];
    const NormalLanes<F> lanes = {lane.template in_batch<RoundRow>(),
                                  lane.template in_batch<Eight>()};
    const LaneVec4<F> n = load(lanes.in_row, row.normal);

    const LaneVec4<F> v = b.velocity - a.velocity;
    const F along = dot(n, v);
    Eight& impulse = coloured.round_impulses.normal[batch];
    const F target = target_of(lanes, row.along, coloured.round_second[batch], sweep.pass);
    const F change = solve_normal(lanes, row.along, target - along, impulse);
    const F normal_impulse = lanes.in_list.load(impulse);
    LaneVec4<F> tangent_change{};
    F tangent_mass{};
    if constexpr (kFriction) {
        const RoundFriction& friction = coloured.round_friction[batch];
        std::array<Eight, 4>& tangents = coloured.round_impulses.tangent[batch];
        const auto& in = lane.template in_batch<RoundFriction>();
        const auto& in_tangents = lane.template in_batch<std::array<Eight, 4>>();
        const F arm_a = in.load(friction.arm_a), arm_b = in.load(friction.arm_b);
        const LaneVec4<F> slip =
            load(in, friction.slip) + slip_of(lane, n, v, along, friction, a, b);
        const LaneVec4<F> old = load(in_tangents, tangents);
        tangent_mass = in.load(friction.mass);
        const LaneVec4<F> tangent =
            clamped<F>(sum(old, -tangent_mass, slip), in.load(friction.friction) * normal_impulse);
        store(in_tangents, tangent, tangents);
        tangent_change = tangent - old;
        turn(n, tangent_change, arm_a, arm_b, a, b);
    }
    if constexpr (kRolling)
        solve_rolling(lane, n, normal_impulse, coloured.round_rolling[batch], a, b);
    apply(sum(tangent_change, change, n), a, b);
    bodies_a.template store<kFriction>(a);
    bodies_b.template store<kFriction>(b);
    if (!sweep.measured) return F{};
    F left = velocity_left(lanes.in_row.load(row.along.mass), change);
    if constexpr (kFriction)
        left = larger(left, square_root(squared_velocity_left(tangent_mass, tangent_change)));
    lanes.in_list.store(left, coloured.round_left[batch]);
    return left;
}

/// Calls sweep(as kFriction, as kRolling), each a std::bool_constant.
template <class Call>
auto with_kind_of_round(const ColouredIslands& coloured, Pass pass, const Call& call) {
    constexpr std::true_type yes;
    constexpr std::false_type no;
    const bool by_normals = is_by_normals(pass);
    if (coloured.rolling && !by_normals) return call(yes, yes);
    return coloured.friction && !by_normals ? call(yes, no) : call(no, no);
}

}  // namespace tesserae::lanes
