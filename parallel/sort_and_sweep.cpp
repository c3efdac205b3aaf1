#include "parallel/sort_and_sweep.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "core/dynamics/pairs.hpp"

namespace tesserae::parallel {
namespace {

/// Bodies or entries of one task: some 10 us of work.
constexpr std::size_t kGrain = 256;

/// Width of a cell in extents of the level's largest body. A wider cell holds more bodies that do
/// not meet, a narrower one puts each body into more cells: 1.5 to 3 cost the same within a tenth.
constexpr double kCellWidth = 2;

constexpr int kBits = 21;
constexpr double kLastCoordinate = (1 << kBits) - 1;

BodyPair ordered(BodyId i, BodyId j) { return {std::min(i, j), std::max(i, j)}; }

double extent_of(const Bounds& bounds) { return (bounds.upper - bounds.lower).maxCoeff(); }

}  // namespace

void SortAndSweep::find_pairs(const Simulation& simulation, StepData& step) {
    bounded_.clear();
    unbounded_.clear();
    for (BodyId id = 0; id < simulation.bodies.size(); ++id)
        (simulation.type_of(id).bounded ? bounded_ : unbounded_).push_back(id);

    choose_axes(step);
    choose_levels(step);
    entry_lists_.collect(
        bounded_.size(), kGrain,
        [&](Range range, std::vector<Entry>& list) {
            for (std::size_t i = range.begin; i < range.end; ++i)
                add_entries(step, bounded_[i], list);
        },
        entries_);
    tbb::parallel_sort(entries_, [](const Entry& i, const Entry& j) {
        return std::tie(i.level, i.cell, i.is_finer, i.lower, i.id) <
               std::tie(j.level, j.cell, j.is_finer, j.lower, j.id);
    });
    pair_lists_.collect(
        entries_.size(), kGrain,
        [&](Range range, std::vector<BodyPair>& pairs) { sweep(simulation, step, range, pairs); },
        found_);
    unbounded_lists_.collect(
        bounded_.size(), kGrain,
        [&](Range range, std::vector<BodyPair>& pairs) {
            add_unbounded(simulation, step, range, pairs);
        },
        with_unbounded_);
    found_.insert(found_.end(), with_unbounded_.begin(), with_unbounded_.end());
    sort_pairs(simulation.bodies.size(), step.pairs);
}

/// By counting each body's pairs, and then each body's by their second.
void SortAndSweep::sort_pairs(std::size_t bodies, std::vector<BodyPair>& sorted) {
    end_.assign(bodies + 1, 0);
    for (const BodyPair& pair : found_) ++end_[pair.a + 1];
    std::partial_sum(end_.begin(), end_.end(), end_.begin());
    sorted.resize(found_.size());
    for (const BodyPair& pair : found_) sorted[end_[pair.a]++] = pair;
    for_each_range(bodies, kGrain, [&](Range range) {
        for (std::size_t a = range.begin; a < range.end; ++a) {
            const std::size_t begin = a == 0 ? 0 : end_[a - 1];
            std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
                      sorted.begin() + static_cast<std::ptrdiff_t>(end_[a]));
        }
    });
}

/// Sorted is the axis along which centres spread most. It changes the time, not the pairs.
void SortAndSweep::choose_axes(const StepData& step) {
    // In the bodies' order, so that rounding does not depend on threads.
    Vec4 sum = Vec4::Zero(), squares = Vec4::Zero();
    origin_.setConstant(std::numeric_limits<double>::infinity());
    for (BodyId id : bounded_) {
        sum += step.position[id];
        squares += step.position[id].cwiseAbs2();
        origin_ = origin_.cwiseMin(step.bounds[id].lower);
    }
    const Vec4 spread =
        squares - sum.cwiseAbs2() / std::max(1.0, static_cast<double>(bounded_.size()));
    sorted_axis_ = 0;
    for (int i = 1; i < 4; ++i)
        if (spread[i] > spread[sorted_axis_]) sorted_axis_ = i;
    for (int i = 0, cut = 0; i < 4; ++i)
        if (i != sorted_axis_) cut_axis_[cut++] = i;
}

