#include "core/dynamics/constraints/joint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/step/step_data.hpp"
#include "core/error.hpp"

namespace tesserae {
namespace {

void check(const Joint& joint, std::size_t number, const Bodies& bodies) {
    for (const BodyId id : {joint.a, joint.b})
        if (id >= bodies.size())
            throw InputError(fmt::format("joint {}: body {} of {}", number, id, bodies.size()));
    if (joint.a == joint.b)
        throw InputError(
            fmt::format("joint {}: body {} cannot be joined to itself", number, joint.a));
    if (!bodies.is_movable(joint.a) && !bodies.is_movable(joint.b))
        throw InputError(fmt::format(
            "joint {}: the bodies {} and {} are both fixed; one of them must be free to move",
            number, joint.a, joint.b));
}

BodyId root_of(std::vector<BodyId>& parent, BodyId id) {
    while (parent[id] != id) id = parent[id] = parent[parent[id]];
    return id;
}

/// The greatest speed at which a joint may take its error away [m/s].
double fastest_correction(const Simulation& simulation, const StepData& step, BodyId a, BodyId b) {
    const double slop = std::min(simulation.type_of(a).slop, simulation.type_of(b).slop);
    return kFastestCorrection / kSlop * slop + step.kick;
}

void pose_joint(const Simulation& simulation, StepData& step, Constraint& constraint) {
    const Joint& joint = simulation.joints.all[constraint.joint];
    constraint.a = constraint.place_a = joint.a;
    constraint.b = constraint.place_b = joint.b;
    const RowErrors errors =
        std::visit([&](const auto& kind) { return pose(kind, step, constraint); }, joint.kind);
    set_response(simulation, step, constraint);
    const double fastest = step.h * fastest_correction(simulation, step, joint.a, joint.b);
    const double far = errors.distance.norm();
    const double taken = far > fastest ? fastest / far : 1;
    constraint.bias = -taken / step.h * errors.distance - 0.5 * step.h * errors.acceleration;
    constraint.impulse = impulses_of(constraint, step.joint_impulses[constraint.joint]);
}

}  // namespace

std::span<const BodyId> Joints::connected_with(BodyId id) const {
    if (empty()) return {};
    const auto [first, last] =
        std::equal_range(members.begin(), members.end(), id,
                         [this](BodyId x, BodyId y) { return group[x] < group[y]; });
    return {first, last};
}

Joints make_joints(std::vector<Joint> all, const Bodies& bodies) {
    Joints joints;
    joints.all = std::move(all);
    if (joints.empty()) return joints;
    joints.group.resize(bodies.size());
    std::iota(joints.group.begin(), joints.group.end(), BodyId{0});
    for (std::size_t i = 0; i < joints.all.size(); ++i) {
        const Joint& joint = joints.all[i];
        check(joint, i, bodies);
        if (!joint.collide) joints.apart.push_back(std::minmax(joint.a, joint.b));
        if (!bodies.is_movable(joint.a) || !bodies.is_movable(joint.b)) continue;
        const BodyId p = root_of(joints.group, joint.a), q = root_of(joints.group, joint.b);
        joints.group[std::max(p, q)] = std::min(p, q);
    }
    for (BodyId& group : joints.group) group = root_of(joints.group, group);
    std::sort(joints.apart.begin(), joints.apart.end());
    joints.members.resize(bodies.size());
    std::iota(joints.members.begin(), joints.members.end(), BodyId{0});
    std::stable_sort(joints.members.begin(), joints.members.end(),
                     [&](BodyId x, BodyId y) { return joints.group[x] < joints.group[y]; });
    return joints;
}

void list_joints(const Simulation& simulation, StepData& step) {
    const std::vector<Joint>& all = simulation.joints.all;
    const auto is_awake = [&](BodyId id) {
        return simulation.type_of(id).movable && !is_asleep(step, id);
    };
    step.constraints.resize(all.size());
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < all.size(); ++i)
        if (is_awake(all[i].a) || is_awake(all[i].b)) step.constraints[count++].joint = i;
    step.constraints.resize(count);
}

void pose_joints(const Simulation& simulation, StepData& step, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) pose_joint(simulation, step, step.constraints[i]);
}

void leave_jointed_pairs_out(const Simulation& simulation, StepData& step) {
    const auto& apart = simulation.joints.apart;
    if (apart.empty()) return;
    std::erase_if(step.pairs, [&](const BodyPair& pair) {
        return std::binary_search(apart.begin(), apart.end(), std::pair(pair.a, pair.b));
    });
}

}  // namespace tesserae
