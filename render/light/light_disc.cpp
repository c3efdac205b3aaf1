#include "render/light/light_disc.hpp"

#include <cmath>
#include <numbers>

#include "render/light/cap.hpp"

namespace tesserae::render {
namespace {

/// A sun smaller than this [rad] is hard: nobody sees the difference, and the radiance of its disc,
/// which grows with the cube, would leave the range of double.
constexpr double kHard = 1e-9;

}  // namespace

SunDisc sun_disc(const Sun& sun) {
    double angle = sun.angle * (std::numbers::pi / 180);
    if (angle < kHard) angle = 0;
    SunDisc disc = {
        {-sun.direction, angle, {std::sin(angle), std::cos(angle)}}, sun.irradiance, Color::Zero()};
    if (angle > 0) disc.radiance = sun.irradiance / cap_irradiance(angle, std::numbers::pi / 2);
    return disc;
}

}  // namespace tesserae::render
