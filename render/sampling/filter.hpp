// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "render/camera/camera.hpp"

namespace tesserae::render {

/// A pixel filter that is sampled: samples fall with the filter's density and all weigh the same,
/// so that each belongs to one pixel, and neither crop nor tiles change one (M. Ernst et al.,
/// "Filter importance sampling", 2006). Separable, never negative, zero beyond half its width from
/// the pixel's centre. The Gaussian is cut at three standard deviations; Blackman-Harris is the
/// window of four terms.
class PixelFilter {
  public:
    /// @param width   of the filter's support [pixels], > 0
    PixelFilter(FilterKind kind, double width);

    /// Where a sample falls, from the pixel's upper left corner [pixels].
    /// @param u   uniform in [0, 1)^2
    Vec2 place(const Vec2& u) const { return {0.5 + offset(u.x()), 0.5 + offset(u.y())}; }

    /// How far samples fall beyond the pixel's sides at most [pixels].
    double reach() const { return width_ > 1 ? 0.5 * (width_ - 1) : 0; }

  private:
    double offset(double u) const;

    FilterKind kind_;
    double width_;
    /// For kinds without a closed form: the points of [-1/2, 1/2] that part the filter into equal
    /// shares.
    std::vector<double> quantiles_;
};

}  // namespace tesserae::render
