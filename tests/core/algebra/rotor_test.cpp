// SPDX-License-Identifier: Apache-2.0
#include "core/algebra/rotor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/core/algebra/blades.hpp"

namespace tesserae {
namespace {

/// A few roundings of sums of 8 products of numbers below 1.
constexpr double kProductRounding = 4e-15;

Vec4 sandwich(const Rotor& r, const Vec4& v) {
    return vector_part(product(product(to_blades(r), to_blades(v)), to_blades(reverse(r))));
}

TEST(Rotor, ProductMatchesTheBladeTable) {
    RandomAlgebra random(311);
    for (int i = 0; i < 5000; ++i) {
        const Rotor a = random.even(), b = random.even();
        // Components are sums of 8 products of numbers of up to 5: 8 * 25 * eps.
        EXPECT_LE(largest_difference(to_blades(a * b), product(to_blades(a), to_blades(b))), 5e-14);
    }
}

TEST(Rotor, ProductIsAssociativeAndReversedByReverse) {
    RandomAlgebra random(312);
    for (int i = 0; i < 3000; ++i) {
        const Rotor a = random.rotor(), b = random.rotor(), c = random.rotor();
        EXPECT_LE(largest_difference((a * b) * c, a * (b * c)), kProductRounding);
        EXPECT_LE(largest_difference(reverse(a * b), reverse(b) * reverse(a)), kProductRounding);
        EXPECT_LE(largest_difference(a * reverse(a), Rotor{}), kProductRounding);
        EXPECT_LE(spin4_defect(a * b), kProductRounding);
    }
}

TEST(Rotor, ReverseTurnsTheOrderOfEveryBlade) {
    const Rotor r = {1, {2, 3, 4, 5, 6, 7}, 8};
    EXPECT_EQ(reverse(r), (Rotor{1, {-2, -3, -4, -5, -6, -7}, 8}));
}

TEST(Rotor, MatrixIsTheSandwichOfEveryAxis) {
    RandomAlgebra random(313);
    for (int i = 0; i < 3000; ++i) {
        const Rotor a = random.rotor(), b = random.rotor();
        const Mat4 m = to_matrix(a);
        for (int axis = 0; axis < 4; ++axis)
            EXPECT_LE((m.col(axis) - sandwich(a, Vec4::Unit(axis))).norm(), kProductRounding);
        // The matrix scales by |R|^2, and R's own length is off by rounding.
        const double error = kProductRounding + 4 * spin4_defect(a);
        EXPECT_LE((m.transpose() * m - Mat4::Identity()).norm(), error);
        EXPECT_NEAR(m.determinant(), 1, error);
        EXPECT_LE((to_matrix(a * b) - m * to_matrix(b)).norm(), kProductRounding);
        EXPECT_LE((y_axis_of(a) - m.col(1)).norm(), kProductRounding);
        EXPECT_EQ(to_matrix(-a), m);
        const Vec4 v = random.vector();
        EXPECT_LE((rotate(a, v) - m * v).norm(), kProductRounding * v.norm());
    }
}

TEST(Rotor, TurnsBivectorsAsTheMatrixDoes) {
    RandomAlgebra random(314);
    for (int i = 0; i < 3000; ++i) {
        const Rotor r = random.rotor();
        const Bivector b = random.bivector();
        const Mat4 m = to_matrix(r), turned = m * to_matrix(b) * m.transpose();
        EXPECT_LE((to_matrix(rotate(r, b)) - turned).norm(), 2 * kProductRounding * norm(b));
        const Vec4 u = random.vector(), v = random.vector();
        EXPECT_LE(largest_difference(rotate(r, wedge(u, v)), wedge(rotate(r, u), rotate(r, v))),
                  2 * kProductRounding * u.norm() * v.norm());
    }
}

TEST(Rotor, ComesBackFromItsMatrixUpToSign) {
    RandomAlgebra random(315);
    const auto check = [](const Rotor& r) {
        const Rotor back = to_rotor(to_matrix(r));
        EXPECT_LE(std::min(largest_difference(back, r), largest_difference(back, -r)),
                  kProductRounding);
        for (double c :
             {back.s, back.b.xy, back.b.xz, back.b.xw, back.b.yz, back.b.yw, back.b.zw, back.p}) {
            if (std::abs(c) <= kRotorNoise) continue;
            EXPECT_GT(c, 0);  // the sign rule
            break;
        }
        EXPECT_EQ(to_rotor(to_matrix(-r)), back);
    };
    for (int i = 0; i < 2000; ++i) {
        const Bivector plane = random.plane();
        check(random.rotor());
        check({0, plane, 0});  // half turn of a plane
        check(Rotor{0, plane, 0} * random.rotor());
        const double c = random.uniform(-1, 1), s = std::sqrt(1 - c * c);
        check({c, s * plane, 0});      // simple
        check({0, s * plane, c});      // a half turn of one plane, any of the other
        check({1, 1e-12 * plane, 0});  // (defect 1e-24)
    }
    check({});
    check({0, {}, 1});  // everything turned to its opposite
    for (int k = 0; k < 6; ++k) {
        Bivector b;
        (k == 0 ? b.xy : k == 1 ? b.xz : k == 2 ? b.xw : k == 3 ? b.yz : k == 4 ? b.yw : b.zw) = 1;
        check({0, b, 0});
        check({std::sqrt(0.5), std::sqrt(0.5) * b, 0});
    }
}

TEST(RotorProjection, MeetsBothConditionsAfterAnyDrift) {
    RandomAlgebra random(316);
    double worst = 0;
    for (int i = 0; i < 5000; ++i) {
        const double size = std::pow(10, random.uniform(-16, -1));
        Rotor r = random.rotor();
        const Rotor e = random.even();
        r = {r.s + size * e.s, r.b + size * e.b, r.p + size * e.p};
        worst = std::max(worst, spin4_defect(projected_to_spin4(r)));
        // Once there, it stays: no drift of its own.
        const Rotor once = projected_to_spin4(r);
        EXPECT_LE(largest_difference(projected_to_spin4(once), once), 1e-15);
    }
    EXPECT_LE(worst, 1e-15);
}

TEST(RotorProjection, IsTheFormulaThroughTheSquareRootOfRTimesItsReverse) {
    // core/FORMULAS.md 1: R R~ = a + b xyzw, u +- v = sqrt(a +- b), R <- (u - v xyzw)/(u^2 - v^2)
    // R.
    RandomAlgebra random(317);
    for (int i = 0; i < 3000; ++i) {
        Rotor r = random.rotor();
        const Rotor e = random.even();
        r = {r.s + 0.05 * e.s, r.b + 0.05 * e.b, r.p + 0.05 * e.p};
        const Multivector square = product(to_blades(r), to_blades(reverse(r)));
        const double a = square[0], b = square[15];
        const double u = 0.5 * (std::sqrt(a + b) + std::sqrt(a - b));
        const double v = 0.5 * (std::sqrt(a + b) - std::sqrt(a - b));
        const double k = 1 / (u * u - v * v);
        const Multivector expected = product(to_blades(Rotor{k * u, {}, -k * v}), to_blades(r));
        EXPECT_LE(largest_difference(to_blades(projected_to_spin4(r)), expected), kProductRounding);
    }
}

TEST(RotorProjection, IsTheNearestRotor) {
    RandomAlgebra random(318);
    const auto gap = [](const Rotor& a, const Rotor& b) {
        const Bivector d = a.b - b.b;
        return std::sqrt((a.s - b.s) * (a.s - b.s) + dot(d, d) + (a.p - b.p) * (a.p - b.p));
    };
    for (int i = 0; i < 2000; ++i) {
        const Rotor unit = random.rotor(), e = random.even();
        const double size = std::pow(10, random.uniform(-6, -1.5));
        const Rotor r = {unit.s + size * e.s, unit.b + size * e.b, unit.p + size * e.p};
        const Rotor projected = projected_to_spin4(r);
        const double least = gap(r, projected);
        EXPECT_LE(least, gap(r, unit) + kProductRounding);
        for (double step : {1e-1, 1e-3, 1e-5, 1e-7}) {
            const Rotor other = exp(step * random.bivector()) * projected;
            EXPECT_LE(least, gap(r, other) + kProductRounding) << step;
        }
    }
}

TEST(RotorProjection, IgnoresScaleAndThePseudoscalar) {
    // (u + v xyzw) R has R as its nearest rotor for every u > |v|.
    RandomAlgebra random(319);
    for (int i = 0; i < 2000; ++i) {
        const Rotor r = random.rotor();
        const double u = random.uniform(0.1, 10), v = random.uniform(-0.9, 0.9) * u;
        EXPECT_LE(largest_difference(projected_to_spin4(Rotor{u, {}, v} * r), r),
                  10 * kProductRounding);
    }
}

}  // namespace
}  // namespace tesserae
