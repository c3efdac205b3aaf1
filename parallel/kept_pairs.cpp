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

/// Pairs of bodies that moved are searched alone if these are at most one of so many.
constexpr std::size_t kFew = 2;

/// Bodies with more candidates each than this are crowded: most of the memory is that of contacts.
constexpr std::size_t kCrowded = 2;

}  // namespace

void KeptPairs::refresh(const Simulation& simulation, StepData& step, const Ranges& ranges) {
    const std::size_t moved = held_ ? list_moved(step, ranges) : 0;
    lasted_ = std::min(lasted_ + 1, kRare);
    if (!held_ || moved > 0) {
        const bool few = held_ && kFew * moved <= large_.size();
        if (!few || !search_for_some(simulation, step, ranges)) search(simulation, step, ranges);
        lasted_ = 0;
    }
    choose_pairs(simulation, step, ranges);
}

void KeptPairs::choose_pairs(const Simulation& simulation, StepData& step, const Ranges& ranges) {
    lists_.collect(
        ranges, candidates_.size(), kCandidateGrain,
        [&](Range range, std::vector<BodyPair>& list) {
            candidates_.for_each(range, [&](BodyId a, BodyId b) {
                if (is_pair(simulation, step, a, b)) list.push_back({a, b});
            });
        },
        step.pairs);
}

/// @return how many bodies have left their larger balls
std::size_t KeptPairs::list_moved(const StepData& step, const Ranges& ranges) {
    moved_.resize(large_.size());
    ranges.for_each(large_.size(), kBallGrain, [&](Range range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const Bounds &now = step.bounds[i], &large = large_[i];
            moved_[i] = !((now.centre - large.centre).norm() + now.radius <= large.radius);
        }
    });
    return static_cast<std::size_t>(std::count(moved_.begin(), moved_.end(), 1));
}

void KeptPairs::enlarge(const Simulation& simulation, const StepData& step, std::size_t body) {
    const TypeProperties& type = simulation.type_of(static_cast<BodyId>(body));
    large_[body] = step.bounds[body];
    if (!type.bounded) return;
    const double way = kSteps * step.dt * step.velocity[body].norm();
    large_[body].radius += std::min(kPart * type.radius + way, type.radius);
}

bool KeptPairs::search_for_some(const Simulation& simulation, const StepData& step,
                                const Ranges& ranges) {
    held_ = false;  // so it stays if the search is stopped or fails for want of memory
    for (std::size_t i = 0; i < large_.size(); ++i)
        if (moved_[i]) enlarge(simulation, step, i);
    if (!sort_and_sweep_.replace_pairs_of(moved_, simulation, large_, candidates_, ranges))
        return false;
    held_ = true;
    ++searches_for_some_;
    return true;
}

void KeptPairs::search(const Simulation& simulation, StepData& step, const Ranges& ranges) {
    held_ = false;
    // Where bodies are crowded and searches are rare these share memory with the rows.
    const auto shares = [&] {
        return lasted_ == kRare && candidates_.size() > kCrowded * large_.size();
    };
    if (shares() && !step.rows_in_use) release_rows(step);
    large_.resize(step.bounds.size());
    ranges.for_each(large_.size(), kBallGrain, [&](Range range) {
        for (std::size_t i = range.begin; i < range.end; ++i) enlarge(simulation, step, i);
    });
    sort_and_sweep_.overlapping_pairs(simulation, large_, candidates_, ranges);
    if (shares()) sort_and_sweep_.release();
    held_ = true;
    ++searches_;
}

}  // namespace tesserae::parallel
