#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstring>

#include "core/simd/simd.hpp"

namespace tesserae {

/// A point or direction of 4D space; axes x, y, z, w.
using Vec4 = Eigen::Vector4d;
/// One that is stored among numbers: its alignment would cost a record a third of its bytes.
using PackedVec4 = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;
/// Two numbers that belong together, as a shape's two radii.
using Vec2 = Eigen::Vector2d;
/// A linear map of 4D space; column i is the image of axis i.
using Mat4 = Eigen::Matrix4d;

/// The vector of four numbers that were just computed, put together in registers. The constructor
/// stores them one by one, and to read them back as one vector stalls for a dozen cycles.
inline Vec4 assembled(double x, double y, double z, double w) {
    const simd::Double4 four = {x, y, z, w};
    Vec4 v;
    std::memcpy(v.data(), &four, sizeof four);
    return v;
}

/// -1 for negative numbers, else 1: also for both zeros.
inline double sign_of(double x) { return x < 0 ? -1 : 1; }

/// Whether a sum of squares lies where none overflows, and one that underflows is below 2^-53 of
/// it.
inline bool is_plain_square(double sum) { return sum > 1e-290 && sum < 1e300; }

/// |v| without overflow or underflow of the squares on the way: 0 only for v = 0, infinite only if
/// |v| is beyond double.
/// Accuracy: 4 ulp (StableNorm.MatchesLongDouble).
inline double stable_norm(const Vec4& v) {
    const double sum = v.squaredNorm();
    if (is_plain_square(sum)) return std::sqrt(sum);
    const double largest = v.cwiseAbs().maxCoeff();
    if (largest == 0 || std::isinf(largest)) return largest;
    return largest * (v / largest).norm();
}

/// v / |v| for any finite nonzero v, however small or large.
inline Vec4 stable_normalized(const Vec4& v) {
    const double sum = v.squaredNorm();
    if (is_plain_square(sum)) return v / std::sqrt(sum);
    const Vec4 scaled = v / v.cwiseAbs().maxCoeff();
    return scaled / scaled.norm();
}

}  // namespace tesserae
