// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstring>

#include "core/simd/simd.hpp"

namespace tesserae {

/// A Vec4 is a point or direction of 4D space, with axes x, y, z, w.
using Vec4 = Eigen::Vector4d;
/// A PackedVec4 is a Vec4 without alignment, for records. Alignment would add a third to a record's
/// bytes.
using PackedVec4 = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;
/// A Vec2 is two numbers that belong together, for example a shape's two radii.
using Vec2 = Eigen::Vector2d;
/// A Mat4 is a linear map of 4D space. Its column i is the image of axis i.
using Mat4 = Eigen::Matrix4d;

/// Makes a vector in registers from four numbers that were just computed. The constructor would
/// store them one by one, and reading them back as one vector stalls for a dozen cycles.
inline Vec4 assembled(double x, double y, double z, double w) {
    const simd::Double4 four = {x, y, z, w};
    Vec4 v;
    std::memcpy(v.data(), &four, sizeof four);
    return v;
}

/// Returns -1 for negative numbers, else 1, also for both zeros.
inline double sign_of(double x) { return x < 0 ? -1 : 1; }

/// Returns whether a sum of squares can be used as it is: no square has overflowed, and one that
/// has underflowed is below 2^-53 of the sum.
inline bool is_plain_square(double sum) { return sum > 1e-290 && sum < 1e300; }

/// Returns |v| without overflow or underflow of the squares on the way. It is 0 only for v = 0, and
/// infinite only if |v| is beyond double.
/// Accuracy: 4 ulp (StableNorm.MatchesLongDouble).
inline double stable_norm(const Vec4& v) {
    const double sum = v.squaredNorm();
    if (is_plain_square(sum)) return std::sqrt(sum);
    const double largest = v.cwiseAbs().maxCoeff();
    if (largest == 0 || std::isinf(largest)) return largest;
    return largest * (v / largest).norm();
}

/// Returns v / |v| for any finite nonzero v, however small or large.
inline Vec4 stable_normalized(const Vec4& v) {
    const double sum = v.squaredNorm();
    if (is_plain_square(sum)) return v / std::sqrt(sum);
    const Vec4 scaled = v / v.cwiseAbs().maxCoeff();
    return scaled / scaled.norm();
}

}  // namespace tesserae
