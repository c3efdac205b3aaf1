// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/joint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/dynamics/step/step_data.hpp"
#include "core/error.hpp"

namespace tesserae {
namespace {

std::uint32_t parts_of(const Joint& joint) {
    const std::size_t parts = (held_of(joint) != 0 ? 1 : 0) + (joint.limits.empty() ? 0 : 1);
    return static_cast<std::uint32_t>(parts + joint.drives.size());
}

void check(const Joint& joint, std::size_t number, const Bodies& bodies) {
    const auto exists = [&](BodyId id) { return id < bodies.size(); };
    const bool of_world = joint.a == kWorld;
    for (const BodyId id : {of_world ? joint.b : joint.a, joint.b})
        if (!exists(id))
            throw InputError(fmt::format("joint {}: body {} of {}", number, id, bodies.size()));
    if (joint.a == joint.b)
        throw InputError(
            fmt::format("joint {}: body {} cannot be joined to itself", number, joint.a));
    if (!bodies.is_movable(joint.b) && (of_world || !bodies.is_movable(joint.a)))
        throw InputError(fmt::format(
            "joint {}: the bodies {} and {} are both fixed; one of them must be free to move",
            number, of_world ? "of the world" : fmt::format("{}", joint.a), joint.b));
    const auto check_coordinate = [&](int coordinate) {
        if (coordinate < 0 || coordinate >= size_of(joint))
            throw InputError(
                fmt::format("joint {}: coordinate {} of {}", number, coordinate, size_of(joint)));
    };
    for (const JointLimit& limit : joint.limits) check_coordinate(limit.coordinate);
    for (const JointDrive& drive : joint.drives) check_coordinate(drive.coordinate);
}

BodyId root_of(std::vector<BodyId>& parent, BodyId id) {
    while (parent[id] != id) id = parent[id] = parent[parent[id]];
    return id;
}

/// A group without loops is a tree: of its bodies, and of all that does not move as one more.
void find_loops(Joints& joints, const Bodies& bodies) {
    struct Group {
        std::size_t bodies = 0, joints = 0;
        bool is_held = false;
    };
    std::vector<Group> groups(bodies.size());
    for (const BodyId group : joints.group) ++groups[group].bodies;
    const auto moves = [&](BodyId id) { return id != kWorld && bodies.is_movable(id); };
    const auto group_of = [&](const Joint& joint) -> Group& {
        return groups[joints.group[moves(joint.a) ? joint.a : joint.b]];
    };
    for (std::size_t i = 0; i < joints.all.size(); ++i) {
        if (joints.is_broken(i)) continue;
        Group& group = group_of(joints.all[i]);
        ++group.joints;
        group.is_held |= !moves(joints.all[i].a) || !moves(joints.all[i].b);
    }
    joints.in_loop.resize(joints.all.size());
    for (std::size_t i = 0; i < joints.all.size(); ++i) {
        const Group& group = group_of(joints.all[i]);
        joints.in_loop[i] = group.joints + 1 > group.bodies + (group.is_held ? 1 : 0);
    }
}

/// Sets what follows from the joints that are not broken.
void connect(Joints& joints, const Bodies& bodies) {
    joints.apart.clear();
    joints.group.resize(bodies.size());
    std::iota(joints.group.begin(), joints.group.end(), BodyId{0});
    for (std::size_t i = 0; i < joints.all.size(); ++i) {
        const Joint& joint = joints.all[i];
        if (joint.a == kWorld || joints.is_broken(i)) continue;
        if (!joint.collide) joints.apart.push_back(std::minmax(joint.a, joint.b));
        if (!bodies.is_movable(joint.a) || !bodies.is_movable(joint.b)) continue;
        const BodyId p = root_of(joints.group, joint.a), q = root_of(joints.group, joint.b);
        joints.group[std::max(p, q)] = std::min(p, q);
    }
    for (BodyId& group : joints.group) group = root_of(joints.group, group);
    find_loops(joints, bodies);
    std::sort(joints.apart.begin(), joints.apart.end());
    joints.members.resize(bodies.size());
    std::iota(joints.members.begin(), joints.members.end(), BodyId{0});
    std::stable_sort(joints.members.begin(), joints.members.end(),
                     [&](BodyId x, BodyId y) { return joints.group[x] < joints.group[y]; });
}

}  // namespace

int size_of(const Joint& joint) {
    return std::visit([](const auto& kind) { return kind.kSize; }, joint.kind);
}

std::uint16_t held_of(const Joint& joint) {
    return static_cast<std::uint16_t>(joint.held & ((1 << size_of(joint)) - 1));
}

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
    for (std::size_t i = 0; i < joints.all.size(); ++i) {
        check(joints.all[i], i, bodies);
        joints.first_part.push_back(joints.first_part.back() + parts_of(joints.all[i]));
    }
    connect(joints, bodies);
    return joints;
}

void set_broken(Joints& joints, const Bodies& bodies, std::vector<std::uint8_t> broken) {
    joints.broken = std::move(broken);
    connect(joints, bodies);
}

Coordinates coordinates_of(const Joint& joint, const Bodies& bodies) {
    const JointedBody a = placed(bodies, joint.a), b = placed(bodies, joint.b);
    return std::visit([&](const auto& kind) { return coordinates_of(kind, a, b); }, joint.kind);
}

double mass_along(const Joint& joint, int coordinate, const Bodies& bodies) {
    const Coordinates coordinates = coordinates_of(joint, bodies);
    const Wrench& row = coordinates.rows[static_cast<std::size_t>(coordinate)];
    double response = 0;
    for (const BodyId id : {joint.a, joint.b}) {
        if (id == kWorld || !bodies.is_movable(id)) continue;
        Bodies one;
        one.types = {bodies.type_of(id)};
        one.type = {0};
        const BodyId jointed[] = {0};
        const TypeProperties type = type_properties(one, jointed).front();
        const Bivector moment =
            wedge(coordinates.anchor - bodies.position[id], row.impulse) + row.moment;
        const BivectorMap map = world_map(type.inverse_inertia, type, bodies.rotor[id]);
        Eigen::Matrix<double, 6, 1> six;
        six << moment.xy, moment.xz, moment.xw, moment.yz, moment.yw, moment.zw;
        response += type.inverse_mass * row.impulse.squaredNorm() + six.dot(map.topRows<6>() * six);
    }
    return 1 / response;
}

void leave_jointed_pairs_out(const Simulation& simulation, StepData& step) {
    const auto& apart = simulation.joints.apart;
    if (apart.empty()) return;
    std::erase_if(step.pairs, [&](const BodyPair& pair) {
        return std::binary_search(apart.begin(), apart.end(), std::pair(pair.a, pair.b));
    });
}

void break_joints(Simulation& simulation, StepData& step) {
    const Joints& joints = simulation.joints;
    StepMemory& memory = simulation.memory;
    step.joint_sums.resize(joints.all.size());
    for (std::size_t i = 0; i < joints.all.size(); ++i) {
        Wrench& sum = step.joint_sums[i] = {};
        for (std::uint32_t part = joints.first_part[i]; part < joints.first_part[i + 1]; ++part) {
            sum.impulse += step.part_sums[part].impulse;
            sum.moment += step.part_sums[part].moment;
        }
        const Joint& joint = joints.all[i];
        if (joints.is_broken(i) || !(sum.impulse.norm() > step.dt * joint.break_force ||
                                     norm(sum.moment) > step.dt * joint.break_torque))
            continue;
        memory.broken.resize(joints.all.size(), 0);
        memory.broken[i] = 1;
    }
}

}  // namespace tesserae
