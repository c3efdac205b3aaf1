// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory/trajectory.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <thread>

#include "core/error.hpp"
#include "tests/child_process.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/trajectory/datasets.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;
using tesserae::testing::error_of;
using tesserae::testing::status_of_child;

class TrajectoryTest : public ::testing::Test {
  protected:
    void write_whole(std::uint64_t rows, std::size_t bodies) {
        fs::remove(path_);
        TrajectoryWriter writer(path_, make_header(bodies), make_steps(rows), false);
        append_rows(writer, rows, bodies);
        writer.finish();
    }
    void expect_killed_runs_end_alike(int rounds);
    void expect_damage_is_met(int files);

    const tesserae::testing::TemporaryFolder folder_{"trajectory"};
    const fs::path path_ = folder_ / "film.h5", partial_ = folder_ / "film.h5.partial";
};
using TrajectoryTestSlow = TrajectoryTest;

void expect_rows(const TrajectoryReader& reader, std::uint64_t begin, std::size_t bodies) {
    const std::vector<StepFacts> facts = reader.facts();
    Bodies read = make_row(9999, bodies).bodies;
    for (std::uint64_t i = begin; i < reader.rows(); ++i) {
        const Row row = make_row(i, bodies);
        reader.read_row(i, read);
        const auto same = [](const auto& a, const auto& b) {
            return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
        };
        EXPECT_TRUE(same(read.position, row.bodies.position)) << "row " << i;
        EXPECT_TRUE(same(read.rotor, row.bodies.rotor)) << "row " << i;
        EXPECT_TRUE(same(read.velocity, row.bodies.velocity)) << "row " << i;
        EXPECT_TRUE(same(read.angular_velocity, row.bodies.angular_velocity)) << "row " << i;
        EXPECT_EQ(reader.steps()[i], row.facts.step);
        EXPECT_EQ(reader.times()[i], row.facts.time);
        EXPECT_EQ(facts[i].report.contacts, row.facts.report.contacts);
        EXPECT_EQ(facts[i].report.penetration, row.facts.report.penetration);
        EXPECT_EQ(facts[i].report.mean_penetration, row.facts.report.mean_penetration);
        EXPECT_EQ(facts[i].report.residual, row.facts.report.residual);
        EXPECT_EQ(facts[i].report.sweeps, row.facts.report.sweeps);
        EXPECT_EQ(facts[i].report.asleep, row.facts.report.asleep);
        EXPECT_EQ(facts[i].kinetic_energy, row.facts.kinetic_energy);
        EXPECT_EQ(facts[i].potential_energy, row.facts.potential_energy);
        EXPECT_EQ(facts[i].momentum, row.facts.momentum);
        EXPECT_EQ(facts[i].angular_momentum, row.facts.angular_momentum);
    }
}

