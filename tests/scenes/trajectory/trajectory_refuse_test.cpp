// SPDX-License-Identifier: Apache-2.0
// Files made with HDF5's own interface to be refused, and leftovers that must not be lost.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>

#include "core/error.hpp"
#include "scenes/compare/content.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/trajectory/datasets.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;
using tesserae::testing::error_of;

class TrajectoryRefuse : public ::testing::Test {
  protected:
    void write_whole() {
        TrajectoryWriter writer(path_, make_header(3), make_steps(5), false);
        append_rows(writer, 5, 3);
        writer.finish();
    }
    void write_leftover(const TrajectoryHeader& header, std::uint64_t rows) {
        TrajectoryWriter writer(path_, header, make_steps(40), false);
        append_rows(writer, rows, header.bodies);
    }

    const tesserae::testing::TemporaryFolder folder_{"trajectory"};
    const fs::path path_ = folder_ / "film.h5", partial_ = folder_ / "film.h5.partial";
};

constexpr const char* kRotor = "/particles/bodies/rotor/value";
constexpr const char* kStep = "/particles/bodies/position/step";
constexpr const char* kText = "/parameters/scene/text";
constexpr const char* kEnergy = "/observables/kinetic_energy/value";

struct Bad {
    const char* replaced;               ///< taken out first
    std::function<void(hid_t)> damage;  ///< put in its place
    const char* expected;               ///< in the message
};

