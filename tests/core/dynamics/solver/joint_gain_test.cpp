// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/joint_gain.hpp"

#include <gtest/gtest.h>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/diagnostics/momentum.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

constexpr double kLinkRadius = 0.05;

struct Chain {
    Bodies bodies;
    std::vector<Joint> joints;

    /// Joined to the last one, which is `half` long from its joint to its centre.
    void append(const BodyType& type, double half, double half_before, const Vec4& direction) {
        const BodyId last = static_cast<BodyId>(bodies.size() - 1);
        const Vec4 at = bodies.position.back() + (half_before + half) * direction;
        const BodyId id = add(bodies, type, at);
        joints.push_back({last, id, PointJoint{half_before * direction, -half * direction}, false});
    }
};

/// Links of 1 kg from the origin, with a load at the end.
Chain hung_chain(int links, double load, const Vec4& direction) {
    Chain chain;
    add(chain.bodies, held_type());
    double last = 0;
    for (int i = 0; i < links; ++i) {
        chain.append(sphere_type(kLinkRadius), kLinkRadius, last, direction);
        last = kLinkRadius;
    }
    chain.append(sphere_type(0.3, load), 0.3, last, direction);
    return chain;
}

double total_energy(const Stepper& world) {
    return kinetic_energy(world.bodies()) +
           potential_energy(world.bodies(), world.simulation().settings.gravity);
}

/// Let go aslant, chains whip round faster than a step can follow, and gain no energy but for what
/// a sub-step gives and another takes.
void expect_whips_gain_nothing(std::initializer_list<double> rates) {
    const Vec4 direction = Vec4(1, -0.2, 0.3, 0.4).normalized();
    for (const double rate : rates)
        for (const int links : {7, 20})
            for (const double load : {1.0, 6.0, 20.0, 100.0, 1800.0}) {
                const Chain chain = hung_chain(links, load, direction);
                Stepper world(make_simulation(chain.bodies, PhysicsSettings{}, chain.joints));
                const double fall = (links + load) * 10 * 2 * kLinkRadius * links;
                const double first = total_energy(world);
                double most = first;
                for (int i = 0; i < 3 * rate; ++i) {
                    world.step(1 / rate);
                    most = std::max(most, total_energy(world));
                }
                EXPECT_LT(most - first, 1e-2 * fall) << rate << " " << links << " " << load;
            }
}

TEST(JointGain, AWhipGainsNoEnergy) { expect_whips_gain_nothing({240}); }
TEST(JointGainSlow, AWhipGainsNoEnergy) { expect_whips_gain_nothing({120, 480}); }

struct Whip {
    double error = 0;  ///< farthest that two anchors were apart [m]
    double lost = 0;   ///< energy at the end [of the fall's]
    double most = 0;   ///< largest gain of energy [of the fall's]
};

double farthest_apart(const Stepper& world) {
    const Bodies& bodies = world.bodies();
    double farthest = 0;
    for (const Joint& joint : world.simulation().joints.all) {
        const auto& at = std::get<PointJoint>(joint.kind);
        const Vec4 a = bodies.position[joint.a] + rotate(bodies.rotor[joint.a], at.on_a);
        const Vec4 b = bodies.position[joint.b] + rotate(bodies.rotor[joint.b], at.on_b);
        farthest = std::max(farthest, (a - b).norm());
    }
    return farthest;
}

Whip let_go_level(int links, double load, double rate) {
    const Chain chain = hung_chain(links, load, Vec4::UnitX());
    Stepper world(make_simulation(chain.bodies, PhysicsSettings{}, chain.joints));
    const double fall = (links + load) * 10 * 2 * kLinkRadius * links, first = total_energy(world);
    Whip whip;
    for (int i = 0; i < 4 * rate; ++i) {
        world.step(1 / rate);
        whip.error = std::max(whip.error, farthest_apart(world));
        whip.most = std::max(whip.most, (total_energy(world) - first) / fall);
    }
    whip.lost = (first - total_energy(world)) / fall;
    return whip;
}

