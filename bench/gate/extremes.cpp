// SPDX-License-Identifier: Apache-2.0
// The stiff and extreme scenes of extreme_cases.hpp, at the default settings.

#include "bench/extreme_cases.hpp"
#include "bench/gate/gate.hpp"

namespace tesserae::bench::gate {
namespace {

/// What chance does is seen by ending the sweeps a little earlier or later.
PhysicsSettings settings_of(const Run& run) {
    PhysicsSettings settings;
    settings.tolerance *= 1 + 0.03 * static_cast<double>(run.shake % 100);
    return settings;
}

}  // namespace

std::vector<Family> extreme_families() {
    std::vector<Family> families;
    for (const ExtremeCase& extreme : extreme_cases(false)) {
        Family family;
        family.name = "extreme: " + extreme.name;
        family.runs = 3;
        family.find_quantities = [extreme] {
            std::vector<Quantity> quantities;
            // What has restitution should come back as fast as it does, all else should not.
            const bool returns = extreme.name.find("restitution") != std::string::npos;
            for (const Measurement& row : extreme.measure(settings_of({}))) {
                const bool equal = returns && row.quantity == "comes back at";
                quantities.push_back({row.quantity,
                                      row.unit,
                                      {Statistic::kMedian},
                                      equal ? Better::kEqual : Better::kLess});
            }
            return quantities;
        };
        family.measure = [extreme](const Run& run) {
            std::vector<double> values;
            for (const Measurement& row : extreme.measure(settings_of(run)))
                values.push_back(row.value);
            return values;
        };
        families.push_back(std::move(family));
    }
    return families;
}

}  // namespace tesserae::bench::gate
