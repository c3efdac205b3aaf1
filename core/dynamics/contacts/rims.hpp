#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// step.company: how many other bodies that contacts move each one touches, up to two. What carries
/// or leans on others does not roll freely.
void count_company(const Simulation& simulation, StepData& step);

/// step.rises and step.rim_slips of the contacts of the runs in the range.
///
/// As a round body turns, the point at which it touches runs along its rim: that of a coin that
/// wobbles down many times faster than its material moves there. Between the middles of two
/// sub-steps the surfaces come nearer than the points do that touch in the first, and the rim sinks
/// in; friction that ends the slip of these points, not of those that come to touch, drives it on.
/// So both aims are those of the way from one middle to the next, as the body turns freely: of
/// second order in the time step, and, as they look the same backwards in time, without gain or
/// loss of energy on the whole. Along the normal that is SHAKE (Ryckaert, Ciccotti, Berendsen, J.
/// Comput. Phys. 23, 1977).
void aim_rims(const Simulation& simulation, StepData& step, Range runs);

/// What the point of a rim ahead is called: after all other points of a pair.
constexpr std::uint32_t kRimAhead = 0xffffffff;

/// Appends to a pair's contacts, which begin at `first`, the point of a body that rolls on the
/// other which will lie deepest in that a sub-step later, if those that there are, without their
/// rises, let it sink in by more than is ever left alone: rises bring bodies up no faster than they
/// come down, and a disc as thin as that would be stopped in the air (see Impacts). Its separation
/// is such that it comes to where it will be at its present velocity.
void add_rim_ahead(const Simulation& simulation, const StepData& step, const BodyPair& pair,
                   std::size_t first, std::vector<Contact>& list);
/// The same of a body's contacts, as the first one of a pair, with a hyperplane in the place of the
/// ground's face.
void add_rim_ahead_on_plane(const Simulation& simulation, const StepData& step, BodyId id,
                            BodyId ground, std::vector<Contact>& list);

}  // namespace tesserae
