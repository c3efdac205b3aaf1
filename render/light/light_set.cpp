#include "render/light/light_set.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/shape/hypersphere.hpp"
#include "render/sampling/cap.hpp"

namespace tesserae::render {
namespace {

using std::numbers::pi;

/// A sun smaller than this [rad] is hard: nobody sees the difference, and the radiance of its disc,
/// which grows with the cube, would leave the range of double.
constexpr double kHard = 1e-9;

}  // namespace

SunDisc sun_disc(const Sun& sun) {
    double angle = sun.angle * (pi / 180);
    if (angle < kHard) angle = 0;
    SunDisc disc = {
        {-sun.direction, angle, {std::sin(angle), std::cos(angle)}}, sun.irradiance, Color::Zero()};
    if (angle > 0) disc.radiance = sun.irradiance / cap_irradiance(angle, pi / 2);
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

LightSet::Seen LightSet::first_sphere(const Ray& ray) const {
    Seen seen;
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
        const Vec4 origin = ray.origin - spheres[i].position;
        const double t = ray_hit(Hypersphere{spheres[i].radius}, origin, ray.direction);
        if (t < ray.limit && t < seen.distance) seen = {i, t};
    }
    return seen;
}

}  // namespace tesserae::render
