// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/properties/properties.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "core/dynamics/constants.hpp"
#include "core/error.hpp"
#include "tests/core/shape/oracle.hpp"

namespace tesserae::scenes::properties {
namespace {

/// Large islands are solved in float, which loses squares below 1e-38. So speeds of bodies that
/// rest to rounding, below this part of the scene's, may depend on the scale.
constexpr double kNothing = 0x1p-54;

/// Where states first differ in a bit, or nothing.
/// @param sizes   of what is expected
std::string bit_difference(const Bodies& expected, const Bodies& found, int step,
                           const Sizes& sizes) {
    std::string fault;
    const auto compare = [&](BodyId id, const char* what, const double* a, const double* b,
                             int count, double size) {
        const auto same = [&](double x, double y) {
            return x == y || std::max(std::abs(x), std::abs(y)) < kNothing * size;
        };
        if (!fault.empty() || std::equal(a, a + count, b, same)) return;
        fault = fmt::format("step {}, body {}: {}", step, id, what);
        for (int i = 0; i < count; ++i) fault += fmt::format(" {}", b[i]);
        fault += ", expected";
        for (int i = 0; i < count; ++i) fault += fmt::format(" {}", a[i]);
    };
    for (BodyId id = 0; id < expected.size(); ++id) {
        const double radius = bounding_radius(expected.type_of(id).shape);
        compare(id, "position", expected.position[id].data(), found.position[id].data(), 4,
                sizes.length);
        compare(id, "velocity", expected.velocity[id].data(), found.velocity[id].data(), 4,
                sizes.speed);
        compare(id, "rotor", &expected.rotor[id].s, &found.rotor[id].s, 8, 1);
        compare(id, "angular velocity", &expected.angular_velocity[id].xy,
                &found.angular_velocity[id].xy, 6, sizes.speed / radius);
    }
    return fault;
}

/// Takes both on, step by step.
/// @param expect   from the first's bodies what the second's should be
std::string compare_bits(Motion& here, Motion& there, int steps, const Sizes& sizes,
                         const std::function<Bodies(const Bodies&)>& expect) {
    for (int i = 1; i <= steps; ++i) {
        here.step();
        there.step();
        std::string fault = bit_difference(expect(here.bodies()), there.bodies(), i, sizes);
        if (!fault.empty()) return fault;
    }
    return {};
}

/// What a step rounds most: points of contacts and large islands' impulses are kept in float.
constexpr double kRounding = 0x1p-24;

/// Overlap up to which the separation of bodies has one direction and is as exact as while they are
/// apart, as a part of the least half-size.
constexpr double kGentleOverlap = 4 * kSlop;

/// The largest of a few differences by rounding may be so much less than another one.
constexpr double kSpread = 10;

/// Scenes that are rounded otherwise: of every scene, and of one that seems to have a fault.
constexpr int kFewOthers = 4, kManyOthers = 100;

/// By so much scenes have parted that what follows is chance.
constexpr double kChaos = 1e-3;

/// Of all bodies [m].
double least_half_size(const Motion& motion) {
    double least = std::numeric_limits<double>::infinity();
    for (const TypeProperties& type : motion.world().simulation().types)
        least = std::min(least, type.slop / kSlop);
    return least;
}

/// Other rounding in all that a step computes: every number is moved by up to that of the sizes.
Change rounding(std::uint64_t seed, const Sizes& sizes) {
    return [random = RandomGeometry(seed), sizes](Bodies& bodies, int) mutable {
        const auto vector = [&](double most) { return random.in_box(Vec4::Constant(most)); };
        for (BodyId id = 0; id < bodies.size(); ++id) {
            const double radius = bounding_radius(bodies.type_of(id).shape);
            if (!std::isfinite(radius)) continue;
            const auto bivector = [&](double most) {
                const Vec4 a = vector(most), b = vector(most);
                return Bivector{a[0], a[1], a[2], a[3], b[0], b[1]};
            };
            bodies.position[id] += vector(kRounding * sizes.length);
            bodies.velocity[id] += vector(kRounding * sizes.speed);
            bodies.rotor[id] = exp(bivector(kRounding)) * bodies.rotor[id];
            bodies.angular_velocity[id] += bivector(kRounding * sizes.speed / radius);
        }
    };
}

}  // namespace

std::string fault_of_scaling(const SmallScene& scene, const Scaling& by, const Change& defect) {
    const Start start = start_of(scene);
    const Start other = scaled(start, by);
    Motion here(start, defect), there(other, defect);
    return compare_bits(here, there, scene.steps, sizes_of(other), [&](Bodies bodies) {
        scale_motion(bodies, by);
        return bodies;
    });
}

std::string fault_of_parting(const SmallScene& scene, const Change& defect) {
    const Start start = start_of(scene);
    Motion whole(start, defect), parted(start, defect);
    for (int i = 0; i < scene.steps; ++i) {
        whole.step();
        parted.step();
        const std::string fault = bit_difference(whole.bodies(), parted.bodies(), i, {});
        if (!fault.empty()) return fault;
        if (i % 3 == 0) parted.start_anew();
    }
    return {};
}

std::string fault_of_numbering(const SmallScene& scene, const Change& defect) {
    RandomGeometry random(scene.seed);
    const auto given = static_cast<BodyId>(scene.tables.size());
    BodyId like = static_cast<BodyId>(random.uniform(0, given));
    while (like < given && !is_bounded(scene.tables[like].shape)) ++like;
    const auto place = static_cast<std::ptrdiff_t>(random.uniform(0, given));
    const Start start = start_of(scene);
    Start other = start;
    Bodies& bodies = other.bodies;
    const auto count = static_cast<BodyId>(bodies.size());
    // The types in the opposite order.
    std::reverse(bodies.types.begin(), bodies.types.end());
    for (std::uint32_t& type : bodies.type) type = count - 1 - type;
    const bool more = like < given;
    if (more) {
        const Vec4 far = 1e6 * sizes_of(start_of(scene)).length * random.direction();
        bodies.type.insert(bodies.type.begin() + place, bodies.type[like]);
        bodies.position.insert(bodies.position.begin() + place, far);
        bodies.rotor.insert(bodies.rotor.begin() + place, bodies.rotor[like]);
        bodies.velocity.insert(bodies.velocity.begin() + place, bodies.velocity[like]);
        bodies.angular_velocity.insert(bodies.angular_velocity.begin() + place,
                                       bodies.angular_velocity[like]);
    }
    Motion here(start, defect), there(other, defect);
    for (int i = 1; i <= scene.steps; ++i) {
        here.step();
        there.step();
        Bodies left = there.bodies();
        if (more) {
            left.type.erase(left.type.begin() + place);
            left.position.erase(left.position.begin() + place);
            left.rotor.erase(left.rotor.begin() + place);
            left.velocity.erase(left.velocity.begin() + place);
            left.angular_velocity.erase(left.angular_velocity.begin() + place);
        }
        std::string fault = bit_difference(here.bodies(), left, i, {});
        if (!fault.empty()) return fault;
    }
    return {};
}

View turned_view(const SmallScene& scene) {
    const Start start = start_of(scene);
    RandomGeometry random(scene.seed + 1);
    const Vec4 a = random.direction(), b = random.direction();
    const Rotor turn = exp({3 * a[0], 3 * a[1], 3 * a[2], 3 * a[3], 3 * b[0], 3 * b[1]});
    const Vec4 shift = sizes_of(start).length * random.direction();
    return {moved(start, turn, shift), [=](Bodies& bodies) { move_bodies(bodies, turn, shift); }};
}

View mirrored_view(const SmallScene& scene) { return {mirrored(start_of(scene)), mirror_motion}; }

bool is_gentle(const Motion& motion) {
    const Simulation& simulation = motion.world().simulation();
    const double least = least_half_size(motion);
    for (BodyId id = 0; id < simulation.bodies.size(); ++id) {
        const TypeProperties& type = simulation.type_of(id);
        if (!type.bounded) continue;
        const double speed = simulation.bodies.velocity[id].norm() +
                             type.radius * norm(simulation.bodies.angular_velocity[id]);
        if (motion.time_step() * speed > kDeepest * least) return false;
    }
    return motion.report().penetration < kGentleOverlap * least;
}

Agreement agreement_of(const SmallScene& scene, const View& view, const Change& defect,
                       const std::function<bool(const Agreement&)>& ends, int others_count) {
    const Start start = start_of(scene);
    const Sizes sizes = sizes_of(start);
    Motion here(start, defect), there(view.start, defect);
    std::vector<Motion> others;
    for (int i = 0; i < others_count; ++i) {
        Change also = rounding(scene.seed + i, sizes);
        Start rounded = start;
        also(rounded.bodies, 0);  // else nothing would be known of the first step
        others.emplace_back(rounded, [&, also](Bodies& bodies, int step) {
            if (defect) defect(bodies, step);
            also(bodies, step);
        });
    }
    Agreement agreement;
    for (int i = 1; i <= scene.steps && is_gentle(here); ++i) {
        here.step();
        there.step();
        if (!is_gentle(here)) break;
        agreement.step = i;
        for (Motion& other : others) {
            other.step();
            agreement.rounding =
                std::max(agreement.rounding, difference(here.bodies(), other.bodies(), sizes));
        }
        Bodies seen = here.bodies();
        view.see(seen);
        agreement.apart = difference(seen, there.bodies(), sizes);
        if (ends(agreement)) break;
    }
    return agreement;
}

namespace {

SmallScene off_axes(SmallScene scene) {
    RandomGeometry random(scene.seed + 2);
    for (BodyTable& table : scene.tables) {
        if (!is_bounded(table.shape)) continue;
        const Vec4 a = random.in_box(Vec4::Ones()), b = random.in_box(Vec4::Ones());
        table.rotation.front() += {a[0], a[1], a[2], a[3], b[0], b[1]};
    }
    return scene;
}

std::string fault_of_view(const SmallScene& scene, const View& view, const Change& defect) {
    std::string fault;
    const auto look = [&](const Agreement& a) {
        fault.clear();
        if (a.apart > kSpread * a.rounding)
            fault = fmt::format("step {}: {} apart, by rounding {}", a.step, a.apart, a.rounding);
        return !fault.empty() || a.rounding > kChaos;
    };
    // Rounding may take one of two ways, and the few may all take the other one.
    for (const int others : {kFewOthers, kManyOthers}) {
        agreement_of(scene, view, defect, look, others);
        if (fault.empty()) break;
    }
    return fault;
}

}  // namespace

std::string fault_of_turning(const SmallScene& scene, const Change& defect) {
    const SmallScene off = off_axes(scene);
    return fault_of_view(off, turned_view(off), defect);
}

std::string fault_of_mirroring(const SmallScene& scene, const Change& defect) {
    const SmallScene off = off_axes(scene);
    return fault_of_view(off, mirrored_view(off), defect);
}

std::string fault_of_slowing(const SmallScene& scene, const Change& defect) {
    SmallScene without = scene;
    without.physics.sleeping = false;
    for (BodyTable& table : without.tables)
        table.type.restitution = std::max(0.1, table.type.restitution);
    const Scaling by{0, scene.seed % 2 == 0 ? 1 : -1, 0};
    const Start start = start_of(without);
    const Start slowed = scaled(start, by);
    Motion here(start, defect), there(slowed, defect);
    const double sub_step = std::min(here.time_step(), there.time_step()) / start.physics.substeps;
    const double most = least_half_size(here) * sub_step * kFastestCorrection / (2 * kBiasPart);
    for (int i = 1; i <= scene.steps; ++i) {
        here.step();
        there.step();
        if (here.report().penetration > most) return {};
        Bodies expected = here.bodies();
        scale_motion(expected, by);
        std::string fault = bit_difference(expected, there.bodies(), i, sizes_of(slowed));
        if (!fault.empty()) return fault;
    }
    return {};
}

}  // namespace tesserae::scenes::properties
