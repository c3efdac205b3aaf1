// SPDX-License-Identifier: Apache-2.0
// Vectors of motion in films: what a frame takes from the frames beside it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "render/file/image_pixels.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

/// Four frames of 3 steps. A box that nothing stops, a face toward the camera, 7.5 m before it.
std::string box_scene(const char* motion) {
    return fmt::format(R"(
[physics]
duration = 0.2
steps_per_second = 60
[camera]
position = [0, 0, -8, 0]
look_at = [0, 0, 0, 0]
[render]
size = [64, 36]
samples = 1
frames_per_second = 20
channels = ["color", "id", "motion"]
[[body]]
name = "box"
shape = "hyperbox"
size = [3, 2, 1, 1]
fixed = ["position", "rotation"]
{}
)",
                       motion);
}
constexpr const char* kGoing = "velocity = [0.6, -0.3, 0, 0.05]";
constexpr const char* kTurning =
    "velocity = [0.6, -0.3, 0, 0.05]\nangular_velocity = { xy = 3, xw = 2, yz = 1 }";

using Planes = std::map<std::string, std::vector<double>>;

Planes planes_of(const std::filesystem::path& file) {
    const render::ImagePixels image(file);
    Planes planes;
    image.for_each_block([&](int, int, const render::PixelPlanes& block) {
        for (std::size_t c = 0; c < block.size(); ++c) {
            const render::ImageChannel& channel = image.channels()[c];
            const std::size_t width = render::bytes_of(channel.type);
            for (std::size_t i = 0; i < block[c].size(); i += width)
                planes[channel.name].push_back(render::value_of(channel.type, block[c].data() + i));
        }
    });
    return planes;
}

nlohmann::json did(std::vector<std::string> words) {
    words.push_back("--json");
    const Outcome outcome = tesserae(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.status == 0 ? nlohmann::json::parse(outcome.out) : nlohmann::json();
}

std::string frame_file(const std::string& name, int frame) {
    return fmt::format("frames/{}.{:04}.exr", name, frame);
}

/// The same scene without physics: a still.
std::string still_of(const Folder& folder, std::string text) {
    text.erase(0, text.find("[camera]"));
    return folder.write("still.toml", text);
}

TEST(Motion, OfABoxAtEvenSpeedIsTheSameInAllFramesOfAFilm) {
    const Folder folder("motion");
    const auto scene = folder.write("box.toml", box_scene(kGoing));
    did({"run", scene, "-o", folder.file("film")});
    did({"render", still_of(folder, box_scene(kGoing)), "-o", folder.file("still")});
    // Of the front face, 7.5 m away, in a twentieth of a second. The vertical field of view is 50
    // degrees.
    const double pixel = 7.5 * 2 * std::tan(25 * std::numbers::pi / 180) / 36;
    const double u = 0.6 / 20 / pixel, v = -0.3 / 20 / pixel;
    std::vector<std::filesystem::path> files = {folder / "still" / frame_file("still", 0)};
    for (int k = 0; k < 4; ++k) files.push_back(folder / "film" / frame_file("box", k));
    for (const auto& file : files) {
        Planes planes = planes_of(file);
        int box = 0;
        for (std::size_t i = 0; i < planes["objectid"].size(); ++i) {
            const bool is_box = planes["objectid"][i] == 1;
            box += is_box;
            // Roundings of floats: no coordinate is longer than half a pixel.
            EXPECT_NEAR(planes["forward.u"][i], is_box ? u : 0, 1e-7) << file << i;
            EXPECT_NEAR(planes["forward.v"][i], is_box ? v : 0, 1e-7) << file << i;
            EXPECT_NEAR(planes["backward.u"][i], is_box ? -u : 0, 1e-7) << file << i;
            EXPECT_NEAR(planes["backward.v"][i], is_box ? -v : 0, 1e-7) << file << i;
        }
        EXPECT_GT(box, 100) << file;
    }
}

TEST(Motion, ForwardLeadsToWhereBackwardLeadsBack) {
    const Folder folder("motion");
    // A ball that comes nearer within the slice.
    std::string text = box_scene("velocity = [6, -3, -8, 0]");
    text.replace(text.find("\"hyperbox\""), 10, "\"hypersphere\"");
    text.replace(text.find("size = [3, 2, 1, 1]"), 19, "radius = 1.6");
    did({"run", folder.write("ball.toml", text), "-o", folder.file("film")});
    constexpr int kWidth = 64, kHeight = 36;
    int compared = 0;
    for (int k = 0; k < 3; ++k) {
        const Planes here = planes_of(folder / "film" / frame_file("ball", k));
        const Planes there = planes_of(folder / "film" / frame_file("ball", k + 1));
        // Whether all pixels about one show the ball: not at its rim, where depth changes fast.
        const auto is_inside = [](const Planes& planes, int x, int y) {
            for (int j = y - 3; j <= y + 3; ++j)
                for (int i = x - 3; i <= x + 3; ++i)
                    if (i < 0 || i >= kWidth || j < 0 || j >= kHeight ||
                        planes.at("objectid")[static_cast<std::size_t>(j * kWidth + i)] != 1)
                        return false;
            return true;
        };
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const auto index = static_cast<std::size_t>(y * kWidth + x);
                const double u = here.at("forward.u")[index], v = here.at("forward.v")[index];
                const double to_x = x + u, to_y = y - v;
                const int x0 = static_cast<int>(std::floor(to_x));
                const int y0 = static_cast<int>(std::floor(to_y));
                if (!is_inside(here, x, y) || !is_inside(there, x0, y0)) continue;
                ++compared;
                const auto back = [&](const char* channel) {
                    const auto at = [&](int i, int j) {
                        return there.at(
                            channel)[static_cast<std::size_t>((y0 + j) * kWidth + x0 + i)];
                    };
                    const double a = to_x - x0, b = to_y - y0;
                    return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) +
                           b * ((1 - a) * at(0, 1) + a * at(1, 1));
                };
                // Vectors of about two pixels; between pixels they bend.
                EXPECT_NEAR(back("backward.u"), -u, 0.01) << k << ": " << x << ", " << y;
                EXPECT_NEAR(back("backward.v"), -v, 0.01) << k << ": " << x << ", " << y;
            }
    }
    EXPECT_GT(compared, 100);
}

