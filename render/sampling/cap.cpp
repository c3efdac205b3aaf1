// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/cap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace tesserae::render {
namespace {

using std::numbers::pi;

/// x - sin x. Below 1 the alternating series: its first left out term is under 1e-17 of the first.
double minus_sine(double x) {
    if (x > 1) return x - std::sin(x);
    constexpr auto kTerms = [] {
        std::array<double, 9> terms{};
        double factorial = 6;
        for (std::size_t k = 0; k < terms.size(); ++k) {
            terms[k] = (k % 2 ? -1 : 1) / factorial;
            factorial *= static_cast<double>((2 * k + 4) * (2 * k + 5));
        }
        return terms;
    }();
    const double square = x * x;
    double sum = 0;
    for (std::size_t k = kTerms.size(); k-- > 0;) sum = sum * square + kTerms[k];
    return x * square * sum;
}

/// angle - sin cos.
double cap_part(double angle) { return 0.5 * minus_sine(2 * angle); }

// In one direction or in four: V is double or simd::Double4.

/// The cube root to 3 %, from the bits of a float.
double root_guess(double x) {
    constexpr std::int32_t kGuess = 0x2a510000;
    const auto bits = simd::same_bits<std::int32_t>(static_cast<float>(x));
    const auto third = static_cast<std::int32_t>(static_cast<float>(bits) * (1.0f / 3));
    return simd::same_bits<float>(third + kGuess);
}
simd::Double4 root_guess(simd::Double4 x) {
    return simd::Double4{root_guess(x[0]), root_guess(x[1]), root_guess(x[2]), root_guess(x[3])};
}

/// Of 0 or a number from 1e-37 up, to 1e-14 of it (of 0: less than 1e-13). Of the guess's error
/// Halley's method keeps two thirds of the cube each time. The library's would take thrice as long,
/// and another library's could give other bits.
template <class V>
[[gnu::always_inline]] inline V cube_root(V x) {
    V root = root_guess(x);
    for (int i = 0; i < 2; ++i) {
        const V cube = root * root * root;
        root *= (cube + 2 * x) / (2 * cube + x);
    }
    return root;
}

template <class V>
[[gnu::always_inline]] inline V not_negative(V x) {
    return simd::larger(x, V{});
}

/// Uniform on the unit 2-sphere.
template <class V>
[[gnu::always_inline]] inline std::array<V, 3> uniform_sphere(V u, V v) {
    // Sine of half the longitude, which goes from -pi/2 to pi/2: Taylor's series, whose first left
    // out term is below 1e-15. What it is out by turns the point, and does not take it off the
    // sphere.
    constexpr auto kTerms = [] {
        std::array<double, 10> terms{};
        double factorial = 1;
        for (std::size_t k = 0; k < terms.size(); ++k) {
            terms[k] = (k % 2 ? -1 : 1) / factorial;
            factorial *= static_cast<double>((2 * k + 2) * (2 * k + 3));
        }
        return terms;
    }();
    const V half = pi * (v - 0.5), square = half * half;
    V sum = V{} + kTerms.back();
    for (std::size_t k = kTerms.size() - 1; k-- > 0;) sum = sum * square + kTerms[k];
    const V sine = half * sum, cosine = simd::square_root(not_negative(1 - sine * sine));
    const V across = 2 * simd::square_root(not_negative(u * (1 - u)));
    return {across * (1 - 2 * sine * sine), across * (2 * sine * cosine), 1 - 2 * u};
}

template <class V>
[[gnu::always_inline]] inline std::array<V, 4> lifted_ball(const std::array<V, 3>& u) {
    const V radius = cube_root(u[0]);
    const auto p = uniform_sphere(u[1], u[2]);
    return {radius * p[0], radius * p[1], radius * p[2],
            simd::square_root(not_negative(1 - radius * radius))};
}

/// Up to this angle the series of Cap::direction does alone: the first term that it leaves out is
/// below 1e-15.
constexpr double kNarrow = 0.4;

/// 1 - cos of the polar angle over the square s of the root that Cap::direction takes, in powers of
/// s: the inverse of (3/2 (angle - sin cos))^(2/3), worked out with fractions.
constexpr std::array<double, 10> kVersine = {1.0 / 2,
                                             1.0 / 40,
                                             11.0 / 2800,
                                             823.0 / 1008000,
                                             150653.0 / 776160000,
                                             3362377.0 / 67267200000,
                                             156912407.0 / 11557728000000,
                                             132463501789.0 / 34580722176000000,
                                             44655090235867.0 / 40152060748800000000.0,
                                             3.3017597331620334e-07};

}  // namespace

