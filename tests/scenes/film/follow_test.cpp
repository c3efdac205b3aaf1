// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "parallel/threads.hpp"
#include "scenes/film/film.hpp"
#include "scenes/film/film_camera.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/timeline.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

constexpr const char* kThrown =
    "[physics]\nduration = 1\nsteps_per_second = 100\n"
    "[camera]\nposition = [0, 1, -8, 0]\nlook_at = [0, 0.5, 0, 0]\nfollow = \"ball\"\n"
    "[[camera.key]]\ntime = 0\nposition = [0, 1, -8, 0]\n"
    "[[camera.key]]\ntime = 1\nposition = [1, 1, -8, 0]\n"
    "[render]\nsize = [16, 12]\nframes_per_second = 12\nsamples = 2\n"
    "[[body]]\nname = \"floor\"\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\noffset = -1\n"
    "[[body]]\nname = \"ball\"\nshape = \"hypersphere\"\nradius = 0.5\nposition = [1, 0.5, 0, 0]\n"
    "velocity = [2, 3, 1, 0.5]\nrestitution = 0.7\n";

/// The scene and its trajectory, in a folder that lives as long as it.
struct Filmed {
    SceneFile file;
    Scene scene;
    fs::path trajectory;

    explicit Filmed(const std::vector<std::string>& sets, std::uint64_t store_every = 0)
        : file(kThrown), scene(load_scene(file.path(), sets)), trajectory(file.folder() / "t.h5") {
        simulate(scene, make_plan(scene, 1), trajectory,
                 {.store_every = store_every, .quiet = true});
    }
    Vec4 way(int frame) const {
        Poses poses(scene, {frame}, trajectory);
        return poses.at(frame_instant(scene, frame)).position[1] - scene.bodies.position[1];
    }
};

/// The mean over the lag, by many points on the straight ways between frames.
Vec4 brute_force_mean(const Filmed& film, int frame, double lag) {
    constexpr int kPoints = 200'000;
    const double rate = film.scene.render.frames_per_second, now = frame / rate;
    std::vector<Vec4> ways;
    for (int k = 0; k <= frame; ++k) ways.push_back(film.way(k));
    Vec4 sum = Vec4::Zero();
    for (int i = 0; i < kPoints; ++i) {
        const double at = std::max(0.0, now - lag * (i + 0.5) / kPoints) * rate;
        const auto k = std::min(static_cast<std::size_t>(at), ways.size() - 1);
        const Vec4 next = ways[std::min(k + 1, ways.size() - 1)];
        sum += ways[k] + (at - static_cast<double>(k)) * (next - ways[k]);
    }
    return sum / kPoints;
}

TEST(FollowingCamera, GoesWithItsBody) {
    const Filmed film({});
    const CameraPath path = film.scene.camera_path();
    Poses poses(film.scene, parse_frames("", 12), film.trajectory);
    FilmCamera camera(film.scene, &poses);
    for (int frame = 0; frame < 12; ++frame) {
        const FrameInstant instant = frame_instant(film.scene, frame);
        const Vec4 way = film.way(frame);
        const auto at = camera.at(instant.time, poses.at(instant));
        EXPECT_EQ(at, *camera.at(frame));
        EXPECT_LT((at.position - path.at(instant.time).position - way).norm(), 1e-14);
        EXPECT_LT((at.look_at - path.at(instant.time).look_at - way).norm(), 1e-14);
    }
    EXPECT_GT(film.way(11).norm(), 1);
}

TEST(FollowingCamera, FollowsTheAxesThatAreNamed) {
    const Filmed film({"camera.follow_axes=[\"x\", \"w\"]"});
    Poses poses(film.scene, {7}, film.trajectory);
    const Vec4 way = film.way(7);
    const auto at = *FilmCamera(film.scene, &poses).at(7);
    const Vec4 moved = at.look_at - film.scene.camera.look_at;
    EXPECT_LT((moved - Vec4(way[0], 0, 0, way[3])).norm(), 1e-14);
}

TEST(FollowingCamera, LagsByTheMeanOverAWindow) {
    for (const double lag : {0.02, 0.25, 0.31, 5.0}) {
        const Filmed film({"camera.follow_lag=" + std::to_string(lag)});
        for (const int frame : {0, 1, 5, 11}) {
            // Alone, as a film of one frame would have it.
            Poses poses(film.scene, {frame}, film.trajectory);
            const auto at = *FilmCamera(film.scene, &poses).at(frame);
            const Vec4 moved = at.look_at - film.scene.camera.look_at;
            EXPECT_LT((moved - brute_force_mean(film, frame, lag)).norm(), 1e-5)
                << lag << " " << frame;
            // In a row, and from what else is stored.
            Poses all(film.scene, parse_frames("", 12), film.trajectory);
            FilmCamera camera(film.scene, &all);
            for (int before = 0; before < frame; ++before) camera.at(before);
            EXPECT_EQ(*camera.at(frame), at);
        }
    }
}

TEST(FollowingCamera, DoesNotDependOnWhatElseIsStored) {
    const std::vector<std::string> sets = {"camera.follow_lag=0.4"};
    const Filmed few(sets), many(sets, 1);
    Poses a(few.scene, {9}, few.trajectory), b(many.scene, {9}, many.trajectory);
    EXPECT_EQ(*FilmCamera(few.scene, &a).at(9), *FilmCamera(many.scene, &b).at(9));
}

std::string bytes_of_frame(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::stringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
}

