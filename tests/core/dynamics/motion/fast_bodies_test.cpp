// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/fast_bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/contacts/pairs.hpp"
#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/motion/free_path.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/step/step.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/motion/throws.hpp"
#include "tests/core/dynamics/observed_world.hpp"

// Nothing goes through anything, however fast, and no energy is won.
namespace tesserae {
namespace {

using namespace tesserae::testing;

constexpr int kStepsOfThrow = 12;
/// Sums of energies are rounded, and what gravity takes from bodies that are slow is neglected.
constexpr double kNoGain = 1e-9;
/// What parts bodies that have come to overlap does work on them.
constexpr double kGainOfOverlap = 1e-2;

/// Throws of each kind: TESSERAE_THROWS=10000 and more for a long run.
int throws(int usual) {
    const char* given = std::getenv("TESSERAE_THROWS");
    return given ? std::atoi(given) : usual;
}

/// The energy of all that moves over that at the start, as a part of the motion's.
class Gain {
  public:
    Gain(const Bodies& start, const Vec4& gravity)
        : gravity_(gravity), motion_(kinetic_energy(start)), start_(energy(start)) {}
    double of(const Bodies& bodies) const { return (energy(bodies) - start_) / motion_; }

  private:
    double energy(const Bodies& bodies) const {
        return kinetic_energy(bodies) + potential_energy(bodies, gravity_);
    }
    Vec4 gravity_;
    double motion_, start_;
};

/// The wall fills |n.x| <= thickness / 2, n its first axis; it is wider than any body flies.
bool is_beyond(const Bodies& bodies, double thickness) {
    const Vec4 normal = rotate(bodies.rotor[0], Vec4(Vec4::UnitX()));
    const double centre = normal.dot(bodies.position[1]);
    const double nearest = -farthest_along(bodies, 1, -normal);
    const bool beside = (bodies.position[1] - centre * normal).norm() > 95;
    return std::max(nearest, centre) > 0.5 * thickness && !beside;
}

TEST(Throw, AtAWallNeverPassesAndAddsNoEnergy) {
    int hits = 0;
    for (int kind = 0; kind < kThrownKinds; ++kind)
        for (int i = 0; i < throws(40); ++i) {
            std::mt19937_64 random(1000003ULL * kind + i);
            const Throw scene = throw_at_wall(random, kind, i % 2 == 1);
            Stepper world(scene.bodies, scene.settings);
            const Gain gain(scene.bodies, scene.settings.gravity);
            double allowed = kNoGain;
            for (int k = 0; k < kStepsOfThrow; ++k) {
                const StepReport report = world.step(scene.dt);
                hits += report.contacts > 0;
                if (report.penetration > 0) allowed = kGainOfOverlap;
                ASSERT_FALSE(is_beyond(world.bodies(), scene.thickness))
                    << "kind " << kind << ", throw " << i << ", step " << k;
                ASSERT_LT(gain.of(world.bodies()), allowed)
                    << "kind " << kind << ", throw " << i << ", step " << k;
            }
        }
    EXPECT_GT(hits, throws(40) * kThrownKinds / 3);
}

/// In these draws friction turns a slender body into what it hits: compression alone would add up
/// to 40 % of the energy.
TEST(Throw, ThatFrictionJamsAddsNoEnergy) {
    for (const int i : {915, 935, 1071, 1321, 2814, 4125, 4324, 5521, 5716})
        for (const std::uint32_t coloured_from : {1u, kNoneColoured}) {
            std::mt19937_64 random(1000003ULL * 6 + i);
            const Throw scene = throw_between_rough_walls(random);
            Stepper world(make_simulation(scene.bodies, scene.settings), coloured_from);
            const Gain gain(scene.bodies, scene.settings.gravity);
            double last = 0;
            for (int k = 0; k < 2 * kStepsOfThrow; ++k) {
                world.step(scene.dt);
                // In float velocities are rounded by 6e-8 of their change.
                EXPECT_LT(gain.of(world.bodies()), last + 1e-6) << i << ", step " << k;
                last = gain.of(world.bodies());
            }
        }
}

/// Of rods that whirl, by more than is left to the solver in a sub-step.
TEST(Throw, OfRodsThatWhirlAddsNoEnergyInColouredIslands) {
    for (const int i : {39, 137, 151, 217, 265}) {
        std::mt19937_64 random(1000003ULL * 4 + i);
        const Throw scene = throw_at_wall(random, 4, true);
        Stepper world(make_simulation(scene.bodies, scene.settings), 1);
        const Gain gain(scene.bodies, scene.settings.gravity);
        for (int k = 0; k < kStepsOfThrow; ++k) {
            const bool overlaps = world.step(scene.dt).penetration > 0;
            EXPECT_LT(gain.of(world.bodies()), overlaps ? kGainOfOverlap : 1e-6) << i;
        }
    }
}

/// The balls inscribed in both never meet deeply, nor do they change places within a step: one that
/// goes round the other leaves the line of their centres.
void expect_no_passing(const Throw& scene, const std::string& name) {
    Stepper world(scene.bodies, scene.settings);
    const Gain gain(scene.bodies, Vec4::Zero());
    const double touch = inscribed_radius(scene.bodies.type_of(0).shape) +
                         inscribed_radius(scene.bodies.type_of(1).shape);
    Vec4 line = scene.bodies.position[1] - scene.bodies.position[0];
    double allowed = kNoGain;
    for (int k = 0; k < kStepsOfThrow; ++k) {
        if (world.step(scene.dt).penetration > 0) allowed = kGainOfOverlap;
        const Vec4 now = world.bodies().position[1] - world.bodies().position[0];
        const Vec4 along = line.normalized();
        const double left = along.dot(now);
        ASSERT_FALSE(left < 0 && (now - left * along).norm() < 0.5 * touch) << name << ", " << k;
        ASSERT_GT(now.norm(), 0.4 * touch) << name << ", " << k;
        ASSERT_LT(gain.of(world.bodies()), allowed) << name << ", " << k;
        line = now;
    }
}

TEST(Throw, OfAnyTwoBodiesAtEachOtherNeverPassesAndAddsNoEnergy) {
    for (int a = 0; a < kThrownKinds; ++a)
        for (int b = 0; b < kThrownKinds; ++b)
            for (int i = 0; i < throws(4); ++i) {
                std::mt19937_64 random(1000003ULL * (a * kThrownKinds + b) + i);
                expect_no_passing(throw_at_each_other(random, a, b, i % 2 == 1, i / 2 % 2 == 1),
                                  fmt::format("kinds {} {}, throw {}", a, b, i));
            }
}

/// A ball that another makes fast after the contacts were found.
TEST(Throw, OfABallAtOneBeforeAThinWallDrivesNeitherThrough) {
    for (const bool substeps : {false, true})
        for (const double gap : {0.0, 0.001, 0.035, 0.1})
            for (const double speed : {0.8, 3.0, 20.0})
                for (const double restitution : {0.0, 0.5, 1.0}) {
                    Bodies bodies;
                    BodyType wall = box_type({0.002, 10, 10, 10});
                    wall.fixed_position = wall.fixed_rotation = true;
                    add(bodies, wall);
                    const BodyType ball = sphere_type(0.05, 1, 0, restitution);
                    BodyType heavy = ball;
                    heavy.mass = 10;
                    add(bodies, ball, {-0.051 - gap, 0, 0, 0});
                    add(bodies, ball, {-0.151 - gap, 0, 0, 0});
                    add(bodies, heavy, {-0.3 - gap, 0.001, 0, 0}, {0.1 * speed * 240, 0, 0, 0});
                    PhysicsSettings settings = substeps ? substepped_settings() : PhysicsSettings{};
                    settings.gravity.setZero();
                    Stepper world(bodies, settings);
                    const Gain gain(bodies, Vec4::Zero());
                    for (int i = 0; i < 24; ++i) {
                        world.step(kStep);
                        for (const BodyId id : {1, 2, 3})
                            ASSERT_LT(world.bodies().position[id][0], -0.001)
                                << gap << ' ' << speed << ' ' << restitution;
                        ASSERT_LT(gain.of(world.bodies()), kNoGain)
                            << gap << ' ' << speed << ' ' << restitution;
                    }
                }
}

/// A wall in which a ball would have room to sink out of sight, and come out of slowly.
TEST(Throw, OfABallFromNearAThickWallDoesNotSinkIn) {
    for (const bool substeps : {false, true})
        for (const double radius : {0.001, 0.02, 1.0})
            for (const double speed : {0.5, 2.0, 8.0}) {  // sizes a step
                BodyType wall = box_type({100 * radius, 1e3, 1e3, 1e3});
                wall.fixed_position = wall.fixed_rotation = true;
                Bodies bodies;
                add(bodies, wall, {50 * radius, 0, 0, 0});
                add(bodies, sphere_type(radius), {-1.5 * radius, 0, 0, 0},
                    {2 * radius * speed * 240, 0, 0, 0});
                PhysicsSettings settings = substeps ? substepped_settings() : PhysicsSettings{};
                settings.gravity.setZero();
                Stepper world(bodies, settings);
                for (int i = 0; i < 24; ++i)
                    ASSERT_LT(world.step(kStep).penetration, 1.01 * kDeepest * 2 * radius)
                        << radius << ' ' << speed;
            }
}

/// Five boxes that fly as one: what stops stands in the way of the next.
TEST(Throw, OfARowOfBoxesStopsAllOfThem) {
    for (const double sizes : {1.0, 5.0, 20.0}) {
        Bodies bodies;
        BodyType wall = box_type({0.001, 50, 50, 50});
        wall.fixed_position = wall.fixed_rotation = true;
        add(bodies, wall);
        for (int i = 0; i < 5; ++i)
            add(bodies, box_type(Vec4::Constant(0.1)), {-0.3 - 0.101 * i, 0, 0, 0},
                {0.1 * sizes * 240, 0, 0, 0});
        Stepper world(bodies, without_gravity());
        for (int i = 0; i < 24; ++i) {
            world.step(kStep);
            for (BodyId id = 1; id < 6; ++id) {
                const double x = world.bodies().position[id][0];
                EXPECT_LT(x, id == 1 ? 0 : world.bodies().position[id - 1][0]) << id << ' ' << i;
            }
        }
    }
}

TEST(Throw, OfAnElasticBallAtAFloorKeepsItsEnergy) {
    for (const double sizes : {0.7, 3.0, 10.0}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0, 1));
        add(bodies, sphere_type(0.1, 1, 0, 1), {0, 1, 0, 0},
            {3, -0.2 * sizes * 240, 0.1 * sizes * 240, 0});
        add(bodies, plane_type(-Vec4::UnitY(), -4, 0, 1));
        Stepper world(bodies, PhysicsSettings{});
        const Gain gain(bodies, {0, -10, 0, 0});
        for (int i = 0; i < 240; ++i) {
            world.step(kStep);
            ASSERT_NEAR(gain.of(world.bodies()), 0, 1e-12) << sizes << ' ' << i;
        }
    }
}

