// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/bodies/needs.hpp"
#include "core/dynamics/bodies/type_properties.hpp"
#include "core/dynamics/constraints/constraint.hpp"
#include "core/dynamics/constraints/joint.hpp"
#include "core/dynamics/contacts/contact_list.hpp"
#include "core/dynamics/solver/kernels/coloured_islands.hpp"
#include "core/dynamics/step/memory.hpp"
#include "core/dynamics/step/settings.hpp"

namespace tesserae {

/// The items begin <= i < end of a list, on which one call of a stage works. They do not depend on
/// each other, so that any split gives the same bits.
struct Range {
    std::size_t begin, end;
};

/// The ball that encloses all that a body can reach in the rest of the step.
struct Bounds {
    /// The body's position when the bounds are made, world [m]; 0 if unbounded.
    PackedVec4 centre = PackedVec4::Zero();
    double radius = 0;  ///< [m]; infinite if unbounded
};

/// Two bodies that may touch in the step, a < b.
struct BodyPair {
    BodyId a, b;

    friend auto operator<=>(const BodyPair&, const BodyPair&) = default;
};

/// The islands: groups of contacts and other constraints that share movable bodies, in the order of
/// their lowest movable body. Island k has the runs of contacts runs[first[k]] to
/// runs[first[k + 1]], and likewise its other constraints.
///
/// Runs are in ascending order of (a, b, feature). The contacts of small islands are solved in this
/// order, one by one. Large islands are coloured and solved in the order of their batches in
/// ColouredIslands.
struct Islands {
    static constexpr std::uint32_t kNotColoured = std::numeric_limits<std::uint32_t>::max();

    std::vector<std::uint32_t> first = {0};
    std::vector<std::uint32_t> runs;      ///< numbers of the runs in the list of contacts
    std::vector<std::uint32_t> contacts;  ///< number of contacts of each island
    std::vector<std::uint32_t> first_constraint = {0};
    std::vector<std::uint32_t> constraints;  ///< numbers in StepData::constraints
    std::vector<std::uint32_t> coloured;     ///< each island's place among the coloured ones, or
                                             ///< kNotColoured
    std::vector<std::uint8_t> held;          ///< of each island: contacts do not move some body
    std::vector<std::uint8_t> direct;        ///< of each island: its joints may be solved as one,
                                             ///< see JointBlock
    std::vector<std::uint8_t> conjugates;    ///< of each island: its load goes along conjugate
                                             ///< directions, see has_conjugates()
    std::vector<double> falling_mass;        ///< of each island: masses times gravity_scale [kg]
    std::vector<std::uint32_t> first_row;    ///< of each island in StepData::rows, if not coloured

    std::size_t size() const { return first.size() - 1; }
    std::span<const std::uint32_t> runs_in(std::size_t island) const {
        return std::span(runs).subspan(first[island], first[island + 1] - first[island]);
    }
    std::span<const std::uint32_t> constraints_in(std::size_t island) const {
        return std::span(constraints)
            .subspan(first_constraint[island],
                     first_constraint[island + 1] - first_constraint[island]);
    }
    /// Returns the number of an island's contacts and other constraints.
    std::uint32_t size_of(std::size_t island) const {
        return contacts[island] + first_constraint[island + 1] - first_constraint[island];
    }
    bool is_coloured(std::size_t island) const { return coloured[island] != kNotColoured; }
};

/// The sums over the contacts of one piece of the list, for the step's report.
struct ContactSums {
    std::uint64_t contacts = 0;
    double penetration = 0, sum = 0;  ///< deepest overlap and sum of all overlaps [m]
};

/// The normal velocities [m/s] at which the passes over a contact aim. The first pass is the
/// compression of an impact, or a load. The second pass follows it: the restitution, or the
/// position correction.
struct ContactTargets {
    double first = 0, second = 0;
};

/// A contact as the solver sees it. Impulses act on b, and their opposites on a.
struct ContactRow {
    Vec4 normal;             ///< unit, from a to b
    Vec4 r_a, r_b;           ///< from the centres to the contact point [m]
    Vec4 normal_response;    ///< change of the relative velocity by a unit impulse along n [1/kg]
    Mat4 tangent_mass;       ///< inverse of the response in the three tangent directions [kg]
    double slide_mass = 0;   ///< at most the inverse of the largest of these responses [kg]
    Vec4 tangent_impulse;    ///< [N s], orthogonal to the normal
    Vec4 slip_by_turning;    ///< [m/s], where there is friction
    double normal_mass = 0;  ///< inverse of the response along the normal [kg]
    ContactTargets targets;
    double normal_impulse = 0;  ///< [N s], >= 0
    double friction = 0;        ///< coefficient
    BodyId a = 0, b = 0;
};

/// The rolling or the twisting of a contact's bodies. A bivector's part that contains the normal n,
/// n ^ t, or its dual part, dual(n ^ t), is stored as the tangent t.
struct RollingPart {
    Mat4 mass;             ///< inverse of the response in the three tangent directions [kg m^2]
    double step_mass = 0;  ///< at most the inverse of the largest of these responses [kg m^2]
    Vec4 impulse;          ///< [N m s], orthogonal to the normal
};
/// The resistance to rolling and twisting at a contact.
struct RollingRow {
    double arm = 0;  ///< greatest impulse of either part per normal impulse [m]
    RollingPart rolling, twisting;
};

/// The velocities of a body.
struct BodyMotion {
    Vec4 velocity = Vec4::Zero();
    Bivector angular_velocity;

