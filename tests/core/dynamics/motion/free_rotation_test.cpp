// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/free_rotation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

const Vec4 kSides{0.5, 1.0, 1.7, 2.6};
constexpr double kMass = 3;
const Bivector kSpin{2.0, -1.1, 0.7, 1.3, -0.4, 0.9};

Vec4 second_moments_of_box(const Vec4& sides) { return kMass / 12 * sides.cwiseAbs2(); }

Stepper spinning_box(const Vec4& sides, const Bivector& omega, RotationIntegrator integrator) {
    Bodies bodies;
    add(bodies, box_type(sides, kMass), Vec4::Zero(), Vec4::Zero(), omega);
    PhysicsSettings settings;
    settings.gravity.setZero();
    settings.integrator = integrator;
    return Stepper(bodies, settings);
}

/// Angular momentum in the world frame by matrices: L = J Omega + Omega J.
Mat4 momentum(const Bodies& bodies, const Vec4& J_body) {
    const Mat4 R = to_matrix(bodies.rotor[0]);
    const Mat4 J = R * J_body.asDiagonal() * R.transpose();
    const Mat4 Omega = to_matrix(bodies.angular_velocity[0]);
    return J * Omega + Omega * J;
}

/// Sum over planes of (J_i^2 + J_j^2) L_ij^2 in the body frame, which free rotation keeps.
double fourth_invariant(const Bodies& bodies, const Vec4& J) {
    const Mat4 R = to_matrix(bodies.rotor[0]);
    const Mat4 L = R.transpose() * momentum(bodies, J) * R;
    double sum = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) sum += (J[i] * J[i] + J[j] * J[j]) * L(i, j) * L(i, j);
    return sum;
}

/// Free rotation by fourth-order Runge-Kutta on 4x4 matrices in long double: with L constant in
/// the world frame, the body-frame entry L_ij = (J_i + J_j) Omega_ij, and R' = R Omega_body.
using LongMat = Eigen::Matrix<long double, 4, 4>;

LongMat rotation_oracle(const Vec4& J, const Bivector& omega, double time, int steps) {
    const LongMat Omega = to_matrix(omega).cast<long double>();
    LongMat L;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            L(i, j) = (static_cast<long double>(J[i]) + J[j]) * Omega(i, j);  // R = 1 at the start
    const auto rate = [&](const LongMat& R) {
        LongMat O = R.transpose() * L * R;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) O(i, j) /= static_cast<long double>(J[i]) + J[j];
        return LongMat(R * O);
    };
    LongMat R = LongMat::Identity();
    const long double h = static_cast<long double>(time) / steps;
    for (int i = 0; i < steps; ++i) {
        const LongMat k1 = rate(R), k2 = rate(R + h / 2 * k1), k3 = rate(R + h / 2 * k2),
                      k4 = rate(R + h * k3);
        R += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return R;
}

struct Errors {
    double rotation, energy, invariant;
};

Errors errors_after_a_second(RotationIntegrator integrator, int steps) {
    Stepper world = spinning_box(kSides, kSpin, integrator);
    const Vec4 J = second_moments_of_box(kSides);
    const double energy = kinetic_energy(world.bodies());
    const double invariant = fourth_invariant(world.bodies(), J);
    for (int i = 0; i < steps; ++i) world.step(1.0 / steps);
    const Mat4 oracle = rotation_oracle(J, kSpin, 1.0, 4000).cast<double>();
    return {(to_matrix(world.bodies().rotor[0]) - oracle).norm(),
            std::abs(kinetic_energy(world.bodies()) / energy - 1),
            std::abs(fourth_invariant(world.bodies(), J) / invariant - 1)};
}

TEST(FreeRotation, KeepsAngularMomentumInTheWorldFrame) {
    for (RotationIntegrator integrator :
         {RotationIntegrator::kEuler, RotationIntegrator::kMidpoint}) {
        Stepper world = spinning_box(kSides, kSpin, integrator);
        const Vec4 J = second_moments_of_box(kSides);
        const Mat4 before = momentum(world.bodies(), J);
        for (int i = 0; i < 2400; ++i) world.step(1.0 / 240);
        // 4800 half steps, each through some ten products and a projection of the rotor: 10 ulp a
        // half step if all went one way. Left out, the gyroscopic term would change L by a tenth.
        const Mat4 change = momentum(world.bodies(), J) - before;
        EXPECT_LT(change.norm(), 4800 * 10 * 2.2e-16 * before.norm());
    }
}

