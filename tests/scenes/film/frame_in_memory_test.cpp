// SPDX-License-Identifier: Apache-2.0
// Pictures in memory, against the files of a film and against each other.
#include "scenes/film/frame_in_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.hpp"
#include "parallel/world_threads.hpp"
#include "scenes/scene_file.hpp"
#include "tests/content.hpp"
#include "tests/error_of.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae {
namespace {

using testing::content;
using testing::error_of;

/// Three balls that drift freely beside a floor that they do not touch.
constexpr const char* kDrift = R"(
physics = { duration = 0.5, gravity = [0, 0, 0, 0] }
camera = { position = [0, 0.5, -6, 0], look_at = [0, 0, 0, 0] }
light = [{ type = "sun", direction = [0.3, -1, 0.4, 0.1] }, { type = "sky" }]
material = [{ name = "red", albedo = [0.9, 0.1, 0.1], albedo_variation = 0.5 }]

[render]
size = [60, 40]
samples = 3
frames_per_second = 20
tile = 16
ghost_depth = 0.5
channels = ["color", "depth", "normal", "albedo", "id", "position", "variance", "samples", "motion", "zplanar", "normal3", "light", "cryptomatte"]

[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 1, 0, 0]
offset = -1.5
[[body]]
name = "left"
shape = "hypersphere"
radius = 0.7
position = [-1.5, 0, 0, 0]
velocity = [1, 0, 0, 0]
material = "red"
[[body]]
name = "middle"
shape = "hypersphere"
radius = 0.5
position = [0, 0, 0, 0.6]
material = "red"
[[body]]
name = "right"
shape = "hypersphere"
radius = 0.6
position = [1.5, 0, 0, 0]
material = "red"
)";

Scene drift(std::vector<std::string> sets = {}) { return Scene::parse(kDrift, sets, "drift.toml"); }

