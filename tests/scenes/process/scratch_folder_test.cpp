// SPDX-License-Identifier: Apache-2.0
#include "scenes/process/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <set>

#include "core/error.hpp"
#include "tests/error_of.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for temporary files, as long as the test lasts.
class ScratchFolders : public ::testing::Test {
  protected:
    ScratchFolders() { ::setenv("TMPDIR", folder_.path().c_str(), 1); }
    ~ScratchFolders() override { ::unsetenv("TMPDIR"); }

    std::set<fs::path> there() const {
        std::set<fs::path> names;
        for (const auto& entry : fs::directory_iterator(folder_.path())) names.insert(entry.path());
        return names;
    }
    /// As a process that was killed a while ago has left it.
    fs::path leftover(const std::string& name) const {
        const fs::path path = folder_.path() / name;
        fs::create_directory(path);
        std::ofstream(path / "measured.exr") << "some";
        const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
        fs::last_write_time(path, long_ago);
        return path;
    }

    const tesserae::testing::TemporaryFolder folder_{"scratch"};
};

TEST_F(ScratchFolders, AreOfTheirOwnerAloneAndGoneInTheEnd) {
    {
        const ScratchFolder one("work-"), other("work-");
        EXPECT_NE(one.path(), other.path());
        struct stat about;
        ASSERT_EQ(::stat(one.path().c_str(), &about), 0);
        EXPECT_EQ(about.st_mode & 0777, 0700u);
        std::ofstream(one.path() / "file") << "some";
        EXPECT_EQ(there().size(), 2u);
    }
    EXPECT_TRUE(there().empty());
}

TEST_F(ScratchFolders, NeedAPlaceThatIsThere) {
    const std::string missing = folder_.path() / "missing";
    ::setenv("TMPDIR", missing.c_str(), 1);
    EXPECT_EQ(
        tesserae::testing::error_of<RunError>([] { ScratchFolder folder("work-"); }),
        missing + ": no folder for temporary files: No such file or directory; set TMPDIR to one");
}

TEST_F(ScratchFolders, LeftByAKilledProcessAreRemoved) {
    const fs::path old = leftover("work-abcdef"), other = leftover("play-abcdef");
    // What only has the name is left alone, and what it points to.
    const fs::path precious = leftover("precious");
    fs::create_directory_symlink(precious, folder_.path() / "work-linked");
    std::optional<ScratchFolder> alive(std::in_place, "work-");
    fs::last_write_time(alive->path(), fs::file_time_type::clock::now() - std::chrono::hours(1));
    const ScratchFolder next("work-");
    EXPECT_FALSE(fs::exists(old));
    EXPECT_TRUE(fs::exists(other / "measured.exr"));
    EXPECT_TRUE(fs::exists(precious / "measured.exr"));
    EXPECT_TRUE(fs::exists(alive->path())) << "its process lives";
}

}  // namespace
}  // namespace tesserae::scenes
