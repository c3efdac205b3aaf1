// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/convex/placed_hull.hpp"

namespace tesserae {

/// A VertexSearch looks for the vertices that the nearest points of two polytopes lie between, or
/// that surround a point which both share. It works as Simplex does, but computes each step from
/// the last. That loses a digit or two in each of its few rounds, which is not accurate enough for
/// nearly degenerate cases. The separation is therefore computed from what this finds, by
/// separation_of().
///
/// With the points y_i of the Minkowski difference go the vectors r_i in their span with r_i . y_j
/// = 1 where i = j, else 0. Their sum u is v / |v|^2, where v is the point of the affine hull that
/// is nearest to the origin, and r_i . u / |u|^2 are its weights. Adding a point or leaving one out
/// takes a sum of such vectors. All r_i lie side by side, the same component of each in one
/// register.
class VertexSearch {
  public:
    /// A Pair is a vertex of each body, by their numbers.
    struct Pair {
        std::uint32_t of_a, of_b;
    };

    VertexSearch(const PlacedHull& a, const PlacedHull& b);

    /// An End says how a search ended.
    enum class End {
        kNear,  ///< found the pairs of the nearest points, or five around a shared point
        kFar,   ///< the one pair shows a gap above `enough` along far_direction()
    };
    /// Runs the search.
    /// @param guess    unit direction from a to b, world
    /// @param enough   a gap above this ends the search [m]
    End run(const Vec4& guess, double enough);

    /// Returns the number of pairs that were found; the heaviest comes first.
    int count() const { return count_; }
    const Pair& pair(int i) const { return found_[static_cast<std::size_t>(i)]; }
    const Vec4& far_direction() const { return far_direction_; }

  private:
    using Double4 = simd::Double4;
    static constexpr std::size_t kSlots = 4;
    struct Point {
        Double4 at;
        Pair pair;
    };

    Point support(Double4 toward_origin) const;
    bool is_enough(Double4 toward, const Point& point, double enough);
    void start(const Point& point);
    bool take_in(const Point& point, double slope);
    bool leave_out_negative(Double4 old, double square);
    void put(std::size_t slot, const Point& point, Double4 own, double slope, Double4 parts);
    void drop(std::size_t slot);
    void gather();
    Double4 parts_of(Double4 x) const;
    Double4 own_of(std::size_t slot) const;

    const PlacedHull &a_, &b_;
    std::array<Double4, 4> turn_, turn_back_;  ///< from b's frame to a's: columns; rows
    Double4 between_;                          ///< b's centre in a's frame
    std::array<Point, kSlots> point_;
    std::array<Double4, 4> dual_;  ///< component by component of r_0 to r_3; 0 where no point is
    Double4 sum_;                  ///< u
    Double4 weight_;               ///< times |u|^2
    double square_ = 0;            ///< |u|^2
    unsigned taken_ = 0;           ///< bits of the slots that have a point
    std::array<Pair, kSlots + 1> found_;
    int count_ = 0;
    Vec4 far_direction_;
};

}  // namespace tesserae
