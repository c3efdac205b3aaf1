// SPDX-License-Identifier: Apache-2.0
#include "core/file/read_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.hpp"
#include "tests/error_of.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae {
namespace {

using tesserae::testing::error_of;

const tesserae::testing::TemporaryFolder& folder() {
    static const tesserae::testing::TemporaryFolder folder("read_file");
    return folder;
}

TEST(ReadFile, GivesAllBytes) {
    for (const std::size_t size : {0, 1, 65535, 65536, 65537, 200000}) {
        std::string bytes(size, '\0');
        for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 7 % 256);
        const auto file = folder() / "bytes";
        std::ofstream(file, std::ios::binary) << bytes;
        EXPECT_TRUE(read_file(file) == bytes) << size;
    }
}

TEST(ReadFile, TellsAFailureWithPathAndReason) {
    const auto missing = folder() / "missing";
    EXPECT_EQ(error_of<RunError>([&] { read_file(missing); }),
              missing.string() + ": cannot be read: No such file or directory");
    // A folder can be opened and not read.
    const std::string path = (folder() / "").parent_path().string();
    EXPECT_EQ(error_of<RunError>([&] { read_file(path); }),
              path + ": cannot be read: Is a directory");
}

}  // namespace
}  // namespace tesserae
