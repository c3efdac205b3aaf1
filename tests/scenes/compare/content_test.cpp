// SPDX-License-Identifier: Apache-2.0
// What a hash depends on and what not, against files rewritten in other forms and the manifest
// recomputed from its description.
#include "scenes/compare/content.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <set>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include "core/error.hpp"
#include "scenes/compare/difference.hpp"
#include "scenes/load/hash.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/compare/written_files.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;
using tesserae::testing::error_of;

class ContentTest : public ::testing::Test {
  protected:
    std::string hash(const fs::path& path) const { return read_content(path).hash(); }

    void expect_damage_is_told(int rounds);

    const Folder folder_{"content"};
    const fs::path a_ = folder_ / "a.h5", b_ = folder_ / "b.h5";
    const fs::path image_a_ = folder_ / "a.exr", image_b_ = folder_ / "b.exr";
};
using ContentTestSlow = ContentTest;

TEST(StreamHash, IsThatOfThePiecesInARow) {
    // The hash of nothing: xxHash's own documentation of XXH3_128bits with seed 0.
    EXPECT_EQ(StreamHash().hex(), "99aa06d3014798d86001c324468d497f");
    std::mt19937 random(1);
    std::string all(10'000, '\0');
    for (char& c : all) c = static_cast<char>(random());
    StreamHash pieces;
    for (std::size_t at = 0; at < all.size();) {
        const std::size_t count = std::min<std::size_t>(random() % 700, all.size() - at);
        pieces.add(all.data() + at, count);
        at += count;
    }
    EXPECT_EQ(pieces.hex(), hex_hash(all));
}

TEST_F(ContentTest, OfATrajectoryIsRecomputedFromItsDescription) {
    write_trajectory(a_);
    // Type and shape by the format of trajectories, the values from HDF5 itself.
    const std::map<std::string, std::string> width = {
        {"position", "[4]"},         {"rotor", "[8]"},    {"velocity", "[4]"},
        {"angular_velocity", "[6]"}, {"momentum", "[4]"}, {"angular_momentum", "[6]"}};
    const std::set<std::string> described = {"particles/bodies/name", "particles/bodies/shape",
                                             "particles/bodies/size"};
    const auto counted = [](const std::string& text) {
        const std::uint64_t length = text.size();
        return std::string(reinterpret_cast<const char*>(&length), 8) + text;
    };
    std::string manifest = "tesserae content 1\ntrajectory\n";
    for (const auto& [name, bytes] : datasets_of(a_)) {
        std::string line = "\"/" + name + "\" ", values = bytes;
        if (name == "parameters/scene/effective") {
            line += "text []";
            values = counted(bytes);
        } else if (bytes.empty() || name.starts_with("parameters")) {
            continue;
        } else if (name == "particles/bodies/id") {
            line += "int64 [3]";
        } else if (name == "particles/bodies/mass") {
            line += "float64 [3]";
        } else if (described.contains(name)) {
            line += "text [3]";
            values.clear();
            for (std::size_t i = 0; i < 3; ++i)
                values += counted(bytes.substr(i * bytes.size() / 3, bytes.size() / 3).c_str());
        } else {
            const std::string parent = fs::path(name).parent_path().filename();
            const bool is_state = name.starts_with("particles");
            if (name.ends_with("/step"))
                line += "int64 [5]";
            else if (name.ends_with("/time"))
                line += "float64 [5]";
            else
                line += (parent == "contacts" || parent == "asleep" || parent == "sweeps"
                             ? "int64 [5]"
                             : "float64 [5]") +
                        std::string(is_state ? "[3]" : "") +
                        (width.contains(parent) ? width.at(parent) : "");
        }
        manifest += line + " " + hex_hash(values) + "\n";
    }
    EXPECT_EQ(read_content(a_).manifest(), manifest);
    EXPECT_EQ(hash(a_), hex_hash(manifest));
}

TEST_F(ContentTest, OfATrajectoryDoesNotDependOnHowItIsStored) {
    write_trajectory(a_);
    for (const Form& form :
         {Form{}, Form{.big_endian = true}, Form{.chunked = true},
          Form{.chunked = true, .compressed = true, .chunk = 3},
          Form{.chunked = true, .compressed = true, .big_endian = true, .chunk = 1000}}) {
        copy_in_form(a_, b_, form);
        ASSERT_EQ(hash(b_), hash(a_)) << read_content(b_).manifest();
        EXPECT_EQ(text_of(compare(a_, b_)), "equal");
    }
}

TEST_F(ContentTest, OfALargeDatasetIsThatOfItsBytesInAnyChunks) {
    // 10 MB: two slabs.
    const std::vector<hsize_t> extent = {521, 301, 8};
    std::mt19937_64 random(2);
    std::string bytes(521 * 301 * 8 * 8, '\0');
    for (std::size_t at = 0; at < bytes.size(); at += 8) {
        const std::uint64_t bits = random();
        std::memcpy(bytes.data() + at, &bits, 8);
    }
    write_trajectory(a_);
    const std::vector<std::vector<hsize_t>> chunks = {{},          {1, 301, 8},   {521, 40, 8},
                                                      {64, 50, 5}, {521, 301, 8}, {3, 301, 8},
                                                      {1, 6, 8},   {40, 2, 1}};
    for (const std::vector<hsize_t>& chunk : chunks) {
        const hid_t file = H5Fopen(a_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        const hid_t space = H5Screate_simple(3, extent.data(), nullptr);
        const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
        if (!chunk.empty()) H5Pset_chunk(creation, 3, chunk.data());
        const hid_t data =
            H5Dcreate2(file, "/x", H5T_STD_U64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
        H5Dwrite(data, H5T_STD_U64LE, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
        H5Dclose(data);
        H5Pclose(creation);
        H5Sclose(space);
        H5Fclose(file);
        const ContentEntry entry = read_content(a_).entries.back();
        EXPECT_EQ(entry, (ContentEntry{"/x", "uint64 [521][301][8]", hex_hash(bytes)}));
        const hid_t again = H5Fopen(a_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        H5Ldelete(again, "/x", H5P_DEFAULT);
        H5Fclose(again);
    }
}

/// HDF5 takes 2 KB for every chunk that one call reads.
TEST_F(ContentTest, OfManySmallChunksTakesLittleMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the sanitizers need addresses of their own";
#endif
    write_trajectory(a_);
    const hid_t file = H5Fopen(a_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const std::vector<std::uint8_t> values(100'000, 7);
    make_dataset(file, "/x", H5T_STD_U8LE, {values.size()}, 1);
    const hid_t data = H5Dopen2(file, "/x", H5P_DEFAULT);
    for (hsize_t at = 0; at < values.size(); at += 1000) {
        const hid_t space = H5Dget_space(data);
        const hsize_t count = 1000;
        H5Sselect_hyperslab(space, H5S_SELECT_SET, &at, nullptr, &count, nullptr);
        const hid_t memory = H5Screate_simple(1, &count, nullptr);
        H5Dwrite(data, H5T_STD_U8LE, memory, space, H5P_DEFAULT, values.data());
        H5Sclose(memory);
        H5Sclose(space);
    }
    H5Dclose(data);
    H5Fclose(file);
    const pid_t child = ::fork();
    if (child == 0) {
        std::uint64_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const rlim_t most = pages * 4096 + (100 << 20);
        const rlimit limit = {most, most};
        ::setrlimit(RLIMIT_AS, &limit);
        ::_exit(error_of<InputError>([&] { read_content(a_); }).empty() ? 7 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 7);
}

TEST_F(ContentTest, OfATrajectoryChangesWithNamesTypesShapesAndTheEffectiveText) {
    std::set<std::string> hashes;
    const auto changed = [&](const char* what, auto&& change) {
        write_trajectory(a_);
        const hid_t file = H5Fopen(a_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        change(file);
        H5Fclose(file);
        EXPECT_TRUE(hashes.insert(hash(a_)).second) << what;
        fs::remove(a_);
    };
    const auto add = [](hid_t file, const char* name, hid_t type, std::vector<hsize_t> extent) {
        const std::vector<double> zeros(8, 0);
        const hid_t space =
            H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
        const hid_t data =
            H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data());
        H5Dclose(data);
        H5Sclose(space);
    };
    changed("nothing", [](hid_t) {});
    for (const char* name : {"/x", "/y"})
        changed(name, [&](hid_t f) { add(f, name, H5T_IEEE_F64LE, {2, 3}); });
    changed("shape", [&](hid_t f) { add(f, "/x", H5T_IEEE_F64LE, {3, 2}); });
    changed("rank", [&](hid_t f) { add(f, "/x", H5T_IEEE_F64LE, {6}); });
    for (hid_t type :
         {H5T_STD_I64LE, H5T_STD_U64LE, H5T_IEEE_F32LE, H5T_STD_I32LE, H5T_STD_U16LE, H5T_STD_I8LE})
        changed("type", [&](hid_t f) { add(f, "/x", type, {2, 3}); });
    changed("removed", [](hid_t f) { H5Ldelete(f, "/observables/contacts/value", H5P_DEFAULT); });
    changed("moved", [](hid_t f) {
        H5Lmove(f, "/observables/contacts", f, "/observables/Contacts", H5P_DEFAULT, H5P_DEFAULT);
    });
    changed("second name", [](hid_t f) {
        H5Lcreate_hard(f, "/particles/bodies/id", f, "/id", H5P_DEFAULT, H5P_DEFAULT);
    });

    TrajectoryHeader header = make_header(kTestBodies);
    header.effective = "affective";
    write_trajectory(a_, header, 5, [](std::uint64_t, Row&) {});
    EXPECT_TRUE(hashes.insert(hash(a_)).second);
}

TEST_F(ContentTest, OfATrajectoryDoesNotDependOnWhoWroteItNorOnInterruptions) {
    write_trajectory(a_);
    TrajectoryHeader header = make_header(kTestBodies);
    header.program_version = "9.9";
    header.source = "# another source of the same scene\n";
    {
        TrajectoryWriter writer(b_, header, make_steps(5), false);
        append_rows(writer, 2, kTestBodies);
    }
    TrajectoryWriter writer(b_, header, make_steps(5), false);
    append_rows(writer, 5, kTestBodies);
    writer.finish();
    EXPECT_EQ(hash(a_), hash(b_));
    const hid_t file = H5Fopen(b_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t space = H5Screate(H5S_SCALAR), group = H5Gopen2(file, "/particles", H5P_DEFAULT);
    H5Aclose(H5Acreate2(group, "note", H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT));
    H5Gclose(group);
    H5Sclose(space);
    H5Fclose(file);
    EXPECT_EQ(hash(a_), hash(b_));
}

TEST_F(ContentTest, RefusesFilesThatAreNoTrajectoriesAtOnce) {
    const auto make = [](hid_t f, const char* name, hid_t type, hid_t space, hid_t creation) {
        H5Dclose(H5Dcreate2(f, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    };
    const auto refused = [&](const char* words, auto&& damage) {
        write_trajectory(a_);
        const hid_t file = H5Fopen(a_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
        damage(file, creation);
        H5Pclose(creation);
        H5Fclose(file);
        const std::string error = error_of<InputError>([&] { read_content(a_); });
        EXPECT_EQ(error.find(a_.string()), 0u) << error;
        EXPECT_NE(error.find(words), std::string::npos) << error << "; expected " << words;
        fs::remove(a_);
    };
    write_trajectory(b_);  // starts HDF5 as the program does
    const hsize_t huge = 1'000'000'000'000;
    const hid_t scalar = H5Screate(H5S_SCALAR), much = H5Screate_simple(1, &huge, nullptr);
    const hid_t text = H5Tcopy(H5T_C_S1), pair = H5Tcreate(H5T_COMPOUND, 16);
    H5Tset_size(text, H5T_VARIABLE);
    H5Tinsert(pair, "a", 0, H5T_IEEE_F64LE);
    refused("link to another place", [](hid_t f, hid_t) {
        H5Lcreate_soft("/particles", f, "/particles/loop", H5P_DEFAULT, H5P_DEFAULT);
    });
    refused("link to another place", [](hid_t f, hid_t) {
        H5Lcreate_external("other.h5", "/x", f, "/x", H5P_DEFAULT, H5P_DEFAULT);
    });
    refused("deeper than 16", [](hid_t f, hid_t) {
        H5Lcreate_hard(f, "/particles", f, "/particles/bodies/loop", H5P_DEFAULT, H5P_DEFAULT);
    });
    refused("more than 10000 objects", [](hid_t f, hid_t) {
        const hid_t group = H5Gcreate2(f, "/a", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        std::vector<hid_t> level = {group};
        for (int depth = 0; depth < 13; ++depth) {
            const hid_t next = H5Gcreate_anon(f, H5P_DEFAULT, H5P_DEFAULT);
            for (const char* name : {"0", "1", "2"})
                H5Olink(next, level.back(), name, H5P_DEFAULT, H5P_DEFAULT);
            level.push_back(next);
        }
        for (hid_t id : level) H5Gclose(id);
    });
    refused("claims to hold more",
            [&](hid_t f, hid_t c) { make(f, "/x", H5T_IEEE_F64LE, much, c); });
    refused("chunks of more than 256 MiB", [&](hid_t f, hid_t c) {
        const hsize_t chunk = 1 << 26;
        H5Pset_chunk(c, 1, &chunk);
        make(f, "/x", H5T_IEEE_F64LE, much, c);
    });
    refused("unknown filter", [&](hid_t f, hid_t c) {
        const hsize_t chunk = 16;
        H5Pset_chunk(c, 1, &chunk);
        H5Pset_nbit(c);
        make(f, "/x", H5T_STD_I32LE, much, c);
    });
    refused("in another file", [&](hid_t f, hid_t c) {
        H5Pset_external(c, "/dev/zero", 0, H5F_UNLIMITED);
        make(f, "/x", H5T_IEEE_F64LE, much, c);
    });
    refused("variable length", [&](hid_t f, hid_t c) { make(f, "/x", text, scalar, c); });
    refused("type that is not compared", [&](hid_t f, hid_t c) { make(f, "/x", pair, scalar, c); });
    refused("type that is not compared",
            [&](hid_t f, hid_t c) { make(f, "/x", H5T_STD_REF_OBJ, scalar, c); });
    refused("doesn't exist",
            [](hid_t f, hid_t) { H5Ldelete(f, "/parameters/scene/effective", H5P_DEFAULT); });
    refused("neither a group nor a dataset", [](hid_t f, hid_t) {
        const hid_t type = H5Tcopy(H5T_STD_I32LE);
        H5Tcommit2(f, "/x", type, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        H5Tclose(type);
    });
    for (hid_t id : {text, pair}) H5Tclose(id);
    for (hid_t id : {scalar, much}) H5Sclose(id);
}

TEST_F(ContentTest, OfAnImageIsRecomputedFromItsDescription) {
    const WrittenImage image;
    image.write(image_a_);
    const auto line = [](const char* name, const char* type, const auto& values) {
        const std::string bytes(reinterpret_cast<const char*>(values.data()), 4 * values.size());
        return "\"" + std::string(name) + "\" " + type + " 2,-1 to 21,13 " + hex_hash(bytes) + "\n";
    };
    const std::string manifest =
        "tesserae content 1\nimage\n" + line("R", "float", image.floats.at("R")) +
        line("Z", "float", image.floats.at("Z")) + line("id", "uint", image.ids);
    EXPECT_EQ(read_content(image_a_).manifest(), manifest);
    EXPECT_EQ(hash(image_a_), hex_hash(manifest));
}

TEST_F(ContentTest, OfAnImageDoesNotDependOnHowItIsStored) {
    WrittenImage image;
    image.floats["Z"][5] = std::numeric_limits<float>::quiet_NaN();
    image.write(image_a_);
    for (int tile : {0, 1, 5, 64})
        for (auto compression :
             {Imf::NO_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::ZIPS_COMPRESSION}) {
            image.write(image_b_, tile, compression, "another attribute");
            ASSERT_EQ(hash(image_b_), hash(image_a_)) << tile;
            EXPECT_TRUE(compare(image_a_, image_b_).is_equal());
        }
}

TEST_F(ContentTest, OfAnImageChangesWithNamesWindowAndEveryBit) {
    std::set<std::string> hashes;
    const auto changed = [&](const char* what, auto&& change) {
        WrittenImage image;
        change(image);
        image.write(image_a_);
        EXPECT_TRUE(hashes.insert(hash(image_a_)).second) << what;
    };
    changed("nothing", [](WrittenImage&) {});
    changed("zero's sign", [](WrittenImage& i) { i.floats["Z"][0] = -0.0f; });
    changed("an ulp", [](WrittenImage& i) {
        float& value = i.floats["R"][100];
        value = std::nextafter(value, 1e9f);
    });
    changed("an id", [](WrittenImage& i) { i.ids[3] ^= 1; });
    changed("two channels swapped",
            [](WrittenImage& i) { std::swap(i.floats["R"], i.floats["Z"]); });
    changed("a name", [](WrittenImage& i) {
        auto channel = i.floats.extract("Z");
        channel.key() = "z";
        i.floats.insert(std::move(channel));
    });
    changed("the window", [](WrittenImage& i) { ++i.window.min.x, ++i.window.max.x; });
}

TEST_F(ContentTest, OfAFolderIsThatOfItsFrames) {
    const fs::path frames = folder_ / "film/frames", plain = folder_ / "plain";
    fs::create_directories(frames);
    fs::create_directories(plain);
    EXPECT_NE(error_of<InputError>([&] { read_content(plain); }).find("no frames"),
              std::string::npos);
    WrittenImage image;
    std::string manifest = "tesserae content 1\nframes\n";
    for (int i = 0; i < 12; ++i) {
        image.ids[0] = static_cast<std::uint32_t>(i);
        const std::string name = fmt::format("film.{:04}.exr", i);
        image.write(frames / name);
        image.write(plain / name, 0);
        manifest += fmt::format("\"{}\" image {}\n", name, hash(frames / name));
    }
    EXPECT_EQ(hash(folder_ / "film"), hex_hash(manifest));
    EXPECT_EQ(hash(plain), hex_hash(manifest));
    folder_.write("plain/film.0012.exr.partial", "unfinished");
    folder_.write("plain/scene.toml", "");
    EXPECT_EQ(hash(plain), hex_hash(manifest));

    // Of two broken frames the first by name is told.
    folder_.write("plain/film.0003.exr", "broken");
    folder_.write("plain/film.0007.exr", "broken");
    EXPECT_NE(error_of<InputError>([&] { read_content(plain); }).find("film.0003.exr"),
              std::string::npos);
}

void ContentTest::expect_damage_is_told(int rounds) {
#ifdef __SANITIZE_ADDRESS__
    // HDF5 1.10 itself loses some bytes where it gives up on a damaged file.
    const __lsan::ScopedDisabler not_ours;
#endif
    write_trajectory(a_);
    const std::string good = content(a_), hash_of_good = hash(a_);
    std::mt19937_64 random(3);
    int errors = 0;
    for (int round = 0; round < rounds; ++round) {
        std::string bytes = good;
        if (round % 10 == 0)
            bytes.resize(random() % bytes.size());
        else
            for (std::uint64_t flips = 1 + random() % 3; flips > 0; --flips)
                bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
        folder_.write("b.h5", bytes);
        errors += error_of<InputError>([&] { compare(a_, b_); }).empty() ? 0 : 1;
    }
    EXPECT_GT(errors, rounds / 10);
    EXPECT_EQ(hash(a_), hash_of_good);
}

TEST_F(ContentTest, DamageInATrajectoryIsAnErrorOrOtherContentNeverACrash) {
    expect_damage_is_told(50);
}
TEST_F(ContentTestSlow, DamageInATrajectoryIsAnErrorOrOtherContentNeverACrash) {
    expect_damage_is_told(150);
}

}  // namespace
}  // namespace tesserae::scenes::testing
