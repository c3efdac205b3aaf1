// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <utility>

#include "core/dynamics/step/stage_copy.hpp"
#include "core/dynamics/stepper.hpp"

namespace tesserae::testing {

/// No island has as many contacts: all are solved one by one in double.
constexpr std::uint32_t kNoneColoured = std::numeric_limits<std::uint32_t>::max();
/// Islands solved by sweeps one by one, by sweeps in colours, and with joints as one block.
inline const ColouredFrom kAllWays[] = {kNoneColoured, 1, {}};

/// A small body that nothing moves.
inline BodyType held_type() {
    BodyType type = sphere_type(0.05);
    type.fixed_position = type.fixed_rotation = true;
    return type;
}

/// One step from the start, as its last stage finds it: solved, but not yet the present state.
inline StepData solved(Bodies bodies, const PhysicsSettings& settings, double dt,
                       std::uint32_t coloured_from) {
    StageCopy copy(Stage::kFinishStep);
    Stepper world(make_simulation(std::move(bodies), settings), coloured_from);
    world.observe(&copy);
    world.step(dt);
    return copy.step;
}

}  // namespace tesserae::testing
