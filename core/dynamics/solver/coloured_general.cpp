#include "core/dynamics/solver/coloured_pair.hpp"
#include "core/dynamics/solver/coloured_points.hpp"

namespace tesserae {
namespace {

using namespace lanes;

/// Planes of the frame that contain the normal, and those that do not.
using Planes = std::array<std::size_t, 3>;
constexpr Planes kRollingPlanes = {2, 4, 5}, kTwistingPlanes = {0, 1, 3};

template <class F>
[[gnu::always_inline]] inline LaneVec4<F> part_of(const LaneBivector<F>& b, const Planes& planes) {
    return {b[planes[0]], b[planes[1]], b[planes[2]], F{}};
}
template <class F>
[[gnu::always_inline]] inline LaneBivector<F> bivector_of(const LaneVec4<F>& part,
                                                          const Planes& planes) {
    LaneBivector<F> b{};
    for (std::size_t i = 0; i < 3; ++i) b[planes[i]] = part[i];
    return b;
}

template <class F, bool kUneven>
[[gnu::always_inline]] inline void start_planes(const Lane<F>& lane,
                                                const LanePair<F, kUneven>& pair,
                                                const Frame<F>& frame, const Planes& planes,
                                                std::array<Eight, 6>& mass, Eight& step_mass) {
    std::array<LaneVec4<F>, 3> K;
    for (std::size_t i = 0; i < 3; ++i) {
        LaneVec4<F> unit{};
        unit[i] = F{} + 1.0f;
        const LaneBivector<F> impulse = frame.reflected(bivector_of(unit, planes));
        K[i] = part_of(frame.reflected(pair.response(impulse)), planes);
    }
    std::array<F, 6> inverse;
    F step;
    invert<F>({K[0][0], K[0][1], K[0][2], K[1][1], K[1][2], K[2][2]}, F{}, inverse, step);
    for (std::size_t i = 0; i < 6; ++i) lane.store(inverse[i], mass[i]);
    lane.store(step, step_mass);
}

/// What all points of a pair share. Its turning at the start is in world axes at first.
template <class F, bool kUneven>
[[gnu::always_inline]] inline void start_turning(const Lane<F>& lane,
                                                 const LanePair<F, kUneven>& pair,
                                                 const Frame<F>& frame, PairRolling& rolling) {
    start_planes(lane, pair, frame, kRollingPlanes, rolling.rolling_mass, rolling.rolling_step);
    start_planes(lane, pair, frame, kTwistingPlanes, rolling.twisting_mass, rolling.twisting_step);
    store(lane, frame.reflected(load(lane, rolling.turning)), rolling.turning);
}

/// The angular impulse that a point starts from, in world axes at first; what the present normal
/// impulse does not allow is left out.
template <class F, bool kUneven>
[[gnu::always_inline]] inline void start_point_rolling(const Lane<F>& lane, const Frame<F>& frame,
                                                       F most, GeneralRolling& row,
                                                       LanePair<F, kUneven>& pair) {
    const LaneBivector<F> last = frame.reflected(load(lane, row.impulse));
    const LaneBivector<F> impulse =
        bivector_of(clamped<F>(part_of(last, kRollingPlanes), most), kRollingPlanes) +
        bivector_of(clamped<F>(part_of(last, kTwistingPlanes), most), kTwistingPlanes);
    store(lane, impulse, row.impulse);
    pair.turn(frame.reflected(impulse));
}

template <bool kFriction, bool kRolling, bool kUneven, class F>
[[gnu::always_inline]] inline void start_points(
    const ColouredStage& stage, const Lane<F>& lane, std::uint32_t index,
    const std::array<EightPoints, kManifoldPoints>& points, const Eight& rounding) {
    ColouredIslands& coloured = stage.step.coloured;
    const Batch& batch = coloured.general[index];
    PairFrame& pair_frame = coloured.frames[index];
    LanePair<F, kUneven> pair(lane, coloured, batch);
    const F one = F{} + 1.0f, least = lane.load(rounding);
    // h along n - g w, which is never short.
    LaneVec4<F> h = load(lane, points[0].normal);
    h[3] = h[3] > F{} ? h[3] + one : h[3] - one;
    const F scale = square_root((F{} + 2.0f) / dot(h, h));
    const Frame<F> frame(scale * h);
    store(lane, frame.h, pair_frame.h);
    F arm{};
    if constexpr (kRolling) {
        PairRolling& rolling = coloured.pair_rolling[index];
        start_turning(lane, pair, frame, rolling);
        arm = lane.load(rolling.arm);
    }

    for (std::uint32_t k = 0; k < batch.rows; ++k) {
        GeneralRow& row = coloured.rows[batch.row + k];
        const LaneVec4<F> r_a = load(lane, points[k].r_a), r_b = load(lane, points[k].r_b);
        store(lane, r_a, row.r_a);
        store(lane, r_b, row.r_b);
        const LaneVec4<F> normal_response =
            frame.reflected(pair.response(r_a, r_b, frame.world({}, one)));
        const F normal_impulse =
            start_normal(lane, points[k], frame.g * normal_response[3], least, row.along);
        LaneVec4<F> tangent{};
        if constexpr (kFriction) {
            GeneralFriction& friction = coloured.general_friction[batch.row + k];
            std::array<LaneVec4<F>, 3> K;
            for (std::size_t i = 0; i < 3; ++i) {
                LaneVec4<F> direction{};
                direction[i] = one;
                K[i] = frame.reflected(pair.response(r_a, r_b, frame.reflected(direction)));
            }
            std::array<F, 6> inverse;
            F slide;
            invert<F>({K[0][0], K[0][1], K[0][2], K[1][1], K[1][2], K[2][2]}, least, inverse,
                      slide);
            for (std::size_t i = 0; i < 6; ++i) lane.store(inverse[i], friction.mass[i]);
            lane.store(slide, friction.slide_mass);
            store(lane, normal_response, friction.normal_response);
            store(lane, frame.reflected(load(lane, points[k].velocity)), friction.slip);
            // The normal may have turned since the impulse was.
            tangent = frame.reflected(load(lane, points[k].impulse));
            tangent[3] = F{};
            tangent = clamped<F>(tangent, lane.load(pair_frame.friction) * normal_impulse);
            store(lane, tangent, friction.impulse);
        }
        pair.apply(r_a, r_b, frame.world(tangent, normal_impulse));
        if constexpr (kRolling)
            start_point_rolling(lane, frame, arm * normal_impulse,
                                coloured.general_rolling[batch.row + k], pair);
    }
    pair.store();
}

/// friction_impulse() of the one-by-one solver, in the frame; solve_part() of its rolling rows.
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> friction_impulse(const Lane<F>& lane,
                                                           const std::array<Eight, 6>& masses,
                                                           const Eight& slide_mass,
                                                           const LaneVec4<F>& old,
                                                           const LaneVec4<F>& slip, F most) {
    std::array<F, 6> mass;
    for (std::size_t i = 0; i < 6; ++i) mass[i] = lane.load(masses[i]);
    const LaneVec4<F> sticking = old - times(mass, slip);
    if (simd::nowhere_above(dot(sticking, sticking), most * most)) return sticking;
    const LaneVec4<F> sliding = clamped<F>(sum(old, -lane.load(slide_mass), slip), most);
    const auto sticks = dot(sticking, sticking) <= most * most;
    return {sticks ? sticking[0] : sliding[0], sticks ? sticking[1] : sliding[1],
            sticks ? sticking[2] : sliding[2], F{}};
}

template <class F, bool kUneven>
[[gnu::always_inline]] inline void solve_planes(const Lane<F>& lane, const Frame<F>& frame, F most,
                                                const PairRolling& rolling, const Planes& planes,
                                                const std::array<Eight, 6>& mass,
                                                const Eight& step_mass, GeneralRolling& row,
                                                LanePair<F, kUneven>& pair) {
    const LaneBivector<F> turning =
        load(lane, rolling.turning) + frame.reflected(pair.relative_turning());
    const LaneVec4<F> old = part_of(load(lane, row.impulse), planes);
    const LaneVec4<F> impulse =
        friction_impulse<F>(lane, mass, step_mass, old, part_of(turning, planes), most);
    for (std::size_t i = 0; i < 3; ++i) lane.store(impulse[i], row.impulse[planes[i]]);
    pair.turn(frame.reflected(bivector_of(impulse - old, planes)));
}

template <bool kFriction, bool kRolling, bool kUneven, class F>
[[gnu::always_inline]] inline F solve_points(const ColouredStage& stage, const Lane<F>& lane,
                                             std::uint32_t index, Sweep sweep) {
    ColouredIslands& coloured = stage.step.coloured;
    const Batch& batch = coloured.general[index];
    const bool soft = stage.simulation.settings.solver == Solver::kSoft;
    LanePair<F, kUneven> pair(lane, coloured, batch);
    const Frame<F> frame(load(lane, coloured.frames[index].h));
    const F mu = lane.load(coloured.frames[index].friction);
    F left{};
    for (std::uint32_t i = 0; i < batch.rows; ++i) {
        const std::uint32_t k = batch.row + (sweep.backward ? batch.rows - 1 - i : i);
        GeneralRow& row = coloured.rows[k];
        const LaneVec4<F> r_a = load(lane, row.r_a), r_b = load(lane, row.r_b);
        const LaneVec4<F> v = frame.reflected(pair.relative_velocity(r_a, r_b));
        F normal_impulse;
        const F change =
            solve_normal(lane, row.along, frame.g * v[3], soft, sweep.pass, normal_impulse);
        LaneVec4<F> tangent_change{};
        if constexpr (kFriction) {
            GeneralFriction& friction = coloured.general_friction[k];
            LaneVec4<F> slip =
                sum(v + load(lane, friction.slip), change, load(lane, friction.normal_response));
            slip[3] = F{};  // that along the normal
            const LaneVec4<F> old = load(lane, friction.impulse);
            const LaneVec4<F> tangent = friction_impulse<F>(
                lane, friction.mass, friction.slide_mass, old, slip, mu * normal_impulse);
            store(lane, tangent, friction.impulse);
            tangent_change = tangent - old;
        }
        pair.apply(r_a, r_b, frame.world(tangent_change, change));
        if constexpr (kRolling) {
            const PairRolling& rolling = coloured.pair_rolling[index];
            GeneralRolling& turned = coloured.general_rolling[k];
            const F most = lane.load(rolling.arm) * normal_impulse;
            solve_planes(lane, frame, most, rolling, kRollingPlanes, rolling.rolling_mass,
                         rolling.rolling_step, turned, pair);
            solve_planes(lane, frame, most, rolling, kTwistingPlanes, rolling.twisting_mass,
                         rolling.twisting_step, turned, pair);
        }
        if (!sweep.measured) continue;
        left = larger(left, velocity_left(lane, row.along, change));
        if constexpr (kFriction)
            left = larger(left, velocity_left(lane.load(coloured.general_friction[k].slide_mass),
                                              tangent_change));
    }
    pair.store();
    return left;
}

template <bool kFriction, bool kRolling, bool kUneven>
void start_all(const ColouredStage& stage, BatchRange batches, LaneCount lanes) {
    const Simulation& simulation = stage.simulation;
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        std::array<EightPoints, kManifoldPoints> points;
        Eight rounding;
        coloured.frames[i].friction = {};
        if constexpr (kRolling) {
            coloured.pair_rolling[i] = {};
            std::fill_n(&coloured.general_rolling[batch.row], batch.rows, GeneralRolling{});
        }
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            for (std::uint32_t p = 0; p < batch.points[k]; ++p) {
                put_point(stage, batch.contact[k] + p, k, points[p]);
                if constexpr (kRolling)
                    put_angular_impulse(stage, batch.contact[k] + p, k,
                                        coloured.general_rolling[batch.row + p].impulse);
            }
            const Contact& c = stage.step.contacts[batch.contact[k]];
            coloured.frames[i].friction.lane[k] = float_friction(stage, c);
            if constexpr (kRolling) {
                coloured.pair_rolling[i].arm.lane[k] = float_rolling_arm(stage, c);
                put_turning(stage, batch.contact[k], k, coloured.pair_rolling[i].turning);
            }
            rounding.lane[k] =
                static_cast<float>(least_response(simulation, c.a, c.b) * stage.mass_unit);
        }
        for_lanes({i, i + 1}, lanes, false, [&](const auto& lane, std::uint32_t) {
            start_points<kFriction, kRolling, kUneven>(stage, lane, i, points, rounding);
        });
    }
}