/// What touches and is fast, but does not come deeper, is not held up: the path is x = v t.
TEST(Throw, AlongAFloorIsNotStopped) {
    for (const bool substeps : {false, true})
        for (const bool tiles : {false, true}) {
            Bodies bodies;
            BodyType floor = box_type({2000, 1, 20, 20});
            floor.fixed_position = floor.fixed_rotation = true;
            if (tiles)
                add(bodies, floor, {0, -0.5, 0, 0});
            else
                add(bodies, plane_type(Vec4::UnitY(), 0));
            BodyType box = box_type(Vec4::Constant(0.2));
            box.friction = floor.friction = 0;
            bodies.types[0].friction = 0;
            const double speed = 0.2 * 10 * 240;
            add(bodies, box, {-500, 0.1, 0, 0}, {speed, 0, 0, 0}, {0, 0, 0, 0, 0, 300});
            Stepper world(bodies, substeps ? substepped_settings() : PhysicsSettings{});
            for (int i = 1; i <= 240; ++i) {
                world.step(kStep);
                ASSERT_NEAR(world.bodies().position[1][0], -500 + speed * i * kStep, 1e-6) << i;
                ASSERT_NEAR(norm(world.bodies().angular_velocity[1]), 300, 1e-3) << i;
            }
        }
}

