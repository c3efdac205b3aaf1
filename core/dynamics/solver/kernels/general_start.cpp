// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/kernels/general_start.hpp"

#include "core/dynamics/solver/kernels/general_sweep.hpp"
#include "core/dynamics/solver/kernels/points.hpp"
#include "core/dynamics/solver/kernels/sixteen.hpp"

namespace tesserae {
namespace {

using namespace lanes;

/// The contacts of a batch, and what is put into its rows at once.
template <bool kFriction, bool kRolling>
void put_pairs(const ColouredStage& stage, std::uint32_t index, EightPairs& pairs) {
    ColouredIslands& coloured = stage.step.coloured;
    const Batch& batch = coloured.general[index];
    prefetch(stage, coloured.general, index);
    if (!is_full(batch)) pairs = {};
    if constexpr (kFriction) coloured.pair_friction[index].friction = {};
    if constexpr (kRolling) {
        coloured.pair_rolling[index].arm = {};
        std::fill_n(&coloured.general_rolling[batch.row], batch.rows, GeneralRolling{});
    }
    for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
        put_pair(stage, batch.contact[k], batch.points[k], k, pairs);
        const Contact& c = stage.step.contacts[batch.contact[k]];
        if constexpr (kFriction)
            coloured.pair_friction[index].friction.lane[k] = float_friction(stage, c);
        if constexpr (kRolling) {
            coloured.pair_rolling[index].arm.lane[k] = float_rolling_arm(stage, c);
            for (std::uint32_t p = 0; p < batch.points[k]; ++p)
                put_angular_impulse(stage, batch.contact[k] + p, k,
                                    coloured.general_rolling[batch.row + p].impulse);
        }
    }
}

}  // namespace

void start_general(const ColouredStage& stage, BatchRange batches, LaneCount lanes) {
    ColouredIslands& coloured = stage.step.coloured;
    with_kind_of_general(coloured, Pass::kSolve, [&](auto friction, auto rolling, auto uneven) {
        const auto start_one = [&](std::uint32_t i) {
            EightPairs pairs;
            put_pairs<friction(), rolling()>(stage, i, pairs);
            for_lanes({i, i + 1}, lanes, false, [&](const auto& lane, std::uint32_t) {
                start_pairs<friction(), rolling(), uneven()>(coloured, lane, i, stage.made, pairs);
            });
        };
        if (lanes != LaneCount::kSixteen) {
            for (std::uint32_t i = batches.begin; i < batches.end; ++i) start_one(i);
            return;
        }
        largest_of_twos(coloured.general, batches, false, [&](BatchRange some) {
            if (some.end - some.begin == 1) {
                start_one(some.begin);
                return 0;
            }
            std::array<EightPairs, 2> pairs;
            for (std::uint32_t i = 0; i < 2; ++i)
                put_pairs<friction(), rolling()>(stage, some.begin + i, pairs[i]);
            sixteen::start_general(coloured, some.begin, stage.made, pairs.data());
            return 0;
        });
    });
}

}  // namespace tesserae
