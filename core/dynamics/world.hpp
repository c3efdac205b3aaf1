#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/stages/blow_patches.hpp"
#include "core/dynamics/stages/chunked_list.hpp"
#include "core/dynamics/stages/first_loads.hpp"
#include "core/dynamics/stages/impacts.hpp"
#include "core/dynamics/stages/islands.hpp"
#include "core/dynamics/stages/kept_contacts.hpp"
#include "core/dynamics/stages/schedule.hpp"
#include "core/dynamics/stages/seams.hpp"
#include "core/dynamics/stages/step.hpp"

namespace tesserae {

/// Bodies that move. The one text of the step: by itself it is serial, tests every two bodies for
/// contacts and solves islands one by one; a Schedule shares the same work out, with the same bits.
///
/// All that a step depends on is bodies() and memory(): a world made from both as saved goes on
/// with the same bits.
class World {
  public:
    /// @throws InputError   as make_simulation()
    World(Bodies bodies, const PhysicsSettings& settings);
    /// @param coloured_from   for tests and measurements
    explicit World(Simulation simulation, ColouredFrom coloured_from = {});

    /// Advances by dt [s].
    /// @throws InputError        dt is not finite or not > 0
    /// @throws LeftFiniteRange   bodies() and memory() are then as before the call
    StepReport step(double dt);
    StepReport step(double dt, Schedule& schedule);

    /// From the next step on the observer sees every stage; null ends that. Changes no result.
    void observe(StageObserver* observer) { observer_ = observer; }

    const Simulation& simulation() const { return simulation_; }
    const Bodies& bodies() const { return simulation_.bodies; }
    const StepMemory& memory() const { return simulation_.memory; }
    StepMemory& memory() { return simulation_.memory; }

  private:
    class Observed;

    void advance_first_half(Schedule& schedule);
    void find_pairs(Schedule& schedule);
    void find_pairs_anew(Schedule& schedule);
    void find_contacts(Schedule& schedule);
    void build_islands();
    void solve_blows(Schedule& schedule);
    void integrate_velocities(Schedule& schedule);
    void solve_islands(Schedule& schedule);
    void advance_second_half(Schedule& schedule);
    void stop_at_impacts(Schedule& schedule, Impacts::Half half);
    void drop_corrections(Schedule& schedule);
    void keep_impulses(Schedule& schedule);
    StepReport finish_step(Schedule& schedule);
    void require_finite(Schedule& schedule) const;

    Simulation simulation_;
    StepData step_;
    IslandBuilder island_builder_;
    SpareManifolds spare_manifolds_;
    Clearances clearances_;
    ChunkedList<Contact> contacts_;
    Seams seams_;
    FirstLoads first_loads_;
    BlowPatches blow_patches_;
    Impacts impacts_;
    std::vector<std::vector<std::uint32_t>> hits_;  ///< of every range of contacts, the blows
    std::vector<std::uint8_t> has_fast_;            ///< of every range of kBodyGrain bodies
    /// Of every range of contacts, and an end.
    std::vector<KeptImpulses::Size> first_pushing_;
    StageObserver* observer_ = nullptr;
};

}  // namespace tesserae
