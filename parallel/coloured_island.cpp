// SPDX-License-Identifier: Apache-2.0
#include "parallel/coloured_island.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

#include "core/dynamics/solver/coloured_rows.hpp"

namespace tesserae::parallel {
namespace {

/// Items of one task: some 5 us of work.
constexpr std::size_t kIslandBodyGrain = 512;
static_assert(kIslandBodyGrain % kSumPiece == 0);
constexpr std::size_t kPointGrain = 1024;

class AllThreads {
  public:
    explicit AllThreads(const Ranges& ranges) : ranges_(ranges) {}

    template <class Work>
    void for_bodies(Range bodies, const Work& work) const {
        ranges_.for_each(bodies.end - bodies.begin, kIslandBodyGrain, [&](Range piece) {
            work(Range{bodies.begin + piece.begin, bodies.begin + piece.end});
        });
    }
    template <class Work>
    void for_batches(BatchRange batches, std::size_t points, const Work& work) const {
        const std::uint32_t grain = grain_of(points);
        ranges_.for_each(batches.end - batches.begin, grain, [&](Range piece) {
            work(BatchRange{batches.begin + static_cast<std::uint32_t>(piece.begin),
                            batches.begin + static_cast<std::uint32_t>(piece.end)});
        });
    }
    template <class Work>
    double largest(BatchRange batches, std::size_t points, const Work& work) const {
        const std::uint32_t grain = grain_of(points);
        const std::uint32_t count = batches.end - batches.begin;
        const std::uint32_t chunks = (count + grain - 1) / grain;
        if (chunks <= 1 || is_alone()) {
            ranges_.look_for_stop();
            return OneThread{}.largest(batches, points, work);
        }
        return tbb::parallel_reduce(
            tbb::blocked_range<std::uint32_t>(0, chunks, 1), 0.0,
            [&](const tbb::blocked_range<std::uint32_t>& range, double largest) {
                ranges_.look_for_stop();
                const BatchRange piece{batches.begin + range.begin() * grain,
                                       batches.begin + std::min(count, range.end() * grain)};
                return std::max(largest, work(piece));
            },
            [](double a, double b) { return std::max(a, b); });
    }

  private:
    static std::uint32_t grain_of(std::size_t points) {
        return static_cast<std::uint32_t>(kPointGrain / kLanes / points);
    }

    const Ranges& ranges_;
};

}  // namespace

void solve_coloured_impact(const Simulation& simulation, StepData& step, std::size_t island,
                           const Ranges& ranges) {
    tesserae::solve_coloured_impact(simulation, step, island, AllThreads(ranges));
}

void solve_coloured_island(const Simulation& simulation, StepData& step, std::size_t island,
                           const Ranges& ranges) {
    tesserae::solve_coloured_island(simulation, step, island, AllThreads(ranges));
}

void apply_coloured_correction(const Simulation& simulation, StepData& step, std::size_t island,
                               const Ranges& ranges) {
    tesserae::apply_coloured_correction(simulation, step, island, AllThreads(ranges));
}

}  // namespace tesserae::parallel
