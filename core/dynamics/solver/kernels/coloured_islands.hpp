// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/contact/manifold.hpp"
#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/solver/members.hpp"
#include "core/simd/simd.hpp"

namespace tesserae {

using simd::kLanes;

/// One float for each lane of a batch.
struct alignas(32) Eight {
    std::array<float, kLanes> lane = {};
};

/// One number for each lane in half the memory, to one part in 500, see simd::to_half(). It is for
/// numbers that only decide how fast sweeps converge, and not to which solution.
struct alignas(16) RoughEight {
    std::array<std::uint16_t, kLanes> lane = {};
};

// The data of coloured islands, in float: velocities as changes since the sub-step's start,
// impulses, and rows of eight contacts. Impulses and masses are in units of
// ColouredIslands::mass_unit, so that neither leaves float's range.

/// The record of one body: its changes of velocity and its inverse mass. The first record stands
/// for all bodies that contacts do not move and is all zero.
struct alignas(64) BodyChange {
    std::array<float, 4> velocity = {};      ///< [m/s]
    std::array<float, 4> first_planes = {};  ///< angular velocity: xy xz xw yz [rad/s]
    /// yw, zw, inverse mass [1/mass unit] and, if isotropic, inverse inertia.
    std::array<float, 4> rest = {};
};

/// A body's changes of velocity alone, in as little memory as possible.
struct PackedChange {
    std::array<float, 4> velocity = {}, first_planes = {};
    std::array<float, 2> rest = {};
};

/// The number of bodies of a coloured island whose sums are added up as one piece: it is the same
/// for any number of threads.
constexpr std::size_t kSumPiece = 64;
using BodySums = std::array<double, 3>;

/// A body's inverse inertia in world axes: the upper triangle of a symmetric 6x6 matrix, row by
/// row.
struct alignas(32) InverseInertia {
    std::array<std::array<float, 4>, 6> entry = {};  ///< three unused
};
/// A body's inertia in world axes, column by column.
struct alignas(32) BodyInertia {
    std::array<std::array<float, 8>, 6> column = {};  ///< two rows unused
};

/// Eight pairs of bodies that share no movable body. Lanes beyond the last pair are all zero.
struct Batch {
    std::array<std::uint32_t, kLanes> a = {}, b = {};  ///< places in ColouredIslands::bodies
    std::array<std::uint32_t, kLanes> contact = {};    ///< each pair's first
    std::array<std::uint8_t, kLanes> points = {};      ///< each pair's number of contacts
    std::array<std::uint8_t, kLanes> member = {};      ///< each pair's island, of its group
    Members members;                                   ///< all of these
    std::uint32_t row = 0;                             ///< first of its rows
    std::uint32_t rows = 0;                            ///< the most points of a lane
    std::uint32_t response = 0;  ///< first of its point responses, see responses_of()
    bool slides = false;         ///< some point slid in the last sweep
};

/// Returns the number of points for which the kernels are compiled that a batch with so many rows
/// takes.
constexpr std::uint32_t padded_points(std::uint32_t rows) {
    return rows > 4 ? 8 : rows > 2 ? 4 : rows;
}
static_assert(kManifoldPoints == 8);
/// Returns the number of responses of points to each other in a batch with so many rows: the lower
/// triangle of a symmetric matrix, row by row.
constexpr std::uint32_t responses_of(std::uint32_t rows) {
    return padded_points(rows) * (padded_points(rows) + 1) / 2;
}

/// The normal part of a row: its mass and the target of the first pass, see ContactTargets. The
/// normal velocity of the start is subtracted from all targets.
struct NormalRow {
    Eight mass, target;
};

/// The impulses on b of rows with so many tangents, without rolling: along the normal, and across
/// it if there is friction.
template <std::size_t kTangents, class Lanes = Eight>
struct RowImpulses {
    std::vector<Lanes> normal;
    std::vector<std::array<Lanes, kTangents>> tangent;
};

/// A contact of two round bodies, or of one and a body that contacts do not move. The normal goes
/// through both centres: the normal impulse turns nothing, and the response is the same along every
/// tangent.
struct RoundRow {
    std::array<Eight, 4> normal;
    NormalRow along;
};
struct RoundFriction {
    Eight arm_a, arm_b;  ///< from the centres to the contact point, along n and against it [m]
    Eight friction, mass;
    std::array<Eight, 4> slip;  ///< slip at the start [m/s]
};

/// Rolling and twisting of a round pair together, as bivectors.
struct RoundRolling {
    Eight arm;                     ///< see RollingRow
    Eight mass;                    ///< the same for rolling and twisting, about any plane
    std::array<Eight, 6> turning;  ///< angular velocity of b relative to a at the start [rad/s]
    std::array<Eight, 6> impulse;  ///< on b
};

/// The frame of all points of a pair. Its centre is the mean of the points, as high along the
/// normal as the deepest. The reflection v - (h.v) h, with |h|^2 = 2, takes the normal n to g w,
/// where g = -1 if h_w >= 0, else 1, and the tangents to x, y, z. Motion "along the normal" is the
/// velocity along n and the turning in xn, yn, zn, on which normal impulses act.
struct PairFrame {
    std::array<Eight, 4> h;
    std::array<Eight, 4> centre_a, centre_b;  ///< from the bodies' centres [m]
    std::array<Eight, 4> motion;              ///< of b relative to a at the start, along the normal
};
/// The entries of InverseInertia for each lane, of bodies that are not isotropic.
using LaneInertia = std::array<Eight, 21>;
struct PairInertia {
    LaneInertia a, b;
};
/// The response of the motion across the normal, on which friction acts: the velocity along x, y, z
/// and the turning in xy, xz, yz. It is not rounded as masses are: the rounding of a slender body's
/// response to a moment about its length would exceed the response to any other.
struct AcrossResponse {
    std::array<Eight, 21> across;               ///< to impulses across the normal: symmetric
    std::array<std::array<Eight, 6>, 4> along;  ///< to impulses along the normal
};
struct PairFriction {
    Eight friction;
    std::array<Eight, 6> motion;  ///< of b relative to a at the start, across the normal
    AcrossResponse response;
};
/// A contact of any two bodies. Its height over the frame's centre is left out: the points of one
/// pair that bear a load lie in one plane, apart from their overlaps.
struct GeneralRow {
    std::array<Eight, 3> at;  ///< from the frame's centre [m]
    NormalRow along;
};
struct GeneralFriction {
    std::array<RoughEight, 6> mass;  ///< xx xy xz yy yz zz
    RoughEight slide_mass;           ///< below the inverse of the largest response
};

/// The rolling of a pair, in the planes xn, yn, zn, and its twisting, in xy, xz, yz.
struct PairRolling {
    Eight arm;                                         ///< see RollingRow
    std::array<Eight, 10> response;                    ///< to impulses along the normal: symmetric
    std::array<Eight, 6> rolling_mass, twisting_mass;  ///< 11 12 13 22 23 33
    Eight rolling_step, twisting_step;                 ///< see RollingPart
};
struct GeneralRolling {
    std::array<Eight, 6> impulse;  ///< on b; rolling, then twisting
};

/// The batches begin <= i < end of a list.
struct BatchRange {
    std::uint32_t begin, end;
};
/// The batches of one colour, and its constraints that are no contacts.
struct ColourBatches {
    BatchRange round, general, others;
};

/// The coloured islands of a sub-step, one behind the other: their bodies, their batches in order
/// of colours, and a row for each point of a batch.
///
/// Small islands are in groups, whose pairs share batches: an island alone would leave most lanes
/// empty. In a group the pairs of a batch have equally many points, so that what happens to an
/// island does not depend on the others of its group. A large island is a group by itself.
struct ColouredIslands {
    bool friction = false;                  ///< some body has friction; else there are no such rows
    bool rolling = false;                   ///< some body has rolling friction, likewise
    bool turns_unevenly = false;            ///< some body is not isotropic
    std::vector<std::uint32_t> islands;     ///< number of every coloured island among all
    std::vector<std::uint32_t> group;       ///< of every coloured island
    std::vector<std::uint32_t> first_body;  ///< of every coloured island, and an end
    std::vector<double> mass_unit;          ///< of every coloured island, a power of two [kg]
    std::vector<std::uint32_t> first_member;   ///< of every group, in `islands`, and an end
    std::vector<std::uint32_t> first_colour;   ///< likewise; each last colour has what is left over
    std::vector<std::uint8_t> shares_batches;  ///< of every group: its islands are small
    std::vector<BodyId> bodies;
    std::vector<ColourBatches> colours;
    std::vector<Batch> round, general;
    std::vector<std::uint32_t> others;  ///< constraints in order of colours: numbers in
                                        ///< StepData::constraints
    std::uint32_t general_rows = 0, point_responses = 0;  ///< of `general`, in all

