// SPDX-License-Identifier: Apache-2.0
// A page's joints: which it draws, where they are on its bodies, and when they are broken.
#include "scenes/view/page_joints.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/error_of.hpp"
#include "tests/scenes/load/load_scene_text.hpp"
#include "tests/scenes/trajectory/datasets.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

std::string ball(const std::string& name, double x, const std::string& more = "") {
    return fmt::format(
        "[[body]]\nname = \"{}\"\nshape = \"hypersphere\"\nradius = 0.25\nposition = [{}, 0, 0, "
        "0]\n{}\n",
        name, x, more);
}

std::string point(const std::string& a, const std::string& b, double x) {
    return fmt::format("[[joint]]\ntype = \"point\"\na = \"{}\"\n{}anchor = [{}, 0, 0, 0]\n", a,
                       b.empty() ? "" : "b = \"" + b + "\"\n", x);
}

std::vector<BodyTrack> tracks_of(const Scene& scene) {
    return PoseRanges(scene.bodies, scene.appearance, scene.materials).tracks();
}

TEST(PageJoints, AreFastenedToBodiesOrToTheWorld) {
    const Scene scene = load_text(
        "[[body]]\nshape = \"hyperplane\"\nname = \"floor\"\nnormal = [0, 1, 0, 0]\noffset = -1\n" +
        ball("a", 1) + ball("b", 2) +
        ball("nail", 3,
             "fixed = [\"position\", \"rotation\"]\nvisible = false\nrotation = { xy = 90 }") +
        ball("hidden", 4, "visible = false") + point("a", "", 0.5) + point("b", "a", 1.5) +
        point("b", "floor", 2.5) + point("floor", "a", 0.75) + point("nail", "b", 3.5) +
        point("b", "hidden", 3.5) + point("hidden", "nail", 3.5) + point("hidden", "", 3.5));
    const std::vector<PageJoint> joints = page_joints(scene, tracks_of(scene));

    // In the page the floor is body 0, a 1 and b 2.
    struct Wanted {
        std::size_t number;
        std::uint32_t a, b;
        double on_a, on_b;  // along x
    };
    const Wanted wanted[] = {{0, kAtWorld, 1, 0.5, -0.5}, {1, 2, 1, -0.5, 0.5},
                             {2, kAtWorld, 2, 2.5, 0.5},  {3, kAtWorld, 1, 0.75, -0.25},
                             {4, kAtWorld, 2, 3.5, 1.5},  {5, kNotInPage, 2, -0.5, 1.5}};
    ASSERT_EQ(joints.size(), std::size(wanted));
    for (std::size_t i = 0; i < joints.size(); ++i) {
        EXPECT_EQ(joints[i].number, wanted[i].number) << i;
        EXPECT_EQ(joints[i].a, wanted[i].a) << i;
        EXPECT_EQ(joints[i].b, wanted[i].b) << i;
        EXPECT_NEAR((joints[i].on_a - Vec4(wanted[i].on_a, 0, 0, 0)).norm(), 0, 1e-12) << i;
        EXPECT_NEAR((joints[i].on_b - Vec4(wanted[i].on_b, 0, 0, 0)).norm(), 0, 1e-12) << i;
    }
}

TEST(PageJoints, OfBodiesThatAreLeftOutAreLeftOut) {
    const Scene scene = load_text(ball("a", 1) + ball("b", 2) + ball("c", 3) +
                                  point("a", "b", 1.5) + point("b", "c", 2.5));
    const std::vector<BodyTrack> all = tracks_of(scene);
    const std::vector<PageJoint> joints = page_joints(scene, {all[2]});
    ASSERT_EQ(joints.size(), 1u);
    EXPECT_EQ(joints[0].number, 1u);
    EXPECT_EQ(joints[0].a, kNotInPage);
    EXPECT_EQ(joints[0].b, 0u);
    EXPECT_TRUE(page_joints(scene, {}).empty());
}

