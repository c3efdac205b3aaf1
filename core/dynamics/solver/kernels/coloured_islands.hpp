#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/contact/manifold.hpp"
#include "core/dynamics/bodies/bodies.hpp"
#include "core/simd/simd.hpp"

namespace tesserae {

using simd::kLanes;

struct alignas(32) Eight {
    std::array<float, kLanes> lane = {};
};

/// The same in half the memory, to one part in 500: of what only decides how fast sweeps come
/// nearer to the solution, and not which one it is. See simd::to_half().
struct alignas(16) RoughEight {
    std::array<std::uint16_t, kLanes> lane = {};
};

// What the coloured solver keeps of a coloured island: velocities as changes since the sub-step's
// start, impulses, and rows of eight contacts, in float. Impulses and masses are in units of
// ColouredIslands::mass_unit, so that neither leaves float's range.

/// One body's record. The first one stands for all bodies that contacts do not move, all zero.
struct alignas(64) BodyChange {
    std::array<float, 4> velocity = {};      ///< [m/s]
    std::array<float, 4> first_planes = {};  ///< angular velocity: xy xz xw yz [rad/s]
    /// yw, zw, inverse mass [1/mass unit] and, if isotropic, inverse inertia.
    std::array<float, 4> rest = {};
};

/// The same without the masses, in as little memory as it takes.
struct PackedChange {
    std::array<float, 4> velocity = {}, first_planes = {};
    std::array<float, 2> rest = {};
};

/// Bodies of a coloured island whose sums are added up at once: the same for any number of threads.
constexpr std::size_t kSumPiece = 64;
using BodySums = std::array<double, 3>;

/// Inverse world inertia: the upper triangle of a symmetric 6x6 matrix, row by row.
struct alignas(32) InverseInertia {
    std::array<std::array<float, 4>, 6> entry = {};  ///< three unused
};
/// World inertia, column by column.
struct alignas(32) BodyInertia {
    std::array<std::array<float, 8>, 6> column = {};  ///< two rows unused
};

/// Eight pairs of bodies that share no movable body; lanes beyond the last pair are all zero.
struct Batch {
    std::array<std::uint32_t, kLanes> a = {}, b = {};  ///< places in ColouredIslands::bodies
    std::array<std::uint32_t, kLanes> contact = {};    ///< each pair's first
    std::array<std::uint8_t, kLanes> points = {};      ///< each pair's contacts
    std::uint32_t row = 0;                             ///< first of its rows
    std::uint32_t rows = 0;                            ///< the most points of a lane
    std::uint32_t response = 0;  ///< first of its point responses, see responses_of()
    bool slides = false;         ///< any of its points did in the last sweep
};

/// Points that a batch with so many rows is worked on as if it had.
constexpr std::uint32_t padded_points(std::uint32_t rows) {
    return rows > 4 ? 8 : rows > 2 ? 4 : rows;
}
static_assert(kManifoldPoints == 8);
/// How many responses of points to each other such a batch has: the lower triangle of a symmetric
/// matrix, row by row.
constexpr std::uint32_t responses_of(std::uint32_t rows) {
    return padded_points(rows) * (padded_points(rows) + 1) / 2;
}

/// The normal part of a row: its mass and the target of the first pass, see ContactTargets. All
/// targets are less the normal velocity of the start.
struct NormalRow {
    Eight mass, target;
};

/// Impulses on b of rows with so many tangents, but for rolling: along the normal, and across it
/// if there is friction.
template <std::size_t kTangents, class Lanes = Eight>
struct RowImpulses {
    std::vector<Lanes> normal;
    std::vector<std::array<Lanes, kTangents>> tangent;
};

/// A contact of two round bodies (or of one and a body that contacts do not move): the normal goes
/// through both centres, so that the normal impulse turns nothing and the response is the same
/// along every tangent.
struct RoundRow {
    std::array<Eight, 4> normal;
    NormalRow along;
};
struct RoundFriction {
    Eight arm_a, arm_b;  ///< from the centres to the contact point, along n and against it [m]
    Eight friction, mass;
    std::array<Eight, 4> slip;  ///< of the start [m/s]
};

/// Rolling and twisting of a round pair together, as bivectors.
struct RoundRolling {
    Eight arm;                     ///< see RollingRow
    Eight mass;                    ///< the same for rolling and twisting, about any plane
    std::array<Eight, 6> turning;  ///< of b against a at the start [rad/s]
    std::array<Eight, 6> impulse;  ///< on b
};

/// Of all points of each pair: their frame, whose centre is in the midst of them and as high along
/// the normal as the deepest. The reflection v - (h.v) h, with |h|^2 = 2, takes the normal n to
/// g w, where g = -1 if h_w >= 0, else 1, and the tangents to x, y, z. Along the normal are the
/// velocity along n and the turning in xn, yn, zn: what normal impulses change and see.
struct PairFrame {
    std::array<Eight, 4> h;
    std::array<Eight, 4> centre_a, centre_b;  ///< from the bodies' centres [m]
    std::array<Eight, 4> motion;              ///< of b against a at the start, along the normal
};
/// Of bodies that do not turn alike in all planes: what InverseInertia has of each lane's.
using LaneInertia = std::array<Eight, 21>;
struct PairInertia {
    LaneInertia a, b;
};
/// What impulses do to the motion across the normal, which friction changes and sees: the velocity
/// along x, y, z and the turning in xy, xz, yz.
template <class Lanes>
struct AcrossResponse {
    std::array<Lanes, 21> across;               ///< of impulses across the normal: symmetric
    std::array<std::array<Lanes, 6>, 4> along;  ///< of those along it
};
struct PairFriction {
    Eight friction;
    std::array<Eight, 6> motion;  ///< of b against a at the start, across the normal
    AcrossResponse<RoughEight> response;
};
/// A contact of any two bodies. Its height above the frame's centre is left out: points of one pair
/// that bear a load are in one plane, but for their overlaps.
struct GeneralRow {
    std::array<Eight, 3> at;  ///< from the frame's centre [m]
    NormalRow along;
};
struct GeneralFriction {
    std::array<RoughEight, 6> mass;  ///< xx xy xz yy yz zz
    RoughEight slide_mass;           ///< below the inverse of the largest response
};

/// Rolling, which turns in xn, yn, zn, and twisting, in xy, xz, yz.
struct PairRolling {
    Eight arm;                                         ///< see RollingRow
    std::array<Eight, 10> response;                    ///< to impulses along the normal: symmetric
    std::array<Eight, 6> rolling_mass, twisting_mass;  ///< 11 12 13 22 23 33
    Eight rolling_step, twisting_step;                 ///< see RollingPart
};
struct GeneralRolling {
    std::array<Eight, 6> impulse;  ///< on b; rolling, then twisting
};

/// Batches begin <= i < end.
struct BatchRange {
    std::uint32_t begin, end;
};
struct ColourBatches {
    BatchRange round, general;
};

/// The coloured islands of a sub-step, one behind the other: their bodies, their batches in order
/// of colours, and a row for each point of a batch.
struct ColouredIslands {
    bool friction = false;                  ///< of any body type; else there are no such rows
    bool rolling = false;                   ///< likewise of rolling friction
    bool turns_unevenly = false;            ///< any body is not isotropic
    bool slender = false;                   ///< any body is: see kSlender
    std::vector<std::uint32_t> first_body;  ///< of every coloured island, and an end
    std::vector<std::uint32_t>
        first_colour;               ///< likewise; an island's last one is what is left over
    std::vector<double> mass_unit;  ///< of every coloured island, a power of two [kg]
    std::vector<BodyId> bodies;
    std::vector<ColourBatches> colours;
    std::vector<Batch> round, general;
    std::uint32_t general_rows = 0, point_responses = 0;  ///< of `general`, in all