/// A step's first half, with the paths of two bodies in it.
struct HalfStep {
    HalfStep(const Bodies& bodies, const PhysicsSettings& settings, double dt)
        : simulation(make_simulation(bodies, settings)) {
        begin_step(simulation, step, dt);
        advance_first_half(simulation, step, {0, bodies.size()});
    }
    FreePath path(BodyId id) const { return {simulation, step, id}; }

    Simulation simulation;
    StepData step;
};

double separation_at(const HalfStep& half, double time) {
    const FreePath a = half.path(0), b = half.path(1);
    const FreePath::State p = a.at(time), q = b.at(time);
    std::vector<Contact> list;
    find_contacts(0, a.shape(), {p.position, p.rotor}, 1, b.shape(), {q.position, q.rotor}, 1e3,
                  list);
    double least = 1e3;
    for (const Contact& contact : list) least = std::min(least, contact.separation);
    return least;
}

/// |x + v t| = r + s, and how deep they would get.
TEST(ImpactTime, OfSpheresIsThatOfTheClosedForm) {
    std::mt19937_64 random(5);
    int stopped = 0, passed = 0;
    ImpactSearch scratch;
    for (int i = 0; i < 3000; ++i) {
        const double r = spread(random, 0.01, 1), s = spread(random, 0.01, 1), sum = r + s;
        const double both = 2 * std::min(r, s);
        const Vec4 x = (sum * uniform_in(random, 1.01, 4)) * random_vector(random, 1).normalized();
        const double h = 0.01;
        const Vec4 v = (-x + random_vector(random, sum)) * (uniform_in(random, 0.2, 5) / h);
        Bodies bodies;
        add(bodies, sphere_type(r), Vec4::Zero(), 3 * v);
        add(bodies, sphere_type(s), x, 4 * v);
        const HalfStep half(bodies, without_gravity(), 2 * h);
        const double t = impact_time(half.path(0), half.path(1), 0, scratch);
        const double a = v.squaredNorm(), b = x.dot(v), c = x.squaredNorm() - sum * sum;
        const double nearest = std::clamp(-b / a, 0.0, h);
        const double depth = sum - (x + nearest * v).norm();
        if (t == kNoImpact) {
            ++passed;
            EXPECT_LT(depth, kDeepest * both) << i;
            continue;
        }
        ++stopped;
        // Stopped a little before the limit is surely reached, and less than kTouch before they
        // touch.
        EXPECT_GT(depth, (kDeepest - 2 * kTouch) * both) << i;
        const double touches = (-b - std::sqrt(b * b - a * c)) / a;
        EXPECT_LE(t, touches * (1 + 1e-12)) << i;
        EXPECT_LE((x + t * v).norm() - sum, 1.001 * kTouch * both) << i;
    }
    EXPECT_GT(stopped, 500);
    EXPECT_GT(passed, 500);
}

