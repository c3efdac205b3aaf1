// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/bodies.hpp"
#include "core/dynamics/stepper.hpp"

namespace tesserae::bench::gate {

constexpr double kDefaultRate = 240;  ///< [1/s]

/// What is seen of bodies that move for a while.
struct Watched {
    /// Largest rise of the energy since any time before, as a part of the largest kinetic energy.
    double gain = 0;
    double deepest = 0;       ///< overlap of all steps [m]
    double last_deepest = 0;  ///< of the last step [m]
    double last_fastest = 0;  ///< of any body in the last second [m/s]
};

/// Takes a world on, and looks at it after every step.
Watched watch(Stepper& world, double seconds, double rate = kDefaultRate);

/// The greatest speed of a body's centre [m/s].
double fastest_of(const Bodies& bodies);

/// Moves what contacts can move by up to 10^-9 of its size; nothing at 0.
void shake(Bodies& bodies, std::uint64_t shake);

// Drawing scenes.

constexpr int kShapes = 8;  ///< all bounded ones
/// @param kind   0 to kShapes - 1
/// @param size   largest extent of it, about [m]
BodyType drawn_type(std::mt19937_64& engine, int kind, double size);

/// A plate, a rod or a coin: thin along one direction, or along all but one.
/// @param kind   0 to kThinShapes - 1
constexpr int kThinShapes = 6;
BodyType thin_type(int kind, double size, double thickness);

Bivector drawn_plane(std::mt19937_64& engine, double most);
Rotor drawn_rotor(std::mt19937_64& engine);
/// As likely in each decade.
double drawn_decade(std::mt19937_64& engine, double least, double most);

/// The least half-extent of a body along its own axes [m].
double half_thickness(const Shape& shape);

inline PhysicsSettings gravity_of_10() {
    PhysicsSettings settings;
    settings.gravity = {0, -10, 0, 0};
    return settings;
}

}  // namespace tesserae::bench::gate
