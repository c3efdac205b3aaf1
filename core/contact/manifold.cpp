// SPDX-License-Identifier: Apache-2.0
#include "core/contact/manifold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/contact/branchless.hpp"
#include "core/error.hpp"

namespace tesserae {
namespace {

/// Squared distances that differ by less than this part count as about equal: a point 5 % farther
/// out is not worth giving up one that is deeper,
constexpr double kAboutEqual = 0.9;
/// if it is so by this part of the manifold's length. What lies flat rocks by less: all of the
/// points would be taken on the side to which it leans by a hair, and it would tip over to the
/// other one.
constexpr double kLevel = 1e-3;
/// Squared distances that differ by less than this part are equal.
constexpr double kAsFar = 1 - 1e-6;
/// An overlap of this part of the manifold's length is no rest: points that are less than half as
/// deep as the deepest are then taken last. They would take the places of those that push out.
constexpr double kSunk = 0.05;
/// Points that leave a line or a plane by less than 1e-6 of the manifold's length (squared here)
/// do not span another dimension.
constexpr double kFlat = 1e-12;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A number of each of four points, or a coordinate: one instruction serves all four.
using Lanes = Eigen::Array4d;
using Coordinates = std::array<Lanes, 4>;

Lanes dot(const Coordinates& v, const Vec4& with) {
    return v[0] * with[0] + v[1] * with[1] + v[2] * with[2] + v[3] * with[3];
}
void remove_along(const Vec4& unit, Coordinates& v) {
    const Lanes along = dot(v, unit);
    for (int k = 0; k < 4; ++k) v[k] -= along * unit[k];
}
Lanes squared_norms(const Coordinates& v) {
    return v[0].square() + v[1].square() + v[2].square() + v[3].square();
}

struct FourPoints {
    Coordinates place;     ///< relative to the deepest, seen along the normal
    Coordinates residual;  ///< what is left of it orthogonal to the dimensions that are spanned
    Lanes nearest;         ///< squared distance to the kept points
    Lanes most;  ///< what a measure of a point may be: -1 where one is kept or there is none
};
/// The numbers 0 to count - 1 where is_before(i, j) puts them: by counting, since sorting so few
/// costs more in mispredicted branches.
template <class IsBefore>
std::array<std::uint8_t, kManifoldInput> sorted(std::size_t count, IsBefore is_before) {
    std::array<std::uint8_t, kManifoldInput> order{};
    for (std::size_t i = 0; i < count; ++i) {
        unsigned place = 0;
        for (std::size_t j = 0; j < count; ++j) place += is_before(j, i) ? 1u : 0u;
        order[place] = static_cast<std::uint8_t>(i);
    }
    return order;
}

class Reduction {
  public:
    Reduction(std::span<const ContactPoint> points, const Vec4& normal)
        : points_(points), fours_((points.size() + 3) / 4) {
        std::array<double, kManifoldInput> separation;
        std::array<std::uint32_t, kManifoldInput> feature;
        for (std::size_t i = 0; i < points.size(); ++i)
            separation[i] = points[i].separation, feature[i] = points[i].feature;
        order_ = sorted(points.size(), [&](std::size_t i, std::size_t j) {
            return either(separation[i] < separation[j],
                          both(separation[i] == separation[j], feature[i] < feature[j]));
        });
        const Vec4 deepest = points[order_[0]].point;
        for (std::size_t i = 0; i < 4 * fours_; ++i) {
            const Vec4 place =
                i < points.size() ? Vec4(points[order_[i]].point - deepest) : Vec4(Vec4::Zero());
            FourPoints& four = four_[i / 4];
            for (int k = 0; k < 4; ++k) four.place[k][i % 4] = place[k];
            four.most[i % 4] = i < points.size() ? kInfinity : -1;
            separation_[i] = i < points.size() ? separation[order_[i]] : kInfinity;
        }
        for (std::size_t f = 0; f < fours_; ++f) {
            FourPoints& four = four_[f];
            remove_along(normal, four.place);
            four.residual = four.place;
            four.nearest = squared_norms(four.place);
        }
        keep(0);
    }

    /// The points to keep.
    std::array<ContactPoint, kManifoldPoints> run() {
        const auto from_kept = [](const FourPoints& four) { return four.nearest; };
        length_ = std::sqrt(farthest(from_kept));
        const std::size_t sunk =
            -separation_[0] > kSunk * length_
                ? static_cast<std::size_t>(std::upper_bound(separation_.begin(),
                                                            separation_.begin() + points_.size(),
                                                            0.5 * separation_[0]) -
                                           separation_.begin())
                : points_.size();
        for (std::size_t i = sunk; i < points_.size(); ++i) four_[i / 4].most[i % 4] = -1;
        span(sunk);
        while (count_ < std::min(sunk, kManifoldPoints)) keep(first_of(farthest(from_kept)));
        for (std::size_t i = sunk; i < points_.size(); ++i) four_[i / 4].most[i % 4] = kInfinity;
        while (count_ < kManifoldPoints) keep(first_of(farthest(from_kept)));

        std::array<ContactPoint, kManifoldPoints> result;
        for (std::size_t i = 0; i < count_; ++i) result[i] = points_[order_[kept_[i]]];
        return result;
    }

