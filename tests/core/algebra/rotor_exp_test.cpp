// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/algebra/blades.hpp"

namespace tesserae {
namespace {

/// A few roundings of numbers of order pi.
constexpr double kExpRounding = 8e-15;

/// A bivector with angles first in a random plane and second in the plane orthogonal to it.
Bivector in_two_planes(RandomAlgebra& random, double first, double second) {
    const Bivector plane = random.plane();
    return first * plane + second * dual(plane);
}

TEST(RotorExp, TurnsXToYByAQuarter) {
    const double quarter = M_PI / 2;
    const Rotor r = exp(-0.5 * Bivector{quarter, 0, 0, 0, 0, 0});
    EXPECT_LE((rotate(r, Vec4::UnitX()) - Vec4::UnitY()).norm(), 1e-15);
    EXPECT_LE((rotate(r, Vec4::UnitY()) + Vec4::UnitX()).norm(), 1e-15);
    EXPECT_LE((rotate(r, Vec4::UnitZ()) - Vec4::UnitZ()).norm(), 1e-15);
    EXPECT_EQ(exp(Bivector{}), Rotor{});
}

TEST(RotorExp, HasTheSpeedThatTheAngularVelocityGives) {
    // x(h) = R(h) b R~(h) with R(h) = exp(-h/2 omega) R: central differences over 2 h = 2e-5 are
    // off by h^2 |omega|^3 / 6 < 2e-9 and 1e-16/h = 1e-11.
    RandomAlgebra random(321);
    const double h = 1e-5;
    for (int i = 0; i < 2000; ++i) {
        const Bivector omega = random.bivector();
        const Rotor r = random.rotor();
        const Vec4 b = random.vector().normalized();
        const Vec4 ahead = rotate(exp(-h / 2 * omega) * r, b);
        const Vec4 behind = rotate(exp(h / 2 * omega) * r, b);
        EXPECT_LE(((ahead - behind) / (2 * h) - velocity_at(omega, rotate(r, b))).norm(), 1e-8);
    }
}

TEST(RotorExp, OfASimpleBivectorIsCosineAndSine) {
    RandomAlgebra random(322);
    for (int i = 0; i < 3000; ++i) {
        const double angle = std::pow(10, random.uniform(-12, 6));
        const Bivector b = angle * random.plane();
        const long double size = std::sqrt((long double)b.xy * b.xy + (long double)b.xz * b.xz +
                                           (long double)b.xw * b.xw + (long double)b.yz * b.yz +
                                           (long double)b.yw * b.yw + (long double)b.zw * b.zw);
        const double c = double(std::cos(size)), s = double(std::sin(size) / size);
        // The angle is known to a few eps of itself; so then is the result. A tiny one comes out
        // as exactly as it went in.
        const Rotor r = exp(b);
        EXPECT_LE(largest_difference(r, Rotor{c, s * b, 0}), 1e-15 * (1 + 3 * angle)) << angle;
        EXPECT_LE(largest_difference(r.b, s * b), 1e-15 * angle * (1 + angle)) << angle;
        EXPECT_LE(spin4_defect(r), 1e-15) << angle;
    }
}

TEST(RotorExp, OfAnyFiniteSizeIsAUnitRotor) {
    RandomAlgebra random(323);
    for (double size : {1e-320, 1e-300, 1e-160, 1e-150, 1e-20, 1e15, 1e100, 1e160, 1e300})
        for (int i = 0; i < 200; ++i) {
            const Rotor r = exp(size * random.bivector());
            EXPECT_LE(spin4_defect(r), 1e-15) << size;
        }
}

/// From angles that have a series to twice as large ones, which may have none.
TEST(RotorExp, OfSmallAnglesIsTheRootOfThatOfTwiceTheAngle) {
    RandomAlgebra random(325);
    for (int i = 0; i < 3000; ++i) {
        const double size = std::pow(10.0, -6 + 4.0 * i / 3000);
        const Bivector b = in_two_planes(random, size, 0.3 * size);
        const Rotor root = exp(b), twice = exp(2 * b);
        EXPECT_LE(largest_difference(root * root, twice), 4e-16) << size;
        // Their small parts, of 2.1 times the size, to four roundings of their own.
        EXPECT_LE(norm((root * root).b - twice.b), 2e-15 * size) << size;
    }
}

TEST(RotorExp, IsAProductOverTheInvariantPlanes) {
    RandomAlgebra random(324);
    for (int i = 0; i < 3000; ++i) {
        const Bivector plane = random.plane();
        const Bivector first = random.gauss() * plane, second = random.gauss() * dual(plane);
        EXPECT_LE(largest_difference(exp(first) * exp(second), exp(first + second)), kExpRounding);
        // And the power law along one b.
        const Bivector b = random.bivector();
        EXPECT_LE(largest_difference(exp(0.25 * b) * exp(0.75 * b), exp(b)), kExpRounding);
    }
}

TEST(RotorLog, IsUndoneByExpEverywhere) {
    RandomAlgebra random(325);
    const auto check = [](const Rotor& r) {
        const Bivector b = log(r);
        EXPECT_LE(largest_difference(exp(b), r), kExpRounding)
            << r.s << " " << norm(r.b) << " " << r.p;
        EXPECT_LE(norm(b), M_PI * std::sqrt(2.0) + kExpRounding);
    };
    for (int i = 0; i < 2000; ++i) {
        const Bivector plane = random.plane();
        const double angle = random.uniform(-7, 7);
        check(random.rotor());
        check(-random.rotor());
        check({0, plane, 0});                             // half turn
        check(exp(in_two_planes(random, angle, 0)));      // simple
        check(exp(in_two_planes(random, angle, angle)));  // isoclinic
        check(exp(in_two_planes(random, angle, -angle)));
        check(exp(in_two_planes(random, M_PI, 0)));             // near -1
        check(exp(in_two_planes(random, M_PI / 2, M_PI / 2)));  // near xyzw
        check(exp(in_two_planes(random, M_PI - 1e-8, 1e-9)));
        check(exp(in_two_planes(random, 1e-12, 1e-13)));
    }
    check({});
    check({-1, {}, 0});
    check({0, {}, 1});
    check({0, {}, -1});
    EXPECT_EQ(log(Rotor{}), Bivector{});
}

TEST(RotorLog, GivesBackTheSmallestBivector) {
    RandomAlgebra random(326);
    for (int i = 0; i < 3000; ++i) {
        // Both quaternion angles, |first +- second|, stay 0.01 below pi, where directions are known
        // to pi eps / sin(0.01).
        const double sum = random.uniform(0, M_PI - 0.01), share = random.uniform(-1, 1);
        for (double second : {sum * (share < 0 ? -0.3 : 0.3), 0.0, 0.5 * sum, -0.5 * sum}) {
            const Bivector b = in_two_planes(random, sum - std::abs(second), second);
            EXPECT_LE(largest_difference(log(exp(b)), b), 1e-13) << sum << " " << second;
        }
    }
}

TEST(RotorLog, KeepsTheDigitsOfTinyTurns) {
    RandomAlgebra random(327);
    for (double size : {1e-3, 1e-8, 1e-12, 1e-100, 1e-200, 1e-290})
        for (int i = 0; i < 300; ++i) {
            const Bivector b = size * random.bivector();
            EXPECT_LE(largest_difference(log(exp(b)), b), 4e-15 * size) << size;
        }
}

TEST(Interpolation, MeetsBothEndsAtOneSpeedTheShortestWay) {
    RandomAlgebra random(329);
    for (int i = 0; i < 2000; ++i) {
        const Rotor r0 = random.rotor(), r1 = random.rotor();
        EXPECT_LE(largest_difference(interpolate(r0, r1, 0), r0), kExpRounding);
        EXPECT_LE((to_matrix(interpolate(r0, r1, 1)) - to_matrix(r1)).norm(), kExpRounding);
        // Equal steps turn by the same rotor, which is t of the whole.
        const Rotor a = interpolate(r0, r1, 0.2), b = interpolate(r0, r1, 0.6);
        const Rotor c = interpolate(r0, r1, 1);
        EXPECT_LE(largest_difference(b * reverse(a), c * reverse(b)), 2 * kExpRounding);
        // No other logarithm of the same rotation is shorter.
        const Rotor turn = r1 * reverse(r0);
        const double taken = norm(log(interpolate(r0, r1, 1) * reverse(r0)));
        EXPECT_LE(taken, std::min(norm(log(turn)), norm(log(-turn))) + kExpRounding);
        // R and -R are the same place.
        EXPECT_LE(largest_difference(interpolate(r0, -r1, 0.7), interpolate(r0, r1, 0.7)),
                  kExpRounding);
    }
}

TEST(Interpolation, OfHalfTurnsGoesTheFixedWayWhateverTheRounding) {
    RandomAlgebra random(330);
    for (int i = 0; i < 2000; ++i) {
        const Rotor r0 = random.rotor();
        const Bivector plane = random.plane();
        const double sign = plane.xy > 0 ? 1 : -1;
        if (std::abs(plane.xy) < 1e-6) continue;
        const Rotor halfway = exp(sign * M_PI / 4 * plane) * r0;
        for (double half : {M_PI / 2, -M_PI / 2}) {
            const Rotor r1 = exp(half * plane) * r0;
            EXPECT_LE(largest_difference(interpolate(r0, r1, 0.5), halfway), 4 * kExpRounding);
            EXPECT_LE(largest_difference(interpolate(r0, -r1, 0.5), halfway), 4 * kExpRounding);
        }
    }
}

TEST(Interpolation, OfEqualRotorsStays) {
    RandomAlgebra random(331);
    for (int i = 0; i < 500; ++i) {
        const Rotor r = random.rotor();
        EXPECT_LE(largest_difference(interpolate(r, r, 0.3), r), kExpRounding);
        EXPECT_LE(largest_difference(interpolate(r, -r, 0.3), r), kExpRounding);
    }
}

}  // namespace
}  // namespace tesserae
