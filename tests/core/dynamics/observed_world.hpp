#pragma once

#include <limits>
#include <utility>

#include "core/dynamics/step/stage_copy.hpp"
#include "core/dynamics/world.hpp"

namespace tesserae::testing {

/// No island has as many contacts: all are solved one by one in double.
constexpr std::uint32_t kNoneColoured = std::numeric_limits<std::uint32_t>::max();

/// One step from the start, as its last stage finds it: solved, but not yet the present state.
inline StepData solved(Bodies bodies, const PhysicsSettings& settings, double dt,
                       std::uint32_t coloured_from) {
    StageCopy copy(Stage::kFinishStep);
    World world(make_simulation(std::move(bodies), settings), coloured_from);
    world.observe(&copy);
    world.step(dt);
    return copy.step;
}

}  // namespace tesserae::testing
