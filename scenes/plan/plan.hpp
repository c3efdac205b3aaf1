// SPDX-License-Identifier: Apache-2.0
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

/// What a scene needs, what is left out and why, and what it will cost, from the scene alone. The
/// step and the renderer decide what they need (core's and render's needs_of); the plan asks them
/// and gives the reasons. Whether anything moves is decided here, and simulating asks.
struct Plan {
    std::vector<Decision> decisions;
    void decide(std::string part, bool needed, std::string if_needed, std::string if_not = {}) {
        decisions.push_back({std::move(part), needed, std::move(needed ? if_needed : if_not)});
    }

    std::vector<std::string> warnings;  ///< of what is surely not meant

    bool moves = false;  ///< some body changes its pose: steps are taken

    std::uint64_t bodies = 0, movable_bodies = 0, joints = 0;
    std::uint64_t steps = 0;             ///< time steps of the whole scene
    int frames = 0;                      ///< of the whole scene
    std::uint64_t view_rays = 0;         ///< of all frames, at most
    std::uint64_t memory_bytes = 0;      ///< estimated peak, program and libraries included
    std::uint64_t trajectory_bytes = 0;  ///< before compression, steps of all frames
    std::uint64_t checkpoint_bytes = 0;  ///< in it until it is done, where all lie in a heap
};

Plan make_plan(const Scene& scene, int threads);

/// Leaves of a plan's counts what the given frames need.
/// @param frames   ascending, at least one
void narrow_to(Plan& plan, const Scene& scene, const std::vector<int>& frames);

/// @throws InputError   the plan needs more memory than the machine or the cgroup has left
void require_memory(const Plan& plan, const Scene& scene);

}  // namespace tesserae::scenes
