// SPDX-License-Identifier: Apache-2.0
// Extreme scenes that others publish as hard, with joints, in four dimensions.
#include <algorithm>
#include <cmath>

#include "bench/extreme_cases.hpp"
#include "bench/peers/jointed.hpp"
#include "bench/resting_scenes.hpp"
#include "core/dynamics/diagnostics/energy.hpp"

namespace tesserae::bench {
namespace {

using Measurements = std::vector<Measurement>;

/// What loses less potential energy than this hangs still [J].
constexpr double kLeastFall = 1;

struct Jointed {
    Bodies bodies;
    std::vector<Joint> joints = {};
};

/// Joins two bodies by a point of the world.
void join(Jointed& scene, BodyId a, BodyId b, const Vec4& anchor) {
    Joint joint;
    joint.a = a, joint.b = b;
    joint.kind = PointJoint{anchor - scene.bodies.position[a], anchor - scene.bodies.position[b]};
    scene.joints.push_back(joint);
}

BodyType held(BodyType type) {
    type.fixed_position = type.fixed_rotation = true;
    return type;
}

/// What joints do in some seconds, and what they do to the energy.
struct Watched {
    double error = 0;  ///< farthest that two anchors were apart [m]
    double gain = 0;   ///< most energy, from that at first [J]
    double end = 0;    ///< energy at the end, from that at first [J]
    double fall = 0;   ///< largest loss of potential energy [J]
};

double largest_error(const Stepper& world) {
    const Bodies& bodies = world.bodies();
    double largest = 0;
    for (const Joint& joint : world.simulation().joints.all) {
        const auto& at = std::get<PointJoint>(joint.kind);
        const Vec4 a = bodies.position[joint.a] + rotate(bodies.rotor[joint.a], at.on_a);
        const Vec4 b = bodies.position[joint.b] + rotate(bodies.rotor[joint.b], at.on_b);
        largest = std::max(largest, (a - b).norm());
    }
    return largest;
}

Watched watch_joints(Stepper& world, double seconds) {
    const auto potential = [&] {
        return potential_energy(world.bodies(), world.simulation().settings.gravity);
    };
    const auto energy = [&] { return kinetic_energy(world.bodies()) + potential(); };
    const double start = energy(), top = potential();
    Watched watched;
    for (long i = 0; i < std::lround(240 * seconds); ++i) {
        world.step(1.0 / 240);
        watched.error = std::max(watched.error, largest_error(world));
        watched.end = energy() - start;
        watched.gain = std::max(watched.gain, watched.end);
        watched.fall = std::max(watched.fall, top - potential());
    }
    return watched;
}

/// What happens to joints that fall, swing and whip.
ExtremeCase swinging(std::string name, const Jointed& scene, double seconds) {
    return {std::move(name), [=](const PhysicsSettings& settings) -> Measurements {
                Stepper world(make_simulation(scene.bodies, settings, scene.joints));
                const Watched watched = watch_joints(world, seconds);
                Measurements rows = {{"largest error of a joint", "mm", 1e3 * watched.error}};
                if (watched.fall < kLeastFall) return rows;
                rows.push_back(
                    {"largest gain of energy", "of the fall's", watched.gain / watched.fall});
                rows.push_back(
                    {"energy gained at the end", "of the fall's", watched.end / watched.fall});
                return rows;
            }};
}

/// The balls of a net or a rope, which Bullet has too: see peers/jointed.hpp.
Jointed balls_of(const JointedScene& scene) {
    Jointed made;
    for (std::size_t i = 0; i < scene.mass.size(); ++i) {
        const BodyType type = sphere_type(scene.radius, std::max(scene.mass[i], 1.0));
        add(made.bodies, scene.mass[i] > 0 ? type : held(type), scene.position[i]);
    }
    for (const JointedScene::Link& link : scene.links)
        join(made, static_cast<BodyId>(link.a), static_cast<BodyId>(link.b), link.anchor);
    return made;
}

/// The same turned about the origin, x toward -y [rad].
Jointed leaning(Jointed scene, double angle) {
    const Rotor turn = exp(Bivector{0.5 * angle});
    for (Vec4& position : scene.bodies.position) position = rotate(turn, position);
    for (Joint& joint : scene.joints) {
        auto& at = std::get<PointJoint>(joint.kind);
        at.on_a = rotate(turn, at.on_a), at.on_b = rotate(turn, at.on_b);
    }
    return scene;
}

/// Cards of 1 by 0.02 by 0.6 by 0.6 m lean on each other in tents of 70 degrees, with a level card
/// across each two tents; so many tents stand at the ground.
Bodies card_house(int storeys) {
    constexpr double kLength = 1, kThick = 0.02, kSide = 0.6, kApart = 1.05;
    const double slope = 70 * pi / 180;
    // The lowest corner of a leaning card touches the ground, its highest the other card's.
    const double height = kLength * std::sin(slope) + kThick * std::cos(slope);
    const double aside = 0.5 * (kLength * std::cos(slope) + kThick * std::sin(slope));
    BodyType card = box_type({kLength, kThick, kSide, kSide}, 0.1);
    card.friction = 1;
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 1, 0), Vec4::Zero());
    for (int storey = 0; storey < storeys; ++storey) {
        const int tents = storeys - storey;
        const double foot = storey * (height + kThick);
        for (int i = 0; i < tents; ++i) {
            const double middle = kApart * (i - 0.5 * (tents - 1));
            for (const double side : {-1.0, 1.0})
                add(bodies, card, {middle + side * aside, foot + 0.5 * height, 0, 0}, Vec4::Zero(),
                    {}, exp(Bivector{-0.5 * side * (pi - slope)}));
        }
        // A level card lies from the top of one tent to that of the next, and the outer ones
        // beyond: both cards of every tent bear the same.
        for (int i = 0; i + 1 < tents; ++i) {
            const double low = kApart * (i - 0.5 * (tents - 1)) + (i == 0 ? -0.1 : 0.005);
            const double high =
                kApart * (i + 1 - 0.5 * (tents - 1)) + (i + 2 == tents ? 0.1 : -0.005);
            BodyType level = card;
            level.shape = Hyperbox{{high - low, kThick, kSide, kSide}};
            add(bodies, level, {0.5 * (low + high), foot + height + 0.5 * kThick, 0, 0});
        }
    }
    return bodies;
}

