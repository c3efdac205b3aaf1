// SPDX-License-Identifier: Apache-2.0
#include "bench/gate/watch.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/dynamics/diagnostics/energy.hpp"

namespace tesserae::bench::gate {
namespace {

template <class S>
Shape completed(S shape) {
    complete(shape);
    return shape;
}

Shape drawn_shape(std::mt19937_64& engine, int kind, double size) {
    const auto part = [&] { return testing::uniform(engine, 0.4, 1) * size; };
    switch (kind) {
        case 0:
            return Hypersphere{0.5 * size};
        case 1:
            return Hypercapsule{0.25 * part(), 0.7 * part()};
        case 2:
            return Hyperbox{{part(), part(), part(), part()}};
        case 3: {
            Polychoron shape;
            shape.regular = static_cast<RegularPolychoron>(1 + engine() % 4);
            shape.radius = 0.5 * size;
            return completed(shape);
        }
        case 4: {
            Duoprism shape;
            for (auto& sides : shape.polygons) sides = 3 + static_cast<int>(engine() % 4);
            shape.radii = {0.5 * part(), 0.5 * part()};
            return completed(shape);
        }
        case 5: {
            Spherinder shape;
            shape.radius = 0.5 * part(), shape.height = part();
            return completed(shape);
        }
        case 6: {
            Cubinder shape;
            shape.radius = 0.5 * part(), shape.size = {part(), part()};
            return completed(shape);
        }
        default: {
            Duocylinder shape;
            shape.radii = {0.5 * part(), 0.5 * part()};
            return completed(shape);
        }
    }
}

Shape thin_shape(int kind, double size, double thickness) {
    switch (kind) {
        case 0:
            return Hyperbox{{size, thickness, size, size}};
        case 1:
            return Hyperbox{{size, thickness, 0.5 * size, thickness}};
        case 2:
            return Hypercapsule{0.5 * thickness, size - thickness};
        case 3: {
            Spherinder shape;
            shape.radius = 0.5 * size, shape.height = thickness;
            return completed(shape);
        }
        case 4: {
            Cubinder shape;
            shape.radius = 0.5 * size, shape.size = {thickness, thickness};
            return completed(shape);
        }
        default: {
            Duocylinder shape;
            shape.radii = {0.5 * size, 0.5 * thickness};
            return completed(shape);
        }
    }
}

}  // namespace

Watched watch(Stepper& world, double seconds, double rate) {
    const Vec4 gravity = world.simulation().settings.gravity;
    const long steps = std::lround(seconds * rate);
    double kinetic = kinetic_energy(world.bodies());
    double least = kinetic + potential_energy(world.bodies(), gravity);
    double most_kinetic = kinetic, rise = 0;
    Watched seen;
    for (long i = 0; i < steps; ++i) {
        seen.last_deepest = world.step(1 / rate).penetration;
        seen.deepest = std::max(seen.deepest, seen.last_deepest);
        kinetic = kinetic_energy(world.bodies());
        const double energy = kinetic + potential_energy(world.bodies(), gravity);
        most_kinetic = std::max(most_kinetic, kinetic);
        least = std::min(least, energy);
        rise = std::max(rise, energy - least);
        if (static_cast<double>(steps - i) <= rate)
            seen.last_fastest = std::max(seen.last_fastest, fastest_of(world.bodies()));
    }
    if (most_kinetic > 0) seen.gain = rise / most_kinetic;
    return seen;
}

double fastest_of(const Bodies& bodies) {
    double fastest = 0;
    for (BodyId id = 0; id < bodies.size(); ++id)
        if (bodies.is_movable(id)) fastest = std::max(fastest, bodies.velocity[id].norm());
    return fastest;
}

void shake(Bodies& bodies, std::uint64_t shake) {
    if (shake == 0) return;
    std::mt19937_64 engine(shake);
    for (BodyId id = 0; id < bodies.size(); ++id)
        if (bodies.is_movable(id))
            bodies.position[id] +=
                random_vector(engine, 1e-9 * bounding_radius(bodies.type_of(id).shape));
}

BodyType drawn_type(std::mt19937_64& engine, int kind, double size) {
    BodyType type;
    type.shape = drawn_shape(engine, kind, size);
    type.mass = 1000 * std::visit([](const auto& s) -> double { return volume(s); }, type.shape);
    return type;
}

BodyType thin_type(int kind, double size, double thickness) {
    BodyType type;
    type.shape = thin_shape(kind, size, thickness);
    return type;
}

Bivector drawn_plane(std::mt19937_64& engine, double most) {
    const Vec4 a = random_vector(engine, most), b = random_vector(engine, most);
    return {a[0], a[1], a[2], b[0], b[1], b[2]};
}

Rotor drawn_rotor(std::mt19937_64& engine) { return exp(drawn_plane(engine, 2)); }

double drawn_decade(std::mt19937_64& engine, double least, double most) {
    return least * std::pow(most / least, testing::uniform(engine, 0, 1));
}

double half_thickness(const Shape& shape) {
    return std::visit(
        [](const auto& s) -> double { return half_extents(s, Mat4::Identity()).minCoeff(); },
        shape);
}

}  // namespace tesserae::bench::gate
