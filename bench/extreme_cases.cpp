// SPDX-License-Identifier: Apache-2.0
#include "bench/extreme_cases.hpp"

#include <algorithm>
#include <cmath>

#include "bench/resting_scenes.hpp"
#include "core/dynamics/diagnostics/energy.hpp"
#include "parallel/parallel_stepper.hpp"
#include "parallel/threads.hpp"

namespace tesserae::bench {
namespace {

using Measurements = std::vector<Measurement>;

/// What happens to bodies that should stay where they are put.
struct Stay {
    double overlap = 0;  ///< deepest of all steps [m]
    double moved = 0;    ///< of any centre, at the end [m]
    double fastest = 0;  ///< of all steps [m/s]
    double last = 0;     ///< fastest at the end [m/s]
};

template <class AnyWorld>
Stay watch(AnyWorld& world, double seconds, double steps_per_second) {
    const std::vector<Vec4> start = world.bodies().position;
    Stay stay;
    const long steps = std::lround(seconds * steps_per_second);
    for (long i = 0; i < steps; ++i) {
        stay.overlap = std::max(stay.overlap, world.step(1 / steps_per_second).penetration);
        stay.last = 0;
        for (const Vec4& v : world.bodies().velocity) stay.last = std::max(stay.last, v.norm());
        stay.fastest = std::max(stay.fastest, stay.last);
    }
    for (std::size_t i = 0; i < start.size(); ++i)
        stay.moved = std::max(stay.moved, (world.bodies().position[i] - start[i]).norm());
    return stay;
}

Measurements rows_of(const Stay& stay, double size) {
    return {{"deepest overlap", "of the least size", stay.overlap / size},
            {"moved at the end", "of the least size", stay.moved / size},
            {"fastest", "m/s", stay.fastest},
            {"fastest at the end", "m/s", stay.last}};
}

ExtremeCase staying(std::string name, Bodies bodies, double size, double seconds,
                    double steps_per_second = 240, double gravity = 10) {
    return {std::move(name), [=](PhysicsSettings settings) {
                settings.gravity = {0, -gravity, 0, 0};
                Stepper world(bodies, settings);
                return rows_of(watch(world, seconds, steps_per_second), size);
            }};
}

/// Turns a box freely and tells how well its energy is kept.
ExtremeCase spinning(std::string name, const Vec4& size, const Bivector& omega, double seconds) {
    return {std::move(name), [=](PhysicsSettings settings) -> Measurements {
                settings.gravity.setZero();
                Bodies bodies;
                add(bodies, box_type(size, 1), Vec4::Zero(), Vec4::Zero(), omega);
                Stepper world(bodies, settings);
                const double start = kinetic_energy(bodies);
                double worst = 0;
                for (long i = 0; i < std::lround(240 * seconds); ++i) {
                    world.step(1.0 / 240);
                    worst = std::max(worst, std::abs(kinetic_energy(world.bodies()) / start - 1));
                }
                return {{"largest change of energy", "relative", worst}};
            }};
}

/// Forty spheres in a closed box of eight planes, e = 1: a hundred thousand steps.
ExtremeCase bouncing() {
    return {"restitution 1, 10^5 steps", [](PhysicsSettings settings) -> Measurements {
                settings.gravity.setZero();
                Bodies bodies;
                add_walls(bodies, {0, 1, 2, 3}, 2, 0, 1);
                std::mt19937_64 engine(3);
                std::uniform_real_distribution<> along(-2, 2);
                for (int i = 0; i < 40; ++i) {
                    const int cell[] = {i % 3, i / 3 % 3, i / 9 % 3, i / 27 % 3};
                    Vec4 x, v;
                    for (int k = 0; k < 4; ++k) x[k] = 1.2 * (cell[k] - 1), v[k] = along(engine);
                    add(bodies, sphere_type(0.3, 1, 0, 1), x, v);
                }
                Stepper world(bodies, settings);
                const double start = kinetic_energy(bodies);
                double worst = 0;
                for (int i = 0; i < 100000; ++i) {
                    world.step(1.0 / 240);
                    worst = std::max(worst, std::abs(kinetic_energy(world.bodies()) / start - 1));
                }
                return {{"largest change of energy", "relative", worst}};
            }};
}

/// The last body hits the others. How fast it comes back, and how much energy there is at most.
/// @param towards   unit, the way it comes
ExtremeCase impact(std::string name, const Bodies& bodies, const Vec4& towards, bool falls) {
    return {std::move(name), [=](PhysicsSettings settings) -> Measurements {
                if (!falls) settings.gravity.setZero();
                Stepper world(bodies, settings);
                const auto energy = [&] {
                    const Bodies& now = world.bodies();
                    double sum = kinetic_energy(now);
                    for (BodyId id = 0; id < now.size(); ++id)
                        if (is_bounded(now.type_of(id).shape))
                            sum -= now.type_of(id).mass * settings.gravity.dot(now.position[id]);
                    return sum;
                };
                const double start = energy();
                double in = 0, back = 0, most = start;
                for (int i = 0; i < 480; ++i) {
                    world.step(1.0 / 240);
                    const double along = towards.dot(world.bodies().velocity.back());
                    in = std::max(in, along), back = std::max(back, -along);
                    most = std::max(most, energy());
                }
                return {{"comes back at", "of its speed", back / in},
                        {"largest gain of energy", "relative", most / start - 1}};
            }};
}

/// Balls of 1 kg in a row from x = 0 on, and one that comes at 10 m/s.
Bodies row_of_balls(int count, double mass, double restitution, bool wall) {
    Bodies bodies;
    if (wall) add(bodies, plane_type(-Vec4::UnitX(), 0.5 - count, 0, restitution), Vec4::Zero());
    for (int i = 0; i < count; ++i)
        add(bodies, sphere_type(0.5, 1, 0, restitution), {static_cast<double>(i), 0, 0, 0});
    add(bodies, sphere_type(0.5, mass, 0, restitution), {-4, 0, 0, 0}, {10, 0, 0, 0});
    return bodies;
}

/// The same of boxes with gaps between them.
Bodies row_of_boxes(int count, double mass, double gap) {
    Bodies bodies;
    add(bodies, plane_type(-Vec4::UnitX(), -(1 + gap) * count, 0, 0), Vec4::Zero());
    for (int i = 0; i < count; ++i)
        add(bodies, box_type(Vec4::Ones(), 1), {0.5 + (1 + gap) * i, 0, 0, 0});
    add(bodies, box_type(Vec4::Ones(), mass), {-4, 0, 0, 0}, {10, 0, 0, 0});
    return bodies;
}

/// A ball that falls 1 m onto five flush boxes of 1 kg.
Bodies ball_on_tower(double mass, double friction) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, friction, 0), Vec4::Zero());
    BodyType box = box_type({0.45, 0.5, 0.55, 0.4}, 1);
    box.friction = friction;
    for (int i = 0; i < 5; ++i) add(bodies, box, {0, 0.25 + 0.5 * i, 0, 0});
    add(bodies, sphere_type(0.25, mass, friction, 0), {0, 3.75, 0, 0});
    return bodies;
}

