// SPDX-License-Identifier: Apache-2.0
#include "bench/experiments/elliptic.hpp"

#include <cmath>

#include "bench/bodies.hpp"

namespace tesserae::bench {
namespace {

/// The mean converges quadratically: from any k' >= 1e-300, eleven steps reach the last bit.
constexpr int kLevels = 12;

}  // namespace

Elliptic elliptic(double u, double complement) {
    // a and c = (a - b)/2 of every level, down to where a = b.
    double a[kLevels + 1], c[kLevels + 1];
    double b = complement;
    a[0] = 1;
    c[0] = 0;  // not used
    for (int i = 0; i < kLevels; ++i) {
        a[i + 1] = 0.5 * (a[i] + b);
        c[i + 1] = 0.5 * (a[i] - b);
        b = std::sqrt(a[i] * b);
    }
    // The amplitude, level by level upwards: sin(2 phi_(i-1) - phi_i) = c_i/a_i sin(phi_i).
    double phi = std::ldexp(a[kLevels] * u, kLevels);
    for (int i = kLevels; i > 0; --i) phi = 0.5 * (phi + std::asin(c[i] / a[i] * std::sin(phi)));
    const double sn = std::sin(phi), cn = std::cos(phi);
    // dn^2 = 1 - k^2 sn^2, without the difference.
    return {sn, cn, std::sqrt(cn * cn + complement * complement * sn * sn)};
}

double quarter_period(double complement) {
    double a = 1, b = complement;
    for (int i = 0; i < kLevels; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return 0.5 * pi / a;
}

}  // namespace tesserae::bench
