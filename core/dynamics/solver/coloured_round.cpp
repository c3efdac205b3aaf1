#include "core/dynamics/solver/coloured_points.hpp"

namespace tesserae {
namespace {

using namespace lanes;

template <class F>
[[gnu::always_inline]] inline void apply(const LaneVec4<F>& impulse, Motion<F>& a, Motion<F>& b) {
    a.velocity = sum(a.velocity, -a.inverse_mass, impulse);
    b.velocity = sum(b.velocity, b.inverse_mass, impulse);
}

/// A tangent impulse also turns the bodies, whose offsets are arm_a n and -arm_b n.
template <class F>
[[gnu::always_inline]] inline void turn(const LaneVec4<F>& n, const LaneVec4<F>& tangent, F arm_a,
                                        F arm_b, Motion<F>& a, Motion<F>& b) {
    const LaneBivector<F> moment = wedge(n, tangent);
    a.angular_velocity = a.angular_velocity - (a.inverse_inertia * arm_a) * moment;
    b.angular_velocity = b.angular_velocity - (b.inverse_inertia * arm_b) * moment;
}

/// An angular impulse, of which rolling and twisting may each have so much.
template <class F>
[[gnu::always_inline]] inline LaneBivector<F> clamped_parts(const LaneVec4<F>& n,
                                                            const LaneBivector<F>& impulse,
                                                            F most) {
    const LaneBivector<F> rolling = wedge(n, velocity_at(impulse, n));
    return clamped<F>(rolling, most) + clamped<F>(impulse - rolling, most);
}

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

/// solve_rolling_row(): the response is the same about every plane, so that both parts can be
/// taken at once and each from the impulse that ends its turning, clamped.
template <class F>
[[gnu::always_inline]] inline void solve_rolling(const Lane<F>& lane, const LaneVec4<F>& n,
                                                 F normal_impulse, RoundRolling& rolling,
                                                 Motion<F>& a, Motion<F>& b) {
    const LaneBivector<F> turning =
        load(lane, rolling.turning) + (b.angular_velocity - a.angular_velocity);
    const LaneBivector<F> old = load(lane, rolling.impulse);
    const LaneBivector<F> impulse = clamped_parts(n, old - lane.load(rolling.mass) * turning,
                                                  lane.load(rolling.arm) * normal_impulse);
    store(lane, impulse, rolling.impulse);
    const LaneBivector<F> change = impulse - old;
    a.angular_velocity = a.angular_velocity - a.inverse_inertia * change;
    b.angular_velocity = b.angular_velocity + b.inverse_inertia * change;
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
    const F normal_impulse = start_normal(lane, along, batch, row.along, coloured.round_relax,
                                          coloured.round_impulses.normal);
    LaneVec4<F> impulse = normal_impulse * n;
    if constexpr (kFriction) {
        RoundFriction& friction = coloured.round_friction[batch];
        const F arm_a = dot(n, load(lane, points.r_a)), arm_b = -dot(n, load(lane, points.r_b));
        const F along_tangent =
            response + (a.inverse_inertia * (arm_a * arm_a) + b.inverse_inertia * (arm_b * arm_b));
        lane.store(arm_a, friction.arm_a);
        lane.store(arm_b, friction.arm_b);
        lane.store(along_tangent > F{} ? one / along_tangent : F{}, friction.mass);
        store(lane, load(lane, points.velocity), friction.slip);
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

/// What the bodies' changes are of the slip.
/// @param v, along   of b against a, and along the normal
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> slip_of(const Lane<F>& lane, const LaneVec4<F>& n,
                                                  const LaneVec4<F>& v, F along,
                                                  const RoundFriction& friction, const Motion<F>& a,
                                                  const Motion<F>& b) {
    const LaneBivector<F> w = lane.load(friction.arm_a) * a.angular_velocity +
                              lane.load(friction.arm_b) * b.angular_velocity;
    return sum(v, -along, n) - velocity_at(w, n);
}

/// The normal first and then friction, as solve_row() does: the response is the same along every
/// tangent, so that the impulse that ends the slip, clamped, is the one that friction gives.
/// Neither changes what the other sees, so that without rolling this is its own adjoint.
template <bool kFriction, bool kRolling, class F>
[[gnu::always_inline]] inline F solve_batch(const ColouredStage& stage, const Lane<F>& lane,
                                            std::uint32_t batch, Sweep sweep) {
    ColouredIslands& coloured = stage.step.coloured;
    LaneBodies<F> bodies_a(lane, coloured.changes.data(), coloured.round[batch].a);
    LaneBodies<F> bodies_b(lane, coloured.changes.data(), coloured.round[batch].b);
    Motion<F> a = bodies_a.template load<kFriction>(), b = bodies_b.template load<kFriction>();
    const RoundRow& row = coloured.round_rows[batch];
    const LaneVec4<F> n = load(lane, row.normal);

    const LaneVec4<F> v = b.velocity - a.velocity;
    const F along = dot(n, v);
    Eight& impulse = coloured.round_impulses.normal[batch];
    const bool solves = sweep.pass == Pass::kSolve;
    const F target = target_of(lane, row.along, coloured.round_relax.target[batch], sweep.pass);
    const F change =
        solve_normal(lane, row.along, solves ? keep_from(coloured.round_relax, batch) : nullptr,
                     target - along, impulse);
    const F normal_impulse = lane.load(impulse);
    LaneVec4<F> tangent_change{};
    if constexpr (kFriction) {
        const RoundFriction& friction = coloured.round_friction[batch];
        std::array<Eight, 4>& tangents = coloured.round_impulses.tangent[batch];
        const F arm_a = lane.load(friction.arm_a), arm_b = lane.load(friction.arm_b);
        const LaneVec4<F> slip =
            load(lane, friction.slip) + slip_of(lane, n, v, along, friction, a, b);
        const LaneVec4<F> old = load(lane, tangents);
        const LaneVec4<F> tangent = clamped<F>(sum(old, -lane.load(friction.mass), slip),
                                               lane.load(friction.friction) * normal_impulse);
        store(lane, tangent, tangents);
        tangent_change = tangent - old;
        turn(n, tangent_change, arm_a, arm_b, a, b);
    }
    if constexpr (kRolling)
        solve_rolling(lane, n, normal_impulse, coloured.round_rolling[batch], a, b);
    apply(sum(tangent_change, change, n), a, b);
    bodies_a.template store<kFriction>(a);
    bodies_b.template store<kFriction>(b);
    if (!sweep.measured) return F{};
    F left = velocity_left(lane, row.along, change);
    if constexpr (kFriction)
        left = larger(left, square_root(squared_velocity_left(
                                lane.load(coloured.round_friction[batch].mass), tangent_change)));
    return left;
}

template <bool kFriction, bool kRolling>
void start_all(const ColouredStage& stage, BatchRange batches, LaneCount lanes) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.round[i];
        EightPoints points;
        if constexpr (kFriction) coloured.round_friction[i].friction = {};
        if constexpr (kRolling) coloured.round_rolling[i] = {};
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            put_point(stage, batch.contact[k], k, points);
            const Contact& c = stage.step.contacts[batch.contact[k]];
            if constexpr (kFriction)
                coloured.round_friction[i].friction.lane[k] = float_friction(stage, c);
            if constexpr (kRolling) {
                RoundRolling& rolling = coloured.round_rolling[i];
                rolling.arm.lane[k] = float_rolling_arm(stage, c);
                put_turning(stage, batch.contact[k], k, rolling.turning);
                put_angular_impulse(stage, batch.contact[k], k, rolling.impulse);
            }
        }
        for_lanes({i, i + 1}, lanes, false, [&](const auto& lane, std::uint32_t) {
            start_batch<kFriction, kRolling>(stage, lane, points, i);
        });
    }
}

template <bool kFriction, bool kRolling>
double sweep_all(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    float most = 0;
    for_lanes(batches, lanes, sweep.backward, [&](const auto& lane, std::uint32_t batch) {
        const auto left = solve_batch<kFriction, kRolling>(stage, lane, batch, sweep);
        if (sweep.measured) most = std::max(most, largest_lane(left));
    });
    return most;
}

}  // namespace

