// SPDX-License-Identifier: Apache-2.0
// The only file that includes Eigen's matrix functions, which compile slowly.
#include <gtest/gtest.h>

#include <unsupported/Eigen/MatrixFunctions>

#include "tests/core/algebra/blades.hpp"

namespace tesserae {
namespace {

void expect_matrix_exponential(const Bivector& omega) {
    // Pade with scaling and squaring: a few eps for every doubling, and eps |omega| for the angle.
    const Mat4 expected = to_matrix(omega).exp();
    EXPECT_LE((to_matrix(exp(-0.5 * omega)) - expected).norm(), 1e-14 * (1 + norm(omega)))
        << norm(omega);
}

TEST(RotorExp, MatchesTheMatrixExponential) {
    RandomAlgebra random(341);
    for (int i = 0; i < 3000; ++i) {
        const double size = std::pow(10, random.uniform(-12, 1));
        const Bivector plane = random.plane();
        expect_matrix_exponential(size * random.bivector());
        expect_matrix_exponential(size * plane);
        expect_matrix_exponential(size * (plane + dual(plane)));
        expect_matrix_exponential(size * (plane - dual(plane)));
    }
    expect_matrix_exponential({});
}

TEST(RotorLog, MatchesTheMatrixLogarithm) {
    // Angles below pi in both planes, where the matrix logarithm is the principal one.
    RandomAlgebra random(342);
    for (int i = 0; i < 500; ++i) {
        const Bivector plane = random.plane();
        const Bivector omega = random.uniform(0, 3) * plane + random.uniform(-3, 3) * dual(plane);
        const Rotor r = exp(-0.5 * omega);
        const Mat4 logarithm = to_matrix(r).log();
        const Bivector back = -2.0 * log(r);
        EXPECT_LE((to_matrix(back) - logarithm).norm(), 1e-11);  // inverse square roots, Schur
        EXPECT_LE(largest_difference(back, omega), 1e-13);
    }
}

}  // namespace
}  // namespace tesserae
