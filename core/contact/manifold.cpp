#include "core/contact/manifold.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <utility>

#include "core/error.hpp"

namespace tesserae {
namespace {

/// Squared distances that differ by less than this part count as about equal: a point 5 % farther
/// out is not worth giving up one that is deeper.
constexpr double kAboutEqual = 0.9;
/// Points that leave a line or a plane by less than 1e-6 of the manifold's length (squared here)
/// do not span another dimension.
constexpr double kFlat = 1e-12;

struct Candidate {
    Vec4 place;     ///< relative to the deepest, seen along the normal
    Vec4 residual;  ///< what is left of it orthogonal to the dimensions that are spanned
    double nearest = std::numeric_limits<double>::infinity();  ///< squared, to the kept points
};

class Reduction {
  public:
    Reduction(std::span<ContactPoint> points, const Vec4& normal) : points_(points) {
        keep(deepest_of([](std::size_t) { return true; }));
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec4 between = points[i].point - points[0].point;
            candidates_[i].place = between - normal.dot(between) * normal;
            candidates_[i].residual = candidates_[i].place;
        }
        approach(candidates_[0]);
    }

    void run() {
        const double length = farthest(&Reduction::off_span);
        for (int dimension = 0; dimension < 3; ++dimension) {
            if (!(farthest(&Reduction::off_span) > kFlat * length)) break;
            add_farthest(&Reduction::off_span);
            span(candidates_[kept_ - 1].residual.normalized());
        }
        while (kept_ < kManifoldPoints) add_farthest(&Reduction::off_points);
    }

  private:
    using Measure = double (Reduction::*)(std::size_t) const;
    double off_span(std::size_t i) const { return candidates_[i].residual.squaredNorm(); }
    double off_points(std::size_t i) const { return candidates_[i].nearest; }

    double farthest(Measure measure) const {
        double most = 0;
        for (std::size_t i = kept_; i < points_.size(); ++i)
            most = std::max(most, (this->*measure)(i));
        return most;
    }
    void add_farthest(Measure measure) {
        const double enough = kAboutEqual * farthest(measure);
        keep(deepest_of([&](std::size_t i) { return (this->*measure)(i) >= enough; }));
        approach(candidates_[kept_ - 1]);
    }
    template <class Allowed>
    std::size_t deepest_of(Allowed allowed) const {
        std::size_t best = kept_;
        bool found = false;
        for (std::size_t i = kept_; i < points_.size(); ++i) {
            if (!allowed(i)) continue;
            if (!found || key(i) < key(best)) best = i;
            found = true;
        }
        return best;
    }
    std::tuple<double, std::uint32_t> key(std::size_t i) const {
        return {points_[i].separation, points_[i].feature};
    }
    void keep(std::size_t i) {
        std::swap(points_[i], points_[kept_]);
        std::swap(candidates_[i], candidates_[kept_]);
        ++kept_;
    }
    void span(const Vec4& direction) {
        for (std::size_t i = kept_; i < points_.size(); ++i)
            candidates_[i].residual -= direction.dot(candidates_[i].residual) * direction;
    }
    void approach(const Candidate& kept) {
        for (std::size_t i = kept_; i < points_.size(); ++i)
            candidates_[i].nearest =
                std::min(candidates_[i].nearest, (candidates_[i].place - kept.place).squaredNorm());
    }

    std::span<ContactPoint> points_;
    std::array<Candidate, kManifoldInput> candidates_;
    std::size_t kept_ = 0;
};

}  // namespace

std::size_t reduce_manifold(std::span<ContactPoint> points, const Vec4& normal) {
    TSR_ASSERT(points.size() <= kManifoldInput);
    const std::size_t kept = std::min(points.size(), kManifoldPoints);
    if (kept < points.size()) Reduction(points, normal).run();
    std::sort(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(kept),
              [](const ContactPoint& a, const ContactPoint& b) { return a.feature < b.feature; });
    return kept;
}

}  // namespace tesserae
