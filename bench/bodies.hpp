#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "core/dynamics/state/bodies.hpp"

namespace tesserae::bench {

using std::numbers::pi;

inline BodyType sphere_type(double radius, double mass, double friction, double restitution) {
    BodyType type;
    type.shape = Hypersphere{radius};
    type.mass = mass;
    type.friction = friction;
    type.restitution = restitution;
    return type;
}

inline BodyType plane_type(const Vec4& normal, double offset, double friction, double restitution) {
    BodyType type;
    type.shape = Hyperplane{normal, offset};
    type.friction = friction;
    type.restitution = restitution;
    return type;
}

/// Adds a body of a type that is there already.
inline BodyId add(Bodies& bodies, std::uint32_t type, const Vec4& position,
                  const Vec4& velocity = Vec4::Zero(), const Bivector& omega = {}) {
    bodies.type.push_back(type);
    bodies.position.push_back(position);
    bodies.rotor.push_back(Rotor{});
    bodies.velocity.push_back(velocity);
    bodies.angular_velocity.push_back(omega);
    return static_cast<BodyId>(bodies.size() - 1);
}

/// Adds a body of a type of its own.
inline BodyId add(Bodies& bodies, const BodyType& type, const Vec4& position,
                  const Vec4& velocity = Vec4::Zero(), const Bivector& omega = {}) {
    bodies.types.push_back(type);
    return add(bodies, static_cast<std::uint32_t>(bodies.types.size() - 1), position, velocity,
               omega);
}

/// Spheres of radius 0.3, 0.4 and 0.5 m above a floor between six walls, `across` of them along x,
/// z and w, 1.1 m apart, jittered: they fall into one heap.
inline Bodies spheres_above_floor(int count, int across) {
    Bodies bodies;
    const double wall = 0.55 * across + 0.1;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5, 0.1), Vec4::Zero());
    for (int axis : {0, 2, 3})
        for (double side : {-1.0, 1.0})
            add(bodies, plane_type(side * Vec4::Unit(axis), -wall, 0.5, 0.1), Vec4::Zero());

    const auto first_type = static_cast<std::uint32_t>(bodies.types.size());
    for (double radius : {0.3, 0.4, 0.5}) {
        const double mass = 1000 * 0.5 * pi * pi * std::pow(radius, 4);
        bodies.types.push_back(sphere_type(radius, mass, 0.5, 0.1));
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

/// Spheres of one size, uniformly random in a 4D cube about `centre` with one to 2^4 m^4; they may
/// overlap.
inline Bodies cloud_of_spheres(int count, double radius, const Vec4& centre) {
    Bodies bodies;
    bodies.types.push_back(sphere_type(radius, 1, 0.5, 0));
    const double half = std::pow(count, 0.25);
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<> along(-half, half);
    for (int i = 0; i < count; ++i) {
        Vec4 x = centre;
        for (int k = 0; k < 4; ++k) x[k] += along(engine);
        add(bodies, 0u, x);
    }
    return bodies;
}

}  // namespace tesserae::bench
