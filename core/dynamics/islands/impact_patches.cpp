// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/islands/impact_patches.hpp"

#include <algorithm>
#include <numeric>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/solver/impact.hpp"

namespace tesserae {
namespace {

/// Calls visit(batch, lane) for all pairs of a coloured island that is a group by itself.
template <class Visit>
void for_pairs(const ColouredIslands& coloured, std::size_t place, const Visit& visit) {
    const auto visit_all = [&](const std::vector<Batch>& all, BatchRange range) {
        for (std::uint32_t i = range.begin; i < range.end; ++i)
            for (std::size_t k = 0; k < kLanes && all[i].points[k] > 0; ++k) visit(all[i], k);
    };
    const std::uint32_t group = coloured.group[place];
    for (std::uint32_t i = coloured.first_colour[group]; i < coloured.first_colour[group + 1];
         ++i) {
        visit_all(coloured.round, coloured.colours[i].round);
        visit_all(coloured.general, coloured.colours[i].general);
    }
}

Range bodies_of(const ColouredIslands& coloured, std::size_t place) {
    return {coloured.first_body[place], coloured.first_body[place + 1]};
}

}  // namespace

void ImpactPatches::begin(const Simulation& simulation, StepData& step,
                          std::span<const std::vector<std::uint32_t>> hits) {
    Islands& islands = step.islands;
    islands_ = islands.size(), runs_ = islands.runs.size(), rows_ = step.rows.size();
    step.awaits.assign(islands_, Awaits::kImpact);
    patched_.clear(), motions_.clear(), rim_.clear();
    hit_.assign(simulation.bodies.size(), 0);
    for (const std::vector<std::uint32_t>& list : hits)
        for (const std::uint32_t contact : list) {
            const auto [a, b] = step.contacts.pair(contact);
            hit_[a] = hit_[b] = 1;
        }
    near_.assign(step.coloured.bodies.size(), 0);
    next_.resize(near_.size());
    parent_.resize(near_.size());
    for (std::size_t island = 0; island < islands_; ++island)
        if (islands.is_coloured(island) && !step.coloured.shares(islands.coloured[island]) &&
            islands.contacts[island] >= kPatchedFrom && islands.constraints_in(island).empty())
            add_patches(step, island);
    if (patched_.empty()) return;
    step.rows.resize(rows_);
    if (simulation.needs.rolling) step.rolling_rows.resize(rows_);
    step.bodies_of_rows.resize(2 * (rows_ + step.constraints.size()));
    step.motions_of_rows.resize(2 * (rows_ + step.constraints.size()));
}

/// @return how many of the bodies (places in ColouredIslands::bodies) are hit
std::size_t ImpactPatches::mark_hit(const StepData& step, Range bodies) {
    std::size_t count = 0;
    for (std::size_t i = bodies.begin; i < bodies.end; ++i)
        count += near_[i] = hit_[step.coloured.bodies[i]];
    return count;
}

/// By the bodies that touch those that are near.
void ImpactPatches::widen(const StepData& step, std::size_t place) {
    const auto [begin, end] = bodies_of(step.coloured, place);
    std::copy(near_.data() + begin, near_.data() + end, next_.data() + begin);
    for_pairs(step.coloured, place, [&](const Batch& batch, std::size_t k) {
        if (!near_[batch.a[k]] && !near_[batch.b[k]]) return;
        // The first place stands for all that do not move: it is not near.
        next_[batch.a[k]] = next_[batch.b[k]] = 1;
    });
    std::copy(next_.data() + begin, next_.data() + end, near_.data() + begin);
}

std::uint32_t ImpactPatches::root_of(std::uint32_t place) {
    while (parent_[place] != place) place = parent_[place] = parent_[parent_[place]];
    return place;
}

/// Pairs of bodies that are near, in pairs_, and what touches the others, in rim_.
/// @return how many contacts the former have
std::size_t ImpactPatches::join(const StepData& step, std::size_t place) {
    const Range bodies = bodies_of(step.coloured, place);
    std::iota(parent_.begin() + static_cast<std::ptrdiff_t>(bodies.begin),
              parent_.begin() + static_cast<std::ptrdiff_t>(bodies.end),
              static_cast<std::uint32_t>(bodies.begin));
    pairs_.clear();
    std::size_t contacts = 0;
    for_pairs(step.coloured, place, [&](const Batch& batch, std::size_t k) {
        const std::uint32_t a = batch.a[k], b = batch.b[k];
        if (!near_[a] && !near_[b]) return;
        if ((a != 0 && !near_[a]) || (b != 0 && !near_[b])) {
            for (std::uint32_t p = 0; p < batch.points[k]; ++p)
                rim_.push_back(batch.contact[k] + p);
            return;
        }
        contacts += batch.points[k];
        pairs_.push_back({a != 0 ? a : b, step.contacts.run_of(batch.contact[k])});
        if (a == 0 || b == 0) return;
        const std::uint32_t p = root_of(a), q = root_of(b);
        parent_[std::max(p, q)] = std::min(p, q);
    });
    for (Pair& pair : pairs_) pair.patch = root_of(pair.patch);
    return contacts;
}

/// A patch, behind the islands that there are.
void ImpactPatches::add_island(StepData& step, std::span<const Pair> pairs) {
    Islands& islands = step.islands;
    std::uint32_t contacts = 0;
    for (const Pair& pair : pairs) {
        islands.runs.push_back(pair.run);
        contacts += static_cast<std::uint32_t>(step.contacts.nth_run(pair.run).size());
    }
    islands.first.push_back(static_cast<std::uint32_t>(islands.runs.size()));
    islands.first_constraint.push_back(islands.first_constraint.back());
    islands.contacts.push_back(contacts);
    islands.coloured.push_back(Islands::kNotColoured);
    islands.held.push_back(1);
    islands.direct.push_back(0);
    islands.conjugates.push_back(0);
    islands.falling_mass.push_back(0);
    islands.first_row.push_back(static_cast<std::uint32_t>(rows_));
    rows_ += contacts;
    step.residual.push_back(0);
    step.sweeps.push_back(0);
    step.has_rows.push_back(0);
    step.was_hit.push_back(0);
    step.corrected.push_back(0);
    step.awaits.push_back(Awaits::kPatch);
}

void ImpactPatches::add_patches(StepData& step, std::size_t island) {
    const std::size_t place = step.islands.coloured[island];
    const Range bodies = bodies_of(step.coloured, place);
    const std::size_t hit = mark_hit(step, bodies);
    if (hit == 0 || hit * kPatchCost > bodies.end - bodies.begin) return;
    for (int i = 0; i < kPatchWidth; ++i) widen(step, place);
    Patched patched = {
        island, {motions_.size(), 0}, {rim_.size(), 0}, {step.islands.runs.size(), 0}};
    if (kPatchCost * join(step, place) > step.islands.contacts[island]) {
        rim_.resize(patched.rim.begin);
        return;
    }
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    for (auto first = pairs_.begin(); first != pairs_.end();) {
        const auto end = std::find_if(first, pairs_.end(),
                                      [&](const Pair& pair) { return pair.patch != first->patch; });
        add_island(step, {first, end});
        first = end;
    }
    for (std::size_t i = bodies.begin; i < bodies.end; ++i) {
        const BodyId id = step.coloured.bodies[i];
        if (near_[i]) motions_.push_back({id, motion_of(step, id)});
    }
    patched.motions.end = motions_.size(), patched.rim.end = rim_.size();
    patched.runs.end = step.islands.runs.size();
    patched_.push_back(patched);
    step.awaits[island] = Awaits::kNothing;
}

/// Whether anything that is not in a patch of the island is hit now.
bool ImpactPatches::reaches_out(const Simulation& simulation, const StepData& step,
                                const Patched& patched) const {
    return std::any_of(
        rim_.data() + patched.rim.begin, rim_.data() + patched.rim.end,
        [&](std::uint32_t contact) { return impact_of(simulation, step, contact).fastest > 0; });
}

/// As before the impact, which the whole island then takes.
void ImpactPatches::give_up(StepData& step, const Patched& patched) const {
    for (std::size_t i = patched.motions.begin; i < patched.motions.end; ++i) {
        const auto& [id, motion] = motions_[i];
        step.velocity[id] = motion.velocity, step.angular_velocity[id] = motion.angular_velocity;
    }
    for (std::size_t i = patched.runs.begin; i < patched.runs.end; ++i) {
        const ContactList::Run run = step.contacts.nth_run(step.islands.runs[i]);
        std::fill(step.hit.data() + run.begin, step.hit.data() + run.end, 0.0);
    }
    step.awaits[patched.island] = Awaits::kImpact;
}

bool ImpactPatches::end(const Simulation& simulation, StepData& step) {
    bool remain = false;
    if (patched_.empty()) return remain;
    step.awaits.assign(islands_, Awaits::kNothing);
    for (const Patched& patched : patched_) {
        if (reaches_out(simulation, step, patched)) {
            give_up(step, patched);
            remain = true;
        } else {
            step.was_hit[patched.island] = 1;
        }
    }
    Islands& islands = step.islands;
    islands.runs.resize(runs_);
    islands.first.resize(islands_ + 1);
    islands.first_constraint.resize(islands_ + 1);
    const auto take_back = [&](auto&... lists) { (lists.resize(islands_), ...); };
    take_back(islands.contacts, islands.coloured, islands.held, islands.direct, islands.conjugates,
              islands.falling_mass, islands.first_row, step.residual, step.has_rows, step.was_hit,
              step.corrected);
    return remain;
}

}  // namespace tesserae
