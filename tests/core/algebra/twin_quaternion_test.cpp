// SPDX-License-Identifier: Apache-2.0
#include "core/algebra/twin_quaternion.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/core/algebra/blades.hpp"

namespace tesserae {
namespace {

/// A few roundings of sums of products of numbers of up to 5.
constexpr double kRounding = 5e-14;

double largest_difference_of(const Bivector& a, const Bivector& b) {
    return largest_of(to_dual_planes(a - b));
}

TEST(TwinQuaternion, MultipliesTurnsAndCommutesAsRotorsDo) {
    RandomAlgebra random(411);
    for (int i = 0; i < 3000; ++i) {
        const Rotor a = random.rotor(), b = random.rotor();
        EXPECT_LE(largest_difference(to_rotor(to_twin(a) * to_twin(b)), a * b), kRounding);
        const DualPlanes u = to_dual_planes(a.b), v = to_dual_planes(b.b);
        const auto turned = [](const TwinVector& w) { return to_bivector(to_dual_planes(w)); };
        EXPECT_LE(largest_difference_of(turned(rotate(to_twin(a), to_twin(v))), rotate(a, b.b)),
                  kRounding);
        EXPECT_LE(largest_difference_of(turned(rotate_back(to_twin(a), to_twin(v))),
                                        rotate(reverse(a), b.b)),
                  kRounding);
        EXPECT_LE(
            largest_difference_of(to_bivector(half_commutator(u, v)), half_commutator(a.b, b.b)),
            kRounding);
    }
}

TEST(TwinQuaternion, IsNormalizedAsRotorsAre) {
    RandomAlgebra random(412);
    for (int i = 0; i < 3000; ++i) {
        // Near unit length a series does it, from 1e-4 of its square on a root.
        for (const double drift : {1e-12, 1e-6, 2e-5, 4.9e-5, 5.1e-5, 0.1, 1e6}) {
            const Rotor r = random.rotor();
            const Rotor drifted{(1 + drift) * r.s, (1 + drift) * r.b, (1 + drift) * r.p};
            EXPECT_LE(largest_difference(to_rotor(normalized(to_twin(drifted))), r), 4e-15)
                << drift;
        }
    }
}

TEST(TwinQuaternion, TurnsThePlanesOfTheXAxis) {
    RandomAlgebra random(413);
    const std::array<Bivector, 3> planes{Bivector{1, 0, 0, 0, 0, 0}, Bivector{0, 1, 0, 0, 0, 0},
                                         Bivector{0, 0, 1, 0, 0, 0}};
    for (int i = 0; i < 3000; ++i) {
        const Rotor r = random.rotor();
        const auto turned = turned_planes(to_twin(r));
        for (int k = 0; k < 3; ++k)
            EXPECT_LE(largest_difference_of(to_bivector(turned[k]), rotate(r, planes[k])), 4e-15);
    }
}

}  // namespace
}  // namespace tesserae
