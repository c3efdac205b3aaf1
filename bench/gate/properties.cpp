// SPDX-License-Identifier: Apache-2.0
// The properties that every scene has, of scenes as the property tests draw them.

#include "tests/scenes/properties/properties.hpp"

#include <fmt/core.h>

#include <functional>
#include <string>

#include "bench/gate/gate.hpp"
#include "core/error.hpp"

namespace tesserae::bench::gate {
namespace {

namespace properties = scenes::properties;

std::vector<double> measure(const Run& run) {
    const properties::SmallScene scene =
        properties::draw_small_scene(10000 + static_cast<std::uint64_t>(run.scene));
    // Another power of two for every scene; of masses a power of four.
    const int power = run.scene % 13 - 6;
    struct Property {
        const char* name;
        std::function<std::string()> fault;
    };
    const Property all[] = {{"momentum", [&] { return properties::fault_of_momentum(scene); }},
                            {"numbering", [&] { return properties::fault_of_numbering(scene); }},
                            {"interruption", [&] { return properties::fault_of_parting(scene); }},
                            {"turning", [&] { return properties::fault_of_turning(scene); }},
                            {"mirror", [&] { return properties::fault_of_mirroring(scene); }},
                            {"units of time", [&] { return properties::fault_of_slowing(scene); }},
                            {"units of length",
                             [&] {
                                 return properties::fault_of_scaling(scene, {power, 0, 0});
                             }},
                            {"units of mass", [&] {
                                 return properties::fault_of_scaling(scene, {0, 0, 2 * power});
                             }}};
    std::vector<double> values;
    for (const auto& [name, find_fault] : all) {
        // What leaves the finite range ends what can be said of it.
        try {
            const std::string fault = find_fault();
            values.push_back(fault.empty() ? 0 : 1);
            if (!fault.empty()) fmt::print(stderr, "seed {}, {}: {}\n", scene.seed, name, fault);
        } catch (const RunError&) {
            values.push_back(0);
        }
    }
    return values;
}

}  // namespace

std::vector<Family> property_families() {
    return {{"properties of drawn scenes",
             300,
             60,
             1,
             {count_of("momentum from nothing"), count_of("changed by numbering"),
              count_of("changed by an interruption"), count_of("changed by turning"),
              count_of("changed by a mirror"), count_of("changed by units of time"),
              count_of("changed by units of length"), count_of("changed by units of mass")},
             measure}};
}

}  // namespace tesserae::bench::gate
