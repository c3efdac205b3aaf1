// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/fast_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "core/dynamics/motion/motion.hpp"

namespace tesserae {
namespace {

/// Bodies and pairs of a range at least. An impact's time takes some 10 us.
constexpr std::size_t kFastGrain = 1024, kImpactGrain = 16;

/// Gaps that a half may find before searches end early, in all and of each body, and as many again
/// where bodies have been stopped before all are. Usual 4000 and 8: some ten steps of a heap.
/// Fewer: more bodies lose a part of a sub-step. More: a step takes longer in which all bodies of a
/// heap are fast.
constexpr std::size_t kGapsOfAll = 4000, kGapsOfBody = 8;

/// Pairs that are looked at again, for each of these gaps. Usual 32: that costs about as much.
constexpr std::size_t kLooksOfGap = 32;

/// The place of a body that no candidate has.
constexpr std::uint32_t kUnlisted = std::numeric_limits<std::uint32_t>::max();

/// Its motion may end; what is driven and what sleeps goes on as it does.
bool can_stop(const Simulation& simulation, const StepData& step, BodyId id) {
    return simulation.type_of(id).movable && !is_driven(simulation, id) && !is_asleep(step, id);
}

/// The part of its speed with which a body that is stopped in a half has, at the sub-step's end,
/// the energy that it would have had there: gravity acts in the middle, on both halves' ways.
/// @param part   of the half that is over when it stops
double kept_speed(const Vec4& gravity, double h, const Vec4& v, double part,
                  FastBodies::Half half) {
    const double squared = v.squaredNorm();
    if (squared == 0) return 1;
    const double fall = h * gravity.dot(v) / squared;
    if (half == FastBodies::Half::kSecond) return std::sqrt(std::max(0.0, 1 - (1 - part) * fall));
    // k^2 + fall k = 1 + fall part. What rises more slowly than gravity acts loses a little.
    if (fall < -1) return 1;
    return std::sqrt(0.25 * fall * fall + 1 + fall * part) - 0.5 * fall;
}

}  // namespace

void FastBodies::stop(const Simulation& simulation, StepData& step, Schedule& schedule, Half half) {
    find_stops(simulation, step, schedule, {}, 0.5 * step.h);
    for (const BodyId id : stopped_) {
        put_back(simulation, step, id);
        const Vec4 gravity = simulation.type_of(id).gravity_scale * simulation.settings.gravity;
        if (!gravity.isZero(0))
            step.velocity[id] *=
                kept_speed(gravity, step.h, step.velocity[id], stop_[id] / (0.5 * step.h), half);
        if (half == Half::kFirst && simulation.needs.turning)
            set_inverse_inertia(simulation, step, id);
    }
}

void FastBodies::stop(const Simulation& simulation, StepData& step, Schedule& schedule,
                      std::span<const double> moved) {
    find_stops(simulation, step, schedule, moved, *std::max_element(moved.begin(), moved.end()));
    for (const BodyId id : stopped_) put_back(simulation, step, id);
}

/// Writes stopped_ and stop_.
void FastBodies::find_stops(const Simulation& simulation, StepData& step, Schedule& schedule,
                            std::span<const double> moved, double duration) {
    moved_ = moved, duration_ = duration;
    stopped_.clear();
    find_candidates(simulation, step, schedule);
    find_paths(simulation, step, schedule);
    find_impacts(schedule);
    list_impacts();
    if (fast_bodies_.empty()) return;
    stop_.assign(simulation.bodies.size(), kNoImpact);
    take_impacts(simulation, step, schedule);
}

void FastBodies::put_back(const Simulation& simulation, StepData& step, BodyId id) {
    const FreePath::State state = place_[id] == kUnlisted
                                      ? new_path(simulation, step, id).at(stop_[id])
                                      : path_of(id).at(stop_[id]);
    step.position[id] = state.position;
    if (!simulation.needs.turning) return;
    step.rotor[id] = state.rotor;
    step.angular_velocity[id] = state.angular_velocity;
}

FreePath FastBodies::new_path(const Simulation& simulation, const StepData& step, BodyId id) const {
    return {simulation, step, id, moved_.empty() ? duration_ : moved_[id], duration_};
}

std::size_t FastBodies::gaps() const {
    std::size_t sum = 0;
    for (const ImpactSearch& search : searches_) sum += search.gaps;
    return sum;
}

void FastBodies::find_candidates(const Simulation& simulation, const StepData& step,
                                 Schedule& schedule) {
    const auto for_each_range = [&](std::size_t count, std::size_t grain, const auto& work) {
        schedule.for_each_range(count, grain, work);
    };
    is_fast_.resize(simulation.bodies.size());
    schedule.for_each_range(is_fast_.size(), kFastGrain, [&](Range bodies) {
        for (std::size_t i = bodies.begin; i < bodies.end; ++i)
            is_fast_[i] =
                moved_.empty() ? is_fast(simulation, step, static_cast<BodyId>(i)) : moved_[i] > 0;
    });
    lists_.collect(
        for_each_range, step.pairs.size(), kFastGrain,
        [&](Range pairs, std::vector<Candidate>& list) {
            for (std::size_t i = pairs.begin; i < pairs.end; ++i) {
                const auto [a, b] = step.pairs[i];
                if (is_fast_[a] || is_fast_[b]) list.push_back({a, b, kNoImpact});
            }
        },
        candidates_);
}

/// A body's path is the same for all that it may meet.
void FastBodies::find_paths(const Simulation& simulation, const StepData& step,
                            Schedule& schedule) {
    place_.assign(simulation.bodies.size(), kUnlisted);
    for (const Candidate& candidate : candidates_) place_[candidate.a] = place_[candidate.b] = 0;
    listed_.clear();
    for (BodyId id = 0; id < place_.size(); ++id) {
        if (place_[id] == kUnlisted) continue;
        place_[id] = static_cast<std::uint32_t>(listed_.size());
        listed_.push_back(id);
    }
    paths_.resize(listed_.size());
    schedule.for_each_range(listed_.size(), kImpactGrain, [&](Range range) {
        for (std::size_t i = range.begin; i < range.end; ++i)
            paths_[i].emplace(new_path(simulation, step, listed_[i]));
    });
}

void FastBodies::find_impacts(Schedule& schedule) {
    const std::size_t ranges = candidates_.size() / kImpactGrain + 1;
    if (searches_.size() < ranges) searches_.resize(ranges);
    for (ImpactSearch& search : searches_) search = {std::move(search.contacts), 0, 0};
    const auto for_each = [&](const auto& work) {
        schedule.for_each_range(candidates_.size(), kImpactGrain, [&](Range range) {
            for (std::size_t i = range.begin; i < range.end; ++i)
                work(candidates_[i], searches_[range.begin / kImpactGrain]);
        });
    };
    for_each([&](Candidate& candidate, ImpactSearch& search) {
        candidate.time = impact_time(path_of(candidate.a), path_of(candidate.b), 0, search);
    });
    const auto open = static_cast<std::size_t>(
        std::count_if(candidates_.begin(), candidates_.end(),
                      [](const Candidate& candidate) { return candidate.time != kNoImpact; }));
    if (open == 0) return;
    // Most searches take less than a fourth of what they may.
    const std::size_t most =
        4 * open > most_gaps() ? 0 : std::min(most_gaps() / open, kMostAdvances);
    for_each([&](Candidate& candidate, ImpactSearch& search) {
        if (candidate.time == kNoImpact) return;
        search.most = most;
        candidate.time = impact_time(path_of(candidate.a), path_of(candidate.b), 0, search);
    });
}

std::size_t FastBodies::most_gaps() const { return kGapsOfAll + kGapsOfBody * is_fast_.size(); }

/// With all that joints connect with it: else its joints would be torn apart.
void FastBodies::stop_at(const Simulation& simulation, const StepData& step, BodyId id,
                         double time) {
    const auto stop = [&](BodyId one) {
        if (stop_[one] != kNoImpact || !can_stop(simulation, step, one)) return;
        stop_[one] = time;
        stopped_.push_back(one);
    };
    stop(id);
    if (!simulation.type_of(id).movable) return;
    for (const BodyId other : simulation.joints.connected_with(id)) stop(other);
}

/// What is known to pass through nothing until a time stops there.
void FastBodies::stop_all(const Simulation& simulation, const StepData& step, double time) {
    for (const BodyId id : listed_) stop_at(simulation, step, id, time);
}

void FastBodies::list_impacts() {
    fast_bodies_.clear();
    for (std::uint32_t i = 0; i < candidates_.size(); ++i)
        if (candidates_[i].time != kNoImpact) fast_bodies_.push_back({candidates_[i].time, i});
    if (fast_bodies_.empty()) return;
    first_met_.assign(listed_.size() + 2, 0);
    const auto for_each_met = [&](const auto& visit) {
        for (std::uint32_t i = 0; i < candidates_.size(); ++i) {
            visit(place_[candidates_[i].a], i);
            visit(place_[candidates_[i].b], i);
        }
    };
    for_each_met([&](std::uint32_t place, std::uint32_t) { ++first_met_[place + 2]; });
    std::partial_sum(first_met_.begin(), first_met_.end(), first_met_.begin());
    met_.resize(2 * candidates_.size());
    for_each_met([&](std::uint32_t place, std::uint32_t i) { met_[first_met_[place + 1]++] = i; });
}

void FastBodies::take_impacts(const Simulation& simulation, const StepData& step,
                              const Schedule& schedule) {
    const auto later = [](const Impact& i, const Impact& j) {
        return std::tie(i.time, i.candidate) > std::tie(j.time, j.candidate);
    };
    ImpactSearch& search = searches_[0];
    std::size_t looks = kLooksOfGap * most_gaps();
    const std::size_t most = search.gaps + most_gaps();
    std::make_heap(fast_bodies_.begin(), fast_bodies_.end(), later);
    while (!fast_bodies_.empty()) {
        std::pop_heap(fast_bodies_.begin(), fast_bodies_.end(), later);
        const Impact impact = fast_bodies_.back();
        fast_bodies_.pop_back();
        Candidate& candidate = candidates_[impact.candidate];
        if (candidate.time != impact.time) continue;  // looked at again since
        candidate.time = kNoImpact;
        const std::size_t first = stopped_.size();
        for (const BodyId id : {candidate.a, candidate.b})
            stop_at(simulation, step, id, impact.time);
        if (looks == 0 || search.gaps >= most) return stop_all(simulation, step, impact.time);
        for (std::size_t i = first; i < stopped_.size(); ++i)
            if (place_[stopped_[i]] != kUnlisted) path_of(stopped_[i]).stop(impact.time);
        for (std::size_t i = first; i < stopped_.size(); ++i) {
            const std::uint32_t place = place_[stopped_[i]];
            if (place == kUnlisted) continue;
            schedule.look_for_stop();
            for (std::uint32_t met = first_met_[place]; met < first_met_[place + 1]; ++met) {
                if (met_[met] == impact.candidate) continue;
                looks -= looks > 0 ? 1 : 0;
                Candidate& other = candidates_[met_[met]];
                search.most = std::min(kMostAdvances, most - std::min(most, search.gaps));
                other.time = impact_time(path_of(other.a), path_of(other.b), impact.time, search);
                if (other.time == kNoImpact) continue;
                fast_bodies_.push_back({other.time, met_[met]});
                std::push_heap(fast_bodies_.begin(), fast_bodies_.end(), later);
            }
        }
    }
}

}  // namespace tesserae
