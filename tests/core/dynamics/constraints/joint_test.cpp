// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/joint.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/diagnostics/momentum.hpp"
#include "core/error.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

Joint point_joint(BodyId a, const Vec4& on_a, BodyId b, const Vec4& on_b) {
    return {a, b, PointJoint{on_a, on_b}, false};
}

/// From a's anchor to b's [m].
Vec4 error_of(const Bodies& bodies, const Joint& joint) {
    const auto& kind = std::get<PointJoint>(joint.kind);
    const auto anchor = [&](BodyId id, const Vec4& r) -> Vec4 {
        return bodies.position[id] + to_matrix(bodies.rotor[id]) * r;
    };
    return anchor(joint.b, kind.on_b) - anchor(joint.a, kind.on_a);
}

double energy_of(const Stepper& world) {
    return kinetic_energy(world.bodies()) +
           potential_energy(world.bodies(), world.simulation().settings.gravity);
}

double largest_error(const Stepper& world) {
    double largest = 0;
    for (const Joint& joint : world.simulation().joints.all)
        largest = std::max(largest, error_of(world.bodies(), joint).norm());
    return largest;
}

/// A chain of balls along x, the first one held.
struct Chain {
    Bodies bodies;
    std::vector<Joint> joints;
};

Chain chain_of(int links, const Vec4& direction, double last_mass = 1) {
    Chain chain;
    add(chain.bodies, held_type());
    const double half = 0.5;
    for (int i = 0; i < links; ++i) {
        const BodyType type = sphere_type(0.3, i + 1 == links ? last_mass : 1);
        const BodyId id = add(chain.bodies, type, (2 * i + 1) * half * direction);
        const Vec4 ahead = i == 0 ? Vec4(Vec4::Zero()) : Vec4(half * direction);
        chain.joints.push_back(point_joint(id - 1, ahead, id, -half * direction));
    }
    return chain;
}

/// A rigid body about a fixed point by Runge and Kutta: an independent way to its motion. Its
/// angular momentum M about the point changes by r ^ m g, and M = I w + m r ^ (w.r).
class Top {
  public:
    Top(const Vec4& size, double mass, const Vec4& arm, const Vec4& gravity, const Rotor& rotor,
        const Bivector& omega)
        : mass_(mass), arm_(arm), weight_(mass * gravity), rotation_(to_matrix(rotor)) {
        for (int i = 0; i < 4; ++i) moments_[i] = mass * size[i] * size[i] / 12;
        momentum_ = momentum_of(rotation_, omega);
    }
    void advance(double dt) {
        const auto slope = [&](const Mat4& rotation, const Bivector& momentum) {
            const Bivector omega = omega_of(rotation, momentum);
            return std::pair<Mat4, Bivector>{to_matrix(omega) * rotation,
                                             wedge(Vec4(rotation * arm_), weight_)};
        };
        const auto [r1, m1] = slope(rotation_, momentum_);
        const auto [r2, m2] = slope(rotation_ + 0.5 * dt * r1, momentum_ + 0.5 * dt * m1);
        const auto [r3, m3] = slope(rotation_ + 0.5 * dt * r2, momentum_ + 0.5 * dt * m2);
        const auto [r4, m4] = slope(rotation_ + dt * r3, momentum_ + dt * m3);
        rotation_ += dt / 6 * (r1 + 2 * r2 + 2 * r3 + r4);
        momentum_ += dt / 6 * (m1 + 2.0 * m2 + 2.0 * m3 + m4);
    }
    Vec4 centre() const { return rotation_ * arm_; }

  private:
    Bivector momentum_of(const Mat4& rotation, const Bivector& omega) const {
        const Vec4 r = rotation * arm_;
        const Mat4 J = rotation * moments_.asDiagonal() * rotation.transpose();
        const Mat4 W = to_matrix(omega);
        return to_bivector(Mat4(J * W + W * J)) + wedge(r, Vec4(mass_ * velocity_at(omega, r)));
    }
    Bivector omega_of(const Mat4& rotation, const Bivector& momentum) const {
        Eigen::Matrix<double, 6, 6> map;
        const auto column = [](const Bivector& b) {
            return Eigen::Matrix<double, 6, 1>(b.xy, b.xz, b.xw, b.yz, b.yw, b.zw);
        };
        const auto unit = [](int i) {
            Bivector b;
            double* const planes[] = {&b.xy, &b.xz, &b.xw, &b.yz, &b.yw, &b.zw};
            *planes[i] = 1;
            return b;
        };
        for (int i = 0; i < 6; ++i) map.col(i) = column(momentum_of(rotation, unit(i)));
        const Eigen::Matrix<double, 6, 1> w = map.partialPivLu().solve(column(momentum));
        return {w[0], w[1], w[2], w[3], w[4], w[5]};
    }

