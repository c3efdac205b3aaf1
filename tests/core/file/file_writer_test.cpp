// SPDX-License-Identifier: Apache-2.0
#include "core/file/file_writer.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <thread>

#include "core/error.hpp"
#include "tests/child_process.hpp"
#include "tests/content.hpp"
#include "tests/error_of.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using tesserae::testing::content;
using tesserae::testing::error_of;
using tesserae::testing::status_of_child;

class FileWriterTest : public ::testing::Test {
  protected:
    const tesserae::testing::TemporaryFolder folder_{"file_writer"};
};

/// From here on this process cannot make files longer than this, as on a full disk.
void limit_file_size(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
}

TEST_F(FileWriterTest, WritesWhatAStringInMemoryHolds) {
    // Writes of all sizes and seeks to random places, beside the same on a string.
    std::mt19937_64 random(1);
    for (int round = 0; round < 40; ++round) {
        const fs::path path = folder_ / "random";
        std::string expected;
        std::size_t position = 0;
        FileWriter writer(path);
        for (int i = 0; i < 100; ++i) {
            if (random() % 4 == 0) {
                position = random() % (expected.size() + 1000);
                writer.seek(position);
            }
            std::string bytes(random() % (std::size_t{1} << random() % 18), '\0');
            for (char& c : bytes) c = static_cast<char>(random());
            if (bytes.empty()) bytes = "x";
            if (expected.size() < position + bytes.size()) expected.resize(position + bytes.size());
            expected.replace(position, bytes.size(), bytes);
            writer.write(bytes.data(), bytes.size());
            position += bytes.size();
            ASSERT_EQ(writer.position(), position);
        }
        ASSERT_FALSE(fs::exists(path) && round == 0);
        writer.finish();
        ASSERT_EQ(content(path), expected) << "round " << round;
        ASSERT_FALSE(fs::exists(path.string() + ".partial"));
    }
}

TEST_F(FileWriterTest, ReplacesAFileOnlyWhenFinished) {
    const fs::path path = folder_ / "file";
    write_file(path, "old");
    {
        FileWriter writer(path);
        writer.write("newer", 5);
        EXPECT_EQ(content(path), "old");
    }
    EXPECT_EQ(content(path), "old");
    EXPECT_FALSE(fs::exists(folder_ / "file.partial"));
    write_file(path, "newer");
    EXPECT_EQ(content(path), "newer");
}

TEST_F(FileWriterTest, RefusesASecondWriter) {
    const fs::path path = folder_ / "file";
    FileWriter writer(path);
    writer.write("first", 5);
    const int status = status_of_child([&] {
        const std::string error = error_of<RunError>([&] { FileWriter second(path); });
        return error == path.string() + ": is being written by another process" ? 7 : 1;
    });
    EXPECT_EQ(status, 7);
    writer.finish();
    EXPECT_EQ(content(path), "first");
}

TEST_F(FileWriterTest, WaitsForAnotherWriterWhoseFileItShares) {
    const fs::path path = folder_ / "file";
    const std::atomic<bool> goes_on = false, stops = true;
    const auto write = [&] { write_file(path, "shared"); };
    // A lock belongs to the opened file: a second writer of this process meets it too.
    auto first = std::make_unique<FileWriter>(path);
    const std::string busy = path.string() + ": is being written by another process";
    EXPECT_EQ(error_of<BusyError>([&] { write_when_free(write, goes_on, 20ms); }), busy);
    EXPECT_THROW(write_when_free(write, stops), Stopped);
    EXPECT_FALSE(fs::exists(path));

    std::thread other([&] {
        std::this_thread::sleep_for(50ms);
        first->write("first", 5);
        first->finish();
    });
    int calls = 0;
    write_when_free([&] { ++calls, write(); }, goes_on);
    other.join();
    EXPECT_EQ(content(path), "shared");
    EXPECT_GT(calls, 1);
}

