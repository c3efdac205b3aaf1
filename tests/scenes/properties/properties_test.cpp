// SPDX-License-Identifier: Apache-2.0
// Properties that hold for every scene, of random ones. Where one does not, the smallest scene that
// still shows it is printed as a scene file.
#include "tests/scenes/properties/properties.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <variant>

#include "core/dynamics/step/step.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

using properties::Change;
using properties::Scaling;
using properties::SmallScene;
using Property = std::function<std::string(const SmallScene&, const Change& defect)>;

/// Of a scene; a body that leaves the finite range ends what can be said of it.
std::string fault_of(const Property& property, const SmallScene& scene, const Change& defect) {
    try {
        return property(scene, defect);
    } catch (const LeftFiniteRange&) {
        return {};
    }
}

/// How many scenes from this seed on have the property.
struct Scenes {
    std::uint64_t first, count;
};
constexpr Scenes kFew = {1, 5}, kMany = {1000, 2000};

/// @param open   seeds of scenes that are known to have a fault whose cause is not known yet
void expect_of_all(const Property& property, Scenes scenes,
                   const std::set<std::uint64_t>& open = {}) {
    int faults = 0;
    for (std::uint64_t seed = scenes.first; seed < scenes.first + scenes.count; ++seed) {
        const SmallScene scene = properties::draw_small_scene(seed);
        if (open.contains(seed) || fault_of(property, scene, {}).empty()) continue;
        if (++faults > 3) continue;  // three are enough to read
        const SmallScene least = properties::shrunk(scene, [&](const SmallScene& smaller) {
            return !fault_of(property, smaller, {}).empty();
        });
        ADD_FAILURE() << "seed " << seed << ": " << fault_of(property, scene, {})
                      << "\nin the least scene: " << fault_of(property, least, {}) << "\n"
                      << properties::text_of(least);
    }
    EXPECT_EQ(faults, 0) << "of " << scenes.count;
}

Property scaling(int lengths, int times, int masses) {
    return [=](const SmallScene& scene, const Change& defect) {
        // Another power of two for every scene.
        const int power = static_cast<int>(scene.seed % 13) - 6;
        return properties::fault_of_scaling(
            scene, Scaling{lengths * power, times * power, masses * power}, defect);
    };
}
const Property kLengths = scaling(1, 0, 0);
/// By powers of four: the square roots of masses are what some of the solver works with.
const Property kMasses = scaling(0, 0, 2);

TEST(SmallScenes, AreReadFromTheirTextsBitForBit) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        const SmallScene drawn = properties::draw_small_scene(seed);
        const Scene read = load_text(properties::text_of(drawn));
        const Bodies bodies = properties::bodies_of(drawn);
        EXPECT_TRUE(tesserae::testing::same_bits(read.bodies, bodies)) << "seed " << seed;
        for (BodyId id = 0; id < bodies.size(); ++id)
            EXPECT_TRUE(read.bodies.type_of(id) == bodies.type_of(id)) << "seed " << seed;
    }
}

TEST(SmallScenes, HaveAllShapesAndMostlyContacts) {
    std::set<std::string> shapes;
    int touching = 0;
    constexpr int kScenes = 100;
    for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
        const SmallScene scene = properties::draw_small_scene(seed);
        for (const BodyTable& table : scene.tables) shapes.insert(name_of(table.shape));
        properties::Motion motion(properties::start_of(scene));
        bool touches = false;
        for (int i = 0; i < scene.steps; ++i)
            motion.step(), touches |= motion.report().contacts > 0;
        touching += touches;
    }
    EXPECT_EQ(shapes.size(), std::variant_size_v<Shape>);
    EXPECT_GT(touching, kScenes * 3 / 4);
}

TEST(SmallScenes, ShrinkToWhatAFaultNeeds) {
    SmallScene scene;
    for (scene = properties::draw_small_scene(1); scene.tables.size() < 6;)
        scene = properties::draw_small_scene(scene.seed + 1);
    const SmallScene least = properties::shrunk(scene, [](const SmallScene& s) {
        return std::count_if(s.tables.begin(), s.tables.end(),
                             [](const BodyTable& table) { return is_bounded(table.shape); }) >= 2;
    });
    EXPECT_EQ(least.tables.size(), 2u);
    EXPECT_EQ(least.steps, 1);
    for (const BodyTable& table : least.tables) {
        EXPECT_EQ(table.velocity, Vec4::Zero());
        EXPECT_TRUE(std::holds_alternative<Hypersphere>(table.shape));
    }
}

TEST(Properties, HoldOfAFewScenes) {
    expect_of_all(kLengths, kFew);
    expect_of_all(kMasses, kFew);
    expect_of_all(properties::fault_of_slowing, kFew);
    expect_of_all(properties::fault_of_parting, kFew);
    expect_of_all(properties::fault_of_numbering, kFew);
    expect_of_all(properties::fault_of_momentum, kFew);
    expect_of_all(properties::fault_of_turning, kFew);
    expect_of_all(properties::fault_of_mirroring, kFew);
}

