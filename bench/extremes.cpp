// SPDX-License-Identifier: Apache-2.0
// Stiff and extreme scenes at the defaults: CSV on standard output. `extremes long` adds the
// longest one, `extremes joints` are others: those with joints, a card house and an arch.

#include <fmt/core.h>

#include <exception>
#include <string>
#include <string_view>

#include "bench/extreme_cases.hpp"
#include "bench/thread_time.hpp"
#include "core/error.hpp"

namespace tesserae::bench {
namespace {

void print(const ExtremeCase& extreme) {
    const double begin = thread_time();
    std::vector<Measurement> rows;
    try {
        rows = extreme.measure({});
    } catch (const RunError& error) {
        fmt::print(stderr, "{}: {}\n", extreme.name, error.what());
        rows = {{"left the finite range", "", 1}};
    }
    for (const Measurement& row : rows)
        fmt::print("\"{}\",{},{},{:.2e},{:.2f}\n", extreme.name, row.quantity, row.unit, row.value,
                   thread_time() - begin);
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae::bench;
    const std::string_view part = argc > 1 ? argv[1] : "";
    try {
        fmt::print("case,quantity,unit,value,serial_s\n");
        for (const ExtremeCase& extreme :
             part == "joints" ? extreme_joints() : extreme_cases(part == "long"))
            print(extreme);
    } catch (const std::exception& e) {
        fmt::print(stderr, "extremes: {}\n", e.what());
        return 1;
    }
    return 0;
}
