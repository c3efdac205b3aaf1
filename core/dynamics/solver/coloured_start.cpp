#include <algorithm>

#include "core/dynamics/solver/coloured_place.hpp"
#include "core/dynamics/solver/coloured_points.hpp"

namespace tesserae {
namespace {

using namespace lanes;

/// A pair's responses to impulses along the normal and across it: symmetric.
template <class F>
struct Responses {
    std::array<F, 10> along;
    std::array<F, 21> across;
};
/// @param turns   else its one point is the centre, where impulses do not turn
template <bool kFriction, class F, bool kUneven>
[[gnu::always_inline]] inline void make_frame(const Lane<F>& lane, const LanePair<F, kUneven>& pair,
                                              const Frame<F>& frame, bool turns, Responses<F>& to,
                                              PairFriction* friction) {
    const F one = F{} + 1.0f;
    const Response<F, kUneven> response(pair);
    for (std::size_t i = 0; i < 4; ++i) {
        FrameScrew<F> unit{};
        if (i == 0 || turns) {
            unit.along[i] = one;
            unit = frame.from_world(response(frame.to_world(unit)));
        }
        for (std::size_t j = i; j < 4; ++j) to.along[in_triangle<4>(i, j)] = unit.along[j];
        if constexpr (kFriction) store_all(lane, unit.across, friction->coupled[i]);
    }
    if constexpr (kFriction)
        for (std::size_t i = 0; i < 6; ++i) {
            FrameScrew<F> unit{};
            if (i < 3 || turns) {
                unit.across[i] = one;
                unit = frame.from_world(response(frame.to_world(unit)));
            }
            for (std::size_t j = i; j < 6; ++j) to.across[in_triangle<6>(i, j)] = unit.across[j];
        }
    if constexpr (kFriction) store_all(lane, to.across, friction->response);
}

/// The masses of rolling or twisting: of a block of three of a response.
/// @param first   of its rows
template <std::size_t kSize, class F, std::size_t kEntries>
[[gnu::always_inline]] inline void make_turning(const Lane<F>& lane,
                                                const std::array<F, kEntries>& response,
                                                std::size_t first, std::array<Eight, 6>& mass,
                                                Eight& step_mass) {
    const auto entry = [&](std::size_t i, std::size_t j) {
        return response[in_triangle<kSize>(first + i, first + j)];
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
[[gnu::always_inline]] inline std::array<F, 6> tangent_response(const std::array<F, 21>& across,
                                                                const Place<F>& at) {
    std::array<LaneVec4<F>, 3> K;
    for (std::size_t i = 0; i < 3; ++i) {
        LaneVec4<F> direction{};
        direction[i] = F{} + 1.0f;
        std::array<F, 6> change{};
        add_product(across, seen_from_centre(at, direction), change);
        K[i] = across_at(at, change);
    }
    return {K[0][0], K[0][1], K[0][2], K[1][1], K[1][2], K[2][2]};
}

/// What a unit impulse at a point does at those before it and at itself.
/// @param motion   what it changes of the motion along the normal
template <class F>
[[gnu::always_inline]] inline void store_responses(const Lane<F>& lane, ColouredIslands& coloured,
                                                   const Batch& batch, std::uint32_t point,
                                                   const std::array<F, 4>& motion) {
    RoughEight* const row = &coloured.point_response[batch.response + point * (point + 1) / 2];
    for (std::uint32_t k = 0; k <= point; ++k)
        lane.store(along_at(place_of(lane, coloured.rows[batch.row + k]), motion), row[k]);
}
/// Of the points that the batch does not have.
template <class F>
[[gnu::always_inline]] inline void store_padding(const Lane<F>& lane, ColouredIslands& coloured,
                                                 const Batch& batch) {
    RoughEight* const first = &coloured.point_response[batch.response];
    for (std::uint32_t k = batch.rows * (batch.rows + 1) / 2; k < responses_of(batch.rows); ++k)
        lane.store(F{}, first[k]);
}

/// What depends on where the bodies are: the same for a blow and for the load after it.
template <bool kFriction, bool kRolling, bool kUneven, class F>
[[gnu::always_inline]] inline void make_points(const ColouredStage& stage, const Lane<F>& lane,
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
    if constexpr (kUneven) {
        PairInertia& inertia = coloured.pair_inertias[index];
        gather_inertias(lane, coloured.inverse_inertias, batch.a, inertia.a);
        gather_inertias(lane, coloured.inverse_inertias, batch.b, inertia.b);
    }
    const LanePair<F, kUneven> pair(lane, coloured, index);
    PairFriction* friction = kFriction ? &coloured.pair_friction[index] : nullptr;
    Responses<F> response;
    make_frame<kFriction>(lane, pair, frame, batch.rows > 1 || kRolling, response, friction);
    if constexpr (kRolling) {
        PairRolling& rolling = coloured.pair_rolling[index];
        store_all(lane, response.along, rolling.response);
        make_turning<4>(lane, response.along, 1, rolling.rolling_mass, rolling.rolling_step);
        make_turning<6>(lane, response.across, 3, rolling.twisting_mass, rolling.twisting_step);
    }
    for (std::uint32_t k = 0; k < batch.rows; ++k) {
        GeneralRow& row = coloured.rows[batch.row + k];
        const LaneVec4<F> r = frame.reflected(load(lane, pairs.points[k].place));
        const Place<F> at = {r[0], r[1], r[2]};
        store_all(lane, at, row.at);
        const std::array<F, 4> unit = {one, at[0], at[1], at[2]};
        std::array<F, 4> change{};
        add_product(response.along, unit, change);
        store_responses(lane, coloured, batch, k, change);
        make_normal(lane, load(lane, pairs.points[k].along)[2], along_at(at, change), least,
                    row.along);
        if constexpr (kFriction) {
            GeneralFriction& tangents = coloured.general_friction[batch.row + k];
            std::array<F, 6> inverse;
            F slide;
            invert<F>(tangent_response(response.across, at), least, inverse, slide);
            store_all(lane, inverse, tangents.mass);
            lane.store(slide, tangents.slide_mass);
        }
    }
    store_padding(lane, coloured, batch);
}

/// What depends on how they move, and the impulses to start from.
template <bool kFriction, bool kRolling, bool kUneven, class F>
[[gnu::always_inline]] inline void start_points(const ColouredStage& stage, const Lane<F>& lane,
                                                std::uint32_t index, const EightPairs& pairs) {
    ColouredIslands& coloured = stage.step.coloured;
    const Batch& batch = coloured.general[index];
    PairFrame& pair_frame = coloured.frames[index];
    const Frame<F> frame(load(lane, pair_frame.h));
    const FrameScrew<F> motion =
        frame.from_world({load(lane, pairs.velocity), load(lane, pairs.turning)});
    store_all(lane, motion.along, pair_frame.motion);
    if constexpr (kFriction) store_all(lane, motion.across, coloured.pair_friction[index].motion);

    FrameScrew<F> impulse{};
    for (std::uint32_t k = 0; k < batch.rows; ++k) {
        GeneralRow& row = coloured.rows[batch.row + k];
        const Place<F> at = place_of(lane, row);
        const F normal_impulse =
            start_normal(lane, load(lane, pairs.points[k].along), batch.row + k, row.along,
                         coloured.relax, coloured.impulses.normal);
        const std::array<F, 4> unit = {F{} + 1.0f, at[0], at[1], at[2]};
        for (std::size_t i = 0; i < 4; ++i)
            impulse.along[i] = fused(normal_impulse, unit[i], impulse.along[i]);
        if constexpr (kFriction) {
            // The normal may have turned since the impulse was.
            LaneVec4<F> tangent = frame.reflected(load(lane, pairs.points[k].impulse));
            tangent[3] = F{};
            const F most = lane.load(coloured.pair_friction[index].friction) * normal_impulse;
            tangent = clamped<F>(tangent, most);
            store(lane, tangent, coloured.impulses.tangent[batch.row + k]);
            add(seen_from_centre(at, tangent), impulse.across);
        }
        if constexpr (kRolling)
            start_point_rolling(lane, frame,
                                lane.load(coloured.pair_rolling[index].arm) * normal_impulse,
                                coloured.general_rolling[batch.row + k], impulse);
    }
    LanePair<F, kUneven>(lane, coloured, index).apply(frame.to_world(impulse));
}

template <bool kFriction, bool kRolling, bool kUneven>
void start_all(const ColouredStage& stage, BatchRange batches, LaneCount lanes) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        EightPairs pairs;
        if constexpr (kFriction) coloured.pair_friction[i].friction = {};
        if constexpr (kRolling) {
            coloured.pair_rolling[i].arm = {};
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
            if (!stage.made) make_points<kFriction, kRolling, kUneven>(stage, lane, i, pairs);
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
