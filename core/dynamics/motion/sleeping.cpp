// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/sleeping.hpp"

#include <algorithm>

#include "core/dynamics/motion/motion.hpp"

namespace tesserae {
namespace {

/// Of any of its points [m/s], at most.
double speed_of(const TypeProperties& type, const Vec4& velocity, const Bivector& omega) {
    return velocity.norm() + type.radius * norm(omega);
}

/// For how long [s] a body has been still, after a step. What gathers speed only begins to move: a
/// tower that has just begun to tip is slower than the trembling of a pile that lies.
double still_for(const Simulation& simulation, const StepData& step, BodyId id, double before) {
    const TypeProperties& type = simulation.type_of(id);
    const double most = kStill / kSlop * type.slop;
    const double speed = speed_of(type, step.velocity[id], step.angular_velocity[id]);
    if (!(speed < most)) return 0;
    const Bodies& last = simulation.bodies;
    const double gained = speed - speed_of(type, last.velocity[id], last.angular_velocity[id]);
    return gained > kStarts * most * step.dt ? before : before + step.dt;
}

/// Slow is not at rest: what nothing holds flies on, however slowly.
bool stands_still(const StepData& step, BodyId id) {
    return step.velocity[id] == Vec4::Zero() && step.angular_velocity[id] == Bivector{};
}

bool pushes(const StepData& step, const ContactList::Run& run) {
    return std::any_of(step.impulses.begin() + static_cast<std::ptrdiff_t>(run.begin),
                       step.impulses.begin() + static_cast<std::ptrdiff_t>(run.end),
                       [](const ContactImpulse& impulse) { return impulse.normal > 0; });
}

/// step.lowest_of_island: its lowest movable body if it may fall asleep, else kAwake.
void find_islands_at_rest(const Simulation& simulation, StepData& step) {
    std::vector<BodyId>& lowest = step.lowest_of_island;
    lowest.assign(step.islands.size(), kAwake);
    for (std::size_t island = 0; island < lowest.size(); ++island) {
        BodyId least = kAwake;
        bool is_supported = false, all_stand = true;
        const auto rests = [&](BodyId id) {
            if (id == kWorld) return true;
            if (is_driven(simulation, id)) return false;
            if (!simulation.type_of(id).movable) return true;
            least = std::min(least, id);
            all_stand = all_stand && stands_still(step, id);
            return simulation.memory.still[id] >= kTimeToSleep;
        };
        // Most islands that move show it soon.
        const auto runs = step.islands.runs_in(island);
        const auto others = step.islands.constraints_in(island);
        if (std::all_of(others.begin(), others.end(),
                        [&](std::uint32_t n) {
                            const Constraint& c = step.constraints[n];
                            if (!simulation.is_movable(c.a) || !simulation.is_movable(c.b))
                                is_supported = true;
                            return rests(c.a) && rests(c.b);
                        }) &&
            std::all_of(runs.begin(), runs.end(),
                        [&](std::uint32_t n) {
                            const ContactList::Run run = step.contacts.nth_run(n);
                            if (!simulation.type_of(run.a).movable ||
                                !simulation.type_of(run.b).movable)
                                is_supported = is_supported || pushes(step, run);
                            return rests(run.a) && rests(run.b);
                        }) &&
            (is_supported || all_stand))
            lowest[island] = least;
    }
}

}  // namespace

bool touches_sleeper(const StepData& step, Range contacts) {
    if (step.asleep.empty()) return false;
    for (std::size_t i = contacts.begin; i < contacts.end;) {
        const ContactList::Run run = step.contacts.run(i, contacts.end);
        if (is_asleep(step, run.a) || is_asleep(step, run.b)) return true;
        i = run.end;
    }
    return false;
}

bool wake_touched(const Simulation& simulation, StepData& step) {
    if (step.asleep.empty()) return false;
    std::vector<BodyId> woken;
    for (const Contact contact : step.contacts)
        for (const BodyId id : {contact.a, contact.b})
            if (is_asleep(step, id)) woken.push_back(step.asleep[id]);
    if (woken.empty()) return false;
    std::sort(woken.begin(), woken.end());
    for (BodyId id = 0; id < step.asleep.size(); ++id) {
        BodyId& island = step.asleep[id];
        if (island == kAwake || !std::binary_search(woken.begin(), woken.end(), island)) continue;
        island = kAwake;
        set_inverse_inertia(simulation, step, id);
    }
    return true;
}

void fall_asleep(Simulation& simulation, StepData& step) {
    const std::size_t count = simulation.bodies.size();
    std::vector<double>& still = simulation.memory.still;
    const std::vector<BodyId>& before = simulation.memory.asleep;
    still.resize(count, 0);
    for (BodyId id = 0; id < count; ++id) {
        if (is_asleep(step, id)) continue;
        const bool woke = !before.empty() && before[id] != kAwake;
        still[id] = woke ? 0 : still_for(simulation, step, id, still[id]);
    }

    // A body without contacts is an island of its own.
    find_islands_at_rest(simulation, step);
    const std::vector<BodyId>& lowest = step.lowest_of_island;
    std::vector<BodyId>& next = step.next_asleep;
    next.resize(count);
    for (BodyId id = 0; id < count; ++id) {
        const bool rests = simulation.type_of(id).movable && !is_driven(simulation, id) &&
                           still[id] >= kTimeToSleep && stands_still(step, id);
        next[id] = rests ? id : kAwake;
    }
    for (std::size_t island = 0; island < lowest.size(); ++island) {
        const auto sleep = [&](BodyId a, BodyId b) {
            for (const BodyId id : {a, b})
                if (simulation.is_movable(id)) next[id] = lowest[island];
        };
        for (const std::uint32_t n : step.islands.runs_in(island)) {
            const ContactList::Run run = step.contacts.nth_run(n);
            sleep(run.a, run.b);
        }
        for (const std::uint32_t n : step.islands.constraints_in(island))
            sleep(step.constraints[n].a, step.constraints[n].b);
    }

    for (BodyId id = 0; id < count; ++id) {
        if (is_asleep(step, id) || next[id] == kAwake) continue;
        step.asleep[id] = next[id];
        step.velocity[id].setZero();
        if (simulation.needs.turning) step.angular_velocity[id] = {};
    }
}

}  // namespace tesserae