    std::vector<BodyChange> changes;  ///< of `bodies`
    // State of the present pair of sweeps, see conjugate.hpp: changes and impulses at its start, x,
    // and the direction, p; and the changes by the warm start, see take_warm_start().
    std::vector<PackedChange> last_changes, direction, warm_start;
    std::vector<BodySums> body_sums;  ///< of pieces of each island's `bodies`
    RowImpulses<4> last_round;
    RowImpulses<3> last_general;
    RowImpulses<4> round_direction;
    RowImpulses<3> general_direction;
    std::vector<std::array<double, 2>> round_work, general_work;  ///< sums of each batch
    // The same for each lane, of groups whose islands share batches.
    std::vector<std::array<Eight, 2>> round_lane_work, general_lane_work;
    std::vector<Eight> round_left, general_left;     ///< velocities left to solve in the last sweep
                                                     ///< that was measured, of each lane [m/s]
    std::vector<std::array<double, 2>> others_work;  ///< likewise, of each of `others`
    // Inertias of `bodies`, if any turns unevenly.
    std::vector<InverseInertia> inverse_inertias;
    std::vector<BodyInertia> inertias;          ///< for directions
    RowImpulses<4> round_impulses;              ///< of `round`, in world axes
    RowImpulses<3> impulses;                    ///< of `rows`, in the frames
    std::vector<RoundRow> round_rows;           ///< of `round`
    std::vector<Eight> round_second;            ///< likewise: the second pass's targets
    std::vector<RoundFriction> round_friction;  ///< of `round`
    std::vector<RoundRolling> round_rolling;    ///< likewise
    std::vector<PairFrame> frames;              ///< of `general`
    std::vector<PairInertia> pair_inertias;     ///< likewise, if any turns unevenly
    std::vector<PairFriction> pair_friction;    ///< likewise
    std::vector<GeneralRow> rows;               ///< of `general`, see Batch::row
    std::vector<Eight> second;                  ///< likewise: the second pass's targets
    /// Point responses of `general`, see Batch::response: the change of the normal velocity at one
    /// point by a unit normal impulse at another; 0 for points that a batch does not have.
    std::vector<RoughEight> point_response;
    std::vector<GeneralFriction> general_friction;  ///< likewise
    std::vector<PairRolling> pair_rolling;          ///< of `general`
    std::vector<GeneralRolling> general_rolling;    ///< of `rows`

    /// Returns whether the island of this place is the first of its group.
    bool leads(std::uint32_t place) const { return first_member[group[place]] == place; }
    /// Returns whether it may share batches with others.
    bool shares(std::uint32_t place) const { return shares_batches[group[place]] != 0; }
};

}  // namespace tesserae