void SortAndSweep::choose_levels(const StepData& step) {
    std::map<int, double> largest;
    for (BodyId id : bounded_) {
        const double extent = extent_of(step.bounds[id]);
        double& known = largest[std::ilogb(extent)];
        known = std::max(known, extent);
    }
    levels_.clear();
    double finer = 0;
    for (const auto& [exponent, extent] : largest) {
        levels_.push_back({exponent, kCellWidth * extent, finer});
        finer = extent;
    }
}

/// Monotone in x, so that a body's cells are all between those of its lower and its upper bound;
/// what lies farther than the last cell is in the last.
std::uint64_t SortAndSweep::coordinate(const Level& level, int cut, double x) const {
    const double cells = (x - origin_[cut_axis_[cut]]) / level.cell;
    return static_cast<std::uint64_t>(std::clamp(cells, 0.0, kLastCoordinate));
}

std::uint64_t SortAndSweep::home_cell(const Level& level, const Bounds& a, const Bounds& b) const {
    std::uint64_t cell = 0;
    for (int cut = 0; cut < 3; ++cut) {
        const int axis = cut_axis_[cut];
        cell = cell << kBits | coordinate(level, cut, std::max(a.lower[axis], b.lower[axis]));
    }
    return cell;
}

void SortAndSweep::add_entries(const StepData& step, BodyId id, std::vector<Entry>& list) const {
    const Bounds& bounds = step.bounds[id];
    const int exponent = std::ilogb(extent_of(bounds));
    for (std::uint32_t k = 0; k < levels_.size(); ++k) {
        const Level& level = levels_[k];
        if (level.exponent < exponent) continue;
        std::uint64_t low[3], high[3];
        for (int cut = 0; cut < 3; ++cut) {
            low[cut] = coordinate(level, cut, bounds.lower[cut_axis_[cut]]);
            high[cut] = coordinate(level, cut, bounds.upper[cut_axis_[cut]]);
        }
        for (std::uint64_t x = low[0]; x <= high[0]; ++x)
            for (std::uint64_t y = low[1]; y <= high[1]; ++y)
                for (std::uint64_t z = low[2]; z <= high[2]; ++z)
                    list.push_back({(x << kBits | y) << kBits | z, k, level.exponent > exponent,
                                    bounds.lower[sorted_axis_], bounds.upper[sorted_axis_], id});
    }
}

void SortAndSweep::sweep(const Simulation& simulation, const StepData& step, Range entries,
                         std::vector<BodyPair>& pairs) const {
    for (std::size_t i = entries.begin; i < entries.end; ++i) {
        const Entry& first = entries_[i];
        if (first.is_finer) continue;
        const Level& level = levels_[first.level];
        const auto is_near = [&](std::size_t j, bool finer) {
            const Entry& e = entries_[j];
            return e.cell == first.cell && e.level == first.level && e.is_finer == finer &&
                   e.lower <= first.upper;
        };
        const auto add = [&](BodyId other) {
            const BodyPair pair = ordered(first.id, other);
            if (is_pair(simulation, step, pair.a, pair.b) &&
                home_cell(level, step.bounds[first.id], step.bounds[other]) == first.cell)
                pairs.push_back(pair);
        };
        for (std::size_t j = i + 1; j < entries_.size() && is_near(j, false); ++j)
            add(entries_[j].id);
        if (level.finer == 0) continue;
        // Finer ones from where none reaches this one (twice as far: nothing is lost by rounding).
        const Entry start{first.cell, first.level, true, first.lower - 2 * level.finer, 0, 0};
        auto j = static_cast<std::size_t>(
            std::lower_bound(entries_.begin(), entries_.end(), start,
                             [](const Entry& e, const Entry& f) {
                                 return std::tie(e.level, e.cell, e.is_finer, e.lower) <
                                        std::tie(f.level, f.cell, f.is_finer, f.lower);
                             }) -
            entries_.begin());
        for (; j < entries_.size() && is_near(j, true); ++j) add(entries_[j].id);
    }
}

void SortAndSweep::add_unbounded(const Simulation& simulation, const StepData& step, Range bounded,
                                 std::vector<BodyPair>& pairs) const {
    for (std::size_t i = bounded.begin; i < bounded.end; ++i)
        for (const BodyId other : unbounded_) {
            const BodyPair pair = ordered(bounded_[i], other);
            if (is_pair(simulation, step, pair.a, pair.b)) pairs.push_back(pair);
        }
}

}  // namespace tesserae::parallel
