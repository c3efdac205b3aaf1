#include "render/sampling/cap.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tesserae::render {
namespace {

using std::numbers::pi;

/// x - sin x. Below 1 the alternating series: its first left out term is under 1e-17 of the first.
double minus_sine(double x) {
    if (x > 1) return x - std::sin(x);
    double term = x * x * x / 6, sum = 0;
    for (int n = 4; n <= 20; n += 2) {
        sum += term;
        term *= -x * x / (n * (n + 1));
    }
    return sum;
}

/// angle - sin cos.
double cap_part(double angle) { return 0.5 * minus_sine(2 * angle); }

Eigen::Vector3d uniform_sphere(double u, double v) {
    const double z = 1 - 2 * u, across = std::sqrt(std::max(0.0, 1 - z * z));
    return {across * std::cos(2 * pi * v), across * std::sin(2 * pi * v), z};
}

}  // namespace

TangentFrame::TangentFrame(const Vec4& axis) : sign_(axis[3] > 0 ? -1 : 1) {
    mirror_ = (axis - sign_ * Vec4::UnitW()).normalized();
}

Vec4 TangentFrame::to_world(const Vec4& local) const {
    const Vec4 v(local[0], local[1], local[2], sign_ * local[3]);
    return v - 2 * mirror_.dot(v) * mirror_;
}

Vec4 TangentFrame::to_local(const Vec4& world) const {
    Vec4 v = world - 2 * mirror_.dot(world) * mirror_;
    v[3] *= sign_;
    return v;
}

Eigen::Vector3d uniform_ball(const Uniform3& u) {
    return std::cbrt(u[0]) * uniform_sphere(u[1], u[2]);
}

Vec4 cosine_direction(const Uniform3& u) {
    const Eigen::Vector3d p = uniform_ball(u);
    return {p.x(), p.y(), p.z(), std::sqrt(std::max(0.0, 1 - p.squaredNorm()))};
}

double cap_solid_angle(double angle) { return 2 * pi * cap_part(angle); }

Vec4 cap_direction(double angle, const Uniform3& u) {
    const double part = u[0] * cap_part(angle);
    // (angle - sin cos) = part turned round, in powers of the root of its first term.
    const double root = std::cbrt(1.5 * part), square = root * root;
    double polar = root * (1 + square * (1.0 / 15 + square * (2.0 / 175 + square * (4.0 / 1575))));
    if (!(polar > 0)) return Vec4::UnitW();
    // Halley's method triples the digits: one step below about 0.6, two up to pi/2. The last one is
    // so small that it turns sine and cosine too, but for its third power.
    constexpr double kLastStep = 1e-5;
    double sine = 0, cosine = 0;
    for (int i = 0; i < 4; ++i) {
        sine = std::sin(polar), cosine = std::cos(polar);
        const double newton = (cap_part(polar) - part) / (2 * sine * sine);
        const double step = newton / (1 - newton * cosine / sine);
        if (std::abs(step) <= kLastStep * polar) {
            const double half = 0.5 * step * step;
            const double turned = sine - half * sine - step * cosine;
            cosine += step * sine - half * cosine;
            sine = turned;
            break;
        }
        polar -= step;
    }
    const Eigen::Vector3d across = sine * uniform_sphere(u[1], u[2]);
    return {across.x(), across.y(), across.z(), cosine};
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