    double mass_;
    Vec4 arm_, weight_, moments_;
    Mat4 rotation_;
    Bivector momentum_;
};

/// Where the centre of a box is after a time that hangs at a point and is set turning.
struct Hanging {
    Bodies bodies;
    std::vector<Joint> joints;
    Top top;
};

Hanging hanging(std::mt19937_64& random, bool flat) {
    const Vec4 size = random_vector(random, 0.3) + Vec4::Constant(0.5);
    const double mass = std::exp(uniform(random, -2, 2));
    const Vec4 arm = random_vector(random, 1);
    // From the pivot to the centre; the first swings in one plane, as a body of one inertia does.
    const Rotor rotor = flat ? Rotor{} : exp({0.3, -0.7, 0.2, 0.5, -0.4, 0.6});
    const Vec4 a = random_vector(random, 2), b = random_vector(random, 2);
    const Bivector omega = flat ? Bivector{} : Bivector{a[0], a[1], a[2], a[3], b[0], b[1]};
    const Vec4 centre = to_matrix(rotor) * arm;
    const Vec4 box = flat ? Vec4(Vec4::Constant(0.5)) : size;
    Hanging of{{}, {}, Top(box, mass, arm, kDown, rotor, omega)};
    add(of.bodies, held_type());
    add(of.bodies, box_type(box, mass), centre, velocity_at(omega, centre), omega, rotor);
    of.joints = {point_joint(0, Vec4::Zero(), 1, -arm)};
    return of;
}

PhysicsSettings settings_of() {
    PhysicsSettings settings;
    settings.gravity = kDown;
    return settings;
}

double error_after(double seconds, double dt, Hanging of, const ColouredFrom& coloured_from) {
    Stepper world(make_simulation(of.bodies, settings_of(), of.joints), coloured_from);
    const int steps = static_cast<int>(std::lround(seconds / dt));
    for (int i = 0; i < steps; ++i) world.step(dt);
    for (int i = 0; i < 4 * steps; ++i) of.top.advance(dt / 4);
    return (world.bodies().position[1] - of.top.centre()).norm();
}

/// Of second order: half of the time step leaves a fourth of the error.
TEST(PointJoint, SwingsAsTheEquationOfAPendulumSays) {
    for (const ColouredFrom& coloured_from : kAllWays)
        for (const bool flat : {true, false}) {
            std::mt19937_64 random(1);
            for (int i = 0; i < 8; ++i) {
                const Hanging of = hanging(random, flat);
                const double coarse = error_after(1, 1.0 / 240, of, coloured_from);
                const double fine = error_after(1, 1.0 / 480, of, coloured_from);
                EXPECT_LT(coarse, 0.02) << i;
                EXPECT_LT(fine, 0.3 * coarse + 2e-6) << i << " " << coloured_from.held;
            }
        }
}

/// Nothing is gained or lost on the whole, over a thousand swings.
TEST(PointJoint, KeepsItsEnergy) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        std::mt19937_64 random(2);
        const Hanging of = hanging(random, false);
        Stepper world(make_simulation(of.bodies, settings_of(), of.joints), coloured_from);
        const auto energy = [&] { return energy_of(world); };
        world.step(kStep);
        const double first = energy();
        double least = first, most = first;
        for (int i = 0; i < 240 * 60; ++i) {
            world.step(kStep);
            least = std::min(least, energy()), most = std::max(most, energy());
        }
        const double swing = of.bodies.type_of(1).mass * 10 * of.bodies.position[1].norm();
        EXPECT_LT(most - least, 0.01 * swing) << coloured_from.held;
        EXPECT_NEAR(energy(), first, 0.01 * swing) << coloured_from.held;
    }
}

/// Two boxes joined in flight keep their momentum, straight and turning.
TEST(PointJoint, KeepsMomentum) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        std::mt19937_64 random(3);
        for (int i = 0; i < 20; ++i) {
            Bodies bodies;
            const Vec4 on_a = random_vector(random, 0.5), on_b = random_vector(random, 0.5);
            const Vec4 p = random_vector(random, 3), q = random_vector(random, 3);
            add(bodies, box_type({0.5, 0.6, 0.3, 0.4}, 2), Vec4::Zero(), random_vector(random, 1),
                {p[0], p[1], p[2], p[3], q[0], q[1]});
            add(bodies, box_type({0.4, 0.4, 0.5, 0.3}, 1), on_a - on_b, random_vector(random, 1),
                {q[2], q[3], p[1], p[0], q[1], p[3]});
            Stepper world(
                make_simulation(bodies, without_gravity(), {point_joint(0, on_a, 1, on_b)}),
                coloured_from);
            const Vec4 momentum = total_momentum(world.bodies());
            const Bivector turning = total_angular_momentum(world.bodies());
            run(world, 240);
            const double rounding = coloured_from.held == 1 ? 1e-5 : 1e-11;
            EXPECT_LT((total_momentum(world.bodies()) - momentum).norm(), rounding) << i;
            EXPECT_LT(norm(total_angular_momentum(world.bodies()) - turning), rounding) << i;
            EXPECT_LT(largest_error(world), 2e-3) << i;
        }
    }
}