template <bool kFriction, bool kRolling, bool kUneven>
double sweep_all(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    float most = 0;
    for_lanes(batches, lanes, sweep.backward, [&](const auto& lane, std::uint32_t batch) {
        const auto left = solve_points<kFriction, kRolling, kUneven>(stage, lane, batch, sweep);
        if (sweep.measured) most = std::max(most, largest_lane(left));
    });
    return most;
}

}  // namespace

void start_general(const ColouredStage& stage, BatchRange batches, LaneCount lanes) {
    const ColouredIslands& coloured = stage.step.coloured;
    if (coloured.rolling)
        return coloured.turns_unevenly ? start_all<true, true, true>(stage, batches, lanes)
                                       : start_all<true, true, false>(stage, batches, lanes);
    if (coloured.friction)
        return coloured.turns_unevenly ? start_all<true, false, true>(stage, batches, lanes)
                                       : start_all<true, false, false>(stage, batches, lanes);
    return coloured.turns_unevenly ? start_all<false, false, true>(stage, batches, lanes)
                                   : start_all<false, false, false>(stage, batches, lanes);
}

double sweep_general(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    const ColouredIslands& coloured = stage.step.coloured;
    if (coloured.rolling)
        return coloured.turns_unevenly ? sweep_all<true, true, true>(stage, batches, sweep, lanes)
                                       : sweep_all<true, true, false>(stage, batches, sweep, lanes);
    if (coloured.friction)
        return coloured.turns_unevenly
                   ? sweep_all<true, false, true>(stage, batches, sweep, lanes)
                   : sweep_all<true, false, false>(stage, batches, sweep, lanes);
    return coloured.turns_unevenly ? sweep_all<false, false, true>(stage, batches, sweep, lanes)
                                   : sweep_all<false, false, false>(stage, batches, sweep, lanes);
}

