// SPDX-License-Identifier: Apache-2.0
#include "core/algebra/bivector.hpp"

#include <gtest/gtest.h>

#include "tests/core/algebra/blades.hpp"

namespace tesserae {
namespace {

/// A few roundings of sums of up to 8 products of numbers of order 1 to 5.
constexpr double kGradeRounding = 2e-14;

TEST(Bivector, WedgeIsTheAntisymmetricProduct) {
    RandomAlgebra random(301);
    for (int i = 0; i < 2000; ++i) {
        const Vec4 a = random.vector(), b = random.vector();
        Multivector half = product(to_blades(a), to_blades(b));
        const Multivector other = product(to_blades(b), to_blades(a));
        for (unsigned k = 0; k < 16; ++k) half[k] = 0.5 * (half[k] - other[k]);
        EXPECT_LE(largest_difference(half, to_blades(Rotor{0, wedge(a, b), 0})), kGradeRounding);
        EXPECT_NEAR(wedge(wedge(a, b), wedge(a, b)), 0, kGradeRounding);  // simple
    }
}

TEST(Bivector, WedgeOfTwoIsTheirFourBladePart) {
    RandomAlgebra random(302);
    for (int i = 0; i < 2000; ++i) {
        const Bivector a = random.bivector(), b = random.bivector();
        const Multivector ab = product(to_blades(Rotor{0, a, 0}), to_blades(Rotor{0, b, 0}));
        EXPECT_NEAR(ab[15], wedge(a, b), kGradeRounding);
        EXPECT_NEAR(ab[0], -dot(a, b), kGradeRounding);
    }
}

TEST(Bivector, DualIsTheProductWithThePseudoscalar) {
    RandomAlgebra random(303);
    Multivector pseudoscalar{};
    pseudoscalar[15] = 1;
    for (int i = 0; i < 1000; ++i) {
        const Bivector b = random.bivector();
        EXPECT_EQ(largest_difference(product(to_blades(Rotor{0, b, 0}), pseudoscalar),
                                     to_blades(Rotor{0, dual(b), 0})),
                  0);
        EXPECT_EQ(dual(dual(b)), b);
        EXPECT_NEAR(dot(wedge(Vec4::UnitX(), Vec4::UnitY()), dual({1, 0, 0, 0, 0, 0})), 0, 0);
    }
}

TEST(Bivector, TurnsXTowardYWhenItsFirstComponentIsPositive) {
    EXPECT_EQ(velocity_at({1, 0, 0, 0, 0, 0}, Vec4::UnitX()), Vec4::UnitY());
    EXPECT_EQ(velocity_at({1, 0, 0, 0, 0, 0}, Vec4::UnitY()), -Vec4::UnitX());
    EXPECT_EQ(velocity_at({0, 0, 0, 0, 0, 1}, Vec4::UnitZ()), Vec4::UnitW());
    EXPECT_EQ(to_matrix(Bivector{7, 0, 0, 0, 0, 0})(1, 0), 7);
}

TEST(Bivector, VelocityIsTheCommutatorTheMatrixAndTheContraction) {
    RandomAlgebra random(304);
    for (int i = 0; i < 2000; ++i) {
        const Bivector omega = random.bivector();
        const Vec4 r = random.vector(), f = random.vector();
        const Vec4 v = velocity_at(omega, r);
        // d/dt (R b R~) with dR/dt = -1/2 omega R is (r omega - omega r)/2.
        const Multivector w = to_blades(Rotor{0, omega, 0});
        const Vec4 commutator =
            0.5 * (vector_part(product(to_blades(r), w)) - vector_part(product(w, to_blades(r))));
        EXPECT_LE((v - commutator).norm(), kGradeRounding);
        EXPECT_LE((v - to_matrix(omega) * r).norm(), kGradeRounding);
        // The power of a force is its torque's dot product with omega.
        EXPECT_NEAR(f.dot(v), dot(omega, wedge(r, f)), 5 * kGradeRounding);
    }
}

TEST(Bivector, ComesBackFromItsMatrix) {
    RandomAlgebra random(305);
    for (int i = 0; i < 500; ++i) {
        const Bivector b = random.bivector();
        EXPECT_EQ(to_bivector(to_matrix(b)), b);
        const Mat4 symmetric = Mat4::Constant(3) + Mat4(random.vector().asDiagonal());
        EXPECT_LE(largest_difference(to_bivector(to_matrix(b) + symmetric), b), kGradeRounding);
        EXPECT_DOUBLE_EQ(norm(b), to_matrix(b).norm() / std::sqrt(2.0));
    }
}

}  // namespace
}  // namespace tesserae
