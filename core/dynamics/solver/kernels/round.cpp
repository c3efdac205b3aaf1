// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/kernels/points.hpp"
#include "core/dynamics/solver/kernels/round_sweep.hpp"
#include "core/dynamics/solver/kernels/sixteen.hpp"
#include "core/dynamics/solver/kernels/unswept.hpp"

namespace tesserae {
namespace {

using namespace lanes;

template <class F>
[[gnu::always_inline]] inline void start_rolling(const Lane<F>& lane, const LaneVec4<F>& n,
                                                 F normal_impulse, RoundRolling& rolling,
                                                 Motion<F>& a, Motion<F>& b) {
    const F response = a.inverse_inertia + b.inverse_inertia;
    lane.store(response > F{} ? (F{} + 1.0f) / response : F{}, rolling.mass);
    const LaneBivector<F> impulse =
        clamped_parts(n, load(lane, rolling.impulse), lane.load(rolling.arm) * normal_impulse);
    store(lane, impulse, rolling.impulse);
    a.angular_velocity = a.angular_velocity - a.inverse_inertia * impulse;
    b.angular_velocity = b.angular_velocity + b.inverse_inertia * impulse;
}

template <bool kFriction, bool kRolling, class F>
[[gnu::always_inline]] inline void start_batch(const ColouredStage& stage, const Lane<F>& lane,
                                               const EightPoints& points, std::uint32_t batch) {
    ColouredIslands& coloured = stage.step.coloured;
    LaneBodies<F> bodies_a(lane, coloured.changes.data(), coloured.round[batch].a);
    LaneBodies<F> bodies_b(lane, coloured.changes.data(), coloured.round[batch].b);
    Motion<F> a = bodies_a.template load<kFriction>(), b = bodies_b.template load<kFriction>();
    const F one = F{} + 1.0f, response = a.inverse_mass + b.inverse_mass;
    const LaneVec4<F> n = load(lane, points.normal);

    RoundRow& row = coloured.round_rows[batch];
    store(lane, n, row.normal);
    const LaneVec4<F> along = load(lane, points.along);
    make_normal(lane, along[2], response, F{}, row.along);
    const F normal_impulse = start_normal({lane, lane}, along, batch, row.along,
                                          coloured.round_second, coloured.round_impulses.normal);
    LaneVec4<F> impulse = normal_impulse * n;
    if constexpr (kFriction) {
        RoundFriction& friction = coloured.round_friction[batch];
        const F arm_a = dot(n, load(lane, points.r_a)), arm_b = -dot(n, load(lane, points.r_b));
        const F along_tangent =
            response + (a.inverse_inertia * (arm_a * arm_a) + b.inverse_inertia * (arm_b * arm_b));
        lane.store(arm_a, friction.arm_a);
        lane.store(arm_b, friction.arm_b);
        lane.store(along_tangent > F{} ? one / along_tangent : F{}, friction.mass);
        LaneVec4<F> slip = load(lane, points.velocity);
        if (slips_by_turning(stage)) slip = slip + slip_by_turning(stage, lane, n, points.turning);
        store(lane, slip, friction.slip);
        // The normal may have turned since the impulse was.
        const LaneVec4<F> last = load(lane, points.impulse);
        const LaneVec4<F> tangent =
            clamped<F>(last - dot(n, last) * n, lane.load(friction.friction) * normal_impulse);
        store(lane, tangent, coloured.round_impulses.tangent[batch]);
        turn(n, tangent, arm_a, arm_b, a, b);
        impulse = impulse + tangent;
    }
    if constexpr (kRolling)
        start_rolling(lane, n, normal_impulse, coloured.round_rolling[batch], a, b);
    apply(impulse, a, b);
    bodies_a.template store<kFriction>(a);
    bodies_b.template store<kFriction>(b);
}

template <bool kFriction, bool kRolling>
void start_all(const ColouredStage& stage, BatchRange batches, LaneCount lanes, Members some) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.round[i];
        if (!(batch.members & some).any()) continue;
        const bool whole = some.has_all(batch.members);
        prefetch(stage, coloured.round, i);
        EightPoints points;
        if (!is_full(batch)) points = {};
        if (kFriction && whole) coloured.round_friction[i].friction = {};
        if (kRolling && whole) coloured.round_rolling[i] = {};
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            const std::uint8_t member = batch.member[k];
            if (!some.has(member)) continue;
            put_point(stage, member, batch.contact[k], k, points);
            const Contact& c = stage.step.contacts[batch.contact[k]];
            if constexpr (kFriction)
                coloured.round_friction[i].friction.lane[k] = float_friction(stage, c);
            if (kFriction && slips_by_turning(stage))
                put_turning(stage, batch.contact[k], k, points.turning);
            if constexpr (kRolling) {
                RoundRolling& rolling = coloured.round_rolling[i];
                rolling.arm.lane[k] = float_rolling_arm(stage, c);
                put_turning(stage, batch.contact[k], k, rolling.turning);
                put_angular_impulse(stage, member, batch.contact[k], k, rolling.impulse);
            }
        }
        for_lanes_of(batch, some, lanes, [&](const auto& lane) {
            start_batch<kFriction, kRolling>(stage, lane, points, i);
        });
    }
}