FourDirections TangentFrame::to_world(const FourDirections& local) const {
    auto [x, y, z, w] = local.axes;
    w = sign_ * w;
    const simd::Double4 along =
        scale_ * ((mirror_[0] * x + mirror_[1] * y) + (mirror_[2] * z + mirror_[3] * w));
    return {{x - along * mirror_[0], y - along * mirror_[1], z - along * mirror_[2],
             w - along * mirror_[3]}};
}

Vec4 TangentFrame::to_local(const Vec4& world) const {
    Vec4 v = world - (scale_ * mirror_.dot(world)) * mirror_;
    v[3] *= sign_;
    return v;
}

Eigen::Vector3d uniform_ball(const Uniform3& u) {
    const auto p = uniform_sphere(u[1], u[2]);
    return cube_root(u[0]) * Eigen::Vector3d(p[0], p[1], p[2]);
}

Vec4 cosine_direction(const Uniform3& u) {
    const auto d = lifted_ball(u);
    return assembled(d[0], d[1], d[2], d[3]);
}

FourDirections cosine_directions(const FourUniform3& u) { return {lifted_ball(u)}; }

double cap_solid_angle(double angle) { return 2 * pi * cap_part(angle); }

Cap::Cap(double angle) : angle_(angle), part_(cap_part(angle)), root_(std::cbrt(1.5 * part_)) {}

double Cap::solid_angle() const { return 2 * pi * part_; }

/// 1 - cos of the angle from the axis within which lies the part u of the cap.
template <class V>
V Cap::versine(V u) const {
    // (angle - sin cos) = part turned round, in powers of the root of its first term.
    const V root = root_ * cube_root(u), square = root * root;
    V sum = V{} + kVersine.back();
    for (std::size_t k = kVersine.size() - 1; k-- > 0;) sum = sum * square + kVersine[k];
    return square * sum;
}

/// Corrects a versine of a wide cap: Halley's method, which triples the digits.
double Cap::inverted(double part, double versine) const {
    double polar = std::acos(1 - versine);
    for (int i = 0; i < 2 && polar > 0; ++i) {
        const double sine = std::sin(polar), cosine = std::cos(polar);
        const double newton = (cap_part(polar) - part) / (2 * sine * sine);
        polar -= newton / (1 - newton * cosine / sine);
    }
    const double half = std::sin(0.5 * polar);
    return 2 * half * half;
}

Vec4 Cap::direction(const Uniform3& u) const {
    double v = versine(u[0]);
    if (angle_ > kNarrow) v = inverted(u[0] * part_, v);
    const double sine = std::sqrt(v * (2 - v));
    const auto p = uniform_sphere(u[1], u[2]);
    return assembled(sine * p[0], sine * p[1], sine * p[2], 1 - v);
}

FourDirections Cap::directions(const FourUniform3& u) const {
    simd::Double4 v = versine(u[0]);
    if (angle_ > kNarrow)
        for (std::size_t i = 0; i < 4; ++i) v[i] = inverted(u[0][i] * part_, v[i]);
    const simd::Double4 sine = simd::square_root(v * (2 - v));
    const auto p = uniform_sphere(u[1], u[2]);
    return {{sine * p[0], sine * p[1], sine * p[2], 1 - v}};
}

double cap_irradiance(double angle, double altitude) {
    if (altitude <= -angle) return 0;
    const double sine = std::sin(angle);
    if (altitude >= angle) return 4 * pi / 3 * sine * sine * sine * std::sin(altitude);
    // e = 1 - s and d = 1 - a of the docstring.
    const double above = std::sin(0.5 * (altitude + angle));
    const double e = 2 * above * above;
    const double d = 2 * above * std::sin(0.5 * (angle - altitude)) / std::cos(altitude);
    return pi / 3 * e * (e + (2 - e) * d);
}

}  // namespace tesserae::render