TEST(FreeRotation, ByEulerConvergesInFirstOrder) {
    const Errors coarse = errors_after_a_second(RotationIntegrator::kEuler, 480);
    const Errors fine = errors_after_a_second(RotationIntegrator::kEuler, 960);
    // Halving the step halves the errors; the next order adds its own part, below 1/10 here.
    EXPECT_NEAR(coarse.rotation / fine.rotation, 2, 0.2) << fine.rotation;
    EXPECT_NEAR(coarse.energy / fine.energy, 2, 0.2) << fine.energy;
    EXPECT_NEAR(coarse.invariant / fine.invariant, 2, 0.2) << fine.invariant;
}

TEST(FreeRotation, ByMidpointConvergesInSecondOrder) {
    const Errors coarse = errors_after_a_second(RotationIntegrator::kMidpoint, 480);
    const Errors fine = errors_after_a_second(RotationIntegrator::kMidpoint, 960);
    EXPECT_NEAR(coarse.rotation / fine.rotation, 4, 0.4) << fine.rotation;
    EXPECT_LT(fine.rotation, 1e-4);
}

/// Boxes, slender ones and spheres; at rest, slow, fast and at speeds that no step resolves.
BodyType random_type(std::mt19937_64& random) {
    if (random() % 5 == 0) return sphere_type(uniform(random, 0.1, 1));
    Vec4 sides;
    for (double& side : sides) side = std::pow(10, uniform(random, random() % 3 == 0 ? -3 : -1, 0));
    return box_type(sides, uniform(random, 0.1, 10));
}
Bivector random_spin(std::mt19937_64& random) {
    if (random() % 10 == 0) return {};
    const double fastest = std::pow(10, uniform(random, -8, random() % 4 == 0 ? 4 : 1));
    const Vec4 a = random_vector(random, fastest), b = random_vector(random, fastest);
    return {a[0], a[1], a[2], b[0], b[1], b[2]};
}

TEST(FreeRotation, OfTwoBodiesIsThatOfEach) {
    std::mt19937_64 random(47);
    for (int i = 0; i < 20000; ++i) {
        Bodies bodies;
        for (int k = 0; k < 2; ++k) {
            const Bivector turn = random_spin(random);
            add(bodies, random_type(random), Vec4::Zero(), Vec4::Zero(), random_spin(random),
                exp(turn));
        }
        const std::vector<TypeProperties> types = type_properties(bodies);
        Bodies alone = bodies;
        const auto integrator =
            i % 8 == 0 ? RotationIntegrator::kEuler : RotationIntegrator::kMidpoint;
        const auto body = [&](BodyId id) {
            return FreeBody{types[bodies.type[id]], bodies.rotor[id], bodies.angular_velocity[id]};
        };
        turn_freely(body(0), body(1), integrator, kStep);
        for (BodyId id = 0; id < 2; ++id) {
            turn_freely(types[alone.type[id]], integrator, kStep, alone.rotor[id],
                        alone.angular_velocity[id]);
            EXPECT_EQ(bodies.rotor[id], alone.rotor[id]) << i;
            EXPECT_EQ(bodies.angular_velocity[id], alone.angular_velocity[id]) << i;
        }
    }
}

/// Small turns are made by series, large ones by sines.
TEST(FreeRotation, OfABallIsAnEvenTurnUpToTheMostTurn) {
    std::mt19937_64 random(48);
    Bodies bodies;
    add(bodies, sphere_type(0.5));
    const TypeProperties type = type_properties(bodies)[0];
    for (int i = 0; i < 20000; ++i) {
        const Bivector spin = random_spin(random);
        Bivector omega = spin;
        const Rotor start = exp(random_spin(random));
        Rotor rotor = start;
        turn_freely(type, RotationIntegrator::kMidpoint, kStep, rotor, omega);
        EXPECT_EQ(omega, spin);
        const Mat4 expected = to_matrix(exp(-0.5 * kStep * spin) * start);
        // What rounds is the angle, and the products.
        const double angle = kStep * std::sqrt(dot(spin, spin));
        EXPECT_LT((to_matrix(rotor) - expected).norm(), 4e-15 + 4e-16 * angle) << i;
    }
}

