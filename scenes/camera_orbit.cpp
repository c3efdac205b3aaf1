// SPDX-License-Identifier: Apache-2.0
#include "scenes/camera_orbit.hpp"

#include <cmath>
#include <numbers>

namespace tesserae::scenes {
namespace {

/// Cosine and sine. Whole turns are left out before anything rounds, and quarter turns are exact.
std::array<double, 2> cosine_and_sine(double degrees) {
    const double rest = std::remainder(degrees, 360);
    const double quarters = std::round(rest / 90);
    const double angle = (rest - 90 * quarters) * (std::numbers::pi / 180);
    const double c = std::cos(angle), s = std::sin(angle);
    switch (static_cast<int>(quarters)) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case -1:
            return {s, -c};
        default:
            return {-c, -s};
    }
}

}  // namespace

double eased(Ease ease, double part) {
    switch (ease) {
        case Ease::kIn:
            return part * part;
        case Ease::kOut:
            return part * (2 - part);
        case Ease::kInOut:
            return part * part * (3 - 2 * part);
        case Ease::kLinear:
            break;
    }
    return part;
}

double eased_slope(Ease ease, double part) {
    switch (ease) {
        case Ease::kIn:
            return 2 * part;
        case Ease::kOut:
            return 2 * (1 - part);
        case Ease::kInOut:
            return 6 * part * (1 - part);
        case Ease::kLinear:
            break;
    }
    return 1;
}

Vec4 CameraOrbit::turned(const Vec4& from, double part) const {
    const auto [i, j] = kPlaneAxes[plane];
    const auto [c, s] = cosine_and_sine(part * angle);
    const double a = from[i] - about[i], b = from[j] - about[j];
    Vec4 to = from;
    to[i] = about[i] + (c * a - s * b);
    to[j] = about[j] + (s * a + c * b);
    return to;
}

double CameraOrbit::radius(const Vec4& from) const {
    const auto [i, j] = kPlaneAxes[plane];
    return std::hypot(from[i] - about[i], from[j] - about[j]);
}

Vec4 CameraArc::at(double time) const { return orbit.turned(from, eased(ease, part(time))); }

Vec4 CameraArc::velocity(double time) const {
    const auto [i, j] = kPlaneAxes[orbit.plane];
    const Vec4 here = at(time) - orbit.about;
    const double rate = orbit.angle * (std::numbers::pi / 180) * eased_slope(ease, part(time)) /
                        (end - begin);  // [rad/s]
    return rate * (here[i] * Vec4::Unit(j) - here[j] * Vec4::Unit(i));
}

}  // namespace tesserae::scenes
