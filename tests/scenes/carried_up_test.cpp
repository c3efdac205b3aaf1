// SPDX-License-Identifier: Apache-2.0
#include "scenes/carried_up.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "render/camera/camera.hpp"
#include "scenes/camera_path.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

using render::Camera;
using render::CameraDescription;

constexpr double kDegree = std::numbers::pi / 180;

double angle_between(const Vec4& a, const Vec4& b) { return 2 * std::asin(0.5 * (a - b).norm()); }

/// From before the origin over it and round by the angle, 8 m away, looking at it. The highest
/// point is beside the vertical by `offset` radians.
CameraPath over_the_top(double angle, double offset) {
    CameraDescription still;
    still.position = Vec4(8 * std::sin(offset), 0, -8 * std::cos(offset), 0);
    std::vector<CameraKey> keys(1);
    keys[0].time = 10;
    keys[0].orbit = CameraOrbit{Vec4::Zero(), 3, angle};
    return CameraPath(still, keys);
}

double most_turn(const CameraPath& path, double begin, double end, int moments) {
    double most = 0;
    Camera last(path.at(begin), 1, 1);
    for (int i = 1; i <= moments; ++i) {
        const Camera next(path.at(begin + (end - begin) * i / moments), 1, 1);
        most = std::max(most, angle_between(last.right(), next.right()));
        last = next;
    }
    return most;
}

TEST(CarriedUp, DoesNotTurnThePictureAtThePole) {
    for (const double offset : {0.0, 1e-9, 1e-3, -1e-3, 0.05}) {
        const CameraPath path = over_the_top(180, offset);
        // The path goes by 0.0031 rad a moment. Beside the pole by d it must still roll, by some
        // 2 d / 0.26 in all over 0.5 rad of it, 1.5 times as fast in the middle as in the mean.
        EXPECT_LT(most_turn(path, 0, 10, 1000), 0.01 * kDegree + 0.08 * std::abs(offset)) << offset;
        // It comes down upside down, as from an arm.
        EXPECT_LT(angle_between(Camera(path.at(10), 1, 1).up(), -Vec4::UnitY()), 1e-9) << offset;
    }
    // What it is against: made anew from up at each moment, the right axis turns round at once.
    CameraDescription before, after;
    before.position = Vec4(0, 8, -1e-3, 0);
    after.position = Vec4(0, 8, 1e-3, 0);
    EXPECT_GT(angle_between(Camera(before, 1, 1).right(), Camera(after, 1, 1).right()), 3);
}

TEST(CarriedUp, IsContinuousHoweverNearMomentsAre) {
    for (const double offset : {0.0, 1e-9, 1e-3, 0.04}) {
        const CameraPath path = over_the_top(180, offset);
        const double coarse = most_turn(path, 0, 10, 500), fine = most_turn(path, 0, 10, 8000);
        // Twice as much as a steady turn would have: a jump would stay as large as it is.
        EXPECT_LT(fine, 2.0 / 16 * coarse + 1e-7) << offset;
    }
}

TEST(CarriedUp, IsUprightAgainAfterTwoPoles) {
    for (const double offset : {0.0, 1e-9, 1e-3}) {
        const CameraPath path = over_the_top(360, offset);
        EXPECT_LT(most_turn(path, 0, 10, 1000), 0.01 * kDegree + 0.08 * offset);
        EXPECT_LT(angle_between(Camera(path.at(10), 1, 1).up(), Camera(path.at(0), 1, 1).up()),
                  1e-9);
    }
}

/// An up that lies in the view because the slice turns toward it is the same to a camera.
TEST(CarriedUp, HoldsWhereTheFourthAxisPassesUp) {
    std::vector<CameraKey> keys(3);
    for (int i = 0; i < 3; ++i) keys[i].time = i;
    keys[0].fourth = Vec4::UnitW();
    keys[1].fourth = Vec4::UnitY();
    keys[2].fourth = -Vec4::UnitW();
    CameraDescription still;
    still.position = Vec4(0, 0, -8, 0);
    EXPECT_LT(most_turn(CameraPath(still, keys), 0, 2, 1000), 0.01);
}

TEST(CarriedUp, EndsAndBeginsAtThePole) {
    const CameraPath up = over_the_top(90, 0);
    EXPECT_LT(most_turn(up, 0, 10, 1000), 0.01 * kDegree);
    CameraDescription still;
    still.position = Vec4(0, 8, 0, 0);
    std::vector<CameraKey> keys(1);
    keys[0].time = 10;
    keys[0].orbit = CameraOrbit{Vec4::Zero(), 3, 90};
    const CameraPath down(still, keys);
    EXPECT_LT(most_turn(down, 0, 10, 1000), 0.01 * kDegree);
    EXPECT_LT(angle_between(Camera(down.at(10), 1, 1).up(), Vec4::UnitY()), 1e-9);
    EXPECT_EQ(down.at(-1), down.at(0));
}

TEST(CarriedUp, StandsStillWhereThePathDoes) {
    CameraDescription still;
    still.position = Vec4(0.3, 0, -8, 0);
    std::vector<CameraKey> keys(3);
    keys[0].time = 1, keys[0].orbit = CameraOrbit{Vec4::Zero(), 3, 88};
    keys[1].time = 5, keys[1].look_at = Vec4::Zero();
    keys[2].time = 6, keys[2].orbit = CameraOrbit{Vec4::Zero(), 3, 80};
    const CameraPath path(still, keys);
    for (double t = 1; t <= 5; t += 0.25) EXPECT_EQ(path.at(t), path.at(1)) << t;
}

TEST(CarriedUp, LeavesPathsAloneThatStayAwayFromThePole) {
    for (const double offset : {0.06, 0.3}) {  // 3.4 and 17 degrees beside it
        const CameraPath path = over_the_top(180, offset);
        for (double t = 0; t < 10; t += 0.05) EXPECT_EQ(path.at(t).up, Vec4::UnitY());
    }
    // One that looks along up all the time and does not turn.
    CameraDescription still;
    still.up = Vec4(0.1, 1, 0, 0);
    still.position = Vec4(0, 8, -0.01, 0);
    std::vector<CameraKey> keys(2);
    keys[1].time = 1;
    keys[0].field_of_view = 40, keys[1].field_of_view = 20;
    EXPECT_EQ(CameraPath(still, keys).at(0.5).up, still.up);
}

TEST(CarriedUp, LetsAFilmPassThePole) {
    // Frame 15 looks straight down.
    const std::string text =
        "[physics]\nduration = 1\n[camera]\nposition = [0, 0, -8, 0]\n[[camera.key]]\ntime = 1\n"
        "orbit = { about = [0, 0, 0, 0], plane = \"yz\", angle = 180 }\n";
    const Scene scene = load_text(text);
    const CameraPath path = scene.camera_path();
    EXPECT_LT((path.at(0.5).position - Vec4(0, 8, 0, 0)).norm(), 1e-12);
    EXPECT_LT((Camera(path.at(0.5), 1, 1).up() - Vec4::UnitZ()).norm(), 1e-9);
}

}  // namespace
}  // namespace tesserae::scenes
