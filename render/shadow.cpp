#include "render/shadow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/light/cap.hpp"

namespace tesserae::render {
namespace {

/// The search for the least f/t ends when it is known to this part of the sun's sine: the visible
/// part is then right to 1e-6.
constexpr double kRimTolerance = 1e-6;
/// A sun smaller than this [rad] is hard: nobody sees the difference, and the radiance of its disc,
/// which grows with the cube, would leave the range of double.
constexpr double kHard = 1e-9;
/// Usually four or five steps do; the Illinois rule needs the more, the flatter the minimum.
constexpr int kMaxRimSteps = 100;

/// A point of the convex function f(t), the signed distance along the ray.
struct Sample {
    double t, value, slope;

    /// f' t - f, which never falls along the ray and is zero where f/t is least.
    double excess() const { return slope * t - value; }
};

/// Within this part of the lengths involved a point counts as on the surface. Where two bodies
/// share a piece of surface, rounding puts its points inside or outside at random.
constexpr double kTouching = 1e-9;

/// From inside a body everything is hidden; from its surface it is its tangent half-space.
double seen_from_within(double distance, double slope, double scale) {
    return distance >= -kTouching * scale ? slope : -1;
}

/// The least f/t over t > 0, or the side of the cone that it is on. Where the ratio is least the
/// ray's point and its closest point on the body see the origin in one tangent plane, so that
/// t cos(phi) is the closest point's distance: beyond `reach` there is nothing inside the cone.
/// Every sample bounds the ratio from above, and the tangents at both ends of the interval from
/// below; the next t is a secant step for f' t - f, with the Illinois rule against standing still.
/// A limit below `reach` ends the ray there, where the ratio may still be falling.
/// @param middle   where along the ray the search steps first: near the body's middle
/// @param most     no larger result is told from this one
template <class Evaluate>
double least_ratio(const Evaluate& f, double middle, double reach, double limit, const Cone& cone,
                   double most) {
    const bool is_cut = limit < reach;
    if (is_cut) reach = limit;
    Sample low = f(0);
    if (low.value <= kTouching * reach) return seen_from_within(low.value, low.slope, reach);
    const auto clears_from = [&](const Sample& s) { return s.slope - s.excess() / reach >= most; };
    if (clears_from(low)) return 1;

    // Step out until the ratio has stopped falling.
    Sample high = low;
    double upper = 1;
    for (double t = std::min(reach, std::max(middle, low.value));; t = std::min(reach, 2 * t)) {
        high = f(t);
        upper = std::min(upper, high.value / t);
        if (upper <= -cone.sine) return upper;
        if (high.excess() >= 0) break;
        if (clears_from(high)) return 1;
        if (t >= reach) return is_cut ? upper : 1;
        low = high;
    }

    double low_excess = low.excess(), high_excess = high.excess();
    int last = 0;
    for (int step = 0; step < kMaxRimSteps; ++step) {
        // Both tangents lie below f: where they cross is the least ratio that f can still have.
        const double bend = high.slope - low.slope;
        if (!(bend > 0)) return upper;
        const double cross = (high.excess() - low.excess()) / bend;
        const double lower = low.slope - low.excess() / cross;
        if (lower >= most) return lower;
        if (upper - lower <= kRimTolerance * cone.sine) return upper;

        double t = (low.t * high_excess - high.t * low_excess) / (high_excess - low_excess);
        if (!(t > low.t && t < high.t)) t = 0.5 * (low.t + high.t);
        if (!(t > low.t && t < high.t)) return upper;
        const Sample s = f(t);
        upper = std::min(upper, s.value / t);
        if (upper <= -cone.sine) return upper;
        if (s.excess() < 0) {
            low = s, low_excess = s.excess();
            if (last == -1) high_excess *= 0.5;
            last = -1;
        } else {
            high = s, high_excess = s.excess();
            if (last == 1) low_excess *= 0.5;
            last = 1;
        }
    }
    return upper;
}

/// Whether the cone about a ray may meet a box about the origin. Along every axis the cone is no
/// wider than rays of slopes d - tan and d + tan, so that each side of the box bounds the distances
/// at which the cone can be beyond it.
bool may_meet_box(const Vec4& half, const Vec4& origin, const Vec4& direction, const Cone& cone) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    const double tangent = cone.sine / cone.cosine;
    const Eigen::Array4d most = direction.array() + tangent, least = direction.array() - tangent;
    const Eigen::Array4d low = (-half - origin).array() / most;
    const Eigen::Array4d high = (half - origin).array() / least;
    const Eigen::Array4d none = Eigen::Array4d::Constant(kInfinite);
    const double first = std::max((most > 0).select(low, -none).maxCoeff(),
                                  (least < 0).select(high, -none).maxCoeff());
    const double last = std::min((most < 0).select(low, none).minCoeff(),
                                 (least > 0).select(high, none).minCoeff());
    // Wide of rounding: at worst a search more.
    return last >= 0 && first <= last + 1e-9 * (last + origin.norm());
}

template <class S>
double rim_sine_of(const S& shape, const Vec4& origin, const Vec4& direction, double radius,
                   const Cone& cone, double limit, double most, FrameStats& stats) {
    const auto f = [&](double t) {
        const Vec4 point = origin + t * direction;
        ++stats.distance_evaluations;
        return Sample{t, signed_distance(shape, point), normal(shape, point).dot(direction)};
    };
    if constexpr (S::kBounded) {
        const Vec4 half = half_extents(shape, Mat4::Identity());
        if (!may_meet_box(half, origin, direction, cone)) return 1;
        return least_ratio(f, -origin.dot(direction),
                           (origin.norm() + radius) / cone.cosine * (1 + 1e-9), limit, cone, most);
    } else {
        // A half-space: f is linear, and f/t falls toward its slope.
        const Sample s = f(0);
        return s.value <= 0 ? seen_from_within(s.value, s.slope, origin.norm())
                            : s.slope + s.value / limit;
    }
}

double rim_sine_of(const Hypersphere&, const Vec4& origin, const Vec4& direction, double radius,
                   const Cone&, double limit, double, FrameStats&) {
    const double square = origin.squaredNorm();
    if (square <= radius * radius) {
        const double distance = std::sqrt(square);
        return seen_from_within(distance - radius, direction.dot(origin) / radius, radius);
    }
    // With D the centre's distance: cos and sin of theta and alpha, times D.
    const double cos_theta = -origin.dot(direction);
    const double sin_theta = (origin + cos_theta * direction).norm();
    const double cos_alpha = std::sqrt(square - radius * radius);
    const double cos_between = cos_theta * cos_alpha + sin_theta * radius;
    if (cos_between <= 0) return 1;
    // The least ratio is met at t = cos_alpha / cos(theta - alpha).
    if (limit * cos_between < cos_alpha * square)
        return ((origin + limit * direction).norm() - radius) / limit;
    return (sin_theta * cos_alpha - cos_theta * radius) / square;
}

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
                const Vec4& direction, const Cone& cone, double limit, FrameStats& stats,
                double most) {
    const PlacedBody& body = placed.bodies[index];
    return std::visit(
        [&](const auto& shape) {
            return rim_sine_of(shape, placed.point_to_body(body, origin),
                               placed.direction_to_body(body, direction), body.radius, cone, limit,
                               std::min(most, cone.sine), stats);
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
                 rim_sine(placed_, body, point, light.toward, light.cone, light.limit, stats) < 0;
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
    const auto narrow = [&](std::uint32_t body) {
        if (body == on || is_behind(light, point, body)) return true;
        const double sine =
            rim_sine(placed_, body, point, light.toward, light.cone, light.limit, stats, least);
        if (sine < least) {
            least = sine;
            cone = {sine, std::sqrt(std::max(0.0, 1 - sine * sine))};
        }
        return least > -light.cone.sine;
    };
    for (std::uint32_t body : tree_.unbounded())
        if (!narrow(body)) return 0;
    tree_.for_each_in_cone(point, light.toward, cone, narrow);
    if (least <= -light.cone.sine) return 0;
    return visible_part(std::asin(least) / light.angle);
}

}  // namespace tesserae::render
