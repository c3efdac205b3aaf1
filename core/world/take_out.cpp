// SPDX-License-Identifier: Apache-2.0
#include "core/world/take_out.hpp"

#include <memory>
#include <utility>

namespace tesserae {
namespace {

using Marks = std::vector<std::uint8_t>;

/// Leaves out the marked items of a list that has one for each mark, or none.
template <class Item>
void leave_out(std::vector<Item>& items, const Marks& marks) {
    if (items.empty() || marks.empty()) return;
    std::size_t left = 0;
    for (std::size_t i = 0; i < items.size(); ++i)
        if (marks[i] == 0) items[left++] = std::move(items[i]);
    items.erase(items.begin() + static_cast<std::ptrdiff_t>(left), items.end());
}

/// Returns the new place of every item that stays, and something else of those that go.
std::vector<BodyId> places_after(const Marks& marks) {
    std::vector<BodyId> places;
    BodyId next = 0;
    for (const std::uint8_t mark : marks) {
        places.push_back(next);
        if (mark == 0) ++next;
    }
    return places;
}

void leave_out_of_impulses(StepMemory& memory, const Marks& removed,
                           const std::vector<BodyId>& place) {
    KeptImpulses impulses;
    std::vector<Bivector> angular;
    std::size_t i = 0;
    for (KeptImpulse impulse : memory.impulses) {
        const std::size_t here = i++;
        if (removed[impulse.a] != 0 || removed[impulse.b] != 0) continue;
        impulse.a = place[impulse.a], impulse.b = place[impulse.b];
        impulses.push_back(impulse);
        if (!memory.angular_impulses.empty()) angular.push_back(memory.angular_impulses[here]);
    }
    memory.impulses = std::move(impulses);
    memory.angular_impulses = std::move(angular);
}

void leave_out_of_manifolds(StepMemory& memory, const Marks& removed,
                            const std::vector<BodyId>& place) {
    for (KeptManifolds& list : memory.kept) {
        KeptManifolds left;
        for (const std::shared_ptr<const KeptManifold>& kept : list) {
            if (removed[kept->a] != 0 || removed[kept->b] != 0) continue;
            auto moved = std::make_shared<KeptManifold>(*kept);
            moved->a = place[kept->a], moved->b = place[kept->b];
            left.push_back(std::move(moved));
        }
        list = std::move(left);
    }
}

/// Bodies that sleep together name the lowest of them, which is not one that goes: it woke them.
void leave_out_of_sleepers(StepMemory& memory, const Marks& removed,
                           const std::vector<BodyId>& place) {
    leave_out(memory.asleep, removed);
    leave_out(memory.still, removed);
    for (BodyId& root : memory.asleep)
        if (root != kAwake) root = place[root];
}

void leave_out_of_types(Bodies& bodies) {
    Marks unused(bodies.types.size(), 1);
    for (const std::uint32_t type : bodies.type) unused[type] = 0;
    const std::vector<BodyId> place = places_after(unused);
    leave_out(bodies.types, unused);
    for (std::uint32_t& type : bodies.type) type = place[type];
}

void take_joints_out(Simulation& simulation, const Marks& removed_joints) {
    Joints& joints = simulation.joints;
    if (removed_joints.empty()) return;
    Marks parts;
    // Those that were added since the last step have no parts yet.
    for (std::size_t i = 0; i + 1 < joints.first_part.size(); ++i)
        parts.resize(joints.first_part[i + 1], removed_joints[i]);
    simulation.memory.joint_impulses.resize(joints.parts());
    leave_out(simulation.memory.joint_impulses, parts);
    leave_out(simulation.memory.broken, removed_joints);
    leave_out(joints.all, removed_joints);
}

void take_bodies_out(Simulation& simulation, const Marks& removed) {
    if (removed.empty()) return;
    const std::vector<BodyId> place = places_after(removed);
    Bodies& bodies = simulation.bodies;
    leave_out(bodies.type, removed);
    leave_out(bodies.position, removed);
    leave_out(bodies.rotor, removed);
    leave_out(bodies.velocity, removed);
    leave_out(bodies.angular_velocity, removed);
    leave_out(simulation.forces, removed);
    leave_out_of_types(bodies);
    leave_out_of_impulses(simulation.memory, removed, place);
    leave_out_of_manifolds(simulation.memory, removed, place);
    leave_out_of_sleepers(simulation.memory, removed, place);
    for (Joint& joint : simulation.joints.all)
        for (BodyId* id : {&joint.a, &joint.b})
            if (*id != kWorld) *id = place[*id];
}

}  // namespace

void take_out(Simulation& simulation, const std::vector<std::uint8_t>& removed,
              const std::vector<std::uint8_t>& removed_joints) {
    take_joints_out(simulation, removed_joints);
    take_bodies_out(simulation, removed);
}

}  // namespace tesserae
