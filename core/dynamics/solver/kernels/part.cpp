// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/kernels/kernels.hpp"
#include "core/dynamics/solver/kernels/place.hpp"
#include "core/dynamics/solver/kernels/row.hpp"

// What the impulses of a coloured island's load do, and a part of them; see LoadWork.
namespace tesserae {
namespace {

using namespace lanes;
constexpr Lane<Float8> kEvery;

Eight stored(Float8 x) {
    Eight lanes;
    kEvery.store(x, lanes);
    return lanes;
}

template <std::size_t kSize>
Float8 product(const std::array<Float8, kSize>& x, const std::array<Eight, kSize>& y) {
    Float8 sum{};
    for (std::size_t i = 0; i < kSize; ++i) sum = fused(x[i], kEvery.load(y[i]), sum);
    return sum;
}

void scale(Eight& x, Float8 by) { kEvery.store(by * kEvery.load(x), x); }
template <std::size_t kSize>
void scale(std::array<Eight, kSize>& all, Float8 by) {
    for (Eight& x : all) scale(x, by);
}

}  // namespace

Eight load_work_of_round(const ColouredStage& stage, std::uint32_t batch) {
    const ColouredIslands& coloured = stage.step.coloured;
    const auto& [normal, tangent] = coloured.round_impulses;
    Float8 work =
        -kEvery.load(normal[batch]) * kEvery.load(coloured.round_rows[batch].along.target);
    if (coloured.friction)
        work += product(load_all(kEvery, coloured.round_friction[batch].slip), tangent[batch]);
    if (coloured.rolling) {
        const RoundRolling& rolling = coloured.round_rolling[batch];
        work += product(load_all(kEvery, rolling.turning), rolling.impulse);
    }
    return stored(work);
}

Eight load_work_of_general(const ColouredStage& stage, std::uint32_t index) {
    const ColouredIslands& coloured = stage.step.coloured;
    const Batch& batch = coloured.general[index];
    const auto along = load_all(kEvery, coloured.frames[index].motion);
    std::array<Float8, 6> across{};
    if (coloured.friction || coloured.rolling)
        across = load_all(kEvery, coloured.pair_friction[index].motion);
    Float8 work{};
    for (std::uint32_t row = batch.row; row < batch.row + batch.rows; ++row) {
        const Place<Float8> at = place_of(kEvery, coloured.rows[row]);
        const Float8 velocity = along_at(at, along) - kEvery.load(coloured.rows[row].along.target);
        work = fused(kEvery.load(coloured.impulses.normal[row]), velocity, work);
        if (coloured.friction) {
            const LaneVec4<Float8> slip = across_at(at, across);
            work += product<3>({slip[0], slip[1], slip[2]}, coloured.impulses.tangent[row]);
        }
        if (coloured.rolling)
            work += product<6>({along[1], along[2], along[3], across[3], across[4], across[5]},
                               coloured.general_rolling[row].impulse);
    }
    return stored(work);
}

void leave_part_of_round(const ColouredStage& stage, BatchRange batches,
                         const PerMember<float>& parts) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Float8 part = kEvery.load(of_lanes(coloured.round[i], parts));
        scale(coloured.round_impulses.normal[i], part);
        if (coloured.friction) scale(coloured.round_impulses.tangent[i], part);
        if (coloured.rolling) scale(coloured.round_rolling[i].impulse, part);
    }
}

void leave_part_of_general(const ColouredStage& stage, BatchRange batches,
                           const PerMember<float>& parts) {
    ColouredIslands& coloured = stage.step.coloured;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const Batch& batch = coloured.general[i];
        const Float8 part = kEvery.load(of_lanes(batch, parts));
        for (std::uint32_t row = batch.row; row < batch.row + batch.rows; ++row) {
            scale(coloured.impulses.normal[row], part);
            if (coloured.friction) scale(coloured.impulses.tangent[row], part);
            if (coloured.rolling) scale(coloured.general_rolling[row].impulse, part);
        }
    }
}

}  // namespace tesserae
