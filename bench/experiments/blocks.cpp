// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bench/experiments/experiments.hpp"

// Boxes that stick and slide.
namespace tesserae::bench {
namespace {

const Vec4 kSize{1, 0.4, 0.8, 1.2};  ///< of the block [m]
constexpr double kFriction = 0.5;

/// Gravity as the block sees it when the floor is turned by an angle [rad].
Vec4 tilted(double angle) {
    return {kGravity * std::sin(angle), -kGravity * std::cos(angle), 0, 0};
}

Bodies block_on_floor(const Vec4& velocity = Vec4::Zero()) {
    Bodies bodies = floor_of(kFriction, 0);
    add(bodies, box_type(kSize, 2, kFriction), {0, 0.5 * kSize[1], 0, 0}, velocity);
    return bodies;
}

}  // namespace

/// tan(angle) = 0.9 mu: the block stays where it is.
Experiment block_sticking(const Knobs& knobs) {
    const auto settings = settings_of(2, knobs, tilted(std::atan(0.9 * kFriction)));
    const Bodies bodies = block_on_floor();
    return {"block_sticking", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                const Vec4 drift = trial.bodies().position[1] - bodies.position[1];
                const double sunk = std::abs(drift[1]);
                return {{"drift along the floor", "m", std::hypot(drift[0], drift[2], drift[3])},
                        {"sinking", "m", sunk}};
            }};
}

/// tan(angle) = 1.3 mu, a start at v0 down the slope: a = g (sin(angle) - mu cos(angle)).
Experiment block_sliding(const Knobs& knobs) {
    constexpr double kSpeed = 0.5;
    const double angle = std::atan(1.3 * kFriction);
    const auto settings = settings_of(1, knobs, tilted(angle));
    return {"block_sliding", block_on_floor({kSpeed, 0, 0, 0}), settings,
            [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                const Bodies& now = trial.bodies();
                const double t = settings.duration;
                const double a = kGravity * (std::sin(angle) - kFriction * std::cos(angle));
                return {
                    {"speed", "m/s", std::abs(now.velocity[1][0] - kSpeed - a * t)},
                    {"distance", "m", std::abs(now.position[1][0] - kSpeed * t - 0.5 * a * t * t)}};
            }};
}

/// The block begins to slide at tan(angle) = mu. Found by bisection: it slides when its speed after
/// 1 s is above 1 mm/s, which it reaches at an excess of 1e-3/(g mu cos(angle)) = 2.2e-4.
Experiment critical_angle(const Knobs& knobs) {
    const Bodies bodies = block_on_floor();
    const auto at_slope = [=](double slope) {
        return settings_of(1, knobs, tilted(std::atan(slope)));
    };
    return {"critical_angle", bodies, at_slope(kFriction),
            [=](Trial& at_exact) -> std::vector<Error> {
                at_exact.run();
                double sticks = 0.5 * kFriction, slides = 1.5 * kFriction;
                for (int i = 0; i < 13; ++i) {
                    const double slope = 0.5 * (sticks + slides);
                    Trial trial(bodies, at_slope(slope));
                    trial.run();
                    (trial.bodies().velocity[1][0] > 1e-3 ? slides : sticks) = slope;
                }
                return {{"tan of the critical angle", "relative",
                         std::abs(0.5 * (sticks + slides) / kFriction - 1)}};
            }};
}

namespace {

/// Pushed at v0 a box stops after v0^2/(2 mu g), whatever the direction in the three dimensions of
/// the floor. Each box starts turned at random in the floor, so that its corners lie differently
/// about the direction.
Experiment isotropy(const char* name, bool fixed_rotation, const Knobs& knobs) {
    constexpr int kBoxes = 12;
    constexpr double kSpeed = 3;
    const auto settings = settings_of(1, knobs, kDown);
    Bodies bodies = floor_of(kFriction, 0);
    BodyType type = box_type({1, 0.2, 1, 1}, 2, kFriction);
    type.fixed_rotation = fixed_rotation;
    bodies.types.push_back(type);
    std::mt19937_64 engine(3);
    std::normal_distribution<> normal;
    std::uniform_real_distribution<> angle(-1, 1);
    std::vector<Vec4> directions;
    for (int i = 0; i < kBoxes; ++i) {
        Vec4 u{normal(engine), 0, normal(engine), normal(engine)};
        directions.push_back(u.normalized());
        add(bodies, 1u, {0, 0.1, 10.0 * i, 0}, kSpeed * directions.back());
        const double xz = angle(engine), xw = angle(engine), zw = angle(engine);
        bodies.rotor.back() = exp(Bivector{0, xz, xw, 0, 0, zw});
    }
    return {name, bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                double sum = 0, least = 1e300, most = 0, sideways = 0, turned = 0;
                for (std::size_t i = 0; i < kBoxes; ++i) {
                    Vec4 path = trial.bodies().position[i + 1] - bodies.position[i + 1];
                    path[1] = 0;
                    const double along = path.dot(directions[i]);
                    sum += along / kBoxes;
                    least = std::min(least, along);
                    most = std::max(most, along);
                    sideways = std::max(sideways, (path - along * directions[i]).norm());
                    turned = std::max(
                        turned, angle_between(trial.bodies().rotor[i + 1], bodies.rotor[i + 1]));
                }
                const double exact = kSpeed * kSpeed / (2 * kFriction * kGravity);
                std::vector<Error> errors = {
                    {"mean distance", "relative", std::abs(sum / exact - 1)},
                    {"spread over directions", "relative", (most - least) / exact},
                    {"sideways", "relative", sideways / exact}};
                if (!fixed_rotation) errors.push_back({"turning", "rad", turned});
                return errors;
            }};
}

}  // namespace

Experiment friction_isotropy(const Knobs& knobs) {
    return isotropy("friction_isotropy", true, knobs);
}

/// The box is low and free to turn. While every corner slides along the unit vector u, friction is
/// mu N against u. The torques about the floor's planes through the vertical then put the centre of
/// the load at mu h/2 u from under the box's centre, h its height: on the path, so that friction
/// does not turn the box in the floor either, and the distance stays the same.
Experiment friction_isotropy_free(const Knobs& knobs) {
    return isotropy("friction_isotropy_free", false, knobs);
}

}  // namespace tesserae::bench
