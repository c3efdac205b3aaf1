// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/constraints/contact_targets.hpp"

namespace tesserae {

/// Appends the contacts in the range that are impacts to a list. All functions of this file need
/// the velocities before gravity.
void list_impacts(const Simulation& simulation, const StepData& step, Range contacts,
                  std::vector<std::uint32_t>& impacts);

/// Returns the largest numbers of Impact over all contacts of some runs.
Impact impact_of_runs(const Simulation& simulation, const StepData& step,
                      std::span<const std::uint32_t> runs);
/// Returns the larger number of two Impacts, member by member.
Impact larger_of(const Impact& a, const Impact& b);

/// Returns the product of two motions of a body that is twice the kinetic energy if they are equal
/// [J].
double motion_product(const Simulation& simulation, const StepData& step, BodyId id,
                      const BodyMotion& a, const BodyMotion& b);
/// Returns twice the kinetic energy of a body [J].
double twice_kinetic_energy(const Simulation& simulation, const StepData& step, BodyId id,
                            const BodyMotion& motion);

/// Returns whether friction can jam in the island's compression. Coulomb's law has no solution
/// where friction turns a slender body into what it hits (Painleve 1895), and the compression may
/// add energy. It is then repeated without friction, which takes energy whatever the bodies.
bool can_jam(const Simulation& simulation, const Impact& impact);
/// Returns whether friction has jammed.
/// @param energies   before the compression and after it, or the same multiple of both
bool has_jammed(const std::array<double, 2>& energies);

// Restitution is cut, for all bodies of an island alike, so that no impact adds energy.
//
// In the norm of the kinetic energy it may change the motion by `returned` times as much as the
// compression did. Compression without friction is the projection to the motions without approach.
// The square of its change is then twice the energy that it takes, and a central impact is not cut;
// with friction it takes more. Work that friction would do during restitution counts as given,
// except on driven bodies, which do work of their own. Nor may there be more energy at the end of
// the sub-step than at its start, the work of gravity included: a body that hits off its centre and
// rebounds before it touches would gain about g h/v of it.

/// Sums over bodies of twice some energies [J]: of the change by compression, of the change by
/// restitution, and of the products of both with the motion that they start from.
struct RestitutionSums {
    double taken_squared = 0, given_squared = 0, lost = 0, cross = 0, all = 0;
    /// Gravity's work in the sub-step changes by half of its kick times the change of velocity.
    double work_taken = 0, work_given = 0;

    RestitutionSums& operator+=(const RestitutionSums& sums);
};
/// Returns the sums over some bodies. Needs step.impact_motion and the bodies' motion after
/// restitution.
RestitutionSums restitution_of(const Simulation& simulation, const StepData& step,
                               std::span<const BodyId> bodies);
/// Returns the part of the change by restitution that may stay.
double part_of_restitution(const RestitutionSums& sums, const Impact& impact);
/// Multiplies the bodies' change by restitution by a part.
void leave_part_of_restitution(const Simulation& simulation, StepData& step,
                               std::span<const BodyId> bodies, double part);

}  // namespace tesserae
