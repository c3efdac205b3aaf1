// SPDX-License-Identifier: Apache-2.0
#include "scenes/camera_orbit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "scenes/camera_path.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

constexpr Ease kAllEases[] = {Ease::kLinear, Ease::kIn, Ease::kOut, Ease::kInOut};
constexpr double kRadiansADegree = std::numbers::pi / 180;

/// The part of the way, from the integral of a speed that is even, grows, shrinks, or does both.
double part_of_way(Ease ease, double t) {
    switch (ease) {
        case Ease::kIn:
            return t * t;
        case Ease::kOut:
            return 1 - (1 - t) * (1 - t);
        case Ease::kInOut:
            return 3 * t * t - 2 * t * t * t;
        case Ease::kLinear:
            break;
    }
    return t;
}

std::vector<CameraKey> orbit_of(const CameraOrbit& orbit, const Vec4& from, Ease ease) {
    std::vector<CameraKey> keys(2);
    keys[0].time = 0.5;
    keys[0].position = from;
    keys[1].time = 2.5;
    keys[1].orbit = orbit;
    keys[1].ease = ease;
    return keys;
}

/// By the rotor exp(-B/2) of the plane's bivector, as bodies are turned.
Vec4 by_rotor(const Vec4& from, const Vec4& about, std::size_t plane, double degrees) {
    Bivector b;
    double* const parts[] = {&b.xy, &b.xz, &b.xw, &b.yz, &b.yw, &b.zw};
    *parts[plane] = degrees * kRadiansADegree;
    return about + to_matrix(exp(-0.5 * b)) * (from - about);
}

TEST(CameraOrbit, IsRoundInAllPlanesWithEaseAndSeveralTurns) {
    const Vec4 from(1, 2, -8, 0.5), about(0.25, -1, 0.5, 2);
    for (std::size_t plane = 0; plane < 6; ++plane)
        for (const Ease ease : kAllEases)
            for (const double angle : {90.0, -135.0, 360.0, 1234.5}) {
                const CameraOrbit orbit = {about, plane, angle};
                const auto keys = orbit_of(orbit, from, ease);
                const CameraPath path({}, keys);
                for (int i = 0; i <= 200; ++i) {
                    const double t = i / 200.0;
                    const Vec4 at = path.at(0.5 + 2 * t).position;
                    // Rounding: of the radius, and of an angle of up to four turns.
                    EXPECT_NEAR((at - about).norm(), (from - about).norm(), 1e-14);
                    const Vec4 expected =
                        by_rotor(from, about, plane, angle * part_of_way(ease, t));
                    EXPECT_LT((at - expected).norm(), 5e-13)
                        << "plane " << plane << " angle " << angle << " t " << t;
                }
            }
}

TEST(CameraOrbit, HasOneSpeedUnlessItEases) {
    const Vec4 from(0, 2, -8, 0);
    const CameraOrbit orbit = {Vec4(0, 2, 0, 0), 1, 270};
    const double h = 1e-4, speed = 8 * 270 * kRadiansADegree / 2;
    for (const Ease ease : kAllEases) {
        const CameraPath path({}, orbit_of(orbit, from, ease));
        for (double t = 0.6; t < 2.4; t += 0.1) {
            const double part = (t - 0.5) / 2;
            const double slope =
                (part_of_way(ease, part + h) - part_of_way(ease, part - h)) / (2 * h);
            const double measured =
                (path.at(t + h).position - path.at(t - h).position).norm() / (2 * h);
            EXPECT_NEAR(measured, speed * slope, 1e-5 * speed) << t;
        }
    }
}

/// Four quarters by keys of position shrink a radius of 8 m to 6.2 m.
TEST(CameraOrbit, OfFourQuartersIsOneTurn) {
    std::vector<CameraKey> keys(5);
    for (int i = 0; i < 5; ++i) {
        keys[i].time = i;
        if (i > 0) keys[i].orbit = CameraOrbit{Vec4(0, 2, 0, 0), 1, 90};
    }
    keys[0].position = Vec4(0, 2, -8, 0);
    const CameraPath path({}, keys);
    for (double t = 0; t < 4; t += 0.01)
        EXPECT_LT((path.at(t).position - Vec4(8 * std::sin(90 * t * kRadiansADegree), 2,
                                              -8 * std::cos(90 * t * kRadiansADegree), 0))
                      .norm(),
                  1e-13);
    EXPECT_EQ(path.at(4).position, *keys[0].position);
    EXPECT_EQ(path.at(9).position, *keys[0].position);
}

