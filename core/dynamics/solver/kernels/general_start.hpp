// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "core/dynamics/solver/kernels/input.hpp"
#include "core/dynamics/solver/kernels/place.hpp"
#include "core/dynamics/solver/kernels/row.hpp"

// Makes batches of pairs that are not round from their contacts.
namespace tesserae::lanes {

/// The response at a pair's centre to a unit impulse along each axis and to a unit moment in each
/// plane. It is symmetric.
template <class F>
struct CentreResponse {
    std::array<LaneVec4<F>, 4> straight{};     ///< velocity, to impulses
    std::array<LaneVec4<F>, 6> coupled{};      ///< velocity, to moments; turning, to impulses
    std::array<LaneBivector<F>, 6> turning{};  ///< turning, to moments
};
/// Returns one component of the vectors of all planes.
template <class F>
[[gnu::always_inline]] inline LaneBivector<F> of_axis(const std::array<LaneVec4<F>, 6>& of_planes,
                                                      std::size_t axis) {
    LaneBivector<F> b;
    for (std::size_t plane = 0; plane < 6; ++plane) b[plane] = of_planes[plane][axis];
    return b;
}

/// Adds a body's part of the response, without its mass. An impulse p has the moment c ^ p, and
/// w.(c ^ p) is p.velocity_at(w, c).
template <class F, bool kUneven>
[[gnu::always_inline]] inline void add_turning(const Inverse<F, kUneven>& inverse,
                                               const LaneVec4<F>& centre, CentreResponse<F>& to) {
    std::array<LaneVec4<F>, 6> coupled;
    for (std::size_t plane = 0; plane < 6; ++plane) {
        const LaneBivector<F> turning = inverse.column(plane);
        coupled[plane] = velocity_at(turning, centre);
        to.turning[plane] = to.turning[plane] + turning;
        to.coupled[plane] = to.coupled[plane] + coupled[plane];
    }
    for (std::size_t axis = 0; axis < 4; ++axis)
        to.straight[axis] = to.straight[axis] + velocity_at(of_axis(coupled, axis), centre);
}

/// Returns a response in the frame's axes from that in the world's.
template <class F>
[[gnu::always_inline]] inline CentreResponse<F> reflected(const Frame<F>& frame,
                                                          const CentreResponse<F>& of) {
    std::array<LaneVec4<F>, 4> straight;
    std::array<LaneVec4<F>, 6> coupled;
    std::array<LaneBivector<F>, 6> turning;
    for (std::size_t i = 0; i < 4; ++i) straight[i] = frame.reflected(of.straight[i]);
    for (std::size_t i = 0; i < 6; ++i) coupled[i] = frame.reflected(of.coupled[i]);
    for (std::size_t i = 0; i < 6; ++i) turning[i] = frame.reflected(of.turning[i]);
    CentreResponse<F> to;
    for (std::size_t j = 0; j < 4; ++j) {
        to.straight[j] = frame.reflected(
            LaneVec4<F>{straight[0][j], straight[1][j], straight[2][j], straight[3][j]});
        const LaneBivector<F> turned = frame.reflected(of_axis(coupled, j));
        for (std::size_t i = 0; i < 6; ++i) to.coupled[i][j] = turned[i];
    }
    for (std::size_t j = 0; j < 6; ++j)
        to.turning[j] =
            frame.reflected(LaneBivector<F>{turning[0][j], turning[1][j], turning[2][j],
                                            turning[3][j], turning[4][j], turning[5][j]});
    return to;
}

/// The responses of a pair to impulses along the normal and across it. They are symmetric.
template <class F>
struct Responses {
    std::array<F, 10> along;
    std::array<F, 21> across;
};
/// Returns x, or 0 if it is negligible beside another entry, see kSpeck.
template <class F>
[[gnu::always_inline]] inline F unless_speck(F x, F beside) {
    return magnitude(x) < static_cast<float>(kSpeck) * beside ? F{} : x;
}
template <class F>
[[gnu::always_inline]] inline void leave_specks_out(CentreResponse<F>& response) {
    F straight{}, turning{};
    for (std::size_t i = 0; i < 4; ++i) straight = larger(straight, response.straight[i][i]);
    for (std::size_t i = 0; i < 6; ++i) turning = larger(turning, response.turning[i][i]);
    const F coupled = square_root(straight * turning);
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 6; ++j)
            response.turning[i][j] = unless_speck(response.turning[i][j], turning);
        for (std::size_t j = 0; j < 4; ++j)
            response.coupled[i][j] = unless_speck(response.coupled[i][j], coupled);
    }
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            response.straight[i][j] = unless_speck(response.straight[i][j], straight);
}

