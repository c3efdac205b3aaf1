// SPDX-License-Identifier: Apache-2.0
// What a trajectory says of joints.
#include "scenes/trajectory/joint_datasets.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "tests/error_of.hpp"
#include "tests/scenes/trajectory/datasets.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;
using tesserae::testing::error_of;

constexpr std::size_t kSomeBodies = 5, kSomeJoints = 4;

class JointDatasets : public ::testing::Test {
  protected:
    void write(const TrajectoryHeader& header, std::uint64_t rows) const {
        TrajectoryWriter writer(path_, header, make_steps(rows), false);
        append_rows(writer, rows, header.bodies, header.joints.size());
        writer.finish();
    }
    void write(std::uint64_t rows, std::size_t joints = kSomeJoints) const {
        fs::remove(path_);
        write(make_header(kSomeBodies, joints), rows);
    }

    const tesserae::testing::TemporaryFolder folder_{"joints"};
    const fs::path path_ = folder_ / "film.h5";
};

/// Whether both have the same bits of every joint.
bool is_same(const JointFacts& a, const JointFacts& b) {
    if (a.broken.size() != b.broken.size()) return false;
    const auto in_a = joint_values(a), in_b = joint_values(b);
    for (std::size_t e = 0; e < kJointElements.size(); ++e)
        if (std::memcmp(in_a[e], in_b[e], a.broken.size() * bytes_of(kJointElements[e])) != 0)
            return false;
    return true;
}

