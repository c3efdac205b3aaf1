// SPDX-License-Identifier: Apache-2.0
#include "parallel/sort_and_sweep.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>

#include "core/counting_sort.hpp"
#include "core/dynamics/contacts/pairs.hpp"
#include "core/dynamics/step/room.hpp"

namespace tesserae::parallel {
namespace {

/// Bodies of one task: some 10 to 50 us of work.
constexpr std::size_t kGrain = 256, kCellGrain = 32;

/// Radii grow by these parts of themselves and of the centre's largest coordinate, which is more
/// than the rounding of bounds, of distances and of a ball that moves within another can add up to.
constexpr double kPadOfRadius = 1e-12, kPadOfPlace = 1e-13;

/// Width of a cell in extents of the level's largest body, which at 1 would still fit but for
/// rounding. Wider cells hold more bodies that do not meet.
constexpr double kCellWidth = 1.01;

/// Largest extent of the level of most bodies, in mean extents: sizes of 1 to 1.7 share it, and the
/// few that are larger do not make its cells wide.
constexpr double kUsual = 1.4;

constexpr int kBits = 20;
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
/// Coordinates of bodies, so that those beside them fit in too.
constexpr std::uint64_t kFirst = 1, kLast = kMask - 1;

std::uint64_t cell_of(std::uint64_t level, const std::uint64_t (&at)[3]) {
    return ((level << kBits | at[0]) << kBits | at[1]) << kBits | at[2];
}

/// Whether the cell also holds what lies beyond it.
bool is_last(std::uint64_t cell) {
    return (cell & kMask) == kLast || (cell >> kBits & kMask) == kLast ||
           (cell >> (2 * kBits) & kMask) == kLast;
}

/// The order of entries.
constexpr auto kByPlace = [](const auto& i, const auto& j) {
    return std::tie(i.cell, i.lower, i.id) < std::tie(j.cell, j.lower, j.id);
};

double padded(const Bounds& bounds) {
    return bounds.radius * (1 + kPadOfRadius) + kPadOfPlace * bounds.centre.cwiseAbs().maxCoeff();
}

}  // namespace

void SortAndSweep::overlapping_pairs(const Simulation& simulation,
                                     const std::vector<Bounds>& bounds, PairTable& pairs,
                                     const Ranges& ranges) {
    simulation_ = &simulation;
    ranges_ = ranges;
    bounded_.clear();
    unbounded_.clear();
    for (BodyId id = 0; id < simulation.bodies.size(); ++id)
        (simulation.type_of(id).bounded ? bounded_ : unbounded_).push_back(id);

    choose_axes(bounds);
    choose_levels(bounds);
    sort_entries(bounds);
    make_items(simulation, bounds);
    list_cells();
    find_first_cells();
    pair_lists_.collect(
        ranges_, items_.size(), kGrain,
        [&](Range items, std::vector<BodyPair>& list) {
            sweep(items, list);
            add_unbounded(simulation, items, list);
        },
        found_);
    sort_pairs(simulation.bodies.size(), pairs);
}

bool SortAndSweep::replace_pairs_of(const std::vector<std::uint8_t>& moved,
                                    const Simulation& simulation, const std::vector<Bounds>& bounds,
                                    PairTable& pairs, const Ranges& ranges) {
    if (entries_.size() != bounded_.size() || !merge_entries(moved, bounds)) return false;
    simulation_ = &simulation;
    ranges_ = ranges;
    make_items(simulation, bounds);
    list_cells();
    find_first_cells();
    moved_cells_.clear();
    for (std::size_t c = 0; c + 1 < cells_.size(); ++c)
        for (std::size_t i = cells_[c].first; i < cells_[c + 1].first && !cells_[c].moved; ++i)
            if (moved[items_[i].id]) cells_[c].moved = true, moved_cells_.push_back(c);
    pair_lists_.collect(
        ranges_, moved_cells_.size(), kCellGrain,
        [&](Range cells, std::vector<BodyPair>& list) { sweep_moved(moved, cells, list); }, found_);
    std::sort(found_.begin(), found_.end());
    replace_pairs(moved, found_, pairs, merged_pairs_);
    return true;
}

void SortAndSweep::release() {
    const auto of = [](auto& list) { tesserae::release(list); };
    of(entries_), of(items_), of(cells_), of(found_);
    of(moved_entries_), of(merged_entries_), of(moved_cells_);
    of(merged_pairs_.first), of(merged_pairs_.second);
    pair_lists_.release();
}

/// Sorted is the axis along which centres spread most. It changes the time, not the pairs.
void SortAndSweep::choose_axes(const std::vector<Bounds>& bounds) {
    // In the bodies' order, so that rounding does not depend on threads.
    Vec4 sum = Vec4::Zero(), squares = Vec4::Zero();
    origin_.setConstant(std::numeric_limits<double>::infinity());
    for (BodyId id : bounded_) {
        const Vec4& centre = bounds[id].centre;
        sum += centre;
        squares += centre.cwiseAbs2();
        origin_ = origin_.cwiseMin(centre);
    }
    const Vec4 spread =
        squares - sum.cwiseAbs2() / std::max(1.0, static_cast<double>(bounded_.size()));
    sorted_axis_ = 0;
    for (int i = 1; i < 4; ++i)
        if (spread[i] > spread[sorted_axis_]) sorted_axis_ = i;
    for (int i = 0, cut = 0; i < 4; ++i)
        if (i != sorted_axis_) cut_axis_[cut++] = i;
}

void SortAndSweep::choose_levels(const std::vector<Bounds>& bounds) {
    levels_.clear();
    double sum = 0;
    for (BodyId id : bounded_) sum += 2 * padded(bounds[id]);
    usual_ = kUsual * sum / static_cast<double>(bounded_.size());
    for (BodyId id : bounded_) {
        const double extent = 2 * padded(bounds[id]);
        const int exponent = exponent_of(extent);
        auto level = levels_.begin() + static_cast<std::ptrdiff_t>(level_of(extent));
        if (level == levels_.end() || level->exponent != exponent)
            level = levels_.insert(level, {exponent});
        level->cell = std::max(level->cell, kCellWidth * extent);
        ++level->bodies;
    }
    while (levels_.size() > kMostLevels) {
        const auto fewest =
            std::min_element(levels_.begin(), levels_.end() - 1,
                             [](const Level& k, const Level& l) { return k.bodies < l.bodies; });
        (fewest + 1)->bodies += fewest->bodies;
        levels_.erase(fewest);
    }
    // An end, so that all of the last level lies before the next one.
    levels_.push_back({std::numeric_limits<int>::max()});
}

int SortAndSweep::exponent_of(double extent) const { return -std::ilogb(usual_ / extent); }

/// The first level for bodies of this extent or larger ones.
std::size_t SortAndSweep::level_of(double extent) const {
    const int exponent = exponent_of(extent);
    std::size_t level = 0;
    while (level < levels_.size() && levels_[level].exponent < exponent) ++level;
    return level;
}

/// Monotone in x; what lies farther than the last cell is in the last.
std::uint64_t SortAndSweep::coordinate(const Level& level, int cut, double x) const {
    const double cells = (x - origin_[cut_axis_[cut]]) / level.cell;
    return kFirst +
           static_cast<std::uint64_t>(std::clamp(cells, 0.0, static_cast<double>(kLast - kFirst)));
}

SortAndSweep::Entry SortAndSweep::entry_of(BodyId id, std::size_t level, const Bounds& ball) const {
    std::uint64_t at[3];
    for (int cut = 0; cut < 3; ++cut)
        at[cut] = coordinate(levels_[level], cut, ball.centre[cut_axis_[cut]]);
    return {cell_of(level, at), ball.centre[sorted_axis_] - padded(ball), id};
}

void SortAndSweep::sort_entries(const std::vector<Bounds>& bounds) {
    entries_.resize(bounded_.size());
    ranges_.for_each(bounded_.size(), kGrain, [&](Range range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const Bounds& ball = bounds[bounded_[i]];
            entries_[i] = entry_of(bounded_[i], level_of(2 * padded(ball)), ball);
        }
    });
    tbb::parallel_sort(entries_, kByPlace);
}