/// Light links turn by more than a right angle in a step when they whip. They hold, and the load
/// keeps its energy.
void expect_load_keeps_its_energy(int links) {
    for (const double load : {200.0, 1800.0}) {
        const Whip rough = let_go_level(links, load, 240);
        const Whip fine = let_go_level(links, load, 960);
        EXPECT_LT(rough.error, 1e-3) << links << " " << load;
        EXPECT_LT(rough.lost, 0.02) << links << " " << load;
        EXPECT_LT(fine.lost, std::max(1e-6, rough.lost / 4)) << links << " " << load;
        for (const Whip& whip : {rough, fine}) EXPECT_LT(whip.most, 1e-5);
    }
}

TEST(JointGain, AHeavyLoadThatWhipsKeepsItsEnergy) { expect_load_keeps_its_energy(20); }
TEST(JointGainSlow, AHeavyLoadThatWhipsKeepsItsEnergy) { expect_load_keeps_its_energy(50); }

/// Light links between heavy ends, thrown so that they whip: free, and so the momenta stay.
void expect_momenta_stay(int chains) {
    std::mt19937_64 random(5);
    for (int round = 0; round < chains; ++round) {
        Chain chain;
        add(chain.bodies, box_type({0.4, 0.3, 0.5, 0.2}, 10), Vec4::Zero());
        double last = 0.1;
        const Vec4 direction = random_vector(random, 1).normalized();
        for (int i = 0; i < 12; ++i) {
            chain.append(sphere_type(kLinkRadius, 0.05), kLinkRadius, last, direction);
            last = kLinkRadius;
        }
        chain.append(box_type(Vec4::Constant(0.2), 5), 0.1, last, direction);
        for (Vec4& v : chain.bodies.velocity) v = random_vector(random, 15);
        for (Bivector& omega : chain.bodies.angular_velocity) omega.xy = uniform(random, -9, 9);
        for (Joint& joint : chain.joints) joint.collide = false;
        Stepper world(make_simulation(chain.bodies, without_gravity(), chain.joints));
        run(world, 2);  // to velocities that the joints allow
        const Vec4 momentum = total_momentum(world.bodies());
        const Bivector angular = total_angular_momentum(world.bodies());
        const double energy = kinetic_energy(world.bodies());
        double most = energy;
        for (int i = 0; i < 240; ++i) {
            world.step(kStep);
            most = std::max(most, kinetic_energy(world.bodies()));
        }
        EXPECT_LT((total_momentum(world.bodies()) - momentum).norm(), 1e-9 * momentum.norm());
        EXPECT_LT(norm(total_angular_momentum(world.bodies()) - angular), 1e-9 * norm(angular));
        EXPECT_LT(most, 1.005 * energy) << round;
    }
}

TEST(JointGain, LeavesTheMomentaOfWhatIsFree) { expect_momenta_stay(2); }
TEST(JointGainSlow, LeavesTheMomentaOfWhatIsFree) { expect_momenta_stay(8); }

/// A chain on a body that moves on whips as one on a body that stands.
TEST(JointGain, IsTheSameInAMovingFrame) {
    const Vec4 speed{30, 4, -7, 2};
    const auto ends = [&](const Vec4& v) {
        std::mt19937_64 random(2);
        Chain chain = hung_chain(12, 0.5, Vec4(1, 0.5, 0.3, -0.4).normalized());
        for (std::size_t i = 1; i < chain.bodies.size(); ++i)
            chain.bodies.velocity[i] = random_vector(random, 8);
        for (Vec4& velocity : chain.bodies.velocity) velocity += v;
        Stepper world(make_simulation(chain.bodies, without_gravity(), chain.joints));
        run(world, 8);
        Vec4 end = world.bodies().position.back();
        end -= 8 * kStep * v;
        return end;
    };
    const Vec4 still = ends(Vec4::Zero()), moved = ends(speed);
    EXPECT_LT((still - moved).norm(), 1e-9);
}

}  // namespace
}  // namespace tesserae