TEST(Motion, OfATurningBoxIsThatOfItsTrajectoryAndOfItsVelocities) {
    const Folder folder("motion");
    const auto scene = folder.write("box.toml", box_scene(kTurning));
    did({"run", scene, "-o", folder.file("film"), "--frames", "0"});
    did({"render", still_of(folder, box_scene(kTurning)), "-o", folder.file("still")});
    const Planes film = planes_of(folder / "film" / frame_file("box", 0));
    const Planes still = planes_of(folder / "still" / frame_file("still", 0));
    double longest = 0;
    for (const char* channel : {"forward.u", "forward.v", "backward.u", "backward.v"})
        for (std::size_t i = 0; i < film.at(channel).size(); ++i) {
            // Floats of up to a few pixels. Steps turn the box exactly: its velocities are
            // constant.
            EXPECT_NEAR(film.at(channel)[i], still.at(channel)[i], 1e-5) << channel;
            longest = std::max(longest, std::abs(film.at(channel)[i]));
        }
    EXPECT_GT(longest, 1);
}

TEST(Motion, OfAFrameIsTheSameAloneAndInAFilm) {
    const Folder folder("motion");
    const auto scene = folder.write("drop.toml", small_scene(0.35) + R"(
[[camera.key]]
time = 0
position = [0, 2, -6, 0]
[[camera.key]]
time = 1
position = [0.5, 2, -5, 0.1]
)");
    const std::vector<std::string> motion = {"--set", R"(render.channels=["motion"])"};
    did({"run", scene, "-o", folder.file("film"), motion[0], motion[1]});
    for (const char* frame : {"0", "3", "6"}) {
        did({"render", scene, "--trajectory", folder.file("film/trajectory.h5"), "--frames", frame,
             "--threads", "3", motion[0], motion[1], "-o", folder.file(frame)});
        const std::string file = frame_file("drop", std::stoi(frame));
        EXPECT_EQ(content(folder / "film" / file), content(folder / frame / file));
    }
}

TEST(Motion, NamesAStepThatAFrameBesideIsMissing) {
    const Folder folder("motion");
    const auto scene = folder.write("box.toml", box_scene(kGoing));
    const std::string every_sixth = folder.file("sixth.h5");
    did({"simulate", scene, "-o", every_sixth, "--store-every", "6"});
    // Frame 2 is at step 6, those beside it at 3 and 9.
    std::vector<std::string> line = {
        "render", scene, "--trajectory", every_sixth, "-o", folder.file("out"), "--frames", "2"};
    const Outcome missing = tesserae(line);
    EXPECT_EQ(missing.status, 2);
    EXPECT_NE(missing.err.find("step 3 is not stored"), std::string::npos) << missing.err;
    line.insert(line.end(), {"--set", R"(render.channels=["color"])"});
    EXPECT_EQ(tesserae(line).status, 0);
}

TEST(Motion, AFrameIsCopiedOnlyWhereItsVectorsAreThoseOfTheLastOne) {
    const Folder folder("motion");
    // At rest; a turn of the camera in frame 2; at rest again.
    const auto scene = folder.write("rest.toml", box_scene("position = [0, 0, 0, 0]") + R"(
[[camera.key]]
time = 0.06
up = [0, 1, 0, 0]
[[camera.key]]
time = 0.14
up = [1, 1, 0, 0]
)");
    const auto render = [&](const char* out, const char* channels) {
        return did({"render", scene, "-o", folder.file(out), "--set", "physics.duration=0.35",
                    "--set", fmt::format("render.channels=[{}]", channels)})["render"];
    };
    EXPECT_EQ(render("color", R"("color")")["copied"], 4);
    // Frame 1 looks like frame 0 and moves; frames 3 and 4 look alike, and only 3 has moved.
    EXPECT_EQ(render("motion", R"("color", "motion")")["copied"], 2);
    const auto forward = [&](int frame) {
        return planes_of(folder / "motion" / frame_file("rest", frame))["forward.u"];
    };
    const auto is_still = [](const std::vector<double>& way) {
        return std::all_of(way.begin(), way.end(), [](double v) { return v == 0; });
    };
    EXPECT_TRUE(is_still(forward(0)));
    EXPECT_FALSE(is_still(forward(1)));
    EXPECT_FALSE(is_still(forward(2)));
    EXPECT_TRUE(is_still(forward(3)));
}

}  // namespace
}  // namespace tesserae::scenes::testing
