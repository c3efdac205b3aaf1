// SPDX-License-Identifier: Apache-2.0
// Finished files that are continued for longer.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <sstream>

#include "core/error.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/trajectory/datasets.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;
using tesserae::testing::error_of;

constexpr std::size_t kBodies = 9;
constexpr std::uint64_t kRows = 40;

/// The scene whose trajectory has so many rows: all but its motion changes with them.
TrajectoryHeader header_of(std::uint64_t rows) {
    TrajectoryHeader header = make_header(kBodies);
    header.source = "# rows " + std::to_string(rows);
    header.effective = "[physics]\nduration = " + std::to_string(rows) + "\n";
    header.hash = std::to_string(rows);
    return header;
}

std::string content_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// In order, whatever lists they are in.
std::vector<KeptManifold> kept_of(const StepMemory& memory) {
    std::vector<KeptManifold> all;
    for (const KeptManifolds& list : memory.kept)
        for (const auto& manifold : list) all.push_back(*manifold);
    return all;
}

class TrajectoryContinue : public ::testing::Test {
  protected:
    TrajectoryWriter open(std::uint64_t rows, bool overwrite = false) const {
        return {path_, header_of(rows), make_steps(rows), overwrite};
    }
    void simulate(std::uint64_t rows) const {
        TrajectoryWriter writer = open(rows);
        append_rows(writer, rows, kBodies);
        writer.finish();
    }
    /// The file of one straight run of kRows.
    fs::path straight() const {
        const fs::path path = folder_ / "straight.h5";
        TrajectoryWriter writer(path, header_of(kRows), make_steps(kRows), false);
        append_rows(writer, kRows, kBodies);
        writer.finish();
        return path;
    }

    const tesserae::testing::TemporaryFolder folder_{"continue"};
    const fs::path path_ = folder_ / "film.h5", partial_ = folder_ / "film.h5.partial";
};

TEST_F(TrajectoryContinue, EndsWithTheBytesOfOneStraightRun) {
    const fs::path expected = straight();
    const std::vector<std::vector<std::uint64_t>> runs = {{1}, {2}, {20}, {39}, {1, 2, 3, 30, 31}};
    for (const auto& ends : runs) {
        fs::remove(path_);
        for (std::uint64_t end : ends) simulate(end);
        {
            const TrajectoryWriter writer = open(kRows);
            ASSERT_EQ(writer.rows(), ends.back()) << writer.note();
            EXPECT_EQ(writer.note(), "");
            Bodies bodies = make_row(9999, kBodies).bodies;
            const auto resume = writer.resume(bodies);
            const Row row = make_row(ends.back() - 1, kBodies);
            ASSERT_TRUE(resume.has_value());
            EXPECT_EQ(resume->step, row.facts.step);
            EXPECT_EQ(resume->memory.time, row.memory.time);
            EXPECT_EQ(resume->memory.asleep, row.memory.asleep);
            EXPECT_EQ(resume->memory.still, row.memory.still);
            ASSERT_EQ(resume->memory.impulses.size(), row.memory.impulses.size());
            for (std::size_t i = 0; i < row.memory.impulses.size(); ++i)
                EXPECT_EQ(resume->memory.impulses[i].slope, row.memory.impulses[i].slope);
            EXPECT_EQ(resume->memory.angular_impulses, row.memory.angular_impulses);
            const auto kept = kept_of(resume->memory), expected_kept = kept_of(row.memory);
            ASSERT_EQ(kept.size(), expected_kept.size());
            for (std::size_t i = 0; i < kept.size(); ++i) {
                EXPECT_EQ(kept[i].a, expected_kept[i].a);
                EXPECT_EQ(kept[i].b, expected_kept[i].b);
                EXPECT_EQ(kept[i].offset, expected_kept[i].offset);
                EXPECT_TRUE(kept[i].rotor == expected_kept[i].rotor);
                EXPECT_EQ(kept[i].keeps, KeptManifold::Keeps::kUnknown);
            }
            EXPECT_EQ(bodies.rotor, row.bodies.rotor);
        }
        simulate(kRows);
        EXPECT_EQ(different_datasets(path_, expected), "") << ends.size() << " " << ends.back();
        EXPECT_FALSE(fs::exists(partial_));
    }
}

