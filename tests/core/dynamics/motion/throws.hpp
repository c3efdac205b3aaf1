// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <variant>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/step/settings.hpp"
#include "tests/core/dynamics/builder.hpp"

// Bodies thrown at walls and at each other, at random.
namespace tesserae::testing {

inline double uniform_in(std::mt19937_64& random, double least, double most) {
    return std::uniform_real_distribution<>(least, most)(random);
}

/// As likely in each decade.
inline double spread(std::mt19937_64& random, double least, double most) {
    return least * std::pow(most / least, uniform_in(random, 0, 1));
}

inline Bivector random_plane(std::mt19937_64& random, double most) {
    const Vec4 a = random_vector(random, most), b = random_vector(random, most);
    return {a[0], a[1], a[2], b[0], b[1], b[2]};
}

/// Radius of the ball about the centre that the body holds however it is turned.
inline double inscribed_radius(const Shape& shape) {
    return std::visit([](const auto& s) { return half_extents(s, Mat4::Identity()).minCoeff(); },
                      shape);
}

/// How far a body gets along a direction.
inline double farthest_along(const Bodies& bodies, BodyId id, const Vec4& direction) {
    const Mat4 rotation = to_matrix(bodies.rotor[id]);
    const Vec4 local = rotation.transpose() * direction;
    return direction.dot(bodies.position[id]) +
           std::visit([&](const auto& s) { return direction.dot(rotation * support(s, local)); },
                      bodies.type_of(id).shape);
}

constexpr int kThrownKinds = 6;

/// A sphere, capsule, box, slab, rod (a capsule) or rod (a box) of 5 cm to 1 m, down to 0.25 mm
/// thin, of 0.1 to 100 kg.
inline BodyType thrown_type(std::mt19937_64& random, int kind, double friction,
                            double restitution) {
    const double size = spread(random, 0.05, 1);
    Vec4 sides = size * (Vec4::Constant(0.75) + random_vector(random, 0.25));
    BodyType type;
    switch (kind) {
        case 0:
            type = sphere_type(0.5 * size);
            break;
        case 1:
            type = capsule_type(size * uniform_in(random, 0.1, 0.4),
                                size * uniform_in(random, 0.2, 1));
            break;
        case 3:
            sides[static_cast<int>(random() % 4)] = size * spread(random, 0.01, 0.2);
            [[fallthrough]];
        case 2:
            type = box_type(sides);
            break;
        case 4:
            type = capsule_type(size * spread(random, 0.005, 0.1), size);
            break;
        default:
            sides.setConstant(size * spread(random, 0.005, 0.1));
            sides[static_cast<int>(random() % 4)] = size;
            type = box_type(sides);
    }
    type.mass = spread(random, 0.1, 100);
    type.friction = friction;
    type.restitution = restitution;
    return type;
}

/// A scene, at what step it runs, and the wall (body 0) or none.
struct Throw {
    Bodies bodies;
    PhysicsSettings settings;
    double dt = kStep;
    double thickness = 0;  ///< of the wall [m]
};

inline Throw empty_throw(std::mt19937_64& random, bool substeps) {
    Throw scene;
    scene.settings = substeps ? substepped_settings() : PhysicsSettings{};
    if (random() % 2 == 0) scene.settings.gravity.setZero();
    scene.dt = 1 / spread(random, 60, 240);
    return scene;
}

/// 0, 1 or between.
inline double random_part(std::mt19937_64& random) {
    const auto which = random() % 4;
    return which < 2 ? static_cast<double>(which) : uniform_in(random, 0, 1);
}

/// A body thrown at a wall of 1 mm to 1 m at 0.1 to 20 of its sizes a step, from anywhere within
/// three steps, turning by up to 3 radians a step in each plane.
inline Throw throw_at_wall(std::mt19937_64& random, int kind, bool substeps) {
    Throw scene = empty_throw(random, substeps);
    scene.thickness = spread(random, 0.001, 1);
    const double friction = random_part(random), restitution = random_part(random);
    BodyType wall = box_type({scene.thickness, 200, 200, 200});
    wall.fixed_position = wall.fixed_rotation = true;
    wall.friction = friction, wall.restitution = restitution;
    const Rotor turn = exp(random_plane(random, 2));
    add(scene.bodies, wall, Vec4::Zero(), Vec4::Zero(), {}, turn);

    const BodyType type = thrown_type(random, kind, friction, restitution);
    const double radius = bounding_radius(type.shape);
    const double speed = 2 * radius * spread(random, 0.1, 20) / scene.dt;
    const Vec4 aim = rotate(turn, Vec4(Vec4::UnitX()));
    const Vec4 velocity = speed * (aim + random_vector(random, uniform_in(random, 0, 1)));
    const double spin = random() % 2 == 0 ? 0 : spread(random, 0.01, 3) / scene.dt;
    const double away = 0.5 * scene.thickness + 1.001 * radius +
                        (random() % 2 == 0 ? 0 : uniform_in(random, 0, 3) * speed * scene.dt);
    add(scene.bodies, type, -away * aim, velocity, random_plane(random, spin),
        exp(random_plane(random, 2)));
    return scene;
}

/// Two bodies on the way to each other, the first one perhaps fixed.
inline Throw throw_at_each_other(std::mt19937_64& random, int kind, int other, bool fixed,
                                 bool substeps) {
    Throw scene = empty_throw(random, substeps);
    scene.settings.gravity.setZero();
    const double friction = random_part(random), restitution = random_part(random);
    BodyType target = thrown_type(random, other, friction, restitution);
    target.fixed_position = target.fixed_rotation = fixed;
    const BodyType type = thrown_type(random, kind, friction, restitution);
    const double radii = bounding_radius(target.shape) + bounding_radius(type.shape);
    const double speed = 2 * bounding_radius(type.shape) * spread(random, 0.1, 20) / scene.dt;
    const double spin = random() % 2 == 0 ? 0 : spread(random, 0.01, 3) / scene.dt;
    const Vec4 aim = random_vector(random, 1).normalized();
    const bool both = !fixed && random() % 2 == 0;
    add(scene.bodies, target, Vec4::Zero(), both ? Vec4(-0.5 * speed * aim) : Vec4(Vec4::Zero()),
        random_plane(random, fixed ? 0 : spin), exp(random_plane(random, 2)));
    const double beside = 0.15 * (inscribed_radius(target.shape) + inscribed_radius(type.shape));
    const double away = 1.001 * radii + uniform_in(random, 0, 3) * speed * scene.dt;
    add(scene.bodies, type, random_vector(random, beside) - away * aim,
        (both ? 0.5 : 1) * speed * aim, random_plane(random, spin), exp(random_plane(random, 2)));
    return scene;
}

/// One to four slender bodies that whirl between one to three walls, much rougher than any
/// material.
inline Throw throw_between_rough_walls(std::mt19937_64& random) {
    Throw scene;
    scene.settings.gravity.setZero();
    scene.settings.iterations = random() % 2 == 0 ? 10 : 100;
    const double friction = spread(random, 0.3, 30), restitution = random_part(random);
    for (auto walls = 1 + random() % 3; walls > 0; --walls)
        add(scene.bodies,
            plane_type(random_vector(random, 1).normalized(), -0.6, friction, restitution));
    for (auto bodies = 1 + random() % 4; bodies > 0; --bodies) {
        const double size = uniform_in(random, 0.3, 1.2), thin = size * spread(random, 0.01, 0.3);
        BodyType type =
            random() % 2 == 0 ? capsule_type(thin, size) : box_type({size, size, thin, thin});
        if (random() % 2 == 0) type = box_type({size, thin, thin, thin});
        type.mass = spread(random, 0.1, 10);
        type.friction = friction, type.restitution = restitution;
        const Vec4 place = random_vector(random, 0.8), velocity = random_vector(random, 5);
        const Bivector spin = random_plane(random, uniform_in(random, 0, 30));
        add(scene.bodies, type, place, velocity, spin, exp(random_plane(random, 2)));
    }
    return scene;
}

}  // namespace tesserae::testing
