#include "core/contact/manifold.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "core/contact/branchless.hpp"
#include "core/error.hpp"

namespace tesserae {
namespace {

/// Squared distances that differ by less than this part count as about equal: a point 5 % farther
/// out is not worth giving up one that is deeper.
constexpr double kAboutEqual = 0.9;
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
        const auto off_span = [](const FourPoints& four) { return squared_norms(four.residual); };
        double length = 0;
        for (int dimension = 0; dimension < 3; ++dimension) {
            const double most = farthest(off_span);
            if (dimension == 0) length = most;
            if (!(most > kFlat * length)) break;
            keep(first_of(most));
            const Vec4 direction = one_of(&FourPoints::residual, kept_[count_ - 1]).normalized();
            for (std::size_t f = 0; f < fours_; ++f) remove_along(direction, four_[f].residual);
        }
        while (count_ < kManifoldPoints)
            keep(first_of(farthest([](const FourPoints& four) { return four.nearest; })));

        std::array<ContactPoint, kManifoldPoints> result;
        for (std::size_t i = 0; i < count_; ++i) result[i] = points_[order_[kept_[i]]];
        return result;
    }

  private:
    template <class Measure>
    double farthest(Measure measure) {
        Lanes largest = Lanes::Constant(-1);
        for (std::size_t f = 0; f < fours_; ++f) {
            measured_[f] = measure(four_[f]).min(four_[f].most);
            largest = largest.max(measured_[f]);
        }
        return largest.maxCoeff();
    }
    /// The deepest of those that are about the farthest.
    std::size_t first_of(double most) const {
        const double enough = kAboutEqual * most;
        std::size_t i = 0;
        while (i + 1 < points_.size() && !(measured_[i / 4][i % 4] >= enough)) ++i;
        return i;
    }
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

}  // namespace tesserae