/// Sweeps one batch, or two at once.
double sweep_at_once(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    ColouredIslands& coloured = stage.step.coloured;
    if (batches.end - batches.begin == 2)
        return sixteen::sweep_round(coloured, batches.begin, sweep);
    return with_kind_of_round(coloured, sweep.pass, [&](auto friction, auto rolling) {
        float most = 0;
        for_lanes(lanes, sweep.backward, [&](const auto& lane) {
            const auto left =
                solve_batch<friction(), rolling()>(coloured, lane, batches.begin, sweep);
            if (sweep.measured) most = std::max(most, largest_lane(left));
        });
        return most;
    });
}

}  // namespace

void start_round(const ColouredStage& stage, BatchRange batches, LaneCount lanes, Members some) {
    const ColouredIslands& coloured = stage.step.coloured;
    if (coloured.rolling) return start_all<true, true>(stage, batches, lanes, some);
    return coloured.friction ? start_all<true, false>(stage, batches, lanes, some)
                             : start_all<false, false>(stage, batches, lanes, some);
}

double sweep_round(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes,
                   Members some) {
    ColouredIslands& coloured = stage.step.coloured;
    return sweep_batches(coloured.round, batches, sweep, lanes, some, [&](BatchRange at_once) {
        return sweep_some(coloured, coloured.round, coloured.round_impulses, at_once, some,
                          [&] { return sweep_at_once(stage, at_once, sweep, lanes); });
    });
}

void take_warm_start_round(const ColouredStage& stage, BatchRange batches, Members some) {
    ColouredIslands& coloured = stage.step.coloured;
    const Lane<Float8> lane;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.round[i];
        const auto a = LaneBodies<Float8>(lane, coloured.changes.data(), batch.a).load<true>();
        const auto b = LaneBodies<Float8>(lane, coloured.changes.data(), batch.b).load<true>();
        const LaneVec4<Float8> n = load(lane, coloured.round_rows[i].normal);
        const LaneVec4<Float8> v = b.velocity - a.velocity;
        const Float8 along = dot(n, v), takes = lane.load(lanes_of(batch, some));
        const auto take = [&](Float8 change, Eight& of_start) {
            const Float8 before = lane.load(of_start);
            lane.store(takes > Float8{} ? before + change : before, of_start);
        };
        take(-along, coloured.round_rows[i].along.target);
        take(-along, coloured.round_second[i]);
        if (!coloured.friction) continue;
        RoundFriction& friction = coloured.round_friction[i];
        const LaneVec4<Float8> slip = slip_of(lane, n, v, along, friction, a, b);
        for (std::size_t k = 0; k < 4; ++k) take(slip[k], friction.slip[k]);
    }
}

void keep_round(const ColouredStage& stage, BatchRange batches, Members some) {
    const ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.round[i];
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            if (!some.has(batch.member[k])) continue;
            const double mass_unit = stage.mass_unit(batch.member[k]);
            const float normal = coloured.round_impulses.normal[i].lane[k];
            if (stage.cause == Cause::kImpact) {
                stage.step.hit[batch.contact[k]] = mass_unit * normal;
                continue;
            }
            ContactImpulse& impulse = stage.step.impulses[batch.contact[k]];
            impulse = {mass_unit * normal};
            if (!coloured.friction) continue;
            for (std::size_t axis = 0; axis < 4 && normal > 0; ++axis)
                impulse.slope[axis] = coloured.round_impulses.tangent[i][axis].lane[k] / normal;
            if (coloured.rolling)
                stage.step.angular_impulses[batch.contact[k]] =
                    mass_unit * bivector_in_lane(coloured.round_rolling[i].impulse, k);
        }
    }
}

}  // namespace tesserae
