// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/algebra/vector.hpp"

// Integrals over the directions of 4D, S^3.
namespace tesserae::render {

using std::numbers::pi;

/// The direction at a polar angle, its tangent part at an angle from the x axis.
inline Vec4 direction_at(double polar, double turn) {
    const double across = std::sin(polar);
    return {across * std::cos(turn), across * std::sin(turn), 0, std::cos(polar)};
}

/// Integral over the directions with polar angle in [a, b] and turn in [p, q] of a function that is
/// symmetric around the plane of x and the normal: midpoints, solid angle
/// 4 pi sin^2(polar) dpolar sin(turn) dturn/2.
template <class F>
double integral(const F& f, double a, double b, double p, double q, int steps) {
    // Every ring has the same turns, whose sines take longer than many an integrand.
    std::vector<Vec4> turned;
    for (int j = 0; j < steps; ++j)
        turned.push_back(direction_at(pi / 2, p + (q - p) * (j + 0.5) / steps));
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double polar = a + (b - a) * (i + 0.5) / steps;
        const double across = std::sin(polar), up = std::cos(polar);
        double ring = 0;
        for (const Vec4& t : turned) ring += t[1] * f(Vec4(across * t[0], across * t[1], 0, up));
        sum += ring * across * across;
    }
    return sum * 2 * pi * (b - a) * (q - p) / (steps * steps);
}

/// The directional albedo: what a surface sends back of a uniform field of radiance 1.
template <class Brdf>
double albedo_by_quadrature(const Brdf& brdf, int steps = 900) {
    return integral([&](const Vec4& in) { return brdf(in) * in[3]; }, 0, pi / 2, 0, pi, steps);
}

}  // namespace tesserae::render