/// Against the separation at 150 times of the half, of bodies that turn by up to two radians in it.
TEST(ImpactTime, OfTurningBodiesIsThatOfFineSampling) {
    std::mt19937_64 random(6);
    int stopped = 0, passed = 0;
    ImpactSearch scratch;
    for (int i = 0; i < 200; ++i) {
        Bodies bodies;
        const double h = 0.01;
        const BodyType type_a = thrown_type(random, static_cast<int>(random() % 6), 0, 0);
        const BodyType type_b = thrown_type(random, static_cast<int>(random() % 6), 0, 0);
        const double radii = bounding_radius(type_a.shape) + bounding_radius(type_b.shape);
        const Vec4 x =
            (radii * uniform_in(random, 0.5, 1.5)) * random_vector(random, 1).normalized();
        const Vec4 v = (random_vector(random, 0.5 * radii) - uniform_in(random, 0, 2) * x) / h;
        add(bodies, type_a, Vec4::Zero(), Vec4::Zero(), random_plane(random, 1 / h),
            exp(random_plane(random, 2)));
        add(bodies, type_b, x, v, random_plane(random, 1 / h), exp(random_plane(random, 2)));
        const HalfStep half(bodies, without_gravity(), 2 * h);
        const double sum = inscribed_radius(type_a.shape) + inscribed_radius(type_b.shape);
        if (separation_at(half, 0) < kTouch * sum) continue;
        const double t = impact_time(half.path(0), half.path(1), 0, scratch);
        const double slack = 0.002 * sum;  // the contact functions': see kCellBias
        double deepest = 0;
        for (int k = 0; k <= 150; ++k) {
            const double separation = separation_at(half, h * k / 150);
            deepest = std::max(deepest, -separation);
            if (h * k / 150 < t) {
                EXPECT_GT(separation, -kDeepest * sum - slack) << i << ' ' << k;
            }
        }
        ++(t == kNoImpact ? passed : stopped);
        if (t == kNoImpact) continue;
        const double separation = separation_at(half, t);
        EXPECT_LT(separation, kTouch * sum + slack) << i;
        EXPECT_GT(separation, -slack) << i;
    }
    EXPECT_GT(stopped, 25);
    EXPECT_GT(passed, 25);
}

