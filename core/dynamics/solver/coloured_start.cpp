#include <algorithm>

#include "core/dynamics/solver/coloured_place.hpp"
#include "core/dynamics/solver/coloured_points.hpp"

namespace tesserae {
namespace {

using namespace lanes;

/// A pair's responses, and its motion at the start.
/// @param turns   else its one point is the centre, where impulses do not turn
template <bool kFriction, class F, bool kUneven>
[[gnu::always_inline]] inline void start_frame(const Lane<F>& lane,
                                               const LanePair<F, kUneven>& pair,
                                               const Frame<F>& frame, const Screw<F>& motion,
                                               bool turns, PairFrame& pair_frame,
                                               PairFriction* friction) {
    const F one = F{} + 1.0f;
    const FrameScrew<F> start = frame.from_world(motion);
    store_all(lane, start.along, pair_frame.motion);
    if constexpr (kFriction) store_all(lane, start.across, friction->motion);
    const Response<F, kUneven> response(pair);
    for (std::size_t i = 0; i < 4; ++i) {
        FrameScrew<F> unit{};
        if (i == 0 || turns) {
            unit.along[i] = one;
            unit = frame.from_world(response(frame.to_world(unit)));
        }
        for (std::size_t j = i; j < 4; ++j)
            lane.store(unit.along[j], pair_frame.response[in_triangle<4>(i, j)]);
        if constexpr (kFriction) store_all(lane, unit.across, friction->coupled[i]);
    }
    if constexpr (kFriction)
        for (std::size_t i = 0; i < 6; ++i) {
            FrameScrew<F> unit{};
            if (i < 3 || turns) {
                unit.across[i] = one;
                unit = frame.from_world(response(frame.to_world(unit)));
            }
            for (std::size_t j = i; j < 6; ++j)
                lane.store(unit.across[j], friction->response[in_triangle<6>(i, j)]);
        }
}

/// The masses of rolling or twisting: of a block of three of a response.
/// @param first   of its rows
template <std::size_t kSize, class F, std::size_t kEntries>
[[gnu::always_inline]] inline void start_turning(const Lane<F>& lane,
                                                 const std::array<Eight, kEntries>& response,
                                                 std::size_t first, std::array<Eight, 6>& mass,
                                                 Eight& step_mass) {
    const auto entry = [&](std::size_t i, std::size_t j) {
        return lane.load(response[in_triangle<kSize>(first + i, first + j)]);
    };
    std::array<F, 6> inverse;
    F step;
    invert<F>({entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)}, F{},
              inverse, step);
    store_all(lane, inverse, mass);
    lane.store(step, step_mass);
}

/// The angular impulse that a point starts from, in world axes at first; what the present normal
/// impulse does not allow is left out.
template <class F>
[[gnu::always_inline]] inline void start_point_rolling(const Lane<F>& lane, const Frame<F>& frame,
                                                       F most, GeneralRolling& row,
                                                       FrameScrew<F>& impulse) {
    const FrameScrew<F> last = frame.from_world({{}, load(lane, row.impulse)});
    const auto &n = last.along, &t = last.across;
    const LaneVec4<F> rolling = clamped<F>(LaneVec4<F>{n[1], n[2], n[3], F{}}, most);
    const LaneVec4<F> twisting = clamped<F>(LaneVec4<F>{t[3], t[4], t[5], F{}}, most);
    for (std::size_t i = 0; i < 3; ++i) {
        lane.store(rolling[i], row.impulse[i]);
        lane.store(twisting[i], row.impulse[3 + i]);
        impulse.along[1 + i] += rolling[i];
        impulse.across[3 + i] += twisting[i];
    }
}

/// A block of three of the tangents at a place, from what each does there.
template <class F>
[[gnu::always_inline]] inline std::array<F, 6> tangent_response(const Lane<F>& lane,
                                                                const PairFriction& friction,
                                                                const Place<F>& at) {
    std::array<LaneVec4<F>, 3> K;
    for (std::size_t i = 0; i < 3; ++i) {
        LaneVec4<F> direction{};
        direction[i] = F{} + 1.0f;
        std::array<F, 6> change{};
        add_product(lane, friction.response, seen_from_centre(at, direction), change);
        K[i] = across_at(at, change);
    }
    return {K[0][0], K[0][1], K[0][2], K[1][1], K[1][2], K[2][2]};
}

template <bool kFriction, bool kRolling, bool kUneven, class F>
[[gnu::always_inline]] inline void start_points(const ColouredStage& stage, const Lane<F>& lane,
                                                std::uint32_t index, const EightPairs& pairs) {
    ColouredIslands& coloured = stage.step.coloured;
    const Batch& batch = coloured.general[index];
    PairFrame& pair_frame = coloured.frames[index];
    const F one = F{} + 1.0f, least = lane.load(pairs.rounding);
    // h along n - g w, which is never short.
    LaneVec4<F> h = load(lane, pairs.normal);
    h[3] = h[3] > F{} ? h[3] + one : h[3] - one;
    const F scale = square_root((F{} + 2.0f) / dot(h, h));
    const Frame<F> frame(scale * h);
    store(lane, frame.h, pair_frame.h);
    store(lane, load(lane, pairs.centre_a), pair_frame.centre_a);
    store(lane, load(lane, pairs.centre_b), pair_frame.centre_b);
    LanePair<F, kUneven> pair(lane, coloured, batch, pair_frame);
    PairFriction* friction = kFriction ? &coloured.pair_friction[index] : nullptr;
    start_frame<kFriction>(lane, pair, frame,
                           {load(lane, pairs.velocity), load(lane, pairs.turning)},
                           batch.rows > 1 || kRolling, pair_frame, friction);
    F arm{};
    if constexpr (kRolling) {
        PairRolling& rolling = coloured.pair_rolling[index];
        start_turning<4, F>(lane, pair_frame.response, 1, rolling.rolling_mass,
                            rolling.rolling_step);
        start_turning<6, F>(lane, friction->response, 3, rolling.twisting_mass,
                            rolling.twisting_step);
        arm = lane.load(rolling.arm);
    }

    FrameScrew<F> impulse{};
    for (std::uint32_t k = 0; k < batch.rows; ++k) {
        GeneralRow& row = coloured.rows[batch.row + k];
        const LaneVec4<F> r = frame.reflected(load(lane, pairs.points[k].place));
        const Place<F> at = {r[0], r[1], r[2]};
        store_all(lane, at, row.at);
        const std::array<F, 4> unit = {one, at[0], at[1], at[2]};
        std::array<F, 4> change{};
        add_product(lane, pair_frame.response, unit, change);
        const F normal_impulse =
            start_normal(lane, pairs.points[k].along, along_at(at, change), least, row.along);
        for (std::size_t i = 0; i < 4; ++i)
            impulse.along[i] = fused(normal_impulse, unit[i], impulse.along[i]);
        if constexpr (kFriction) {
            GeneralFriction& tangents = coloured.general_friction[batch.row + k];
            std::array<F, 6> inverse;
            F slide;
            invert<F>(tangent_response(lane, *friction, at), least, inverse, slide);
            store_all(lane, inverse, tangents.mass);
            lane.store(slide, tangents.slide_mass);
            // The normal may have turned since the impulse was.
            LaneVec4<F> tangent = frame.reflected(load(lane, pairs.points[k].impulse));
            tangent[3] = F{};
            tangent = clamped<F>(tangent, lane.load(friction->friction) * normal_impulse);
            store(lane, tangent, tangents.impulse);
            add(seen_from_centre(at, tangent), impulse.across);
        }
        if constexpr (kRolling)
            start_point_rolling(lane, frame, arm * normal_impulse,
                                coloured.general_rolling[batch.row + k], impulse);
    }
    pair.apply(frame.to_world(impulse));
}

template <bool kFriction, bool kRolling, bool kUneven>
void start_all(const ColouredStage& stage, BatchRange batches, LaneCount lanes) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        EightPairs pairs;
        if constexpr (kFriction) coloured.pair_friction[i].friction = {};
        if constexpr (kRolling) {
            coloured.pair_rolling[i] = {};
            std::fill_n(&coloured.general_rolling[batch.row], batch.rows, GeneralRolling{});
        }
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
            put_pair(stage, batch.contact[k], batch.points[k], k, pairs);
            const Contact& c = stage.step.contacts[batch.contact[k]];
            if constexpr (kFriction)
                coloured.pair_friction[i].friction.lane[k] = float_friction(stage, c);
            if constexpr (kRolling) {
                coloured.pair_rolling[i].arm.lane[k] = float_rolling_arm(stage, c);
                for (std::uint32_t p = 0; p < batch.points[k]; ++p)
                    put_angular_impulse(stage, batch.contact[k] + p, k,
                                        coloured.general_rolling[batch.row + p].impulse);
            }
        }
        for_lanes({i, i + 1}, lanes, false, [&](const auto& lane, std::uint32_t) {
            start_points<kFriction, kRolling, kUneven>(stage, lane, i, pairs);
        });
    }
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

}  // namespace tesserae
