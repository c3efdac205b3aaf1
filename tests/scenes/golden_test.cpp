// SPDX-License-Identifier: Apache-2.0
// Hashes of where the gallery's and generated scenes are after some steps, and of what their frames
// and trajectories hold: the same from g++ and clang++, on Debian 12 and 13, that is, with other
// compilers, mathematical libraries, Embrees and HDF5s. One that moves is a change of results: to
// be wanted, reviewed, and named in the commit's message, which raises kMotionVersion or
// kPictureVersion.
#include <gtest/gtest.h>

#include "core/dynamics/islands/islands.hpp"
#include "parallel/parallel_stepper.hpp"
#include "parallel/threads.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/load/hash.hpp"
#include "tests/scenes/load/load_scene_text.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes {
namespace {

/// The hashes are those of optimized builds for the default architecture. One for any x86-64 and
/// without optimization was measured to end with other bits where bodies turn, and takes minutes.
class Golden : public ::testing::Test {
    void SetUp() override {
#if !defined(__AVX2__) || !defined(__OPTIMIZE__)
        GTEST_SKIP() << "not an optimized build for x86-64-v3";
#endif
    }
};

template <class T>
std::string bytes_of(const std::vector<T>& list) {
    return {reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T)};
}

/// A hash of all positions and rotors after so many steps, and the contacts that push then.
struct End {
    std::string hash;
    std::size_t contacts;
};

End end_of(const Scene& scene, int steps) {
    parallel::ParallelStepper world(make_simulation(scene.bodies, *scene.physics, scene.joints));
    parallel::Threads(2).run([&] {
        for (int i = 0; i < steps; ++i) world.step(1 / scene.physics->steps_per_second);
    });
    return {hex_hash(bytes_of(world.bodies().position) + bytes_of(world.bodies().rotor)),
            world.memory().impulses.size()};
}

End end_of_gallery(const std::string& name, int steps) {
    return end_of(load_scene(TESSERAE_SOURCE_DIR "/scenes/gallery/" + name, {}), steps);
}

End end_of_generated(const std::string& name, std::uint64_t bodies, int steps,
                     const std::vector<std::string>& sets = {}) {
    return end_of(load_text(generated_scene(name, bodies), sets), steps);
}

TEST_F(Golden, GalleryScenesMoveAsEver) {
    EXPECT_EQ(end_of_gallery("first.toml", 240).hash, "b64585168d7ec4ee0714cb323518fa06");
    EXPECT_EQ(end_of_gallery("shapes.toml", 240).hash, "7575217478c3dca886f2ad89fba5f371");
    EXPECT_EQ(end_of_gallery("drum.toml", 120).hash, "cc194cff078c0c019e2bcb4870c81b19");
    EXPECT_EQ(end_of_gallery("race.toml", 240).hash, "a61e46f9e07dadeed9445794a35cdd46");
}

TEST_F(Golden, GeneratedScenesMoveAsEver) {
    const std::vector<std::string> substeps = {"physics.substeps=4", "physics.iterations=2",
                                               "physics.sleeping=true"};
    EXPECT_EQ(end_of_generated("boxes", 300, 180).hash, "c019f40536107ad2ae084908507b9409");
    EXPECT_EQ(end_of_generated("boxes", 300, 180, substeps).hash,
              "86172b84acee981a4c3381ae525cc696");
    EXPECT_EQ(end_of_generated("gas", 500, 240).hash, "b0fa8a5f6a16859201377f9004af4580");
}

/// One island each, with so many contacts that it is coloured and solved in float.
TEST_F(Golden, LargeIslandsMoveAsEver) {
    const auto expect = [](const char* name, std::uint64_t bodies, int steps,
                           const std::vector<std::string>& sets, const std::string& hash) {
        const End end = end_of_generated(name, bodies, steps, sets);
        EXPECT_GT(end.contacts, kColouredFrom) << name;
        EXPECT_EQ(end.hash, hash) << name;
    };
    const std::vector<std::string> substeps = {"physics.substeps=4", "physics.iterations=2"};
    expect("pile", 1000, 200, {}, "ee775b89dfb918f29a2e94fcca82ef37");
    expect("pile", 1000, 200, substeps, "f9a37d10e4ba6ace34cc8ece3d242191");
    expect("pyramid", 200, 60, {}, "95d492b161a274b5cdbc81a494db73bc");
    expect("pyramid", 200, 60, substeps, "2d9be4d0c445c68bd2633dd68057d5d1");
}

/// Joints as a block, in double and in colours.
TEST_F(Golden, JointsMoveAsEver) {
    EXPECT_EQ(end_of_generated("chain", 40, 240).hash, "4b137f70ff4a0d6beb94e6c394a2c697");
    EXPECT_EQ(end_of_generated("bridge", 70, 120).hash, "cc64c3a12cbbe1385391bf6f2e1888a7");
    EXPECT_EQ(end_of_generated("grid", 150, 120).hash, "62bb04609b460ce0403cf8c3f34a2421");
}

/// What `tesserae hash` says of a path.
std::string hash_of_content(const std::string& path) {
    const testing::Outcome hash = testing::tesserae({"hash", path});
    EXPECT_EQ(hash.status, 0) << hash.err;
    return hash.out.substr(0, 32);
}

/// Still frames with every integrator, material, light, lens and sheet of the gallery.
TEST_F(Golden, GalleryScenesLookAsEver) {
    const std::pair<const char*, const char*> stills[] = {
        {"sheet", "c1267fea01b4c075d30561573d621d44"},
        {"glass", "1aad7366f5e8b1892717e5625adb9aed"},
        {"room", "506e8a1d65939ee16ffcbb4b8db2fa06"},
        {"lens", "b3525954a0cbceb8ae420329eb4f9668"},
        {"turn", "b90c0e88e9783bd8e3df7f305e64dba2"}};
    const testing::Folder folder("golden");
    for (const auto& [name, hash] : stills) {
        const testing::Outcome render = testing::tesserae(
            {"render", TESSERAE_SOURCE_DIR "/scenes/gallery/" + std::string(name) + ".toml",
             "--frames", "0", "--size", "64x36", "--samples", "4", "-o", folder.file(name)});
        ASSERT_EQ(render.status, 0) << render.err;
        EXPECT_EQ(hash_of_content(folder.file(name)), hash) << name;
    }
}

TEST_F(Golden, AFilmIsAsEver) {
    const testing::Folder folder("golden");
    const testing::Outcome run = testing::tesserae(
        {"run", TESSERAE_SOURCE_DIR "/scenes/gallery/first.toml", "--set", "physics.duration=0.5",
         "--size", "64x36", "--samples", "4", "-o", folder.file("film")});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(hash_of_content(folder.file("film/trajectory.h5")),
              "a75d405dbe8e0f109707bac1bd39a635");
    EXPECT_EQ(hash_of_content(folder.file("film")), "6e61e3b93f6b97b0fa293852a00d3668");
}

}  // namespace
}  // namespace tesserae::scenes