TEST_F(FileWriterTest, OverwritesTheLeftoverOfAKilledWriter) {
    const fs::path path = folder_ / "file";
    const int status = status_of_child([&] {
        FileWriter writer(path);
        const std::string bytes(200'000, 'x');
        writer.write(bytes.data(), bytes.size());
        return ::raise(SIGKILL);
    });
    ASSERT_EQ(status, -SIGKILL);
    ASSERT_EQ(fs::file_size(folder_ / "file.partial"), 200'000u);
    ASSERT_FALSE(fs::exists(path));
    write_file(path, "whole");
    EXPECT_EQ(content(path), "whole");
}

TEST_F(FileWriterTest, AFullDiskLeavesNothing) {
    // The limit is met by a large write, by a flush of small ones, and by finish() only.
    for (const std::size_t piece : {1'000'000, 1000, 1}) {
        const fs::path path = folder_ / "file";
        const int status = status_of_child([&] {
            limit_file_size(piece == 1 ? 50 : 150'000);
            FileWriter writer(path);
            const std::string bytes(piece, 'x');
            const auto write = [&] {
                for (int i = 0; i < 1000; ++i) writer.write(bytes.data(), bytes.size());
            };
            const std::string first = error_of<RunError>(write);
            const std::string last = error_of<RunError>([&] { writer.finish(); });
            const bool named =
                last.find(path.string()) == 0 && last.find("File too large") != std::string::npos;
            // Buffered bytes fail in finish(); others at once, and finish() repeats it.
            return named && first == (piece == 1 ? "" : last) ? 7 : 1;
        });
        EXPECT_EQ(status, 7) << "pieces of " << piece;
        EXPECT_FALSE(fs::exists(path));
        EXPECT_FALSE(fs::exists(folder_ / "file.partial"));
    }
}

TEST_F(FileWriterTest, ACopyIsWholeOrGone) {
    std::mt19937_64 random(1);
    std::string bytes(3'000'001, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    write_file(folder_ / "source", bytes);
    const fs::path path = folder_ / "copy";
    // What a killed process left may be longer.
    std::ofstream(path.string() + ".partial") << std::string(5'000'000, 'x');
    {
        PartialFile copy(path);
        copy.copy_from(folder_ / "source");
        copy.publish();
    }
    EXPECT_TRUE(content(path) == bytes);

    const int status = status_of_child([&] {
        limit_file_size(2'000'000);
        PartialFile copy(path);
        const std::string error = error_of<RunError>([&] { copy.copy_from(folder_ / "source"); });
        const std::string expected =
            fmt::format("{}: cannot be copied to {}: File too large", (folder_ / "source").string(),
                        path.string() + ".partial");
        if (error != expected) std::cerr << error << "\n";
        return error == expected ? 7 : 1;
    });
    EXPECT_EQ(status, 7);
    EXPECT_FALSE(fs::exists(path.string() + ".partial"));
    EXPECT_TRUE(content(path) == bytes);
}

TEST_F(FileWriterTest, NamesThePathAndTheReason) {
    // No permission bits: root ignores them. Each of these fails for everyone.
    write_file(folder_ / "plain", "x");
    fs::create_directory(folder_ / "taken");
    fs::create_directory(folder_ / "half.partial");
    fs::create_symlink("/dev/null", folder_ / "link.partial");
    const std::string long_name(300, 'n');
    const std::pair<fs::path, const char*> cases[] = {
        {folder_ / "missing" / "file", "No such file or directory"},
        {folder_ / "plain" / "file", "Not a directory"},
        {folder_ / "taken", "Is a directory"},
        {folder_ / "half", "Is a directory"},
        {folder_ / "link", "Too many levels of symbolic links"},
        {folder_ / long_name, "File name too long"},
        {"/proc/file", "No such file or directory"},
    };
    for (const auto& [path, reason] : cases) {
        const std::string error = error_of<RunError>([&, p = path] { write_file(p, "content"); });
        EXPECT_EQ(error.find(path.string() + ": "), 0u) << error;
        EXPECT_NE(error.find(reason), std::string::npos) << error;
    }
    EXPECT_EQ(content(folder_ / "plain"), "x");
}

TEST_F(FileWriterTest, AFailedRenameLeavesNothing) {
    const fs::path path = folder_ / "file";
    std::string error;
    {
        FileWriter writer(path);
        writer.write("x", 1);
        fs::create_directory(path);
        error = error_of<RunError>([&] { writer.finish(); });
        EXPECT_EQ(error_of<RunError>([&] { writer.finish(); }), error);
    }
    EXPECT_NE(error.find("cannot be renamed"), std::string::npos) << error;
    EXPECT_TRUE(fs::is_directory(path));
    EXPECT_FALSE(fs::exists(folder_ / "file.partial"));
}

TEST_F(FileWriterTest, ManyWritersOfOneFileLeaveOneWholeFile) {
    // Races between locking and renaming: whoever gets the lock writes all of its own letter.
    const fs::path path = folder_ / "file";
    for (int child = 0; child < 4; ++child)
        if (::fork() == 0) {
            const std::string bytes(100'000, static_cast<char>('a' + child));
            for (int written = 0; written < 20;) {
                const std::string error = error_of<RunError>([&] { write_file(path, bytes); });
                written += error.empty();
                if (!error.empty() && error.find("by another process") == std::string::npos)
                    ::_exit(1);
            }
            ::_exit(7);
        }
    for (int child = 0; child < 4; ++child) {
        int status = 0;
        ::wait(&status);
        EXPECT_EQ(WEXITSTATUS(status), 7);
    }
    const std::string bytes = content(path);
    ASSERT_EQ(bytes.size(), 100'000u);
    EXPECT_EQ(bytes.find_first_not_of(bytes[0]), std::string::npos);
    EXPECT_FALSE(fs::exists(folder_ / "file.partial"));
}

}  // namespace
}  // namespace tesserae
