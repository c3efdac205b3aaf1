// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/islands/islands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "core/counting_sort.hpp"
#include "core/dynamics/solver/conjugate.hpp"
#include "core/dynamics/step/room.hpp"
#include "core/error.hpp"

namespace tesserae {
namespace {

/// The number of a body that is in no island.
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// The most pairs of a group of islands, as many as there are colours.
constexpr std::size_t kPairsOfGroup = 64;

/// The range of masses of an island, as a power of 2, up to which their products with sizes fit in
/// floats.
constexpr int kMostExponents = 60;

bool drives(const Simulation& simulation, BodyId id) {
    return id != kWorld && is_driven(simulation, id);
}

/// Returns whether a driven body may squeeze an island's bodies, as another one that contacts do
/// not move touches them too. There may be no velocities that suit both. Every sweep then presses
/// the bodies together more, and a long step along a direction does so until rounding throws them.
bool may_be_squeezed(const Simulation& simulation, const StepData& step, std::size_t island) {
    std::optional<BodyId> holder;
    bool several = false, driven = false;
    const auto see = [&](BodyId id) {
        const bool moves = drives(simulation, id);
        if (!moves && id != kWorld && simulation.type_of(id).inverse_mass > 0) return;
        driven = driven || moves;
        several = several || (holder && *holder != id);
        holder = id;
    };
    for (const std::uint32_t n : step.islands.runs_in(island)) {
        const ContactList::Run run = step.contacts.nth_run(n);
        see(run.a), see(run.b);
    }
    for (const std::uint32_t n : step.islands.constraints_in(island))
        see(step.constraints[n].a), see(step.constraints[n].b);
    return driven && several;
}

}  // namespace

BodyId IslandBuilder::root_of(BodyId id) {
    while (parent_[id] != id) id = parent_[id] = parent_[parent_[id]];
    return id;
}

void IslandBuilder::build(const Simulation& simulation, StepData& step) {
    sort_by_island(simulation, step);
    Islands& islands = step.islands;
    step.residual.resize(islands.size());
    step.sweeps.assign(islands.size(), 0);
    step.has_rows.assign(islands.size(), 0);
    step.was_hit.assign(islands.size(), 0);
    step.corrected.assign(islands.size(), 0);
    islands.coloured.assign(islands.size(), Islands::kNotColoured);
    islands.first_row.assign(islands.size(), 0);
    colouring_.begin(simulation, step);
    std::uint32_t rows = 0;
    for (std::uint32_t island = 0; island < islands.size(); ++island) {
        if (!islands.direct[island] && is_coloured(islands, island)) {
            add_coloured(simulation, step, island);
        } else {
            islands.first_row[island] = rows;
            rows += islands.contacts[island];
        }
    }
    add_group(simulation, step);
    colouring_.end(step);
    resize_anew(step.rows, rows);
    if (simulation.needs.rolling) resize_anew(step.rolling_rows, rows);
    const std::size_t all_rows = rows + step.constraints.size();
    resize_anew(step.bodies_of_rows, 2 * all_rows);
    resize_anew(step.motions_of_rows, 2 * all_rows);
}

/// To the present group, or by itself.
void IslandBuilder::add_coloured(const Simulation& simulation, StepData& step,
                                 std::uint32_t island) {
    const std::size_t pairs = pairs_if_few(step, island);
    if (pairs == 0) return colouring_.add(simulation, step, {&island, 1}, false);
    if (group_.size() == Members::kMost || pairs_of_group_ + pairs > kPairsOfGroup)
        add_group(simulation, step);
    group_.push_back(island);
    pairs_of_group_ += pairs;
}

void IslandBuilder::add_group(const Simulation& simulation, StepData& step) {
    if (!group_.empty()) colouring_.add(simulation, step, group_, true);
    group_.clear();
    pairs_of_group_ = 0;
}

/// The number of an island's pairs if it may share batches with others, else 0. It must have no
/// more pairs than there are colours, and be solved along conjugate directions.
std::size_t IslandBuilder::pairs_if_few(const StepData& step, std::size_t island) {
    const Islands& islands = step.islands;
    if (!islands.conjugates[island] || !islands.constraints_in(island).empty()) return 0;
    std::size_t pairs = 0;
    for (const std::uint32_t run : islands.runs_in(island)) {
        pairs += (step.contacts.nth_run(run).size() + kManifoldPoints - 1) / kManifoldPoints;
        if (pairs > kPairsOfGroup) return 0;
    }
    return pairs;
}

bool IslandBuilder::is_coloured(const Islands& islands, std::size_t island) const {
    const FloatRange& floats = floats_[island];
    if (!floats.fits || floats.most - floats.least > kMostExponents) return false;
    const std::uint32_t size = islands.size_of(island);
    if (!islands.held[island]) return size >= coloured_from_.free;
    const bool unequal =
        islands.conjugates[island] && most_mass_[island] > kUnequalMasses * least_mass_[island];
    return size >= (unequal ? coloured_from_.unequal : coloured_from_.held);
}

/// Joins two bodies if both are movable, the lower root above the higher one.
/// @return one that is movable
BodyId IslandBuilder::join(const Simulation& simulation, BodyId a, BodyId b) {
    if (!simulation.is_movable(a)) return b;
    if (!simulation.is_movable(b)) return a;
    const BodyId p = root_of(a), q = root_of(b);
    parent_[std::max(p, q)] = std::min(p, q);
    return a;
}

/// Numbers the roots that have contacts or other constraints, ascending.
/// @return their number
std::uint32_t IslandBuilder::number_islands() {
    number_.assign(parent_.size(), kNone);
    for (const BodyId root : member_) number_[root] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t& number : number_)
        if (number != kNone) number = count++;
    return count;
}