/// Puts the bodies that moved into the grids of the last search.
/// @return whether their extents fit into these
bool SortAndSweep::merge_entries(const std::vector<std::uint8_t>& moved,
                                 const std::vector<Bounds>& bounds) {
    moved_entries_.clear(), merged_entries_.clear();
    for (const BodyId id : bounded_) {
        if (!moved[id]) continue;
        const double extent = 2 * padded(bounds[id]);
        std::size_t level = level_of(extent);
        while (level + 1 < levels_.size() && levels_[level].cell < kCellWidth * extent) ++level;
        if (level + 1 >= levels_.size()) return false;
        moved_entries_.push_back(entry_of(id, level, bounds[id]));
    }
    std::sort(moved_entries_.begin(), moved_entries_.end(), kByPlace);
    const auto stays = std::remove_if(entries_.begin(), entries_.end(),
                                      [&](const Entry& entry) { return moved[entry.id]; });
    std::merge(entries_.begin(), stays, moved_entries_.begin(), moved_entries_.end(),
               std::back_inserter(merged_entries_), kByPlace);
    entries_.swap(merged_entries_);
    return true;
}

void SortAndSweep::make_items(const Simulation& simulation, const std::vector<Bounds>& bounds) {
    items_.resize(entries_.size());
    ranges_.for_each(entries_.size(), kGrain, [&](Range range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const BodyId id = entries_[i].id;
            const Vec4& centre = bounds[id].centre;
            const double radius = padded(bounds[id]);
            const TypeProperties& type = simulation.type_of(id);
            items_[i] = {centre,
                         radius,
                         entries_[i].lower,
                         centre[sorted_axis_] + radius,
                         id,
                         type.movable,
                         type.collides_with != kAllGroups};
        }
    });
}

