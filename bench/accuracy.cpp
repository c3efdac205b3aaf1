// SPDX-License-Identifier: Apache-2.0
// Error against known results and the run time that it takes: CSV on standard output.
//   accuracy [NAME...]   the experiments of these names only

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <span>
#include <string_view>
#include <vector>

#include "bench/experiments/experiments.hpp"
#include "bench/matrix.hpp"
#include "core/error.hpp"
#include "parallel/threads.hpp"

namespace tesserae::bench {
namespace {

/// One experiment in one configuration: its errors and the times of its repeats.
struct Row {
    Experiment experiment;
    Knobs knobs;
    std::vector<Error> errors;
    std::vector<double> seconds;  ///< processor time of all steps
    int repeats;                  ///< in all, the run that gave the errors included if it counts
};

/// Runs longer than this [s] count themselves: the clock read beside each step is then little.
constexpr double kLongRun = 0.1;

/// Time [s] that one row may spend on repeats, and their greatest number.
constexpr double kTimeOfRepeats = 0.15;
constexpr int kMostRepeats = 15;

Row first_run(const Listed& listed, const Knobs& knobs) {
    Row row{listed.make(knobs), knobs, {}, {}, 1};
    Trial trial(row.experiment.bodies, row.experiment.settings, row.experiment.crowd,
                row.experiment.joints);
    row.errors = row.experiment.errors(trial);
    if (trial.seconds() > kLongRun) {
        row.seconds.push_back(trial.seconds());
    } else {
        const double fitting = kTimeOfRepeats / std::max(trial.seconds(), 1e-6);
        row.repeats = static_cast<int>(std::clamp(fitting, 3.0, 1.0 * kMostRepeats));
    }
    return row;
}

void repeat(Row& row) {
    const Experiment& e = row.experiment;
    Trial trial(e.bodies, e.settings, e.crowd, e.joints);
    trial.run();
    row.seconds.push_back(trial.seconds());
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           std::memcmp(static_cast<const void*>(a.data()), static_cast<const void*>(b.data()),
                       a.size() * sizeof(T)) == 0;
}

/// Either world must end with the same bits, so that an error is one of the engine's, not of the
/// world that happens to run it.
void require_same_bits(const Experiment& e) {
    Trial serial(e.bodies, e.settings, false, e.joints),
        crowd(e.bodies, e.settings, true, e.joints);
    serial.run();
    crowd.run();
    if (!same_bits(serial.bodies().position, crowd.bodies().position) ||
        !same_bits(serial.bodies().angular_velocity, crowd.bodies().angular_velocity))
        throw RunError(fmt::format("{}: the serial and the parallel world differ", e.name));
}

/// The value below which a part of the values lie.
double quantile(std::vector<double> values, double part) {
    const auto at = values.begin() + std::lround(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

void print(const Row& row) {
    const Knobs& k = row.knobs;
    const double scale = 1e6 / row.experiment.settings.duration;
    const double median = quantile(row.seconds, 0.5);
    const double spread = (quantile(row.seconds, 0.75) - quantile(row.seconds, 0.25)) / median;
    for (const Error& error : row.errors)
        fmt::print("{},{},{},{},{},{},{},{:.3e},{:.4g},{:.0f},{}\n", row.experiment.name,
                   error.quantity, error.unit, name_of(k.integrator), k.substeps, k.iterations,
                   k.steps_per_second, error.value, scale * median, 100 * spread,
                   row.seconds.size());
}

void run(std::span<char*> names) {
    std::vector<Row> rows;
    for (const Listed& listed : all_experiments()) {
        const std::string name = listed.make({}).name;
        const auto is_it = [&](std::string_view given) { return given == name; };
        if (!names.empty() && std::none_of(names.begin(), names.end(), is_it)) continue;
        const double begin = thread_time();
        require_same_bits(listed.make({.steps_per_second = 60}));
        for (const Knobs& knobs : knobs_of(listed.kind)) rows.push_back(first_run(listed, knobs));
        fmt::print(stderr, "{}: {:.1f} s\n", name, thread_time() - begin);
    }
    // Repeats are interleaved, so that a disturbance of the machine does not fall on one row.
    for (int i = 0; i < kMostRepeats; ++i)
        for (Row& row : rows)
            if (static_cast<int>(row.seconds.size()) < row.repeats) repeat(row);

    fmt::print(
        "experiment,quantity,unit,integrator,substeps,iterations,steps_per_second,error,us_"
        "per_s,"
        "spread_percent,repeats\n");
    for (const Row& row : rows) print(row);
}

}  // namespace
}  // namespace tesserae::bench

int main(int count, char** arguments) {
    try {
        tesserae::parallel::Threads one(1);
        one.run([&] {
            tesserae::bench::run({arguments + 1, static_cast<std::size_t>(count - 1)});
        });
    } catch (const std::exception& e) {
        fmt::print(stderr, "accuracy: {}\n", e.what());
        return 1;
    }
    return 0;
}