/// Restitution 0 but for the last three.
std::vector<ExtremeCase> impacts() {
    std::vector<ExtremeCase> cases;
    for (const double mass : {10.0, 100.0}) {
        Bodies boxes = tower({1, mass});
        boxes.position.back()[1] += 2;
        cases.push_back(impact(fmt::format("box of {:g} kg falls 2 m onto one of 1 kg", mass),
                               boxes, -Vec4::UnitY(), true));
    }
    for (const double mass : {20.0, 100.0, 1000.0})
        cases.push_back(impact(fmt::format("ball of {:g} kg hits six of 1 kg before a wall", mass),
                               row_of_balls(6, mass, 0, true), Vec4::UnitX(), false));
    cases.push_back(impact("box of 20 kg hits six of 1 kg, gaps of 3 mm, before a wall",
                           row_of_boxes(6, 20, 0.003), Vec4::UnitX(), false));
    for (const double friction : {0.9, 1.2})
        cases.push_back(
            impact(fmt::format("ball of 1000 kg falls 1 m onto five boxes of 1 kg, friction {:g}",
                               friction),
                   ball_on_tower(1000, friction), -Vec4::UnitY(), true));
    cases.push_back(impact("ball of 100 kg hits one of 1 kg before a wall, restitution 0.9",
                           row_of_balls(1, 100, 0.9, true), Vec4::UnitX(), false));
    cases.push_back(impact("ball hits four others, restitution 1", row_of_balls(4, 1, 1, false),
                           Vec4::UnitX(), false));
    Bodies tumbling;
    add(tumbling, plane_type(Vec4::UnitY(), 0, 0.5, 0.9), Vec4::Zero());
    BodyType box = box_type({1, 0.6, 0.8, 0.5}, 2);
    box.restitution = 0.9;
    add(tumbling, box, {0, 2, 0, 0}, {3, 0, 1, 0}, {8, -3, 2, 5, -4, 1});
    cases.push_back(impact("tumbling box, restitution 0.9", tumbling, -Vec4::UnitY(), true));
    return cases;
}

