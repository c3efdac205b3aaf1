// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/contacts/internal_edges.hpp"

#include <algorithm>
#include <span>
#include <tuple>

namespace tesserae {
namespace {

/// Contacts of a range at least.
constexpr std::size_t kEdgeGrain = 1024;

/// Of a floor that may be made of several bodies.
bool may_be_floor(const Simulation& simulation, BodyId id) {
    return !simulation.type_of(id).movable &&
           std::visit([]<class S>(const S&) { return S::kBounded && HasFaces<S>; },
                      simulation.bodies.type_of(id).shape);
}

}  // namespace

void InternalEdges::correct(const Simulation& simulation, StepData& step, Schedule& schedule) {
    list_meetings(step, schedule, [&](Meeting& m) {
        if (!simulation.type_of(m.body).movable) return false;
        return may_be_floor(simulation, m.other) || may_be_internal_edge(simulation, step, m);
    });
    if (meetings_.empty()) return;
    is_marked_.assign(simulation.bodies.size(), 0);
    for (const Meeting& m : meetings_) is_marked_[m.body] = 1;
    list_meetings(step, schedule, [&](Meeting& m) {
        if (is_marked_[m.body] == 0) return false;
        m.may_be_internal_edge = may_be_internal_edge(simulation, step, m);
        return true;
    });

    judge_.clear();
    for (auto begin = meetings_.begin(); begin != meetings_.end();) {
        schedule.look_for_stop();
        const auto end = std::find_if(begin, meetings_.end(),
                                      [&](const Meeting& m) { return m.body != begin->body; });
        if (end - begin > 1) judge_.judge(simulation, step, {begin, end});
        begin = end;
    }
    if (!judge_.corrections.empty()) replace(step);
}

/// Every meeting is one of either body.
template <class Choose>
void InternalEdges::list_meetings(const StepData& step, Schedule& schedule, const Choose& choose) {
    const ContactList& contacts = step.contacts;
    const auto for_each_range = [&](std::size_t count, std::size_t grain, const auto& work) {
        schedule.for_each_range(count, grain, work);
    };
    const auto list_range = [&](Range range, std::vector<Meeting>& list) {
        // A pair is that range's in which its first contact is.
        std::size_t i = range.begin > 0 ? contacts.end_of_pair(range.begin - 1) : 0;
        while (i < range.end) {
            const auto [a, b] = contacts.pair(i);
            const std::size_t end = contacts.end_of_pair(i);
            const auto [first, last] = std::pair(std::uint32_t(i), std::uint32_t(end));
            for (Meeting m : {Meeting{a, b, first, last}, Meeting{b, a, first, last}})
                if (choose(m)) list.push_back(m);
            i = end;
        }
    };
    lists_.collect(for_each_range, contacts.size(), kEdgeGrain, list_range, meetings_);
    std::sort(meetings_.begin(), meetings_.end(), [](const Meeting& m, const Meeting& n) {
        return std::tie(m.body, m.begin) < std::tie(n.body, n.begin);
    });
}

/// Of two corrections of one pair, for either body, that holds which turns the normal more.
void InternalEdges::replace(StepData& step) {
    std::vector<EdgeCorrection>& corrections = judge_.corrections;
    std::sort(corrections.begin(), corrections.end(),
              [](const EdgeCorrection& c, const EdgeCorrection& d) {
                  return std::tie(c.begin, c.cosine, c.first) <
                         std::tie(d.begin, d.cosine, d.first);
              });
    replacements_.clear();
    std::uint32_t done = 0;
    for (const EdgeCorrection& c : corrections) {
        if (c.begin < done) continue;
        replacements_.push_back(
            {c.begin, c.end, std::span(judge_.contacts).subspan(c.first, c.last - c.first)});
        done = c.end;
    }
    step.contacts.replace(replacements_);
}

}  // namespace tesserae
