// SPDX-License-Identifier: Apache-2.0
// Files whose structures are damaged in ways that HDF5 itself does not notice. That a growing file
// is whole after every write: trajectory_kill_test.cpp.
#include "scenes/trajectory/trajectory_driver.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>

#include "core/error.hpp"
#include "scenes/compare/content.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;
using tesserae::testing::error_of;

std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

std::uint64_t word(const std::string& bytes, std::uint64_t at) {
    std::uint64_t value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

void put(std::string& bytes, std::uint64_t at, std::uint64_t value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

class TrajectoryDriver : public ::testing::Test {
  protected:
    void write_rows(std::uint64_t rows, bool finishes) {
        TrajectoryWriter writer(path_, make_header(3), make_steps(5), false);
        append_rows(writer, rows, 3);
        if (finishes) writer.finish();
    }

    const tesserae::testing::TemporaryFolder folder_{"driver"};
    const fs::path path_ = folder_ / "film.h5", partial_ = folder_ / "film.h5.partial";
};

/// The names of a group (HDF5 File Format Specification 3.0, III.D).
struct Names {
    std::uint64_t size, first_free, address;  ///< where the file has these three
    std::uint64_t bytes, begin;
};

std::vector<Names> all_names(const std::string& file) {
    std::vector<Names> all;
    for (std::size_t at = file.find("HEAP"); at != file.npos; at = file.find("HEAP", at + 1))
        if (at % 8 == 0)
            all.push_back({at + 8, at + 16, at + 24, word(file, at + 8), word(file, at + 24)});
    return all;
}

using Damage = std::function<void(std::string& file, const Names& names)>;

/// A free place among names: where the next one is, and its own size.
void put_place(std::string& file, const Names& names, std::uint64_t place, std::uint64_t next,
               std::uint64_t size) {
    put(file, names.begin + place, next);
    put(file, names.begin + place + 8, size);
}

const Damage kDamages[] = {
    [](std::string& file, const Names& names) {
        put(file, names.first_free, 16);
        put_place(file, names, 16, 16, 16);
    },
    [](std::string& file, const Names& names) {
        put(file, names.first_free, 0);
        put_place(file, names, 0, 16, 16);
        put_place(file, names, 16, 0, 16);
    },
    [](std::string& file, const Names& names) { put(file, names.first_free, names.bytes - 8); },
    [](std::string& file, const Names& names) { put(file, names.first_free, ~0ull - 7); },
    [](std::string& file, const Names& names) {
        put(file, names.first_free, 16);
        put_place(file, names, 16, 1, names.bytes);
    },
    [](std::string& file, const Names& names) { put(file, names.size, ~0ull); },
    [](std::string& file, const Names& names) { put(file, names.size, file.size()); },
    [](std::string& file, const Names& names) { put(file, names.address, ~0ull - 15); },
    [](std::string& file, const Names& names) { put(file, names.address, file.size()); },
};

/// HDF5 takes memory without end for some of these, and writes beyond its own for others.
TEST_F(TrajectoryDriver, RefusesDamagedNames) {
    write_rows(5, true);
    const std::string whole = bytes_of(path_);
    const std::vector<Names> all = all_names(whole);
    ASSERT_GT(all.size(), 5u);
    std::size_t refused = 0;
    for (std::size_t group = 0; group < all.size(); ++group)
        for (std::size_t i = 0; i < std::size(kDamages); ++i) {
            std::string file = whole;
            kDamages[i](file, all[group]);
            write_bytes(path_, file);
            const std::string read = error_of<InputError>([&] { TrajectoryReader reader(path_); });
            const std::string walked = error_of<InputError>([&] { read_content(path_); });
            refused += !read.empty() || !walked.empty();
            for (const std::string& error : {read, walked})
                EXPECT_TRUE(error.empty() || error.find("names are damaged") != error.npos)
                    << "group " << group << ", damage " << i << ": " << error;
        }
    // Some groups are looked at by neither.
    EXPECT_GT(refused, all.size() * std::size(kDamages) / 2);
}

TEST_F(TrajectoryDriver, ALeftoverWithDamagedNamesIsStartedAnew) {
    write_rows(3, false);
    const std::string whole = bytes_of(partial_);
    for (std::size_t i = 0; i < std::size(kDamages); ++i) {
        std::string file = whole;
        kDamages[i](file, all_names(whole)[0]);
        write_bytes(partial_, file);
        const TrajectoryWriter writer(path_, make_header(3), make_steps(5), false);
        EXPECT_EQ(writer.rows(), 0u) << i;
        EXPECT_EQ(writer.note(), partial_.string() + ": a group's names are damaged; starting anew")
            << i;
    }
}

}  // namespace
}  // namespace tesserae::scenes