/// The last body's path for a second over boxes, and that over planes in their place.
ExtremeCase beside_planes(std::string name, Bodies boxes, Bodies planes) {
    return {std::move(name), [=](const PhysicsSettings& settings) -> Measurements {
                Stepper on_boxes(boxes, settings), on_planes(planes, settings);
                double path = 0, hop = 0;
                for (int i = 0; i < 240; ++i) {
                    on_boxes.step(1.0 / 240), on_planes.step(1.0 / 240);
                    Vec4 apart =
                        on_boxes.bodies().position.back() - on_planes.bodies().position.back();
                    hop = std::max(hop, std::abs(apart[1]));
                    apart[1] = 0;
                    path = std::max(path, apart.norm());
                }
                return {{"path differs by", "mm", 1e3 * path}, {"hops by", "mm", 1e3 * hop}};
            }};
}

/// A body of 0.3 m put down on tiles of 0.5 m, on its way at 3 m/s across them.
ExtremeCase seams(std::string name, BodyType body, double friction) {
    Bodies tiles, plane;
    add(plane, plane_type(Vec4::UnitY(), 0, friction), Vec4::Zero());
    BodyType tile = box_type(Vec4::Constant(0.5), 1);
    tile.fixed_position = tile.fixed_rotation = true;
    tile.friction = body.friction = friction;
    tiles.types.push_back(tile);
    for (int i = 0; i < 10 * 6 * 4; ++i)
        add(tiles, 0,
            {0.5 * (i % 10) - 0.3, -0.25, 0.5 * (i / 10 % 6) - 0.3, 0.5 * (i / 60) - 0.8});
    for (Bodies* bodies : {&tiles, &plane}) add(*bodies, body, {0, 0.15, 0, 0}, {2.6, 0, 1.4, 0.3});
    return beside_planes(std::move(name), tiles, plane);
}

/// A box of 0.3 m that slides down a ramp of 15 degrees, half a metre to the floor at its foot.
ExtremeCase ramp() {
    const double angle = 15 * pi / 180;
    const Vec4 out = {std::sin(angle), std::cos(angle), 0, 0};
    const Vec4 down = {std::cos(angle), -std::sin(angle), 0, 0};
    const Rotor leaning = exp(Bivector{0.5 * angle});
    Bodies boxes, planes;
    for (const Vec4& normal : {Vec4(Vec4::UnitY()), out})
        add(planes, plane_type(normal, 0, 0), Vec4::Zero());
    BodyType ground = box_type(Vec4::Constant(10), 1);
    ground.fixed_position = ground.fixed_rotation = true, ground.friction = 0;
    add(boxes, ground, {5, -5, 0, 0});
    add(boxes, ground, -5 * (down + out));
    boxes.rotor.back() = leaning;
    BodyType box = box_type(Vec4::Constant(0.3), 1);
    box.friction = 0;
    for (Bodies* bodies : {&boxes, &planes}) {
        add(*bodies, box, 0.15 * out - 0.65 * down);
        bodies->rotor.back() = leaning;
    }
    return beside_planes("box slides from a ramp onto a floor", boxes, planes);
}

/// Rods of 1 m by 2 mm that fall across each other, at 60 steps a second.
ExtremeCase rods() {
    return {"eight rods of 1 m by 2 mm poured", [](const PhysicsSettings& settings) {
                std::mt19937_64 engine(1);
                Bodies bodies = floor_and();
                for (int i = 0; i < 8; ++i) {
                    Vec4 size = Vec4::Constant(0.002);
                    size[i % 4] = 1;
                    const Vec4 a = random_vector(engine, 2), b = random_vector(engine, 2);
                    add(bodies, box_type(size, 1), {0.05 * (i % 3), 0.8 + 0.7 * i, 0, 0});
                    bodies.rotor.back() = exp(Bivector{a[0], a[1], a[2], b[0], b[1], b[2]});
                }
                Stepper world(bodies, settings);
                const auto energy = [&] {
                    return kinetic_energy(world.bodies()) +
                           potential_energy(world.bodies(), settings.gravity);
                };
                const double start = energy();
                double least = start, gain = 0;
                for (int k = 0; k < 180; ++k) {
                    world.step(1.0 / 60);
                    least = std::min(least, energy());
                    gain = std::max(gain, energy() - least);
                }
                return Measurements{{"largest gain of energy", "relative", gain / start}};
            }};
}