TEST_F(TrajectoryRefuse, NamesWhatIsWrongAtOnce) {
    const hsize_t huge = 1'000'000'000'000;
    const Bad cases[] = {
        {kStep, [](hid_t) {}, "doesn't exist"},
        {kRotor, [](hid_t) {}, "doesn't exist"},
        {kText, [](hid_t) {}, "doesn't exist"},
        {"/parameters/scene", [](hid_t) {}, "doesn't exist"},
        {"/h5md/creator", [](hid_t) {}, "doesn't exist"},
        {kStep, [](hid_t f) { H5Lcreate_soft(kEnergy, f, kStep, H5P_DEFAULT, H5P_DEFAULT); },
         "link to another place"},
        {kRotor,
         [](hid_t f) {
             H5Lcreate_external("other.h5", kRotor, f, kRotor, H5P_DEFAULT, H5P_DEFAULT);
         },
         "link to another place"},
        {"/observables",
         [](hid_t f) {
             H5Lcreate_external("other.h5", "/observables", f, "/observables", H5P_DEFAULT,
                                H5P_DEFAULT);
         },
         "link to another place"},
        {kText,
         [](hid_t f) { H5Lcreate_external("other.h5", kText, f, kText, H5P_DEFAULT, H5P_DEFAULT); },
         "link to another place"},
        {kStep, [=](hid_t f) { make_dataset(f, kStep, H5T_STD_I64LE, {huge}, 1024); },
         "claims to hold more"},
        {kRotor,
         [=](hid_t f) {
             make_dataset(f, kRotor, H5T_IEEE_F64LE, {huge, 3, 8}, 1);
         },
         "claims to hold more"},
        {kRotor,
         [](hid_t f) {
             make_dataset(f, kRotor, H5T_IEEE_F64LE, {5, 4, 8}, 1);
         },
         "another shape"},
        {kRotor,
         [](hid_t f) {
             make_dataset(f, kRotor, H5T_IEEE_F64LE, {5, 24}, 1);
         },
         "another shape"},
        {kRotor,
         [](hid_t f) {
             make_dataset(f, kRotor, H5T_IEEE_F32LE, {5, 3, 8}, 1);
         },
         "64-bit reals"},
        {kRotor, [](hid_t f) { make_text(f, kRotor, 8); }, "64-bit reals"},
        {kStep, [](hid_t f) { make_dataset(f, kStep, H5T_IEEE_F64LE, {5}, 1); }, "64-bit integers"},
        {kEnergy, [](hid_t f) { make_dataset(f, kEnergy, H5T_IEEE_F64LE, {5}, 0); },
         "claims to hold more"},
        {kEnergy, [=](hid_t f) { make_dataset(f, kEnergy, H5T_IEEE_F64LE, {1u << 30}, 1u << 26); },
         "chunks of more than"},
        {kRotor,
         [](hid_t f) { H5Gclose(H5Gcreate2(f, kRotor, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)); },
         "not a dataset"},
        {kText, [](hid_t f) { make_text(f, kText, std::size_t{1} << 31); }, "longer than the file"},
        {kText, [](hid_t f) { make_dataset(f, kText, H5T_STD_I64LE, {5}, 0); }, "not a text"},
    };
    write_whole();
    const fs::path good = folder_ / "good.h5";
    fs::rename(path_, good);
    const auto begin = std::chrono::steady_clock::now();
    for (const Bad& bad : cases) {
        fs::copy_file(good, path_, fs::copy_options::overwrite_existing);
        const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        ASSERT_GE(H5Ldelete(file, bad.replaced, H5P_DEFAULT), 0);
        bad.damage(file);
        ASSERT_GE(H5Fclose(file), 0);
        const std::string error = error_of<InputError>([&] { TrajectoryReader reader(path_); });
        EXPECT_NE(error.find(bad.expected), std::string::npos)
            << bad.replaced << ": \"" << error << "\", expected \"" << bad.expected << "\"";
        EXPECT_EQ(error.find(path_.string()), 0u) << error;
    }
    // A file of a few rows is refused in milliseconds; a loop over what it claims takes hours.
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

/// HDF5 1.10 looks without end for the chunks of a dataset that has other axes than these.
TEST_F(TrajectoryRefuse, ChunksOfAnotherNumberOfAxes) {
    write_whole();
    std::ifstream in(path_, std::ios::binary);
    const std::string whole(std::istreambuf_iterator<char>(in), {});
    // A dataspace: version 1, three axes that may grow, five rows of three bodies (HDF5 File Format
    // Specification 3.0, IV.A.2.b).
    std::string space("\1\3\1\0\0\0\0\0\5\0\0\0\0\0\0\0\3\0\0\0\0\0\0\0", 24);
    int found = 0;
    for (std::size_t at = whole.find(space); at != whole.npos; at = whole.find(space, at + 1)) {
        ++found;
        for (const char axes : {'\0', '\1', '\2'}) {
            std::string file = whole;
            file[at + 1] = axes;
            std::ofstream(path_, std::ios::binary) << file;
            const std::string error = error_of<InputError>([&] { read_content(path_); });
            // HDF5 1.14 finds it by itself, in words of its own.
            EXPECT_TRUE(error.find("number of axes") != error.npos ||
                        error.find("number of dimensions") != error.npos ||
                        error.find("dataspace dim") != error.npos)
                << at << ": " << error;
        }
    }
    EXPECT_GE(found, 3);
}

TEST_F(TrajectoryRefuse, ALeftoverOfOtherSteps) {
    TrajectoryHeader made = make_header(3);
    made.effective = "[render]\nframes_per_second = 80\n";
    write_leftover(made, 12);
    TrajectoryHeader wanted = made;
    wanted.effective = "[render]\nframes_per_second = 120\n";
    std::vector<std::uint64_t> steps = make_steps(40);
    for (std::uint64_t& step : steps) step = step / 3 * 2;
    const std::string error =
        error_of<InputError>([&] { TrajectoryWriter(path_, wanted, steps, false); });
    EXPECT_NE(error.find("row 1 is of step 3, here of step 2"), std::string::npos) << error;
    EXPECT_NE(error.find("frames_per_second: 80 there, 120 here"), std::string::npos) << error;
    EXPECT_NE(error.find("--overwrite"), std::string::npos) << error;

    const std::string fewer =
        error_of<InputError>([&] { TrajectoryWriter(path_, made, make_steps(7), false); });
    EXPECT_NE(fewer.find("goes on to step 33 in 12 rows, here to step 18 in 7"), std::string::npos)
        << fewer;
    TrajectoryHeader every = made;
    every.store_every = 0;
    const std::string stored =
        error_of<InputError>([&] { TrajectoryWriter(path_, every, make_steps(40), false); });
    EXPECT_NE(stored.find("every 3. step, here the steps that frames need"), std::string::npos)
        << stored;

    // None of these touched it; --overwrite does, and says so.
    EXPECT_EQ(TrajectoryWriter(path_, made, make_steps(40), false).rows(), 12u);
    const TrajectoryWriter anew(path_, wanted, steps, true);
    EXPECT_EQ(anew.rows(), 0u);
    EXPECT_NE(anew.note().find("row 1 is of step 3"), std::string::npos) << anew.note();
}

TEST_F(TrajectoryRefuse, ALeftoverThatTheSystemDoesNotLetBeRead) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizers need descriptors of their own to look at an exception";
#endif
    write_leftover(make_header(3), 12);
    const pid_t child = ::fork();
    if (child == 0) {
        // The lock takes the last descriptor: nothing says that the content is not good.
        int next = ::dup(0);
        ::close(next);
        const rlimit limit = {static_cast<rlim_t>(next + 1), static_cast<rlim_t>(next + 1)};
        ::setrlimit(RLIMIT_NOFILE, &limit);
        const std::string error = error_of<RunError>(
            [&] { TrajectoryWriter(path_, make_header(3), make_steps(40), false); });
        if (error.find("Too many open files") == std::string::npos) std::cerr << error << "\n";
        ::_exit(error.find("Too many open files") != std::string::npos ? 7 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 7);
    EXPECT_EQ(TrajectoryWriter(path_, make_header(3), make_steps(40), false).rows(), 12u);
}

/// Records are written where others were.
TEST_F(TrajectoryRefuse, ALeftoverWithoutPlacesForRecords) {
    const std::function<void(hid_t, const char*)> changes[] = {
        [](hid_t f, const char* name) { make_text(f, name, 8); },
        [](hid_t f, const char* name) {
            make_dataset(f, name, H5T_STD_U8LE, {8, 8}, 1);
        },
        [](hid_t f, const char* name) { make_dataset(f, name, H5T_STD_U8LE, {8}, 0); },
        [](hid_t f, const char* name) { make_dataset(f, name, H5T_STD_I64LE, {8}, 1); }};
    for (const char* name :
         {"/parameters/checkpoint", "/parameters/resume/a", "/parameters/resume/b"})
        for (const auto& change : changes) {
            fs::remove(partial_);
            write_leftover(make_header(3), 12);
            const hid_t file = H5Fopen(partial_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
            ASSERT_GE(H5Ldelete(file, name, H5P_DEFAULT), 0);
            change(file, name);
            ASSERT_GE(H5Fclose(file), 0);
            TrajectoryWriter writer(path_, make_header(3), make_steps(40), false);
            EXPECT_EQ(writer.note(), fmt::format("{}: {}: is no record to continue from; starting "
                                                 "anew",
                                                 partial_.string(), name));
            append_rows(writer, 2, 3);
            writer.flush();
        }
}

/// A step would read beyond the bodies.
TEST_F(TrajectoryRefuse, ARecordThatNamesOtherBodies) {
    const std::function<void(StepMemory&)> changes[] = {
        [](StepMemory& m) { m.asleep[1] = 3; },
        [](StepMemory& m) { m.asleep.push_back(0), m.still.push_back(0); },
        [](StepMemory& m) {
            m.impulses.push_back({{1, {}}, 1, 3, 0});
        },
        [](StepMemory& m) {
            m.impulses.push_back({{1, {}}, 2, 2, 0});
        },
        [](StepMemory& m) {
            KeptManifold manifold;
            manifold.a = 1, manifold.b = 1u << 30;
            m.kept.emplace_back().push_back(std::make_shared<KeptManifold>(manifold));
        }};
    StepMemory good = make_row(2, 3).memory;
    good.angular_impulses.clear();
    ASSERT_EQ(good.asleep.size(), 3u);
    for (int i = -1; i < static_cast<int>(std::size(changes)); ++i) {
        fs::remove(partial_);
        StepMemory memory = good;
        if (i >= 0) changes[i](memory);
        {
            // The first row is flushed with its record, the others go with the last one's.
            TrajectoryWriter writer(path_, make_header(3), make_steps(40), false);
            append_rows(writer, 2, 3);
            const Row row = make_row(2, 3);
            writer.append(row.facts, row.bodies, memory);
        }
        const TrajectoryWriter writer(path_, make_header(3), make_steps(40), false);
        EXPECT_EQ(writer.rows(), i < 0 ? 3u : 1u) << i << ": " << writer.note();
    }
}

TEST_F(TrajectoryRefuse, ReplacesAnUnreadableLeftoverAndSaysSo) {
    std::ofstream(partial_) << std::string(5000, 'x');
    const TrajectoryWriter writer(path_, make_header(3), make_steps(40), false);
    EXPECT_EQ(writer.note(), partial_.string() + ": is not an HDF5 file; starting anew");
}

TEST_F(TrajectoryRefuse, WorksWithHdf5sOwnLocks) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::setenv("HDF5_USE_FILE_LOCKING", "TRUE", 1);
        const std::string error = error_of<std::exception>([&] {
            write_leftover(make_header(3), 12);
            TrajectoryWriter writer(path_, make_header(3), make_steps(40), false);
            if (writer.rows() != 12) throw RunError("is not continued: " + writer.note());
            if (TrajectoryReader(partial_).rows() != 12) throw RunError("is not read");
            append_rows(writer, 40, 3);
            writer.finish();
            if (TrajectoryReader(path_).rows() != 40) throw RunError("is not whole");
        });
        if (!error.empty()) std::cerr << error << "\n";
        ::_exit(error.empty() ? 7 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 7);
}

}  // namespace
}  // namespace tesserae::scenes