/// At rest a chain's joints are where they belong, and it falls asleep as one.
TEST(Chain, HangsStill) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        const Chain chain = chain_of(12, -Vec4::UnitY(), 3);
        PhysicsSettings settings = settings_of();
        settings.sleeping = true;
        Stepper world(make_simulation(chain.bodies, settings, chain.joints), coloured_from);
        StepReport report;
        for (int i = 0; i < 480; ++i) report = world.step(kStep);
        EXPECT_LT(largest_error(world), 1e-6) << coloured_from.held;
        EXPECT_LT(fastest_of(world), 1e-6) << coloured_from.held;
        EXPECT_EQ(report.asleep, 12u) << coloured_from.held;
        // What each joint bears: all below it.
        for (std::size_t i = 0; i < 12; ++i) {
            const double weight = 10 * (14 - static_cast<double>(i)) * kStep;
            EXPECT_NEAR(world.memory().joint_impulses[i].impulse[1], weight, 1e-3 * weight);
        }
    }
}

/// What hits one of those asleep wakes all of them.
TEST(Chain, WakesAsOne) {
    Chain chain = chain_of(5, -Vec4::UnitY());
    PhysicsSettings settings = settings_of();
    settings.sleeping = true;
    add(chain.bodies, sphere_type(0.2), {-16, -3.5, 0, 0}, {8, 10, 0, 0});
    Stepper world(make_simulation(chain.bodies, settings, chain.joints));
    StepReport report;
    for (int i = 0; i < 240; ++i) report = world.step(kStep);
    EXPECT_EQ(report.asleep, 5u);
    bool swung = false;
    for (int i = 0; i < 480; ++i) {
        report = world.step(kStep);
        EXPECT_TRUE(report.asleep == 0 || report.asleep >= 5) << i;
        swung |= world.bodies().velocity[1].norm() > 0.01;
    }
    EXPECT_TRUE(swung);
}

/// A swinging chain goes on with the same bits from bodies and memory as saved.
TEST(Chain, GoesOnFromItsMemory) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        const Chain chain = chain_of(8, Vec4(1, 0.2, 0.1, 0.3).normalized());
        for (const int substeps : {1, 3}) {
            PhysicsSettings settings = settings_of();
            settings.substeps = substeps;
            Stepper world(make_simulation(chain.bodies, settings, chain.joints), coloured_from);
            run(world, 30);
            Stepper again(make_simulation(world.bodies(), settings, chain.joints), coloured_from);
            again.memory() = world.memory();
            Stepper without(make_simulation(world.bodies(), settings, chain.joints), coloured_from);
            run(world, 20), run(again, 20), run(without, 20);
            EXPECT_TRUE(same_bits(world.bodies(), again.bodies()));
            EXPECT_EQ(world.memory().joint_impulses, again.memory().joint_impulses);
            EXPECT_FALSE(same_bits(world.bodies(), without.bodies()));  // so they are state
        }
    }
}

/// Jointed bodies overlap freely, unless they are to collide.
TEST(Joint, LeavesContactsOfItsBodiesOut) {
    for (const bool collide : {false, true}) {
        Bodies bodies;
        add(bodies, sphere_type(0.5));
        add(bodies, sphere_type(0.5), {0.5, 0, 0, 0});
        Joint joint = point_joint(0, {0.25, 0, 0, 0}, 1, {-0.25, 0, 0, 0});
        joint.collide = collide;
        Stepper world(make_simulation(bodies, without_gravity(), {joint}));
        EXPECT_EQ(world.step(kStep).contacts, collide ? 1u : 0u);
    }
}

