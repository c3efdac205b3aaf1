// SPDX-License-Identifier: Apache-2.0
#include "scenes/plan/rehearsal.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "core/dynamics/step/step.hpp"
#include "core/error.hpp"
#include "parallel/parallel_stepper.hpp"
#include "scenes/process/signals.hpp"

namespace tesserae::scenes {
namespace {

/// Poses that are kept, at most: of many bodies fewer.
constexpr std::size_t kMostPoses = 8, kMostKeptBodies = 1'000'000;
/// Contact points of a body at rest among others: what piles, stacks and heaps of 400 have for each
/// sphere, box and any other body after 3 s.
constexpr double kSphereContacts = 2.3, kBoxContacts = 8, kOtherContacts = 4.5;
/// Of a contact in a step, on one thread, with the default iterations [s]; where none was met.
constexpr double kContactSeconds = 4e-7;

double contacts_of(const Shape& shape) {
    return std::holds_alternative<Hypersphere>(shape) ? kSphereContacts
           : std::holds_alternative<Hyperbox>(shape)  ? kBoxContacts
                                                      : kOtherContacts;
}

/// What one step took.
struct StepCost {
    double seconds, contacts;
};

/// Seconds of a step as a line over its contacts: the least squares' of the later half of what was
/// seen, in which caches are warm.
struct CostLine {
    double fixed = 0, of_contact = 0;

    explicit CostLine(const std::vector<StepCost>& all) {
        const std::vector<StepCost> steps(all.begin() + static_cast<std::ptrdiff_t>(all.size() / 8),
                                          all.end());
        const auto count = static_cast<double>(steps.size());
        double time = 0, contacts = 0, product = 0, square = 0;
        for (const StepCost& s : steps) time += s.seconds / count, contacts += s.contacts / count;
        for (const StepCost& s : steps) {
            product += (s.seconds - time) * (s.contacts - contacts);
            square += (s.contacts - contacts) * (s.contacts - contacts);
        }
        // All contacts were met, or hardly any.
        const bool is_seen = square > 0.01 * count * contacts * contacts && product > 0;
        of_contact = is_seen ? product / square : contacts > 0 ? time / contacts : kContactSeconds;
        fixed = std::max(0.0, time - of_contact * contacts);
    }
    double at(double contacts) const { return fixed + of_contact * contacts; }
};

/// Contacts once all that falls has come to rest; where nothing falls, as many as now.
double contacts_at_rest(const Scene& scene, const std::vector<StepCost>& seen) {
    const std::size_t recent = std::max<std::size_t>(1, seen.size() / 4);
    const double now =
        std::accumulate(seen.end() - static_cast<std::ptrdiff_t>(recent), seen.end(), 0.0,
                        [](double sum, const StepCost& s) { return sum + s.contacts; }) /
        static_cast<double>(recent);
    const Bodies& bodies = scene.bodies;
    double most = 0;
    bool has_ground = false;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        if (bodies.is_movable(id))
            most += contacts_of(bodies.type_of(id).shape);
        else
            has_ground = true;
    }
    const bool falls = has_ground && !scene.physics->gravity.isZero(0);
    return falls ? std::max(now, most) : now;
}

}  // namespace

Rehearsal rehearse(const Scene& scene, const Plan& plan, std::uint64_t steps, double seconds) {
    Rehearsal rehearsal;
    rehearsal.steps = plan.moves ? steps : 0;
    rehearsal.poses.push_back({0, scene.bodies});
    if (rehearsal.steps == 0) return rehearsal;
    const std::size_t most_poses =
        std::clamp<std::size_t>(kMostKeptBodies / scene.bodies.size(), 2, kMostPoses);
    using Clock = std::chrono::steady_clock;
    const auto since = [](Clock::time_point begin) {
        return std::chrono::duration<double>(Clock::now() - begin).count();
    };
    const double dt = 1 / scene.physics->steps_per_second;
    std::vector<StepCost> costs;
    std::uint64_t spacing = 1;
    const auto is_stopped = [] { return stop_requested().load(std::memory_order_relaxed); };
    const StopQuestion stop = is_stopped;
    const auto begin = Clock::now();
    parallel::ParallelStepper world(make_simulation(scene.bodies, *scene.physics, scene.joints));
    // One step at least, however late it is: without any there is nothing to guess from.
    while (rehearsal.taken < rehearsal.steps && (costs.empty() || since(begin) < seconds)) {
        const auto step_begin = Clock::now();
        const StepReport found = world.step(dt, &stop);
        costs.push_back({since(step_begin), static_cast<double>(found.contacts)});
        if (++rehearsal.taken % spacing != 0) continue;
        rehearsal.poses.push_back({static_cast<double>(rehearsal.taken) * dt, world.bodies()});
        if (rehearsal.poses.size() <= most_poses) continue;
        // Every second one stays.
        spacing *= 2;
        std::vector<TimedBodies> fewer;
        for (std::size_t i = 0; i < rehearsal.poses.size(); i += 2)
            fewer.push_back(std::move(rehearsal.poses[i]));
        rehearsal.poses = std::move(fewer);
    }
    rehearsal.seconds = since(begin);
    if (rehearsal.is_whole()) return rehearsal;
    rehearsal.contacts = contacts_at_rest(scene, costs);
    rehearsal.seconds += static_cast<double>(rehearsal.steps - rehearsal.taken) *
                         CostLine(costs).at(rehearsal.contacts);
    return rehearsal;
}

}  // namespace tesserae::scenes
