// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>

#include "tests/core/dynamics/builder.hpp"

namespace tesserae::bench {

using std::numbers::pi;
using testing::add, testing::add_walls, testing::heap_of_spheres;
using testing::plane_type, testing::random_vector, testing::sphere_type;

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
