// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_set.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/shape/hypersphere.hpp"

namespace tesserae::render {
namespace {

using std::numbers::pi;

/// A sun smaller than this [rad] is hard: nobody sees the difference, and the radiance of its disc,
/// which grows with the cube, would leave the range of double.
constexpr double kHard = 1e-9;

/// Of the square of a distance between a ray and a point: far above its rounding.
constexpr double kRounding = 1e-12;

}  // namespace

SunDisc sun_disc(const Sun& sun) {
    double angle = sun.angle * (pi / 180);
    if (angle < kHard) angle = 0;
    SunDisc disc = {
        {-sun.direction, angle, {std::sin(angle), std::cos(angle)}}, sun.irradiance, Color::Zero()};
    if (angle > 0) disc.radiance = sun.irradiance / cap_irradiance(angle, pi / 2);
    disc.cap = Cap(angle);
    disc.frame = TangentFrame(disc.toward);
    const double half = std::sin(0.5 * angle);
    disc.squared_chord = 4 * half * half;
    return disc;
}

LightSet::LightSet(const Lights& lights, const Vec4& camera_origin) : sky(lights.sky) {
    for (const Sun& sun : lights.suns)
        if ((sun.irradiance > 0).any()) suns.push_back(sun_disc(sun));
    for (PointLight light : lights.points) {
        light.position -= camera_origin;
        if ((light.flux > 0).any()) points.push_back(light);
    }
    for (SphereLight light : lights.spheres) {
        light.position -= camera_origin;
        if ((light.radiance > 0).any()) spheres.push_back(light);
    }
    if (spheres.empty()) return;
    std::vector<std::uint32_t> order(spheres.size());
    std::iota(order.begin(), order.end(), 0u);
    add_balls(order);
}

LightAt LightSet::at(const PointLight& light, const Vec4& point, const Vec4& normal) {
    const Vec4 to = light.position - point;
    const double distance = to.norm();
    if (!(distance > 0)) return {{normal, 0, {0, 1}, 0}, Color::Zero()};
    LightAt at = {{to / distance, 0, {0, 1}, distance}, Color::Zero()};
    const double cosine = normal.dot(at.disc.toward);
    if (cosine > 0)
        at.irradiance = light.flux * (cosine / (2 * pi * pi * distance * distance * distance));
    return at;
}

LightAt LightSet::at(const SphereLight& light, const Vec4& point, const Vec4& normal) {
    const Vec4 to = light.position - point;
    const double distance = to.norm();
    if (distance <= light.radius) return {{normal, 0, {0, 1}, 0}, light.radiance * (4 * pi / 3)};
    const double sine = light.radius / distance;
    const double cosine = std::sqrt((1 - sine) * (1 + sine));
    LightAt at = {{to / distance, std::asin(sine), {sine, cosine}, distance * cosine},
                  Color::Zero()};
    const double altitude = std::asin(std::clamp(normal.dot(at.disc.toward), -1.0, 1.0));
    at.irradiance = light.radiance * cap_irradiance(at.disc.angle, altitude);
    return at;
}

void LightSet::add_balls(std::span<std::uint32_t> some) {
    const std::size_t own = balls_.size();
    Vec4 low = spheres[some[0]].position, high = low;
    for (const std::uint32_t i : some)
        low = low.cwiseMin(spheres[i].position), high = high.cwiseMax(spheres[i].position);
    Ball ball = {0.5 * (low + high), 0, some.size() == 1 ? some[0] : kNone, 0};
    for (const std::uint32_t i : some)
        ball.radius =
            std::max(ball.radius, (spheres[i].position - ball.centre).norm() + spheres[i].radius);
    balls_.push_back(ball);
    if (some.size() > 1) {
        int axis;
        (high - low).maxCoeff(&axis);
        const std::size_t half = some.size() / 2;
        std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(half), some.end(),
                         [&](std::uint32_t a, std::uint32_t b) {
                             return std::pair(spheres[a].position[axis], a) <
                                    std::pair(spheres[b].position[axis], b);
                         });
        add_balls(some.first(half));
        add_balls(some.subspan(half));
    }
    balls_[own].past = static_cast<std::uint32_t>(balls_.size());
}

LightSet::Seen LightSet::first_ball(const Ray& ray) const {
    Seen seen;
    const auto can_meet = [&](const Ball& ball) {
        const Vec4 to = ball.centre - ray.origin;
        const double middle = to.dot(ray.direction), squared = to.squaredNorm();
        // A little more than the ball, for the rounding of a far one.
        const double most = ball.radius * ball.radius + kRounding * squared;
        return squared - middle * middle <= most && (middle >= 0 || squared <= most);
    };
    for (std::size_t b = 0; b < balls_.size();) {
        const Ball& ball = balls_[b];
        if (ball.sphere == kNone) {
            b = can_meet(ball) ? b + 1 : ball.past;
            continue;
        }
        const SphereLight& light = spheres[ball.sphere];
        const double t =
            ray_hit(Hypersphere{light.radius}, ray.origin - light.position, ray.direction);
        const bool is_first =
            t < seen.distance || (t == seen.distance && t < kMiss && ball.sphere < seen.sphere);
        if (t < ray.limit && is_first) seen = {ball.sphere, t};
        ++b;
    }
    return seen;
}

}  // namespace tesserae::render
