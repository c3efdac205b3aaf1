// SPDX-License-Identifier: Apache-2.0
#include "scenes/camera_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <random>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

constexpr double kRounding = 1e-12;

using Random = std::mt19937_64;

render::CameraDescription camera_at(const render::CameraDescription& still,
                                    std::span<const CameraKey> keys, double time) {
    return CameraPath(still, keys).at(time);
}

Vec4 random_vector(Random& random) {
    std::normal_distribution<double> normal;
    return {normal(random), normal(random), normal(random), normal(random)};
}

std::vector<CameraKey> keys_at(std::initializer_list<double> times) {
    std::vector<CameraKey> keys;
    for (const double time : times) keys.emplace_back().time = time;
    return keys;
}

std::vector<CameraKey> random_keys(Random& random, int count) {
    std::vector<CameraKey> keys;
    double time = 0;
    for (int i = 0; i < count; ++i) {
        CameraKey& key = keys.emplace_back();
        key.time = time += std::uniform_real_distribution<double>(0.1, 2)(random);
        key.position = random_vector(random);
        key.look_at = random_vector(random);
        key.up = random_vector(random).normalized();
        key.fourth = random_vector(random).normalized();
        key.field_of_view = std::uniform_real_distribution<double>(10, 90)(random);
    }
    return keys;
}

TEST(CameraPath, MeetsItsKeysAndStandsStillOutside) {
    Random random(1);
    auto keys = random_keys(random, 6);
    for (CameraKey& key : keys) {
        // Far from looking along up.
        key.look_at = *key.position + 10 * Vec4::UnitZ();
        key.up = (6 * Vec4::UnitY() + random_vector(random)).normalized();
        key.fourth = (6 * Vec4::UnitW() + random_vector(random)).normalized();
    }
    const CameraPath path({}, keys);
    for (const CameraKey& key : keys) {
        const auto camera = path.at(key.time);
        EXPECT_LT((camera.position - *key.position).norm(), kRounding);
        EXPECT_LT((camera.look_at - *key.look_at).norm(), kRounding);
        EXPECT_LT((camera.up - *key.up).norm(), kRounding);
        EXPECT_LT((camera.fourth - *key.fourth).norm(), kRounding);
        EXPECT_NEAR(camera.field_of_view, *key.field_of_view, kRounding * 90);
    }
    EXPECT_EQ(path.at(-5).position, *keys.front().position);
    EXPECT_EQ(path.at(1e9).fourth, *keys.back().fourth);
}

TEST(CameraPath, TwoKeysMoveEvenly) {
    Random random(2);
    const auto keys = random_keys(random, 2);
    const CameraKey &a = keys[0], &b = keys[1];
    const double angle = std::acos(a.fourth->dot(*b.fourth));
    const CameraPath path({}, keys);
    for (const double t : {0.1, 0.25, 0.5, 0.8}) {
        const auto camera = path.at(a.time + t * (b.time - a.time));
        EXPECT_LT((camera.position - (*a.position + t * (*b.position - *a.position))).norm(),
                  kRounding);
        // Along the great arc, by its part of the angle.
        const Vec4 on_arc = std::sin((1 - t) * angle) / std::sin(angle) * *a.fourth +
                            std::sin(t * angle) / std::sin(angle) * *b.fourth;
        EXPECT_LT((camera.fourth - on_arc).norm(), 1e-11);
    }
}

TEST(CameraPath, FollowsParabolasAndSteadyTurnsThroughUnevenKeys) {
    auto keys = keys_at({0, 0.7, 1.1, 2.5, 3});
    const Vec4 c0(1, 2, 3, 4), c1(-1, 0.5, 2, 1), c2(0.3, -0.2, 0.1, 1);
    const auto parabola = [&](double t) -> Vec4 { return c0 + t * c1 + t * t * c2; };
    const auto turned = [](double t) { return Vec4(std::cos(t), 0, std::sin(t), 0); };
    for (CameraKey& key : keys) {
        key.position = parabola(key.time);
        key.fourth = turned(key.time);
    }
    const CameraPath path({}, keys);
    // The parabola between inner keys, where the slopes have neighbours on both sides.
    for (double t = 0.7; t < 2.5; t += 0.1)
        EXPECT_LT((path.at(t).position - parabola(t)).norm(), kRounding) << t;
    for (double t = 0; t < 3; t += 0.1)
        EXPECT_LT((path.at(t).fourth - turned(t)).norm(), kRounding) << t;
}

TEST(CameraPath, HasNoKinks) {
    Random random(3);
    const auto keys = random_keys(random, 7);
    const CameraPath path({}, keys);
    // Second differences of a smooth path fall with the square of the step, of a kink only with
    // the step: halving it tells them apart.
    const auto bend = [&](const CameraKey& key, double h) {
        const auto at = [&](double t) { return path.at(t); };
        const auto a = at(key.time - h), b = at(key.time), c = at(key.time + h);
        return (a.position - 2 * b.position + c.position).norm() +
               (a.fourth - 2 * b.fourth + c.fourth).norm();
    };
    for (std::size_t i = 1; i + 1 < keys.size(); ++i)
        EXPECT_LT(bend(keys[i], 5e-5) / bend(keys[i], 1e-4), 0.3) << i;
}

