// SPDX-License-Identifier: Apache-2.0
#include "parallel/kept_pairs.hpp"

#include <algorithm>

#include "core/dynamics/contacts/pairs.hpp"

namespace tesserae::parallel {
namespace {

/// Bodies and candidates of one task: some 10 us of work.
constexpr std::size_t kBallGrain = 512, kCandidateGrain = 2048;

/// A ball is larger than the body's bounds by this part of the body's radius, and by the way that
/// it goes in so many steps, but by no more than its radius. More, and a search and each step look
/// at more candidates, by the fourth power of the ball; less, and searches come more often. With
/// these a search lasts 5 steps where a pile of 10^5 spheres falls together, 20 while it settles
/// and for ever once it rests.
constexpr double kPart = 0.1, kSteps = 16;

/// Bodies with more candidates each than this are crowded: most of the memory is that of contacts.
constexpr std::size_t kCrowded = 2;

}  // namespace

void KeptPairs::refresh(const Simulation& simulation, StepData& step) {
    if (!holds(step)) {
        // Where bodies are crowded searches are rare, and share memory with the rows.
        const auto crowded = [&] { return candidates_.size() > kCrowded * large_.size(); };
        if (crowded() && !step.rows_in_use) release_rows(step);
        search(simulation, step);
        if (crowded()) sort_and_sweep_.release();
    }
    choose_pairs(simulation, step);
}

void KeptPairs::choose_pairs(const Simulation& simulation, StepData& step) {
    lists_.collect(
        kInRanges, candidates_.size(), kCandidateGrain,
        [&](Range range, std::vector<BodyPair>& list) {
            candidates_.for_each(range, [&](BodyId a, BodyId b) {
                if (is_pair(simulation, step, a, b)) list.push_back({a, b});
            });
        },
        step.pairs);
}

bool KeptPairs::holds(const StepData& step) const {
    return held_ && !any_range(large_.size(), kBallGrain, [&](Range range) {
               for (std::size_t i = range.begin; i < range.end; ++i) {
                   const Bounds &now = step.bounds[i], &large = large_[i];
                   if (!((now.centre - large.centre).norm() + now.radius <= large.radius))
                       return true;
               }
               return false;
           });
}

void KeptPairs::search(const Simulation& simulation, const StepData& step) {
    held_ = false;  // so it stays if the search fails for want of memory
    large_.resize(step.bounds.size());
    for_each_range(large_.size(), kBallGrain, [&](Range range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const TypeProperties& type = simulation.type_of(static_cast<BodyId>(i));
            large_[i] = step.bounds[i];
            if (!type.bounded) continue;
            const double way = kSteps * step.dt * step.velocity[i].norm();
            large_[i].radius += std::min(kPart * type.radius + way, type.radius);
        }
    });
    sort_and_sweep_.overlapping_pairs(simulation, large_, candidates_);
    held_ = true;
    ++searches_;
}

}  // namespace tesserae::parallel
