#pragma once

#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/constraints/point_joint.hpp"

namespace tesserae {

/// The kinds of joints. Each has a file of its own with a function pose(), and this list names it.
using JointKind = std::variant<PointJoint>;

/// A joint between two bodies. Contacts can move at least one of them.
struct Joint {
    BodyId a = 0, b = 0;
    JointKind kind;
    bool collide = false;  ///< the two bodies have contacts with each other, too
};

/// The joints of a scene, and what follows from them once.
struct Joints {
    std::vector<Joint> all;
    std::vector<std::pair<BodyId, BodyId>> apart;  ///< pairs without contacts: low, high; ascending
    /// For every body the lowest of the movable bodies that joints connect it with, by any way;
    /// empty if there are no joints.
    std::vector<BodyId> group;
    std::vector<BodyId> members;  ///< all bodies, ascending by group

    bool empty() const { return all.empty(); }
    /// Returns the movable bodies that joints connect with a body, by any way. It is one of them.
    std::span<const BodyId> connected_with(BodyId id) const;
};

/// Returns the joints of some bodies.
/// @throws InputError   a joint names a body that does not exist, one body twice, or two bodies
///                      that contacts do not move
Joints make_joints(std::vector<Joint> all, const Bodies& bodies);

/// Lists the joints of bodies that are awake in step.constraints, without what pose_joints() sets.
void list_joints(const Simulation& simulation, StepData& step);
/// Poses the constraints in the range, with their last impulses, for the middle of the sub-step.
///
/// A joint aims at no error in the middle of the next sub-step. Until then bodies go straight on
/// and turn freely, so that the aim counts how their anchors' ways bend. Together with the
/// sub-step this is SHAKE (Ryckaert, Ciccotti, Berendsen, J. Comput. Phys. 23, 1977), of second
/// order, which neither gains nor loses energy on the whole.
void pose_joints(const Simulation& simulation, StepData& step, std::size_t begin, std::size_t end);

/// Removes the pairs of jointed bodies that do not collide from step.pairs.
void leave_jointed_pairs_out(const Simulation& simulation, StepData& step);

}  // namespace tesserae