/// The largest relative changes of the four invariants over a million steps, 1/480 s in halves.
void expect_invariants(const Vec4& sides, const Bivector& spin) {
    Bodies bodies;
    add(bodies, box_type(sides, kMass));
    const TypeProperties type = type_properties(bodies)[0];
    const Vec4 J = second_moments_of_box(sides);
    bodies.angular_velocity[0] = spin;
    const double energy = kinetic_energy(bodies), fourth = fourth_invariant(bodies, J);
    const Mat4 L = momentum(bodies, J);
    const Bivector l = to_bivector(L);
    double worst = 0;
    for (int i = 1; i <= 2000000; ++i) {
        turn_freely(type, RotationIntegrator::kMidpoint, 1.0 / 480, bodies.rotor[0],
                    bodies.angular_velocity[0]);
        if (i % 1000 != 0) continue;
        const Bivector now = to_bivector(momentum(bodies, J));
        worst = std::max({worst, std::abs(kinetic_energy(bodies) / energy - 1),
                          std::abs(dot(now, now) / dot(l, l) - 1),
                          std::abs(wedge(now, now) - wedge(l, l)) / dot(l, l),
                          std::abs(fourth_invariant(bodies, J) / fourth - 1)});
    }
    EXPECT_LT(worst, 1e-9);
}

TEST(FreeRotation, ByMidpointKeepsAllInvariants) {
    expect_invariants(kSides, kSpin);
    // Slender and flat, a thousand times as long as wide, about the middle axis: the iteration for
    // the middle momentum does not converge here, Newton's does.
    expect_invariants({1000, 30, 1, 1.1}, {0.01, 3, 0.001, 0.02, 0.001, 0.001});
}

TEST(FreeRotation, OfAThousandRadiansASecondKeepsItsEnergy) {
    Stepper world =
        spinning_box(kSides, {900, -300, 200, 100, -50, 20}, RotationIntegrator::kMidpoint);
    const double energy = kinetic_energy(world.bodies());
    for (int i = 0; i < 240; ++i) world.step(1.0 / 60);
    // 16 rad a step, done in pieces; rounding of 240 times 32 pieces, some 10 ulp each.
    EXPECT_NEAR(kinetic_energy(world.bodies()) / energy, 1, 240 * 32 * 10 * 2.2e-16);
}

/// Angles are not resolved then, but what acts on others is as it should be.
TEST(FreeRotation, FasterThanAnyStepResolvesKeepsAllInvariants) {
    for (const Vec4& sides : {kSides, Vec4(1, 0.02, 0.02, 0.02), Vec4(1, 1, 1, 0.001)})
        for (const double speed : {1e5, 1e7, 1e9, 1e12}) {
            Bodies bodies;
            add(bodies, box_type(sides, kMass), Vec4::Zero(), Vec4::Zero(), speed * kSpin);
            const TypeProperties type = type_properties(bodies)[0];
            const Vec4 J = second_moments_of_box(sides);
            const double energy = kinetic_energy(bodies);
            const Bivector l = to_bivector(momentum(bodies, J));
            for (int i = 0; i < 10; ++i)
                turn_freely(type, RotationIntegrator::kMidpoint, 1.0 / 480, bodies.rotor[0],
                            bodies.angular_velocity[0]);
            EXPECT_NEAR(kinetic_energy(bodies) / energy, 1, 1e-10) << speed;
            EXPECT_LT(norm(to_bivector(momentum(bodies, J)) - l), 1e-10 * norm(l)) << speed;
        }
}

// Rotation confined to xyz is Euler's in three dimensions, with (w_yz, -w_xz, w_xy) for the vector.
using Triple = std::array<long double, 3>;

