// SPDX-License-Identifier: Apache-2.0
// Time of the narrow phase for every pair of shapes, by Google Benchmark, over 10^5 random pairs
// each, and of Bullet's functions for the same pairs in 3D. See README.md.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "bench/bullet_pairs.hpp"
#include "bench/contact_pairs.hpp"
#include "bench/thread_time.hpp"

namespace tesserae::bench {
namespace {

using benchmark::State;

constexpr std::size_t kPairs = 100000;
/// Pairs are copied this many at a time, untimed, so that what is timed begins with its input in
/// the second-level cache and does not read memory.
constexpr std::size_t kBatch = 500;
/// Rounds of single calls of which each pair's least counts, so that interruptions don't.
constexpr int kRounds = 3;

template <class Pairs>
using PairList = std::vector<typename Pairs::Pair>;

enum class Set { kTouching, kApart, kResting };

template <class Pairs>
PairList<Pairs> draw_pairs(Pairs& pairs, Set set) {
    Random random(6);
    PairList<Pairs> list;
    list.reserve(kPairs);
    while (list.size() < kPairs) {
        const auto pair =
            set == Set::kResting ? pairs.resting_pair(random) : pairs.random_pair(random);
        pairs.find(pair);
        if (pairs.touching() == (set != Set::kApart)) list.push_back(pair);
    }
    return list;
}

/// Calls visit(first, batch) for all batches of the list.
template <class List, class Visit>
void for_each_batch(const List& list, Visit&& visit) {
    for (std::size_t first = 0; first < list.size(); first += kBatch) {
        const auto begin = list.begin() + static_cast<std::ptrdiff_t>(first);
        const List batch(begin, begin + static_cast<std::ptrdiff_t>(kBatch));
        visit(first, batch);
    }
}

/// Median of what two readings of a clock in a row differ by: to be subtracted.
template <class Clock>
double cost_of(Clock&& clock) {
    std::vector<double> cost(10001);
    for (double& c : cost) {
        const double begin = clock();
        c = clock() - begin;
    }
    const auto middle = cost.begin() + 5000;
    std::nth_element(cost.begin(), middle, cost.end());
    return *middle;
}

/// Processor time of a call, the mean over the pairs.
template <class Pairs>
void mean_call(State& state, Pairs& pairs, const PairList<Pairs>& list) {
    const double cost = cost_of(thread_time);
    double calls = 0, time = 0, points = 0;
    for (auto _ : state) {
        double round = 0;
        for_each_batch(list, [&](std::size_t, const PairList<Pairs>& batch) {
            const double begin = thread_time();
            for (const auto& pair : batch) {
                pairs.find(pair);
                points += static_cast<double>(pairs.points());
            }
            round += thread_time() - begin - cost;
        });
        state.SetIterationTime(round);
        time += round;
        calls += static_cast<double>(list.size());
    }
    state.counters["ns_per_pair"] = 1e9 * time / calls;
    state.counters["points_per_pair"] = points / calls;
}

/// Wall time of single calls: how it is distributed over the pairs.
template <class Pairs>
void single_calls(State& state, Pairs& pairs, const PairList<Pairs>& list) {
    const auto wall_time = [] {
        using Nanoseconds = std::chrono::duration<double, std::nano>;
        return Nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
    };
    const double cost = cost_of(wall_time);
    std::vector<double> least(list.size(), 1e9);
    for (auto _ : state) {
        for_each_batch(list, [&](std::size_t first, const PairList<Pairs>& batch) {
            for (std::size_t i = 0; i < batch.size(); ++i) {
                const double begin = wall_time();
                pairs.find(batch[i]);
                const double time = wall_time() - begin - cost;
                least[first + i] = std::min(least[first + i], time);
            }
        });
        state.SetIterationTime(1);
    }
    std::sort(least.begin(), least.end());
    const auto quantile = [&](std::size_t percent) { return least[kPairs * percent / 100]; };
    state.counters["median_ns"] = quantile(50);
    state.counters["p90_ns"] = quantile(90);
    state.counters["p99_ns"] = quantile(99);
}

/// The pairs are drawn when first needed and kept.
template <class Pairs>
void add_benchmarks(const std::string& name, std::shared_ptr<Pairs> pairs, bool are_boxes) {
    std::vector<std::pair<std::string, Set>> sets{{"touching", Set::kTouching},
                                                  {"apart", Set::kApart}};
    if (are_boxes) sets.push_back({"resting", Set::kResting});
    for (const auto& [set_name, set] : sets) {
        auto list = std::make_shared<PairList<Pairs>>();
        const auto drawn = [pairs, list, which = set]() -> const PairList<Pairs>& {
            if (list->empty()) *list = draw_pairs(*pairs, which);
            return *list;
        };
        const std::string full_name = name + "/" + set_name;
        benchmark::RegisterBenchmark(full_name.c_str(),
                                     [=](State& state) { mean_call(state, *pairs, drawn()); })
            ->UseManualTime()
            ->Iterations(2);
        if (!are_boxes) continue;
        benchmark::RegisterBenchmark((full_name + "/single_calls").c_str(),
                                     [=](State& state) { single_calls(state, *pairs, drawn()); })
            ->UseManualTime()
            ->Iterations(kRounds);
    }
}

void add_all() {
    const std::vector<std::pair<std::string, Shape>> shapes{{"sphere", Hypersphere{}},
                                                            {"capsule", Hypercapsule{}},
                                                            {"box", Hyperbox{}},
                                                            {"plane", Hyperplane{}}};
    for (std::size_t i = 0; i < shapes.size(); ++i)
        for (std::size_t j = i; j < shapes.size(); ++j) {
            const auto& [name_a, a] = shapes[i];
            const auto& [name_b, b] = shapes[j];
            if (!is_bounded(a)) continue;
            const std::string name = name_a + "_" + name_b;
            add_benchmarks(name, std::make_shared<PairsIn4D>(a, b), name == "box_box");
        }
    const std::string bullet =
        sizeof(btScalar) == sizeof(double) ? "bullet_double/" : "bullet_float/";
    add_benchmarks(bullet + "sphere_sphere", std::make_shared<PairsInBullet<btSphereShape>>(),
                   false);
    add_benchmarks(bullet + "capsule_capsule", std::make_shared<PairsInBullet<btCapsuleShape>>(),
                   false);
    add_benchmarks(bullet + "box_box", std::make_shared<PairsInBullet<btBoxShape>>(), true);
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    tesserae::bench::add_all();
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