/// The numbers of the planes xn yn zn and of the planes xy xz yz, see FrameScrew.
constexpr std::array<std::size_t, 3> kAlong = {2, 4, 5}, kAcross = {0, 1, 3};
template <bool kFriction, class F, bool kUneven>
[[gnu::always_inline]] inline void make_frame(const Lane<F>& lane, const LanePair<F, kUneven>& pair,
                                              const Frame<F>& frame, Responses<F>& to,
                                              ColouredIslands& coloured, std::uint32_t index) {
    CentreResponse<F> world;
    add_turning(pair.inverse_a(), pair.centre_a(), world);
    add_turning(pair.inverse_b(), pair.centre_b(), world);
    for (std::size_t i = 0; i < 4; ++i) world.straight[i][i] += pair.inverse_mass();
    CentreResponse<F> of = reflected(frame, world);
    leave_specks_out(of);
    to.along[0] = of.straight[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
        to.along[in_triangle<4>(0, 1 + i)] = of.coupled[kAlong[i]][3];
        for (std::size_t j = i; j < 3; ++j)
            to.along[in_triangle<4>(1 + i, 1 + j)] = of.turning[kAlong[i]][kAlong[j]];
    }
    if constexpr (kFriction) {
        std::array<std::array<F, 6>, 4> coupled;
        for (std::size_t i = 0; i < 3; ++i) {
            coupled[0][i] = frame.g * of.straight[3][i];
            coupled[0][3 + i] = frame.g * of.coupled[kAcross[i]][3];
            for (std::size_t j = 0; j < 3; ++j) {
                coupled[1 + i][j] = frame.g * of.coupled[kAlong[i]][j];
                coupled[1 + i][3 + j] = frame.g * of.turning[kAlong[i]][kAcross[j]];
                to.across[in_triangle<6>(i, 3 + j)] = of.coupled[kAcross[j]][i];
            }
            for (std::size_t j = i; j < 3; ++j) {
                to.across[in_triangle<6>(i, j)] = of.straight[i][j];
                to.across[in_triangle<6>(3 + i, 3 + j)] = of.turning[kAcross[i]][kAcross[j]];
            }
        }
        const auto& in = lane.template in_batch<PairFriction>();
        AcrossResponse& response = coloured.pair_friction[index].response;
        for (std::size_t i = 0; i < 4; ++i) store_all(in, coupled[i], response.along[i]);
        store_all(in, to.across, response.across);
    }
}

/// Computes the masses of rolling or twisting from a block of three of a response.
/// @param first   first row of the block
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

/// Starts a point's angular impulse, which is given in world axes, clamped to what its present
/// normal impulse allows.
template <class F>
[[gnu::always_inline]] inline void start_point_rolling(const Lane<F>& lane, const Frame<F>& frame,
                                                       F most, GeneralRolling& row,
                                                       FrameScrew<F>& impulse) {
    const FrameScrew<F> last = frame.from_world({{}, load(lane, row.impulse)});
    const std::array<F, 4>& n = last.along;
    const std::array<F, 6>& t = last.across;
    const LaneVec4<F> rolling = clamped<F>(LaneVec4<F>{n[1], n[2], n[3], F{}}, most);
    const LaneVec4<F> twisting = clamped<F>(LaneVec4<F>{t[3], t[4], t[5], F{}}, most);
    for (std::size_t i = 0; i < 3; ++i) {
        lane.store(rolling[i], row.impulse[i]);
        lane.store(twisting[i], row.impulse[3 + i]);
        impulse.along[1 + i] += rolling[i];
        impulse.across[3 + i] += twisting[i];
    }
}

