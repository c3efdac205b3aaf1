#include "bench/experiments.hpp"

#include <algorithm>
#include <cmath>

#include "bench/bodies.hpp"
#include "bench/free_rotation.hpp"
#include "core/error.hpp"

// The exact results are derived in the comment beside each motion; g = 10 m/s^2, and a hypersphere
// has I = m R^2 / 3.
namespace tesserae::bench {
namespace {

constexpr double kGravity = 10;
constexpr double kRadius = 0.5;

PhysicsSettings settings_of(double duration, int steps_per_second, const Vec4& gravity) {
    PhysicsSettings settings;
    settings.gravity = gravity;
    settings.duration = duration;
    settings.steps_per_second = steps_per_second;
    return settings;
}

const Vec4 kDown{0, -kGravity, 0, 0};

/// Motions with an event (a bounce, the end of slip) are made by this many bodies at once, 10 m
/// apart, that start a little differently: the error depends on where in its step the event falls,
/// and the largest of several shows the order.
constexpr int kCopies = 8;

Vec4 place(int copy) { return {0, 0, 10.0 * copy, 0}; }

/// The plane y = 0.
Bodies floor_of(double friction, double restitution) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, friction, restitution), Vec4::Zero());
    return bodies;
}

/// Calls after(time) behind each step.
template <class After>
void run(World& world, const PhysicsSettings& settings, const After& after) {
    const long steps = std::lround(settings.duration * settings.steps_per_second);
    for (long i = 1; i <= steps; ++i) {
        world.step(1 / settings.steps_per_second);
        after(static_cast<double>(i) / settings.steps_per_second);
    }
}

void run(World& world, const PhysicsSettings& settings) {
    run(world, settings, [](double) {});
}

/// x = x0 + v t + g t^2 / 2.
Experiment projectile(int steps_per_second) {
    const Vec4 v{3, 10, -2, 1};
    const auto settings = settings_of(2, steps_per_second, kDown);
    Bodies bodies;
    add(bodies, sphere_type(kRadius, 2, 0, 0), Vec4::Zero(), v);
    return {"projectile", bodies, settings, [=](World& world) -> std::vector<Error> {
                run(world, settings);
                const Vec4 exact = settings.duration * v + 2 * kDown;
                return {{"position", "m", (world.bodies().position[0] - exact).norm()}};
            }};
}

/// The bounces of one sphere, read off the parabola on which it flies after each, so that the
/// step's length does not limit what can be seen. Dropped from the height H it meets the floor at
/// t1 = sqrt(2 H/g) with v1 = sqrt(2 g H), leaves it the k-th time with e^k v1 and rises to
/// e^(2k) H.
struct Bouncing {
    static constexpr double kRestitution = 0.8;
    static constexpr int kBounces = 6;  ///< the last one at some 2.9 s

    double top;  ///< of the fall before the first bounce [m]
    double v1 = std::sqrt(2 * kGravity * top), exact_time = v1 / kGravity;
    double before = 0;  ///< velocity after the last step [m/s]
    int count = 0;
    double height_error = 0, time_error = 0;

    void see(double time, double y, double v) {
        if (count < kBounces && v > 0 && before <= 0) {
            ++count;
            const double rise = v * v + 2 * kGravity * y;
            const double left = time - (std::sqrt(rise) - v) / kGravity;
            const double exact_height = std::pow(kRestitution, 2 * count) * top;
            height_error =
                std::max(height_error, std::abs(rise / (2 * kGravity) / exact_height - 1));
            time_error = std::max(time_error, std::abs(left - exact_time));
            exact_time += 2 * std::pow(kRestitution, count) * v1 / kGravity;
        }
        before = v;
    }
};

