// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/constraint.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "core/dynamics/constraints/contact_row.hpp"
#include "core/dynamics/constraints/rolling_row.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/step/step.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// Two boxes in the middle of a step, turned at random and moving.
struct Two {
    Simulation simulation;
    StepData step;
};

Two random_two(std::mt19937_64& random, bool b_is_fixed = false) {
    Bodies bodies;
    for (int i = 0; i < 2; ++i) {
        BodyType type = box_type(random_vector(random, 0.4) + Vec4::Constant(0.6),
                                 std::exp(uniform(random, -2, 2)));
        type.friction = uniform(random, 0.1, 1), type.rolling_friction = uniform(random, 0, 0.2);
        const bool fixed = i == 1 && b_is_fixed;
        type.fixed_position = type.fixed_rotation = fixed;
        const Vec4 p = random_vector(random, 2), q = random_vector(random, 2);
        const Vec4 velocity = random_vector(random, 1);
        const Bivector omega{p[0], p[1], p[2], p[3], q[0], q[1]};
        add(bodies, type, random_vector(random, 1), (fixed ? 0 : 1) * velocity,
            (fixed ? 0.0 : 1.0) * omega, exp({p[0], q[1], p[2], q[3], q[0], p[1]}));
    }
    Two two{make_simulation(bodies, PhysicsSettings{}), {}};
    begin_step(two.simulation, two.step, kStep);
    advance_first_half(two.simulation, two.step, {0, 2});
    return two;
}

/// With unit wrenches that are orthonormal, as all kinds' rows are.
Constraint random_constraint(const Two& two, int size, std::mt19937_64& random) {
    Constraint constraint;
    constraint.a = 0, constraint.b = 1;
    constraint.r_a = random_vector(random, 1), constraint.r_b = random_vector(random, 1);
    Eigen::Matrix<double, 10, 10> m;
    for (int i = 0; i < 10; ++i)
        for (int j = 0; j < 10; ++j) m(i, j) = uniform(random, -1, 1);
    const Eigen::Matrix<double, 10, 10> axes =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 10, 10>>(m + m.transpose())
            .eigenvectors();
    constraint.size = size;
    for (int i = 0; i < size; ++i) {
        const auto axis = axes.col(i);
        constraint.rows[static_cast<std::size_t>(i)] = {
            axis.head<4>(), {axis[4], axis[5], axis[6], axis[7], axis[8], axis[9]}};
    }
    set_response(two.simulation, two.step, constraint);
    constraint.impulse.setZero(size);
    constraint.aim = RowVector::Random(size);
    return constraint;
}

RowVector velocities(const Two& two, const Constraint& constraint) {
    return row_velocities(constraint, motion_of(two.step, 0), motion_of(two.step, 1));
}

void apply(Two& two, const Constraint& constraint, const RowVector& impulses) {
    const auto change = motion_by(two.simulation, two.step, constraint, impulses);
    for (BodyId id = 0; id < 2; ++id) {
        two.step.velocity[id] += change[id].velocity;
        two.step.angular_velocity[id] += change[id].angular_velocity;
    }
}

/// A joint's rows have their velocities after one step, and the work of impulses is what they add
/// to the kinetic energy.
TEST(Constraint, OfAllImpulsesReachesItsAim) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
        Two two = random_two(random, i % 3 == 0);
        Constraint constraint = random_constraint(two, 1 + i % kMostRows, random);
        const RowVector before = velocities(two, constraint);
        const auto energy = [&] {
            double sum = 0;
            for (BodyId id = 0; id < 2; ++id) {
                const TypeProperties& type = two.simulation.type_of(id);
                if (!type.movable) continue;
                const BodyMotion motion = motion_of(two.step, id);
                sum +=
                    0.5 * type.mass * motion.velocity.squaredNorm() +
                    0.5 * dot(motion.angular_velocity,
                              angular_momentum(type, two.step.rotor[id], motion.angular_velocity));
            }
            return sum;
        };
        const double least = energy();
        const RowVector change = solve_rows(constraint, before);
        apply(two, constraint, change);
        const RowVector after = velocities(two, constraint);
        const double condition = constraint.response.norm() * constraint.mass.norm();
        EXPECT_LT((after - constraint.aim).norm(), 1e-13 * condition) << i;
        const double work = 0.5 * change.dot(before + after);
        EXPECT_NEAR(energy() - least, work, 1e-12 * (1 + std::abs(work)) * condition) << i;
    }
}

/// Momentum: what one body gets the other loses, with the moments about any point.
TEST(Constraint, GivesNoMomentum) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 1000; ++i) {
        Two two = random_two(random);
        Constraint constraint = random_constraint(two, 1 + i % kMostRows, random);
        // The anchors are one point: else they have a lever between them.
        constraint.r_b = two.step.position[0] + constraint.r_a - two.step.position[1];
        const RowVector impulses = RowVector::Random(constraint.size);
        const auto change = motion_by(two.simulation, two.step, constraint, impulses);
        Vec4 sum = Vec4::Zero();
        Bivector turning;
        for (BodyId id = 0; id < 2; ++id) {
            const TypeProperties& type = two.simulation.type_of(id);
            const Vec4 p = type.mass * change[id].velocity;
            sum += p;
            turning += wedge(two.step.position[id], p) +
                       angular_momentum(type, two.step.rotor[id], change[id].angular_velocity);
        }
        EXPECT_LT(sum.norm(), 1e-13 * (1 + impulses.norm())) << i;
        EXPECT_LT(norm(turning), 1e-11 * (1 + impulses.norm())) << i;
    }
}

