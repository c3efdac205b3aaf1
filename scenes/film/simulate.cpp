// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <numbers>
#include <span>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/diagnostics/joint_state.hpp"
#include "core/dynamics/diagnostics/momentum.hpp"
#include "core/dynamics/motion_version.hpp"
#include "core/dynamics/step/step.hpp"
#include "core/error.hpp"
#include "parallel/parallel_stepper.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/process/progress.hpp"
#include "scenes/process/version.hpp"
#include "scenes/timeline.hpp"
#include "scenes/trajectory/joint_datasets.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

constexpr double kDegreesInRadian = 180 / std::numbers::pi;

/// The unit in which a trajectory tells a joint's position.
const char* position_unit(const Joint& joint) {
    const int free = free_coordinate(joint);
    return free < 0 ? "" : is_angle(joint, free) ? "deg" : "m";
}

TrajectoryHeader header_of(const Scene& scene, const SimulateOptions& options,
                           std::uint64_t last_step) {
    TrajectoryHeader header;
    header.creator = options.creator;
    header.scene_name = scene.name;
    header.source = scene.source;
    header.effective = scene.effective;
    header.hash = scene.hash;
    header.motion_hash = scene.motion_hash;
    header.program_version = program_version();
    header.bodies = scene.bodies.size();
    header.steps_per_second = scene.physics ? scene.physics->steps_per_second : 1;
    header.store_every = options.store_every;
    header.last_step = last_step;
    header.motion_version = kMotionVersion;
    header.described = {scene.bodies.types, scene.bodies.type, scene.names};
    for (std::size_t i = 0; i < scene.joints.size(); ++i)
        header.joints.push_back({scene.joint_names[i], position_unit(scene.joints[i])});
    header.joint_parts = make_joints(scene.joints, scene.bodies).parts();
    return header;
}

/// What joints are and do where bodies are.
/// @param world   none: nothing has acted on them
JointFacts joint_facts_of(const Scene& scene, const Bodies& bodies,
                          const parallel::ParallelStepper* world) {
    std::span<const Wrench> impulses;
    if (world) impulses = world->joint_impulses();
    JointFacts facts = room_for_joints(scene.joints.size());
    if (world && !world->memory().broken.empty()) facts.broken = world->memory().broken;
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        const Joint& joint = scene.joints[i];
        const JointState state = state_of(joint, bodies, impulses.empty() ? Wrench{} : impulses[i]);
        facts.impulse[i] = state.impulse;
        facts.angular_impulse[i] = state.angular_impulse;
        facts.error[i] = state.error;
        facts.angular_error[i] = kDegreesInRadian * state.angular_error;
        const bool is_turning = is_angle(joint, free_coordinate(joint));
        facts.position[i] = (is_turning ? kDegreesInRadian : 1) * state.position;
    }
    return facts;
}

StepFacts facts_of(const Scene& scene, std::uint64_t step, const StepReport& found,
                   const Bodies& bodies) {
    StepFacts facts;
    facts.step = step;
    facts.report = found;
    facts.kinetic_energy = kinetic_energy(bodies);
    facts.momentum = total_momentum(bodies);
    facts.angular_momentum = total_angular_momentum(bodies);
    if (scene.physics) {
        facts.time = static_cast<double>(step) / scene.physics->steps_per_second;
        facts.potential_energy = potential_energy(bodies, scene.physics->gravity);
    }
    return facts;
}

/// The name that a body has, alone or with others of its lattice.
const std::string& name_of_body(const Scene& scene, BodyId id) {
    const auto after =
        std::upper_bound(scene.names.begin(), scene.names.end(), id,
                         [](BodyId body, const NamedBodies& named) { return body < named.first; });
    return std::prev(after)->name;
}

