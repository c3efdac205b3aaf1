// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tesserae::scenes {

/// Something that a file tells of itself.
struct Fact {
    std::string name;
    /// Numbers as numbers; with a unit, or a step at which it was reached, an object of "value" and
    /// "unit" and "step". What JSON has no number for is one of the texts "inf", "-inf" and "nan".
    nlohmann::ordered_json value;
    std::string text;  ///< the value as a person reads it
};

/// A summary of a scene, trajectory or image, told apart by content, in the order to show it.
/// @throws InputError   the file cannot be read, or is none of the three
std::vector<Fact> facts_about(const std::filesystem::path& file, int threads);

}  // namespace tesserae::scenes