void SortAndSweep::list_cells() {
    cells_.clear();
    for (std::size_t i = 0; i < entries_.size(); ++i)
        if (i == 0 || entries_[i].cell != entries_[i - 1].cell)
            cells_.push_back({entries_[i].cell, i});
    // An end, so that all of the last cell lies before the next one.
    cells_.push_back({std::numeric_limits<std::uint64_t>::max(), entries_.size()});
}

void SortAndSweep::find_first_cells() {
    const std::size_t end = cells_.size() - 1;
    for (std::size_t k = 0; k + 1 < levels_.size(); ++k)
        levels_[k].first = static_cast<std::size_t>(
            std::lower_bound(cells_.begin(), cells_.begin() + static_cast<std::ptrdiff_t>(end),
                             std::uint64_t{k} << (3 * kBits),
                             [](const Cell& c, std::uint64_t cell) { return c.cell < cell; }) -
            cells_.begin());
    levels_.back().first = end;
}

/// The pairs of bodies that moved, of the cells that hold them, with any other.
void SortAndSweep::sweep_moved(const std::vector<std::uint8_t>& moved, Range cells,
                               std::vector<BodyPair>& pairs) const {
    const std::size_t begin = pairs.size();
    for (std::size_t k = cells.begin; k < cells.end; ++k) {
        const std::size_t c = moved_cells_[k], end = cells_[c + 1].first;
        for (std::size_t i = cells_[c].first; i < end; ++i) {
            ranges_.look_for_stop();
            for (std::size_t j = i + 1; j < end && items_[j].lower <= items_[i].upper; ++j)
                add_if_overlapping(items_[i], items_[j], pairs);
            if (moved[items_[i].id]) add_unbounded(*simulation_, {i, i + 1}, pairs);
        }
        const std::size_t at_once = is_last(cells_[c].cell) ? 1 : end - cells_[c].first;
        for (std::size_t level = 0; level + 1 < levels_.size(); ++level)
            for (std::size_t i = cells_[c].first; i < end; i += at_once) {
                const Range those{i, i + at_once};
                for_each_cell(reached(those, levels_[level]), levels_[level].first,
                              levels_[level + 1].first, [&](std::size_t other) {
                                  // Of two such cells the first sees the other.
                                  if (other == c || (cells_[other].moved && other < c)) return;
                                  meet(those, {cells_[other].first, cells_[other + 1].first},
                                       levels_[level].cell, pairs);
                              });
            }
    }
    const auto stay = [&](const BodyPair& pair) { return !moved[pair.a] && !moved[pair.b]; };
    pairs.erase(
        std::remove_if(pairs.begin() + static_cast<std::ptrdiff_t>(begin), pairs.end(), stay),
        pairs.end());
}