/// In a set, steps lead to the one impulse that is optimal: what is left points out of the set.
TEST(Constraint, InASetReachesTheOptimum) {
    std::mt19937_64 random(3);
    int bounded = 0;
    for (int i = 0; i < 600; ++i) {
        const Two two = random_two(random);
        Constraint constraint = random_constraint(two, 1 + i % 5, random);
        constraint.set = i % 3 == 0   ? ImpulseSet::kHalfLine
                         : i % 3 == 1 ? ImpulseSet::kBox
                                      : ImpulseSet::kBall;
        constraint.most = uniform(random, 0.01, 1);
        constraint.compliance = i % 2 == 0 ? 0.1 : 0;
        set_response(two.simulation, two.step, constraint);
        const RowVector start = velocities(two, constraint);
        const auto now = [&]() -> RowVector {
            return start + constraint.response * constraint.impulse -
                   constraint.compliance * constraint.impulse;
        };
        for (int k = 0; k < 20000; ++k) solve_rows(constraint, now());
        const RowVector& impulse = constraint.impulse;
        const RowVector left = constraint.aim - now() - constraint.compliance * impulse;
        const double rounding = 1e-9;
        if (constraint.set == ImpulseSet::kBall) {
            EXPECT_LE(impulse.norm(), constraint.most * (1 + 1e-12));
            if (impulse.norm() < constraint.most * (1 - 1e-9)) {
                EXPECT_LT(left.norm(), rounding) << i;
            } else {  // it points outward
                EXPECT_LT((left - left.dot(impulse) / impulse.squaredNorm() * impulse).norm(),
                          1e-6 * left.norm() + rounding)
                    << i;
                EXPECT_GE(left.dot(impulse), 0) << i;
                ++bounded;
            }
            continue;
        }
        const bool half = constraint.set == ImpulseSet::kHalfLine;
        for (int k = 0; k < constraint.size; ++k) {
            const double least = half ? 0 : -constraint.most;
            EXPECT_GE(impulse[k], least);
            if (impulse[k] == least) {
                EXPECT_LT(left[k], rounding) << i;
                ++bounded;
            } else if (!half && impulse[k] == constraint.most) {
                EXPECT_GT(left[k], -rounding) << i;
                ++bounded;
            } else {
                EXPECT_NEAR(left[k], 0, rounding) << i;
            }
        }
    }
    EXPECT_GT(bounded, 300);
}

/// A contact's normal, its friction and its rolling, posed as constraints, have the masses of their
/// own rows.
TEST(Constraint, SolvesContactsAsTheirOwnRowsDo) {
    std::mt19937_64 random(4);
    for (int i = 0; i < 500; ++i) {
        Two two = random_two(random, i % 4 == 0);
        Contact contact;
        contact.a = 0, contact.b = 1;
        contact.point = random_vector(random, 1);
        contact.normal = random_vector(random, 1).normalized();
        ContactRow row = make_row(two.simulation, two.step, contact);
        Constraint normal;
        normal.a = 0, normal.b = 1, normal.r_a = row.r_a, normal.r_b = row.r_b;
        Constraint across = normal, rolling = normal;
        normal.size = 1;
        normal.rows[0] = {contact.normal, {}};
        set_response(two.simulation, two.step, normal);
        EXPECT_NEAR(normal.mass(0, 0), row.normal_mass, 1e-12 * row.normal_mass);

        // Three tangents.
        const Eigen::Matrix<double, 4, 1> n = contact.normal;
        const Mat4 axes =
            Eigen::SelfAdjointEigenSolver<Mat4>(Mat4(n * n.transpose())).eigenvectors();
        across.size = 3, across.set = ImpulseSet::kBall;
        for (int k = 0; k < 3; ++k) across.rows[static_cast<std::size_t>(k)] = {axes.col(k), {}};
        set_response(two.simulation, two.step, across);
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(across.mass(j, k), axes.col(j).dot(row.tangent_mass * axes.col(k)),
                            1e-10 * across.mass.norm())
                    << i;
        EXPECT_NEAR(across.step_mass, row.slide_mass, 1e-10 * row.slide_mass);

        // One step of rolling, from rest and with little or much normal impulse.
        row.normal_impulse = std::exp(uniform(random, -6, 3));
        RollingRow own = make_rolling_row(two.simulation, two.step, row);
        start_rolling_row(row, {}, own);
        if (own.arm == 0) continue;
        rolling.size = 3, rolling.set = ImpulseSet::kBall;
        rolling.most = own.arm * row.normal_impulse;
        for (int k = 0; k < 3; ++k)
            rolling.rows[static_cast<std::size_t>(k)] = {Vec4::Zero(), wedge(n, Vec4(axes.col(k)))};
        set_response(two.simulation, two.step, rolling);
        rolling.impulse.setZero(3), rolling.aim.setZero(3);
        Two other = two;
        apply(other, rolling, solve_rows(rolling, velocities(two, rolling)));
        own.twisting.mass.setZero(), own.twisting.step_mass = 0;  // rolling alone
        solve_rolling_row(two.simulation, two.step, row, own);
        for (BodyId id = 0; id < 2; ++id)
            EXPECT_LT(norm(two.step.angular_velocity[id] - other.step.angular_velocity[id]), 1e-9)
                << i;
    }
}

}  // namespace
}  // namespace tesserae
