// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/dynamics/constraints/contact_row.hpp"
#include "core/dynamics/constraints/rolling_row.hpp"
#include "core/dynamics/solver/kernels/input.hpp"
#include "core/dynamics/solver/kernels/kernels.hpp"
#include "core/dynamics/solver/kernels/lanes.hpp"

namespace tesserae::lanes {

inline void put(const Vec4& v, std::array<float, 4>& to) {
    Eigen::Map<Eigen::Vector4f>(to.data()) = v.cast<float>();
}

inline void put(const Bivector& b, std::size_t lane, std::array<Eight, 6>& to) {
    to[0].lane[lane] = static_cast<float>(b.xy), to[1].lane[lane] = static_cast<float>(b.xz);
    to[2].lane[lane] = static_cast<float>(b.xw), to[3].lane[lane] = static_cast<float>(b.yz);
    to[4].lane[lane] = static_cast<float>(b.yw), to[5].lane[lane] = static_cast<float>(b.zw);
}

/// Writes the offset of a point from a body's centre, or 0 for a body that contacts do not move:
/// its offset may be too large for a float.
inline void put_offset(const Simulation& simulation, BodyId body, const Vec4& offset,
                       std::array<float, 4>& to) {
    put(simulation.type_of(body).movable ? offset : Vec4(Vec4::Zero()), to);
}

/// Returns whether each lane has as many points as the batch has rows. Pairs with more points come
/// first.
inline bool is_full(const Batch& batch) { return batch.points[kLanes - 1] == batch.rows; }

/// Fetches ahead the contacts of the batch after the next one and the bodies' motions of the next
/// one. A colour's pairs come from anywhere in memory, and most of the time would be spent waiting
/// for them. It must be inlined: a call to a function that does nothing else is optimized away.
[[gnu::always_inline]] inline void prefetch(const ColouredStage& stage,
                                            const std::vector<Batch>& batches,
                                            std::uint32_t index) {
    const StepData& step = stage.step;
    const auto fetch = [](const auto& item) __attribute__((always_inline)) {
        const auto* const bytes = reinterpret_cast<const char*>(&item);
        __builtin_prefetch(bytes);
        __builtin_prefetch(bytes + sizeof item - 1);
    };
    if (index + 2 < batches.size())
        for (const std::uint32_t contact : batches[index + 2].contact) {
            step.contacts.prefetch(contact);
            fetch(step.impulses[contact]);
        }
    if (index + 1 == batches.size()) return;
    for (const std::uint32_t contact : batches[index + 1].contact) {
        const auto [a, b] = step.contacts.pair(contact);
        for (const BodyId id : {a, b}) {
            fetch(step.position[id]);
            fetch(step.velocity[id]);
            fetch(step.angular_velocity[id]);
        }
    }
}

/// Writes the contact `index` of round bodies into a lane. Velocities and impulses are in float,
/// targets are relative to the start and computed in double.
inline void put_point(const ColouredStage& stage, std::size_t member, std::uint32_t index,
                      std::size_t lane, EightPoints& points) {
    const Simulation& simulation = stage.simulation;
    const StepData& step = stage.step;
    const Contact& c = step.contacts[index];
    const ContactImpulse impulse =
        stage.cause == Cause::kLoad ? step.impulses[index] : ContactImpulse{};
    const Vec4 r_a = c.point - step.position[c.a], r_b = c.point - step.position[c.b];
    const Vec4 v = relative_velocity(step, c.a, r_a, c.b, r_b, simulation.needs.turning);
    const double along = c.normal.dot(v);
    const ContactTargets targets = PairTargets(simulation, step, c, stage.cause,
                                               stage.parting[member].at(step, {index, index + 1}))
                                       .at(c.separation, along, 0);  // of round bodies
    put(c.normal, points.normal[lane]);
    put_offset(simulation, c.a, r_a, points.r_a[lane]);
    put_offset(simulation, c.b, r_b, points.r_b[lane]);
    put(v - along * c.normal, points.velocity[lane]);
    const double per_mass_unit = 1 / stage.mass_unit(member);  // a power of two
    put(per_mass_unit * impulse.tangent(), points.impulse[lane]);
    put({targets.first - along, targets.second - along, 1, per_mass_unit * impulse.normal},
        points.along[lane]);
}

/// Returns whether slip_by_turning() can be other than 0.
inline bool slips_by_turning(const ColouredStage& stage) {
    return stage.cause == Cause::kLoad && stage.simulation.needs.turning;
}
inline void put_turning(const ColouredStage& stage, std::uint32_t index, std::size_t lane,
                        EightTurning& to) {
    const StepData& step = stage.step;
    const auto [a, b] = step.contacts.pair(index);
    const TurningOf turning = turning_of(stage.simulation, a, b);
    const Bivector& of_a = step.angular_velocity[turning == TurningOf::kB ? b : a];
    const Bivector& of_b = step.angular_velocity[turning == TurningOf::kA ? a : b];
    put({of_a.xy, of_a.xz, of_a.xw, of_a.yz}, to.a[lane]);
    put({of_b.xy, of_b.xz, of_b.xw, of_b.yz}, to.b[lane]);
    put({of_a.yw, of_a.zw, of_b.yw, of_b.zw}, to.last[lane]);
    put(velocity_before_gravity(stage.simulation, step, a, b), to.against[lane]);
}
/// Returns slip_by_turning() of each lane.
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> slip_by_turning(const ColouredStage& stage,
                                                          const Lane<F>& lane, const LaneVec4<F>& n,
                                                          const EightTurning& of) {
    const LaneVec4<F> a = load(lane, of.a), b = load(lane, of.b), last = load(lane, of.last);
    const LaneBivector<F> of_a = {a[0], a[1], a[2], a[3], last[0], last[1]};
    const LaneBivector<F> of_b = {b[0], b[1], b[2], b[3], last[2], last[3]};
    const auto is_a = dot(of_a, of_a) <= dot(of_b, of_b);
    LaneBivector<F> w;
    for (std::size_t i = 0; i < 6; ++i) w[i] = is_a ? of_a[i] : of_b[i];
    const F part = F{} + static_cast<float>(-0.5 * stage.step.h);
    const LaneVec4<F> slip = part * velocity_at(w, load(lane, of.against));
    return slip - dot(n, slip) * n;
}

/// The largest friction coefficient in float: its square, 1e36, is below float's largest number,
/// 3e38.
constexpr double kLargestFloatFriction = 1e18;

inline float float_friction(const ColouredStage& stage, const Contact& c) {
    return static_cast<float>(
        std::min(friction_of(stage.simulation, c.a, c.b), kLargestFloatFriction));
}

inline Bivector bivector_in_lane(const std::array<Eight, 6>& from, std::size_t lane) {
    return {from[0].lane[lane], from[1].lane[lane], from[2].lane[lane],
            from[3].lane[lane], from[4].lane[lane], from[5].lane[lane]};
}

inline float float_rolling_arm(const ColouredStage& stage, const Contact& c) {
    return static_cast<float>(
        std::min(rolling_arm_of(stage.simulation, c.a, c.b), kLargestFloatFriction));
}
/// Writes the angular velocity of b relative to a at the start into a lane.
inline void put_turning(const ColouredStage& stage, std::uint32_t index, std::size_t lane,
                        std::array<Eight, 6>& turning) {
    const Contact& c = stage.step.contacts[index];
    put(stage.step.angular_velocity[c.b] - stage.step.angular_velocity[c.a], lane, turning);
}
/// Writes the angular impulse that a contact starts from into a lane.
inline void put_angular_impulse(const ColouredStage& stage, std::size_t member, std::uint32_t index,
                                std::size_t lane, std::array<Eight, 6>& impulse) {
    if (stage.cause == Cause::kImpact) return;
    put((1 / stage.mass_unit(member)) * stage.step.angular_impulses[index], lane, impulse);
}

/// A point of a pair, in world axes.
struct PairPoint {
    Vec4 place;
    double separation;
};
/// Returns the centre of a pair: the mean of its points, as high along the normal as the deepest.
inline Vec4 centre_of(std::span<const PairPoint> points, const Vec4& normal) {
    Vec4 sum = points[0].place;
    const PairPoint* deepest = &points[0];
    for (const PairPoint& point : points.subspan(1)) {
        sum += point.place;
        if (point.separation < deepest->separation) deepest = &point;
    }
    const Vec4 mean = sum / static_cast<double>(points.size());
    return mean + normal.dot(deepest->place - mean) * normal;
}

/// Writes a pair with `count` contacts from `first` on into a lane, as put_point() does for one
/// contact.
inline void put_pair(const ColouredStage& stage, std::size_t member, std::uint32_t first,
                     std::size_t count, std::size_t lane, EightPairs& pairs) {
    const Simulation& simulation = stage.simulation;
    const StepData& step = stage.step;
    const Contact contact = step.contacts[first];
    const BodyId a = contact.a, b = contact.b;
    const PairTargets targets_of(simulation, step, contact, stage.cause,
                                 stage.parting[member].at(step, {first, first + count}));
    const double mass_unit = stage.mass_unit(member);
    const double per_mass_unit = 1 / mass_unit;  // a power of two
    std::array<PairPoint, kManifoldPoints> points;
    points[0] = {contact.point, contact.separation};
    for (std::uint32_t p = 1; p < count; ++p)
        points[p] = {step.contacts.point(first + p), step.contacts.separation(first + p)};
    const Vec4 centre = centre_of({points.data(), count}, contact.normal);
    const Vec4 r_a = centre - step.position[a], r_b = centre - step.position[b];
    const Vec4 v = relative_velocity(step, a, r_a, b, r_b, simulation.needs.turning);
    Bivector turning;
    if (simulation.needs.turning) turning = step.angular_velocity[b] - step.angular_velocity[a];
    put(contact.normal, pairs.normal[lane]);
    put_offset(simulation, a, r_a, pairs.centre_a[lane]);
    put_offset(simulation, b, r_b, pairs.centre_b[lane]);
    put(v + slip_by_turning(simulation, step, contact, stage.cause) +
            slip_on_rim(step, {first, first + count}, contact.normal, v, stage.cause),
        pairs.velocity[lane]);
    put(turning, lane, pairs.turning);
    pairs.rounding.lane[lane] = static_cast<float>(least_response(simulation, a, b) * mass_unit);
    for (std::uint32_t p = 0; p < count; ++p) {
        EightPairs::Points& point = pairs.points[p];
        const Vec4 place = points[p].place - centre;
        const double along =
            targets_of.need_velocity() ? contact.normal.dot(v + velocity_at(turning, place)) : 0;
        const ContactTargets targets =
            targets_of.at(points[p].separation, along, rise_of(step, first + p));
        put(place, point.place[lane]);
        const ContactImpulse impulse =
            stage.cause == Cause::kLoad ? step.impulses[first + p] : ContactImpulse{};
        const auto normal = static_cast<float>(per_mass_unit * impulse.normal);
        for (std::size_t i = 0; i < 4; ++i) point.impulse[lane][i] = normal * impulse.slope[i];
        point.along[lane] = {static_cast<float>(targets.first), static_cast<float>(targets.second),
                             1, normal};
    }
}

/// Calls work(Lane<F>) for all lanes of a batch, in the order of the sweep.
template <class Work>
void for_lanes(LaneCount lanes, bool backward, const Work& work) {
    if (lanes != LaneCount::kOne) return work(Lane<Float8>{});
    for (std::size_t k = 0; k < kLanes; ++k) work(Lane<float>(backward ? kLanes - 1 - k : k));
}
/// Calls work(Lane<F>) for the lanes of some islands: at once if the batch has no others.
template <class Work>
void for_lanes_of(const Batch& batch, Members some, LaneCount lanes, const Work& work) {
    if (some.has_all(batch.members)) return for_lanes(lanes, false, work);
    for (std::size_t k = 0; k < kLanes; ++k)
        if (some.has(batch.member[k])) work(Lane<float>(k));
}

}  // namespace tesserae::lanes
