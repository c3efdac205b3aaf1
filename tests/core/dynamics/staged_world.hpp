#pragma once

#include <limits>
#include <utility>

#include "core/dynamics/islands.hpp"
#include "core/dynamics/motion.hpp"
#include "core/dynamics/pairs.hpp"
#include "core/dynamics/solver.hpp"
#include "core/dynamics/step.hpp"

namespace tesserae::testing {

/// No island has as many contacts: all are solved one by one in double.
constexpr std::uint32_t kNoneColoured = std::numeric_limits<std::uint32_t>::max();

/// World::step without sleeping, for any size of coloured islands, and in two parts.
class StagedWorld {
  public:
    Simulation simulation;
    StepData step;

    StagedWorld(Bodies bodies, const PhysicsSettings& settings, std::uint32_t coloured_from)
        : simulation(make_simulation(std::move(bodies), settings)), islands_(coloured_from) {}

    /// The sub-step as far as its contacts and islands.
    void find(double dt) {
        if (step.substep == 0) begin_step(simulation, step, dt);
        advance_first_half(simulation, step, all());
        update_bounds(simulation, step, all());
        find_pairs(simulation, step);
        step.contacts.clear();
        find_contacts(simulation, step, {0, step.pairs.size()}, step.contacts);
        begin_contacts(step);
        recall_impulses(simulation, step, {0, step.contacts.size()});
        integrate_velocities(simulation, step, all());
        islands_.build(simulation, step);
    }
    void solve() {
        for (std::size_t i = 0; i < step.islands.size(); ++i) solve_island(simulation, step, i);
    }
    void relax() {
        advance_second_half(simulation, step, all());
        for (std::size_t i = 0; i < step.islands.size(); ++i) relax_island(simulation, step, i);
        step.pushing.clear();
        list_pushing(step, {0, step.impulses.size()}, step.pushing);
        end_substep(simulation, step);
    }

    StepReport advance(double dt) {
        step.substep = 0;
        for (int i = 0; i < simulation.settings.substeps; ++i) {
            step.substep = i;
            find(dt);
            solve();
            relax();
        }
        require_finite(simulation, step);
        begin_report(step);
        sum_contacts(step, {0, step.contacts.size()});
        step.substep = 0;
        return commit_step(simulation, step);
    }

  private:
    Range all() const { return {0, simulation.bodies.size()}; }
    IslandBuilder islands_;
};

}  // namespace tesserae::testing