  private:
    /// Keeps points until all dimensions are spanned, or as many.
    void span(std::size_t points) {
        const auto off_span = [](const FourPoints& four) { return squared_norms(four.residual); };
        double length = 0;
        for (int dimension = 0; dimension < 3 && count_ < points; ++dimension) {
            const double most = farthest(off_span);
            if (dimension == 0) length = most;
            if (!(most > kFlat * length)) break;
            keep(first_of(most));
            const Vec4 direction = one_of(&FourPoints::residual, kept_[count_ - 1]).normalized();
            for (std::size_t f = 0; f < fours_; ++f) remove_along(direction, four_[f].residual);
        }
    }
    template <class Measure>
    double farthest(Measure measure) {
        Lanes largest = Lanes::Constant(-1);
        for (std::size_t f = 0; f < fours_; ++f) {
            measured_[f] = measure(four_[f]).min(four_[f].most);
            largest = largest.max(measured_[f]);
        }
        return largest.maxCoeff();
    }
    double measured(std::size_t i) const { return measured_[i / 4][i % 4]; }
    /// Of those that are about the farthest the deepest, of those about as deep the farthest, of
    /// those as far the one of the lowest feature.
    std::size_t first_of(double most) const {
        const double enough = kAboutEqual * most;
        std::size_t deepest = 0;
        while (deepest + 1 < points_.size() && !(measured(deepest) >= enough)) ++deepest;
        const double level = separation_[deepest] + kLevel * length_;
        double farthest = measured(deepest);
        std::size_t end = deepest + 1;
        for (; end < points_.size() && separation_[end] <= level; ++end)
            farthest = std::max(farthest, measured(end));
        std::size_t best = deepest;
        while (best + 1 < end && !(measured(best) >= kAsFar * farthest)) ++best;
        for (std::size_t i = best + 1; i < end; ++i)
            if (measured(i) >= kAsFar * farthest && feature_of(i) < feature_of(best)) best = i;
        return best;
    }
    std::uint32_t feature_of(std::size_t i) const { return points_[order_[i]].feature; }
    Vec4 one_of(Coordinates FourPoints::*which, std::size_t i) const {
        const Coordinates& v = four_[i / 4].*which;
        return {v[0][i % 4], v[1][i % 4], v[2][i % 4], v[3][i % 4]};
    }
    void keep(std::size_t i) {
        kept_[count_++] = i;
        four_[i / 4].most[i % 4] = -1;
        const Vec4 kept = one_of(&FourPoints::place, i);
        for (std::size_t f = 0; f < fours_; ++f) {
            Coordinates between = four_[f].place;
            for (int k = 0; k < 4; ++k) between[k] -= kept[k];
            four_[f].nearest = four_[f].nearest.min(squared_norms(between));
        }
    }

    std::span<const ContactPoint> points_;
    std::size_t fours_;
    std::array<std::uint8_t, kManifoldInput> order_;  ///< of the points, the deepest first
    std::array<FourPoints, kManifoldInput / 4> four_;
    std::array<Lanes, kManifoldInput / 4> measured_;
    std::array<double, kManifoldInput> separation_;  ///< in the order
    double length_ = 0;                              ///< of the manifold
    std::array<std::size_t, kManifoldPoints> kept_{};
    std::size_t count_ = 0;
};

}  // namespace

std::size_t reduce_manifold(std::span<ContactPoint> points, const Vec4& normal) {
    TSR_ASSERT(points.size() <= kManifoldInput);
    if (points.size() <= kManifoldPoints) {
        std::sort(points.begin(), points.end(), [](const ContactPoint& a, const ContactPoint& b) {
            return a.feature < b.feature;
        });
        return points.size();
    }
    const std::array<ContactPoint, kManifoldPoints> kept = Reduction(points, normal).run();
    std::array<std::uint32_t, kManifoldPoints> feature;
    for (std::size_t i = 0; i < kept.size(); ++i) feature[i] = kept[i].feature;
    const auto order =
        sorted(kept.size(), [&](std::size_t i, std::size_t j) { return feature[i] < feature[j]; });
    for (std::size_t i = 0; i < kept.size(); ++i) points[i] = kept[order[i]];
    return kept.size();
}

std::size_t reduce_corners(std::span<ContactPoint> corners, const Vec4& normal) {
    if (corners.size() <= kManifoldPoints) return reduce_manifold(corners, normal);
    const auto is_before = [](const ContactPoint& p, const ContactPoint& q) {
        return p.separation != q.separation ? p.separation < q.separation : p.feature < q.feature;
    };
    std::sort(corners.begin(), corners.end(), is_before);
    std::size_t count = 0;
    for (const ContactPoint& corner : corners) {
        const auto hides = [&](const ContactPoint& deeper) {
            const Vec4 from = corner.point - deeper.point;
            const double along = normal.dot(from), higher = corner.separation - deeper.separation;
            return from.squaredNorm() - along * along < higher * higher;
        };
        if (std::none_of(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(count),
                         hides))
            corners[count++] = corner;
    }
    return reduce_manifold(corners.first(count), normal);
}

}  // namespace tesserae
