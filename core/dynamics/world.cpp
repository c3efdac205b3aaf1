#include "core/dynamics/world.hpp"

#include <utility>

#include "core/dynamics/motion.hpp"
#include "core/dynamics/pairs.hpp"
#include "core/dynamics/sleeping.hpp"
#include "core/dynamics/solver.hpp"

namespace tesserae {

World::World(Bodies bodies, const PhysicsSettings& settings)
    : simulation_(make_simulation(std::move(bodies), settings)) {}

StepReport World::step(double dt) {
    begin_step(simulation_, step_, dt);
    for (step_.substep = 0; step_.substep < simulation_.settings.substeps; ++step_.substep) {
        advance_first_half();    // free motion to the middle, where contacts act
        find_pairs();            // here every pair; parallel/ sorts and sweeps
        find_contacts();         // narrow phase, contacts keyed by feature id
        integrate_velocities();  // gravity
        build_islands();
        solve_islands();        // sequential impulses, warm started
        advance_second_half();  // rotors projected to unit rotors
        relax_islands();        // soft contacts give back the velocity that removed overlap
    }
    return finish_step();
}

void World::advance_first_half() {
    tesserae::advance_first_half(simulation_, step_, all_bodies());
    require_finite(simulation_, step_);
}

void World::find_pairs() {
    if (step_.substep > 0 && !outgrows_bounds(simulation_, step_, all_bodies())) return;
    update_bounds(simulation_, step_, all_bodies());
    tesserae::find_pairs(simulation_, step_);
}

void World::find_contacts() {
    for (bool look = true; look;) {
        step_.contacts.clear();
        tesserae::find_contacts(simulation_, step_, {0, step_.pairs.size()}, step_.contacts);
        look = wake_touched(simulation_, step_);
        if (look) tesserae::find_pairs(simulation_, step_);
    }
    begin_contacts(step_);
    recall_impulses(simulation_, step_, {0, step_.contacts.size()});
}

void World::integrate_velocities() {
    tesserae::integrate_velocities(simulation_, step_, all_bodies());
}

void World::build_islands() { island_builder_.build(simulation_, step_); }

void World::solve_islands() {
    for (std::size_t island = 0; island < step_.islands.size(); ++island)
        solve_island(simulation_, step_, island);
}

void World::advance_second_half() {
    tesserae::advance_second_half(simulation_, step_, all_bodies());
}

void World::relax_islands() {
    for (std::size_t island = 0; island < step_.islands.size(); ++island)
        relax_island(simulation_, step_, island);
    step_.pushing.clear();
    list_pushing(step_, {0, step_.impulses.size()}, step_.pushing);
    end_substep(simulation_, step_);
}

StepReport World::finish_step() {
    require_finite(simulation_, step_);
    begin_report(step_);
    sum_contacts(step_, {0, step_.contacts.size()});
    return commit_step(simulation_, step_);
}

}  // namespace tesserae
