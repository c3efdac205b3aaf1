// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/constraints/frame_joint.hpp"
#include "core/dynamics/constraints/joint_description.hpp"
#include "core/dynamics/constraints/line_joint.hpp"
#include "core/dynamics/constraints/point_joint.hpp"

namespace tesserae {

/// The kinds of joints. Each has a file with its coordinates, and this list names it.
using JointKind = std::variant<PointJoint, LineJoint, FrameJoint>;

static_assert(FrameJoint::kSize == kJointCoordinates);

/// Keeps a coordinate between two values.
struct JointLimit {
    int coordinate = 0;
    double low = -kNoLimit, high = kNoLimit;  ///< [m, rad]
};

/// Drives a coordinate by the force stiffness (target - q) + damping (speed - dq/dt), or with no
/// more force than `most` to just the speed.
struct JointDrive {
    int coordinate = 0;
    double target = 0, speed = 0;       ///< [m, m/s; rad, rad/s]
    double stiffness = 0, damping = 0;  ///< [N/m, N s/m; N m, N m s]
    bool holds_speed = false;           ///< whatever damping it takes
    double most = kNoLimit;             ///< greatest force or moment [N, N m]
};

/// All coordinates of a joint, as bits.
constexpr std::uint16_t kAllHeld = 0x3ff;

/// A joint between two bodies, or the world and a body. Contacts can move at least one of them.
struct Joint {
    BodyId a = kWorld, b = 0;
    JointKind kind;
    bool collide = false;           ///< the two bodies have contacts with each other, too
    std::uint16_t held = kAllHeld;  ///< a bit for each coordinate that is held at 0
    std::vector<JointLimit> limits = {};
    std::vector<JointDrive> drives = {};
    double break_force = kNoLimit, break_torque = kNoLimit;  ///< [N, N m]
};

/// The joints of a scene, and what follows from those that are not broken.
struct Joints {
    std::vector<Joint> all;
    /// The constraints of joint i are its parts first_part[i] to first_part[i + 1]: what it holds,
    /// its limits, and each of its drives.
    std::vector<std::uint32_t> first_part = {0};
    std::vector<std::uint8_t> broken;              ///< of every joint, or none: see StepMemory
    std::vector<std::pair<BodyId, BodyId>> apart;  ///< pairs without contacts: low, high; ascending
    /// For every body the lowest of the movable bodies that joints connect it with, by any way;
    /// empty if there are no joints.
    std::vector<BodyId> group;
    std::vector<BodyId> members;  ///< all bodies, ascending by group
    /// Of every joint: 1 if the joints of its group make a loop. All that does not move is one
    /// body.
    std::vector<std::uint8_t> in_loop;

    bool empty() const { return all.empty(); }
    std::size_t parts() const { return first_part.back(); }
    bool is_broken(std::size_t joint) const { return !broken.empty() && broken[joint] != 0; }
    /// Returns the movable bodies that joints connect with a body, by any way. It is one of them.
    std::span<const BodyId> connected_with(BodyId id) const;
};

/// Returns the joints of some bodies.
/// @throws InputError   a joint names a body that does not exist, one body twice, or two bodies
///                      that contacts do not move
Joints make_joints(std::vector<Joint> all, const Bodies& bodies);
/// Sets which joints are broken, and what follows from it.
void set_broken(Joints& joints, const Bodies& bodies, std::vector<std::uint8_t> broken);

/// Returns the number of a joint's coordinates.
int size_of(const Joint& joint);
/// Returns a bit for each coordinate that a joint holds.
std::uint16_t held_of(const Joint& joint);
/// Returns the coordinates of a joint where its bodies are.
Coordinates coordinates_of(const Joint& joint, const Bodies& bodies);

/// Returns the mass, or moment of inertia, with which two bodies resist a force along a coordinate
/// of their joint, where they are: what a spring's stiffness follows from its frequency by.
double mass_along(const Joint& joint, int coordinate, const Bodies& bodies);

/// Removes the pairs of jointed bodies that do not collide from step.pairs.
void leave_jointed_pairs_out(const Simulation& simulation, StepData& step);

/// Sums what the sub-steps' impulses of every joint were in a step, in step.joint_sums, and writes
/// the joints that broke by them to the memory.
void break_joints(Simulation& simulation, StepData& step);

}  // namespace tesserae