/// The page's script finds the lists by the number of joints alone.
TEST(PageJoints, ArePackedAsThePageReadsThem) {
    std::vector<PageJoint> joints(3);
    for (std::uint32_t i = 0; i < 3; ++i) {
        joints[i].a = 10 + i, joints[i].b = 20 + i, joints[i].broken_at = 30 + i;
        joints[i].on_a = Vec4::Constant(1e9 + i), joints[i].on_b = Vec4::Constant(0.5 + i);
    }
    const std::string bytes = joint_bytes(joints);
    ASSERT_EQ(bytes.size(), 3 * kPageJointBytes);
    const auto number = [&]<class T>(T value, std::size_t at) {
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return value;
    };
    for (std::uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(number(0.0, 32 * i), 1e9 + i);
        EXPECT_EQ(number(0.0f, 3 * 32 + 16 * i + 12), 0.5f + static_cast<float>(i));
        EXPECT_EQ(number(0u, 3 * 48 + 4 * i), 10 + i);
        EXPECT_EQ(number(0u, 3 * 52 + 4 * i), 20 + i);
        EXPECT_EQ(number(0u, 3 * 56 + 4 * i), 30 + i);
    }
}

/// A ball of one colour looks the same however it is turned, but what hangs beside its centre does
/// not; and an arm is shown as exactly as the rim.
TEST(PageJoints, HaveThePageStoreHowTheirBodiesTurn) {
    Scene scene = load_text(ball("a", 0) + ball("b", 0.5) + ball("c", 9) + point("a", "b", 0.5) +
                            point("c", "", 29));
    PoseRanges ranges(scene.bodies, scene.appearance, scene.materials);
    show_anchors(scene, ranges);
    const render::Camera camera({.position = {0, 0, -50, 0}}, 640, 360);
    for (int moment = 0; moment < 2; ++moment) {
        ranges.add(scene.bodies, camera);
        for (Rotor& rotor : scene.bodies.rotor) rotor = exp(Bivector{0.3, 0, 0, 0, 0, 0});
    }
    const auto bits = [&](std::size_t track) {
        return static_cast<int>(grid_of(ranges.tracks()[track]).bits[kPositionNumbers]);
    };
    EXPECT_GT(bits(0), 0);
    EXPECT_EQ(bits(1), 0) << "its joint is at its centre";
    EXPECT_GE(bits(2), bits(0) + 4) << "its joint is 40 times as far from it";
}

constexpr std::size_t kBodies = 5, kJoints = 4;

/// A trajectory of made-up rows. Of its joints the last one is broken from row 5 on.
class BrokenPageJoints : public ::testing::Test {
  protected:
    void SetUp() override {
        TrajectoryWriter writer(path_, make_header(kBodies, kJoints), make_steps(9), false);
        append_rows(writer, 9, kBodies, kJoints);
        writer.finish();
        scene_.joints.resize(kJoints);
    }
    std::vector<std::uint32_t> found(const std::vector<std::uint64_t>& steps) const {
        std::vector<PageJoint> joints(kJoints);
        for (std::size_t i = 0; i < kJoints; ++i) joints[i].number = i;
        find_broken(joints, scene_, path_, steps);
        std::vector<std::uint32_t> at;
        for (const PageJoint& joint : joints) at.push_back(joint.broken_at);
        return at;
    }

    const tesserae::testing::TemporaryFolder folder_{"page_joints"};
    const fs::path path_ = folder_ / "film.h5";
    Scene scene_;
};

TEST_F(BrokenPageJoints, AreKnownByTheFirstMoment) {
    constexpr std::uint32_t kNever = 0xffffffff;
    const auto last = [&](std::uint32_t at) {
        return std::vector<std::uint32_t>{kNever, kNever, kNever, at};
    };
    EXPECT_EQ(found(make_steps(9)), last(5));
    EXPECT_EQ(found(make_steps(6)), last(5));
    EXPECT_EQ(found(make_steps(5)), last(kNever));
    EXPECT_EQ(found({0, 12, 18, 18, 24}), last(2));
    EXPECT_EQ(found({21, 24}), last(0));
    EXPECT_EQ(found({15}), last(0));
}

TEST_F(BrokenPageJoints, OfAnotherNumberAreRefused) {
    scene_.joints.resize(kJoints + 1);
    const std::string error = tesserae::testing::error_of<InputError>([&] { found({0}); });
    EXPECT_NE(error.find("holds 4 joints, the scene has 5"), std::string::npos) << error;
}

TEST_F(BrokenPageJoints, ThatCannotBeReadAreRefused) {
    constexpr const char* kBroken = "/joints/broken/value";
    const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(H5Ldelete(file, kBroken, H5P_DEFAULT), 0);
    ASSERT_GE(H5Fclose(file), 0);
    const std::string error = tesserae::testing::error_of<InputError>([&] { found({0}); });
    EXPECT_NE(error.find("not a readable trajectory"), std::string::npos) << error;
    EXPECT_NE(error.find("doesn't exist"), std::string::npos) << error;
}

}  // namespace
}  // namespace tesserae::scenes
