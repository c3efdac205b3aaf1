#include "render/light/shadow.hpp"

#include <algorithm>
#include <cmath>

namespace tesserae::render {
namespace {

/// Bodies that a walk meets before its cone narrows. To begin anew with a narrower cone costs the
/// walk about two boxes' tests: too much where it soon ends, as in a small sun's cone.
constexpr int kBeforeNarrowing = 4;

}  // namespace

double rim_sine(const PlacedBodies& placed, std::uint32_t index, const Ray& ray, double low,
                double high, FrameStats& stats) {
    const PlacedBody& body = placed.bodies[index];
    return std::visit(
        [&](const auto& shape) {
            const Rim least = rim(shape, placed.point_to_body(body, ray.origin, ray.time),
                                  placed.direction_to_body(body, ray.direction, ray.time),
                                  {low, high, ray.limit});
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

bool Shadows::is_behind(const Ray& ray, std::uint32_t body) const {
    if (ray.limit == kMiss) return false;
    const PlacedBody& b = placed_.bodies[body];
    return (b.centre - ray.origin).norm() - b.radius > ray.limit;
}

bool Shadows::is_hidden(const Ray& ray, FrameStats& stats) const {
    bool hidden = false;
    const auto clears = [&](std::uint32_t body) {
        hidden = body != ray.on && !is_behind(ray, body) &&
                 rim_sine(placed_, body, ray, 0, 0, stats) < 0;
        return !hidden;
    };
    for (std::uint32_t body : tree_.unbounded())
        if (!clears(body)) return true;
    tree_.for_each_on_ray(ray, clears);
    return hidden;
}

double Shadows::visibility(const LightDisc& light, const Vec4& point, std::uint32_t on,
                           FrameStats& stats, double time) const {
    ++stats.shadow_rays;
    const Ray ray = {point, light.toward, on, std::min(light.limit, limit_), time};
    if (light.angle == 0) return is_hidden(ray, stats) ? 0 : 1;

    // The cone that can still matter narrows to the nearest rim found.
    double least = light.cone.sine;
    Cone cone = light.cone;
    int bodies = 0;
    const auto narrow = [&](std::uint32_t body) {
        if (body == on || is_behind(ray, body)) return true;
        const double sine = rim_sine(placed_, body, ray, -light.cone.sine, least, stats);
        least = std::min(least, sine);
        if (++bodies >= kBeforeNarrowing && least < cone.sine)
            cone = {least, std::sqrt(std::max(0.0, 1 - least * least))};
        return least > -light.cone.sine;
    };
    for (std::uint32_t body : tree_.unbounded())
        if (!narrow(body)) return 0;
    tree_.for_each_in_cone(ray, cone, narrow);
    if (least <= -light.cone.sine) return 0;
    return visible_part(std::asin(least) / light.angle);
}

}  // namespace tesserae::render
