// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/kernels/sixteen.hpp"

#include "core/dynamics/solver/kernels/general_start.hpp"
#include "core/dynamics/solver/kernels/general_sweep.hpp"
#include "core/dynamics/solver/kernels/round_sweep.hpp"

// What is in here may run on no other CPU. So all that it calls must be inlined or its own: what
// other sources have as well, the linker takes from any of them (tests/sixteen_alone.sh).
namespace tesserae::sixteen {

#ifdef __AVX512F__

using namespace lanes;

const bool kCompiled = true;

double sweep_round(ColouredIslands& coloured, std::uint32_t first, Sweep sweep) {
    const auto sweep_two = [&](auto friction, auto rolling) {
        const Lane<Float16> lane(coloured.round[first].rows);
        const Float16 left = solve_batch<friction(), rolling()>(coloured, lane, first, sweep);
        return sweep.measured ? largest_lane(left) : 0;
    };
    return with_kind_of_round(coloured, sweep.pass, sweep_two);
}

double sweep_general(ColouredIslands& coloured, std::uint32_t first, Sweep sweep) {
    const auto sweep_two = [&](auto friction, auto rolling, auto uneven) {
        const Lane<Float16> lane(coloured.general[first].rows);
        const Float16 left =
            solve_points<friction(), rolling(), uneven()>(coloured, lane, first, sweep);
        return sweep.measured ? largest_lane(left) : 0;
    };
    return with_kind_of_general(coloured, sweep.pass, sweep_two);
}

void start_general(ColouredIslands& coloured, std::uint32_t first, bool made,
                   const EightPairs* pairs) {
    const Lane<Float16> lane(coloured.general[first].rows);
    with_kind_of_general(coloured, Pass::kSolve, [&](auto friction, auto rolling, auto uneven) {
        start_pairs<friction(), rolling(), uneven()>(coloured, lane, first, made, *pairs);
    });
}

#else

const bool kCompiled = false;

double sweep_round(ColouredIslands&, std::uint32_t, Sweep) { return 0; }
double sweep_general(ColouredIslands&, std::uint32_t, Sweep) { return 0; }
void start_general(ColouredIslands&, std::uint32_t, bool, const lanes::EightPairs*) {}

#endif

}  // namespace tesserae::sixteen