    friend BodyMotion operator+(const BodyMotion& a, const BodyMotion& b) {
        return {a.velocity + b.velocity, a.angular_velocity + b.angular_velocity};
    }
    friend BodyMotion operator-(const BodyMotion& a, const BodyMotion& b) {
        return {a.velocity - b.velocity, a.angular_velocity - b.angular_velocity};
    }
    friend BodyMotion operator*(double k, const BodyMotion& m) {
        return {k * m.velocity, k * m.angular_velocity};
    }
};

/// What solve_impact() has to solve of an island: kPatch means that the island is a patch of a
/// large one, see ImpactPatches.
enum class Awaits : std::uint8_t { kNothing, kImpact, kPatch };

/// The motion of a body before an impact and after its compression.
struct ImpactMotion {
    BodyMotion before, compressed;
};

/// The bodies as they were after the last finished step, and what is computed from them once.
struct Simulation {
    Bodies bodies;
    StepMemory memory;
    PhysicsSettings settings;
    std::vector<TypeProperties> types;  ///< by body type
    Joints joints;
    Needs needs;
    std::vector<Wrench> forces;  ///< on every body, about its centre [N, N m]; empty where none act

    const TypeProperties& type_of(BodyId id) const { return types[bodies.type[id]]; }
    /// Returns whether contacts can change the motion of a body; kWorld never moves.
    bool is_movable(BodyId id) const { return id != kWorld && type_of(id).movable; }
};

/// The data that the stages of one step hand on. Their values do not survive the step, but their
/// storage does. Where nothing turns, the rotors and angular velocities of the first step stay, as
/// they never change.
struct StepData {
    double dt = 0;    ///< [s]
    double h = 0;     ///< length of a sub-step [s]
    double kick = 0;  ///< speed that gravity adds in a sub-step [m/s]
    int substep = 0;  ///< 0 to settings.substeps - 1

    std::vector<Vec4> position;  ///< of every body, on its way from the last state to the next
    std::vector<Rotor> rotor;
    std::vector<Vec4> velocity;
    std::vector<Bivector> angular_velocity;

    /// Inverse inertia in world axes in the middle of the sub-step, of bodies that are awake and
    /// not isotropic.
    std::vector<BivectorMap> inverse_inertia;

    std::vector<Bounds> bounds;           ///< of every body
    std::vector<BodyPair> pairs;          ///< ascending
    ContactList contacts;                 ///< ascending (a, b, feature)
    std::vector<Constraint> constraints;  ///< all but contacts, of bodies that are awake
    std::vector<Wrench> joint_impulses;   ///< of every joint's part, the last sub-step's at first
    std::vector<Wrench> part_sums;        ///< of every joint's part: all impulses of the step
    std::vector<Wrench> joint_sums;       ///< of every joint: all impulses of the last step
    Islands islands;
    bool rows_in_use = false;  ///< rows are in use: from build_islands() to the end of the sub-step
    std::vector<ContactRow> rows;          ///< of islands that are not coloured
    std::vector<RollingRow> rolling_rows;  ///< of `rows`, where there is rolling friction
    ColouredIslands coloured;              ///< the islands that are coloured
    std::vector<ContactImpulse> impulses;  ///< of every contact, the last sub-step's at first
    std::vector<double> hit;               ///< of every contact: the normal impulse of an impact
                                           ///< [N s], >= 0
    /// For every contact, where there are rims: see rise_of() and slip_on_rim().
    std::vector<double> rises;
    std::vector<Vec4> rim_slips;
    std::vector<std::uint8_t> company;  ///< of every body, for rims: see count_company()
    KeptImpulses warm_start;  ///< impulses that a sub-step leaves to the next one of the step
    /// The angular impulses to `impulses` and `warm_start`, where there is rolling friction; see
    /// StepMemory.
    std::vector<Bivector> angular_impulses, warm_start_angular;
    std::vector<KeptManifolds> kept, last_kept;  ///< those of this sub-step and of the last one
    std::vector<std::uint8_t> corrected;         ///< of every island: see is_corrected()
    std::vector<double> residual;                ///< of every island [m/s]
    std::vector<int> sweeps;  ///< of every island, and of the patches of impacts behind them: the
                              ///< most of any of its solves
    std::vector<BodyId> asleep;     ///< as in StepMemory, but now
    std::vector<ContactSums> sums;  ///< of every piece of kReportPiece contacts

