// SPDX-License-Identifier: Apache-2.0
// Scenes as programs use them: names, worlds, simulating, and what is told on the way.
#include "scenes/scene_file.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "core/error.hpp"
#include "parallel/world_threads.hpp"
#include "scenes/trajectory_file.hpp"
#include "tests/content.hpp"
#include "tests/error_of.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae {
namespace {

using testing::error_of;

constexpr const char* kHeap = R"(
physics = { duration = 0.5, sleeping = true }
camera = { position = [0, 3, -8, 0], look_at = [0, 1, 0, 0] }
render = { size = [48, 32], samples = 2, frames_per_second = 20, tile = 16 }
material = [{ name = "red", albedo = [0.9, 0.1, 0.1], albedo_variation = 0.5 }]
light = [{ type = "sun", direction = [0.3, -1, 0.4, 0.1] }]

[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 1, 0, 0]
[[body]]
name = "crate"
shape = "hyperbox"
size = [1, 0.6, 0.8, 0.7]
position = [0.1, 2.5, 0, 0]
angular_velocity = { xy = 1, zw = -2 }
material = "red"
[[body]]
name = "weight"
shape = "hypersphere"
radius = 0.3
position = [1.2, 2.5, 0, 0]

[[joint]]
name = "rod"
type = "distance"
a = "crate"
b = "weight"

[[lattice]]
name = "heap"
shape = "hypersphere"
radius = 0.3
count = [3, 2, 2, 1]
spacing = 0.62
position = [0, 0.7, 0, 0]
)";

Scene heap(std::vector<std::string> sets = {}) { return Scene::parse(kHeap, sets, "heap.toml"); }

