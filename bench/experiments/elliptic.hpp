// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tesserae::bench {

/// The Jacobi elliptic functions of the argument u and the modulus k, k'^2 = 1 - k^2.
struct Elliptic {
    double sn, cn, dn;
};

/// By the arithmetic-geometric mean (Abramowitz and Stegun, section 16.4), for which k' is given,
/// since near k = 1 the difference 1 - k^2 loses what matters.
/// @param u   within some periods, |u| < 1000
/// @param complement   k', 0 < k' <= 1
Elliptic elliptic(double u, double complement);

/// The quarter period K = pi / (2 agm(1, k')).
double quarter_period(double complement);

}  // namespace tesserae::bench