/// Scenes that did not have them: bodies far off decided which contacts others had, and impulses
/// were not those that had moved the bodies.
TEST(Properties, HoldWhereTheyWereOnceFoundNotTo) {
    for (const std::uint64_t seed : {1077, 2276, 2817})
        expect_of_all(properties::fault_of_momentum, {seed, 1});
    for (const std::uint64_t seed : {1271, 3144, 6309, 8058})
        expect_of_all(properties::fault_of_numbering, {seed, 1});
}

TEST(LengthsSlow, ScaleBitForBit) { expect_of_all(kLengths, kMany); }
TEST(MassesSlow, ScaleBitForBit) { expect_of_all(kMasses, kMany); }
TEST(TimesSlow, ScaleBitForBit) { expect_of_all(properties::fault_of_slowing, kMany); }
TEST(PartingSlow, ChangesNoBit) { expect_of_all(properties::fault_of_parting, kMany); }
TEST(NumberingSlow, ChangesNoBit) { expect_of_all(properties::fault_of_numbering, kMany); }
/// Of the 6000 scenes after these, 3113, 4698, 6699 and 7469 are off, by 5e-6 to 7e-6: conjugate
/// directions carry on what float has rounded.
TEST(MomentumSlow, ComesFromGravityAndWhatIsHeld) {
    expect_of_all(properties::fault_of_momentum, kMany);
}
/// One does not converge in its sweeps, and parts by 4e-6 m/s where its residual is 3e-4 m/s: the
/// masses of friction are kept to eight bits, in frames that depend on the axes.
TEST(TurningSlow, ChangesNothing) { expect_of_all(properties::fault_of_turning, kMany, {2548}); }
/// Two allow one sweep, whose result is that of the order of a pair's contacts; a mirror changes
/// it.
TEST(MirroringSlow, ChangesNothing) {
    expect_of_all(properties::fault_of_mirroring, kMany, {1644, 2751});
}

/// Some of the first scenes has a fault where the motion has a defect of a part in 10^3, or in
/// bits.
void expect_seen(const char* name, const Property& property, const Change& defect) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
        if (!fault_of(property, properties::draw_small_scene(seed), defect).empty()) return;
    ADD_FAILURE() << name << ": no fault was seen";
}

/// Changes the velocity of every bounded body that may be changed.
Change of_velocities(const std::function<void(Bodies&, BodyId)>& change) {
    return [=](Bodies& bodies, int) {
        for (BodyId id = 0; id < bodies.size(); ++id)
            if (bodies.is_movable(id)) change(bodies, id);
    };
}

TEST(Properties, SeeDefects) {
    // A length, time or mass of its own.
    expect_seen("a length", kLengths,
                of_velocities([](Bodies& b, BodyId i) { b.velocity[i][0] += 1e-12; }));
    expect_seen("a mass", kMasses, of_velocities([](Bodies& b, BodyId i) {
                    b.velocity[i] *= 1 - 1e-12 / (1 + b.type_of(i).mass);
                }));
    expect_seen("a time", properties::fault_of_slowing,
                of_velocities([](Bodies& b, BodyId i) { b.velocity[i][0] += 1e-15; }));
    // What is not in the memory.
    int steps = 0;
    expect_seen(
        "what is not in the memory", properties::fault_of_parting,
        of_velocities([&](Bodies& b, BodyId i) { b.velocity[i] *= 1 - 1e-15 * (++steps % 7); }));
    // What depends on a body's number.
    expect_seen("a number", properties::fault_of_numbering, of_velocities([](Bodies& b, BodyId i) {
                    if (i % 2 == 0) b.velocity[i] *= 1 - 1e-15;
                }));
    // A momentum from nowhere, linear and angular.
    expect_seen("a momentum", properties::fault_of_momentum,
                of_velocities([](Bodies& b, BodyId i) { b.velocity[i] *= 1 - 1e-6; }));
    expect_seen("an angular momentum", properties::fault_of_momentum,
                of_velocities([](Bodies& b, BodyId i) {
                    b.angular_velocity[i] = (1 - 1e-6) * b.angular_velocity[i];
                }));
    // A direction of its own.
    expect_seen("a direction", properties::fault_of_turning,
                of_velocities([](Bodies& b, BodyId i) { b.velocity[i][0] *= 1 - 1e-3; }));
    expect_seen("a side", properties::fault_of_mirroring, of_velocities([](Bodies& b, BodyId i) {
                    b.angular_velocity[i].xy *= b.angular_velocity[i].xy > 0 ? 1 - 1e-3 : 1;
                }));
}

}  // namespace
}  // namespace tesserae::scenes
