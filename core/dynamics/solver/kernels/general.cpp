// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/kernels/general_sweep.hpp"
#include "core/dynamics/solver/kernels/points.hpp"
#include "core/dynamics/solver/kernels/sixteen.hpp"

namespace tesserae {

using namespace lanes;

double sweep_general(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes) {
    ColouredIslands& coloured = stage.step.coloured;
    const auto sweep_all = [&](auto friction, auto rolling, auto uneven) {
        float most = 0;
        for_lanes(batches, lanes, sweep.backward, [&](const auto& lane, std::uint32_t batch) {
            const auto left =
                solve_points<friction(), rolling(), uneven()>(coloured, lane, batch, sweep);
            if (sweep.measured) most = std::max(most, largest_lane(left));
        });
        return most;
    };
    if (lanes != LaneCount::kSixteen) return with_kind_of_general(coloured, sweep.pass, sweep_all);
    return largest_of_twos(coloured.general, batches, sweep.backward, [&](BatchRange some) {
        return some.end - some.begin == 2 ? sixteen::sweep_general(coloured, some.begin, sweep)
                                          : sweep_general(stage, some, sweep, LaneCount::kEight);
    });
}

void take_warm_start_general(const ColouredStage& stage, BatchRange batches) {
    ColouredIslands& coloured = stage.step.coloured;
    const Lane<Float8> lane;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        PairFrame& pair_frame = coloured.frames[i];
        const Frame<Float8> frame(load(lane, pair_frame.h));
        const FrameScrew<Float8> warm_start =
            frame.from_world(LanePair<Float8, false>(lane, coloured, i).motion());
        add_to(lane, warm_start.along, pair_frame.motion);
        if (coloured.friction) add_to(lane, warm_start.across, coloured.pair_friction[i].motion);
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
void keep_row(const ColouredStage& stage, std::uint32_t index, std::uint32_t point) {
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
        if (point >= batch.points[k]) continue;
        const std::uint32_t contact = batch.contact[k] + point;
        stage.step.impulses[contact] = {stage.mass_unit * normals.lane[k], slopes[k]};
        if (coloured.rolling)
            stage.step.angular_impulses[contact] =
                stage.mass_unit *
                angular_impulse_in_lane(coloured.general_rolling[row], coloured.frames[index], k);
    }
}

void keep_hits(const ColouredStage& stage, std::uint32_t index, std::uint32_t point) {
    const Batch& batch = stage.step.coloured.general[index];
    const Eight& normal = stage.step.coloured.impulses.normal[batch.row + point];
    for (std::size_t k = 0; k < kLanes; ++k)
        if (point < batch.points[k])
            stage.step.hit[batch.contact[k] + point] = stage.mass_unit * normal.lane[k];
}

}  // namespace

void keep_general(const ColouredStage& stage, BatchRange batches) {
    for (std::uint32_t i = batches.begin; i < batches.end; ++i)
        for (std::uint32_t point = 0; point < stage.step.coloured.general[i].rows; ++point)
            if (stage.cause == Cause::kImpact)
                keep_hits(stage, i, point);
            else
                keep_row(stage, i, point);
}

}  // namespace tesserae