TEST_F(JointDatasets, ReadBackTheBitsWritten) {
    // From one joint to several chunks a row (131,072 numbers fill one).
    for (const std::size_t joints : {1u, 7u, 200'000u}) {
        const std::uint64_t rows = joints > 1000 ? 2 : 70;
        write(rows, joints);
        const TrajectoryReader reader(path_);
        ASSERT_EQ(reader.rows(), rows);
        EXPECT_EQ(reader.header().joints, make_joint_descriptions(joints));
        for (std::uint64_t i = 0; i < rows; ++i)
            EXPECT_TRUE(is_same(reader.joints(i), make_row(i, kSomeBodies, joints).facts.joints))
                << "row " << i;
        EXPECT_EQ(joint_value(reader.joints(1), 2, 0), reader.joints(1).error[0]);
        EXPECT_EQ(reader.facts()[1].kinetic_energy,
                  make_row(1, kSomeBodies, joints).facts.kinetic_energy);
    }
}

TEST_F(JointDatasets, AreElementsWithUnitsAndNames) {
    write(6);
    EXPECT_EQ(texts_of(path_, "/joints/name"),
              (std::vector<std::string>{"d\xc3\xa9j\xc3\xa0", "joint-1", "joint-2", "joint-3"}));
    EXPECT_EQ(texts_of(path_, "/joints/position/unit"),
              (std::vector<std::string>{"", "m", "deg", ""}));
    const auto found = datasets_of(path_);
    EXPECT_EQ(found.at("joints/broken/value").size(), 6 * kSomeJoints);
    EXPECT_EQ(found.at("joints/impulse/value").size(), 6 * kSomeJoints * 8);
    const hdf5::Handle file = hdf5::open_file(path_, false);
    for (const JointElement& element : kJointElements) {
        const std::string path = joint_element_path(element);
        for (const char* shared : {"/step", "/time"})
            EXPECT_EQ(found.at(path.substr(1) + shared),
                      found.at(std::string("particles/bodies/position") + shared));
        const hdf5::Handle value = hdf5::open_dataset(file.get(), path + "/value");
        const bool has_unit = hdf5::has_attribute(value.get(), "unit");
        EXPECT_EQ(has_unit ? hdf5::read_text_attribute(value.get(), "unit") : "", element.unit);
    }
}

TEST_F(JointDatasets, AreInNoFileWithoutJoints) {
    write(6, 0);
    EXPECT_FALSE(datasets_of(path_).contains("joints"));
    {
        const TrajectoryReader reader(path_);
        EXPECT_TRUE(reader.header().joints.empty());
        EXPECT_TRUE(reader.joints(5).impulse.empty());
    }
    // Nor do they change what else is in one.
    auto without = datasets_of(path_);
    write(6);
    auto with = datasets_of(path_);
    ASSERT_FALSE(without.empty());
    std::erase_if(with, [](const auto& entry) { return entry.first.starts_with("joints"); });
    for (auto* all : {&with, &without}) all->erase("parameters/checkpoint");
    EXPECT_EQ(with, without);
}

TEST_F(JointDatasets, OfAnInterruptedRunAreThoseOfAStraightOne) {
    write(30);
    const auto straight = datasets_of(path_);
    fs::remove(path_);
    for (std::uint64_t stop = 0; stop < 30; stop += 3) {
        TrajectoryWriter writer(path_, make_header(kSomeBodies, kSomeJoints), make_steps(30),
                                false);
        if (stop > 3) {
            EXPECT_EQ(writer.note(), "");
            const Row row = make_row(stop - 4, kSomeBodies, kSomeJoints);
            Bodies bodies = row.bodies;
            const auto resume = writer.resume(bodies);
            ASSERT_TRUE(resume);
            EXPECT_EQ(resume->memory.joint_impulses, row.memory.joint_impulses);
            EXPECT_EQ(resume->memory.broken, row.memory.broken);
        }
        append_rows(writer, stop, kSomeBodies, kSomeJoints);
    }
    write(make_header(kSomeBodies, kSomeJoints), 30);
    EXPECT_EQ(datasets_of(path_), straight);
    // A finished one is continued, too.
    write(11);
    write(make_header(kSomeBodies, kSomeJoints), 30);
    EXPECT_EQ(datasets_of(path_), straight);
}

TEST_F(JointDatasets, AContinuedTrajectoryHasTheNamesOfItsScene) {
    TrajectoryHeader other = make_header(kSomeBodies, kSomeJoints);
    other.effective = "other names";
    other.joints[1].name = "a name that is longer than the others";
    for (const auto& [before, after] : {std::pair(make_header(kSomeBodies, kSomeJoints), other),
                                        std::pair(other, make_header(kSomeBodies, kSomeJoints))}) {
        fs::remove(path_);
        write(after, 20);
        const auto straight = datasets_of(path_);
        fs::remove(path_);
        write(before, 10);
        write(after, 20);
        EXPECT_EQ(datasets_of(path_), straight);
        EXPECT_EQ(TrajectoryReader(path_).header().joints, after.joints);
    }
}

TEST_F(JointDatasets, OfAnotherNumberAreOfAnotherMotion) {
    write(6);
    const std::string error = error_of<InputError>(
        [&] { TrajectoryWriter(path_, make_header(kSomeBodies, 3), make_steps(9), false); });
    EXPECT_NE(error.find("has 4 joints, here 3"), std::string::npos) << error;
}

/// A step would read beyond the joints.
TEST_F(JointDatasets, ARecordOfOtherPartsIsNotUsed) {
    const std::function<void(StepMemory&)> changes[] = {
        [](StepMemory&) {}, [](StepMemory& m) { m.joint_impulses.emplace_back(); },
        [](StepMemory& m) { m.joint_impulses.pop_back(); },
        [](StepMemory& m) { m.broken.resize(kSomeJoints + 1); },
        [](StepMemory& m) { m.broken.resize(1); }};
    for (std::size_t i = 0; i < std::size(changes); ++i) {
        fs::remove(folder_ / "film.h5.partial");
        {
            // The first row is flushed with its record, the others go with the last one's.
            TrajectoryWriter writer(path_, make_header(kSomeBodies, kSomeJoints), make_steps(9),
                                    false);
            append_rows(writer, 7, kSomeBodies, kSomeJoints);
            Row row = make_row(7, kSomeBodies, kSomeJoints);
            changes[i](row.memory);
            writer.append(row.facts, row.bodies, row.memory);
        }
        const TrajectoryWriter writer(path_, make_header(kSomeBodies, kSomeJoints), make_steps(9),
                                      false);
        EXPECT_EQ(writer.rows(), i == 0 ? 8u : 1u) << i << ": " << writer.note();
    }
}

TEST_F(JointDatasets, RefuseWhatIsNotOfTheJoints) {
    struct Bad {
        const char* replaced;               ///< taken out first
        std::function<void(hid_t)> damage;  ///< put in its place
        const char* expected;               ///< in the message
    };
    constexpr const char *kImpulse = "/joints/impulse/value", *kBroken = "/joints/broken/value",
                         *kNames = "/joints/name", *kUnits = "/joints/position/unit";
    const hsize_t huge = 1'000'000'000'000;
    const Bad cases[] = {
        {"/joints", [](hid_t) {}, "doesn't exist"},
        {kImpulse, [](hid_t) {}, "doesn't exist"},
        {kNames, [](hid_t) {}, "doesn't exist"},
        {kUnits, [](hid_t f) { H5Lcreate_soft(kNames, f, kUnits, H5P_DEFAULT, H5P_DEFAULT); },
         "link to another place"},
        {kImpulse,
         [](hid_t f) {
             make_dataset(f, kImpulse, H5T_IEEE_F64LE, {6, 5}, 1);
         },
         "another shape"},
        {kImpulse, [](hid_t f) { make_dataset(f, kImpulse, H5T_IEEE_F64LE, {24}, 1); },
         "another shape"},
        {kImpulse,
         [=](hid_t f) {
             make_dataset(f, kImpulse, H5T_IEEE_F64LE, {huge, 4}, 1);
         },
         "claims to hold more"},
        {kBroken,
         [](hid_t f) {
             make_dataset(f, kBroken, H5T_IEEE_F64LE, {6, 4}, 1);
         },
         "not of bytes"},
        {kBroken,
         [](hid_t f) {
             make_dataset(f, kBroken, H5T_STD_I64LE, {6, 4}, 1);
         },
         "not of bytes"},
        {kNames, [](hid_t f) { make_dataset(f, kNames, H5T_STD_I64LE, {4}, 1); }, "not of texts"},
        {kNames, [](hid_t f) { make_text(f, kNames, 8); }, kNames},
        {kNames,
         [](hid_t f) {
             const hid_t type = H5Tcopy(H5T_C_S1);
             H5Tset_size(type, H5T_VARIABLE);
             make_dataset(f, kNames, type, {4}, 1);
             H5Tclose(type);
         },
         "not of texts of a fixed length"},
        {kNames,
         [](hid_t f) {
             const hid_t type = H5Tcopy(H5T_C_S1);
             H5Tset_size(type, 1u << 30);
             make_dataset(f, kNames, type, {4}, 0);
             H5Tclose(type);
         },
         "claims to hold more"}};
    write(6);
    const fs::path good = folder_ / "good.h5";
    fs::rename(path_, good);
    for (const Bad& bad : cases) {
        fs::copy_file(good, path_, fs::copy_options::overwrite_existing);
        const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        ASSERT_GE(H5Ldelete(file, bad.replaced, H5P_DEFAULT), 0);
        bad.damage(file);
        ASSERT_GE(H5Fclose(file), 0);
        const std::string error = error_of<InputError>([&] { TrajectoryReader reader(path_); });
        EXPECT_NE(error.find(bad.expected), std::string::npos)
            << bad.replaced << ": \"" << error << "\", expected \"" << bad.expected << "\"";
    }
}

TEST_F(JointDatasets, RefuseNumbersThatAFileCannotHold) {
    write(6);
    for (const std::int64_t joints : {std::int64_t{3}, std::int64_t{5}, std::int64_t{1} << 60}) {
        const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        ASSERT_GE(file, 0);
        const hid_t scene = H5Gopen2(file, "/parameters/scene", H5P_DEFAULT);
        ASSERT_GE(H5Adelete(scene, "joints"), 0);
        const hid_t space = H5Screate(H5S_SCALAR);
        const hid_t attribute =
            H5Acreate2(scene, "joints", H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT);
        ASSERT_GE(H5Awrite(attribute, H5T_NATIVE_INT64, &joints), 0);
        H5Aclose(attribute), H5Sclose(space), H5Gclose(scene);
        ASSERT_GE(H5Fclose(file), 0);
        const std::string error = error_of<InputError>([&] { TrajectoryReader reader(path_); });
        EXPECT_NE(error.find("/joints"), std::string::npos) << joints << ": " << error;
    }
}

}  // namespace
}  // namespace tesserae::scenes
