// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/kernels/general_sweep.hpp"
#include "core/dynamics/solver/kernels/points.hpp"
#include "core/dynamics/solver/kernels/sixteen.hpp"
#include "core/dynamics/solver/kernels/unswept.hpp"

namespace tesserae {

using namespace lanes;

namespace {

/// Sweeps one batch, or two at once.
double sweep_at_once(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    ColouredIslands& coloured = stage.step.coloured;
    if (batches.end - batches.begin == 2)
        return sixteen::sweep_general(coloured, batches.begin, sweep);
    return with_kind_of_general(
        coloured, sweep.pass, [&](auto friction, auto rolling, auto uneven) {
            float most = 0;
            for_lanes(lanes, sweep.backward, [&](const auto& lane) {
                const auto left = solve_points<friction(), rolling(), uneven()>(
                    coloured, lane, batches.begin, sweep);
                if (sweep.measured) most = std::max(most, largest_lane(left));
            });
            return most;
        });
}

}  // namespace

double sweep_general(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes,
                     Members some) {
    ColouredIslands& coloured = stage.step.coloured;
    return sweep_batches(coloured.general, batches, sweep, lanes, some, [&](BatchRange at_once) {
        return sweep_some(coloured, coloured.general, coloured.impulses, at_once, some,
                          [&] { return sweep_at_once(stage, at_once, sweep, lanes); });
    });
}

void take_warm_start_general(const ColouredStage& stage, BatchRange batches, Members some) {
    ColouredIslands& coloured = stage.step.coloured;
    const Lane<Float8> lane;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        PairFrame& pair_frame = coloured.frames[i];
        const Frame<Float8> frame(load(lane, pair_frame.h));
        const FrameScrew<Float8> warm_start =
            frame.from_world(LanePair<Float8, false>(lane, coloured, i).motion());
        const Float8 takes = lane.load(lanes_of(coloured.general[i], some));
        const auto take = [&](const auto& change, auto& motion) {
            for (std::size_t k = 0; k < change.size(); ++k) {
                const Float8 before = lane.load(motion[k]);
                lane.store(takes > Float8{} ? before + change[k] : before, motion[k]);
            }
        };
        take(warm_start.along, pair_frame.motion);
        if (coloured.friction) take(warm_start.across, coloured.pair_friction[i].motion);
    }
}

namespace {

/// A lane's angular impulse [N m s, world] of a row.
Bivector angular_impulse_in_lane(const GeneralRolling& row, const PairFrame& frame,
                                 std::size_t lane) {
    Vec4 h;
    for (std::size_t axis = 0; axis < 4; ++axis)
        h[static_cast<int>(axis)] = frame.h[axis].lane[lane];
    const auto entry = [&](std::size_t at) { return double{row.impulse[at].lane[lane]}; };
    const double g = h[3] < 0 ? 1 : -1;
    const Bivector turned = {entry(3), entry(4),     g * entry(0),
                             entry(5), g * entry(1), g * entry(2)};
    return turned - wedge(h, velocity_at(turned, h));
}

/// The impulses of a row in the world, lane by lane.
void keep_row(const ColouredStage& stage, std::uint32_t index, std::uint32_t point, Members some) {
    const ColouredIslands& coloured = stage.step.coloured;
    const Batch& batch = coloured.general[index];
    const std::uint32_t row = batch.row + point;
    const Eight& normals = coloured.impulses.normal[row];
    std::array<std::array<float, 4>, kLanes> slopes = {};
    if (coloured.friction) {
        const Lane<Float8> all;
        const Frame<Float8> frame(load(all, coloured.frames[index].h));
        LaneVec4<Float8> slope = frame.reflected(load(all, coloured.impulses.tangent[row]));
        const Float8 normal = all.load(normals);
        for (std::size_t i = 0; i < 4; ++i)
            slope[i] = normal > Float8{} ? slope[i] / normal : Float8{};
        std::array<float*, kLanes> to;
        for (std::size_t k = 0; k < kLanes; ++k) to[k] = slopes[k].data();
        store_four(slope.c, to);
    }
    for (std::size_t k = 0; k < kLanes; ++k) {
        if (point >= batch.points[k] || !some.has(batch.member[k])) continue;
        const std::uint32_t contact = batch.contact[k] + point;
        const double mass_unit = stage.mass_unit(batch.member[k]);
        stage.step.impulses[contact] = {mass_unit * normals.lane[k], slopes[k]};
        if (coloured.rolling)
            stage.step.angular_impulses[contact] =
                mass_unit *
                angular_impulse_in_lane(coloured.general_rolling[row], coloured.frames[index], k);
    }
}

void keep_hits(const ColouredStage& stage, std::uint32_t index, std::uint32_t point, Members some) {
    const Batch& batch = stage.step.coloured.general[index];
    const Eight& normal = stage.step.coloured.impulses.normal[batch.row + point];
    for (std::size_t k = 0; k < kLanes; ++k)
        if (point < batch.points[k] && some.has(batch.member[k]))
            stage.step.hit[batch.contact[k] + point] =
                stage.mass_unit(batch.member[k]) * normal.lane[k];
}

}  // namespace

void keep_general(const ColouredStage& stage, BatchRange batches, Members some) {
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        for (std::uint32_t point = 0; point < stage.step.coloured.general[i].rows; ++point)
            if (stage.cause == Cause::kImpact)
                keep_hits(stage, i, point, some);
            else
                keep_row(stage, i, point, some);
}

}  // namespace tesserae
