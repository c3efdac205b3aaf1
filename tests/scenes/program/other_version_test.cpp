// SPDX-License-Identifier: Apache-2.0
// Files that another version of the law of motion, or of pictures, has made.
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <nlohmann/json.hpp>

#include "core/dynamics/motion_version.hpp"
#include "render/picture_version.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/load.hpp"
#include "scenes/load/versions.hpp"
#include "scenes/trajectory/trajectory.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kOther = kMotionVersion + 1;

/// Makes a trajectory one that was moved by another motion version.
void set_motion_version(const fs::path& path, int version) {
    const std::string hash = motion_hash(TrajectoryReader(path).header().effective, version);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t scene = H5Gopen2(file, "/parameters/scene", H5P_DEFAULT);
    const hid_t attribute = H5Aopen(scene, "motion_version", H5P_DEFAULT);
    EXPECT_GE(H5Awrite(attribute, H5T_NATIVE_INT, &version), 0);
    H5Aclose(attribute);
    H5Gclose(scene);
    const hid_t text = H5Dopen2(file, "/parameters/scene/motion_hash", H5P_DEFAULT);
    const hid_t type = H5Dget_type(text);
    EXPECT_EQ(H5Tget_size(type), hash.size());
    EXPECT_GE(H5Dwrite(text, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, hash.data()), 0);
    H5Tclose(type);
    H5Dclose(text);
    EXPECT_GE(H5Fclose(file), 0);
}

nlohmann::json info_of(const std::string& file) {
    const Outcome info = tesserae({"info", file, "--json"});
    EXPECT_EQ(info.status, 0) << info.err;
    return nlohmann::json::parse(info.out);
}

/// A folder with a film whose trajectory is of another motion version than its frames.
class OtherVersion : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(tesserae({"run", scene_, "-o", out_}).status, 0);
        EXPECT_EQ(info_of(trajectory_).at("motion version"), kMotionVersion);
        set_motion_version(trajectory_, kOther);
    }
    void expect_refused(const std::vector<std::string>& words) const {
        const Outcome outcome = tesserae(words);
        EXPECT_EQ(outcome.status, 2) << words[0];
        const std::string expected =
            other_motion_version(kOther, kMotionVersion) + "; choose another file, or --overwrite";
        EXPECT_NE(outcome.err.find(expected), std::string::npos) << outcome.err;
    }

    const Folder folder_{"versions"};
    const std::string scene_ = folder_.write("drop.toml", small_scene(0.15));
    const std::string out_ = folder_.file("out"), trajectory_ = out_ + "/trajectory.h5";
};

TEST_F(OtherVersion, ATrajectoryOfAnotherMotionVersionIsNotContinued) {
    EXPECT_EQ(info_of(trajectory_).at("motion version"), kOther);
    const std::string before = content(trajectory_);
    expect_refused({"simulate", scene_, "-o", trajectory_});
    expect_refused({"simulate", scene_, "-o", trajectory_, "--set", "physics.duration=1"});
    expect_refused({"run", scene_, "-o", out_});
    EXPECT_EQ(content(trajectory_), before);
    // Nor is an unfinished one.
    const std::string other = folder_.file("other.h5");
    fs::copy_file(trajectory_, other + ".partial");
    expect_refused({"simulate", scene_, "-o", other});
    EXPECT_EQ(content(other + ".partial"), before);
    // What differs in the scene is named first.
    const Outcome both =
        tesserae({"simulate", scene_, "-o", trajectory_, "--set", "physics.seed=9"});
    EXPECT_EQ(both.status, 2);
    EXPECT_NE(both.err.find("physics.seed: 1 there, 9 here"), std::string::npos) << both.err;

    ASSERT_EQ(tesserae({"simulate", scene_, "-o", trajectory_, "--overwrite"}).status, 0);
    EXPECT_EQ(info_of(trajectory_).at("motion version"), kMotionVersion);
}

TEST_F(OtherVersion, ATrajectoryOfAnotherMotionVersionIsRendered) {
    const std::string film = folder_.file("film");
    const std::vector<std::string> render = {"render", scene_, "--trajectory", trajectory_, "-o"};
    const auto into = [&](const std::string& folder) {
        std::vector<std::string> words = render;
        words.insert(words.end(), {folder, "--json"});
        return tesserae(words);
    };
    const Outcome rendered = into(film);
    ASSERT_EQ(rendered.status, 0) << rendered.err;
    const auto frame = info_of(film + "/frames/drop.0001.exr");
    EXPECT_EQ(frame.at("motion version"), kOther);
    EXPECT_EQ(frame.at("tesserae/sceneHash"),
              frame_hash(without_duration(load_scene(scene_, {}).effective),
                         render::kPictureVersion, kOther));
    EXPECT_EQ(nlohmann::json::parse(into(film).out).at("render").at("kept"), 3);
    // Frames of both are not mixed.
    const Outcome mixed = into(out_);
    EXPECT_EQ(mixed.status, 2);
    EXPECT_NE(mixed.err.find(fmt::format(
                  "drop.0000.exr: shows bodies moved by motion version {}, here by version {}",
                  kMotionVersion, kOther)),
              std::string::npos)
        << mixed.err;
}

TEST_F(OtherVersion, AVersionThatCannotBeIsRefused) {
    set_motion_version(trajectory_, 0);
    const Outcome info = tesserae({"info", trajectory_});
    EXPECT_EQ(info.status, 2);
    EXPECT_NE(info.err.find("motion_version"), std::string::npos) << info.err;
}

TEST(OtherPictureVersion, FramesOfAnotherAreNotMixedWithOurs) {
    const Folder folder("pictures");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    const std::string out = folder.file("out"), frame = out + "/frames/drop.0001.exr";
    ASSERT_EQ(tesserae({"run", scene, "-o", out}).status, 0);
    {
        const int other = render::kPictureVersion + 1;
        Imf::TiledInputFile in(frame.c_str());
        Imf::Header header = in.header();
        header.insert("tesserae/pictureVersion", Imf::IntAttribute(other));
        header.insert("tesserae/sceneHash",
                      Imf::StringAttribute(
                          frame_hash(load_scene(scene, {}).effective, other, kMotionVersion)));
        Imf::TiledOutputFile((frame + ".other").c_str(), header).copyPixels(in);
    }
    fs::rename(frame + ".other", frame);
    const Outcome again = tesserae({"run", scene, "-o", out});
    EXPECT_EQ(again.status, 2);
    EXPECT_NE(again.err.find(fmt::format("drop.0001.exr: is a frame of picture version {}, this "
                                         "program makes version {}",
                                         render::kPictureVersion + 1, render::kPictureVersion)),
              std::string::npos)
        << again.err;
    EXPECT_EQ(tesserae({"run", scene, "-o", out, "--overwrite"}).status, 0);
}

}  // namespace
}  // namespace tesserae::scenes::testing
