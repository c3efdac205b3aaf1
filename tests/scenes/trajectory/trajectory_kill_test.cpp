// SPDX-License-Identifier: Apache-2.0
// What a SIGKILL leaves, at every place where it can fall: a writer runs under ptrace and is
// stopped before each of its writes, where the file is just what a kill at that moment would leave.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>
#include <map>

#include "core/error.hpp"
#include "tests/content.hpp"
#include "tests/scenes/trajectory/datasets.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKilledBodies = 5;
/// A tree node of HDF5's default format has 64 entries: rows 65 and 122 split one.
constexpr std::uint64_t kKilledRows = 128;

/// Runs `work` in a child, stopped before every system call that changes a file.
/// @return its exit status, -1 if it cannot be traced
int trace_writes(const std::function<void()>& work, const std::function<void()>& before_write) {
    const pid_t child = ::fork();
    if (child == 0) {
        if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) ::_exit(99);
        ::raise(SIGSTOP);
        work();
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    if (!WIFSTOPPED(status)) return -1;
    ::ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL);
    for (bool entering = true;;) {
        ::ptrace(PTRACE_SYSCALL, child, nullptr, nullptr);
        ::waitpid(child, &status, 0);
        if (WIFEXITED(status)) return WEXITSTATUS(status);
        if (WIFSIGNALED(status)) return -WTERMSIG(status);
        if (!WIFSTOPPED(status) || WSTOPSIG(status) != (SIGTRAP | 0x80)) continue;
        __ptrace_syscall_info info = {};
        ::ptrace(PTRACE_GET_SYSCALL_INFO, child, sizeof info, &info);
        const auto call = info.entry.nr;
        if (entering && (call == SYS_pwrite64 || call == SYS_ftruncate || call == SYS_rename ||
                         call == SYS_sendfile || call == SYS_copy_file_range))
            before_write();
        entering = !entering;
    }
}