/// One step; a body that leaves the finite range is reported by its name.
/// @throws Stopped   the watch says so, before the step or amid it
StepReport checked_step(const Scene& scene, parallel::ParallelStepper& world, const Watch& watch) {
    const auto is_stopped = [&] { return watch.is_stopped(); };
    const StopQuestion stop = is_stopped;
    try {
        return world.step(1.0 / scene.physics->steps_per_second, &stop);
    } catch (const LeftFiniteRange& error) {
        throw RunError(fmt::format("{} (body {} is of \"{}\")", error.what(), error.body,
                                   name_of_body(scene, error.body)));
    }
}

/// Says once, after a step that took long, which body makes it so: one that turns many times within
/// a step, whose way is looked at in as many pieces, or one that goes so far that it may meet very
/// many others.
class SlowSteps {
  public:
    SlowSteps(const Scene& scene, bool quiet) : scene_(scene), told_(quiet) {}

    void look_at(double seconds, const Bodies& bodies) {
        constexpr double kLong = 0.5, kFullTurn = 6.283185307179586;  // [s], [rad]
        constexpr double kFar = 10;                                   // [radii]
        if (told_ || seconds < kLong) return;
        const double steps = scene_.physics->steps_per_second;
        const auto turns = [&](BodyId id) {
            return norm(bodies.angular_velocity[id]) / (kFullTurn * steps);
        };
        const auto radii = [&](BodyId id) {
            return bodies.velocity[id].norm() / (bounding_radius(bodies.type_of(id).shape) * steps);
        };
        if (const BodyId turning = most(bodies, turns); turns(turning) > 1)
            tell_of(turning, seconds, fmt::format("turns {:.0f} times", turns(turning)));
        else if (const BodyId id = most(bodies, radii); radii(id) > kFar)
            tell_of(id, seconds, fmt::format("goes {:.0f} times its radius", radii(id)));
    }

  private:
    template <class Measure>
    static BodyId most(const Bodies& bodies, const Measure& measure) {
        BodyId most = 0;
        for (BodyId id = 0; id < bodies.size(); ++id)
            if (measure(id) > measure(most)) most = id;
        return most;
    }
    void tell_of(BodyId id, double seconds, const std::string& what) {
        told_ = true;
        tell(
            fmt::format("warning: a step took {}: \"{}\" {} within it; with more "
                        "steps_per_second a step takes less",
                        duration_text(seconds), name_of_body(scene_, id), what));
    }

    const Scene& scene_;
    bool told_;
};

/// Stores the rows that are missing of those wanted. Every row holds a state and what the step that
/// led to it found; the first, before any step, found nothing.
void store_rows(const Scene& scene, const Plan& plan, TrajectoryWriter& writer,
                std::span<const std::uint64_t> steps, const SimulateOptions& options,
                SimulateReport& report) {
    Bodies start = scene.bodies;
    std::uint64_t step = 0;
    StepMemory memory;
    if (auto resume = writer.resume(start)) {
        step = resume->step;
        memory = std::move(resume->memory);
    }
    report.first_step = step;
    // Where nothing moves every row is the first.
    std::optional<parallel::ParallelStepper> world;
    if (plan.moves) {
        world.emplace(make_simulation(std::move(start), *scene.physics, scene.joints));
        world->memory() = std::move(memory);
        world->set_trace(options.trace);
    }
    const Bodies& bodies = world ? world->bodies() : start;

    Progress progress("simulating", "steps", std::max(step, steps.back()), options.quiet);
    progress.start_at(step);
    SlowSteps slow(scene, options.quiet);
    StepReport found;
    for (std::uint64_t row = writer.rows(); row < steps.size(); ++row) {
        for (; step < steps[row]; ++step) {
            options.watch.look();
            if (world) {
                const auto begin = std::chrono::steady_clock::now();
                found = checked_step(scene, *world, options.watch);
                const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
                slow.look_at(took.count(), bodies);
            }
            progress.update(step + 1);
            options.watch.tell(step + 1, steps.back());
        }
        StepFacts facts = facts_of(scene, step, found, bodies);
        facts.joints = joint_facts_of(scene, bodies, world ? &*world : nullptr);
        writer.append(facts, bodies, world ? world->memory() : memory);
    }
    report.last_step = step;
    report.rows = writer.rows();
}