TEST_F(TrajectoryTest, ReadsBackTheBitsWritten) {
    // From no body at all to several chunks a row (32768 positions fill one).
    for (const unsigned bodies : {0u, 1u, 7u, 40'000u}) {
        const std::uint64_t rows = bodies > 1000 ? 2 : 70;
        write_whole(rows, bodies);
        EXPECT_FALSE(fs::exists(partial_));
        const TrajectoryReader reader(path_);
        ASSERT_EQ(reader.rows(), rows);
        const TrajectoryHeader header = make_header(bodies);
        EXPECT_EQ(reader.header().scene_name, header.scene_name);
        EXPECT_EQ(reader.header().source, header.source);
        EXPECT_EQ(reader.header().effective, header.effective);
        EXPECT_EQ(reader.header().hash, header.hash);
        EXPECT_EQ(reader.header().motion_hash, header.motion_hash);
        EXPECT_EQ(reader.header().program_version, header.program_version);
        EXPECT_EQ(reader.header().bodies, bodies);
        EXPECT_EQ(reader.header().steps_per_second, 240);
        EXPECT_EQ(reader.header().store_every, 3u);
        expect_rows(reader, 0, bodies);
    }
}

TEST_F(TrajectoryTest, FollowsH5md) {
    write_whole(5, 7);
    const auto found = datasets_of(path_);
    for (const char* name :
         {"h5md/modules/tesserae", "h5md/author", "h5md/creator", "particles/bodies/box",
          "particles/bodies/id", "parameters/scene/text"})
        EXPECT_TRUE(found.contains(name)) << name;
    EXPECT_FALSE(found.contains("parameters/resume"));
    EXPECT_EQ(found.at("parameters/scene/hash"), "0123");
    const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    int version[2] = {}, dimension = 0;
    hid_t attribute = H5Aopen_by_name(file, "/h5md", "version", H5P_DEFAULT, H5P_DEFAULT);
    H5Aread(attribute, H5T_NATIVE_INT, version);
    H5Aclose(attribute);
    EXPECT_TRUE(version[0] == 1 && version[1] == 1);
    attribute =
        H5Aopen_by_name(file, "/particles/bodies/box", "dimension", H5P_DEFAULT, H5P_DEFAULT);
    H5Aread(attribute, H5T_NATIVE_INT, &dimension);
    H5Aclose(attribute);
    EXPECT_EQ(dimension, 4);
    // One dataset of steps under thirteen names, as H5MD asks of what was stored together.
    for (const char* shared : {"step", "time"}) {
        const auto address = [&](const std::string& element) {
            // An old call, but one that HDF5 1.10 and 1.14 have alike.
            H5G_stat_t object;
            H5Gget_objinfo(file, (element + "/" + shared).c_str(), false, &object);
            EXPECT_EQ(object.nlink, 14u);
            return std::pair(object.objno[0], object.objno[1]);
        };
        EXPECT_EQ(address("/particles/bodies/rotor"), address("/observables/contacts"));
    }
    const hid_t rotor = H5Dopen2(file, "/particles/bodies/rotor/value", H5P_DEFAULT);
    const hid_t space = H5Dget_space(rotor);
    hsize_t extent[3] = {};
    ASSERT_EQ(H5Sget_simple_extent_dims(space, extent, nullptr), 3);
    EXPECT_TRUE(extent[0] == 5 && extent[1] == 7 && extent[2] == 8);
    H5Sclose(space);
    H5Dclose(rotor);
    H5Fclose(file);
}

TEST_F(TrajectoryTest, AnInterruptedRunEndsWithTheSameBytes) {
    write_whole(40, 9);
    const auto straight = datasets_of(path_);
    fs::remove(path_);
    for (std::uint64_t stop = 0; stop < 40; stop += 3) {
        TrajectoryWriter writer(path_, make_header(9), make_steps(40), false);
        if (stop > 3) {
            // What the run goes on from is the last row, with its memory.
            EXPECT_EQ(writer.note(), "");
            ASSERT_EQ(writer.rows(), stop - 3);
            Bodies bodies = make_row(9999, 9).bodies;
            const auto resume = writer.resume(bodies);
            const Row row = make_row(stop - 4, 9);
            ASSERT_TRUE(resume.has_value());
            EXPECT_EQ(resume->step, row.facts.step);
            EXPECT_EQ(resume->memory.time, row.memory.time);
            EXPECT_EQ(resume->memory.asleep, row.memory.asleep);
            EXPECT_EQ(resume->memory.still, row.memory.still);
            ASSERT_EQ(resume->memory.impulses.size(), row.memory.impulses.size());
            for (std::size_t i = 0; i < row.memory.impulses.size(); ++i) {
                EXPECT_EQ(resume->memory.impulses[i].normal, row.memory.impulses[i].normal);
                EXPECT_EQ(resume->memory.impulses[i].slope, row.memory.impulses[i].slope);
                EXPECT_EQ(resume->memory.impulses[i].feature, row.memory.impulses[i].feature);
            }
            EXPECT_EQ(bodies.position, row.bodies.position);
            EXPECT_EQ(bodies.rotor, row.bodies.rotor);
        }
        append_rows(writer, stop, 9);
    }
    TrajectoryWriter writer(path_, make_header(9), make_steps(40), false);
    append_rows(writer, 40, 9);
    writer.finish();
    EXPECT_EQ(datasets_of(path_), straight);
}

void TrajectoryTest::expect_killed_runs_end_alike(int rounds) {
    // Killed at random times, while creating, appending, flushing and finishing. The child flushes
    // often because it reopens the file every few rows.
    constexpr std::uint64_t kManyRows = 60;
    write_whole(kManyRows, 9);
    const auto straight = datasets_of(path_);
    std::mt19937_64 random(7);
    int killed = 0, anew = 0;
    for (int round = 0; round < rounds; ++round) {
        fs::remove(path_);
        const pid_t child = ::fork();
        if (child == 0) {
            for (std::uint64_t end = 1; end <= kManyRows; end += 3) {
                TrajectoryWriter writer(path_, make_header(9), make_steps(kManyRows), false);
                append_rows(writer, std::max(end, writer.rows()), 9);
            }
            TrajectoryWriter writer(path_, make_header(9), make_steps(kManyRows), false);
            append_rows(writer, kManyRows, 9);
            writer.finish();
            ::_exit(0);
        }
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 60'000));
        ::kill(child, SIGKILL);
        int status = 0;
        ::waitpid(child, &status, 0);
        if (!WIFSIGNALED(status)) continue;
        ++killed;
        if (fs::exists(path_)) continue;
        TrajectoryWriter writer(path_, make_header(9), make_steps(kManyRows), false);
        anew += !writer.note().empty();
        append_rows(writer, kManyRows, 9);
        writer.finish();
        ASSERT_EQ(datasets_of(path_), straight) << "round " << round;
    }
    EXPECT_GE(killed, rounds / 4);
    std::cout << killed << " killed, " << anew << " of them started anew\n";
}

TEST_F(TrajectoryTest, AKilledRunEndsWithTheSameBytes) { expect_killed_runs_end_alike(12); }
TEST_F(TrajectoryTestSlow, AKilledRunEndsWithTheSameBytes) { expect_killed_runs_end_alike(40); }

TEST_F(TrajectoryTest, AKillBetweenFlushesKeepsTheLastFlush) {
    const int status = status_of_child([&] {
        TrajectoryWriter writer(path_, make_header(900), make_steps(500), false);
        const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(2300);
        for (std::uint64_t i = 0; i < 500 && std::chrono::steady_clock::now() < end; ++i) {
            append_rows(writer, i + 1, 900);
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return ::raise(SIGKILL);
    });
    ASSERT_EQ(status, -SIGKILL);
    std::uint64_t rows = 0;
    {
        const TrajectoryReader reader(partial_);
        // One flush after the first row, one at 2 s; some rows lie beyond the second.
        rows = reader.rows();
        EXPECT_GT(rows, 20u);
        expect_rows(reader, 0, 900);
    }
    TrajectoryWriter writer(path_, make_header(900), make_steps(500), false);
    EXPECT_EQ(writer.note(), "");
    EXPECT_EQ(writer.rows(), rows);
}

TEST_F(TrajectoryTest, RefusesALeftoverOfAnotherMotion) {
    { TrajectoryWriter(path_, make_header(9), make_steps(40), false); }
    TrajectoryHeader other = make_header(9);
    other.motion_hash = "89ab";
    const std::string error =
        error_of<InputError>([&] { TrajectoryWriter(path_, other, make_steps(40), false); });
    EXPECT_NE(error.find(partial_.string() + ": is of another motion"), std::string::npos) << error;
    const std::string bodies = error_of<InputError>(
        [&] { TrajectoryWriter(path_, make_header(8), make_steps(40), false); });
    EXPECT_NE(bodies.find("has 9 bodies, here 8"), std::string::npos) << bodies;
    TrajectoryWriter writer(path_, other, make_steps(40), true);
    EXPECT_EQ(writer.rows(), 0u);
}

TEST_F(TrajectoryTest, RefusesASecondWriterAndAdmitsReaders) {
    // A plain reader in a process of its own (begun before, so that it does not inherit HDF5's view
    // of the open file), with the locks that HDF5 takes by default.
    int written[2];
    ASSERT_EQ(::pipe(written), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        char byte = 0;
        if (::read(written[0], &byte, 1) != 1) ::_exit(1);
        ::_exit(H5Fopen(partial_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT) >= 0 ? 7 : 1);
    }
    TrajectoryWriter writer(path_, make_header(9), make_steps(40), false);
    append_rows(writer, 1, 9);
    const std::string error =
        error_of<RunError>([&] { TrajectoryWriter(path_, make_header(9), make_steps(40), false); });
    EXPECT_EQ(error, path_.string() + ": is being written by another process");
    ASSERT_EQ(::write(written[1], "x", 1), 1);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 7);
    ::close(written[0]);
    ::close(written[1]);
}

TEST_F(TrajectoryTest, AFileThatIsOpenShowsWhatIsFlushedThen) {
    // A reader has seen the superblock, and of the rest nothing, when trees grow and split.
    constexpr std::uint64_t kSplit = 150;
    TrajectoryWriter writer(path_, make_header(9), make_steps(kSplit), false);
    append_rows(writer, 10, 9);
    writer.flush();
    const hdf5::Handle file = hdf5::open_file(partial_, false);
    append_rows(writer, kSplit, 9);
    writer.flush();
    const hdf5::Handle positions =
        hdf5::open_dataset(file.get(), "/particles/bodies/position/value");
    ASSERT_EQ(hdf5::extent_of(positions)[0], kSplit);
    for (std::uint64_t row = 0; row < kSplit; ++row) {
        std::vector<Vec4> read(9);
        ASSERT_NO_THROW(hdf5::read_rows(positions, row, 1, H5T_NATIVE_DOUBLE, read.data())) << row;
        EXPECT_EQ(read, make_row(row, 9).bodies.position) << row;
    }
}

TEST_F(TrajectoryTest, AFileEndsWhereItSaysOnceItIsClosed) {
    // While it grows it says more (trajectory_driver.hpp).
    const auto said = [](const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        in.seekg(40);
        std::uint64_t end = 0;
        in.read(reinterpret_cast<char*>(&end), sizeof end);
        return end;
    };
    {
        TrajectoryWriter writer(path_, make_header(9), make_steps(150), false);
        append_rows(writer, 100, 9);
        writer.flush();
        EXPECT_LT(said(partial_), fs::file_size(partial_));
    }
    EXPECT_EQ(said(partial_), fs::file_size(partial_));
    EXPECT_LT(said(partial_), 1u << 20);
    TrajectoryWriter writer(path_, make_header(9), make_steps(150), false);
    append_rows(writer, 150, 9);
    writer.finish();
    EXPECT_EQ(said(path_), fs::file_size(path_));
    EXPECT_LT(said(path_), 1u << 20);
}

TEST_F(TrajectoryTest, AFullDiskIsAnErrorAndLeavesNoFile) {
    // From too little for the layout to enough for most rows; what was flushed goes on later.
    for (const unsigned bytes : {1000u, 20'000u, 60'000u, 150'000u}) {
        fs::remove(partial_);
        const int status = status_of_child([&] {
            ::signal(SIGXFSZ, SIG_IGN);
            const rlimit limit = {bytes, bytes};
            ::setrlimit(RLIMIT_FSIZE, &limit);
            const std::string error = error_of<RunError>([&] { write_whole(200, 40); });
            if (error.find(path_.string()) == 0 &&
                error.find("File too large") != std::string::npos)
                return 7;
            std::cerr << error << "\n";
            return 1;
        });
        EXPECT_EQ(status, 7) << bytes;
        EXPECT_FALSE(fs::exists(path_));
    }
    TrajectoryWriter writer(path_, make_header(40), make_steps(200), false);
    append_rows(writer, 200, 40);
    writer.finish();
    expect_rows(TrajectoryReader(path_), 0, 40);
}

TEST_F(TrajectoryTest, NamesAMissingFolder) {
    const fs::path path = folder_ / "missing" / "film.h5";
    const std::string error =
        error_of<RunError>([&] { TrajectoryWriter(path, make_header(1), make_steps(1), false); });
    EXPECT_EQ(error, path.string() + ": cannot be created: No such file or directory");
}

TEST_F(TrajectoryTest, RefusesFilesThatAreNoTrajectories) {
    write_whole(20, 9);
    std::ifstream in(path_, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    const std::string whole = text.str();
    const auto refused = [&](const std::string& content) {
        std::ofstream(path_, std::ios::binary) << content;
        return error_of<InputError>([&] { TrajectoryReader reader(path_); });
    };
    EXPECT_NE(refused("").find("is not an HDF5 file"), std::string::npos);
    EXPECT_NE(refused(std::string(5000, 'x')).find("is not an HDF5 file"), std::string::npos);
    for (std::size_t keep = 1; keep < whole.size(); keep += whole.size() / 50)
        EXPECT_NE(refused(whole.substr(0, keep)), "") << keep;
    fs::remove(path_);
    EXPECT_NE(error_of<InputError>([&] { TrajectoryReader reader(path_); }).find("No such file"),
              std::string::npos);
    EXPECT_NE(
        error_of<InputError>([&] { TrajectoryReader reader(folder_.path()); }).find("not a file"),
        std::string::npos);
}

// HDF5 itself may fail on damaged structures, beyond what the reader's checks can see: a process
// of its own for each file, its time and memory limited; the rates are printed.
void TrajectoryTest::expect_damage_is_met(int files) {
    write_whole(5, 3);
    std::ifstream in(path_, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    const std::string whole = text.str();
    std::mt19937_64 random(3);
    std::map<int, int> outcomes;
    for (int i = 0; i < files; ++i) {
        std::string bytes = whole;
        for (std::uint64_t flips = 1 + random() % 8; flips > 0; --flips)
            bytes[random() % bytes.size()] = static_cast<char>(random());
        std::ofstream(path_, std::ios::binary) << bytes;
        ++outcomes[status_of_child([&] {
            ::alarm(5);
            const rlimit no_core = {0, 0};
            ::setrlimit(RLIMIT_CORE, &no_core);
            const std::string error = error_of<InputError>([&] {
                const TrajectoryReader reader(path_);
                Bodies bodies = make_row(0, 3).bodies;
                if (reader.header().bodies != 3) throw InputError("bodies");
                for (std::uint64_t row = 0; row < reader.rows(); ++row)
                    reader.read_row(row, bodies);
                static_cast<void>(reader.facts());
            });
            return error.empty() ? 0 : 7;
        })];
    }
    const int orderly = outcomes[0] + outcomes[7];
    for (const auto& [status, count] : outcomes)
        std::cout << "status " << status << ": " << count << " of " << files << "\n";
    EXPECT_GT(outcomes[7], 0);
    EXPECT_GE(orderly, files * 98 / 100);
}

TEST_F(TrajectoryTest, MostDamagedFilesAreRefusedOrRead) { expect_damage_is_met(100); }
TEST_F(TrajectoryTestSlow, MostDamagedFilesAreRefusedOrRead) { expect_damage_is_met(300); }

}  // namespace
}  // namespace tesserae::scenes
