// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>

#include "core/dynamics/step/step.hpp"
#include "core/world/inside.hpp"

// How a World steps, and what it tells of contacts afterwards.
namespace tesserae {

StepReport World::Inside::do_step(double dt, const StopQuestion* stop) {
    if (!workers_) {
        Schedule serial;
        return stepper_->step(dt, serial, stop);
    }
    StepReport report;
    workers_->run([&] {
        if (!schedule_) schedule_ = workers_->schedule();
        report = stepper_->step(dt, *schedule_, stop);
    });
    return report;
}

StepReport World::Inside::step(double dt, const StopQuestion* stop) {
    settle();
    StepReport report;
    has_contacts_ = true;
    contacts_.clear();
    try {
        report = do_step(dt, stop);
    } catch (const LeftFiniteRange& error) {
        throw LeftFiniteRange(bodies_[error.body], error.time);
    }
    if (stepper_.use_count() > 1) stepper_->put_back_arrays();
    simulation_->forces.clear();
    has_contacts_ = false;
    has_tree_ = false;
    return report;
}

const std::vector<ContactReading>& World::Inside::contacts() {
    if (has_contacts_) return contacts_;
    has_contacts_ = true;
    const StepData& step = stepper_->last_step();
    for (std::size_t i = 0; i < step.contacts.size(); ++i) {
        const Contact contact = step.contacts[i];
        const ContactImpulse& load = step.impulses[i];
        if (contact.separation > 0 && !(load.normal > 0) && !(step.hit[i] > 0)) continue;
        contacts_.push_back({bodies_[contact.a], bodies_[contact.b], contact.point, contact.normal,
                             contact.separation, load.normal + step.hit[i], load.tangent()});
    }
    return contacts_;
}

/// Contacts of bodies that sleep are known by the impulses that they keep.
std::vector<TouchingPair> World::Inside::touching_pairs() {
    std::vector<TouchingPair> pairs;
    const auto add = [&](BodyId a, BodyId b) {
        if (pairs.empty() || pairs.back() != TouchingPair{a, b}) pairs.push_back({a, b});
    };
    for (const ContactReading& contact : contacts()) add(contact.a, contact.b);
    const StepMemory& memory = simulation_->memory;
    for (const KeptImpulses::Run& run : memory.impulses.runs()) {
        if (memory.asleep.empty()) break;
        if (memory.asleep[run.a] != kAwake || memory.asleep[run.b] != kAwake)
            add(bodies_[run.a], bodies_[run.b]);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

ContactChanges World::Inside::contact_changes() {
    std::vector<TouchingPair> now = touching_pairs();
    ContactChanges changes;
    std::set_difference(now.begin(), now.end(), touched_.begin(), touched_.end(),
                        std::back_inserter(changes.began));
    std::set_difference(touched_.begin(), touched_.end(), now.begin(), now.end(),
                        std::back_inserter(changes.ended));
    touched_ = std::move(now);
    return changes;
}

}  // namespace tesserae