Experiment bounces(int steps_per_second) {
    const auto settings = settings_of(3.2, steps_per_second, kDown);
    const auto height = [](int copy) { return 1 + 0.01 * copy; };
    Bodies bodies = floor_of(0, 0);
    for (int i = 0; i < kCopies; ++i)
        add(bodies, sphere_type(kRadius, 2, 0, Bouncing::kRestitution),
            place(i) + Vec4(0, kRadius + height(i), 0, 0));
    return {"bounce e=0.8", bodies, settings, [=](World& world) -> std::vector<Error> {
                std::vector<Bouncing> spheres;
                for (int i = 0; i < kCopies; ++i) spheres.push_back({height(i)});
                const Bodies& now = world.bodies();
                run(world, settings, [&](double time) {
                    for (std::size_t i = 0; i < kCopies; ++i)
                        spheres[i].see(time, now.position[i + 1][1] - kRadius,
                                       now.velocity[i + 1][1]);
                });
                double height_error = 0, time_error = 0;
                for (const Bouncing& s : spheres) {
                    if (s.count < Bouncing::kBounces) throw RunError("a bounce is missing");
                    height_error = std::max(height_error, s.height_error);
                    time_error = std::max(time_error, s.time_error);
                }
                return {{"height", "relative", height_error}, {"bounce time", "s", time_error}};
            }};
}

/// Slip starts at v0 and falls by mu g (1 + 3) a second, so that the sphere slides for
/// t = v0/(4 mu g) and then rolls at 3/4 v0.
Experiment sliding(int steps_per_second) {
    const double mu = 0.3;
    const auto settings = settings_of(1, steps_per_second, kDown);
    const auto start_speed = [](int copy) { return 3.6 + 0.0371 * copy; };
    Bodies bodies = floor_of(mu, 0);
    for (int i = 0; i < kCopies; ++i)
        add(bodies, sphere_type(kRadius, 2, mu, 0), place(i) + Vec4(0, kRadius, 0, 0),
            {start_speed(i), 0, 0, 0});
    return {"sliding to rolling", bodies, settings, [=](World& world) -> std::vector<Error> {
                run(world, settings);
                double speed_error = 0, distance_error = 0;
                for (int i = 0; i < kCopies; ++i) {
                    const auto id = static_cast<std::size_t>(i + 1);
                    const double v0 = start_speed(i), t = v0 / (4 * mu * kGravity);
                    const double distance =
                        v0 * t - 0.5 * mu * kGravity * t * t + 0.75 * v0 * (settings.duration - t);
                    const Bodies& now = world.bodies();
                    speed_error = std::max(speed_error, std::abs(now.velocity[id][0] - 0.75 * v0));
                    distance_error =
                        std::max(distance_error, std::abs(now.position[id][0] - distance));
                }
                return {{"speed", "m/s", speed_error}, {"distance", "m", distance_error}};
            }};
}

/// Rolls at 3/4 g sin(angle), since mu > tan(angle) / 4.
Experiment incline(int steps_per_second) {
    const double angle = 20 * kPi / 180;
    const auto settings = settings_of(
        1, steps_per_second, {kGravity * std::sin(angle), -kGravity * std::cos(angle), 0, 0});
    Bodies bodies = floor_of(0.6, 0);
    add(bodies, sphere_type(kRadius, 2, 0.6, 0), {0, kRadius, 0, 0});
    return {"rolling down 20 degrees", bodies, settings, [=](World& world) -> std::vector<Error> {
                run(world, settings);
                const Bodies& now = world.bodies();
                const double exact = 0.75 * kGravity * std::sin(angle);
                return {{"speed", "m/s", std::abs(now.velocity[1][0] - exact)},
                        {"distance", "m", std::abs(now.position[1][0] - 0.5 * exact)}};
            }};
}

