// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory/resume_record.hpp"

#include <algorithm>
#include <cstring>

#include "core/error.hpp"
#include "scenes/load/hash.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"

namespace tesserae::scenes {
namespace {

constexpr std::size_t kImpulseBytes = 3 * 4 + 8 + 4 * 4;
/// Of each, where there is rolling friction; files of before there was have none.
constexpr std::size_t kAngularBytes = 6 * 8;
constexpr std::size_t kBodyBytes = 4 + 8;  ///< of what sleeping remembers
constexpr std::size_t kJointPartBytes = 10 * 8;
/// Part of the number of manifolds if the numbers of joints' parts and of bytes that tell which
/// joints are broken follow it: files without joints are as they were before there were any.
constexpr std::uint64_t kHasJoints = std::uint64_t{1} << 63;
constexpr std::size_t kManifoldBytes = 2 * 4 + 12 * 8;
/// Rows, first, hash, step, numbers of impulses, of bodies and of manifolds.
constexpr std::size_t kFixedBytes = 8 * 8;
constexpr std::size_t kFrontBytes = 3 * 8;  ///< length, hash

template <class Value>
void put(std::string& bytes, const Value& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put(std::string& bytes, const Bivector& b) {
    for (const double plane : {b.xy, b.xz, b.xw, b.yz, b.yw, b.zw}) put(bytes, plane);
}

void put(std::string& bytes, const Wrench& wrench) {
    for (int axis = 0; axis < 4; ++axis) put(bytes, wrench.impulse[axis]);
    put(bytes, wrench.moment);
}

void put(std::string& bytes, const KeptManifold& m) {
    put(bytes, m.a);
    put(bytes, m.b);
    for (int axis = 0; axis < 4; ++axis) put(bytes, m.offset[axis]);
    put(bytes, m.rotor.s);
    put(bytes, m.rotor.b);
    put(bytes, m.rotor.p);
}

template <class Value>
void take(std::string_view& bytes, Value& value) {
    std::memcpy(&value, bytes.data(), sizeof value);
    bytes.remove_prefix(sizeof value);
}

void take(std::string_view& bytes, Bivector& b) {
    for (double* plane : {&b.xy, &b.xz, &b.xw, &b.yz, &b.yw, &b.zw}) take(bytes, *plane);
}

void take(std::string_view& bytes, Wrench& wrench) {
    for (int axis = 0; axis < 4; ++axis) take(bytes, wrench.impulse[axis]);
    take(bytes, wrench.moment);
}

void take(std::string_view& bytes, KeptManifold& m) {
    take(bytes, m.a);
    take(bytes, m.b);
    for (int axis = 0; axis < 4; ++axis) take(bytes, m.offset[axis]);
    take(bytes, m.rotor.s);
    take(bytes, m.rotor.b);
    take(bytes, m.rotor.p);
}

}  // namespace

std::string to_bytes(const ResumeRecord& record) {
    std::uint64_t manifolds = 0;
    for (const KeptManifolds& list : record.memory.kept) manifolds += list.size();
    std::string bytes;
    bytes.reserve(kFrontBytes + kFixedBytes + record.memory.impulses.size() * kImpulseBytes +
                  record.memory.angular_impulses.size() * kAngularBytes +
                  record.memory.asleep.size() * kBodyBytes + manifolds * kManifoldBytes +
                  2 * sizeof(std::uint64_t) +
                  record.memory.joint_impulses.size() * kJointPartBytes +
                  record.memory.broken.size());
    bytes.resize(kFrontBytes);
    put(bytes, record.rows);
    put(bytes, record.first);
    put(bytes, record.hash);
    put(bytes, record.step);
    const StepMemory& memory = record.memory;
    TSR_ASSERT(memory.asleep.size() == memory.still.size());
    TSR_ASSERT(memory.angular_impulses.empty() ||
               memory.angular_impulses.size() == memory.impulses.size());
    put(bytes, static_cast<std::uint64_t>(memory.impulses.size()));
    put(bytes, static_cast<std::uint64_t>(memory.asleep.size()));
    const std::uint64_t parts = memory.joint_impulses.size(), broken = memory.broken.size();
    const bool has_joints = parts > 0 || broken > 0;
    put(bytes, manifolds | (has_joints ? kHasJoints : 0));
    if (has_joints) put(bytes, parts), put(bytes, broken);
    for (const KeptImpulse& impulse : memory.impulses) {
        put(bytes, impulse.a);
        put(bytes, impulse.b);
        put(bytes, impulse.feature);
        put(bytes, impulse.normal);
        for (const float part : impulse.slope) put(bytes, part);
    }
    for (BodyId island : memory.asleep) put(bytes, island);
    for (double time : memory.still) put(bytes, time);
    for (const KeptManifolds& list : memory.kept)
        for (const auto& manifold : list) put(bytes, *manifold);
    for (const Wrench& impulse : memory.joint_impulses) put(bytes, impulse);
    for (const std::uint8_t is_broken : memory.broken) put(bytes, is_broken);
    for (const Bivector& impulse : memory.angular_impulses) put(bytes, impulse);
    // In one string, whose front is known last: the record may be as large as what it saves.
    const std::string_view body = std::string_view(bytes).substr(kFrontBytes);
    std::string front;
    put(front, static_cast<std::uint64_t>(body.size()));
    put(front, hash_of(body));
    bytes.replace(0, kFrontBytes, front);
    return bytes;
}

std::optional<ResumeRecord> to_record(std::string_view bytes) {
    if (bytes.size() < kFrontBytes) return std::nullopt;
    std::uint64_t length = 0;
    std::array<std::uint64_t, 2> hash;
    take(bytes, length);
    take(bytes, hash);
    if (length < kFixedBytes || length > bytes.size()) return std::nullopt;
    bytes = bytes.substr(0, length);
    if (hash_of(bytes) != hash) return std::nullopt;

    ResumeRecord record;
    std::uint64_t impulses = 0, bodies = 0, manifolds = 0, parts = 0, broken = 0;
    take(bytes, record.rows);
    take(bytes, record.first);
    take(bytes, record.hash);
    take(bytes, record.step);
    take(bytes, impulses);
    take(bytes, bodies);
    take(bytes, manifolds);
    if ((manifolds & kHasJoints) != 0) {
        manifolds &= ~kHasJoints;
        if (bytes.size() < sizeof parts + sizeof broken) return std::nullopt;
        take(bytes, parts);
        take(bytes, broken);
    }
    if (impulses > bytes.size() / kImpulseBytes || bodies > bytes.size() / kBodyBytes ||
        manifolds > bytes.size() / kManifoldBytes || parts > bytes.size() / kJointPartBytes ||
        broken > bytes.size())
        return std::nullopt;
    const std::uint64_t plain = impulses * kImpulseBytes + bodies * kBodyBytes +
                                manifolds * kManifoldBytes + parts * kJointPartBytes + broken;
    const bool has_angular = bytes.size() != plain;
    const bool fits = bytes.size() == plain + (has_angular ? impulses * kAngularBytes : 0);
    if (!fits || record.first >= record.rows) return std::nullopt;
    record.memory.impulses.reserve_anew({impulses, impulses});
    for (std::uint64_t i = 0; i < impulses; ++i) {
        KeptImpulse impulse;
        take(bytes, impulse.a);
        take(bytes, impulse.b);
        take(bytes, impulse.feature);
        take(bytes, impulse.normal);
        for (float& part : impulse.slope) take(bytes, part);
        record.memory.impulses.push_back(impulse);
    }
    record.memory.asleep.resize(bodies);
    record.memory.still.resize(bodies);
    for (BodyId& island : record.memory.asleep) take(bytes, island);
    for (double& time : record.memory.still) take(bytes, time);
    if (manifolds > 0) record.memory.kept.emplace_back().reserve(manifolds);
    for (std::uint64_t i = 0; i < manifolds; ++i) {
        KeptManifold manifold;
        take(bytes, manifold);
        record.memory.kept[0].push_back(std::make_shared<KeptManifold>(manifold));
    }
    record.memory.joint_impulses.resize(parts);
    for (Wrench& impulse : record.memory.joint_impulses) take(bytes, impulse);
    record.memory.broken.resize(broken);
    for (std::uint8_t& is_broken : record.memory.broken) take(bytes, is_broken);
    if (has_angular) record.memory.angular_impulses.resize(impulses);
    for (Bivector& impulse : record.memory.angular_impulses) take(bytes, impulse);
    return record;
}

bool is_of_bodies(const StepMemory& memory, std::uint64_t bodies) {
    const auto is_pair = [&](const auto& of) { return of.a < of.b && of.b < bodies; };
    const auto& runs = memory.impulses.runs();
    const auto is_of_pairs = [&](const KeptManifolds& list) {
        return std::all_of(list.begin(), list.end(),
                           [&](const auto& manifold) { return is_pair(*manifold); });
    };
    return std::all_of(runs.begin(), runs.end(), is_pair) &&
           std::all_of(memory.kept.begin(), memory.kept.end(), is_of_pairs) &&
           std::all_of(memory.asleep.begin(), memory.asleep.end(),
                       [&](BodyId island) { return island == kAwake || island < bodies; }) &&
           (memory.asleep.empty() || memory.asleep.size() == bodies);
}

bool is_of_joints(const StepMemory& memory, std::uint64_t joints, std::uint64_t parts) {
    return (memory.joint_impulses.empty() || memory.joint_impulses.size() == parts) &&
           (memory.broken.empty() || memory.broken.size() == joints);
}

std::array<std::uint64_t, 2> hash_with_row(const std::array<std::uint64_t, 2>& before,
                                           const StepFacts& facts, const Bodies& bodies) {
    std::string parts;
    put(parts, before);
    put(parts, facts.step);
    put(parts, facts.time);
    const auto values = observable_values(facts);
    for (std::size_t i = 0; i < values.size(); ++i)
        parts.append(static_cast<const char*>(values[i]), 8 * kObservables[i].width);
    const auto arrays = state_arrays(bodies);
    for (std::size_t i = 0; i < arrays.size(); ++i)
        put(parts, hash_of({reinterpret_cast<const char*>(arrays[i]),
                            bodies.size() * kStateElements[i].width * sizeof(double)}));
    const auto of_joints = joint_values(facts.joints);
    const std::size_t joints = facts.joints.broken.size();
    for (std::size_t i = 0; joints > 0 && i < of_joints.size(); ++i)
        put(parts, hash_of({static_cast<const char*>(of_joints[i]),
                            joints * bytes_of(kJointElements[i])}));
    return hash_of(parts);
}

}  // namespace tesserae::scenes