/// Rows that the child has flushed, where both processes see it.
class SharedCount {
  public:
    SharedCount()
        : count_(static_cast<volatile std::uint64_t*>(::mmap(nullptr, sizeof(std::uint64_t),
                                                             PROT_READ | PROT_WRITE,
                                                             MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {}
    ~SharedCount() { ::munmap(const_cast<std::uint64_t*>(count_), sizeof(std::uint64_t)); }
    void set(std::uint64_t rows) { *count_ = rows; }
    std::uint64_t get() const { return *count_; }

  private:
    volatile std::uint64_t* count_;
};

/// The scene whose trajectory has so many rows.
TrajectoryHeader killed_header(std::uint64_t rows) {
    TrajectoryHeader header = make_header(kKilledBodies);
    header.source = "run " + std::string(rows, 'x');
    header.hash = std::to_string(rows);
    // Other names, longer and shorter.
    static std::map<std::uint64_t, NamedBodies> names;
    const NamedBodies& named =
        names[rows] = {"run-" + std::string(rows % 9, 'x'), 0, kKilledBodies};
    header.effective = "[[body]]\nname = \"" + named.name + "\"\n";
    header.described.names = {&named, 1};
    return header;
}

/// Every row that counts is right, and none of those flushed is missing.
void expect_whole(const fs::path& file, std::uint64_t flushed) {
    const std::vector<std::string> names = texts_of(file, "/particles/bodies/name");
    ASSERT_EQ(names.size(), kKilledBodies);
    EXPECT_EQ(names[1].find(names[1] == "d\xc3\xa9j\xc3\xa0" ? "d" : "run-"), 0u) << names[1];
    EXPECT_EQ(names[4], names[1]);
    const TrajectoryReader reader(file);
    ASSERT_GE(reader.rows(), flushed);
    EXPECT_EQ(reader.facts().size(), reader.rows());
    Bodies bodies = make_row(0, kKilledBodies).bodies;
    // The last rows, which are beside what changes, and some of all the others.
    for (std::uint64_t row = 0; row < reader.rows(); ++row) {
        if (row + 8 < reader.rows() && row % 32 != 0) continue;
        ASSERT_EQ(reader.steps()[row], 3 * row);
        reader.read_row(row, bodies);
        const Row made = make_row(row, kKilledBodies);
        ASSERT_EQ(bodies.position, made.bodies.position) << "row " << row;
        ASSERT_EQ(bodies.rotor, made.bodies.rotor) << "row " << row;
        ASSERT_EQ(bodies.velocity, made.bodies.velocity) << "row " << row;
    }
}

/// A copy is continued from its last flush on.
void expect_continued(const fs::path& file, std::uint64_t flushed) {
    const tesserae::testing::TemporaryFolder folder("kill");
    const fs::path path = folder / "copy.h5";
    fs::copy_file(file, path.string() + ".partial");
    const TrajectoryWriter writer(path, make_header(kKilledBodies), make_steps(kKilledRows), false);
    ASSERT_GE(writer.rows(), flushed) << writer.note();
    Bodies bodies = make_row(0, kKilledBodies).bodies;
    ASSERT_TRUE(writer.resume(bodies).has_value());
    EXPECT_EQ(bodies.rotor, make_row(writer.rows() - 1, kKilledBodies).bodies.rotor);
}

/// Of so many states one is looked at: of all in the slow set.
int looked_at() {
    const std::string suite = ::testing::UnitTest::GetInstance()->current_test_suite()->name();
    return suite.ends_with("Slow") ? 1 : 20;
}

/// Traces `work`, which writes below `path` and counts what it has flushed, and checks the states.
void expect_whole_at_every_write(const fs::path& path, const SharedCount& flushed,
                                 const std::function<void()>& work) {
    const fs::path partial = path.string() + ".partial";
    int states = 0;
    const auto check = [&] {
        const std::uint64_t rows = flushed.get();
        if (rows == 0 || !fs::exists(partial) || ::testing::Test::HasFailure()) return;
        if (++states % looked_at() != 0) return;
        try {
            expect_whole(partial, rows);
            if (states % 8 == 0) expect_continued(partial, rows);
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
        if (::testing::Test::HasFailure())
            std::cout << "at write " << states << " after " << rows << " flushed rows\n";
    };
    const int status = trace_writes(work, check);
    if (status == -1) GTEST_SKIP() << "processes cannot be traced here";
    EXPECT_EQ(status, 0);
    EXPECT_GE(states, 300);
    expect_whole(path, kKilledRows);
}

void kill_straight_run() {
    const tesserae::testing::TemporaryFolder folder("kill");
    const fs::path path = folder / "film.h5";
    SharedCount flushed;
    expect_whole_at_every_write(path, flushed, [&] {
        TrajectoryWriter writer(path, make_header(kKilledBodies), make_steps(kKilledRows), false);
        for (std::uint64_t row = 1; row <= kKilledRows; ++row) {
            append_rows(writer, row, kKilledBodies);
            const bool splits = (row > 62 && row < 68) || row > 119;
            if (!splits && row % 20 != 1) continue;
            writer.flush();
            flushed.set(row);
        }
        writer.finish();
    });
}

void kill_interrupted_run() {
    // Each run has another text, and rows that were not flushed are cut off again.
    const tesserae::testing::TemporaryFolder folder("kill");
    const fs::path path = folder / "film.h5";
    SharedCount flushed;
    expect_whole_at_every_write(path, flushed, [&] {
        for (std::uint64_t end = 14; flushed.get() < kKilledRows; end += 19) {
            TrajectoryWriter writer(path, killed_header(end), make_steps(kKilledRows), false);
            append_rows(writer, std::min(end, kKilledRows), kKilledBodies);
            writer.flush();
            flushed.set(writer.rows());
            if (writer.rows() == kKilledRows) writer.finish();
        }
    });
}

/// A copy of the folder is continued from what is furthest in it, of so many rows, up to `end`.
void expect_continued_for_longer(const fs::path& path, std::uint64_t rows, std::uint64_t end) {
    const tesserae::testing::TemporaryFolder folder("kill");
    const fs::path copy = folder / "copy.h5";
    fs::copy_file(path, copy);
    if (fs::exists(path.string() + ".partial"))
        fs::copy_file(path.string() + ".partial", copy.string() + ".partial");
    TrajectoryWriter writer(copy, killed_header(end), make_steps(end), false);
    ASSERT_GE(writer.rows(), rows) << writer.note();
    append_rows(writer, end, kKilledBodies);
    writer.finish();
    expect_whole(copy, end);
}

/// @param continue_every   of so many states one is continued
void expect_whole_while_continued(int continue_every) {
    const tesserae::testing::TemporaryFolder folder("kill");
    const fs::path path = folder / "film.h5";
    // Each time what is there is continued, in a copy; rows 65 and 122 split a node.
    const std::uint64_t ends[] = {3, 64, 65, 121, kKilledRows};
    {
        TrajectoryWriter writer(path, killed_header(ends[0]), make_steps(ends[0]), false);
        append_rows(writer, ends[0], kKilledBodies);
        writer.finish();
    }
    SharedCount finished;
    finished.set(ends[0]);
    int states = 0;
    std::uint64_t whole_rows = 0;
    std::string whole_bytes;
    const auto work = [&] {
        for (std::uint64_t end : ends) {
            if (end == ends[0]) continue;
            TrajectoryWriter writer(path, killed_header(end), make_steps(end), false);
            append_rows(writer, end, kKilledBodies);
            writer.finish();
            finished.set(end);
        }
    };
    const auto check = [&] {
        if (::testing::Test::HasFailure()) return;
        ++states;
        try {
            // The same bytes need no second look.
            std::string bytes = tesserae::testing::content(path);
            if (whole_rows != finished.get() || bytes != whole_bytes) {
                expect_whole(path, finished.get());
                whole_rows = finished.get(), whole_bytes = std::move(bytes);
            }
            if (states % continue_every == 0) {
                // By the same command or, by turns, by one that wants more.
                const std::uint64_t* const end =
                    std::upper_bound(std::begin(ends), std::end(ends), finished.get());
                const std::uint64_t same = end == std::end(ends) ? kKilledRows : *end;
                const std::uint64_t more = states / continue_every % 2 == 0 ? 0 : 7;
                expect_continued_for_longer(path, finished.get(),
                                            std::min(same + more, kKilledRows));
            }
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
        if (::testing::Test::HasFailure()) std::cout << "at write " << states << "\n";
    };
    const int status = trace_writes(work, check);
    if (status == -1) GTEST_SKIP() << "processes cannot be traced here";
    EXPECT_EQ(status, 0);
    EXPECT_GE(states, 300);
    expect_whole(path, kKilledRows);
}

TEST(TrajectoryKill, AtAWriteOfAContinuedFileTheFinishedOneIsWhole) {
    expect_whole_while_continued(80);
}

TEST(TrajectoryKillSlow, EveryStateOfAContinuedFileIsContinued) { expect_whole_while_continued(1); }

void kill_unnamed_file() {
    // Killed just before the rename, then wanted longer: nothing else holds its rows.
    const tesserae::testing::TemporaryFolder folder("kill");
    const fs::path path = folder / "film.h5";
    constexpr std::uint64_t kFinished = 50;
    {
        TrajectoryWriter writer(path, killed_header(kFinished), make_steps(kFinished), false);
        append_rows(writer, kFinished, kKilledBodies);
        writer.finish();
    }
    fs::rename(path, path.string() + ".partial");
    SharedCount flushed;
    flushed.set(kFinished);
    expect_whole_at_every_write(path, flushed, [&] {
        TrajectoryWriter writer(path, killed_header(kKilledRows), make_steps(kKilledRows), false);
        for (std::uint64_t row = kFinished + 1; row <= kKilledRows; ++row) {
            append_rows(writer, row, kKilledBodies);
            if (row > 68 && row % 8 != 0) continue;
            writer.flush();
            flushed.set(row);
        }
        writer.finish();
    });
}

TEST(TrajectoryKill, AtAWriteTheFileHoldsTheLastFlush) { kill_straight_run(); }
TEST(TrajectoryKill, AtAWriteOfAnInterruptedRunTheFileHoldsTheLastFlush) { kill_interrupted_run(); }
TEST(TrajectoryKill, AtAWriteOfAFileWithoutItsNameTheFileHoldsTheLastFlush) { kill_unnamed_file(); }

TEST(TrajectoryKillSlow, AtEveryWriteTheFileHoldsTheLastFlush) { kill_straight_run(); }
TEST(TrajectoryKillSlow, AtEveryWriteOfAnInterruptedRunTheFileHoldsTheLastFlush) {
    kill_interrupted_run();
}
TEST(TrajectoryKillSlow, AtEveryWriteOfAFileWithoutItsNameTheFileHoldsTheLastFlush) {
    kill_unnamed_file();
}

}  // namespace
}  // namespace tesserae::scenes
