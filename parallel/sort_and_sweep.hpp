// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/dynamics/contacts/chunked_list.hpp"
#include "core/dynamics/step/step_data.hpp"
#include "parallel/pair_table.hpp"
#include "parallel/ranges.hpp"

namespace tesserae::parallel {

/// Finds overlapping balls in time that grows little faster than their number.
///
/// In four dimensions one sorted axis is not enough: of N bodies in a pile each overlaps N^(3/4)
/// others along it. So space is cut into cells along the three other axes, each body is put into
/// the cell of its centre, and each cell's bodies are sorted along the fourth. What a body overlaps
/// is then in its own cell or in one beside it, and is looked for only as far as it reaches.
///
/// Sizes differ: bodies are divided into levels by powers of two of their extent, and each level
/// has a grid of its own, with cells as wide as its largest body. A cell's bodies meet those of the
/// cells beside it and of the coarser grids' cells that they reach. Unbounded bodies meet all
/// others.
class SortAndSweep {
  public:
    /// Levels are at most so many: when sizes differ more, the level with the fewest bodies joins
    /// the next coarser one. Each costs a body a search in its grid; too few, and small bodies are
    /// compared with all in a cell that is far larger than they are.
    static constexpr std::size_t kMostLevels = 8;

    /// @param bounds   of every body
    /// @param pairs    becomes all pairs that overlap and one of which contacts can
    ///                 move, and a few that miss each other by less than rounding
    void overlapping_pairs(const Simulation& simulation, const std::vector<Bounds>& bounds,
                           PairTable& pairs, const Ranges& ranges = Ranges());

    /// Searches again for the pairs of some bodies, where all others have the bounds of the last
    /// search. Takes little time if these are few.
    /// @param moved   1 for these, for every body
    /// @param pairs   as it was found; its pairs of these bodies are replaced
    /// @return whether that was possible; else nothing has changed, and a search for all is due
    bool replace_pairs_of(const std::vector<std::uint8_t>& moved, const Simulation& simulation,
                          const std::vector<Bounds>& bounds, PairTable& pairs,
                          const Ranges& ranges = Ranges());

    /// Gives back the memory that it keeps for the next search.
    void release();

  private:
    struct Level {
        int exponent;     ///< largest binary exponent of its bodies' extents
        double cell = 0;  ///< width of the grid's cells [m]
        std::size_t bodies = 0;
        std::size_t first = 0;  ///< place of its first cell in cells_
    };
    /// What bodies are sorted by.
    struct Entry {
        std::uint64_t cell;  ///< level, then three coordinates of 20 bits
        double lower;        ///< along the sorted axis [m]
        BodyId id;
    };
    /// A bounded body, with its ball enlarged by more than rounding can take from it.
    struct Item {
        Vec4 centre;                  ///< world [m]
        double radius, lower, upper;  ///< [m], the latter along the sorted axis
        BodyId id;
        bool movable;
        bool choosy;  ///< it does not collide with every group
    };
    struct Cell {
        std::uint64_t cell;
        std::size_t first;   ///< place in items_
        bool moved = false;  ///< it holds a body that is searched again
    };
    /// From the first to the last coordinate, both included, on the three cut axes.
    struct Box {
        std::uint64_t low[3], high[3];
    };

    void choose_axes(const std::vector<Bounds>& bounds);
    void choose_levels(const std::vector<Bounds>& bounds);
    int exponent_of(double extent) const;
    std::size_t level_of(double extent) const;
    std::uint64_t coordinate(const Level& level, int cut, double x) const;
    void sort_entries(const std::vector<Bounds>& bounds);
    bool merge_entries(const std::vector<std::uint8_t>& moved, const std::vector<Bounds>& bounds);
    Entry entry_of(BodyId id, std::size_t level, const Bounds& ball) const;
    void make_items(const Simulation& simulation, const std::vector<Bounds>& bounds);
    void list_cells();
    void find_first_cells();
    void sweep_moved(const std::vector<std::uint8_t>& moved, Range cells,
                     std::vector<BodyPair>& pairs) const;
    void sweep(Range items, std::vector<BodyPair>& pairs) const;
    Box beside(std::uint64_t cell) const;
    Box reached(Range items, const Level& level) const;
    template <class Visit>
    void for_each_cell(const Box& box, std::size_t first, std::size_t last,
                       const Visit& visit) const;
    void meet(Range items, Range others, double widest, std::vector<BodyPair>& pairs) const;
    void add_if_overlapping(const Item& a, const Item& b, std::vector<BodyPair>& pairs) const;
    void add_unbounded(const Simulation& simulation, Range items,
                       std::vector<BodyPair>& pairs) const;
    void sort_pairs(std::size_t bodies, PairTable& sorted);

    const Simulation* simulation_ = nullptr;   ///< of the search under way
    Ranges ranges_;                            ///< of the search under way
    std::vector<BodyId> bounded_, unbounded_;  ///< ascending
    int sorted_axis_ = 0, cut_axis_[3] = {1, 2, 3};
    Vec4 origin_;                 ///< least coordinates of all centres [m]
    double usual_ = 0;            ///< levels are counted from this extent [m]
    std::vector<Level> levels_;   ///< ascending, and an end
    std::vector<Entry> entries_;  ///< ascending by (cell, lower, id)
    std::vector<Item> items_;     ///< in the order of entries_
    std::vector<Cell> cells_;     ///< those that hold bodies, ascending, and the end of items_
    ChunkedList<BodyPair> pair_lists_;
    std::vector<BodyPair> found_;
    // For replace_pairs_of().
    std::vector<Entry> moved_entries_, merged_entries_;
    std::vector<std::size_t> moved_cells_;
    PairTable merged_pairs_;
};

}  // namespace tesserae::parallel
