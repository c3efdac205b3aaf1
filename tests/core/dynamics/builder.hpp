// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <numbers>
#include <random>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/step/memory.hpp"
#include "core/dynamics/step/settings.hpp"
#include "core/dynamics/stepper.hpp"

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

inline BodyType regular_type(RegularPolychoron regular, double radius) {
    BodyType type = box_type(Vec4::Ones());
    Polychoron shape;
    shape.regular = regular, shape.radius = radius;
    complete(shape);
    type.shape = shape;
    return type;
}

inline BodyType capsule_type(double radius, double height, double mass = 1) {
    BodyType type;
    type.shape = Hypercapsule{radius, height};
    type.mass = mass;
    return type;
}

/// Several sub-steps a step; of few sweeps each where nothing depends on how well they converge.
inline PhysicsSettings substepped_settings(int iterations = 2) {
    PhysicsSettings settings;
    settings.substeps = 4;
    settings.iterations = iterations;
    return settings;
}

inline PhysicsSettings without_gravity() {
    PhysicsSettings settings;
    settings.gravity.setZero();
    return settings;
}

inline void run(Stepper& world, int steps) {
    for (int i = 0; i < steps; ++i) world.step(kStep);
}

/// Of its bodies [m/s].
inline double fastest_of(const Stepper& world) {
    double fastest = 0;
    for (const Vec4& v : world.bodies().velocity) fastest = std::max(fastest, v.norm());
    return fastest;
}

inline double uniform(std::mt19937_64& random, double least, double most) {
    return std::uniform_real_distribution<>(least, most)(random);
}

inline Vec4 random_vector(std::mt19937_64& random, double half_side) {
    std::uniform_real_distribution<> along(-half_side, half_side);
    Vec4 v;
    for (int i = 0; i < 4; ++i) v[i] = along(random);
    return v;
}

/// Adds a body of a type that is there already.
inline BodyId add(Bodies& bodies, std::uint32_t type, const Vec4& position,
                  const Vec4& velocity = Vec4::Zero(), const Bivector& omega = {},
                  const Rotor& rotor = {}) {
    bodies.type.push_back(type);
    bodies.position.push_back(position);
    bodies.rotor.push_back(rotor);
    bodies.velocity.push_back(velocity);
    bodies.angular_velocity.push_back(omega);
    return static_cast<BodyId>(bodies.size() - 1);
}

/// Adds a body of a type of its own.
inline BodyId add(Bodies& bodies, const BodyType& type, const Vec4& position = Vec4::Zero(),
                  const Vec4& velocity = Vec4::Zero(), const Bivector& omega = {},
                  const Rotor& rotor = {}) {
    bodies.types.push_back(type);
    return add(bodies, static_cast<std::uint32_t>(bodies.types.size() - 1), position, velocity,
               omega, rotor);
}

/// Gives a body a type of its own.
inline void give_type(Bodies& bodies, BodyId id, const BodyType& type) {
    bodies.type[id] = static_cast<std::uint32_t>(bodies.types.size());
    bodies.types.push_back(type);
}

/// Across each of these axes two planes that face each other, this far from the origin [m].
inline void add_walls(Bodies& bodies, std::initializer_list<int> axes, double distance,
                      double friction = 0, double restitution = 0) {
    for (const int axis : axes)
        for (const double side : {-1.0, 1.0})
            add(bodies, plane_type(side * Vec4::Unit(axis), -distance, friction, restitution));
}

/// Spheres of three sizes above a floor between six walls, 4 across along x, z and w, 1.1 m apart,
/// jittered: they fall into one heap.
inline Bodies heap_of_spheres(int count, int across = 4) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5, 0.1));
    add_walls(bodies, {0, 2, 3}, 0.55 * across + 0.1, 0.5, 0.1);
    const auto first_type = static_cast<std::uint32_t>(bodies.types.size());
    for (const double radius : {0.3, 0.4, 0.5}) {
        const double volume = 0.5 * pi * pi * std::pow(radius, 4);
        bodies.types.push_back(sphere_type(radius, 1000 * volume, 0.5, 0.1));
    }
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<> jitter(-0.02, 0.02);
    const double middle = 0.5 * (across - 1);
    for (int i = 0; i < count; ++i) {
        Vec4 x{i % across - middle, 0.7 + i / (across * across * across),
               i / across % across - middle, i / (across * across) % across - middle};
        x *= 1.1;
        for (int k = 0; k < 4; ++k) x[k] += jitter(engine);
        add(bodies, first_type + static_cast<std::uint32_t>(i % 3), x);
    }
    return bodies;
}

/// 6^4 spheres of radius 0.5, in columns that touch each other: one large island.
/// @param type_of   the type of the i-th
template <class TypeOf>
void add_columns(Bodies& bodies, const TypeOf& type_of) {
    for (int i = 0; i < 6 * 6 * 6 * 6; ++i)
        add(bodies, type_of(i), {i % 6 - 2.5, i / 216 + 0.5, i / 6 % 6 - 2.5, i / 36 % 6 - 2.5});
}

/// A floor, and above it these columns between walls.
template <class TypeOf>
Bodies packed_spheres(const TypeOf& type_of) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    add_walls(bodies, {0, 2, 3}, 3, 0.5);
    add_columns(bodies, type_of);
    return bodies;
}

/// The heap of spheres with every third one a box and every third a capsule, turning.
inline Bodies mixed_heap(int count = 90, int across = 3) {
    Bodies bodies = heap_of_spheres(count, across);
    for (BodyId id = 0; id < bodies.size(); ++id) {
        if (!is_bounded(bodies.type_of(id).shape)) continue;
        BodyType type = bodies.type_of(id);
        const double r = std::get<Hypersphere>(type.shape).radius;
        if (id % 3 == 0) type.shape = Hyperbox{{r, 1.2 * r, 1.1 * r, 0.8 * r}};
        if (id % 3 == 1) type.shape = Hypercapsule{0.5 * r, r};
        bodies.rotor[id] = exp({0.1 * id, 0.2, 0.05 * id, -0.1, 0.3, 0.02 * id});
        bodies.angular_velocity[id] = {1, -0.5, 0.3, 0.2, -1, 0.7};
        give_type(bodies, id, type);
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

/// Zero where there is no rolling friction.
inline Bivector angular_impulse(const StepMemory& memory, std::size_t i) {
    return memory.angular_impulses.empty() ? Bivector{} : memory.angular_impulses[i];
}

inline bool same_values(const StepMemory& a, const StepMemory& b) {
    if (a.time != b.time || a.asleep != b.asleep || a.still != b.still) return false;
    if (a.impulses.size() != b.impulses.size()) return false;
    for (std::size_t i = 0; i < a.impulses.size(); ++i) {
        const KeptImpulse p = a.impulses[i], q = b.impulses[i];
        if (p.a != q.a || p.b != q.b || p.feature != q.feature || p.normal != q.normal ||
            p.slope != q.slope || !(angular_impulse(a, i) == angular_impulse(b, i)))
            return false;
    }
    return true;
}

}  // namespace tesserae::testing
