// SPDX-License-Identifier: Apache-2.0
// The gallery's scenes show what they say they show.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/stepper.hpp"
#include "scenes/load/load.hpp"
#include "scenes/plan/plan.hpp"

namespace tesserae::scenes {
namespace {

TEST(Gallery, EverySceneLoadsAndSaysWhatItNeeds) {
    int count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(TESSERAE_SOURCE_DIR "/scenes/gallery")) {
        if (entry.path().extension() != ".toml") continue;
        const Scene scene = load_scene(entry.path(), {});
        EXPECT_EQ(scene.name, entry.path().stem());
        EXPECT_GT(make_plan(scene, 1).view_rays, 0u);
        ++count;
    }
    EXPECT_GE(count, 8);
}

using Kinds = std::set<std::string>;

/// How often bodies of two kinds of shapes overlap or touch, and the deepest overlap [m].
struct Meetings {
    std::map<Kinds, int> count;
    double deepest = 0;

    void add(const Bodies& bodies) {
        std::vector<Contact> contacts;
        for (BodyId a = 0; a < bodies.size(); ++a)
            for (BodyId b = a + 1; b < bodies.size(); ++b) {
                if (!bodies.is_movable(a) && !bodies.is_movable(b)) continue;
                contacts.clear();
                const Shape &s = bodies.type_of(a).shape, &t = bodies.type_of(b).shape;
                find_contacts(a, s, {bodies.position[a], bodies.rotor[a]}, b, t,
                              {bodies.position[b], bodies.rotor[b]}, 0, contacts);
                if (contacts.empty()) continue;
                ++count[{name_of(s), name_of(t)}];
                for (const Contact& c : contacts) deepest = std::max(deepest, -c.separation);
            }
    }
};

TEST(Gallery, ShapesMeetInAllNinePairsAndNothingPassesThrough) {
    const Scene scene = load_scene(TESSERAE_SOURCE_DIR "/scenes/gallery/shapes.toml", {});
    Stepper world(scene.bodies, *scene.physics);
    Meetings meetings;
    for (int step = 0; step < 720; ++step) {
        world.step(1 / scene.physics->steps_per_second);
        if (step % 5 == 0) meetings.add(world.bodies());
    }
    EXPECT_EQ(meetings.count.size(), 9u);
    for (const auto& [kinds, count] : meetings.count)
        EXPECT_GE(count, 2) << *kinds.begin() << " and " << *kinds.rbegin();
    // A body that passes through another is half its size inside it on the way; the least half size
    // here is a capsule's radius, 0.18 m.
    EXPECT_LT(meetings.deepest, 0.09);
}

TEST(Gallery, TheDrumsMixerStirsAndIsNotHeldUp) {
    const Scene scene = load_scene(TESSERAE_SOURCE_DIR "/scenes/gallery/drum.toml", {});
    Stepper world(scene.bodies, *scene.physics);
    const auto of_mixer = [&](BodyId id) { return !world.bodies().is_movable(id); };
    // From 0.8 s on the heap lies around the mixer; it would be at rest without.
    std::uint64_t touched = 0;
    for (int step = 0; step < 240; ++step) {
        world.step(1 / scene.physics->steps_per_second);
        if (step < 192) continue;
        for (const KeptImpulse& impulse : world.memory().impulses)
            touched += of_mixer(impulse.a) && is_bounded(world.bodies().type_of(impulse.a).shape);
    }
    EXPECT_GT(touched, 48u);
    int turning = 0;
    for (BodyId id = 0; id < scene.bodies.size(); ++id) {
        if (!of_mixer(id)) continue;
        EXPECT_EQ(world.bodies().angular_velocity[id], scene.bodies.angular_velocity[id]);
        EXPECT_EQ(world.bodies().position[id], scene.bodies.position[id]);
        turning += scene.bodies.angular_velocity[id].xz != 0;
    }
    EXPECT_EQ(turning, 2);
}

}  // namespace
}  // namespace tesserae::scenes
