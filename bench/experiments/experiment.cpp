// SPDX-License-Identifier: Apache-2.0
#include "bench/experiments/experiment.hpp"

#include <cmath>

#include "core/dynamics/diagnostics/energy.hpp"

namespace tesserae::bench {

PhysicsSettings settings_of(double duration, const Knobs& knobs, const Vec4& gravity) {
    PhysicsSettings settings;
    settings.gravity = gravity;
    settings.duration = duration;
    settings.steps_per_second = knobs.steps_per_second;
    settings.substeps = knobs.substeps;
    settings.iterations = knobs.iterations;
    settings.tolerance = knobs.tolerance;
    settings.integrator = knobs.integrator;
    return settings;
}

Trial::Trial(const Bodies& bodies, const PhysicsSettings& settings, bool crowd,
             const std::vector<Joint>& joints)
    : settings_(settings), world_(std::in_place_index<0>, Bodies{}, settings) {
    if (crowd)
        world_.emplace<1>(make_simulation(bodies, settings, joints));
    else
        world_.emplace<0>(make_simulation(bodies, settings, joints));
}

const Bodies& Trial::bodies() const {
    return std::visit([](const auto& w) -> const Bodies& { return w.bodies(); }, world_);
}

const StepMemory& Trial::memory() const {
    return std::visit([](const auto& w) -> const StepMemory& { return w.memory(); }, world_);
}

std::span<const Wrench> Trial::joint_impulses() const {
    return std::visit([](const auto& w) { return w.joint_impulses(); }, world_);
}

void Trial::observe(StageObserver* observer) {
    std::visit([&](auto& w) { w.observe(observer); }, world_);
}

StepReport Trial::step() {
    return std::visit([&](auto& w) { return w.step(1 / settings_.steps_per_second); }, world_);
}

void Trial::run() {
    const long steps = std::lround(settings_.duration * settings_.steps_per_second);
    const double begin = thread_time();
    for (long i = 1; i <= steps; ++i) step();
    seconds_ += thread_time() - begin;
}

void Trial::run(const std::function<void(double, const StepReport&)>& after) {
    const long steps = std::lround(settings_.duration * settings_.steps_per_second);
    for (long i = 1; i <= steps; ++i) {
        const double begin = thread_time();
        const StepReport report = step();
        seconds_ += thread_time() - begin;
        after(static_cast<double>(i) / settings_.steps_per_second, report);
    }
}

Bodies floor_of(double friction, double restitution) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, friction, restitution), Vec4::Zero());
    return bodies;
}

BodyType box_type(const Vec4& size, double mass, double friction) {
    BodyType type;
    type.shape = Hyperbox{size};
    type.mass = mass;
    type.friction = friction;
    return type;
}

double angle_between(const Rotor& a, const Rotor& b) {
    // A small rotation by the bivector B has the matrix 1 + B, whose norm counts each plane twice.
    return (to_matrix(a) - to_matrix(b)).norm() / std::sqrt(2.0);
}

double energy(const Bodies& bodies, const Vec4& gravity) {
    return kinetic_energy(bodies) + potential_energy(bodies, gravity);
}

}  // namespace tesserae::bench