/// Also through an open shutter and with vectors of motion, which ask for instants beside.
TEST(FollowingCamera, ShowsTheSameInAnyRangeOfFrames) {
    const Filmed film(
        {"camera.follow_lag=0.3", "camera.shutter=0.5", "render.channels=[\"color\", \"motion\"]"});
    const auto render = [&](const std::vector<int>& frames, int threads, const char* name) {
        const fs::path folder = film.file.folder() / name;
        parallel::Threads(threads).run([&] {
            scenes::film(film.scene, frames, film.trajectory, folder, Replace::kNothing, true);
        });
        return folder / "frames" / "test.";
    };
    const fs::path all = render(parse_frames("", 12), 4, "all");
    for (const int frame : {0, 6, 11}) {
        const fs::path one = render({frame}, 1, fmt::format("{}", frame).c_str());
        const std::string name = fmt::format("{:04}.exr", frame);
        EXPECT_EQ(bytes_of_frame(one.string() + name), bytes_of_frame(all.string() + name))
            << frame;
        EXPECT_FALSE(bytes_of_frame(one.string() + name).empty());
    }
}

/// A body that the camera goes with stands still in the picture, blurred or not, and its vectors of
/// motion are none.
TEST(FollowingCamera, CopiesNoFrameOfABodyThatMoves) {
    const Filmed film({"camera.follow_axes=[\"x\"]", "render.samples=1"});
    const FilmReport report = scenes::film(film.scene, parse_frames("0-3", 12), film.trajectory,
                                           film.file.folder() / "f", Replace::kNothing, true);
    EXPECT_EQ(report.copied, 0);
    EXPECT_EQ(report.rendered, 4);
}

TEST(FollowingCamera, NamesABody) {
    const auto with = [](const std::string& follow, const std::string& more = "") {
        return "[physics]\n[camera]\n" + follow +
               "[[body]]\nname = \"crate\"\nshape = \"hypersphere\"\nradius = 1\n" + more;
    };
    const std::string lattice =
        "[[lattice]]\nname = \"bricks\"\nshape = \"hypersphere\"\nradius = 1\n"
        "count = [2, 3, 1, 1]\nspacing = 3\n";
    EXPECT_EQ(load_text(with("follow = \"crate\"\n", lattice)).camera_motion.followed, 0u);
    EXPECT_EQ(load_text(with("follow = \"bricks.4\"\n", lattice)).camera_motion.followed, 5u);
    const auto expect = [](const std::string& text, const std::vector<const char*>& words) {
        const std::string error = error_of(text);
        for (const char* word : words)
            EXPECT_NE(error.find(word), std::string::npos) << word << " in: " << error;
    };
    expect(with("follow = \"crat\"\n"), {"test.toml:3:10", "did you mean \"crate\"?"});
    expect(with("follow = \"bricks\"\n", lattice), {"3:10", "\"bricks.0\" to \"bricks.5\""});
    expect(with("follow = \"bricks.6\"\n", lattice), {"3:10", "\"bricks.0\" to \"bricks.5\""});
    expect(with("follow = \"\"\n"), {"3:10", "expected a body's name"});
    expect(with("follow = \"crate\"\nfollow_lag = -1\n"), {"4:14", "follow_lag = -1"});
    expect(with("follow = \"crate\"\nfollow_axes = [\"v\"]\n"),
           {"4:16", "\"x\", \"y\", \"z\", \"w\""});
    expect(with("follow = \"crate\"\nfollow_axes = []\n"), {"4:15", "at least one axis"});
}

TEST(FollowingCamera, SaysWhereItChangesNothing) {
    const std::string body = "[[body]]\nname = \"b\"\nshape = \"hypersphere\"\nradius = 1\n";
    const std::string camera = "[camera]\nfollow = \"b\"\n";
    const auto expect = [](const std::string& text, const char* words) {
        const Scene scene = load_text(text);
        ASSERT_EQ(scene.unused.size(), 1u) << text;
        EXPECT_NE(scene.unused[0].find(words), std::string::npos) << scene.unused[0];
    };
    expect(camera + body, "without [physics]");
    expect("[physics]\n" + camera + body + "fixed = [\"position\"]\n", "is fixed in its position");
    expect("[physics]\n" + camera +
               "[[body]]\nname = \"b\"\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\n",
           "never moves");
    expect("[camera]\nfollow_lag = 1\n" + body, "no follow");
    expect("[camera]\nfollow_axes = [\"x\"]\n" + body, "no follow");
    EXPECT_TRUE(load_text("[physics]\n" + camera + body +
                          "fixed = [\"position\"]\nvelocity = [1, 0, 0, 0]\n")
                    .unused.empty());
}

TEST(FollowingCamera, IsWrittenBack) {
    const Scene scene = load_text(kThrown, {"camera.follow_lag=0.5", "camera.follow_axes=[\"y\"]"});
    EXPECT_EQ(load_text(scene.effective).hash, scene.hash);
    EXPECT_NE(scene.effective.find("follow = \"ball\"\nfollow_axes = [\"y\"]\nfollow_lag = 0.5\n"),
              std::string::npos);
    // Bodies move as before, and what is said by default is not written.
    EXPECT_EQ(scene.motion_hash, load_text(kThrown).motion_hash);
    EXPECT_EQ(load_text(kThrown,
                        {"camera.follow_axes=[\"w\", \"x\", \"y\", \"z\"]", "camera.follow_lag=0"})
                  .hash,
              load_text(kThrown).hash);
}

}  // namespace
}  // namespace tesserae::scenes
