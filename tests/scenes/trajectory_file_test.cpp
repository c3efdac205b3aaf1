// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "scenes/scene_file.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/trajectory/datasets.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae {
namespace {

constexpr const char* kFall = R"(
physics = { duration = 0.1, gravity = [0, -8, 0, 0] }
body = [{ name = "floor", shape = "hyperplane", normal = [0, 1, 0, 0], offset = -9 },
        { name = "stone", shape = "hypersphere", radius = 1, mass = 3, velocity = [1, 0, 0, 2] }]
)";

class TrajectoryOfTheLibrary : public ::testing::Test {
  protected:
    void SetUp() override { Scene::parse(kFall).simulate(file_, {.store_every = 6}); }

    const testing::TemporaryFolder folder_{"trajectory"};
    const std::filesystem::path file_ = folder_ / "fall.h5";
};

TEST_F(TrajectoryOfTheLibrary, TellsOfBodiesAndSteps) {
    const Trajectory trajectory(file_);
    EXPECT_EQ(trajectory.bodies(), 2u);
    EXPECT_EQ(trajectory.names(), (std::vector<std::string>{"floor", "stone"}));
    const std::vector<double> masses = trajectory.masses();
    ASSERT_EQ(masses.size(), 2u);
    EXPECT_TRUE(std::isinf(masses[0]));
    EXPECT_EQ(masses[1], 3);
    EXPECT_EQ(trajectory.scene_name(), "scene");
    const Scene scene = Scene::parse(trajectory.scene_text());
    EXPECT_EQ(scene.motion_hash(), trajectory.motion_hash());
    EXPECT_EQ(scene.motion_hash(), Scene::parse(kFall).motion_hash());

    ASSERT_EQ(trajectory.size(), 5u);
    BodyArrays last = trajectory.state(0);
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
        EXPECT_EQ(trajectory.steps()[i], 6 * i);
        const double t = trajectory.times()[i];
        EXPECT_DOUBLE_EQ(t, 6.0 * static_cast<double>(i) / 240);
        const BodyArrays state = trajectory.state(i);
        // It falls freely, which the midpoint rule has exactly but for rounding.
        const Vec4 expected(t, -4 * t * t, 0, 2 * t);
        EXPECT_LT((state.position[1] - expected).norm(), 1e-12) << "at " << t;
        EXPECT_LT((state.velocity[1] - Vec4(1, -8 * t, 0, 2)).norm(), 1e-12) << "at " << t;
        last = state;
    }
    // What was read before is its own.
    EXPECT_GT(last.position[1][0], 0.09);
}

TEST_F(TrajectoryOfTheLibrary, OutlivesItsCopiesAndKeepsStatesAlive) {
    BodyArrays state;
    {
        const Trajectory copy = Trajectory(file_);
        state = copy.state(4);
    }
    EXPECT_LT(std::abs(state.position[1][3] - 0.2), 1e-12);
}

TEST_F(TrajectoryOfTheLibrary, RefusesWhatItCannotTell) {
    const Trajectory trajectory(file_);
    EXPECT_EQ(testing::error_of<InputError>([&] { trajectory.state(5); }),
              file_.string() + ": stored step 5: the trajectory has 5");
    EXPECT_NE(testing::error_of<InputError>([&] { Trajectory(folder_ / "none.h5"); }), "");
}

/// Makes a dataset of the bodies anew, of ones.
void replace(const std::filesystem::path& file, const char* name, hid_t type,
             const std::vector<hsize_t>& extent) {
    const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(H5Ldelete(id, name, H5P_DEFAULT), 0);
    scenes::make_dataset(id, name, type, extent, 0);
    const std::vector<double> values(extent[0], 1);
    const hid_t dataset = H5Dopen2(id, name, H5P_DEFAULT);
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(dataset);
    H5Fclose(id);
}

TEST_F(TrajectoryOfTheLibrary, RefusesNamesAndMassesOfAnotherForm) {
    const auto failure = [&](auto read) {
        const Trajectory trajectory(file_);
        return testing::error_of<InputError>([&] { read(trajectory); });
    };
    const auto names = [](const Trajectory& t) { t.names(); };
    const auto masses = [](const Trajectory& t) { t.masses(); };
    EXPECT_EQ(failure(names), "");
    const std::string before = file_.string() + ": not a readable trajectory: /particles/bodies/";
    replace(file_, "/particles/bodies/name", H5T_NATIVE_DOUBLE, {2});
    EXPECT_EQ(failure(names), before + "name: is not of texts of a fixed length");
    replace(file_, "/particles/bodies/mass", H5T_NATIVE_INT, {2});
    EXPECT_EQ(failure(masses), before + "mass: is not of reals");
    replace(file_, "/particles/bodies/mass", H5T_NATIVE_DOUBLE, {3});
    EXPECT_EQ(failure(masses), before + "mass: has another shape");
}

}  // namespace
}  // namespace tesserae
