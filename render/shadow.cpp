#include "render/shadow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/light/cap.hpp"

namespace tesserae::render {
namespace {

/// A sun smaller than this [rad] is hard: nobody sees the difference, and the radiance of its disc,
/// which grows with the cube, would leave the range of double.
constexpr double kHard = 1e-9;
/// Bodies that a walk meets before its cone narrows. To begin anew with a narrower cone costs the
/// walk about two boxes' tests: too much where it soon ends, as in a small sun's cone.
constexpr int kBeforeNarrowing = 4;

}  // namespace

SunDisc sun_disc(const Sun& sun) {
    double angle = sun.angle * (std::numbers::pi / 180);
    if (angle < kHard) angle = 0;
    SunDisc disc = {
        {-sun.direction, angle, {std::sin(angle), std::cos(angle)}}, sun.irradiance, Color::Zero()};
    if (angle > 0) disc.radiance = sun.irradiance / cap_irradiance(angle, std::numbers::pi / 2);
    return disc;
}

double rim_sine(const PlacedBodies& placed, std::uint32_t index, const Vec4& origin,
                const Vec4& direction, const RimRange& range, FrameStats& stats) {
    const PlacedBody& body = placed.bodies[index];
    return std::visit(
        [&](const auto& shape) {
            const Rim least = rim(shape, placed.point_to_body(body, origin),
                                  placed.direction_to_body(body, direction), range);
            stats.distance_evaluations += static_cast<std::uint64_t>(least.steps);
            return least.sine;
        },
        *body.shape);
}

double visible_part(double x) {
    if (x <= -1) return 0;
    if (x >= 1) return 1;
    return 0.25 * (2 + 3 * x - x * x * x);
}

bool Shadows::is_behind(const LightDisc& light, const Vec4& point, std::uint32_t body) const {
    if (light.limit == kMiss) return false;
    const PlacedBody& b = placed_.bodies[body];
    return (b.centre - point).norm() - b.radius > light.limit;
}

bool Shadows::is_hidden(const LightDisc& light, const Vec4& point, std::uint32_t on,
                        FrameStats& stats) const {
    bool hidden = false;
    const auto clears = [&](std::uint32_t body) {
        hidden = body != on && !is_behind(light, point, body) &&
                 rim_sine(placed_, body, point, light.toward, {0, 0, light.limit}, stats) < 0;
        return !hidden;
    };
    for (std::uint32_t body : tree_.unbounded())
        if (!clears(body)) return true;
    tree_.for_each_on_ray(point, light.toward, light.limit, clears);
    return hidden;
}

double Shadows::visibility(const LightDisc& light, const Vec4& point, std::uint32_t on,
                           FrameStats& stats) const {
    ++stats.shadow_rays;
    if (light.angle == 0) return is_hidden(light, point, on, stats) ? 0 : 1;

    // The cone that can still matter narrows to the nearest rim found.
    double least = light.cone.sine;
    Cone cone = light.cone;
    int bodies = 0;
    const auto narrow = [&](std::uint32_t body) {
        if (body == on || is_behind(light, point, body)) return true;
        const double sine = rim_sine(placed_, body, point, light.toward,
                                     {-light.cone.sine, least, light.limit}, stats);
        least = std::min(least, sine);
        if (++bodies >= kBeforeNarrowing && least < cone.sine)
            cone = {least, std::sqrt(std::max(0.0, 1 - least * least))};
        return least > -light.cone.sine;
    };
    for (std::uint32_t body : tree_.unbounded())
        if (!narrow(body)) return 0;
    tree_.for_each_in_cone(point, light.toward, cone, narrow);
    if (least <= -light.cone.sine) return 0;
    return visible_part(std::asin(least) / light.angle);
}

}  // namespace tesserae::render