TEST(CameraOrbit, BeginsWhereTheKeyBeforeLeftTheCamera) {
    const CameraOrbit quarter = {Vec4::Zero(), 1, 90};
    render::CameraDescription still;
    still.position = Vec4(0, 2, -8, 0);
    std::vector<CameraKey> keys(1);
    keys[0].time = 2;
    keys[0].orbit = quarter;
    // Without a key before it: from [camera], in the time from 0 on.
    EXPECT_EQ(CameraPath(still, keys).at(-1).position, still.position);
    EXPECT_LT(
        (CameraPath(still, keys).at(1).position - by_rotor(still.position, Vec4::Zero(), 1, 45))
            .norm(),
        1e-14);
    // A key before that says nothing of the position: it stands still until then.
    CameraKey first;
    first.time = 1;
    first.look_at = Vec4(0, 1, 0, 0);
    keys.insert(keys.begin(), first);
    EXPECT_EQ(CameraPath(still, keys).at(1).position, still.position);
    EXPECT_LT(
        (CameraPath(still, keys).at(1.5).position - by_rotor(still.position, Vec4::Zero(), 1, 45))
            .norm(),
        1e-14);
    EXPECT_EQ(CameraPath(still, keys).at(1.5).look_at, *first.look_at);
}

TEST(CameraOrbit, MeetsOtherKeysWithoutAKink) {
    std::vector<CameraKey> keys(4);
    for (int i = 0; i < 4; ++i) keys[i].time = 1.5 * i;
    keys[0].position = Vec4(3, 0, -9, 1);
    keys[1].position = Vec4(0, 2, -8, 0);
    keys[2].orbit = CameraOrbit{Vec4(0, 2, 0, 0), 1, 100};
    keys[3].position = Vec4(20, 5, 3, 1);
    const CameraPath path({}, keys);
    // Second differences fall with the square of the step; of a kink only with the step.
    const auto bend = [&](double t, double h) {
        return (path.at(t - h).position - 2 * path.at(t).position + path.at(t + h).position).norm();
    };
    for (const double t : {1.5, 3.0}) EXPECT_LT(bend(t, 5e-5) / bend(t, 1e-4), 0.3) << t;
    // Where the camera stays behind an orbit, it stands still.
    keys[3].position = path.at(3).position;
    const CameraPath staying({}, keys);
    for (double t = 3; t <= 4.5; t += 0.125) EXPECT_EQ(staying.at(t).position, *keys[3].position);
}

TEST(CameraOrbit, IsReadFromASceneAndWrittenBack) {
    const std::string text =
        "[physics]\nduration = 2\n[camera]\nposition = [0, 0, -5, 0]\n[[camera.key]]\ntime = 2\n"
        "orbit = { about = [0, 1, 0, 0], plane = \"xz\", angle = 450 }\n";
    const Scene scene = load_text(text + "ease = \"in-out\"\n");
    ASSERT_EQ(scene.camera_keys.size(), 1u);
    const CameraKey& key = scene.camera_keys[0];
    ASSERT_TRUE(key.orbit);
    EXPECT_EQ(key.orbit->about, Vec4(0, 1, 0, 0));
    EXPECT_EQ(key.orbit->plane, 1u);
    EXPECT_EQ(key.orbit->angle, 450);
    EXPECT_EQ(key.ease, Ease::kInOut);
    EXPECT_EQ(load_text(scene.effective).effective, scene.effective);
    // What is said by default is not written.
    EXPECT_EQ(load_text(text + "ease = \"linear\"\n").hash, load_text(text).hash);
    EXPECT_NE(load_text(text).hash, scene.hash);
}

TEST(CameraOrbit, AloneHasAnEase) {
    const std::string without =
        error_of("[[camera.key]]\ntime = 1\nposition = [0, 0, -5, 0]\nease = \"in\"\n");
    EXPECT_TRUE(without.starts_with("test.toml:4:8: ")) << without;
    EXPECT_NE(without.find("this key has none"), std::string::npos) << without;
    const std::string misspelt = error_of(
        "[[camera.key]]\ntime = 1\nease = \"inout\"\n"
        "orbit = { about = [0, 0, 0, 0], plane = \"xz\", angle = 90 }\n");
    EXPECT_NE(misspelt.find("did you mean \"in-out\"?"), std::string::npos) << misspelt;
}

}  // namespace
}  // namespace tesserae::scenes
