#pragma once

#include "core/dynamics/islands.hpp"
#include "core/dynamics/step.hpp"

namespace tesserae {

/// The serial step: every pair tested, islands one by one. The reference that everything faster
/// must match bit for bit.
///
/// All that a step depends on is bodies() and memory(): a world made from both as saved goes on
/// with the same bits.
class World {
  public:
    /// @throws InputError   as make_simulation()
    World(Bodies bodies, const PhysicsSettings& settings);

    /// Advances by dt [s].
    /// @throws InputError        dt is not finite or not > 0
    /// @throws LeftFiniteRange   bodies() and memory() are then as before the call
    StepReport step(double dt);

    const Bodies& bodies() const { return simulation_.bodies; }
    const StepMemory& memory() const { return simulation_.memory; }
    StepMemory& memory() { return simulation_.memory; }

  private:
    void advance_first_half();
    void find_pairs();
    void find_contacts();
    void integrate_velocities();
    void build_islands();
    void solve_islands();
    void advance_second_half();
    void relax_islands();
    StepReport finish_step();

    Range all_bodies() const { return {0, simulation_.bodies.size()}; }

    Simulation simulation_;
    StepData step_;
    IslandBuilder island_builder_;
};

}  // namespace tesserae