/// A half circle of wedges of equal angles, 2 m within and 2.5 m without, 1 m deep along z and w,
/// whose first and last ones are held.
Bodies arch(int wedges) {
    constexpr double kInner = 2, kOuter = 2.5, kHalf = 0.5;
    const double angle = pi / wedges;
    Polychoron wedge;
    wedge.regular = RegularPolychoron::kNone;
    Vec4 centre = Vec4::Zero();
    for (const double radius : {kInner, kOuter})
        for (const double turn : {-0.5, 0.5})
            for (const double z : {-kHalf, kHalf})
                for (const double w : {-kHalf, kHalf})
                    wedge.vertices.emplace_back(radius * std::cos(turn * angle),
                                                radius * std::sin(turn * angle), z, w);
    complete(wedge);
    // The centre of mass of the ring's part between two chords, where the hull puts its origin.
    const auto chord = [&](double radius) { return radius * std::cos(0.5 * angle); };
    const double in = chord(kInner), out = chord(kOuter);
    centre[0] = 2.0 / 3 * (out * out * out - in * in * in) / (out * out - in * in);
    BodyType type;
    type.shape = wedge;
    type.mass = 100;
    type.friction = 0.7;
    Bodies bodies;
    for (int i = 0; i < wedges; ++i) {
        const Rotor turn = exp(Bivector{-0.5 * (i + 0.5) * angle});
        add(bodies, i == 0 || i + 1 == wedges ? held(type) : type, rotate(turn, centre),
            Vec4::Zero(), {}, turn);
    }
    return bodies;
}

ExtremeCase standing(std::string name, const Bodies& bodies, double size, double seconds) {
    return {std::move(name), [=](const PhysicsSettings& settings) -> Measurements {
                Stepper world(bodies, settings);
                double overlap = 0, moved = 0, fastest = 0;
                for (long i = 0; i < std::lround(240 * seconds); ++i) {
                    overlap = std::max(overlap, world.step(1.0 / 240).penetration);
                    fastest = 0;
                    for (const Vec4& v : world.bodies().velocity)
                        fastest = std::max(fastest, v.norm());
                }
                for (BodyId id = 0; id < bodies.size(); ++id)
                    moved =
                        std::max(moved, (world.bodies().position[id] - bodies.position[id]).norm());
                return {{"deepest overlap", "of the least size", overlap / size},
                        {"moved at the end", "of the least size", moved / size},
                        {"fastest at the end", "m/s", fastest}};
            }};
}

