#include "core/dynamics/islands/islands.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/counting_sort.hpp"
#include "core/dynamics/solver/conjugate.hpp"
#include "core/dynamics/step/room.hpp"
#include "core/error.hpp"

namespace tesserae {

BodyId IslandBuilder::root_of(BodyId id) {
    while (parent_[id] != id) id = parent_[id] = parent_[parent_[id]];
    return id;
}

void IslandBuilder::build(const Simulation& simulation, StepData& step) {
    sort_by_island(simulation, step);
    Islands& islands = step.islands;
    step.residual.resize(islands.size());
    step.has_rows.assign(islands.size(), 0);
    step.was_hit.assign(islands.size(), 0);
    step.corrected.assign(islands.size(), Correction::kNone);
    islands.coloured.assign(islands.size(), Islands::kNotColoured);
    islands.first_row.assign(islands.size(), 0);
    colouring_.begin(simulation, step);
    std::uint32_t coloured = 0, rows = 0;
    for (std::size_t island = 0; island < islands.size(); ++island) {
        if (simulation.floats.fits && is_coloured(islands, island)) {
            colouring_.add(simulation, step, island);
            islands.coloured[island] = coloured++;
        } else {
            islands.first_row[island] = rows;
            rows += islands.contacts[island];
        }
    }
    colouring_.end(step);
    resize_anew(step.rows, rows);
    if (simulation.needs.rolling) resize_anew(step.rolling_rows, rows);
    resize_anew(step.bodies_of_rows, 2 * std::size_t{rows});
    resize_anew(step.motions_of_rows, 2 * std::size_t{rows});
}

bool IslandBuilder::is_coloured(const Islands& islands, std::size_t island) const {
    const std::uint32_t contacts = islands.contacts[island];
    if (!islands.held[island]) return contacts >= coloured_from_.free;
    const bool unequal =
        islands.conjugates[island] && most_mass_[island] > kUnequalMasses * least_mass_[island];
    return contacts >= (unequal ? coloured_from_.unequal : coloured_from_.held);
}

void IslandBuilder::sort_by_island(const Simulation& simulation, StepData& step) {
    const ContactList& contacts = step.contacts;
    TSR_ASSERT(contacts.size() < std::numeric_limits<std::uint32_t>::max());
    const auto movable = [&](BodyId id) { return simulation.type_of(id).movable; };

    // Join, the lower root above the higher one.
    resize_anew(parent_, simulation.bodies.size());
    std::iota(parent_.begin(), parent_.end(), BodyId{0});
    resize_anew(member_, contacts.run_count());
    for (std::size_t i = 0; i < member_.size(); ++i) {
        const ContactList::Run run = contacts.nth_run(i);
        member_[i] = movable(run.a) ? run.a : run.b;
        if (!movable(run.a) || !movable(run.b)) continue;
        const BodyId p = root_of(run.a), q = root_of(run.b);
        parent_[std::max(p, q)] = std::min(p, q);
    }
    for (BodyId& member : member_) member = root_of(member);

    // Number the roots that have contacts, ascending.
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    number_.assign(parent_.size(), kNone);
    for (const BodyId root : member_) number_[root] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t& number : number_)
        if (number != kNone) number = count++;

    Islands& islands = step.islands;
    islands.held.assign(count, 0);
    islands.contacts.assign(count, 0);
    islands.conjugates.assign(count, 1);
    least_mass_.assign(count, std::numeric_limits<double>::infinity());
    most_mass_.assign(count, 0);
    for (std::size_t i = 0; i < member_.size(); ++i) {
        const ContactList::Run run = contacts.nth_run(i);
        const std::uint32_t island = number_[member_[i]];
        if (!movable(run.a) || !movable(run.b)) islands.held[island] = 1;
        islands.contacts[island] += static_cast<std::uint32_t>(run.size());
        if (!has_conjugates(simulation, run.a, run.b)) islands.conjugates[island] = 0;
    }
    islands.falling_mass.assign(count, 0);
    for (BodyId id = 0; id < parent_.size(); ++id) {
        const TypeProperties& type = simulation.type_of(id);
        const std::uint32_t island = number_[root_of(id)];
        if (island == kNone || !(type.inverse_mass > 0)) continue;
        least_mass_[island] = std::min(least_mass_[island], type.mass);
        most_mass_[island] = std::max(most_mass_[island], type.mass);
        if (type.falls) islands.falling_mass[island] += type.mass;
    }
    resize_anew(islands.runs, member_.size());
    counting_sort(
        member_.size(), count, [&](std::size_t i) { return number_[member_[i]]; }, islands.first,
        [&](std::size_t i, std::size_t place) {
            islands.runs[place] = static_cast<std::uint32_t>(i);
        });
}

}  // namespace tesserae
