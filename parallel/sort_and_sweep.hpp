#pragma once

#include <cstdint>

#include "core/dynamics/step_data.hpp"
#include "parallel/chunks.hpp"

namespace tesserae::parallel {

/// The same pairs as core's find_pairs(), in time that grows little faster than the bodies' number.
///
/// In four dimensions one sorted axis is not enough: of N bodies in a pile each overlaps N^(3/4)
/// others along it. So space is cut into cells along the three other axes, the bounds in each cell
/// are sorted along the fourth, and from each the others are looked at only as far as it reaches. A
/// pair is reported in one cell, that of the lower corner of what the two have in common.
///
/// Sizes differ: bodies are divided into levels by powers of two of their extent, and each level
/// has a grid of its own, with cells twice as wide as its largest body. A level's grid also holds
/// the bodies of all finer levels, to meet its own. Unbounded bodies meet all others.
class SortAndSweep {
  public:
    void find_pairs(const Simulation& simulation, StepData& step);

  private:
    /// Bodies whose extent has the same binary exponent.
    struct Level {
        int exponent;
        double cell = 0;   ///< width of the grid's cells [m]
        double finer = 0;  ///< largest extent of all finer levels [m]
    };
    /// A body's bounds along the sorted axis, in one of the cells that it touches.
    struct Entry {
        std::uint64_t cell;   ///< of its level: three coordinates of 21 bits
        std::uint32_t level;  ///< place in levels_
        bool is_finer;        ///< than the level: met by the level's own bodies only
        double lower, upper;  ///< [m]
        BodyId id;
    };

    void choose_axes(const StepData& step);
    void choose_levels(const StepData& step);
    void add_entries(const StepData& step, BodyId id, std::vector<Entry>& list) const;
    std::uint64_t coordinate(const Level& level, int cut, double x) const;
    std::uint64_t home_cell(const Level& level, const Bounds& a, const Bounds& b) const;
    void sweep(const Simulation& simulation, const StepData& step, Range entries,
               std::vector<BodyPair>& pairs) const;
    void add_unbounded(const Simulation& simulation, const StepData& step, Range bounded,
                       std::vector<BodyPair>& pairs) const;
    void sort_pairs(std::size_t bodies, std::vector<BodyPair>& sorted);

    std::vector<BodyId> bounded_, unbounded_;  ///< ascending
    int sorted_axis_ = 0, cut_axis_[3] = {1, 2, 3};
    Vec4 origin_;                ///< lower corner of all bounds [m]
    std::vector<Level> levels_;  ///< ascending
    /// Of the bounded ones, ascending by (level, cell, is_finer, lower, id).
    std::vector<Entry> entries_;
    ChunkedList<Entry> entry_lists_;
    ChunkedList<BodyPair> pair_lists_, unbounded_lists_;
    std::vector<BodyPair> found_, with_unbounded_;
    std::vector<std::size_t> end_;  ///< of each body's pairs, as their first
};

}  // namespace tesserae::parallel
