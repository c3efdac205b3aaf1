// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Returns the largest speed that the warm start of a run gives the lighter one of its bodies
/// [m/s].
inline double speed_of_loads(const Simulation& simulation, const StepData& step,
                             std::span<const std::uint32_t> runs) {
    double largest = 0;
    for (const std::uint32_t n : runs) {
        const auto [begin, end, a, b] = step.contacts.nth_run(n);
        double load = 0;
        for (std::size_t i = begin; i < end; ++i) load += step.impulses[i].normal;
        const double inverse_mass =
            std::max(simulation.type_of(a).inverse_mass, simulation.type_of(b).inverse_mass);
        largest = std::max(largest, load * inverse_mass);
    }
    return largest;
}

}  // namespace tesserae
