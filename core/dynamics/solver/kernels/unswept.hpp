// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/dynamics/solver/kernels/kernels.hpp"
#include "core/dynamics/solver/kernels/lanes.hpp"

namespace tesserae {

/// What a sweep over one or two batches changes of the islands that it should leave as they are.
/// Kernels work on all lanes; those of islands that are solved already get back what they had.
template <std::size_t kTangents>
class UnsweptLanes {
  public:
    /// @param batches   one or two of `all`
    /// @param some      the islands that are swept
    UnsweptLanes(ColouredIslands& coloured, const std::vector<Batch>& all,
                 RowImpulses<kTangents>& impulses, BatchRange batches, Members some)
        : coloured_(coloured), all_(all), impulses_(impulses), batches_(batches), swept_(some) {
        for_each_left_out([&](const Batch& batch, Kept& kept) {
            for (std::uint32_t i = 0; i < batch.rows; ++i) {
                kept.normal[i] = impulses_.normal[batch.row + i];
                if (!impulses_.tangent.empty()) kept.tangent[i] = impulses_.tangent[batch.row + i];
            }
            for_lanes_left_out(batch, [&](std::size_t k) {
                kept.a[k] = coloured_.changes[batch.a[k]];
                kept.b[k] = coloured_.changes[batch.b[k]];
            });
        });
    }
    /// Call it after the sweep.
    void put_back() {
        for_each_left_out([&](const Batch& batch, const Kept& kept) {
            const Float8 swept = kAll.load(lanes_of(batch, swept_));
            const auto blend = [&](const Eight& before, Eight& now) {
                kAll.store(swept > Float8{} ? kAll.load(now) : kAll.load(before), now);
            };
            for (std::uint32_t i = 0; i < batch.rows; ++i) {
                blend(kept.normal[i], impulses_.normal[batch.row + i]);
                if (impulses_.tangent.empty()) continue;
                for (std::size_t j = 0; j < kTangents; ++j)
                    blend(kept.tangent[i][j], impulses_.tangent[batch.row + i][j]);
            }
            for_lanes_left_out(batch, [&](std::size_t k) {
                if (batch.a[k] != 0) coloured_.changes[batch.a[k]] = kept.a[k];
                if (batch.b[k] != 0) coloured_.changes[batch.b[k]] = kept.b[k];
            });
        });
    }

  private:
    using Float8 = lanes::Float8;
    static constexpr lanes::Lane<Float8> kAll{};
    struct Kept {
        std::array<Eight, kManifoldPoints> normal;
        std::array<std::array<Eight, kTangents>, kManifoldPoints> tangent;
        std::array<BodyChange, kLanes> a, b;
    };

    template <class Visit>
    void for_each_left_out(const Visit& visit) {
        for (std::uint32_t i = batches_.begin; i < batches_.end; ++i)
            if (!swept_.has_all(all_[i].members)) visit(all_[i], storage_.kept[i - batches_.begin]);
    }
    template <class Visit>
    void for_lanes_left_out(const Batch& batch, const Visit& visit) const {
        for (std::size_t k = 0; k < kLanes && batch.points[k] > 0; ++k)
            if (!swept_.has(batch.member[k])) visit(k);
    }

    ColouredIslands& coloured_;
    const std::vector<Batch>& all_;
    RowImpulses<kTangents>& impulses_;
    BatchRange batches_;
    Members swept_;
    /// Not initialized.
    union Storage {
        Storage() {}  // NOLINT: leaves it so
        std::array<Kept, 2> kept;
    };
    Storage storage_;
};

/// Sweeps some islands of one or two batches by sweep(), which works on all lanes.
/// @return the result of sweep()
template <std::size_t kTangents, class SweepAll>
double sweep_some(ColouredIslands& coloured, const std::vector<Batch>& all,
                  RowImpulses<kTangents>& impulses, BatchRange batches, Members some,
                  const SweepAll& sweep) {
    if (some.has_all(all[batches.begin].members | all[batches.end - 1].members)) return sweep();
    UnsweptLanes unswept(coloured, all, impulses, batches, some);
    const double result = sweep();
    unswept.put_back();
    return result;
}

}  // namespace tesserae
