// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/body_id.hpp"
#include "core/dynamics/constraints/wrench.hpp"

// The type of all constraints. A contact, its friction and its rolling are constraints of one pair
// each, and have rows and kernels of their own (ContactRow, RollingRow), which are faster. All
// other kinds are posed as a Constraint, and the functions of this file solve them.
// Constraint.SolvesContactsAsTheirOwnRowsDo holds both ways against each other.
namespace tesserae {

struct BodyMotion;
struct Simulation;
struct StepData;

/// The most rows of a constraint: two bodies move relative to each other in 4 + 6 ways.
constexpr int kMostRows = 10;

/// One number for each row of a constraint.
using RowVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostRows, 1>;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostRows, kMostRows>;

/// The set that holds the impulses of a constraint.
enum class ImpulseSet : std::uint8_t {
    kAll,       ///< all impulses: a joint
    kHalfLine,  ///< each row's is at least 0: a contact, a limit
    kBall,      ///< together at most `most` long: friction, rolling, twisting
    kBox,       ///< each row's is at most `most` in size: a motor, a spring
};

/// A constraint of the motion of body b relative to body a, as the solver sees it. Each row is a
/// unit Wrench. Its velocity is the work of this wrench per time: the part of the relative motion
/// along the row.
struct Constraint {
    BodyId a = 0, b = 0;
    Vec4 r_a = Vec4::Zero(), r_b = Vec4::Zero();  ///< from the centres to the anchor [m]
    ImpulseSet set = ImpulseSet::kAll;
    double most = 0;  ///< see ImpulseSet
    /// Velocity by which a row gives way per impulse on it [1/kg, 1/(kg m^2)].
    double compliance = 0;
    int size = 0;              ///< number of rows
    bool holds_point = false;  ///< its rows are unit forces along the world's axes: all of a point
    std::array<Wrench, kMostRows> rows;
    RowVector bias;  ///< velocities at which a load aims [m/s, rad/s]

    // What the solver keeps: see set_response() and ConstraintRows.
    RowMatrix response, mass;  ///< change of the rows' velocities by unit impulses, and its inverse
    double step_mass = 0;      ///< at most the inverse of the largest response
    RowVector aim;             ///< bias, less the velocities that the bodies' motion leaves out
    RowVector impulse;         ///< [N s, N m s]
    RowVector last_impulse, direction;       ///< see conjugate.hpp
    std::uint32_t place_a = 0, place_b = 0;  ///< where the solver finds the bodies' motion
    std::uint32_t joint = 0;                 ///< number of the joint that it is of
    std::uint32_t part = 0;                  ///< and which part of all joints, see Joints
    bool in_block = false;                   ///< it is solved by a JointBlock, not by sweeps
    bool starts_anew = false;                ///< its load has no warm start

    /// Returns whether it holds bodies whatever it takes. Only then does it act in an impact, and
    /// in a position correction: the impulse of a force that is limited is nothing there.
    bool is_firm() const { return set == ImpulseSet::kAll || set == ImpulseSet::kHalfLine; }
};

/// Sets the response and the masses, in the middle of the sub-step.
void set_response(const Simulation& simulation, const StepData& step, Constraint& constraint);

/// Returns the velocities of the rows at some motion of the bodies.
RowVector row_velocities(const Constraint& constraint, const BodyMotion& a, const BodyMotion& b);

/// Returns the impulses of all rows together.
Wrench wrench_of(const Constraint& constraint, const RowVector& impulses);
/// Returns the rows' impulses nearest to a wrench that the set allows.
RowVector impulses_of(const Constraint& constraint, const Wrench& wrench);

/// Returns the changes of the motion of a and b by impulses of the rows.
std::array<BodyMotion, 2> motion_by(const Simulation& simulation, const StepData& step,
                                    const Constraint& constraint, const RowVector& impulses);

/// Does one step towards the aim for all rows together.
/// @param velocities   of the rows
/// @return the change of the impulses
RowVector solve_rows(Constraint& constraint, const RowVector& velocities);

}  // namespace tesserae
