#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <random>

#include "core/dynamics/state/bodies.hpp"
#include "core/dynamics/state/memory.hpp"
#include "core/dynamics/state/settings.hpp"
#include "core/dynamics/world.hpp"

namespace tesserae::testing {

using std::numbers::pi;

/// The default time step [s], and its gravity [m/s^2].
constexpr double kStep = 1.0 / 240;
inline const Vec4 kDown{0, -10, 0, 0};

inline BodyType sphere_type(double radius, double mass = 1, double friction = 0,
                            double restitution = 0) {
    BodyType type;
    type.shape = Hypersphere{radius};
    type.mass = mass;
    type.friction = friction;
    type.restitution = restitution;
    return type;
}

inline BodyType plane_type(const Vec4& normal, double offset, double friction = 0,
                           double restitution = 0) {
    Hyperplane plane;
    plane.normal = normal;
    plane.offset = offset;
    BodyType type;
    type.shape = plane;
    type.friction = friction;
    type.restitution = restitution;
    return type;
}

inline BodyType box_type(const Vec4& size, double mass = 1) {
    Hyperbox box;
    box.size = size;
    BodyType type;
    type.shape = box;
    type.mass = mass;
    return type;
}

inline BodyType capsule_type(double radius, double height, double mass = 1) {
    BodyType type;
    type.shape = Hypercapsule{radius, height};
    type.mass = mass;
    return type;
}

/// The soft solver as README recommends it.
inline PhysicsSettings soft_settings() {
    PhysicsSettings settings;
    settings.solver = Solver::kSoft;
    settings.substeps = 4;
    settings.iterations = 2;
    return settings;
}

inline PhysicsSettings without_gravity() {
    PhysicsSettings settings;
    settings.gravity.setZero();
    return settings;
}

inline void run(World& world, int steps) {
    for (int i = 0; i < steps; ++i) world.step(kStep);
}

/// Adds one body, of a type of its own.
inline BodyId add(Bodies& bodies, const BodyType& type, const Vec4& position = Vec4::Zero(),
                  const Vec4& velocity = Vec4::Zero(), const Bivector& omega = {},
                  const Rotor& rotor = {}) {
    bodies.type.push_back(static_cast<std::uint32_t>(bodies.types.size()));
    bodies.types.push_back(type);
    bodies.position.push_back(position);
    bodies.rotor.push_back(rotor);
    bodies.velocity.push_back(velocity);
    bodies.angular_velocity.push_back(omega);
    return static_cast<BodyId>(bodies.size() - 1);
}

/// Spheres of three sizes above a floor between six walls, 4 across along x, z and w, 1.1 m apart,
/// jittered: they fall into one heap.
inline Bodies heap_of_spheres(int count, int across = 4) {
    Bodies bodies;
    const double wall = 0.55 * across + 0.1;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5, 0.1));
    for (int axis : {0, 2, 3})
        for (double side : {-1.0, 1.0})
            add(bodies, plane_type(side * Vec4::Unit(axis), -wall, 0.5, 0.1));
    const double radii[] = {0.3, 0.4, 0.5};
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<> jitter(-0.02, 0.02);
    for (int i = 0; i < count; ++i) {
        const double middle = 0.5 * (across - 1);
        const int layer = across * across * across;
        Vec4 x{i % across - middle, 0.0, i / across % across - middle,
               i / (across * across) % across - middle};
        x[1] = 0.7 + i / layer;
        x *= 1.1;
        for (int k = 0; k < 4; ++k) x[k] += jitter(engine);
        const double radius = radii[i % 3];
        const double volume = 0.5 * pi * pi * std::pow(radius, 4);
        add(bodies, sphere_type(radius, 1000 * volume, 0.5, 0.1), x);
    }
    return bodies;
}

/// The heap of spheres with every third one a box and every third a capsule, turning.
inline Bodies mixed_heap(int count = 90, int across = 3) {
    Bodies bodies = heap_of_spheres(count, across);
    for (BodyId id = 0; id < bodies.size(); ++id) {
        BodyType& type = bodies.types[bodies.type[id]];
        if (!is_bounded(type.shape)) continue;
        const double r = std::get<Hypersphere>(type.shape).radius;
        if (id % 3 == 0) type.shape = Hyperbox{{r, 1.2 * r, 1.1 * r, 0.8 * r}};
        if (id % 3 == 1) type.shape = Hypercapsule{0.5 * r, r};
        bodies.rotor[id] = exp({0.1 * id, 0.2, 0.05 * id, -0.1, 0.3, 0.02 * id});
        bodies.angular_velocity[id] = {1, -0.5, 0.3, 0.2, -1, 0.7};
    }
    return bodies;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           std::memcmp(static_cast<const void*>(a.data()), static_cast<const void*>(b.data()),
                       a.size() * sizeof(T)) == 0;
}

inline bool same_bits(const Bodies& a, const Bodies& b) {
    return same_bits(a.position, b.position) && same_bits(a.rotor, b.rotor) &&
           same_bits(a.velocity, b.velocity) && same_bits(a.angular_velocity, b.angular_velocity);
}

inline bool same_values(const StepMemory& a, const StepMemory& b) {
    if (a.time != b.time || a.asleep != b.asleep || a.still != b.still) return false;
    if (a.impulses.size() != b.impulses.size()) return false;
    for (std::size_t i = 0; i < a.impulses.size(); ++i) {
        const ContactImpulse &p = a.impulses[i], &q = b.impulses[i];
        if (p.a != q.a || p.b != q.b || p.feature != q.feature || p.normal != q.normal ||
            p.tangent != q.tangent)
            return false;
    }
    return true;
}

}  // namespace tesserae::testing