void leave_whirling_general(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            const Contact& c = stage.step.contacts[batch.contact[k]];
            if (!whirls(stage.simulation, stage.step, c.a) &&
                !whirls(stage.simulation, stage.step, c.b))
                continue;
            for (std::uint32_t p = 0; p < batch.points[k]; ++p) {
                coloured.rows[batch.row + p].along.mass.lane[k] = 0;
                if (!coloured.friction) continue;
                GeneralFriction& friction = coloured.general_friction[batch.row + p];
                friction.slide_mass.lane[k] = 0;
                for (Eight& mass : friction.mass) mass.lane[k] = 0;
            }
        }
    }
}

void keep_general(const ColouredStage& stage, BatchRange batches) {
    const ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            Vec4 h;
            for (int axis = 0; axis < 4; ++axis) h[axis] = coloured.frames[i].h[axis].lane[k];
            for (std::uint32_t p = 0; p < batch.points[k]; ++p) {
                const float normal = coloured.rows[batch.row + p].along.impulse.lane[k];
                if (stage.cause == Cause::kBlow) {
                    stage.step.hit[batch.contact[k] + p] = normal > 0;
                    continue;
                }
                ContactImpulse& impulse = stage.step.impulses[batch.contact[k] + p];
                impulse.normal = stage.mass_unit * normal;
                impulse.tangent.setZero();
                if (!coloured.friction) continue;
                Vec4 tangent = Vec4::Zero();
                for (int axis = 0; axis < 3; ++axis)
                    tangent[axis] = coloured.general_friction[batch.row + p].impulse[axis].lane[k];
                impulse.tangent = stage.mass_unit * (tangent - h.dot(tangent) * h);
                if (!coloured.rolling) continue;
                const Bivector turned =
                    bivector_in_lane(coloured.general_rolling[batch.row + p].impulse, k);
                stage.step.angular_impulses[batch.contact[k] + p] =
                    stage.mass_unit * (turned - wedge(h, velocity_at(turned, h)));
            }
        }
    }
}

}  // namespace tesserae
