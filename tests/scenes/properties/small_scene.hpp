// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/step/settings.hpp"
#include "scenes/load/body_keys.hpp"

namespace tesserae::scenes::properties {

/// A scene of a few bodies as its file says it. Every body has a type of its own here.
struct SmallScene {
    std::uint64_t seed = 0;  ///< from which it was drawn
    int steps = 0;           ///< that a property is looked at for
    PhysicsSettings physics;
    std::vector<BodyTable> tables;  ///< shapes as written in `shape`, completed in `type`
};

/// Draws a scene of 2 to 12 bodies of all shapes that meet within some steps, from half a size to
/// 1.6 sizes of each other: with any friction, restitution and masses; thin, fast, fixed and driven
/// ones; in the air, on planes, stacked or inside each other; with any settings.
/// The same seed gives the same scene everywhere.
SmallScene draw_small_scene(std::uint64_t seed);

/// The scene as a file that `tesserae simulate` takes.
std::string text_of(const SmallScene& scene);

/// How the scene starts.
Bodies bodies_of(const SmallScene& scene);

/// How many bodies are bounded.
std::size_t bounded_count(const SmallScene& scene);

/// Looks for the smallest scene that still has a fault: bodies are taken away one by one, steps,
/// velocities, friction and whatever else may matter likewise, as long as the fault stays.
/// @param has_fault   of the scene given it is true
SmallScene shrunk(SmallScene scene, const std::function<bool(const SmallScene&)>& has_fault);

}  // namespace tesserae::scenes::properties
