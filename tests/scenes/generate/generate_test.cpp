// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generate.hpp"

#include <gtest/gtest.h>

#include "core/dynamics/diagnostics/joint_state.hpp"
#include "core/dynamics/stepper.hpp"
#include "core/error.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

std::uint64_t movable_bodies(const Scene& scene) {
    std::uint64_t count = 0;
    for (BodyId id = 0; id < scene.bodies.size(); ++id) count += scene.bodies.is_movable(id);
    return count;
}

TEST(Generate, HasExactlyTheBodiesAskedForAndNoneStartsInAnother) {
    for (const std::string_view name : kGenerators)
        for (const std::uint64_t bodies : {1, 2, 10, 17, 256, 1003}) {
            SCOPED_TRACE(std::string(name) + " " + std::to_string(bodies));
            const Scene scene = load_text(generated_scene(name, bodies));
            EXPECT_EQ(movable_bodies(scene), bodies);
            Stepper world(make_simulation(scene.bodies, *scene.physics, scene.joints));
            // Half a step of falling moves them by rounding only.
            EXPECT_LT(world.step(1e-6).penetration, 1e-9);
        }
}

TEST(Generate, PyramidAndStacksStandAndAGasMoves) {
    const auto moved = [](const std::string& text) {
        const Scene scene = load_text(text);
        Stepper world(make_simulation(scene.bodies, *scene.physics, scene.joints));
        for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
        double farthest = 0;
        for (BodyId id = 0; id < scene.bodies.size(); ++id)
            farthest = std::max(farthest,
                                (world.bodies().position[id] - scene.bodies.position[id]).norm());
        return farthest;
    };
    // They sink by the overlap that the solver leaves, 5 mm a contact of boxes of 1 m, and no more.
    EXPECT_LT(moved(generated_scene("pyramid", 36)), 8 * 0.005);
    EXPECT_LT(moved(generated_scene("stacks", 40)), 10 * 0.005);
    EXPECT_GT(moved(generated_scene("gas", 40)), 1);
}

/// What is joined stays joined, to each other and to the world: what is not falls 20 m.
TEST(Generate, WhatIsJoinedStaysJoined) {
    for (const char* name : {"chain", "grid", "bridge"}) {
        const Scene scene = load_text(generated_scene(name, 50));
        Stepper world(make_simulation(scene.bodies, *scene.physics, scene.joints));
        for (int i = 0; i < 480; ++i) world.step(1.0 / 240);
        double farthest = 0;
        for (const Joint& joint : scene.joints)
            farthest = std::max(farthest, state_of(joint, world.bodies(), {}).error);
        EXPECT_LT(farthest, 2e-3) << name;
    }
}

TEST(Generate, RefusesMoreJointsThanAFileCanHave) {
    EXPECT_THROW(generated_scene("grid", 80001), InputError);
    const Scene scene = load_text(generated_scene("grid", 10000));
    EXPECT_EQ(scene.joints.size(), 2 * 100 * 99 + 100u);  // neighbours, and those that it hangs on
    EXPECT_EQ(load_text(scene.effective).effective, scene.effective);
}

TEST(Generate, SaysHowItWasMade) {
    EXPECT_EQ(generated_scene("pile", 12).substr(0, 33), "# tesserae generate pile --bodies");
}

}  // namespace
}  // namespace tesserae::scenes
