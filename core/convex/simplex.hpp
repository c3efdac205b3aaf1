#pragma once

#include <array>
#include <span>

#include "core/convex/minkowski_difference.hpp"

namespace tesserae {

/// v without what of it lies along n orthonormal directions, again where that was most of it: the
/// rest is orthogonal to them to rounding of itself (Kahan, Parlett: twice is enough).
Vec4 orthogonal_part(const Vec4& v, const Vec4* directions, int n);

/// A simplex of 1 to 5 points of a Minkowski difference and the point of it that is nearest to a
/// target. Of the points only those are kept that the nearest point is in the inside of.
///
/// The nearest point after another one is added is found as in Wolfe, "Finding the nearest point in
/// a polytope" (1976): go toward the nearest point of the affine hull; drop the point whose weight
/// becomes 0 on the way; repeat. Wolfe's normal equations, solved twice, serve only where the edges
/// are well apart in direction; near-degenerate simplices need them made orthonormal. Unlike the
/// trial of all faces (Gilbert, Johnson, Keerthi 1988) it mostly takes one or two solutions, and
/// the distance never rises.
class Simplex {
  public:
    /// Starts anew with one point.
    void start(const Vec4& target, const DifferencePoint& point);
    /// Starts anew with 1 to 5 points; those are kept that the nearest point is in the inside of.
    void start(const Vec4& target, std::span<const DifferencePoint> points);
    /// Takes in a point. False: that brought the nearest point no nearer.
    bool add(const DifferencePoint& point, double at_least);

    /// Finds the nearest point again by orthonormal edges alone, and so from now on. False: they
    /// make no difference.
    bool refine();

    /// As seen from the target.
    const Vec4& nearest() const { return nearest_; }
    /// Whether the target is inside of 5 points.
    bool contains_target() const { return contains_target_; }
    const Vec4& target() const { return target_; }
    /// Where on body a the nearest point comes from.
    Vec4 nearest_on_a() const;

    int count() const { return count_; }
    const DifferencePoint& point(int i) const { return points_[static_cast<std::size_t>(i)]; }

  private:
    static constexpr int kMaxPoints = 5;

    /// The points from one of them.
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
    std::array<Vec4, kMaxPoints> seen_;  ///< the points from the target
    std::array<double, kMaxPoints> weight_;
    int count_ = 0;
    bool contains_target_ = false;
    bool is_careful_ = false;  ///< only by orthonormal edges
};

}  // namespace tesserae