/// Returns the velocity across the normal at a place by turning in xy xz yz alone.
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> turned_at(const Place<F>& at, F xy, F xz, F yz) {
    const auto& [x, y, z] = at;
    return {-fused(y, xy, z * xz), fused(x, xy, -(z * yz)), fused(x, xz, y * yz), F{}};
}
/// Returns the response of the three tangents at a place: xx xy xz yy yz zz.
template <class F>
[[gnu::always_inline]] inline std::array<F, 6> tangent_response(const std::array<F, 21>& across,
                                                                const Place<F>& at) {
    const auto entry = [&](std::size_t i, std::size_t j) { return across[in_triangle<6>(i, j)]; };
    std::array<LaneVec4<F>, 3> coupled, turning;  // by the moments of unit impulses at the place
    for (std::size_t i = 0; i < 3; ++i) {
        coupled[i] = turned_at(at, entry(i, 3), entry(i, 4), entry(i, 5));
        turning[i] = turned_at(at, entry(3 + i, 3), entry(3 + i, 4), entry(3 + i, 5));
    }
    std::array<F, 6> K;
    for (std::size_t j = 0; j < 3; ++j) {
        const LaneVec4<F> turned = turned_at(at, turning[0][j], turning[1][j], turning[2][j]);
        for (std::size_t i = 0; i <= j; ++i)
            K[in_triangle<3>(i, j)] = entry(i, j) + (coupled[i][j] + coupled[j][i]) + turned[i];
    }
    return K;
}

/// Writes the response to a unit impulse at a point, at this point and at those before it.
/// @param motion   change of the motion along the normal by the impulse
template <class F>
[[gnu::always_inline]] inline void store_responses(const Lane<F>& lane, ColouredIslands& coloured,
                                                   const Batch& batch, std::uint32_t point,
                                                   const std::array<F, 4>& motion) {
    RoughEight* const row = &coloured.point_response[batch.response + point * (point + 1) / 2];
    for (std::uint32_t k = 0; k <= point; ++k)
        lane.in_responses().store(along_at(place_of(lane, coloured.rows[batch.row + k]), motion),
                                  row[k]);
}
/// Writes the responses of points that the batch does not have.
template <class F>
[[gnu::always_inline]] inline void store_padding(const Lane<F>& lane, ColouredIslands& coloured,
                                                 const Batch& batch) {
    RoughEight* const first = &coloured.point_response[batch.response];
    for (std::uint32_t k = batch.rows * (batch.rows + 1) / 2; k < responses_of(batch.rows); ++k)
        lane.in_responses().store(F{}, first[k]);
}

/// Makes the part of the rows that depends on where the bodies are. It is the same for an impact
/// and for the load after it.
template <bool kFriction, bool kRolling, bool kUneven, class F>
[[gnu::always_inline]] inline void make_points(ColouredIslands& coloured, const Lane<F>& lane,
                                               std::uint32_t index, const EightPairs& pairs) {
    const Batch& batch = coloured.general[index];
    PairFrame& pair_frame = coloured.frames[index];
    const auto& in_frame = lane.template in_batch<PairFrame>();
    const auto& in_pairs = lane.template in_batch<EightPairs>();
    const F one = F{} + 1.0f, least = in_pairs.load(pairs.rounding);
    // h along n - g w, which is never short.
    LaneVec4<F> h = load(in_pairs, pairs.normal);
    h[3] = h[3] > F{} ? h[3] + one : h[3] - one;
    const F scale = square_root((F{} + 2.0f) / dot(h, h));
    const Frame<F> frame(scale * h);
    store(in_frame, frame.h, pair_frame.h);
    store(in_frame, load(in_pairs, pairs.centre_a), pair_frame.centre_a);
    store(in_frame, load(in_pairs, pairs.centre_b), pair_frame.centre_b);
    if constexpr (kUneven) {
        PairInertia& inertia = coloured.pair_inertias[index];
        gather_inertias(lane, coloured.inverse_inertias, batch.a, inertia.a);
        gather_inertias(lane, coloured.inverse_inertias, batch.b, inertia.b);
    }
    const LanePair<F, kUneven> pair(lane, coloured, index);
    Responses<F> response;
    make_frame<kFriction>(lane, pair, frame, response, coloured, index);
    if constexpr (kRolling) {
        PairRolling& rolling = coloured.pair_rolling[index];
        const auto& in_rolling = lane.template in_batch<PairRolling>();
        store_all(in_rolling, response.along, rolling.response);
        make_turning<4>(in_rolling, response.along, 1, rolling.rolling_mass, rolling.rolling_step);
        make_turning<6>(in_rolling, response.across, 3, rolling.twisting_mass,
                        rolling.twisting_step);
    }
    const auto& in_row = lane.template in_row<GeneralRow>();
    for (std::uint32_t k = 0; k < batch.rows; ++k) {
        GeneralRow& row = coloured.rows[batch.row + k];
        const LaneVec4<F> r = frame.reflected(load(in_pairs, pairs.points[k].place));
        const Place<F> at = {r[0], r[1], r[2]};
        store_all(in_row, at, row.at);
        const std::array<F, 4> unit = {one, at[0], at[1], at[2]};
        std::array<F, 4> change{};
        add_product(response.along, unit, change);
        store_responses(lane, coloured, batch, k, change);
        make_normal(in_row, load(in_pairs, pairs.points[k].along)[2], along_at(at, change), least,
                    row.along);
        if constexpr (kFriction) {
            GeneralFriction& tangents = coloured.general_friction[batch.row + k];
            std::array<F, 6> inverse;
            F slide;
            invert<F>(tangent_response(response.across, at), least, inverse, slide);
            for (F& entry : inverse) entry = unless_speck(entry, slide);
            const auto& in = lane.template in_row<GeneralFriction>();
            store_all(in, inverse, tangents.mass);
            in.store(slide, tangents.slide_mass);
        }
    }
    store_padding(lane, coloured, batch);
}

