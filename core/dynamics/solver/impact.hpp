#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/constraints/contact_targets.hpp"

namespace tesserae {

/// Adds those of the contacts that are one. Needs the velocities before gravity, as all of this.
void list_impacts(const Simulation& simulation, const StepData& step, Range contacts,
                  std::vector<std::uint32_t>& impacts);

/// The largest numbers of all contacts of runs.
Impact impact_of_runs(const Simulation& simulation, const StepData& step,
                      std::span<const std::uint32_t> runs);
Impact larger_of(const Impact& a, const Impact& b);

/// Twice the kinetic energy of a body [J].
double twice_kinetic_energy(const Simulation& simulation, const StepData& step, BodyId id,
                            const BodyMotion& motion);

/// Whether friction can jam in the island's compression: it may then add energy, as Coulomb's law
/// has no answer where it turns a slender body into what it hits (Painleve 1895), and is done again
/// without friction, which takes energy whatever the bodies.
bool can_jam(const Simulation& simulation, const Impact& impact);
/// Whether it has: an energy, or a multiple of it, before the compression and after it.
bool has_jammed(const std::array<double, 2>& energies);

// What restitution gave is cut, of all bodies of an island alike, so that no impact adds energy.
//
// In the norm of the kinetic energy it may change the motion by `returned` times as much as the
// compression did. Compression without friction is the projection to the motions at which no
// bodies meet, so that the square of its change is twice the energy that it takes, and a central
// impact is not cut; with friction it takes more. Work that friction would do while restitution
// acts counts as given (bodies that are driven do work of their own: there it does not).
// Nor may there be more energy at the sub-step's end than at its start, the work of gravity
// included: what hits off its centre and rebounds before it touches would win some, some g h/v.

/// Sums over bodies, of twice energies [J]: of the changes by the compression and by what
/// restitution gave, and of what both do with the motion that they begin with.
struct RestitutionSums {
    double taken_squared = 0, given_squared = 0, lost = 0, cross = 0, all = 0;
    /// Gravity's work in the sub-step changes by half of its kick times the change of velocity.
    double work_taken = 0, work_given = 0;

    RestitutionSums& operator+=(const RestitutionSums& sums);
};
/// Needs step.impact_motion, and the bodies' motion after restitution.
RestitutionSums restitution_of(const Simulation& simulation, const StepData& step,
                               std::span<const BodyId> bodies);
/// The part of what restitution gave that may stay.
double part_of_restitution(const RestitutionSums& sums, const Impact& impact);
void leave_part_of_restitution(const Simulation& simulation, StepData& step,
                               std::span<const BodyId> bodies, double part);

}  // namespace tesserae
