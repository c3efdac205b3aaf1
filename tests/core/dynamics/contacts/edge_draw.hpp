// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <random>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

// What tests of internal edges draw at random.
namespace tesserae::testing {

struct Draw {
    std::mt19937_64 random;

    double number(double least, double most) {
        return std::uniform_real_distribution<>(least, most)(random);
    }
    double any_size(double least, double most) {
        return std::exp(number(std::log(least), std::log(most)));
    }
    /// Unit, across the floor.
    Vec4 across() {
        Vec4 v = random_vector(random, 1);
        v[1] = 0;
        return v.normalized();
    }
    /// Of a turn across the floor.
    Bivector spin(double most) {
        return {0, number(-most, most), number(-most, most), 0, 0, number(-most, most)};
    }
    Rotor turn() {
        const Vec4 a = random_vector(random, 1.5), b = random_vector(random, 1.5);
        return exp(Bivector{a[0], a[1], a[2], b[0], b[1], b[2]});
    }
};

inline std::array<PhysicsSettings, 2> with_and_without_substeps() {
    return {PhysicsSettings{}, substepped_settings()};
}

}  // namespace tesserae::testing