TEST_F(TrajectoryContinue, TheFinishedFileStaysWholeUntilTheRename) {
    simulate(20);
    const std::string before = content_of(path_);
    {
        TrajectoryWriter writer = open(kRows);
        append_rows(writer, 35, kBodies);
        writer.flush();
        EXPECT_EQ(content_of(path_), before);
        EXPECT_EQ(TrajectoryReader(partial_).rows(), 35u);
    }
    EXPECT_EQ(content_of(path_), before);
    // The next run goes on with what is further, and an interrupted one may be stopped again.
    EXPECT_EQ(open(kRows).rows(), 35u);
    simulate(kRows);
    EXPECT_EQ(different_datasets(path_, straight()), "");
}

TEST_F(TrajectoryContinue, ACopyThatWasCutIsMadeAgain) {
    simulate(20);
    const std::string whole = content_of(path_);
    for (std::size_t bytes = 0; bytes < whole.size(); bytes += 1 + whole.size() / 40) {
        std::ofstream(partial_, std::ios::binary) << whole.substr(0, bytes);
        const TrajectoryWriter writer = open(kRows);
        EXPECT_EQ(writer.rows(), 20u) << bytes;
        EXPECT_EQ(writer.note(), "");
    }
    simulate(kRows);
    EXPECT_EQ(different_datasets(path_, straight()), "");
}

TEST_F(TrajectoryContinue, ALeftoverThatIsBehindGivesWay) {
    {
        TrajectoryWriter writer = open(kRows);
        append_rows(writer, 7, kBodies);
    }
    fs::rename(partial_, folder_ / "behind");
    simulate(20);
    fs::rename(folder_ / "behind", partial_);
    EXPECT_EQ(open(kRows).rows(), 20u);
}

TEST_F(TrajectoryContinue, RefusesAnotherMotionOtherStepsAndLess) {
    simulate(20);
    const std::string before = content_of(path_);
    const auto refused = [&](const TrajectoryHeader& header, std::vector<std::uint64_t> steps) {
        const std::string error =
            error_of<InputError>([&] { TrajectoryWriter(path_, header, std::move(steps), false); });
        EXPECT_EQ(error.find(path_.string() + ": "), 0u) << error;
        EXPECT_NE(error.find("--overwrite"), std::string::npos) << error;
        return error;
    };
    TrajectoryHeader other = header_of(kRows);
    other.motion_hash = "89ab";
    other.effective = "[physics]\nduration = 9\nseed = 7\n";
    const std::string motion = refused(other, make_steps(kRows));
    EXPECT_NE(motion.find("another motion: physics: nothing there, seed = 7 here"),
              std::string::npos)
        << motion;
    TrajectoryHeader every = header_of(kRows);
    every.store_every = 0;
    EXPECT_NE(refused(every, make_steps(kRows)).find("every 3. step"), std::string::npos);
    std::vector<std::uint64_t> finer = make_steps(kRows);
    for (std::uint64_t& step : finer) step = step / 3 * 2;
    EXPECT_NE(refused(header_of(kRows), finer).find("row 1 is of step 3, here of step 2"),
              std::string::npos);
    const std::string less = refused(header_of(7), make_steps(7));
    EXPECT_NE(less.find("goes on to step 57 in 20 rows, here to step 18 in 7"), std::string::npos)
        << less;
    EXPECT_NE(less.find("physics.duration: 20 there, 7 here"), std::string::npos) << less;
    EXPECT_EQ(content_of(path_), before);
    // --overwrite replaces these, and nothing that serves.
    EXPECT_EQ(open(kRows, true).rows(), 20u);
    EXPECT_EQ(TrajectoryWriter(path_, every, make_steps(kRows), true).rows(), 0u);
}

TEST_F(TrajectoryContinue, StartsAnewWithoutAGoodRecordAndSaysSo) {
    simulate(20);
    {
        const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        const hid_t record = H5Dopen2(file, "/parameters/checkpoint", H5P_DEFAULT);
        const hid_t space = H5Dget_space(record);
        std::string bytes(H5Sget_simple_extent_npoints(space), '\0');
        H5Dread(record, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
        bytes[bytes.size() / 2] ^= 1;
        H5Dwrite(record, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
        H5Sclose(space);
        H5Dclose(record);
        H5Fclose(file);
    }
    TrajectoryWriter writer = open(kRows);
    EXPECT_EQ(writer.rows(), 0u);
    EXPECT_NE(writer.note().find("holds no row that can be continued from; starting anew"),
              std::string::npos)
        << writer.note();
    append_rows(writer, kRows, kBodies);
    writer.finish();
    EXPECT_EQ(different_datasets(path_, straight()), "");
}

}  // namespace
}  // namespace tesserae::scenes
