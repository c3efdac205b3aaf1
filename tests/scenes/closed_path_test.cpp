// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/camera/camera.hpp"
#include "scenes/camera_path.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

/// An uneven round trip of all parts; some keys name only some of them.
std::vector<CameraKey> round_trip() {
    std::vector<CameraKey> keys(6);
    const double times[] = {0.5, 1.25, 2, 3.5, 4, 6};
    const Vec4 positions[] = {
        {0, 1, -8, 0}, {6, 3, -5, 1}, {8, 1, 2, 0}, {0, 2, 7, -1}, {-6, 0, 1, 0}};
    for (int i = 0; i < 6; ++i) {
        keys[i].time = times[i];
        keys[i].position = positions[i % 5];
    }
    keys[1].look_at = Vec4(1, 0, 0, 0), keys[4].look_at = Vec4(0, 0, 1, 0.5);
    keys[0].fourth = keys[5].fourth = Vec4(0, 0, 0, 1);
    keys[2].fourth = Vec4(0.6, 0, 0, 0.8);
    keys[0].field_of_view = 40, keys[3].field_of_view = 60;
    return keys;
}

double view_change(const render::CameraDescription& a, const render::CameraDescription& b) {
    return (a.position - b.position).norm() + (a.look_at - b.look_at).norm() +
           (a.fourth - b.fourth).norm() + std::abs(a.field_of_view - b.field_of_view);
}

render::CameraDescription view_rate(const CameraPath& path, double from, double to) {
    const auto a = path.at(from), b = path.at(to);
    render::CameraDescription d;
    d.position = (b.position - a.position) / (to - from);
    d.look_at = (b.look_at - a.look_at) / (to - from);
    d.fourth = (b.fourth - a.fourth) / (to - from);
    d.field_of_view = (b.field_of_view - a.field_of_view) / (to - from);
    return d;
}

TEST(ClosedPath, PassesItsJointWithoutAKink) {
    const std::vector<CameraKey> keys = round_trip();
    const CameraPath closed({}, keys, true), open({}, keys);
    const double h = 1e-5;
    EXPECT_LT(view_change(closed.at(0.5), closed.at(6)), 1e-12);
    // The velocity changes by the acceleration times h, some 20 times h here.
    EXPECT_LT(view_change(view_rate(closed, 6 - h, 6), view_rate(closed, 0.5, 0.5 + h)), 1e-3);
    // It is not at rest there.
    EXPECT_GT(view_rate(closed, 6 - h, 6).position.norm(), 1);
    // An open one has a kink.
    EXPECT_GT(view_change(view_rate(open, 6 - h, 6), view_rate(open, 0.5, 0.5 + h)), 1);
    // It goes through its keys.
    for (const CameraKey& key : keys)
        EXPECT_LT((closed.at(key.time).position - *key.position).norm(), 1e-12);
}

TEST(ClosedPath, GoesOnRoundBeforeAndAfter) {
    const CameraPath path({}, round_trip(), true);
    const double h = 1e-5;
    for (const double t : {0.5, 1.0, 2.5, 5.9}) {
        EXPECT_LT(view_change(path.at(t), path.at(t + 5.5)), 1e-11) << t;
        EXPECT_LT(view_change(path.at(t), path.at(t - 11)), 1e-11) << t;
    }
    for (const double joint : {0.5, 6.0, 11.5})
        EXPECT_LT(view_change(view_rate(path, joint - h, joint), view_rate(path, joint, joint + h)),
                  1e-3);
}

/// Where the first key is does not matter.
TEST(ClosedPath, HasNoFavouredKey) {
    std::vector<CameraKey> keys = round_trip();
    const CameraPath path({}, keys, true);
    std::vector<CameraKey> later(keys.begin() + 2, keys.end() - 1);
    for (int i = 0; i < 3; ++i) {
        later.push_back(keys[i]);
        later.back().time += 5.5;
    }
    const CameraPath same({}, later, true);
    for (double t = 2; t < 7.5; t += 0.05)
        EXPECT_LT(view_change(path.at(t), same.at(t)), 1e-11) << t;
}

TEST(ClosedPath, MayBeMadeOfOrbits) {
    std::vector<CameraKey> keys(3);
    for (int i = 0; i < 3; ++i) keys[i].time = i;
    keys[0].position = Vec4(0, 2, -8, 0);
    keys[1].orbit = keys[2].orbit = CameraOrbit{Vec4::Zero(), 2, 180};
    keys[0].position = Vec4(3, 2, -8, 0.1);
    EXPECT_EQ(open_ends({}, keys), "");
    const CameraPath path({}, keys, true);
    const double h = 1e-6;
    EXPECT_LT(view_change(view_rate(path, 2 - h, 2), view_rate(path, 2, 2 + h)), 1e-3);
    // Half of it an orbit, half a spline.
    keys[2].orbit.reset();
    keys[2].position = keys[0].position;
    const CameraPath half({}, keys, true);
    for (const double joint : {0.0, 1.0, 2.0})
        EXPECT_LT(view_change(view_rate(half, joint - h, joint), view_rate(half, joint, joint + h)),
                  1e-3);
}

constexpr const char* kRoundTrip =
    "[physics]\nduration = 2\n[camera]\nclosed = true\n"
    "[[camera.key]]\ntime = 0\nposition = [0, 2, -8, 0]\n"
    "[[camera.key]]\ntime = 1\nposition = [4, 2, -8, 0]\n";

TEST(ClosedPath, IsReadAndWrittenBack) {
    const std::string text =
        std::string(kRoundTrip) + "[[camera.key]]\ntime = 2\nposition = [0, 2, -8, 0]\n";
    const Scene scene = load_text(text);
    EXPECT_TRUE(scene.camera_motion.closed);
    EXPECT_EQ(load_text(scene.effective).hash, scene.hash);
    EXPECT_EQ(load_text(text, {"camera.closed=false"}).effective.find("closed"), std::string::npos);
}

TEST(ClosedPath, SaysWhatIsOpen) {
    const auto expect = [](const std::string& text, const std::vector<const char*>& words) {
        const std::string error = error_of(text);
        for (const char* word : words)
            EXPECT_NE(error.find(word), std::string::npos) << word << " in: " << error;
    };
    expect(kRoundTrip, {"test.toml:4:10", "ends with the position [4, 2, -8, 0]",
                        "begins with [0, 2, -8, 0]", "that has the position of the first"});
    expect("[camera]\nclosed = true\n", {"2:10", "two [[camera.key]] or more"});
    expect(
        "[camera]\nclosed = true\n[[camera.key]]\ntime = 1\n"
        "orbit = { about = [0, 0, 0, 0], plane = \"xz\", angle = 360 }\n"
        "[[camera.key]]\ntime = 2\nposition = [0, 2, -8, 0]\n",
        {"2:10", "the first [[camera.key]] is an orbit"});
    expect(
        "[physics]\n[camera]\nclosed = true\n"
        "[[camera.key]]\ntime = 0\nposition = [0, 0, -8, 0]\n"
        "[[camera.key]]\ntime = 1\norbit = { about = [0, 0, 0, 0], plane = \"yz\", angle = 180 }\n"
        "[[camera.key]]\ntime = 2\norbit = { about = [0, 0, 0, 0], plane = \"xz\", angle = 180 }\n",
        {"turned by 180 degrees when the path comes back"});
}

}  // namespace
}  // namespace tesserae::scenes