/// A ball of 0.5 m at the end of a chain of ten rods swings into a wall of 10 rows of 10 boxes.
/// @param mass   of the ball; a rod weighs 1 kg, a box 10 kg
ExtremeCase wrecking_ball(double mass) {
    return {fmt::format("wrecking ball of {:g} kg on ten rods of 1 kg hits a wall, 4 s", mass),
            [=](const PhysicsSettings& settings) -> Measurements {
                Jointed scene;
                scene.bodies = floor_and();
                for (int row = 0; row < 10; ++row)
                    for (int i = 0; i < 10; ++i)
                        add(scene.bodies, box_type({0.5, 0.5, 0.5, 0.5}, 10),
                            {0, 0.25 + 0.5 * row, 0.51 * (i - 4.5) + (row % 2) * 0.125, 0});
                const std::size_t boxes = scene.bodies.size();
                // Level at first, along -x.
                const Vec4 top(-0.85, 7, 0, 0);
                BodyId last = add(scene.bodies, held(sphere_type(0.05)), top);
                Vec4 end = top;
                BodyType rod = testing::capsule_type(0.05, 1);
                rod.shape = Hypercapsule{0.05, 0.4};
                const Rotor level = exp(Bivector{0.25 * pi});
                for (int i = 0; i < 10; ++i) {
                    const Vec4 middle = end - Vec4(0.25, 0, 0, 0);
                    const BodyId id = add(scene.bodies, rod, middle, Vec4::Zero(), {}, level);
                    Joint joint;
                    joint.a = last, joint.b = id;
                    const auto on = [&](BodyId body) -> Vec4 {
                        return rotate(reverse(scene.bodies.rotor[body]),
                                      Vec4(end - scene.bodies.position[body]));
                    };
                    joint.kind = PointJoint{on(last), on(id)};
                    scene.joints.push_back(joint);
                    end -= Vec4(0.5, 0, 0, 0), last = id;
                }
                const BodyId ball =
                    add(scene.bodies, sphere_type(0.5, mass, 0.5), end - Vec4(0.5, 0, 0, 0));
                Joint joint;
                joint.a = last, joint.b = ball;
                joint.kind =
                    PointJoint{rotate(reverse(level), Vec4(end - scene.bodies.position[last])),
                               end - scene.bodies.position[ball]};
                scene.joints.push_back(joint);

                Stepper world(make_simulation(scene.bodies, settings, scene.joints));
                const Watched watched = watch_joints(world, 4);
                int left = 0;
                for (std::size_t id = 1; id < boxes; ++id)
                    left += (world.bodies().position[id] - scene.bodies.position[id]).norm() > 0.25;
                return {{"largest error of a joint", "mm", 1e3 * watched.error},
                        {"largest gain of energy", "of the fall's", watched.gain / watched.fall},
                        {"boxes moved by half a side", "of 100", 1.0 * left}};
            }};
}

}  // namespace

std::vector<ExtremeCase> extreme_joints() {
    const JointedScene heavy = rope(50, 1800, 0);
    std::vector<ExtremeCase> cases;
    for (const int storeys : {2, 5})
        cases.push_back(standing(fmt::format("card house of {} storeys, 10 s", storeys),
                                 card_house(storeys), 0.02, 10));
    cases.push_back(standing("arch of 15 wedges, 10 s", arch(15), 0.3, 10));
    cases.push_back(swinging("rope of 50 links under 1800 times a link, hung straight, 4 s",
                             leaning(balls_of(heavy), 0.5 * pi), 4));
    cases.push_back(
        swinging("rope of 50 links under 1800 times a link, let go 60 degrees aside, 4 s",
                 leaning(balls_of(heavy), pi / 6), 4));
    cases.push_back(swinging("rope of 50 links under 1800 times a link, let go level, 4 s",
                             balls_of(heavy), 4));
    cases.push_back(
        swinging("chain of 20 links let go level whips, 4 s", balls_of(rope(20, 1, 0)), 4));
    cases.push_back(swinging("net of 20 x 20 balls let go level, 4 s", balls_of(net(20, 0)), 4));
    for (const double mass : {100.0, 1000.0}) cases.push_back(wrecking_ball(mass));
    return cases;
}

}  // namespace tesserae::bench
