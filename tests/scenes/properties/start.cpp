// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/properties/start.hpp"

#include <algorithm>
#include <cmath>

#include "tests/core/shape/oracle.hpp"

namespace tesserae::scenes::properties {
namespace {

/// Planes that contain x turn round.
Bivector mirrored(const Bivector& b) { return {-b.xy, -b.xz, -b.xw, b.yz, b.yw, b.zw}; }
/// e_x R e_x, which is exact.
Rotor mirrored(const Rotor& r) { return {r.s, mirrored(r.b), -r.p}; }
Vec4 mirrored(const Vec4& v) { return {-v[0], v[1], v[2], v[3]}; }

/// All but these are mirrored by being turned as mirrored() says. A duoprism has a vertex on its x
/// axis; the 5-cell has no axis as its mirror's normal.
void mirror_shape(Shape& shape) {
    std::vector<Vec4> vertices;
    if (const auto* polychoron = std::get_if<Polychoron>(&shape))
        vertices = polychoron->body->hull.vertices;
    if (const auto* duoprism = std::get_if<Duoprism>(&shape))
        vertices = duoprism->body->hull.vertices;
    if (vertices.empty()) return;
    for (Vec4& vertex : vertices) vertex = mirrored(vertex);
    shape = hull_shape(std::move(vertices));
}

void scale_shape(Shape& shape, double factor) {
    if (auto* plane = std::get_if<Hyperplane>(&shape)) {
        plane->offset *= factor;
        return;
    }
    std::visit(
        [&](auto& s) {
            s.parameters(s, [&](const Key&, auto& value, Rule) { scale_parameter(value, factor); });
            if constexpr (requires { complete(s); }) complete(s);
        },
        shape);
}

}  // namespace

Start start_of(const SmallScene& scene) {
    return {bodies_of(scene), scene.physics, 1 / scene.physics.steps_per_second};
}

Motion::Motion(const Start& start, Change change)
    : world_(start.bodies, start.physics), step_(start.step), change_(std::move(change)) {}

void Motion::step(StageObserver* observer) {
    world_.observe(observer);
    report_ = world_.step(step_);
    world_.observe(nullptr);
    ++taken_;
    if (!change_) return;
    Simulation simulation = world_.simulation();
    change_(simulation.bodies, taken_);
    world_ = Stepper(std::move(simulation));
}

void Motion::start_anew() {
    Simulation simulation = make_simulation(world_.bodies(), world_.simulation().settings);
    simulation.memory = world_.memory();
    world_ = Stepper(std::move(simulation));
}

void move_bodies(Bodies& bodies, const Rotor& turn, const Vec4& shift) {
    for (BodyId id = 0; id < bodies.size(); ++id) {
        if (!is_bounded(bodies.type_of(id).shape)) continue;
        bodies.position[id] = rotate(turn, bodies.position[id]) + shift;
        bodies.rotor[id] = projected_to_spin4(turn * bodies.rotor[id]);
        bodies.velocity[id] = rotate(turn, bodies.velocity[id]);
        bodies.angular_velocity[id] = rotate(turn, bodies.angular_velocity[id]);
    }
}

Start moved(Start start, const Rotor& turn, const Vec4& shift) {
    move_bodies(start.bodies, turn, shift);
    for (BodyType& type : start.bodies.types)
        if (auto* plane = std::get_if<Hyperplane>(&type.shape)) {
            plane->normal = rotate(turn, plane->normal);
            complete(*plane);
            plane->offset += plane->normal.dot(shift);
        }
    start.physics.gravity = rotate(turn, start.physics.gravity);
    return start;
}

void mirror_motion(Bodies& bodies) {
    for (BodyId id = 0; id < bodies.size(); ++id) {
        bodies.position[id] = mirrored(bodies.position[id]);
        bodies.rotor[id] = mirrored(bodies.rotor[id]);
        bodies.velocity[id] = mirrored(bodies.velocity[id]);
        bodies.angular_velocity[id] = mirrored(bodies.angular_velocity[id]);
    }
}

Start mirrored(Start start) {
    mirror_motion(start.bodies);
    for (BodyType& type : start.bodies.types) {
        if (auto* plane = std::get_if<Hyperplane>(&type.shape))
            plane->normal = mirrored(plane->normal);
        mirror_shape(type.shape);
    }
    start.physics.gravity = mirrored(start.physics.gravity);
    return start;
}

void scale_motion(Bodies& bodies, const Scaling& by) {
    for (BodyId id = 0; id < bodies.size(); ++id) {
        bodies.position[id] *= std::ldexp(1, by.length);
        bodies.velocity[id] *= std::ldexp(1, by.length - by.time);
        bodies.angular_velocity[id] = std::ldexp(1, -by.time) * bodies.angular_velocity[id];
    }
}

Start scaled(Start start, const Scaling& by) {
    scale_motion(start.bodies, by);
    for (BodyType& type : start.bodies.types) {
        scale_shape(type.shape, std::ldexp(1, by.length));
        type.rolling_friction *= std::ldexp(1, by.length);
        type.mass *= std::ldexp(1, by.mass);
    }
    start.physics.gravity *= std::ldexp(1, by.length - 2 * by.time);
    start.physics.tolerance *= std::ldexp(1, by.length - by.time);
    start.physics.steps_per_second *= std::ldexp(1, -by.time);
    start.step *= std::ldexp(1, by.time);
    return start;
}

Sizes sizes_of(const Start& start) {
    Sizes sizes;
    const Bodies& bodies = start.bodies;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const double radius = bounding_radius(bodies.type_of(id).shape);
        if (!std::isfinite(radius)) continue;
        sizes.length = std::max(sizes.length, bodies.position[id].norm() + radius);
        sizes.speed = std::max(
            sizes.speed, bodies.velocity[id].norm() + radius * norm(bodies.angular_velocity[id]));
    }
    sizes.speed += start.physics.gravity.norm() * start.step;
    return sizes;
}

double difference(const Bodies& a, const Bodies& b, const Sizes& sizes) {
    double most = 0;
    for (BodyId id = 0; id < a.size(); ++id) {
        const double radius = bounding_radius(a.type_of(id).shape);
        if (!std::isfinite(radius)) continue;
        const Mat4 turned = to_matrix(a.rotor[id]) - to_matrix(b.rotor[id]);
        const double moved = (a.position[id] - b.position[id]).norm() + radius * turned.norm();
        const double faster = (a.velocity[id] - b.velocity[id]).norm() +
                              radius * norm(a.angular_velocity[id] - b.angular_velocity[id]);
        most = std::max(most, moved / sizes.length);
        if (sizes.speed > 0) most = std::max(most, faster / sizes.speed);
    }
    return most;
}

}  // namespace tesserae::scenes::properties