/// A box whose angular velocity has parts in all six planes, against Runge-Kutta.
Experiment rotation(int steps_per_second, Integrator integrator) {
    const Vec4 size{1, 0.7, 0.4, 0.2};
    const Bivector omega{1.2, -0.7, 0.5, 2.1, -1.4, 0.9};
    auto settings = settings_of(2, steps_per_second, Vec4::Zero());
    settings.integrator = integrator;
    Bodies bodies;
    BodyType type;
    type.shape = Hyperbox{size};
    add(bodies, type, Vec4::Zero(), Vec4::Zero(), omega);
    static const Bivector exact =
        free_rotation(size.cwiseAbs2() / 12, omega, settings.duration, 20000);
    const char* name =
        integrator == Integrator::kEuler ? "free rotation (Euler)" : "free rotation (midpoint)";
    return {name, bodies, settings, [=](World& world) -> std::vector<Error> {
                run(world, settings);
                return {{"angular velocity", "relative",
                         norm(world.bodies().angular_velocity[0] - exact) / norm(omega)}};
            }};
}

/// Equal masses, e = 1: velocities swap when the gap is closed.
Experiment head_on(int steps_per_second) {
    const Vec4 n = Vec4(1, -2, 0, 1).normalized();
    const double v0 = 3, v1 = -1.25;
    const auto settings = settings_of(2, steps_per_second, Vec4::Zero());
    const auto half_distance = [](int copy) { return 2 + 0.0371 * copy; };
    Bodies bodies;
    bodies.types.push_back(sphere_type(kRadius, 2, 0.5, 1));
    for (int i = 0; i < kCopies; ++i) {
        add(bodies, 0u, place(i) - half_distance(i) * n, v0 * n);
        add(bodies, 0u, place(i) + half_distance(i) * n, v1 * n);
    }
    return {"head on e=1", bodies, settings, [=](World& world) -> std::vector<Error> {
                run(world, settings);
                double velocity_error = 0, position_error = 0;
                const auto compare = [&](std::size_t id, const Vec4& x, const Vec4& v) {
                    const Bodies& now = world.bodies();
                    velocity_error = std::max(velocity_error, (now.velocity[id] - v).norm());
                    position_error = std::max(position_error, (now.position[id] - x).norm());
                };
                for (int i = 0; i < kCopies; ++i) {
                    const double half = half_distance(i);
                    const double t = (2 * half - 2 * kRadius) / (v0 - v1);
                    const double after = settings.duration - t;
                    const auto id = static_cast<std::size_t>(2 * i);
                    compare(id, place(i) + (-half + v0 * t + v1 * after) * n, v1 * n);
                    compare(id + 1, place(i) + (half + v1 * t + v0 * after) * n, v0 * n);
                }
                return {{"velocity", "m/s", velocity_error}, {"position", "m", position_error}};
            }};
}

}  // namespace

std::vector<Experiment> experiments(int steps_per_second) {
    return {projectile(steps_per_second),
            bounces(steps_per_second),
            sliding(steps_per_second),
            incline(steps_per_second),
            head_on(steps_per_second),
            rotation(steps_per_second, Integrator::kEuler),
            rotation(steps_per_second, Integrator::kMidpoint)};
}

Experiment column_of_spheres(int steps_per_second, int iterations) {
    constexpr int kCount = 10;
    constexpr double kMass = 2;
    auto settings = settings_of(0.5, steps_per_second, kDown);
    settings.iterations = iterations;
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5, 0), Vec4::Zero());
    bodies.types.push_back(sphere_type(kRadius, kMass, 0.5, 0));
    for (int i = 0; i < kCount; ++i) add(bodies, 1u, {0, (2 * i + 1) * kRadius, 0, 0});
    return {"column of ten spheres", bodies, settings, [=](World& world) -> std::vector<Error> {
                double overlap = 0;
                run(world, settings, [&](double) {
                    const double top = world.bodies().position[kCount][1];
                    overlap = std::max(overlap, std::abs((2 * kCount - 1) * kRadius - top));
                });
                const double force =
                    world.memory().impulses.at(0).normal * settings.steps_per_second;
                return {{"force on the floor", "relative",
                         std::abs(force / (kCount * kMass * kGravity) - 1)},
                        {"height of the top", "m", overlap}};
            }};
}

}  // namespace tesserae::bench
