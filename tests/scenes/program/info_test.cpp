// SPDX-License-Identifier: Apache-2.0
// What `tesserae info` says of files, as text and as JSON.
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/dynamics/motion_version.hpp"
#include "render/picture_version.hpp"
#include "tests/scenes/program/program.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"

namespace tesserae::scenes::testing {
namespace {

TEST(Info, TellsScenesTrajectoriesAndImagesApart) {
    const Folder folder("info");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    ASSERT_EQ(tesserae({"run", scene, "-o", folder.file("out")}).status, 0);
    const auto kind = [&](const std::string& file) {
        const Outcome info = tesserae({"info", file, "--json"});
        EXPECT_EQ(info.status, 0) << info.err;
        return nlohmann::json::parse(info.out)["kind"].get<std::string>();
    };
    EXPECT_EQ(kind(scene), "scene");
    EXPECT_EQ(kind(folder.file("out/trajectory.h5")), "trajectory");
    EXPECT_EQ(kind(folder.file("out/frames/drop.0000.exr")), "image");
    // Cut files are errors, not crashes.
    for (const char* file : {"out/trajectory.h5", "out/frames/drop.0000.exr"}) {
        const auto cut = folder.write("cut", content(folder / file).substr(0, 200));
        EXPECT_EQ(tesserae({"info", cut}).status, 2);
    }
}

/// Points with a few digits split cells: that shows.
TEST(Info, CountsWhatHullsHave) {
    const Folder folder("hulls");
    const auto scene = folder.write("hulls.toml", R"([[body]]
name = "a"
shape = "polychoron"
regular = "24-cell"
radius = 1
[[body]]
name = "b"
shape = "duoprism"
polygons = [3, 5]
radii = [1, 1]
position = [9, 0, 0, 0]
[[body]]
name = "c"
shape = "polychoron"
regular = "24-cell"
radius = 1
position = [-9, 0, 0, 0]
)");
    const Outcome info = tesserae({"info", scene, "--json"});
    ASSERT_EQ(info.status, 0) << info.err;
    using nlohmann::json;
    const auto row = [](const char* body, int v, int e, int f, int c) {
        return json{{"body", body}, {"vertices", v}, {"edges", e}, {"faces", f}, {"cells", c}};
    };
    EXPECT_EQ(json::parse(info.out)["hulls"],
              (json::array({row("a", 24, 96, 96, 24), row("b", 15, 30, 23, 8)})));
    EXPECT_NE(tesserae({"info", scene}).out.find("b: 15 vertices, 30 edges, 23 faces, 8 cells"),
              std::string::npos);
    // Every name has a key without blanks; the old names stay beside them until version 0.3.
    const auto all = nlohmann::json::parse(info.out);
    EXPECT_EQ(all["movable_bodies"], all["movable bodies"]);
    for (const auto& [key, value] : all.items())
        if (key.find(' ') != std::string::npos) {
            std::string plain = key;
            std::erase(plain, ',');
            std::replace(plain.begin(), plain.end(), ' ', '_');
            EXPECT_EQ(all[plain], value) << key;
        }
}

TEST(Info, SaysHowWellATrajectoryKeepsWhatMotionKeeps) {
    const Folder folder("diagnostics");
    const auto scene = folder.write("fall.toml", R"([physics]
duration = 1
[[body]]
shape = "hypersphere"
radius = 0.5
mass = 2
position = [3, 0, 0, 0]
angular_velocity = { zw = 6 }
)");
    const auto file = folder.file("fall.h5");
    ASSERT_EQ(tesserae({"simulate", scene, "-o", file, "--store-every", "1"}).status, 0);
    const Outcome info = tesserae({"info", file, "--json"});
    ASSERT_EQ(info.status, 0) << info.err;
    const auto json = nlohmann::json::parse(info.out);
    const auto expect = [&](const char* name, double value, const char* unit, int step) {
        EXPECT_EQ(json.at(name), (nlohmann::json{{"value", value}, {"unit", unit}, {"step", step}}))
            << name;
    };
    // I = m r^2 / 3, so I omega^2 / 2 = 3 J; after 1 s a fall at 10 m/s^2 has m v = 20 kg m/s, and
    // x m v = 60 kg m^2/s about the origin. The steps add up roundings.
    const auto near = [&](const char* name, const char* part, double value) {
        ASSERT_TRUE(json.at(name).at(part).is_number()) << name;
        EXPECT_NEAR(json.at(name).at(part).get<double>(), value, 1e-11) << name;
    };
    near("energy, first row", "value", 3);
    near("energy, first row", "kinetic", 3);
    near("energy, first row", "potential", 0);
    EXPECT_EQ(json.at("energy, first row").at("unit"), "J");
    near("momentum change", "value", 20);
    near("angular momentum change", "value", 60);
    EXPECT_EQ(json.at("momentum change").at("step"), 240);
    EXPECT_EQ(json.at("angular momentum change").at("unit"), "kg m^2/s");
    // The step is exact under constant gravity: 240 roundings of 100 J.
    EXPECT_LT(json.at("largest energy change").at("value").get<double>(), 240 * 100 * 2.3e-16);
    expect("deepest penetration", 0, "m", 0);
    EXPECT_EQ(json.at("last step"), 240);
    EXPECT_EQ(json.at("last time"), (nlohmann::json{{"value", 1.0}, {"unit", "s"}}));
    const std::string text = tesserae({"info", file}).out;
    const std::string version = fmt::format("\nmotion version           {}\n", kMotionVersion);
    for (const std::string& line :
         {std::string("\nmomentum change          20 kg m/s at step 240\n"),
          std::string("\nlast time                1 s\n"), version,
          std::string("\nasleep, last row         0 bodies\n")})
        EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

TEST(Info, NumbersAreNumbersInJson) {
    const Folder folder("types");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    ASSERT_EQ(tesserae({"run", scene, "-o", folder.file("out"), "--crop", "8,4,40,20"}).status, 0);
    const auto json_of = [&](const std::string& file) {
        const Outcome info = tesserae({"info", file, "--json"});
        EXPECT_EQ(info.status, 0) << info.err;
        return nlohmann::json::parse(info.out);
    };
    const auto of_scene = json_of(scene);
    EXPECT_EQ(of_scene.at("bodies"), 29);
    EXPECT_EQ(of_scene.at("size"), (nlohmann::json{64, 48}));
    EXPECT_TRUE(of_scene.at("hash").is_string());
    const auto of_trajectory = json_of(folder.file("out/trajectory.h5"));
    for (const char* name : {"bodies", "rows", "last step", "contacts, last row",
                             "asleep, last row", "motion version"})
        EXPECT_TRUE(of_trajectory.at(name).is_number_unsigned()) << name;
    EXPECT_EQ(of_trajectory.at("steps per second"), 60);
    const auto of_image = json_of(folder.file("out/frames/drop.0001.exr"));
    EXPECT_EQ(of_image.at("size"), (nlohmann::json{64, 48}));
    EXPECT_EQ(of_image.at("pixels held"), (nlohmann::json{8, 4, 40, 20}));
    EXPECT_EQ(of_image.at("channels").at(0), "A");
    EXPECT_EQ(of_image.at("tesserae/frame"), 1);
    EXPECT_EQ(of_image.at("tesserae/time"), 0.05);
    EXPECT_EQ(of_image.at("tesserae/scene"), "drop");
    EXPECT_EQ(of_image.at("tesserae/cameraOrigin"), (nlohmann::json{0.0, 2.0, -6.0, 0.0}));
    EXPECT_EQ(of_image.at("framesPerSecond"), (nlohmann::json{20, 1}));
    EXPECT_EQ(of_image.at("motion version"), kMotionVersion);
    EXPECT_EQ(of_image.at("tesserae/motionVersion"), kMotionVersion);
    EXPECT_EQ(of_image.at("picture version"), render::kPictureVersion);
    EXPECT_EQ(of_image.at("tesserae/pictureVersion"), render::kPictureVersion);
}

TEST(Info, NumbersThatJsonDoesNotHaveAreNamed) {
    const Folder folder("infinite");
    const auto file = folder.file("film.h5");
    Row row = make_row(0, 3);
    row.facts.report.penetration = std::numeric_limits<double>::infinity();
    row.facts.kinetic_energy = -std::numeric_limits<double>::infinity();
    row.facts.potential_energy = std::numeric_limits<double>::quiet_NaN();
    TrajectoryWriter writer(file, make_header(3), make_steps(1), false);
    writer.append(row.facts, row.bodies, row.memory);
    writer.finish();
    const Outcome info = tesserae({"info", file, "--json"});
    ASSERT_EQ(info.status, 0) << info.err;
    const auto json = nlohmann::json::parse(info.out);
    EXPECT_EQ(json.at("deepest penetration").at("value"), "inf");
    EXPECT_EQ(json.at("energy, first row").at("kinetic"), "-inf");
    EXPECT_EQ(json.at("energy, first row").at("value"), "nan");
}

TEST(Info, CountsJointsAndThoseThatBroke) {
    const Folder folder("joints");
    const auto file = folder.file("film.h5");
    TrajectoryWriter writer(file, make_header(3, 4), make_steps(7), false);
    append_rows(writer, 7, 3, 4);
    writer.finish();
    const auto json = nlohmann::json::parse(tesserae({"info", file, "--json"}).out);
    EXPECT_EQ(json.at("joints"), 4);
    EXPECT_EQ(json.at("broken_joints_last_row"), 1);
    const Outcome info = tesserae({"info", file});
    EXPECT_NE(info.out.find("\nbroken joints, last row  1\n"), std::string::npos) << info.out;
}

TEST(Info, AnImageWithoutBodiesHasNoNames) {
    const Folder folder("nobody");
    const auto scene = folder.write("empty.toml", "[render]\nsize = [8, 8]\n");
    ASSERT_EQ(tesserae({"render", scene, "-o", folder.file("out")}).status, 0);
    const Outcome info = tesserae({"info", folder.file("out/frames/empty.0000.exr"), "--json"});
    ASSERT_EQ(info.status, 0) << info.err;
    EXPECT_EQ(nlohmann::json::parse(info.out).at("tesserae/idNames"), "{}");
}

}  // namespace
}  // namespace tesserae::scenes::testing