/// A dumbbell of which one end hits a thin wall is stopped as a whole: else the other end would go
/// on by up to 6 cm, and the joint would be torn by a part of it. It then swings round.
TEST(Joint, IsNotTornWhereABodyIsStopped) {
    constexpr double kSpeed = 30, kFront = 3 - 0.025, kRadius = 0.1;
    for (const ColouredFrom& coloured_from : kAllWays)
        for (const double ahead : {0.002, 0.01, 0.02, 0.03, 0.04}) {
            Bodies bodies;
            BodyType wall = box_type({0.05, 0.3, 4, 4});
            wall.fixed_position = wall.fixed_rotation = true;
            add(bodies, wall, {3, 0, 0, 0});
            const double x = kFront - kRadius - ahead;  // it touches in the first half of a step
            add(bodies, sphere_type(kRadius), {x, 0, 0, 0}, {kSpeed, 0, 0, 0});
            add(bodies, sphere_type(kRadius), {x, 0.6, 0, 0}, {kSpeed, 0, 0, 0});
            Stepper world(make_simulation(bodies, without_gravity(),
                                          {point_joint(1, {0, 0.3, 0, 0}, 2, {0, -0.3, 0, 0})}),
                          coloured_from);
            double torn = 0;
            for (int i = 0; i < 4; ++i) {
                world.step(kStep);
                torn = std::max(torn, largest_error(world));
            }
            EXPECT_LT(world.bodies().position[1][0], 3) << ahead;
            EXPECT_GT(world.bodies().position[2][0], 3) << ahead;
            EXPECT_LT(torn, 0.01) << ahead;
        }
}

/// An impact leaves the velocities of what joints hold as they are. Those are not 0: the ways of
/// what whirls bend, for which the last load has aimed.
TEST(Joint, KeepsItsRowsVelocitiesInAnImpact) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        Bodies bodies;
        const Bivector spin{40, 0, 0, 0, 0, 0};
        for (const double y : {-0.5, 0.5})
            add(bodies, sphere_type(0.3, 1, 0, 1), {0, y, 0, 0}, velocity_at(spin, {0, y, 0, 0}),
                spin);
        add(bodies, sphere_type(0.3, 2, 0, 1), {-2.2, 0.5, 0.1, -0.1}, {12, 0, 0, 0});
        Stepper world(make_simulation(bodies, without_gravity(),
                                      {point_joint(0, {0, 0.5, 0, 0}, 1, {0, -0.5, 0, 0})}),
                      coloured_from);
        StageCopy before(Stage::kSolveImpacts), after(Stage::kIntegrateVelocities);
        const auto rows_of = [](const StepData& step) -> RowVector {
            const Constraint& c = step.constraints[0];
            return row_velocities(c, motion_of(step, c.a), motion_of(step, c.b));
        };
        double fastest = 0;
        int hits = 0;
        for (int i = 0; i < 60; ++i) {
            Stepper again(
                make_simulation(world.bodies(), without_gravity(), world.simulation().joints.all),
                coloured_from);
            again.memory() = world.memory();
            world.observe(&before), again.observe(&after);
            world.step(kStep), again.step(kStep);
            if (before.step.velocity[2] == after.step.velocity[2]) continue;
            ++hits;
            fastest = std::max(fastest, rows_of(before.step).norm());
            EXPECT_LT((rows_of(after.step) - rows_of(before.step)).norm(),
                      PhysicsSettings{}.tolerance)
                << i;
        }
        EXPECT_GT(hits, 0);
        EXPECT_GT(fastest, 0.1);  // so that it could fail
    }
}

/// A ball that hits one end of a dumbbell elastically: momentum and energy stay.
TEST(Joint, HandsAnElasticImpactOn) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        Bodies bodies;
        for (const double y : {-0.5, 0.5}) add(bodies, sphere_type(0.3, 1, 0, 1), {0, y, 0, 0});
        add(bodies, sphere_type(0.3, 2, 0, 1), {-1.5, 0.5, 0.1, -0.1}, {6, 0, 0, 0});
        Stepper world(
            make_simulation(bodies, without_gravity(),
                            {point_joint(0, 0.5 * Vec4::UnitY(), 1, -0.5 * Vec4::UnitY())}),
            coloured_from);
        const double before = energy_of(world);
        run(world, 120);
        EXPECT_NEAR(energy_of(world), before, 0.01 * before) << coloured_from.held;
        EXPECT_GT(world.bodies().velocity[1][0], 1) << coloured_from.held;
        EXPECT_LT(largest_error(world), 2e-3) << coloured_from.held;
    }
}

TEST(Joint, RefusesBodiesThatCannotBeJoined) {
    Bodies bodies;
    add(bodies, held_type());
    add(bodies, held_type());
    add(bodies, sphere_type(0.5), {2, 0, 0, 0});
    const auto joined = [&](BodyId a, BodyId b) {
        return make_simulation(bodies, PhysicsSettings{},
                               {point_joint(a, Vec4::Zero(), b, Vec4::Zero())});
    };
    EXPECT_NO_THROW(joined(0, 2));
    EXPECT_THROW(joined(0, 1), InputError);
    EXPECT_THROW(joined(2, 2), InputError);
    EXPECT_THROW(joined(2, 3), InputError);
}

}  // namespace
}  // namespace tesserae