Triple euler_oracle(const Triple& I, Triple w, double time, int steps) {
    const auto rate = [&](const Triple& v) {
        return Triple{(I[1] - I[2]) / I[0] * v[1] * v[2], (I[2] - I[0]) / I[1] * v[2] * v[0],
                      (I[0] - I[1]) / I[2] * v[0] * v[1]};
    };
    const auto plus = [](const Triple& a, long double k, const Triple& b) {
        return Triple{a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]};
    };
    const long double h = static_cast<long double>(time) / steps;
    for (int i = 0; i < steps; ++i) {
        const Triple k1 = rate(w), k2 = rate(plus(w, h / 2, k1)), k3 = rate(plus(w, h / 2, k2)),
                     k4 = rate(plus(w, h, k3));
        for (int k = 0; k < 3; ++k) w[k] += h / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
    }
    return w;
}

double distance_from_euler(const Triple& start, double time, int steps) {
    const Vec4 J = second_moments_of_box(kSides);
    Bivector omega;
    omega.yz = static_cast<double>(start[0]);
    omega.xz = -static_cast<double>(start[1]);
    omega.xy = static_cast<double>(start[2]);
    Stepper world = spinning_box(kSides, omega, RotationIntegrator::kMidpoint);
    for (int i = 0; i < steps; ++i) world.step(time / steps);
    const Bodies& bodies = world.bodies();
    const Bivector body = rotate(reverse(bodies.rotor[0]), bodies.angular_velocity[0]);
    EXPECT_LT(std::abs(body.xw) + std::abs(body.yw) + std::abs(body.zw), 1e-12);
    const Triple I{J[1] + J[2], J[0] + J[2], J[0] + J[1]};
    const Triple w = euler_oracle(I, start, time, 20000);
    return std::sqrt(std::pow(body.yz - static_cast<double>(w[0]), 2) +
                     std::pow(-body.xz - static_cast<double>(w[1]), 2) +
                     std::pow(body.xy - static_cast<double>(w[2]), 2));
}

TEST(FreeRotation, WithinXyzIsEulersInThreeDimensions) {
    const Triple start{1.2L, -0.8L, 2.1L};
    const double coarse = distance_from_euler(start, 4, 2000);
    const double fine = distance_from_euler(start, 4, 4000);
    EXPECT_NEAR(coarse / fine, 4, 0.4);
    EXPECT_LT(fine, 1e-4);
}

TEST(FreeRotation, AboutTheMiddleAxisTumblesAsATennisRacketDoes) {
    // J_x < J_y < J_z, so I_yz > I_xz > I_xy: the middle one is I_xz, the second component.
    const Vec4 J = second_moments_of_box(kSides);
    const Triple I{J[1] + J[2], J[0] + J[2], J[0] + J[1]};
    const Triple start{1e-3L, 3, 1e-3L};
    double flip = 0;
    for (double t = 0.5; t < 20 && flip == 0; t += 0.5)
        if (euler_oracle(I, start, t, 4000)[1] < -2.9L) flip = t;
    ASSERT_GT(flip, 0) << "the oracle shows no flip";
    const double coarse = distance_from_euler(start, flip, 4000);
    const double fine = distance_from_euler(start, flip, 8000);
    EXPECT_NEAR(coarse / fine, 4, 0.4);
    EXPECT_LT(fine, 1e-2);
}

TEST(FreeRotation, OfAFixedRotationKeepsItsAngularVelocity) {
    Bodies bodies;
    BodyType type = box_type(kSides, kMass);
    type.fixed_rotation = true;
    add(bodies, type, Vec4::Zero(), Vec4::Zero(), kSpin);
    Stepper world(bodies, PhysicsSettings{});
    for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
    EXPECT_EQ(world.bodies().angular_velocity[0], kSpin);
    const Mat4 turned = to_matrix(world.bodies().rotor[0]);
    EXPECT_LT((turned - to_matrix(exp(-0.5 * kSpin))).norm(), 1e-12);
    EXPECT_NEAR(world.bodies().position[0][1], -5, 1e-12);  // its position is free
}

}  // namespace
}  // namespace tesserae