void start_round(const ColouredStage& stage, BatchRange batches, LaneCount lanes) {
    const ColouredIslands& coloured = stage.step.coloured;
    if (coloured.rolling) return start_all<true, true>(stage, batches, lanes);
    return coloured.friction ? start_all<true, false>(stage, batches, lanes)
                             : start_all<false, false>(stage, batches, lanes);
}

double sweep_round(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    const ColouredIslands& coloured = stage.step.coloured;
    const bool pushes = sweep.pass == Pass::kPush;
    if (coloured.rolling && !pushes) return sweep_all<true, true>(stage, batches, sweep, lanes);
    return coloured.friction && !pushes ? sweep_all<true, false>(stage, batches, sweep, lanes)
                                        : sweep_all<false, false>(stage, batches, sweep, lanes);
}

void take_recalled_round(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    const Lane<Float8> lane;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.round[i];
        const auto a = LaneBodies<Float8>(lane, coloured.changes.data(), batch.a).load<true>();
        const auto b = LaneBodies<Float8>(lane, coloured.changes.data(), batch.b).load<true>();
        const LaneVec4<Float8> n = load(lane, coloured.round_rows[i].normal);
        const LaneVec4<Float8> v = b.velocity - a.velocity;
        const Float8 along = dot(n, v);
        NormalRow& row = coloured.round_rows[i].along;
        lane.store(lane.load(row.target) - along, row.target);
        Eight& relax_target = coloured.round_relax.target[i];
        lane.store(lane.load(relax_target) - along, relax_target);
        if (!coloured.friction) continue;
        RoundFriction& friction = coloured.round_friction[i];
        const LaneVec4<Float8> slip = slip_of(lane, n, v, along, friction, a, b);
        store(lane, load(lane, friction.slip) + slip, friction.slip);
    }
}

void keep_round(const ColouredStage& stage, BatchRange batches) {
    const ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.round[i];
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            const float normal = coloured.round_impulses.normal[i].lane[k];
            if (stage.cause == Cause::kBlow) {
                stage.step.hit[batch.contact[k]] = normal > 0;
                continue;
            }
            ContactImpulse& impulse = stage.step.impulses[batch.contact[k]];
            impulse = {stage.mass_unit * normal};
            if (!coloured.friction) continue;
            for (std::size_t axis = 0; axis < 4 && normal > 0; ++axis)
                impulse.slope[axis] = coloured.round_impulses.tangent[i][axis].lane[k] / normal;
            if (coloured.rolling)
                stage.step.angular_impulses[batch.contact[k]] =
                    stage.mass_unit * bivector_in_lane(coloured.round_rolling[i].impulse, k);
        }
    }
}

}  // namespace tesserae