/// A body of 0.3 m thrown at a wall 500 times from any side, at 5 to 20 of its sizes a step,
/// turning: how many are beyond it after 12 steps, and the most energy that any wins.
ExtremeCase throws(std::string name, BodyType body, double thickness, double restitution) {
    body.restitution = restitution;
    return {
        std::move(name), [=](PhysicsSettings settings) -> Measurements {
            constexpr int kThrows = 500;
            settings.gravity.setZero();
            std::mt19937_64 engine(1);
            std::uniform_real_distribution<> part(-1, 1);
            const auto plane = [&](double most) {
                const Vec4 a = random_vector(engine, most), b = random_vector(engine, most);
                return Bivector{a[0], a[1], a[2], b[0], b[1], b[2]};
            };
            BodyType wall = box_type({thickness, 200, 200, 200}, 1);
            wall.fixed_position = wall.fixed_rotation = true;
            int lost = 0;
            double gain = 0;
            for (int i = 0; i < kThrows; ++i) {
                const double speed = 0.3 * 240 * (12.5 + 7.5 * part(engine));
                Bodies bodies;
                add(bodies, wall, Vec4::Zero());
                add(bodies, body, {-0.5 - 0.01 * speed * (1 + part(engine)), 0, 0, 0},
                    speed * (Vec4::UnitX() + random_vector(engine, 0.4)), plane(20));
                bodies.rotor.back() = exp(plane(2));
                Stepper world(bodies, settings);
                const double start = kinetic_energy(bodies);
                for (int k = 0; k < 12; ++k) {
                    world.step(1.0 / 240);
                    gain = std::max(gain, kinetic_energy(world.bodies()) / start - 1);
                }
                lost += world.bodies().position.back()[0] > 0;
            }
            return {{"lost", "of 500", 1.0 * lost}, {"largest gain of energy", "relative", gain}};
        }};
}

/// A ball 35 mm before a wall of 1 cm, struck by another at 0.8 diameters a step.
ExtremeCase struck_before_wall() {
    return {"ball struck 35 mm before a thin wall", [](PhysicsSettings settings) -> Measurements {
                settings.gravity.setZero();
                Bodies bodies;
                BodyType wall = box_type({0.01, 4, 4, 4}, 1);
                wall.fixed_position = wall.fixed_rotation = true;
                add(bodies, wall, Vec4::Zero());
                add(bodies, sphere_type(0.05, 1, 0, 1), {-0.09, 0, 0, 0});
                add(bodies, sphere_type(0.05, 10, 0, 1), {-0.3, 0, 0, 0}, {0.08 * 240, 0, 0, 0});
                Stepper world(bodies, settings);
                int lost = 0;
                for (int k = 0; k < 24; ++k) world.step(1.0 / 240);
                for (const BodyId id : {1, 2}) lost += world.bodies().position[id][0] > 0;
                return {{"lost", "of 2", 1.0 * lost}};
            }};
}

std::vector<ExtremeCase> all_throws() {
    BodyType rod;
    rod.shape = Hypercapsule{0.002, 0.3};
    rod.mass = 1, rod.friction = 0.5;
    const BodyType slab = box_type({0.3, 0.3, 0.03, 0.3}, 1);
    return {throws("slab thrown at a wall of 2 cm", slab, 0.02, 0),
            throws("slab thrown at a wall of 1 mm, restitution 1", slab, 0.001, 1),
            throws("ball thrown at a wall of 1 mm", sphere_type(0.15, 1, 0.5, 0), 0.001, 0.5),
            throws("rod thrown at a wall of 1 mm", rod, 0.001, 0.5), struck_before_wall()};
}

/// 10 x 10 x 10 x 10 spheres between walls, put down touching, 60 s.
ExtremeCase resting_spheres() {
    return {"10^4 spheres at rest for 60 s", [](PhysicsSettings settings) {
                Bodies bodies = floor_and();
                add_walls(bodies, {0, 2, 3}, 5, 0.5);
                bodies.types.push_back(sphere_type(0.5, 1, 0.5, 0));
                for (int i = 0; i < 10000; ++i)
                    add(bodies, static_cast<std::uint32_t>(bodies.types.size() - 1),
                        {i % 10 - 4.5, i / 1000 + 0.5, i / 10 % 10 - 4.5, i / 100 % 10 - 4.5});
                parallel::Threads threads(parallel::granted_cores());
                Measurements rows;
                threads.run([&] {
                    parallel::ParallelStepper world(bodies, settings);
                    rows = rows_of(watch(world, 60, 60), 1);
                });
                return rows;
            }};
}

