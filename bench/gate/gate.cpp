// SPDX-License-Identifier: Apache-2.0
// The gate of the dynamics: CSV on standard output, progress on the other one. See README.md.
//   gate [--list] [--quick] [--scenes N] [--runs N] [--no-times] [--shake N] [--rows NAME...]

#include "bench/gate/gate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bench/thread_time.hpp"
#include "core/error.hpp"
#include "parallel/threads.hpp"

namespace tesserae::bench::gate {
namespace {

/// The longest first, so that both cores are busy to the end.
std::vector<Family> all_families() {
    std::vector<Family> all;
    for (const auto& some : {rest_families(), ride_families(), rim_families(), thin_heap_families(),
                             tower_families(), jam_families(), extreme_families(), found_families(),
                             plate_families(), impact_families(), property_families()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

struct Options {
    bool list = false, quick = false, times = true;
    int scenes = std::numeric_limits<int>::max();  ///< of a family, at most
    int runs = std::numeric_limits<int>::max();    ///< of a scene, at most
    std::uint64_t shake = 0;  ///< other numbers shake the same scenes otherwise
    std::vector<std::string> names;

    bool asks_for(const std::string& name) const {
        return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
    }
};

void print(const std::vector<Row>& rows) {
    constexpr const char* kBetter[] = {"less", "more", "equal"};
    for (const Row& row : rows)
        fmt::print("\"{}\",\"{}\",{},{:.4g},{:.3g},{},{}\n", row.family, row.quantity, row.unit,
                   row.value, row.spread, row.samples, kBetter[static_cast<int>(row.better)]);
    std::fflush(stdout);
}

/// All runs of all scenes of some families, on all cores.
class Runs {
  public:
    Runs(std::vector<Family> families, const Options& options)
        : families_(std::move(families)), values_(families_.size()), spent_(families_.size()) {
        for (std::size_t f = 0; f < families_.size(); ++f) {
            const Family& family = families_[f];
            const int scenes =
                std::min(options.quick ? family.quick_scenes : family.scenes, options.scenes);
            const int runs = std::min(family.runs, options.runs);
            values_[f].resize(static_cast<std::size_t>(scenes));
            for (int scene = 0; scene < scenes; ++scene) {
                values_[f][static_cast<std::size_t>(scene)].resize(static_cast<std::size_t>(runs));
                for (int run = 0; run < runs; ++run) {
                    const auto number = static_cast<std::uint64_t>(run);
                    todo_.push_back({f, {scene, 1000 * options.shake + number}, number});
                }
            }
        }
    }

    void make(int threads) {
        std::vector<std::thread> workers;
        for (int i = 0; i < threads; ++i)
            workers.emplace_back([this] {
                for (std::size_t next; (next = next_++) < todo_.size();) make(todo_[next]);
            });
        for (std::thread& worker : workers) worker.join();
    }

    std::vector<Row> rows() const {
        std::vector<Row> rows;
        for (std::size_t f = 0; f < families_.size(); ++f)
            for (Row& row : rows_of(with_quantities(families_[f]), values_[f]))
                rows.push_back(std::move(row));
        Row left{"all", "left the finite range", "runs of " + std::to_string(todo_.size())};
        left.value = left_, left.samples = static_cast<int>(todo_.size());
        rows.push_back(left);
        return rows;
    }

  private:
    static constexpr std::size_t kMostQuantities = 16;
    struct Task {
        std::size_t family;
        Run run;
        std::size_t number;  ///< of the run
    };

    static Family with_quantities(Family family) {
        try {
            if (family.find_quantities) family.quantities = family.find_quantities();
        } catch (const RunError&) {
            family.quantities = {{"left the finite range", ""}};
        }
        return family;
    }

    void make(const Task& task) {
        const Family& family = families_[task.family];
        const double begin = thread_time();
        std::vector<double>& values =
            values_[task.family][static_cast<std::size_t>(task.run.scene)][task.number];
        try {
            values = family.measure(task.run);
        } catch (const RunError& error) {
            ++left_;
            values.assign(kMostQuantities, std::numeric_limits<double>::infinity());
            fmt::print(stderr, "{}, scene {}: {}\n", family.name, task.run.scene, error.what());
        }
        const std::lock_guard lock(mutex_);
        Spent& spent = spent_[task.family];
        spent.seconds += thread_time() - begin;
        if (++spent.runs == values_[task.family].size() * values_[task.family][0].size())
            fmt::print(stderr, "{}: {:.1f} s\n", family.name, spent.seconds);
    }

    /// Of a family, so far.
    struct Spent {
        std::size_t runs = 0;
        double seconds = 0;  ///< of processor time
    };

    std::vector<Family> families_;
    std::vector<std::vector<std::vector<std::vector<double>>>> values_;
    std::vector<Spent> spent_;
    std::mutex mutex_;  ///< of what is spent
    std::vector<Task> todo_;
    std::atomic<std::size_t> next_ = 0;
    std::atomic<int> left_ = 0;
};

void run(const Options& options) {
    std::vector<Family> families;
    for (Family& family : all_families())
        if (options.asks_for(family.name)) families.push_back(std::move(family));
    std::vector<std::string> timed;
    for (const std::string& name : timed_scenes())
        if (options.asks_for(name)) timed.push_back(name);
    if (options.list) {
        for (const Family& family : families) fmt::print("{}\n", family.name);
        for (const std::string& name : timed) fmt::print("{}\n", name);
        return;
    }
    if (families.empty() && timed.empty()) throw InputError("no such row; --list names them");
    fmt::print("row,quantity,unit,value,spread,samples,better\n");
    if (!families.empty()) {
        Runs runs(std::move(families), options);
        runs.make(parallel::granted_cores());
        print(runs.rows());
    }
    if (options.times && !timed.empty()) measure_times(timed, options.quick, print);
}

Options options_of(const std::vector<std::string>& arguments) {
    Options options;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& argument = arguments[i];
        if (argument == "--list")
            options.list = true;
        else if (argument == "--quick")
            options.quick = true;
        else if (argument == "--no-times")
            options.times = false;
        else if (argument == "--scenes" && i + 1 < arguments.size())
            options.scenes = std::max(1, std::stoi(arguments[++i]));
        else if (argument == "--runs" && i + 1 < arguments.size())
            options.runs = std::max(1, std::stoi(arguments[++i]));
        else if (argument == "--shake" && i + 1 < arguments.size())
            options.shake = std::stoull(arguments[++i]);
        else if (argument == "--rows" && i + 1 < arguments.size())
            options.names.assign(arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                 arguments.end()),
                i = arguments.size();
        else
            throw InputError(
                "usage: gate [--list] [--quick] [--scenes N] [--runs N] [--no-times] [--shake N] "
                "[--rows NAME...]");
    }
    return options;
}

}  // namespace
}  // namespace tesserae::bench::gate

int main(int argc, char** argv) {
    try {
        tesserae::bench::gate::run(
            tesserae::bench::gate::options_of(std::vector<std::string>(argv + 1, argv + argc)));
    } catch (const tesserae::InputError& error) {
        fmt::print(stderr, "gate: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "gate: {}\n", error.what());
        return 1;
    }
    return 0;
}