/// The pairs of which the first, by cell and then by lower end, is in the range.
void SortAndSweep::sweep(Range items, std::vector<BodyPair>& pairs) const {
    std::size_t c = static_cast<std::size_t>(
        std::upper_bound(cells_.begin(), cells_.end(), items.begin,
                         [](std::size_t i, const Cell& cell) { return i < cell.first; }) -
        cells_.begin() - 1);
    for (std::size_t begin = items.begin; begin < items.end; ++c) {
        const std::size_t end = cells_[c + 1].first;
        const Range part{begin, std::min(items.end, end)};
        for (std::size_t i = part.begin; i < part.end; ++i)
            for (std::size_t j = i + 1; j < end && items_[j].lower <= items_[i].upper; ++j)
                add_if_overlapping(items_[i], items_[j], pairs);

        const std::size_t own = cells_[c].cell >> (3 * kBits);
        const auto meet_all = [&](Range those, const Box& box, std::size_t first,
                                  std::size_t level) {
            for_each_cell(box, first, levels_[level + 1].first, [&](std::size_t other) {
                meet(those, {cells_[other].first, cells_[other + 1].first}, levels_[level].cell,
                     pairs);
            });
        };
        meet_all(part, beside(cells_[c].cell), c + 1, own);
        // What shares a last cell may be far apart and reach very many cells of a coarser level.
        const std::size_t at_once = is_last(cells_[c].cell) ? 1 : part.end - part.begin;
        for (std::size_t level = own + 1; level + 1 < levels_.size(); ++level)
            for (std::size_t i = part.begin; i < part.end; i += at_once) {
                const Range those{i, i + at_once};
                meet_all(those, reached(those, levels_[level]), levels_[level].first, level);
            }
        begin = part.end;
    }
}

SortAndSweep::Box SortAndSweep::beside(std::uint64_t cell) const {
    Box box;
    for (int cut = 0; cut < 3; ++cut) {
        const std::uint64_t at = cell >> ((2 - cut) * kBits) & kMask;
        box.low[cut] = at - 1;
        box.high[cut] = at + 1;
    }
    return box;
}

/// The cells of the bodies of a level that these may overlap.
SortAndSweep::Box SortAndSweep::reached(Range items, const Level& level) const {
    Box box;
    for (int cut = 0; cut < 3; ++cut) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t i = items.begin; i < items.end; ++i) {
            low = std::min(low, items_[i].centre[cut_axis_[cut]] - items_[i].radius);
            high = std::max(high, items_[i].centre[cut_axis_[cut]] + items_[i].radius);
        }
        box.low[cut] = coordinate(level, cut, low - 0.5 * level.cell);
        box.high[cut] = coordinate(level, cut, high + 0.5 * level.cell);
    }
    return box;
}