    /// Lists that are made and used within one stage. They are here so that their memory is kept.
    KeptImpulses merged_impulses;
    std::vector<Bivector> merged_angular;
    std::vector<BodyId> lowest_of_island, next_asleep;
    std::vector<ImpactMotion> impact_motion;  ///< of every body, where there is restitution
    // Two places for each of `rows` and `constraints`: an island's bodies, and their motion before
    // its impulses.
    std::vector<BodyId> bodies_of_rows;
    std::vector<BodyMotion> motions_of_rows;
    std::vector<std::uint8_t> has_rows;  ///< of every island: its rows are made
    std::vector<std::uint8_t> was_hit;   ///< of every island: there was an impact
    std::vector<Awaits> awaits;          ///< of every island
    std::vector<std::uint32_t> filled;   ///< which of the last kept lists are not empty

    /// Returns the number of contacts and other constraints that are solved with an island: those
    /// of its group if it is the first of one, none if it is another.
    std::uint32_t size_of_group(std::size_t island) const {
        if (!islands.is_coloured(island)) return islands.size_of(island);
        const std::uint32_t place = islands.coloured[island], group = coloured.group[place];
        std::uint32_t size = 0;
        for (std::uint32_t i = place; coloured.leads(place) && i < coloured.first_member[group + 1];
             ++i)
            size += islands.size_of(coloured.islands[i]);
        return size;
    }
};

/// Gives the memory of all rows back. They must not be in use.
inline void release_rows(StepData& step) {
    step.coloured = {};
    std::vector<ContactRow>().swap(step.rows);
    std::vector<RollingRow>().swap(step.rolling_rows);
    std::vector<Constraint>().swap(step.constraints);
}

/// Returns the key by which contacts and their impulses are in ascending order.
template <class ContactOrImpulse>
auto key_of(const ContactOrImpulse& c) {
    return std::tuple(c.a, c.b, c.feature);
}

/// Returns the impulses that the sub-step before this one left.
inline const KeptImpulses& last_impulses(const Simulation& simulation, const StepData& step) {
    return step.substep == 0 ? simulation.memory.impulses : step.warm_start;
}

/// Returns the angular impulses that the sub-step before this one left.
inline const std::vector<Bivector>& last_angular_impulses(const Simulation& simulation,
                                                          const StepData& step) {
    return step.substep == 0 ? simulation.memory.angular_impulses : step.warm_start_angular;
}

/// Returns the change of a body's angular velocity by an angular impulse [N m s, world] in this
/// sub-step, by the inertia of its type and rotor. It is always inlined: a call in every row of
/// every sweep would slow the step.
[[gnu::always_inline]] inline Bivector angular_response(const Simulation& simulation,
                                                        const StepData& step, BodyId id,
                                                        const Bivector& impulse) {
    const TypeProperties& type = simulation.type_of(id);
    if (type.isotropic) return type.inverse_inertia.xy * impulse;
    const BivectorMap& map = step.inverse_inertia[id];
    Eigen::Matrix<double, 8, 1> sum = impulse.xy * map.col(0);
    sum += impulse.xz * map.col(1);
    sum += impulse.xw * map.col(2);
    sum += impulse.yz * map.col(3);
    sum += impulse.yw * map.col(4);
    sum += impulse.zw * map.col(5);
    return {sum[0], sum[1], sum[2], sum[3], sum[4], sum[5]};
}

/// Returns by how much faster a contact's surfaces come together than its two points, until the
/// middle of the next sub-step [m/s]: see aim_rims().
inline double rise_of(const StepData& step, std::size_t contact) {
    return step.rises.empty() ? 0 : step.rises[contact];
}

inline BodyMotion motion_of(const StepData& step, BodyId id) {
    return {step.velocity[id], step.angular_velocity[id]};
}

inline bool is_asleep(const StepData& step, BodyId id) {
    return !step.asleep.empty() && step.asleep[id] != kAwake;
}

/// Returns whether a body moves at a velocity of its own, which contacts do not change.
inline bool is_driven(const Simulation& simulation, BodyId id) {
    if (!simulation.type_of(id).fixed) return false;
    const Bodies& bodies = simulation.bodies;
    const BodyType& type = bodies.type_of(id);
    return (type.fixed_position && bodies.velocity[id] != Vec4::Zero()) ||
           (type.fixed_rotation && !(bodies.angular_velocity[id] == Bivector{}));
}

}  // namespace tesserae
