// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/description.hpp"

namespace tesserae::render {

/// The mean of a pixel's samples and how far it may be off.
class PixelEstimate {
  public:
    void add(const Color& sample) {
        ++count_;
        const Color off = sample - mean_;
        mean_ += off / count_;
        squares_ += off * (sample - mean_);  // Welford 1962: does not cancel
        const double bright = luminance(sample), bright_off = bright - bright_mean_;
        bright_mean_ += bright_off / count_;
        bright_squares_ += bright_off * (bright - bright_mean_);
    }

    int count() const { return count_; }
    const Color& mean() const { return mean_; }
    /// Of the mean, as if samples were independent: stratified ones are better than it says.
    /// Zero with fewer than two samples.
    Color variance() const {
        if (count_ < 2) return Color::Zero();
        return squares_ / (static_cast<double>(count_) * (count_ - 1));
    }
    /// How many samples bring the noise of their mean down to `target`: the standard error of its
    /// luminance as it shows in a picture that is encoded by its square root (nearly sRGB), in
    /// parts of white. What is darker than its error is encoded as if it were that bright. Infinite
    /// with fewer than two samples.
    double samples_for(double target) const {
        if (count_ < 2) return std::numeric_limits<double>::infinity();
        if (bright_squares_ == 0) return 0;
        const double error = 2 * target * std::sqrt(std::max(bright_mean_, 4 * target * target));
        return bright_squares_ / (count_ - 1) / (error * error);
    }

  private:
    /// Rec. 709.
    static double luminance(const Color& c) {
        return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    }

    int count_ = 0;
    Color mean_ = Color::Zero(), squares_ = Color::Zero();
    double bright_mean_ = 0, bright_squares_ = 0;
};

}  // namespace tesserae::render