/// Visits the places of each cell of the box from the first place in cells_ and before the last.
/// Jumps from one that is not in the box to the next that may be, so that a box may be of any size.
template <class Visit>
void SortAndSweep::for_each_cell(const Box& box, std::size_t first, std::size_t last,
                                 const Visit& visit) const {
    const auto from = [&](std::size_t c, std::uint64_t cell) {
        // Most are near: search ever farther before searching between.
        std::size_t step = 1;
        while (c + step < last && cells_[c + step].cell < cell) {
            c += step;
            step *= 2;
        }
        return static_cast<std::size_t>(
            std::lower_bound(cells_.begin() + static_cast<std::ptrdiff_t>(c),
                             cells_.begin() + static_cast<std::ptrdiff_t>(std::min(last, c + step)),
                             cell, [](const Cell& a, std::uint64_t b) { return a.cell < b; }) -
            cells_.begin());
    };
    for (std::size_t c = first; c < last;) {
        const std::uint64_t cell = cells_[c].cell, level = cell >> (3 * kBits);
        const std::uint64_t x = cell >> (2 * kBits) & kMask, y = cell >> kBits & kMask,
                            z = cell & kMask;
        if (x > box.high[0]) return;
        if (x < box.low[0])
            c = from(c, cell_of(level, box.low));
        else if (y < box.low[1])
            c = from(c, cell_of(level, {x, box.low[1], box.low[2]}));
        else if (y > box.high[1])
            c = from(c, cell_of(level, {x + 1, box.low[1], box.low[2]}));
        else if (z < box.low[2])
            c = from(c, cell_of(level, {x, y, box.low[2]}));
        else if (z > box.high[2])
            c = from(c, cell_of(level, {x, y + 1, box.low[2]}));
        else {
            visit(c);
            ++c;
        }
    }
}

/// The pairs of one of the items and one of the others, which are part of a cell of another column
/// and at most so wide. Of two that overlap along the sorted axis, that which begins first finds
/// the other.
void SortAndSweep::meet(Range items, Range others, double widest,
                        std::vector<BodyPair>& pairs) const {
    std::size_t i = items.begin;
    auto j = static_cast<std::size_t>(
        std::lower_bound(items_.begin() + static_cast<std::ptrdiff_t>(others.begin),
                         items_.begin() + static_cast<std::ptrdiff_t>(others.end),
                         items_[i].lower - widest,
                         [](const Item& item, double lower) { return item.lower < lower; }) -
        items_.begin());
    while (i < items.end && j < others.end) {
        if (items_[i].lower <= items_[j].lower) {
            for (std::size_t k = j; k < others.end && items_[k].lower <= items_[i].upper; ++k)
                add_if_overlapping(items_[i], items_[k], pairs);
            ++i;
        } else {
            for (std::size_t k = i; k < items.end && items_[k].lower <= items_[j].upper; ++k)
                add_if_overlapping(items_[j], items_[k], pairs);
            ++j;
        }
    }
}

void SortAndSweep::add_if_overlapping(const Item& a, const Item& b,
                                      std::vector<BodyPair>& pairs) const {
    if (!overlap({a.centre, a.radius}, {b.centre, b.radius}) || !(a.movable || b.movable)) return;
    if ((a.choosy || b.choosy) && !collide(simulation_->type_of(a.id), simulation_->type_of(b.id)))
        return;
    pairs.push_back({std::min(a.id, b.id), std::max(a.id, b.id)});
}

void SortAndSweep::add_unbounded(const Simulation& simulation, Range items,
                                 std::vector<BodyPair>& pairs) const {
    for (std::size_t i = items.begin; i < items.end; ++i)
        for (const BodyId other : unbounded_) {
            const Item& item = items_[i];
            if (item.movable && collide(simulation.type_of(item.id), simulation.type_of(other)) &&
                reaches({item.centre, item.radius}, simulation.bodies.type_of(other).shape))
                pairs.push_back({std::min(item.id, other), std::max(item.id, other)});
        }
}

/// By counting each body's pairs, and then each body's by their second.
void SortAndSweep::sort_pairs(std::size_t bodies, PairTable& sorted) {
    auto& first = sorted.first;
    auto& second = sorted.second;
    resize_anew(second, found_.size());
    counting_sort(
        found_.size(), bodies, [&](std::size_t i) { return found_[i].a; }, first,
        [&](std::size_t i, std::size_t place) { second[place] = found_[i].b; });
    ranges_.for_each(bodies, kGrain, [&](Range range) {
        for (std::size_t a = range.begin; a < range.end; ++a)
            std::sort(second.begin() + static_cast<std::ptrdiff_t>(first[a]),
                      second.begin() + static_cast<std::ptrdiff_t>(first[a + 1]));
    });
}

}  // namespace tesserae::parallel
