#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// One part of the work: done, or left out, and why.
struct Decision {
    std::string part;
    bool needed = false;
    std::string reason;
};

/// What a scene needs, what is left out and why, and what it will cost. Made once, from the scene
/// alone; simulating and rendering ask it, so that what it prints is what happens.
struct Plan {
    std::vector<Decision> decisions;
    bool moves = false;  ///< some body changes its pose: steps are taken

    std::uint64_t bodies = 0, movable_bodies = 0;
    std::uint64_t steps = 0;  ///< time steps of the whole scene
    int frames = 0;
    std::uint64_t view_rays = 0;         ///< of all frames
    std::uint64_t memory_bytes = 0;      ///< estimated peak, program and libraries included
    std::uint64_t trajectory_bytes = 0;  ///< before compression, steps of all frames
};

Plan make_plan(const Scene& scene, int threads);

/// @throws InputError   the plan needs more memory than the machine or the cgroup has left
void require_memory(const Plan& plan, const Scene& scene);

}  // namespace tesserae::scenes
