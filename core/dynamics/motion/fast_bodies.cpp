// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/fast_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/dynamics/motion/free_path.hpp"
#include "core/dynamics/motion/motion.hpp"

namespace tesserae {
namespace {

/// Bodies and pairs of a range at least. An impact's time takes some 10 us.
constexpr std::size_t kFastGrain = 1024, kImpactGrain = 16;

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
    find_candidates(simulation, step, schedule);
    list_impacts();
    if (fast_bodies_.empty()) return;
    stop_.assign(simulation.bodies.size(), kNoImpact);
    stopped_.clear();
    take_impacts(simulation, step);

    for (const BodyId id : stopped_) {
        const FreePath::State state = FreePath(simulation, step, id).at(stop_[id]);
        step.position[id] = state.position;
        const Vec4 gravity = simulation.type_of(id).gravity_scale * simulation.settings.gravity;
        if (!gravity.isZero(0))
            step.velocity[id] *=
                kept_speed(gravity, step.h, step.velocity[id], stop_[id] / (0.5 * step.h), half);
        if (!simulation.needs.turning) continue;
        step.rotor[id] = state.rotor;
        step.angular_velocity[id] = state.angular_velocity;
        if (half == Half::kFirst) set_inverse_inertia(simulation, step, id);
    }
}

void FastBodies::find_candidates(const Simulation& simulation, const StepData& step,
                                 Schedule& schedule) {
    const auto for_each_range = [&](std::size_t count, std::size_t grain, const auto& work) {
        schedule.for_each_range(count, grain, work);
    };
    is_fast_.resize(simulation.bodies.size());
    stop_.clear();
    schedule.for_each_range(is_fast_.size(), kFastGrain, [&](Range bodies) {
        for (std::size_t i = bodies.begin; i < bodies.end; ++i)
            is_fast_[i] = is_fast(simulation, step, static_cast<BodyId>(i));
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
    const std::size_t ranges = candidates_.size() / kImpactGrain + 1;
    if (scratch_.size() < ranges) scratch_.resize(ranges);
    schedule.for_each_range(candidates_.size(), kImpactGrain, [&](Range range) {
        std::vector<Contact>& scratch = scratch_[range.begin / kImpactGrain];
        for (std::size_t i = range.begin; i < range.end; ++i)
            candidates_[i].time = look_at(simulation, step, candidates_[i], 0, scratch);
    });
}

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

double FastBodies::look_at(const Simulation& simulation, const StepData& step,
                           const Candidate& candidate, double from,
                           std::vector<Contact>& scratch) const {
    FreePath a(simulation, step, candidate.a), b(simulation, step, candidate.b);
    if (!stop_.empty()) a.stop(stop_[candidate.a]), b.stop(stop_[candidate.b]);
    return impact_time(a, b, from, scratch);
}

void FastBodies::list_impacts() {
    fast_bodies_.clear();
    for (std::uint32_t i = 0; i < candidates_.size(); ++i)
        if (candidates_[i].time != kNoImpact) fast_bodies_.push_back({candidates_[i].time, i});
    if (fast_bodies_.empty()) return;
    met_.clear();
    for (std::uint32_t i = 0; i < candidates_.size(); ++i) {
        met_.push_back({candidates_[i].a, i});
        met_.push_back({candidates_[i].b, i});
    }
    std::sort(met_.begin(), met_.end());
}

void FastBodies::take_impacts(const Simulation& simulation, const StepData& step) {
    const auto later = [](const Impact& i, const Impact& j) {
        return std::tie(i.time, i.candidate) > std::tie(j.time, j.candidate);
    };
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
        for (std::size_t i = first; i < stopped_.size(); ++i) {
            const BodyId id = stopped_[i];
            auto met = std::lower_bound(met_.begin(), met_.end(), std::pair(id, std::uint32_t{0}));
            for (; met != met_.end() && met->first == id; ++met) {
                if (met->second == impact.candidate) continue;
                Candidate& other = candidates_[met->second];
                other.time = look_at(simulation, step, other, impact.time, scratch_[0]);
                if (other.time == kNoImpact) continue;
                fast_bodies_.push_back({other.time, met->second});
                std::push_heap(fast_bodies_.begin(), fast_bodies_.end(), later);
            }
        }
    }
}

}  // namespace tesserae
