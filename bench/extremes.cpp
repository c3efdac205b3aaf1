// Stiff and extreme scenes under both solvers: CSV on standard output. `extremes long` adds the
// longest one.

#include <fmt/core.h>

#include <cstring>
#include <exception>
#include <string>

#include "bench/extreme_cases.hpp"
#include "bench/thread_time.hpp"
#include "core/error.hpp"

namespace tesserae::bench {
namespace {

struct Named {
    std::string name;
    PhysicsSettings settings;
};

std::vector<Named> settings() {
    PhysicsSettings impulse, soft;
    soft.solver = Solver::kSoft;
    soft.substeps = 4;
    soft.iterations = 2;
    return {{fmt::format("impulse 1x{}", impulse.iterations), impulse}, {"soft 4x2", soft}};
}

void print(const ExtremeCase& extreme, const Named& named) {
    const double begin = thread_time();
    std::vector<Measurement> rows;
    try {
        rows = extreme.measure(named.settings);
    } catch (const RunError& error) {
        fmt::print(stderr, "{}, {}: {}\n", extreme.name, named.name, error.what());
        rows = {{"left the finite range", "", 1}};
    }
    for (const Measurement& row : rows)
        fmt::print("\"{}\",{},{},{},{:.2e},{:.2f}\n", extreme.name, named.name, row.quantity,
                   row.unit, row.value, thread_time() - begin);
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae::bench;
    const bool with_long = argc > 1 && std::strcmp(argv[1], "long") == 0;
    try {
        fmt::print("case,settings,quantity,unit,value,serial_s\n");
        for (const ExtremeCase& extreme : extreme_cases(with_long))
            for (const Named& named : settings()) print(extreme, named);
    } catch (const std::exception& e) {
        fmt::print(stderr, "extremes: {}\n", e.what());
        return 1;
    }
    return 0;
}