/// Whether two lists hold the same bits, but for the sign of zeros.
template <class T>
bool equal(std::span<const T> a, std::span<const T> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

bool same_state(const BodyArrays& a, const BodyArrays& b) {
    return equal(a.position, b.position) && equal(a.rotor, b.rotor) &&
           equal(a.velocity, b.velocity) && equal(a.angular_velocity, b.angular_velocity);
}

TEST(SceneOfTheLibrary, TellsWhatItsFileSays) {
    const Scene scene = heap({"render.size=[64,32]", "physics.duration=1.5"});
    EXPECT_EQ(scene.name(), "heap");
    EXPECT_EQ(scene.width(), 64);
    EXPECT_EQ(scene.height(), 32);
    EXPECT_EQ(scene.frames(), 30);
    EXPECT_EQ(scene.frames_per_second(), 20);
    EXPECT_EQ(scene.time_of_frame(7), 0.35);
    EXPECT_EQ(scene.physics()->duration, 1.5);
    EXPECT_EQ(scene.bodies(), 15u);
    EXPECT_EQ(scene.joints(), 1u);
    EXPECT_TRUE(scene.unused_keys().empty());
    EXPECT_EQ(heap({"camera.focus_distance=3"}).unused_keys().size(), 1u);

    // The effective text is the scene, and camera and light are no part of the motion.
    EXPECT_EQ(Scene::parse(scene.text()).hash(), scene.hash());
    const Scene other = heap({"render.size=[64,32]", "physics.duration=1.5", "camera.shutter=0.5"});
    EXPECT_NE(other.hash(), scene.hash());
    EXPECT_EQ(other.motion_hash(), scene.motion_hash());
    EXPECT_NE(heap({"body.crate.mass=7"}).motion_hash(), scene.motion_hash());

    const testing::TemporaryFolder folder("scene");
    EXPECT_EQ(error_of<InputError>([&] { Scene::read(folder / "none.toml"); }).find("none.toml") ==
                  std::string::npos,
              false);
    EXPECT_EQ(error_of<InputError>([&] { scene.time_of_frame(30); }),
              "heap.toml: frame 30: the scene has frames 0 to 29");
}

TEST(SceneOfTheLibrary, FindsBodiesAndJointsByTheirNames) {
    const Scene scene = heap();
    EXPECT_EQ(scene.body("crate"), 1u);
    EXPECT_EQ(scene.name_of(1), "crate");
    EXPECT_EQ(scene.name_of(14), "heap");
    EXPECT_EQ(scene.joint("rod"), 0u);
    EXPECT_EQ(scene.bodies_of("weight"), std::vector<BodyId>{2});
    const std::vector<BodyId> lattice = scene.bodies_of("heap");
    ASSERT_EQ(lattice.size(), 12u);
    EXPECT_EQ(lattice.front(), 3u);
    EXPECT_EQ(lattice.back(), 14u);

    EXPECT_EQ(error_of<InputError>([&] { scene.body("crat"); }),
              "heap.toml: body \"crat\": the scene has none of this name; did you mean \"crate\"?");
    EXPECT_EQ(error_of<InputError>([&] { scene.body("heap"); }),
              "heap.toml: body \"heap\": is a lattice of 12 bodies");
    EXPECT_EQ(error_of<InputError>([&] { scene.name_of(15); }),
              "heap.toml: body 15: the scene has 15 bodies");
    EXPECT_EQ(error_of<InputError>([&] { scene.joint("rope"); }),
              "heap.toml: joint \"rope\": the scene has none of this name");
}

TEST(SceneOfTheLibrary, HasAWorldThatMovesAsTheTrajectoryTells) {
    const testing::TemporaryFolder folder("world");
    const Scene scene = heap();
    const SimulationResult made = scene.simulate(folder / "heap.h5", {.threads = 2});
    EXPECT_EQ(made.last_step, 108u);  // frame 9 at 0.45 s
    const Trajectory trajectory(folder / "heap.h5");
    ASSERT_EQ(trajectory.size(), made.stored);

    for (const int count : {0, 1, 3}) {
        World world = scene.world(count > 0 ? threads(count) : nullptr);
        ASSERT_EQ(world.size(), scene.bodies());
        ASSERT_EQ(world.joint_ids().size(), 1u);
        std::uint64_t step = 0;
        for (std::size_t i = 0; i < trajectory.size(); ++i) {
            for (; step < trajectory.steps()[i]; ++step) world.step();
            EXPECT_TRUE(same_state(world.arrays(), trajectory.state(i)))
                << count << " threads, step " << step;
        }
    }
    // A still has a world, too.
    EXPECT_EQ(Scene::parse("[[body]]\nshape = \"hypersphere\"\nradius = 1\n").world().size(), 1u);
}

TEST(SceneOfTheLibrary, SimulatesOnAfterItWasStopped) {
    const testing::TemporaryFolder folder("stop");
    const Scene scene = heap();
    const auto straight = folder / "straight.h5", parts = folder / "parts.h5";
    std::vector<std::uint64_t> told;
    scene.simulate(straight, {.threads = 1, .progress = [&](auto done, auto total) {
                                  told.push_back(done);
                                  return total == 108;
                              }});
    ASSERT_EQ(told.size(), 108u);
    EXPECT_EQ(told.back(), 108u);

    // By the answer of who is told, and by a flag that another thread may set.
    EXPECT_THROW(scene.simulate(parts, {.progress = [](auto done, auto) { return done < 30; }}),
                 Stopped);
    std::atomic<bool> stop{false};
    EXPECT_THROW(scene.simulate(parts, {.progress =
                                            [&](auto done, auto) {
                                                stop = done == 70;
                                                return true;
                                            },
                                        .stop = &stop}),
                 Stopped);
    EXPECT_FALSE(std::filesystem::exists(parts));
    const SimulationResult rest = scene.simulate(parts);
    EXPECT_EQ(rest.first_step, 60u);  // stored last before step 70
    EXPECT_FALSE(rest.kept);
    const Trajectory a(straight), b(parts);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(same_state(a.state(i), b.state(i)));

    EXPECT_TRUE(scene.simulate(parts).kept);
    EXPECT_NE(error_of<InputError>([&] { heap({"body.crate.mass=7"}).simulate(parts); }), "");
    EXPECT_FALSE(heap({"body.crate.mass=7"}).simulate(parts, {.overwrite = true}).kept);
    EXPECT_EQ(scene.simulate(folder / "all.h5", {.store_every = 4}).stored, 31u);
}

}  // namespace
}  // namespace tesserae