/// How many of a scene's stored steps frames need, with those before them.
std::size_t rows_to(const Scene& scene, const std::vector<std::uint64_t>& steps,
                    const std::vector<int>& frames) {
    if (frames.empty()) return steps.size();
    const std::uint64_t last = last_step_needed(scene, frames);
    return static_cast<std::size_t>(std::upper_bound(steps.begin(), steps.end(), last) -
                                    steps.begin());
}

/// How many of a scene's stored steps are as far as a trajectory of its motion goes.
std::size_t rows_as_far_as(const fs::path& file, const std::vector<std::uint64_t>& steps) {
    const TrajectoryReader there(file);
    if (there.rows() == 0) return 0;
    const auto after = std::lower_bound(steps.begin(), steps.end(), there.steps().back());
    return std::min(steps.size(), static_cast<std::size_t>(after - steps.begin()) + 1);
}

}  // namespace

std::vector<std::uint64_t> stored_steps(const Scene& scene, std::uint64_t store_every) {
    if (store_every == 0) return steps_for_frames(scene, parse_frames("", frame_count(scene)));
    std::vector<std::uint64_t> steps;
    const std::uint64_t last = step_count(scene);
    for (std::uint64_t step = 0; step <= last; step += store_every) {
        steps.push_back(step);
        if (last - step < store_every) break;
    }
    return steps;
}

Served how_served(const Scene& scene, const fs::path& file, std::uint64_t store_every,
                  const std::vector<int>& frames) {
    if (!fs::exists(file)) return Served::kByNothing;
    std::optional<TrajectoryReader> there;
    try {
        there.emplace(file);
    } catch (const InputError&) {
        return Served::kByOther;
    }
    if (there->header().motion_hash != scene.motion_hash ||
        there->header().motion_version != kMotionVersion)
        return Served::kByOther;
    const std::vector<std::uint64_t>& stored = there->steps();
    const std::vector<std::uint64_t> steps = stored_steps(scene, store_every);
    const auto wanted = static_cast<std::ptrdiff_t>(rows_to(scene, steps, frames));
    const bool is_beginning =
        stored.size() <= steps.size() && std::equal(stored.begin(), stored.end(), steps.begin());
    if (is_beginning && std::ssize(stored) >= wanted) return Served::kWhole;
    if (std::includes(stored.begin(), stored.end(), steps.begin(), steps.begin() + wanted))
        return Served::kByMore;
    return is_beginning && there->header().store_every == store_every ? Served::kByBeginning
                                                                      : Served::kByOtherSteps;
}

SimulateReport report_of_kept(const Scene& scene, const fs::path& file, std::uint64_t store_every) {
    const TrajectoryReader there(file);
    SimulateReport report;
    report.kept = true;
    report.rows = there.rows();
    report.first_step = report.last_step = there.steps().back();
    report.steps = stored_steps(scene, store_every).back();
    return report;
}

bool is_made_by(const fs::path& file, const char* creator) {
    if (!fs::exists(file)) return false;
    try {
        return TrajectoryReader(file).header().creator == creator;
    } catch (const InputError&) {
        return false;
    }
}

SimulateReport simulate(const Scene& scene, const Plan& plan, const fs::path& file,
                        const SimulateOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    const Served served = how_served(scene, file, options.store_every, options.frames);
    if (served == Served::kWhole) return report_of_kept(scene, file, options.store_every);
    const std::vector<std::uint64_t> steps = stored_steps(scene, options.store_every);
    std::size_t count = rows_to(scene, steps, options.frames);
    if (served == Served::kByMore || served == Served::kByOtherSteps)
        count = std::max(count, rows_as_far_as(file, steps));
    SimulateReport report;
    report.steps = steps.back();
    TrajectoryWriter writer(file, header_of(scene, options, steps.back()), steps,
                            options.overwrite);
    if (!writer.note().empty()) tell(writer.note());
    store_rows(scene, plan, writer, std::span(steps).first(count), options, report);
    writer.finish();
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return report;
}

}  // namespace tesserae::scenes
