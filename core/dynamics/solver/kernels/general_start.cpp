// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/kernels/general_start.hpp"

#include "core/dynamics/solver/kernels/general_sweep.hpp"
#include "core/dynamics/solver/kernels/points.hpp"
#include "core/dynamics/solver/kernels/sixteen.hpp"

namespace tesserae {
namespace {

using namespace lanes;

/// The contacts of a batch's pairs of some islands, and what is put into its rows at once.
template <bool kFriction, bool kRolling>
void put_pairs(const ColouredStage& stage, std::uint32_t index, Members some, EightPairs& pairs) {
    ColouredIslands& coloured = stage.step.coloured;
    const Batch& batch = coloured.general[index];
    prefetch(stage, coloured.general, index);
    const bool whole = some.has_all(batch.members);
    if (!is_full(batch)) pairs = {};
    if (kFriction && whole) coloured.pair_friction[index].friction = {};
    if (kRolling && whole) {
        coloured.pair_rolling[index].arm = {};
        std::fill_n(&coloured.general_rolling[batch.row], batch.rows, GeneralRolling{});
    }
    for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k) {
        const std::uint8_t member = batch.member[k];
        if (!some.has(member)) continue;
        put_pair(stage, member, batch.contact[k], batch.points[k], k, pairs);
        const Contact& c = stage.step.contacts[batch.contact[k]];
        if constexpr (kFriction)
            coloured.pair_friction[index].friction.lane[k] = float_friction(stage, c);
        if constexpr (kRolling) {
            coloured.pair_rolling[index].arm.lane[k] = float_rolling_arm(stage, c);
            for (std::uint32_t p = 0; p < batch.points[k]; ++p)
                put_angular_impulse(stage, member, batch.contact[k] + p, k,
                                    coloured.general_rolling[batch.row + p].impulse);
        }
    }
}

}  // namespace

void start_general(const ColouredStage& stage, BatchRange batches, LaneCount lanes, Members some) {
    ColouredIslands& coloured = stage.step.coloured;
    with_kind_of_general(coloured, Pass::kSolve, [&](auto friction, auto rolling, auto uneven) {
        const auto start_one = [&](std::uint32_t i) {
            EightPairs pairs;
            put_pairs<friction(), rolling()>(stage, i, some, pairs);
            for_lanes_of(coloured.general[i], some, lanes, [&](const auto& lane) {
                start_pairs<friction(), rolling(), uneven()>(coloured, lane, i, stage.made, pairs);
            });
        };
        const auto is_whole = [&](std::uint32_t i) {
            return some.has_all(coloured.general[i].members);
        };
        sweep_batches(coloured.general, batches, Sweep{}, lanes, some, [&](BatchRange at_once) {
            if (at_once.end - at_once.begin == 1 || !is_whole(at_once.begin) ||
                !is_whole(at_once.begin + 1)) {
                for (std::uint32_t i = at_once.begin; i < at_once.end; ++i) start_one(i);
                return 0;
            }
            std::array<EightPairs, 2> pairs;
            for (std::uint32_t i = 0; i < 2; ++i)
                put_pairs<friction(), rolling()>(stage, at_once.begin + i, some, pairs[i]);
            sixteen::start_general(coloured, at_once.begin, stage.made, pairs.data());
            return 0;
        });
    });
}

}  // namespace tesserae
