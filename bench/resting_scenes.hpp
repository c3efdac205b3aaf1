// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "bench/bodies.hpp"

// Scenes in which all should stay where it is put, or soon come to rest.
namespace tesserae::bench {

inline BodyType box_type(const Vec4& size, double mass) {
    BodyType type;
    type.shape = Hyperbox{size};
    type.mass = mass;
    type.friction = 0.5;
    return type;
}

inline Bodies floor_and(double restitution = 0) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5, restitution), Vec4::Zero());
    return bodies;
}

/// Unit boxes on each other, their masses from the ground up.
/// @param gap   between one box and the next, at first [m]
inline Bodies tower(const std::vector<double>& masses, const Vec4& place = Vec4::Zero(),
                    double gap = 0) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), place[1], 0.5, 0), Vec4::Zero());
    double y = 0.5;
    for (const double mass : masses) {
        add(bodies, box_type(Vec4::Ones(), mass), place + Vec4(0, y, 0, 0));
        y += 1 + gap;
    }
    return bodies;
}

inline Bodies small_tower(int count, double size) {
    Bodies bodies = floor_and();
    for (int i = 0; i < count; ++i)
        add(bodies, box_type(Vec4::Constant(size), 1), {0, size * (i + 0.5), 0, 0});
    return bodies;
}

inline Bodies pyramid(int rows) {
    Bodies bodies = floor_and();
    for (int row = 0; row < rows; ++row)
        for (int i = 0; i < rows - row; ++i)
            add(bodies, box_type(Vec4::Ones(), 1000),
                {1.05 * (i - 0.5 * (rows - row - 1)), 0.5 + row, 0, 0});
    return bodies;
}

inline Bodies boards() {
    Bodies bodies = floor_and();
    for (int i = 0; i < 10; ++i)
        add(bodies, box_type({2, 0.1, 0.5, 0.5}, 50), {0, 0.05 + 0.1 * i, 0, 0});
    return bodies;
}

/// Twelve logs, 5, 4 and 3, between walls that leave 0.1 % of slack.
inline Bodies logs() {
    constexpr double kRadius = 0.3, kHalf = 1.001 * 5 * kRadius;
    Bodies bodies = floor_and();
    for (const Vec4& inward : {Vec4(0, 0, 1, 0), Vec4(0, 0, -1, 0)})
        add(bodies, plane_type(inward, -kHalf, 0.5, 0));
    for (const Vec4& inward : {Vec4(0, 0, 0, 1), Vec4(0, 0, 0, -1)})
        add(bodies, plane_type(inward, -1.001 * kRadius, 0.5, 0));
    BodyType type = testing::capsule_type(kRadius, 1);
    type.friction = 0.5;
    const Rotor lying = exp(Bivector{0.25 * pi});
    for (int row = 0; row < 3; ++row)
        for (int i = 0; i < 5 - row; ++i)
            add(bodies, type,
                {0, kRadius * (1 + row * std::sqrt(3.0)), kRadius * (2 * i + row - 4), 0},
                Vec4::Zero(), {}, lying);
    return bodies;
}

/// One across the other, put down from 1 mm.
inline Bodies rulers() {
    Bodies bodies = floor_and();
    const BodyType ruler = box_type({0.3, 0.003, 0.03, 0.03}, 0.01);
    add(bodies, ruler, {0, 0.0015, 0, 0});
    add(bodies, ruler, {0, 0.0055, 0, 0}, Vec4::Zero(), {}, exp(Bivector{0, pi / 8}));
    return bodies;
}

/// Each row moved by a quarter of a box.
inline Bodies wall(int rows, int in_row) {
    Bodies bodies = floor_and();
    for (int row = 0; row < rows; ++row)
        for (int i = 0; i < in_row; ++i)
            add(bodies, box_type({1, 0.5, 0.5, 0.5}, 125),
                {1.05 * i + (row % 2) * 0.25, 0.25 + 0.5 * row, 0, 0});
    return bodies;
}

/// Spheres of 1 mm, 0.1, 10 and 1000 m in diameter, beside each other, and two of 1 m on the last.
inline Bodies mixed_sizes() {
    Bodies bodies = floor_and();
    double x = 0;
    for (const double radius : {0.0005, 0.05, 5.0, 500.0}) {
        x += 1.5 * radius;
        add(bodies, sphere_type(radius, 1000 * std::pow(radius, 4), 0.5, 0), {x, radius, 0, 0});
        x += 1.5 * radius;
    }
    add(bodies, sphere_type(0.5, 60, 0.5, 0), {x - 750, 1000.5, 0, 0});
    return bodies;
}

inline Bodies deep_boxes() {
    Bodies bodies = floor_and();
    for (int i = 0; i < 4; ++i)
        add(bodies, box_type(Vec4::Ones(), 1000), {0.1 * i, 0.5 + 0.3 * i, 0.05 * i, 0});
    return bodies;
}

inline Bodies deep_spheres() {
    Bodies bodies = floor_and();
    for (int i = 0; i < 8; ++i)
        add(bodies, sphere_type(0.5, 1000, 0.5, 0), {0.01 * i, 0.5 + 0.01 * i, 0.005 * (i % 3), 0});
    return bodies;
}

inline Bodies long_capsule() {
    Bodies bodies = floor_and();
    BodyType type;
    type.shape = Hypercapsule{0.01, 200};
    type.mass = 10;
    type.friction = 0.5;
    const BodyId id = add(bodies, type, {0, 0.01, 0, 0});
    bodies.rotor[id] = exp(Bivector{0.25 * pi, 0, 0, 0, 0, 0});  // lies along x
    return bodies;
}

}  // namespace tesserae::bench