/// Adds up the masses of each island's bodies.
void IslandBuilder::weigh_islands(const Simulation& simulation, Islands& islands) {
    const std::size_t count = islands.contacts.size();
    least_mass_.assign(count, std::numeric_limits<double>::infinity());
    most_mass_.assign(count, 0);
    floats_.assign(count, {});
    islands.falling_mass.assign(count, 0);
    for (BodyId id = 0; id < parent_.size(); ++id) {
        const TypeProperties& type = simulation.type_of(id);
        const std::uint32_t island = number_[root_of(id)];
        if (island == kNone || !type.movable) continue;
        FloatRange& floats = floats_[island];
        const int exponent = std::ilogb(type.mass);
        floats.fits &= type.fits_floats;
        floats.least = std::min(floats.least, exponent);
        floats.most = std::max(floats.most, exponent);
        if (!(type.inverse_mass > 0)) continue;
        least_mass_[island] = std::min(least_mass_[island], type.mass);
        most_mass_[island] = std::max(most_mass_[island], type.mass);
        islands.falling_mass[island] += std::abs(type.gravity_scale) * type.mass;
    }
}

void IslandBuilder::sort_by_island(const Simulation& simulation, StepData& step) {
    const ContactList& contacts = step.contacts;
    TSR_ASSERT(contacts.size() < std::numeric_limits<std::uint32_t>::max());
    const std::size_t runs = contacts.run_count(), all = runs + step.constraints.size();
    const auto bodies_of = [&](std::size_t i) -> BodyPair {
        if (i >= runs) return {step.constraints[i - runs].a, step.constraints[i - runs].b};
        const ContactList::Run run = contacts.nth_run(i);
        return {run.a, run.b};
    };

    resize_anew(parent_, simulation.bodies.size());
    std::iota(parent_.begin(), parent_.end(), BodyId{0});
    resize_anew(member_, all);
    for (std::size_t i = 0; i < all; ++i) {
        const BodyPair bodies = bodies_of(i);
        member_[i] = join(simulation, bodies.a, bodies.b);
    }
    for (BodyId& member : member_) member = root_of(member);
    const std::uint32_t count = number_islands();

    Islands& islands = step.islands;
    islands.held.assign(count, 0);
    islands.contacts.assign(count, 0);
    islands.conjugates.assign(count, 1);
    bool any_driven = false;
    for (std::size_t i = 0; i < all; ++i) {
        const auto [a, b] = bodies_of(i);
        const std::uint32_t island = number_[member_[i]];
        for (const BodyId id : {a, b}) {
            if (!simulation.is_movable(id)) islands.held[island] = 1;
            any_driven = any_driven || drives(simulation, id);
        }
        if (i < runs)
            islands.contacts[island] += static_cast<std::uint32_t>(contacts.nth_run(i).size());
        if (i < runs ? !has_conjugates(simulation, a, b)
                     : step.constraints[i - runs].compliance > 0)
            islands.conjugates[island] = 0;
    }
    weigh_islands(simulation, islands);
    const auto sort = [&](std::size_t first, std::size_t size, std::vector<std::uint32_t>& starts,
                          std::vector<std::uint32_t>& sorted) {
        resize_anew(sorted, size);
        counting_sort(
            size, count, [&](std::size_t i) { return number_[member_[first + i]]; }, starts,
            [&](std::size_t i, std::size_t place) {
                sorted[place] = static_cast<std::uint32_t>(i);
            });
    };
    sort(0, runs, islands.first, islands.runs);
    sort(runs, step.constraints.size(), islands.first_constraint, islands.constraints);
    for (std::size_t island = 0; any_driven && island < count; ++island)
        if (may_be_squeezed(simulation, step, island)) islands.conjugates[island] = 0;
    find_direct(simulation, step);
}

/// Counts the bodies with joints of every island.
void IslandBuilder::find_direct(const Simulation& simulation, StepData& step) {
    Islands& islands = step.islands;
    islands.direct.assign(islands.size(), 0);
    if (step.constraints.empty()) return;
    jointed_.assign(islands.size(), 0);
    is_jointed_.assign(simulation.bodies.size(), 0);
    for (const Constraint& c : step.constraints)
        for (const BodyId id : {c.a, c.b}) {
            if (!simulation.is_movable(id) || std::exchange(is_jointed_[id], 1) != 0) continue;
            ++jointed_[number_[root_of(id)]];
        }
    for (std::size_t island = 0; island < islands.size(); ++island)
        islands.direct[island] = jointed_[island] > 0 && jointed_[island] <= coloured_from_.direct;
}

}  // namespace tesserae
