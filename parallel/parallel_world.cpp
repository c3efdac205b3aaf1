#include "parallel/parallel_world.hpp"

#include <utility>

#include "core/dynamics/islands.hpp"
#include "core/dynamics/motion.hpp"
#include "core/dynamics/pairs.hpp"
#include "core/dynamics/sleeping.hpp"
#include "core/dynamics/solver.hpp"
#include "parallel/chunks.hpp"
#include "parallel/coloured_island.hpp"
#include "parallel/island_graph.hpp"
#include "parallel/kept_pairs.hpp"
#include "parallel/trace.hpp"

namespace tesserae::parallel {
namespace {

/// Items of one task: some 10 to 50 us of work each.
constexpr std::size_t kBodyGrain = 256;
constexpr std::size_t kPairGrain = 512;
constexpr std::size_t kContactGrain = 1024;

}  // namespace

struct ParallelWorld::Stages {
    KeptPairs kept_pairs;
    ChunkedList<Contact> contacts;
    ChunkedList<ContactImpulse> pushing;
    IslandBuilder island_builder;
    IslandGraph island_graph;
};

ParallelWorld::ParallelWorld(Bodies bodies, const PhysicsSettings& settings)
    : simulation_(make_simulation(std::move(bodies), settings)) {}

ParallelWorld::~ParallelWorld() = default;

StepReport ParallelWorld::step(double dt) {
    begin_step(simulation_, step_, dt);
    // A graph works in the arena that it is built in, and the first step is the first to know it.
    if (!stages_) stages_ = std::make_unique<Stages>();
    for (step_.substep = 0; step_.substep < simulation_.settings.substeps; ++step_.substep) {
        advance_first_half();
        find_pairs();
        find_contacts();
        integrate_velocities();
        build_islands();
        solve_islands();
        advance_second_half();
        relax_islands();
    }
    return finish_step();
}

void ParallelWorld::forget_hints() {
    if (stages_) stages_->kept_pairs.forget();
}

void ParallelWorld::advance_first_half() {
    const Trace::Span span(trace_, "advance_first_half", simulation_.bodies.size());
    for_each_range(simulation_.bodies.size(), kBodyGrain,
                   [&](Range bodies) { tesserae::advance_first_half(simulation_, step_, bodies); });
    require_finite();
}

void ParallelWorld::find_pairs() {
    const std::size_t count = simulation_.bodies.size();
    const Trace::Span span(trace_, "find_pairs", count);
    if (step_.substep > 0 && !any_range(count, kBodyGrain, [&](Range bodies) {
            return outgrows_bounds(simulation_, step_, bodies);
        }))
        return;
    for_each_range(count, kBodyGrain,
                   [&](Range bodies) { update_bounds(simulation_, step_, bodies); });
    stages_->kept_pairs.find_pairs(simulation_, step_);
}

void ParallelWorld::find_contacts() {
    const Trace::Span span(trace_, "find_contacts", step_.pairs.size());
    for (bool look = true; look;) {
        stages_->contacts.collect(
            step_.pairs.size(), kPairGrain,
            [&](Range pairs, std::vector<Contact>& list) {
                tesserae::find_contacts(simulation_, step_, pairs, list);
            },
            step_.contacts);
        look = any_range(step_.contacts.size(), kContactGrain,
                         [&](Range contacts) { return touches_sleeper(step_, contacts); }) &&
               wake_touched(simulation_, step_);
        if (look) stages_->kept_pairs.choose_pairs(simulation_, step_);
    }
    begin_contacts(step_);
    for_each_range(step_.contacts.size(), kContactGrain,
                   [&](Range contacts) { recall_impulses(simulation_, step_, contacts); });
}

void ParallelWorld::integrate_velocities() {
    const Trace::Span span(trace_, "integrate_velocities", simulation_.bodies.size());
    for_each_range(simulation_.bodies.size(), kBodyGrain, [&](Range bodies) {
        tesserae::integrate_velocities(simulation_, step_, bodies);
    });
}

void ParallelWorld::build_islands() {
    const Trace::Span span(trace_, "build_islands", step_.contacts.size());
    stages_->island_builder.build(simulation_, step_);
}

void ParallelWorld::solve_islands() {
    const Trace::Span span(trace_, "solve_islands", step_.islands.size());
    stages_->island_graph.run(simulation_, step_, solve_island, solve_coloured_island, trace_);
}

void ParallelWorld::advance_second_half() {
    const Trace::Span span(trace_, "advance_second_half", simulation_.bodies.size());
    for_each_range(simulation_.bodies.size(), kBodyGrain, [&](Range bodies) {
        tesserae::advance_second_half(simulation_, step_, bodies);
    });
}

void ParallelWorld::relax_islands() {
    const Trace::Span span(trace_, "relax_islands", step_.islands.size());
    stages_->island_graph.run(simulation_, step_, relax_island, relax_coloured_island, trace_);
    stages_->pushing.collect(
        step_.impulses.size(), kContactGrain,
        [&](Range contacts, std::vector<ContactImpulse>& list) {
            list_pushing(step_, contacts, list);
        },
        step_.pushing);
    end_substep(simulation_, step_);
}

/// Pieces find out whether any body is not finite, and only then the lowest is looked for.
void ParallelWorld::require_finite() const {
    const std::size_t count = simulation_.bodies.size();
    if (any_range(count, kBodyGrain,
                  [&](Range bodies) { return !is_finite(simulation_, step_, bodies); }))
        tesserae::require_finite(simulation_, step_);
}

StepReport ParallelWorld::finish_step() {
    const Trace::Span span(trace_, "finish_step", step_.contacts.size());
    require_finite();
    begin_report(step_);
    for_each_range(step_.contacts.size(), kReportPiece,
                   [&](Range contacts) { sum_contacts(step_, contacts); });
    return commit_step(simulation_, step_);
}

}  // namespace tesserae::parallel
