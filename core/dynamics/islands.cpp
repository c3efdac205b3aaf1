#include "core/dynamics/islands.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

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
    islands.first_colour.assign(1, 0);
    islands.colours.clear();
    used_.assign(simulation.bodies.size(), 0);
    for (std::size_t island = 0; island < islands.size(); ++island) {
        const Range places = islands.places(island);
        if (places.end - places.begin >= kColouredFrom) colour(simulation, step, island);
        islands.first_colour.push_back(static_cast<std::uint32_t>(islands.colours.size()));
    }
}

void IslandBuilder::sort_by_island(const Simulation& simulation, StepData& step) {
    const std::vector<Contact>& contacts = step.contacts;
    TSR_ASSERT(contacts.size() < std::numeric_limits<std::uint32_t>::max());
    const auto movable = [&](BodyId id) { return simulation.type_of(id).movable; };
    const auto member = [&](const Contact& c) { return movable(c.a) ? c.a : c.b; };

    // Join, the lower root above the higher one.
    parent_.resize(simulation.bodies.size());
    std::iota(parent_.begin(), parent_.end(), BodyId{0});
    for (const Contact& c : contacts) {
        if (!movable(c.a) || !movable(c.b)) continue;
        const BodyId i = root_of(c.a), j = root_of(c.b);
        parent_[std::max(i, j)] = std::min(i, j);
    }

    // Number the roots that have contacts, ascending.
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    number_.assign(parent_.size(), kNone);
    for (const Contact& c : contacts) number_[root_of(member(c))] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t& number : number_)
        if (number != kNone) number = count++;

    // Counting sort of the contacts by island; it keeps their order within each.
    Islands& islands = step.islands;
    islands.first.assign(count + 1, 0);
    for (const Contact& c : contacts) ++islands.first[number_[root_of(member(c))] + 1];
    std::partial_sum(islands.first.begin(), islands.first.end(), islands.first.begin());
    islands.contacts.resize(contacts.size());
    for (std::uint32_t i = 0; i < contacts.size(); ++i)
        islands.contacts[islands.first[number_[root_of(member(contacts[i]))]]++] = i;
    // Filling moved each start to its island's end: shift them back.
    std::shift_right(islands.first.begin(), islands.first.end(), 1);
    islands.first.front() = 0;
}

/// Each contact, in order, gets the first colour that none of its movable bodies has yet.
void IslandBuilder::colour(const Simulation& simulation, StepData& step, std::size_t island) {
    constexpr int kColours = 64;
    const Range places = step.islands.places(island);
    const auto begin = step.islands.contacts.begin() + static_cast<std::ptrdiff_t>(places.begin);
    const std::size_t size = places.end - places.begin;
    std::uint32_t count[kColours + 1] = {};  // the last one: left over
    colour_.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
        const Contact& c = step.contacts[begin[static_cast<std::ptrdiff_t>(i)]];
        std::uint64_t taken = 0;
        for (const BodyId id : {c.a, c.b})
            if (simulation.type_of(id).movable) taken |= used_[id];
        const int colour = std::countr_one(taken);  // 64 if all are taken
        colour_[i] = static_cast<std::uint8_t>(colour);
        ++count[colour];
        if (colour == kColours) continue;
        for (const BodyId id : {c.a, c.b})
            if (simulation.type_of(id).movable) used_[id] |= std::uint64_t{1} << colour;
    }

    // Counting sort.
    std::uint32_t start[kColours + 1];
    std::exclusive_scan(std::begin(count), std::end(count), start, 0u);
    sorted_.resize(size);
    for (std::size_t i = 0; i < size; ++i)
        sorted_[start[colour_[i]]++] = begin[static_cast<std::ptrdiff_t>(i)];
    std::copy(sorted_.begin(), sorted_.end(), begin);
    for (int colour = 0; colour < kColours && count[colour] > 0; ++colour)
        step.islands.colours.push_back(static_cast<std::uint32_t>(places.begin) + start[colour]);
}

}  // namespace tesserae
