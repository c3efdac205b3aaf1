// SPDX-License-Identifier: Apache-2.0
// `tesserae view` as a program: what it makes of scenes and trajectories, and what it refuses.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scenes/process/base64.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

/// What the page holds of the scene.
nlohmann::json scene_in(const std::string& page) {
    const std::string begin = "id=\"scene-data\">";
    const auto at = page.find(begin) + begin.size();
    return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
}

TEST(View, SimulatesASceneFirstAndShowsTheFilmsFrames) {
    const Folder folder("view");
    const auto scene = folder.write("drop.toml", small_scene(0.2));
    const Outcome view = tesserae({"view", scene, "-o", folder.file("a.html"), "--json"});
    ASSERT_EQ(view.status, 0) << view.err;
    const auto report = nlohmann::json::parse(view.out);
    EXPECT_EQ(report["moments"], 4);
    EXPECT_EQ(report["bytes"], content(folder / "a.html").size());
    const auto json = scene_in(content(folder / "a.html"));
    ASSERT_EQ(json["times"].size(), 4u);  // 20 a second
    EXPECT_DOUBLE_EQ(json["times"][3].get<double>(), 0.15);

    // The trajectory is beside it, and makes the same page; so do any threads.
    ASSERT_EQ(tesserae({"view", folder.file("a.h5"), "-o", folder.file("b.html")}).status, 0);
    EXPECT_EQ(content(folder / "a.html"), content(folder / "b.html"));
    ASSERT_EQ(tesserae({"view", scene, "-o", folder.file("c.html"), "--threads", "1"}).status, 0);
    EXPECT_EQ(content(folder / "a.html"), content(folder / "c.html"));
}

/// One that stores other steps than frames need is shown as it is.
TEST(View, ShowsTheStepsOfATrajectoryThatHasNotThoseOfTheFrames) {
    const Folder folder("view-steps");
    const auto scene = folder.write("drop.toml", small_scene(0.2));
    const auto file = folder.file("drop.h5");
    ASSERT_EQ(tesserae({"simulate", scene, "-o", file, "--store-every", "5"}).status, 0);
    ASSERT_EQ(tesserae({"view", file, "-o", folder.file("a.html")}).status, 0);
    const auto json = scene_in(content(folder / "a.html"));
    ASSERT_EQ(json["times"].size(), 3u);
    EXPECT_DOUBLE_EQ(json["times"][2].get<double>(), 10.0 / 60);
}

TEST(View, ShowsStillsAndScenesWithoutBodies) {
    const Folder folder("view-still");
    const auto still =
        folder.write("still.toml", "[[body]]\nshape = \"hypersphere\"\nradius = 1\n");
    const auto empty = folder.write("empty.toml", "[camera]\nposition = [0, 0, -5, 0]\n");
    EXPECT_EQ(tesserae({"view", still, "-o", folder.file("still.html")}).status, 0);
    EXPECT_EQ(tesserae({"view", empty, "-o", folder.file("empty.html")}).status, 0);
    EXPECT_EQ(files_below(folder.path()),
              (std::vector<std::string>{"empty.html", "empty.toml", "still.html", "still.toml"}));
}

TEST(View, LeavesOutWhatIsNeverNearTheSlice) {
    const Folder folder("view-near");
    const auto scene = folder.write("scene.toml", R"([[body]]
shape = "hypersphere"
radius = 1
[[body]]
shape = "hypersphere"
radius = 1
position = [0, 0, 0, 5]
)");
    const auto bodies = [&](const std::vector<std::string>& more) {
        std::vector<std::string> line = {"view", scene, "-o", folder.file("a.html"), "--json"};
        line.insert(line.end(), more.begin(), more.end());
        return nlohmann::json::parse(tesserae(line).out)["bodies"].get<int>();
    };
    EXPECT_EQ(bodies({}), 2);
    EXPECT_EQ(bodies({"--near-slice", "4.1"}), 2);
    EXPECT_EQ(bodies({"--near-slice", "3.9"}), 1);
    EXPECT_EQ(tesserae({"view", scene, "-o", folder.file("a.html"), "--near-slice", "-1"}).status,
              2);
}

