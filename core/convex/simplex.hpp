// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/convex/minkowski_difference.hpp"

namespace tesserae {

/// Returns the part of v that is orthogonal to n orthonormal directions. If that is only a small
/// part of v, it is computed twice, so that the result is orthogonal to rounding of itself (Kahan,
/// Parlett: twice is enough).
Vec4 orthogonal_part(const Vec4& v, const Vec4* directions, int n);

/// A Simplex is 1 to 5 points of a Minkowski difference, and the point of it that is nearest to a
/// target. It keeps only the points that have the nearest point in their inside.
///
/// After a point is added, the nearest point is found as in Wolfe, "Finding the nearest point in a
/// polytope" (1976): go toward the nearest point of the affine hull; drop the point whose weight
/// becomes 0 on the way; repeat. Wolfe's normal equations, solved twice, serve only where the
/// directions of the edges are well apart. The edges of near-degenerate simplices are first made
/// orthonormal. Unlike the trial of all faces (Gilbert, Johnson, Keerthi 1988) it mostly takes one
/// or two solutions, and the distance never rises.
class Simplex {
  public:
    /// Starts again with one point.
    void start(const Vec4& target, const DifferencePoint& point);
    /// Starts again with 1 to 5 points. Those are kept that have the nearest point in their inside.
    void start(const Vec4& target, std::span<const DifferencePoint> points);
    /// Adds a point. Returns false, and changes nothing, if the point is there already or there are
    /// five.
    /// @param at_least   lower bound of the distance from the target; a nearest point below it is
    ///                   rounding
    bool add(const DifferencePoint& point, double at_least);

    /// Finds the nearest point again by orthonormal edges alone, and does so from now on. Returns
    /// false if that makes no difference.
    bool refine();

    /// Returns the nearest point, relative to the target.
    const Vec4& nearest() const { return nearest_; }
    /// Returns whether the target is inside of 5 points.
    bool contains_target() const { return contains_target_; }
    const Vec4& target() const { return target_; }
    /// Returns the point of body a that the nearest point comes from.
    Vec4 nearest_on_a() const;

    int count() const { return count_; }
    const DifferencePoint& point(int i) const { return points_[static_cast<std::size_t>(i)]; }

  private:
    static constexpr int kMaxPoints = 5;

    /// The edges from one of the points, `base`, to the others.
    struct Edges {
        int base, count;
        std::array<Vec4, kMaxPoints - 1> edge;
        std::array<double, kMaxPoints - 1> part;  ///< weights of the points at their ends
    };

    Edges edges_from_heaviest() const;
    bool find_upright(Edges& edges, Vec4& nearest) const;
    bool find_orthonormal(Edges& edges, Vec4& nearest) const;
    bool find_affine_nearest(double* weight, Vec4& nearest) const;
    bool is_inside(const double* weight) const;
    void take(const double* weight, const Vec4& nearest);
    void step_toward(const double* weight);
    void drop(int i);
    void merge_last();

    Vec4 target_, nearest_;
    std::array<DifferencePoint, kMaxPoints> points_;
    std::array<Vec4, kMaxPoints> seen_;  ///< the points relative to the target
    std::array<double, kMaxPoints> weight_;
    int count_ = 0;
    bool contains_target_ = false;
    bool is_careful_ = false;  ///< uses only orthonormal edges, see refine()
};

}  // namespace tesserae