    std::vector<BodyChange> changes;  ///< of `bodies`
    // Of the present pair of sweeps, see conjugate.hpp: what `bodies` and the rows' impulses began
    // with, x, and the direction, p; and what the warm start's impulses did before, see
    // take_warm_start().
    std::vector<PackedChange> last_changes, direction, warm_start;
    std::vector<BodySums> body_sums;  ///< of pieces of each island's `bodies`
    RowImpulses<4> last_round;
    RowImpulses<3> last_general;
    RowImpulses<4, RoughEight> round_direction;
    RowImpulses<3, RoughEight> general_direction;
    std::vector<std::array<double, 2>> round_work, general_work;  ///< sums of each batch
    // Of `bodies`, if any turns unevenly.
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
    /// Likewise, if any body is slender: instead of PairFriction::response. The rounding of what a
    /// moment about its length does would be more than what any other does.
    std::vector<AcrossResponse<Eight>> slender_response;
    std::vector<GeneralRow> rows;  ///< of `general`, see Batch::row
    std::vector<Eight> second;     ///< likewise: the second pass's targets
    /// Of `general`, see Batch::response: what a unit impulse along the normal at one point changes
    /// of the velocity along it at another; 0 for points that a batch does not have.
    std::vector<RoughEight> point_response;
    std::vector<GeneralFriction> general_friction;  ///< likewise
    std::vector<PairRolling> pair_rolling;          ///< of `general`
    std::vector<GeneralRolling> general_rolling;    ///< of `rows`
};

}  // namespace tesserae
