// SPDX-License-Identifier: Apache-2.0
// Trajectories on a disk whose reads fail.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <functional>
#include <string>

#include "core/error.hpp"
#include "scenes/compare/content.hpp"
#include "tests/content.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"
#include "tests/temporary_folder.hpp"

namespace {

/// Which call fails from now on, the first is 1; at 0 or less none does.
std::atomic<int> calls_until_failure = 0;

bool fails() { return calls_until_failure.load() > 0 && --calls_until_failure == 0; }

}  // namespace

// These stand before the system's own ones.
extern "C" ssize_t pread(int file, void* bytes, std::size_t size, off_t at) {
    if (!fails()) return ::syscall(SYS_pread64, file, bytes, size, at);
    errno = EIO;
    return -1;
}
extern "C" int fstat(int file, struct stat* found) noexcept {
    if (!fails()) return ::fstatat(file, "", found, AT_EMPTY_PATH);
    errno = EIO;
    return -1;
}

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;
using tesserae::testing::content;
using tesserae::testing::error_of;

constexpr const char* kReason = "Input/output error";

class FailingReads : public ::testing::Test {
  protected:
    void write_rows(std::uint64_t rows, bool finishes) {
        TrajectoryWriter writer(path_, make_header(3), make_steps(5), false);
        append_rows(writer, rows, 3);
        if (finishes) writer.finish();
    }

    /// Calls `work` so often that each of its reads fails once. It may do without one: then it
    /// gives what it gives undisturbed.
    /// @param look   at an error
    /// @return how many reads it has
    template <class Error, class Result>
    int let_each_fail(const std::function<Result()>& work,
                      const std::function<void(const std::string& error)>& look) {
        const Result undisturbed = work();
        for (int at = 1;; ++at) {
            Result result;
            calls_until_failure = at;
            const std::string error = error_of<Error>([&] { result = work(); });
            if (calls_until_failure.exchange(0) > 0) return at - 1;
            SCOPED_TRACE("call " + std::to_string(at));
            if (error.empty())
                EXPECT_EQ(result, undisturbed);
            else
                look(error);
        }
    }

    const tesserae::testing::TemporaryFolder folder_{"failing_reads"};
    const fs::path path_ = folder_ / "film.h5", partial_ = folder_ / "film.h5.partial";
};

TEST_F(FailingReads, OfATrajectoryAreToldInTheSystemsWords) {
    write_rows(5, true);
    const auto look = [&](const std::string& error) {
        EXPECT_NE(error.find(kReason), error.npos) << error;
        EXPECT_EQ(error.find(path_.string()), 0u) << error;
    };
    const std::function read = [&] { return TrajectoryReader(path_).times(); };
    EXPECT_GT((let_each_fail<InputError>(read, look)), 50);
    const std::function hash = [&] { return read_content(path_).hash(); };
    EXPECT_GT((let_each_fail<InputError>(hash, look)), 50);
}

TEST_F(FailingReads, OfALeftoverLoseNothing) {
    write_rows(3, false);
    const std::string leftover = content(partial_);
    const std::function rows = [&] {
        return TrajectoryWriter(path_, make_header(3), make_steps(5), false).rows();
    };
    const auto look = [&](const std::string& error) {
        EXPECT_EQ(error.find(path_.string()), 0u) << error;
        EXPECT_NE(error.find(kReason), error.npos) << error;
        EXPECT_EQ(content(partial_), leftover);
    };
    EXPECT_GT((let_each_fail<RunError>(rows, look)), 50);
    EXPECT_EQ(rows(), 3u);
}

}  // namespace
}  // namespace tesserae::scenes
