// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Writes step.company: the number of other movable bodies that each body touches, up to two. A
/// body that carries or leans on others does not roll freely.
void count_company(const Simulation& simulation, StepData& step);

/// Writes step.rises and step.rim_slips of the contacts of the runs in the range.
///
/// As a round body turns, the point at which it touches runs along its rim; on a coin that wobbles
/// down it runs many times faster than the material moves there. Between the middles of two
/// sub-steps the surfaces come nearer than the points do that touch in the first, and the rim sinks
/// in. Friction that ends the slip of these points, not of those that touch next, drives the body
/// on. So both aims are for the way from one middle to the next, as the body turns freely. They are
/// of second order in the time step. They are the same backwards in time, so that energy is neither
/// gained nor lost on the whole. Along the normal this is SHAKE (Ryckaert, Ciccotti, Berendsen, J.
/// Comput. Phys. 23, 1977).
void aim_rims(const Simulation& simulation, StepData& step, Range runs);

/// The feature of a rim's point ahead, see add_rim_ahead(): it comes after all other points of a
/// pair.
constexpr std::uint32_t kRimAhead = 0xffffffff;

/// Appends to a pair's contacts, which begin at `first`, the point of a rolling body that will lie
/// deepest in the other one a sub-step later, if the present points, without their rises, would let
/// it sink in by more than the solver ever leaves alone. Rises bring bodies up no faster than they
/// come down, and a disc as thin as that would be stopped in the air (see FastBodies). The point's
/// separation is such that its present velocity brings it to where it will be.
void add_rim_ahead(const Simulation& simulation, const StepData& step, const BodyPair& pair,
                   std::size_t first, std::vector<Contact>& list);
/// Appends the same point to a body's contacts with a hyperplane in the place of the ground's face.
/// The body is the first one of the pair.
void add_rim_ahead_on_plane(const Simulation& simulation, const StepData& step, BodyId id,
                            BodyId ground, std::vector<Contact>& list);

}  // namespace tesserae