std::vector<ExtremeCase> rotations() {
    return {spinning("box 1000:30:1:1 about a middle axis, 10 s", {1000, 30, 1, 1.1},
                     {0.01, 3, 0.001, 0.02, 0.001, 0.001}, 10),
            spinning("box at 1000 rad/s, 10 s", {1, 0.7, 0.4, 0.2}, {900, -300, 200, 100, -50, 20},
                     10)};
}

}  // namespace

std::vector<ExtremeCase> extreme_cases(bool with_long) {
    const std::vector<double> ten(10, 1000.0);
    std::vector<ExtremeCase> cases;
    for (const double ratio : {1e2, 1e3, 1e6}) {
        cases.push_back(staying(fmt::format("two boxes, the upper {:g} times heavier", ratio),
                                tower({1, ratio}), 1, 4));
        cases.push_back(staying(fmt::format("two boxes, the lower {:g} times heavier", ratio),
                                tower({ratio, 1}), 1, 4));
        cases.push_back(staying(
            fmt::format("two boxes, the upper {:g} times heavier, put down 1 mm above", ratio),
            tower({1, ratio}, Vec4::Zero(), 1e-3), 1, 4));
    }
    const std::vector<double> forty(40, 1000.0);
    cases.push_back(staying("tower of 20 boxes of 10 cm, 4 s", small_tower(20, 0.1), 0.1, 4));
    cases.push_back(staying("tower of 40 boxes, 10 s", tower(forty), 1, 10));
    cases.push_back(staying("tower of 40 boxes, gaps of 0.3 mm, 10 s",
                            tower(forty, Vec4::Zero(), 3e-4), 1, 10));
    cases.push_back(staying("pyramid of 55 boxes, 10 s", pyramid(10), 1, 10));
    cases.push_back(staying("ten boards of 2 x 0.1 x 0.5 x 0.5 m, 10 s", boards(), 0.1, 10));
    cases.push_back(staying("wall of 20 rows of 20 boxes, 10 s", wall(20, 20), 0.5, 10));
    cases.push_back(staying("pile of twelve logs between walls, 10 s", logs(), 0.6, 10));
    cases.push_back(staying("ruler of 3 mm across another, 4 s", rulers(), 0.003, 4));
    cases.push_back(staying("spheres of 1 mm to 1 km, 4 s", mixed_sizes(), 0.001, 4));
    for (const double rate : {30.0, 60.0, 120.0, 2000.0})
        cases.push_back(staying(fmt::format("tower of 10 boxes, steps of 1/{:g} s, 4 s", rate),
                                tower(ten), 1, 4, rate));
    cases.push_back(
        staying("tower of 10 boxes, gravity 10^4 m/s^2, 4 s", tower(ten), 1, 4, 240, 1e4));
    cases.push_back(staying("tower of 10 boxes, 10^5 m from the origin, 4 s",
                            tower(ten, {1e5, -1e5, 1e5, 1e5}), 1, 4));
    cases.push_back(staying("4 boxes deep in each other, 4 s", deep_boxes(), 1, 4));
    cases.push_back(staying("8 spheres deep in each other, 4 s", deep_spheres(), 1, 4));
    cases.push_back(staying("capsule 10^4 times as long as wide, 4 s", long_capsule(), 0.02, 4));
    for (ExtremeCase& rotation : rotations()) cases.push_back(std::move(rotation));
    for (ExtremeCase& hit : impacts()) cases.push_back(std::move(hit));
    cases.push_back(seams("box slides over seams", box_type({0.4, 0.3, 0.3, 0.3}, 1), 0));
    cases.push_back(
        seams("box slides over seams, friction 0.3", box_type({0.4, 0.3, 0.3, 0.3}, 1), 0.3));
    cases.push_back(seams("ball slides over seams", sphere_type(0.15, 1), 0));
    cases.push_back(ramp());
    cases.push_back(rods());
    for (ExtremeCase& thrown : all_throws()) cases.push_back(std::move(thrown));
    cases.push_back(bouncing());
    if (with_long) cases.push_back(resting_spheres());
    return cases;
}

}  // namespace tesserae::bench
