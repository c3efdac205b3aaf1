// Error against exact results and the run time that it takes: CSV on standard output.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <vector>

#include "bench/experiments.hpp"
#include "bench/thread_time.hpp"
#include "core/error.hpp"
#include "parallel/parallel_world.hpp"
#include "parallel/threads.hpp"

namespace tesserae::bench {
namespace {

/// An experiment's errors and the times of its repeats.
struct Row {
    Experiment experiment;
    std::vector<Error> errors;
    std::vector<double> serial;    ///< processor time of all steps [s]
    std::vector<double> parallel;  ///< wall time of all steps [s]
};

template <class AnyWorld>
void make_steps(AnyWorld& world, const PhysicsSettings& settings) {
    const long steps = std::lround(settings.duration * settings.steps_per_second);
    for (long i = 0; i < steps; ++i) world.step(1 / settings.steps_per_second);
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           std::memcmp(static_cast<const void*>(a.data()), static_cast<const void*>(b.data()),
                       a.size() * sizeof(T)) == 0;
}

/// One repeat of a row. The two worlds must end alike.
void measure(Row& row, parallel::Threads& threads) {
    const Experiment& e = row.experiment;
    World serial(e.bodies, e.settings);
    const double begin = thread_time();
    make_steps(serial, e.settings);
    row.serial.push_back(thread_time() - begin);

    parallel::ParallelWorld wide(e.bodies, e.settings);
    threads.run([&] {
        const auto wall_begin = std::chrono::steady_clock::now();
        make_steps(wide, e.settings);
        const auto wall_end = std::chrono::steady_clock::now();
        row.parallel.push_back(std::chrono::duration<double>(wall_end - wall_begin).count());
    });

    if (!same_bits(serial.bodies().position, wide.bodies().position) ||
        !same_bits(serial.bodies().angular_velocity, wide.bodies().angular_velocity))
        throw RunError(fmt::format("{}: the serial and the parallel world differ", e.name));
}

/// The value below which a part of the values lie.
double quantile(std::vector<double> values, double part) {
    const auto at = values.begin() + std::lround(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

void print(const Row& row) {
    const PhysicsSettings& s = row.experiment.settings;
    const double scale = 1e6 / s.duration;
    const double median = quantile(row.serial, 0.5);
    const double spread = (quantile(row.serial, 0.75) - quantile(row.serial, 0.25)) / median;
    for (const Error& error : row.errors)
        fmt::print("{},{},{},{},{},{:.3e},{:.1f},{:.0f},{:.1f}\n", row.experiment.name,
                   error.quantity, error.unit, s.steps_per_second, s.iterations, error.value,
                   scale * median, 100 * spread, scale * quantile(row.parallel, 0.5));
}

void run() {
    std::vector<Experiment> list;
    for (int steps_per_second : {30, 60, 120, 240, 480, 960, 1920}) {
        for (Experiment& e : experiments(steps_per_second)) list.push_back(std::move(e));
        list.push_back(column_of_spheres(steps_per_second, 10));
    }
    for (int iterations : {1, 2, 3, 5, 7, 15, 20, 30, 50, 100})
        list.push_back(column_of_spheres(240, iterations));

    std::vector<Row> rows;
    for (Experiment& e : list) {
        World world(e.bodies, e.settings);
        std::vector<Error> errors = e.errors(world);
        rows.push_back({std::move(e), std::move(errors), {}, {}});
    }
    // Repeats are interleaved, so that a disturbance of the machine does not fall on one row.
    constexpr int kRepeats = 15;
    parallel::Threads threads(parallel::granted_cores());
    for (int repeat = 0; repeat < kRepeats; ++repeat)
        for (Row& row : rows) measure(row, threads);

    fmt::print(
        "motion,quantity,unit,steps_per_second,iterations,error,serial_us_per_s,spread_percent,"
        "parallel_us_per_s\n");
    for (const Row& row : rows) print(row);
}

}  // namespace
}  // namespace tesserae::bench

int main() {
    try {
        tesserae::bench::run();
    } catch (const std::exception& e) {
        fmt::print(stderr, "accuracy: {}\n", e.what());
        return 1;
    }
    return 0;
}
