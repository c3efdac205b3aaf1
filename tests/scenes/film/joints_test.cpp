// SPDX-License-Identifier: Apache-2.0
// What simulating stores of joints.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "parallel/threads.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/trajectory/trajectory.hpp"
#include "tests/scenes/trajectory/datasets.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

constexpr double kLoad = 2;  ///< mass of what hangs [kg]

/// A load that hangs from a held body by a rod, a wheel that turns on a hinge by 1 rad/s, and a
/// weight on a point that bears less than it weighs.
Scene jointed_scene(double duration) {
    Scene scene;
    scene.name = "joints", scene.motion_hash = "89ab";
    scene.physics.emplace().duration = duration;
    Bodies& bodies = scene.bodies;
    BodyType held{Hypersphere{0.1}};
    held.fixed_position = held.fixed_rotation = true;
    bodies.types = {held, {Hypersphere{0.1}, kLoad}, {Hypersphere{0.5}, 1}};
    const std::pair<std::uint32_t, Vec4> placed[] = {
        {0, {0, 0, 0, 0}}, {1, {0, -1, 0, 0}}, {2, {5, 0, 0, 0}}, {2, {9, 0, 0, 0}}};
    for (const auto& [type, position] : placed) {
        scene.names.push_back({"body", static_cast<BodyId>(bodies.size())});
        bodies.type.push_back(type);
        bodies.position.push_back(position);
        bodies.rotor.emplace_back();
        bodies.velocity.push_back(Vec4::Zero());
        bodies.angular_velocity.emplace_back();
    }
    bodies.angular_velocity[2].xy = 1;

    Joint rod, hinge, weak;
    rod.a = 0, rod.b = 1;
    rod.kind = LineJoint{.length = 1};
    hinge.b = 2;
    hinge.kind = FrameJoint{{5, 0, 0, 0}, Vec4::Zero(), Rotor(), Rotor()};
    hinge.held = kAllHeld & ~(1 << 4);  // the angle of xy is free
    weak.b = 3;
    weak.kind = PointJoint{.on_a = {9, 0, 0, 0}};
    weak.break_force = 1;
    scene.joints = {rod, hinge, weak};
    scene.joint_names = {"rod", "hinge", "weak"};
    return scene;
}

class StoredJoints : public ::testing::Test {
  protected:
    void store(const fs::path& file, double duration) const {
        const Scene scene = jointed_scene(duration);
        Plan plan;
        plan.moves = true;
        parallel::Threads(2).run(
            [&] { simulate(scene, plan, file, {.store_every = 1, .quiet = true}); });
    }

    const tesserae::testing::TemporaryFolder folder_{"joints"};
    const fs::path path_ = folder_ / "film.h5";
};

TEST_F(StoredJoints, TellLoadsErrorsPositionsAndWhatBroke) {
    store(path_, 0.5);
    const TrajectoryReader reader(path_);
    EXPECT_EQ(reader.header().joints,
              (std::vector<JointDescription>{{"rod", ""}, {"hinge", "deg"}, {"weak", ""}}));
    ASSERT_EQ(reader.rows(), 121u);
    for (std::uint64_t row = 0; row < reader.rows(); ++row) {
        const JointFacts facts = reader.joints(row);
        // The load's weight over a step; its rod keeps its length.
        EXPECT_NEAR(facts.impulse[0], row == 0 ? 0 : kLoad * 10 / 240, 1e-6) << row;
        EXPECT_NEAR(facts.error[0], 0, 1e-6) << row;
        EXPECT_TRUE(std::isnan(facts.position[0])) << row;
        // The wheel turns steadily: half an angle in degrees is far below a turn.
        const double turned = reader.times()[row] * 180 / std::numbers::pi;
        EXPECT_NEAR(std::abs(facts.position[1]), turned, 1e-6) << row;
        EXPECT_NEAR(facts.error[1], 0, 1e-6) << row;
        EXPECT_NEAR(facts.angular_error[1], 0, 1e-6) << row;
        // The first step breaks the weak one, on which nothing acts from then on.
        EXPECT_EQ(facts.broken, (std::vector<std::uint8_t>{0, 0, row > 0})) << row;
        if (row != 1) {
            EXPECT_EQ(facts.impulse[2], 0) << row;
        }
        if (row > 10) {
            EXPECT_GT(facts.error[2], 0.005) << row;
        }
    }
}

TEST_F(StoredJoints, AreTheSameWhereARunIsContinued) {
    const fs::path straight = folder_ / "straight.h5";
    store(straight, 0.5);
    for (const double first : {1 / 240.0, 0.2}) {
        fs::remove(path_);
        store(path_, first);
        store(path_, 0.5);
        EXPECT_EQ(different_datasets(path_, straight), "") << first;
    }
}

}  // namespace
}  // namespace tesserae::scenes