TEST(CameraPath, StaysBetweenEqualKeys) {
    auto keys = keys_at({0, 1, 2, 3});
    const Vec4 rest(1, 2, 3, 4);
    keys[0].position = Vec4(0, 0, 0, 0);
    keys[1].position = keys[2].position = rest;
    keys[3].position = Vec4(5, 0, 0, 0);
    const CameraPath path({}, keys);
    for (double t = 1; t <= 2; t += 0.125) EXPECT_EQ(path.at(t).position, rest);
}

TEST(CameraPath, DoesNotDependOnTheAxes) {
    Random random(4);
    const auto keys = random_keys(random, 5);
    const Mat4 turn = to_matrix(exp(Bivector{0.3, -1, 2, 0.7, 0.1, -0.4}));
    auto turned = keys;
    for (CameraKey& key : turned)
        for (auto part :
             {&CameraKey::position, &CameraKey::look_at, &CameraKey::up, &CameraKey::fourth})
            if (key.*part) key.*part = Vec4(turn * *(key.*part));
    const CameraPath path({}, keys), turned_path({}, turned);
    for (double t = 0; t < keys.back().time; t += 0.07) {
        const auto a = path.at(t), b = turned_path.at(t);
        EXPECT_LT((turn * a.position - b.position).norm(), 1e-11);
        EXPECT_LT((turn * a.up - b.up).norm(), 1e-9);
        EXPECT_NEAR(a.up.norm(), 1, kRounding);
    }
}

TEST(CameraPath, PartsWithoutKeysStayAsTheyAre) {
    auto keys = keys_at({1, 2});
    keys[0].field_of_view = 20;
    keys[1].position = Vec4(9, 9, 9, 9);
    render::CameraDescription still;
    still.look_at = Vec4(1, 2, 3, 4);
    const auto camera = camera_at(still, keys, 1.5);
    EXPECT_EQ(camera.look_at, still.look_at);
    EXPECT_EQ(camera.field_of_view, 20);
    EXPECT_EQ(camera.position, Vec4(9, 9, 9, 9));
}

TEST(CameraPath, IsReadFromASceneAndWrittenBack) {
    const std::string text =
        "[physics]\nduration = 2\n[camera]\nposition = [0, 0, -5, 0]\n"
        "[[camera.key]]\ntime = 0\nfourth = [0, 0, 0, 2]\n"
        "[[camera.key]]\ntime = 2\nfourth = [3, 0, 0, 3]\nfield_of_view = 30\n";
    const Scene scene = load_text(text);
    ASSERT_EQ(scene.camera_keys.size(), 2u);
    EXPECT_EQ(scene.camera_keys[0].fourth, Vec4::UnitW());
    EXPECT_EQ(scene.camera_keys[1].field_of_view, 30);
    EXPECT_FALSE(scene.camera_keys[0].position);
    const Scene again = load_text(scene.effective);
    EXPECT_EQ(again.effective, scene.effective);
    EXPECT_EQ(again.camera_keys.size(), 2u);
}

TEST(CameraPath, RefusesAFrameWithoutAxes) {
    // Turning the fourth axis from w through z passes the forward direction, at frame 15.
    const std::string error = error_of(
        "[physics]\nduration = 1\n[camera]\nposition = [0, 0, -5, 0]\n"
        "look_at = [0, 0, 0, 0]\n[[camera.key]]\ntime = 0\nfourth = [0, 0, 0, 1]\n"
        "[[camera.key]]\ntime = 0.5\nfourth = [0, 0, 1, 0]\n"
        "[[camera.key]]\ntime = 1\nfourth = [0, 0, 0, -1]\n");
    EXPECT_NE(error.find("frame 15 at 0.5 s"), std::string::npos) << error;
    EXPECT_NE(error.find("parallel to the forward direction"), std::string::npos) << error;
}

/// A film's cameras are all checked when its scene is read: if each took as long as there are keys,
/// these would take minutes.
TEST(CameraPath, OfManyKeysIsReadAtOnce) {
    constexpr int kKeys = 10'000, kFrames = 500'000;
    std::string text = fmt::format(
        "[physics]\nduration = {}\n[render]\nframes_per_second = 100\n"
        "[[body]]\nshape = \"hypersphere\"\nradius = 1\n",
        kFrames / 100);
    for (int i = 0; i < kKeys; ++i)
        text += fmt::format("[[camera.key]]\ntime = {}\nposition = [0, {}, -8, 0]\n", 0.5 * i,
                            1 + i % 2);
    const std::clock_t begin = std::clock();  // of this process alone
    EXPECT_EQ(load_text(text).camera_keys.size(), std::size_t{kKeys});
    EXPECT_LT(std::clock() - begin, 20 * CLOCKS_PER_SEC);
}

}  // namespace
}  // namespace tesserae::scenes