/// Whether a layer of two pictures holds the same values.
bool same_layer(const Picture& a, const Picture& b, const std::string& name) {
    const auto bits = [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    return a.channels(name) == b.channels(name) &&
           std::equal(a.layer(name).begin(), a.layer(name).end(), b.layer(name).begin(),
                      b.layer(name).end(), bits);
}

std::set<float> ids_in(const Picture& picture) {
    const auto ids = picture.layer("id");
    return {ids.begin(), ids.end()};
}

TEST(FramesInMemory, AreThoseOfTheFilm) {
    const testing::TemporaryFolder folder("frames");
    const Scene scene = drift({"camera.shutter=0.5", "overlay.time=true", "render.exposure=-1",
                               "render.crop=[8,4,56,40]"});
    const FilmResult made = scene.film(folder / "film", {}, {.threads = 2, .frames = {3, 8}});
    EXPECT_EQ(made.rendered, 2);
    EXPECT_EQ(made.frames, folder / "film" / "frames");
    EXPECT_EQ(made.preview, folder / "film" / "preview" / "drift.0008.png");
    const auto trajectory = folder / "film" / "trajectory.h5";
    for (const int threads : {1, 3}) {
        const Picture picture = scene.render_frame(8, trajectory, {.threads = threads});
        picture.write_image(folder / "one.exr");
        picture.write_preview(folder / "one.png");
        EXPECT_EQ(content(folder / "one.exr"), content(made.frames / "drift.0008.exr"));
        EXPECT_EQ(content(folder / "one.png"), content(made.preview));
        EXPECT_EQ(picture.width(), 48);
        EXPECT_EQ(picture.height(), 36);
        EXPECT_EQ(picture.left(), 8);
        EXPECT_EQ(picture.top(), 4);
    }
    // One frame more: the trajectory is continued, and what is there is kept.
    const FilmResult more = scene.film(folder / "film", {}, {.frames = {9, 3, 8}});
    EXPECT_EQ(more.kept, 2);
    EXPECT_EQ(more.rendered, 1);
}

TEST(FramesInMemory, HoldTheValuesOfTheirFiles) {
    const testing::TemporaryFolder folder("values");
    const Picture made = drift({"physics.gravity=[0,-1,0,0]"}).render(drift().world());
    made.write_image(folder / "one.exr");
    const Picture read = Picture::read(folder / "one.exr");
    const std::vector<std::string> names = {
        "color", "depth",  "albedo",  "normal",  "position", "variance", "samples",
        "id",    "motion", "zplanar", "normal3", "light",    "ghost",    "cryptomatte"};
    EXPECT_EQ(made.layers(), names);
    EXPECT_EQ(read.layers(), names);
    std::size_t channels = 0;
    for (const std::string& name : names) {
        EXPECT_TRUE(same_layer(made, read, name)) << name;
        EXPECT_EQ(made.layer(name).size(), 60 * 40 * made.channels(name).size());
        channels += made.channels(name).size();
    }
    EXPECT_EQ(channels, 4u + 1 + 3 + 4 + 4 + 3 + 1 + 1 + 4 + 1 + 3 + 6 + 4 + 24);
    EXPECT_EQ(made.channels("normal3"),
              (std::vector<std::string>{"Nslice.X", "Nslice.Y", "Nslice.Z"}));
    // Without exposure and overlay a file's own pixels give the preview.
    made.write_preview(folder / "made.png");
    read.write_preview(folder / "read.png");
    EXPECT_EQ(content(folder / "made.png"), content(folder / "read.png"));
    read.write_image(folder / "again.exr");
    EXPECT_EQ(content(folder / "again.exr"), content(folder / "one.exr"));

    EXPECT_NE(error_of<InputError>([&] { made.layer("colour"); }).find("it has color, depth"),
              std::string::npos);
    const Picture no_color = drift({"render.channels=[\"id\"]"}).render(drift().world());
    EXPECT_THROW(no_color.write_preview(folder / "none.png"), InputError);
    for (const char* name : {"made.jpg", "made.exr", "made"})
        EXPECT_NE(error_of<InputError>([&] {
                      made.write_preview(folder / name);
                  }).find("expected a name that ends in .png"),
                  std::string::npos)
            << name;
    EXPECT_NE(error_of<InputError>([&] {
                  made.write_image(folder / "one.png");
              }).find("expected a name that ends in .exr"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "made.jpg"));
    EXPECT_THROW(Picture::read(folder / "made.png"), InputError);
}

TEST(FramesInMemory, ReportProgressAndStop) {
    const Scene scene = drift();
    const World world = scene.world();
    std::vector<std::uint64_t> told;
    scene.render(world, {.threads = 2, .progress = [&](auto done, auto total) {
                             told.push_back(done);
                             return total == 12;  // 4 by 3 tiles
                         }});
    EXPECT_EQ(told, (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
    EXPECT_THROW(scene.render(world, {.progress = [](auto done, auto) { return done < 5; }}),
                 Stopped);
    const std::atomic<bool> stop{true};
    EXPECT_THROW(scene.render(world, {.stop = &stop}), Stopped);
    const testing::TemporaryFolder folder("stop");
    EXPECT_THROW(scene.film(folder / "film", {}, {.stop = &stop}), Stopped);
    EXPECT_THROW(scene.film(folder / "film", {}, {.progress = [](auto, auto) { return false; }}),
                 Stopped);
    EXPECT_EQ(scene.film(folder / "film", {}, {.frames = {0, 1}}).kept, 1);
}

TEST(FramesInMemory, NeedATrajectoryOnceBodiesHaveMoved) {
    const Scene scene = drift({"render.channels=[\"color\"]"});
    EXPECT_NO_THROW(scene.render_frame(0));
    EXPECT_EQ(error_of<InputError>([&] { scene.render_frame(2); }),
              "drift.toml: frame 2: bodies have moved by then: it needs a trajectory, which "
              "simulating makes");
    EXPECT_EQ(error_of<InputError>([&] { scene.render_frame(10); }),
              "drift.toml: frame 10: the scene has frames 0 to 9");
}

TEST(PicturesOfWorlds, AreFramesAtTheSameTime) {
    const testing::TemporaryFolder folder("world");
    const Scene scene = drift();
    scene.simulate(folder / "drift.h5");
    World world = scene.world(threads(2));
    // Bodies drift evenly: where a frame of the film interpolates, and where it looks at its
    // neighbours, is where the world's go at their velocities.
    for (int step = 0; step < 48; ++step) world.step();
    const Picture frame = scene.render_frame(4, folder / "drift.h5");
    const Picture picture = scene.render(world, {.frame = 4});
    for (const std::string& name : frame.layers()) {
        const auto expected = frame.layer(name), found = picture.layer(name);
        ASSERT_EQ(expected.size(), found.size());
        // Positions differ by rounding, so that a pixel at an edge may be of another body.
        std::size_t different = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            if (std::abs(expected[i] - found[i]) > 1e-3 * (1 + std::abs(expected[i]))) ++different;
        EXPECT_LE(different, expected.size() / 200) << name;
    }
    EXPECT_EQ(ids_in(picture), (std::set<float>{0, 1, 2, 4}));

    // The left ball has moved by 0.2 m; two meshes of the motion layer are its velocity.
    const auto ids = picture.layer("id"), motion = picture.layer("motion");
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (ids[i] != 2) continue;
        EXPECT_GT(motion[4 * i], 0.1) << "to the right in the next frame";
        EXPECT_LT(motion[4 * i + 2], -0.1) << "from the left";
    }
}

TEST(PicturesOfWorlds, KeepTheLooksOfBodiesWhoseNumbersStay) {
    const Scene scene = drift();
    World world = scene.world();
    const Picture before = scene.render(world);
    world.remove(scene.body("left"));
    const Picture without = scene.render(world);
    EXPECT_EQ(ids_in(without), (std::set<float>{0, 1, 4}));
    // The right ball has the same pixels: its number, on which its colour depends, is the same.
    const auto ids = before.layer("id"), now = without.layer("id");
    const auto albedo = before.layer("albedo"), albedo_now = without.layer("albedo");
    std::size_t seen = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (ids[i] != 4) continue;
        ++seen;
        ASSERT_EQ(now[i], 4);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(albedo[3 * i + c], albedo_now[3 * i + c]);
    }
    EXPECT_GT(seen, 50u);

    // A body that the scene does not have is of the default material: a grey of 0.8.
    BodyState place;
    place.position = {-1.5, 0, 0, 0};
    const BodyId added = world.add({.shape = Hyperbox{{0.8, 0.8, 0.8, 0.8}}}, place);
    EXPECT_EQ(added, 4u);
    const Picture with = scene.render(world);
    EXPECT_EQ(ids_in(with), (std::set<float>{0, 1, 4, 5}));
    bool is_grey = false;
    for (std::size_t i = 0; i < ids.size(); ++i)
        if (with.layer("id")[i] == 5 && with.layer("color")[4 * i + 3] == 1)
            is_grey = is_grey || std::abs(with.layer("albedo")[3 * i] - 0.8) < 1e-3;
    EXPECT_TRUE(is_grey);

    // Without the last numbers, and without any body.
    world.remove(added);
    world.remove(scene.body("right"));
    EXPECT_EQ(ids_in(scene.render(world)), (std::set<float>{0, 1}));
    for (const BodyId id : std::vector<BodyId>(world.ids().begin(), world.ids().end()))
        world.remove(id);
    EXPECT_EQ(ids_in(scene.render(world)), std::set<float>{0});
}

TEST(PicturesOfWorlds, FollowABodyWhileItIsThere) {
    const Scene scene = drift({"camera.follow=\"left\""});
    World world = scene.world();
    const Picture before = scene.render(world);
    for (int step = 0; step < 48; ++step) world.step();
    // The ball stays where it is in the picture, and the others move.
    const auto count = [](const Picture& picture, std::size_t pixel) {
        return picture.layer("id")[pixel];
    };
    const Picture after = scene.render(world);
    std::size_t same = 0, of_ball = 0;
    for (std::size_t i = 0; i < before.layer("id").size(); ++i)
        if (count(before, i) == 2) ++of_ball, same += count(after, i) == 2;
    EXPECT_GE(same + 2, of_ball);
    EXPECT_GT(of_ball, 50u);
    world.remove(scene.body("left"));
    EXPECT_EQ(error_of<InputError>([&] { scene.render(world); }),
              "body 1 \"left\": the camera follows it, and the world has it no more");
}

TEST(PicturesOfWorlds, HaveNumbersFromZero) {
    const Scene scene = drift();
    EXPECT_EQ(error_of<InputError>([&] { scene.render(scene.world(), {.frame = -1}); }),
              "frame = -1: expected a number >= 0");
}

TEST(PicturesOfWorlds, AreNotTakenForFramesOfTheScene) {
    const testing::TemporaryFolder folder("other");
    const Scene scene = drift();
    scene.film(folder / "film", {}, {.frames = {0}});
    const auto frame = folder / "film" / "frames" / "drift.0000.exr";
    scene.render(scene.world()).write_image(frame);
    EXPECT_NE(error_of<InputError>([&] { scene.film(folder / "film", {}, {.frames = {0}}); }), "");
    EXPECT_EQ(scene.film(folder / "film", {}, {.frames = {0}, .overwrite = true}).rendered, 1);
}

}  // namespace
}  // namespace tesserae