/// A ball on a hinge, and one that breaks its rod after a quarter of a second's fall.
TEST(View, HasJointsAndWhenTheyBreak) {
    const Folder folder("view-joints");
    const auto scene = folder.write("joints.toml", small_scene(0.5) + R"(
[[body]]
name = "wheel"
shape = "hypersphere"
radius = 0.2
position = [5, 6, 0, 0]
[[body]]
name = "load"
shape = "hypersphere"
radius = 0.2
position = [9, 6, 0, 0]
[[joint]]
name = "axle <1>"
type = "hinge"
a = "wheel"
anchor = [5, 6.5, 0, 0]
plane = "xy"
[[joint]]
name = "thread"
type = "rope"
a = "load"
anchor_a = [9, 6, 0, 0]
anchor_b = [9, 6.5, 0, 0]
length = 0.8
break = { force = 1 }
)");
    const Outcome view = tesserae({"view", scene, "-o", folder.file("a.html")});
    ASSERT_EQ(view.status, 0) << view.err;
    const std::string page = content(folder / "a.html");
    const auto joints = scene_in(page)["joints"];
    EXPECT_EQ(joints["names"], (nlohmann::json{"axle <1>", "thread"}));
    EXPECT_EQ(joints["data"].get<std::string>().size(), 160u);  // 120 bytes as base64
    // 0.3 m deep the rope is taut: after 0.245 s, before the sixth frame of 20 a second.
    EXPECT_EQ(joints["data"].get<std::string>().substr(148),
              base64(std::string("\0\xff\xff\xff\xff\5\0\0\0", 9)));
    ASSERT_EQ(tesserae({"view", folder.file("a.h5"), "-o", folder.file("b.html")}).status, 0);
    EXPECT_EQ(content(folder / "b.html"), page);
}

TEST(View, RefusesWhatItCannotDo) {
    const Folder folder("view-refuse");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    const auto page = folder.file("a.html");
    const Outcome name = tesserae({"view", scene, "-o", folder.file("a.txt")});
    EXPECT_EQ(name.status, 2);
    EXPECT_NE(name.err.find(".html"), std::string::npos) << name.err;
    EXPECT_EQ(tesserae({"view", folder.file("none.toml"), "-o", page}).status, 2);

    // What is no page is not replaced unasked.
    folder.write("b.html", "mine");
    EXPECT_EQ(tesserae({"view", scene, "-o", folder.file("b.html")}).status, 2);
    EXPECT_EQ(content(folder / "b.html"), "mine");
    EXPECT_EQ(tesserae({"view", scene, "-o", folder.file("b.html"), "--overwrite"}).status, 0);
}

TEST(View, ReplacesItsOwnPageAndTrajectoryAndNoOther) {
    const Folder folder("view-replace");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    const auto page = folder.file("a.html");
    ASSERT_EQ(tesserae({"view", scene, "-o", page}).status, 0);
    const std::string first = content(page), moved = content(folder / "a.h5");
    // Another look keeps the trajectory, another motion replaces both.
    ASSERT_EQ(tesserae({"view", scene, "-o", page, "--set", "camera.field_of_view=20"}).status, 0);
    EXPECT_NE(content(page), first);
    EXPECT_EQ(content(folder / "a.h5"), moved);
    const Outcome changed = tesserae({"view", scene, "-o", page, "--set", "physics.duration=0.05",
                                      "--set", "physics.gravity=[0, -1, 0, 0]"});
    ASSERT_EQ(changed.status, 0) << changed.err;
    EXPECT_NE(content(folder / "a.h5"), moved);
    ASSERT_EQ(tesserae({"view", scene, "-o", page}).status, 0);
    EXPECT_EQ(content(page), first);
    EXPECT_EQ(content(folder / "a.h5"), moved);

    // A trajectory that simulate has made may have taken hours.
    ASSERT_EQ(tesserae({"simulate", scene, "-o", folder.file("b.h5")}).status, 0);
    const std::string kept = content(folder / "b.h5");
    EXPECT_EQ(tesserae({"view", scene, "-o", folder.file("b.html")}).status, 0);
    EXPECT_EQ(tesserae({"view", scene, "-o", folder.file("b.html"), "--set",
                        "physics.gravity=[0, -1, 0, 0]"})
                  .status,
              2);
    EXPECT_EQ(content(folder / "b.h5"), kept);
}

}  // namespace
}  // namespace tesserae::scenes::testing
