// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/filter.hpp"

#include <cmath>
#include <numbers>

namespace tesserae::render {
namespace {

/// Shares between which places are interpolated: the density is then right to 1e-4 of its peak.
constexpr int kShares = 1024;

/// The filter up to a factor, x in [-1/2, 1/2].
double density(FilterKind kind, double x) {
    constexpr double kTurn = 2 * std::numbers::pi;
    if (kind == FilterKind::kGaussian) return std::exp(-0.5 * (6 * x) * (6 * x));
    return 0.35875 + 0.48829 * std::cos(kTurn * x) + 0.14128 * std::cos(2 * kTurn * x) +
           0.01168 * std::cos(3 * kTurn * x);
}

std::vector<double> quantiles_of(FilterKind kind) {
    // Cumulative sums by the trapezoid rule on a grid much finer than the shares.
    constexpr int kSteps = 64 * kShares;
    std::vector<double> sum(kSteps + 1);
    const auto at = [&](int i) { return density(kind, static_cast<double>(i) / kSteps - 0.5); };
    for (int i = 1; i <= kSteps; ++i)
        sum[static_cast<std::size_t>(i)] =
            sum[static_cast<std::size_t>(i - 1)] + 0.5 * (at(i - 1) + at(i));
    std::vector<double> quantiles = {-0.5};
    std::size_t i = 1;
    for (int share = 1; share < kShares; ++share) {
        const double wanted = sum.back() * share / kShares;
        while (sum[i] < wanted) ++i;
        const double part = (wanted - sum[i - 1]) / (sum[i] - sum[i - 1]);
        quantiles.push_back((static_cast<double>(i - 1) + part) / kSteps - 0.5);
    }
    quantiles.push_back(0.5);
    return quantiles;
}

}  // namespace

PixelFilter::PixelFilter(FilterKind kind, double width) : kind_(kind), width_(width) {
    if (kind == FilterKind::kGaussian || kind == FilterKind::kBlackmanHarris)
        quantiles_ = quantiles_of(kind);
}

double PixelFilter::offset(double u) const {
    if (kind_ == FilterKind::kBox) return width_ * (u - 0.5);
    if (kind_ == FilterKind::kTriangle)
        return 0.5 * width_ * (u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u));
    const double share = u * kShares;
    const auto i = static_cast<std::size_t>(share);
    const double part = share - static_cast<double>(i);
    return width_ * (quantiles_[i] + part * (quantiles_[i + 1] - quantiles_[i]));
}

}  // namespace tesserae::render
