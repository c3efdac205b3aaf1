#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "parallel/trace.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// What simulating did.
struct SimulateReport {
    std::uint64_t first_step = 0;  ///< where this run began: 0, or what an earlier one had kept
    std::uint64_t last_step = 0;
    std::uint64_t rows = 0;  ///< stored steps in the file
    double seconds = 0;
};

/// The steps that a trajectory stores: every K-th from 0 on, or those that all frames need (K = 0).
std::vector<std::uint64_t> stored_steps(const Scene& scene, std::uint64_t store_every);

/// How a trajectory that is there serves a scene.
enum class Served {
    kByNothing,     ///< none is there
    kWhole,         ///< it holds just the steps
    kByMore,        ///< it holds them and others
    kByBeginning,   ///< it holds the first of them: it is continued
    kByOtherSteps,  ///< it is of this motion, but lacks steps
    kByOther,       ///< it is of another motion or motion version, or no trajectory
};
Served how_served(const Scene& scene, const std::filesystem::path& file, std::uint64_t store_every);

/// Whether a trajectory says that it was made by this: see simulate().
bool is_made_by(const std::filesystem::path& file, const char* creator);

/// Moves the scene's bodies and stores their states in `file`. A whole file of the same motion and
/// steps is left as it is; an unfinished one is continued, and so is a finished one of a shorter
/// duration: the bytes of every dataset are those of one straight run.
/// Runs on the threads of the caller's parallel::Threads.
/// @param overwrite   a trajectory of other motion or steps is replaced, one that serves is kept
/// @param creator   what a new file says that it was made by
/// @param trace     records the stages of every step that is taken
/// @throws InputError   `file` is of another motion or motion version, stores other steps or more
/// than the scene's,
///                      and not `overwrite`
/// @throws RunError     a body left the finite range, or the file cannot be written
/// @throws Stopped      after a signal; what is stored is kept
SimulateReport simulate(const Scene& scene, const Plan& plan, const std::filesystem::path& file,
                        std::uint64_t store_every, bool overwrite, bool quiet,
                        parallel::Trace* trace = nullptr, const char* creator = "tesserae");

}  // namespace tesserae::scenes
