// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "parallel/trace.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/process/watch.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// What simulating did.
struct SimulateReport {
    std::uint64_t first_step = 0;  ///< where this run began: 0, or what an earlier one had kept
    std::uint64_t last_step = 0;   ///< of the file
    std::uint64_t steps = 0;       ///< to the last frame of the scene
    std::uint64_t rows = 0;        ///< stored steps in the file
    bool kept = false;             ///< nothing was missing
    double seconds = 0;
};

/// The steps that a trajectory stores: every K-th from 0 on, or those that all frames need (K = 0).
std::vector<std::uint64_t> stored_steps(const Scene& scene, std::uint64_t store_every);

/// How a trajectory that is there serves a scene.
enum class Served {
    kByNothing,     ///< none is there
    kWhole,         ///< it holds just the steps, or just those and later ones of the scene
    kByMore,        ///< it holds them and others
    kByBeginning,   ///< it holds the first of them: it is continued
    kByOtherSteps,  ///< it is of this motion, but lacks steps
    kByOther,       ///< it is of another motion or motion version, or no trajectory
};
/// @param frames   to the last of which steps are wanted; empty: to the scene's last
Served how_served(const Scene& scene, const std::filesystem::path& file, std::uint64_t store_every,
                  const std::vector<int>& frames = {});

/// What simulating would tell of a trajectory that is kept.
SimulateReport report_of_kept(const Scene& scene, const std::filesystem::path& file,
                              std::uint64_t store_every);

/// Whether a trajectory says that it was made by this: see simulate().
bool is_made_by(const std::filesystem::path& file, const char* creator);

/// How simulate() works.
struct SimulateOptions {
    std::uint64_t store_every = 0;  ///< 0: the steps that frames need
    std::vector<int> frames = {};   ///< steps are taken to the last of them; empty: to the scene's
    bool overwrite = false;         ///< other motion or steps are replaced; what serves is kept
    bool quiet = false;
    parallel::Trace* trace = nullptr;  ///< records the stages of every step that is taken
    const char* creator = "tesserae";  ///< what a new file says that it was made by
    Watch watch = {};                  ///< of steps
};

/// Moves the scene's bodies and stores their states in `file`. A whole file of the same motion and
/// steps is left as it is, also where it goes on after the frames that are asked for; an unfinished
/// one is continued, and so is a finished one of fewer frames or a shorter duration: the bytes of
/// every dataset are those of one straight run. What replaces a trajectory of the same motion goes
/// at least as far, and to no step less than an unfinished one has.
/// Runs on the threads of the caller's parallel::Threads.
/// @throws InputError   `file` is of another motion or motion version, stores other steps or more
/// than the scene's,
///                      and not `overwrite`
/// @throws RunError     a body left the finite range, or the file cannot be written
/// @throws Stopped      the watch says so; what is stored is kept
SimulateReport simulate(const Scene& scene, const Plan& plan, const std::filesystem::path& file,
                        const SimulateOptions& options);

}  // namespace tesserae::scenes