/// Boxes, capsules and balls on a lattice, side by side.
Bodies fast_heap(int side, double speed, double spin) {
    std::mt19937_64 random(7);
    Bodies bodies;
    const BodyType types[] = {box_type({0.5, 0.4, 0.45, 0.5}), capsule_type(0.1, 0.2),
                              sphere_type(0.25)};
    for (int i = 0; i < side * side * side * side; ++i) {
        const Vec4 place(i % side, i / side % side, i / side / side % side, i / side / side / side);
        const Bivector turn = random_plane(random, 1);
        add(bodies, types[i % 3], 0.75 * (place - Vec4::Constant(0.5 * (side - 1))),
            speed * random_vector(random, 1).normalized(), (spin / norm(turn)) * turn);
    }
    return bodies;
}

/// A search that had to be sure would take millions, as each may have to be made again wherever a
/// body has been stopped.
TEST(FastBodies, FindFewGapsHoweverFastABodyOrAWholeHeap) {
    for (const double speed : {1.0, 1e3, 1e5, 1e7, 1e9, 1e12})
        for (const double spin : {0.0, 1e3, 1e5, 1e8, 1e10})
            for (const bool all : {false, true}) {
                Bodies bodies = fast_heap(4, all ? speed : 0, all ? spin : 0);
                if (!all) {
                    bodies.velocity[0] = speed * Vec4::Ones();
                    bodies.angular_velocity[0].xy = bodies.angular_velocity[0].zw = spin;
                }
                HalfStep half(bodies, without_gravity(), kStep);
                update_bounds(half.simulation, half.step, {0, bodies.size()});
                test_all_pairs(half.simulation, half.step);
                Schedule schedule;
                FastBodies fast_bodies;
                fast_bodies.stop(half.simulation, half.step, schedule, FastBodies::Half::kFirst);
                EXPECT_LT(fast_bodies.gaps(), 150 * bodies.size()) << speed << ' ' << spin;
            }
}

/// In a room of walls of 0.5 m, from 1 mm to 1 m large.
void expect_heap_stays_in_its_room(std::initializer_list<double> speeds) {
    for (const double speed : speeds)
        for (const double spin : {0.0, 1e4, 1e8, 1e10}) {
            Bodies bodies = fast_heap(2, speed, spin);
            const auto count = static_cast<BodyId>(bodies.size());
            add(bodies, sphere_type(5e-4), {0, 0, 0, 0.4}, Vec4(speed, 0, speed, 0));
            add(bodies, box_type(Vec4::Constant(1e-3)), {0, 0, 0.1, 0.4}, Vec4(0, speed, 0, 0),
                {spin, 0, spin, 0, 0, 0});
            for (int axis = 0; axis < 4; ++axis)
                for (const double side : {-1.5, 1.5}) {
                    Vec4 sides = Vec4::Constant(4);
                    sides[axis] = 0.5;
                    BodyType wall = box_type(sides);
                    wall.fixed_position = wall.fixed_rotation = true;
                    add(bodies, wall, side * Vec4::Unit(axis));
                }
            Stepper world(bodies, without_gravity());
            for (int i = 0; i < 24; ++i) {
                world.step(kStep);
                for (BodyId id = 0; id < count + 2; ++id)
                    ASSERT_LT(world.bodies().position[id].cwiseAbs().maxCoeff(), 1.25)
                        << speed << ' ' << spin << ", step " << i << ", body " << id;
            }
        }
}

TEST(Throw, OfAHeapInARoomStaysInItHoweverFast) { expect_heap_stays_in_its_room({1e3, 1e12}); }
TEST(ThrowSlow, OfAHeapInARoomStaysInItHoweverFast) { expect_heap_stays_in_its_room({1e6, 1e9}); }

}  // namespace
}  // namespace tesserae