/// Makes the part of the rows that depends on how the bodies move, and their first impulses.
template <bool kFriction, bool kRolling, bool kUneven, class F>
[[gnu::always_inline]] inline void start_points(ColouredIslands& coloured, const Lane<F>& lane,
                                                std::uint32_t index, const EightPairs& pairs) {
    const Batch& batch = coloured.general[index];
    PairFrame& pair_frame = coloured.frames[index];
    const auto& in_frame = lane.template in_batch<PairFrame>();
    const auto& in_pairs = lane.template in_batch<EightPairs>();
    const Frame<F> frame(load(in_frame, pair_frame.h));
    const FrameScrew<F> motion =
        frame.from_world({load(in_pairs, pairs.velocity), load(in_pairs, pairs.turning)});
    store_all(in_frame, motion.along, pair_frame.motion);
    const auto& in_friction = lane.template in_batch<PairFriction>();
    if constexpr (kFriction)
        store_all(in_friction, motion.across, coloured.pair_friction[index].motion);

    const NormalLanes<F> lanes = {lane.template in_row<GeneralRow>(),
                                  lane.template in_row<Eight>()};
    FrameScrew<F> impulse{};
    for (std::uint32_t k = 0; k < batch.rows; ++k) {
        GeneralRow& row = coloured.rows[batch.row + k];
        const Place<F> at = place_of(lane, row);
        const F normal_impulse =
            start_normal(lanes, load(in_pairs, pairs.points[k].along), batch.row + k, row.along,
                         coloured.second, coloured.impulses.normal);
        const std::array<F, 4> unit = {F{} + 1.0f, at[0], at[1], at[2]};
        for (std::size_t i = 0; i < 4; ++i)
            impulse.along[i] = fused(normal_impulse, unit[i], impulse.along[i]);
        if constexpr (kFriction) {
            // The normal may have turned since the last step.
            LaneVec4<F> tangent = frame.reflected(load(in_pairs, pairs.points[k].impulse));
            tangent[3] = F{};
            const F most =
                in_friction.load(coloured.pair_friction[index].friction) * normal_impulse;
            tangent = clamped<F>(tangent, most);
            store(lane.template in_row<std::array<Eight, 3>>(), tangent,
                  coloured.impulses.tangent[batch.row + k]);
            add(seen_from_centre(at, tangent), impulse.across);
        }
        if constexpr (kRolling)
            start_point_rolling(
                lane.template in_row<GeneralRolling>(), frame,
                lane.template in_batch<PairRolling>().load(coloured.pair_rolling[index].arm) *
                    normal_impulse,
                coloured.general_rolling[batch.row + k], impulse);
    }
    LanePair<F, kUneven>(lane, coloured, index).apply(frame.to_world(impulse));
}

/// Makes the rows of a batch, or of two, unless an impact has made them before, and applies the
/// impulses that they start from.
template <bool kFriction, bool kRolling, bool kUneven, class F>
[[gnu::always_inline]] inline void start_pairs(ColouredIslands& coloured, const Lane<F>& lane,
                                               std::uint32_t index, bool made,
                                               const EightPairs& pairs) {
    if (!made) make_points<kFriction, kRolling, kUneven>(coloured, lane, index, pairs);
    start_points<kFriction, kRolling, kUneven>(coloured, lane, index, pairs);
}

}  // namespace tesserae::lanes
