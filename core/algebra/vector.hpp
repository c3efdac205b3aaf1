#pragma once

#include <Eigen/Core>
#include <cmath>

namespace tesserae {

/// A point or direction of 4D space; axes x, y, z, w.
using Vec4 = Eigen::Vector4d;
/// A linear map of 4D space; column i is the image of axis i.
using Mat4 = Eigen::Matrix4d;

/// |v| without overflow or underflow of the squares on the way: 0 only for v = 0, infinite only if
/// |v| is beyond double.
/// Accuracy: 4 ulp (StableNorm.MatchesLongDouble).
inline double stable_norm(const Vec4& v) {
    // Within these bounds no square overflows, and one that underflows is below 2^-53 of the sum.
    const double sum = v.squaredNorm();
    if (sum > 1e-290 && sum < 1e300) return std::sqrt(sum);
    const double largest = v.cwiseAbs().maxCoeff();
    if (largest == 0 || std::isinf(largest)) return largest;
    return largest * (v / largest).norm();
}

/// v / |v| for any finite nonzero v, however small or large.
inline Vec4 stable_normalized(const Vec4& v) {
    const Vec4 scaled = v / v.cwiseAbs().maxCoeff();
    return scaled / scaled.norm();
}

}  // namespace tesserae
