// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tesserae::scenes {

/// Scenes of many bodies, for measurements and to start from.
inline constexpr std::string_view kGenerators[] = {
    "gas", "pile", "boxes", "stacks", "pyramid", "polychora", "chain", "grid", "bridge"};

/// A scene file of exactly `bodies` bodies beside floor and walls.
///   gas      elastic spheres without gravity between eight walls, half of them against the other
///   pile     spheres that fall into one dense heap between walls
///   boxes    the same with boxes of unequal sides, turned
///   stacks   boxes in separate stacks of ten: as many islands
///   polychora  regular polychora, a duoprism, a duocylinder, spherinders and cubinders in one heap
///   pyramid  boxes in rows, each one shorter than that below: one island
///   chain    capsules in a row along x, joined by points and to the world at one end
///   grid     a net of balls, joined by points, whose first row is held
///   bridge   planks in an arc, joined by hinges and to the world at both ends
/// @param name     one of kGenerators
/// @param bodies   1 to 10^6
/// @throws InputError   more bodies than a scene file can join
std::string generated_scene(std::string_view name, std::uint64_t bodies);

}  // namespace tesserae::scenes
