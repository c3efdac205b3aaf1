// SPDX-License-Identifier: Apache-2.0
// Images written with OpenEXR's own interface in many forms, against the pixels that went in.
#include "render/file/image_pixels.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include "core/error.hpp"
#include "render/file/image_info.hpp"
#include "render/file/whole_image.hpp"
#include "tests/error_of.hpp"
#include "tests/render/test_scene.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::render {
namespace {

namespace fs = std::filesystem;
using tesserae::testing::error_of;

class ImagePixelsTest : public ::testing::Test {
  protected:
    const testing::TemporaryFolder folder_{"image_pixels"};
    const fs::path path_ = folder_ / "a.exr";
};

/// Bits at random for three channels: infinities, numbers that are none and all else.
struct Pixels {
    Imath::Box2i window{{-3, 5}, {33, 27}};
    std::vector<std::uint32_t> ids;
    std::vector<float> depths;
    std::vector<std::uint16_t> reds;

    explicit Pixels(unsigned seed = 1) {
        std::mt19937 random(seed);
        for (int i = 0; i < 37 * 23; ++i) {
            ids.push_back(static_cast<std::uint32_t>(random()));
            depths.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
            reds.push_back(static_cast<std::uint16_t>(random()));
        }
    }
    Imf::Header header(Imf::Compression compression) const {
        Imf::Header header(window, window);
        header.compression() = compression;
        header.channels().insert("id", Imf::Channel(Imf::UINT));
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
        header.channels().insert("R", Imf::Channel(Imf::HALF));
        return header;
    }
    Imf::FrameBuffer buffer() const {
        Imf::FrameBuffer buffer;
        buffer.insert("id", Imf::Slice::Make(Imf::UINT, ids.data(), window));
        buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, depths.data(), window));
        buffer.insert("R", Imf::Slice::Make(Imf::HALF, reds.data(), window));
        return buffer;
    }
    void write_lines(const fs::path& path, Imf::Compression compression) const {
        Imf::OutputFile out(path.c_str(), header(compression), 0);
        out.setFrameBuffer(buffer());
        out.writePixels(23);
    }
    /// Only the first `count` tiles if it is not negative.
    void write_tiles(const fs::path& path, unsigned side, Imf::Compression compression,
                     Imf::LevelMode mode = Imf::ONE_LEVEL, int count = -1) const {
        Imf::Header head = header(compression);
        head.setTileDescription(Imf::TileDescription(side, side, mode));
        Imf::TiledOutputFile out(path.c_str(), head, 0);
        out.setFrameBuffer(buffer());
        for (int y = 0; y < out.numYTiles(); ++y)
            for (int x = 0; x < out.numXTiles(); ++x)
                if (count-- != 0) out.writeTile(x, y);
    }
};

template <class Value>
std::vector<unsigned char> bytes_of_all(const std::vector<Value>& values) {
    std::vector<unsigned char> bytes(values.size() * sizeof(Value));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

/// All planes of an image, read `lines` at a time.
PixelPlanes all_of(const fs::path& path, int lines) {
    const ImagePixels image(path);
    PixelPlanes all(image.channels().size()), block;
    for (int y = image.window().y0; y < image.window().y1; y += lines) {
        image.read(y, std::min(y + lines, image.window().y1), block);
        for (std::size_t c = 0; c < all.size(); ++c)
            all[c].insert(all[c].end(), block[c].begin(), block[c].end());
    }
    return all;
}

TEST_F(ImagePixelsTest, AreThoseThatWereWrittenInAnyForm) {
    const Pixels picture;
    // Ascending by name.
    const PixelPlanes expected = {bytes_of_all(picture.reds), bytes_of_all(picture.depths),
                                  bytes_of_all(picture.ids)};
    const auto check = [&](const std::string& what) {
        for (int lines : {1, 5, 23})
            ASSERT_EQ(all_of(path_, lines), expected) << what << ", by " << lines;
        const ImagePixels image(path_);
        EXPECT_EQ(image.channels(), (std::vector<ImageChannel>{{"R", PixelType::kHalf},
                                                               {"Z", PixelType::kFloat},
                                                               {"id", PixelType::kUint}}));
        const Crop& window = image.window();
        EXPECT_EQ((std::vector<int>{window.x0, window.y0, window.x1, window.y1}),
                  (std::vector<int>{-3, 5, 34, 28}));
    };
    for (Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
          Imf::PIZ_COMPRESSION}) {
        picture.write_lines(path_, compression);
        check("lines");
        for (unsigned side : {3u, 16u, 64u}) {
            picture.write_tiles(path_, side, compression);
            check("tiles of " + std::to_string(side));
        }
    }
}

TEST_F(ImagePixelsTest, ValuesAreExact) {
    const auto value = [](PixelType type, std::uint32_t bits) {
        unsigned char bytes[4];
        std::memcpy(bytes, &bits, 4);
        return value_of(type, bytes);
    };
    // IEEE 754 binary16: 0x3c00 is 1, 0x0001 the smallest, 2^-24.
    EXPECT_EQ(value(PixelType::kHalf, 0x3c00), 1);
    EXPECT_EQ(value(PixelType::kHalf, 0x0001), 0x1p-24);
    EXPECT_EQ(value(PixelType::kHalf, 0xfc00), -std::numeric_limits<double>::infinity());
    EXPECT_EQ(value(PixelType::kFloat, 0x00000001), 0x1p-149);
    EXPECT_EQ(value(PixelType::kUint, 0xffffffff), 4294967295.0);
}

TEST_F(ImagePixelsTest, RefusesWhatIsNotCompared) {
    const Pixels picture;
    const auto error = [&] {
        return error_of<InputError>([&] {
            const ImagePixels image(path_);
            image.for_each_block([](int, int, const PixelPlanes&) {});
        });
    };
    const auto expect = [&](const char* words) {
        const std::string text = error();
        EXPECT_EQ(text.find(path_.string()), 0u) << text;
        EXPECT_NE(text.find(words), std::string::npos) << text;
    };
    expect("not a file");

    picture.write_tiles(path_, 16, Imf::ZIP_COMPRESSION, Imf::MIPMAP_LEVELS);
    expect("levels");
    picture.write_tiles(path_, 16, Imf::ZIP_COMPRESSION, Imf::ONE_LEVEL, 4);
    expect("missing");

    Imf::Header subsampled(16, 16);
    subsampled.channels().insert("Y", Imf::Channel(Imf::HALF, 2, 2));
    { const Imf::OutputFile out(path_.c_str(), subsampled, 0); }
    expect("subsampled");

    Imf::Header many(4, 4);
    for (int i = 0; i < 65; ++i)
        many.channels().insert("c" + std::to_string(i), Imf::Channel(Imf::HALF));
    { const Imf::OutputFile out(path_.c_str(), many, 0); }
    expect("64 channels");

    Imf::Header wide(Imath::Box2i({0, 0}, {65536, 0}), Imath::Box2i({0, 0}, {65536, 0}));
    wide.channels().insert("R", Imf::Channel(Imf::HALF));
    { const Imf::OutputFile out(path_.c_str(), wide, 0); }
    expect("65536");

    std::vector<Imf::Header> parts(2, picture.header(Imf::ZIP_COMPRESSION));
    for (std::size_t i = 0; i < 2; ++i) {
        parts[i].setName("part" + std::to_string(i));
        parts[i].setType(Imf::SCANLINEIMAGE);
    }
    { const Imf::MultiPartOutputFile out(path_.c_str(), parts.data(), 2); }
    expect("several parts");
}

void write(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

TEST(WholeImage, IsNotSaidToBeCutWhereItCannotBeRead) {
    const tesserae::testing::TemporaryFolder folder("whole_image");
    const fs::path missing = folder / "missing.exr";
    EXPECT_EQ(error_of<InputError>([&] { is_whole_image(missing); }),
              missing.string() + ": cannot be read: No such file or directory");
    // A folder can be opened and not read.
    EXPECT_EQ(error_of<InputError>([&] { is_whole_image(folder.path()); }),
              folder.path().string() + ": cannot be read: Is a directory");
}

TEST_F(ImagePixelsTest, AHeaderThatClaimsMuchTakesNoMemory) {
    const Pixels picture;
    picture.write_tiles(path_, 16, Imf::ZIP_COMPRESSION);
    const std::string good = content(path_);
    // The data window 30000 x 30000, and tiles of one pixel or of 65536.
    const auto at = [&](const char* name) {
        const std::string text = std::string(name) + '\0';
        return good.find(text) + text.size();
    };
    const std::size_t window = at("dataWindow") + std::strlen("box2i") + 1 + 4;
    const std::size_t tiles = at("tiles") + std::strlen("tiledesc") + 1 + 4;
    for (std::uint32_t side : {1u, 65536u}) {
        std::string bad = good;
        const std::int32_t box[] = {0, 0, 29999, 29999};
        std::memcpy(bad.data() + window, box, sizeof box);
        std::memcpy(bad.data() + tiles, &side, 4);
        std::memcpy(bad.data() + tiles + 4, &side, 4);
        write(path_, bad);
        const std::string error = error_of<InputError>([&] { const ImagePixels image(path_); });
        EXPECT_NE(error.find(side == 1 ? "more tiles than bytes" : "1 GiB"), std::string::npos)
            << error;
        // What reads no pixels takes nothing for them.
        EXPECT_EQ(read_image_info(path_).x1, 30000);
    }
    // An attribute of 2 GB.
    std::string bad = good;
    const std::int32_t length = std::numeric_limits<std::int32_t>::max();
    std::memcpy(bad.data() + tiles - 4, &length, 4);
    write(path_, bad);
    const std::string error = error_of<InputError>([&] { const ImagePixels image(path_); });
    EXPECT_NE(error.find("header is cut off"), std::string::npos) << error;
    // So says what reads the header alone.
    const std::string info = error_of<InputError>([&] { read_image_info(path_); });
    EXPECT_NE(info.find("header is cut off"), std::string::npos) << info;
    // Values that OpenEXR reads by their type, whatever their length says: what follows would be
    // taken for names and lengths.
    for (const char* name : {"channels", "dataWindow", "tiles", "lineOrder", "pixelAspectRatio"}) {
        bad = good;
        const std::size_t type = at(name), value = good.find('\0', type) + 1;
        bad[value] = static_cast<char>(bad[value] + (std::string(name) == "channels" ? -1 : 1));
        bad.insert(value + 4, 1, '\x7f');
        write(path_, bad);
        const std::string told = error_of<InputError>([&] { read_image_info(path_); });
        EXPECT_NE(told.find("its header"), std::string::npos) << name << ": " << told;
    }
    // A preview of (2^31 - 1)^2 pixels, whose bytes no 64 bits with a sign count.
    bad = good;
    const std::string size = "\xff\xff\xff\x7f";
    bad.insert(8, "thumb" + std::string(1, '\0') + "preview" + std::string(1, '\0') + '\x08' +
                      std::string(3, '\0') + size + size);
    write(path_, bad);
    const std::string told = error_of<InputError>([&] { read_image_info(path_); });
    EXPECT_NE(told.find("its header"), std::string::npos) << told;
}

TEST_F(ImagePixelsTest, DamageIsAnErrorOrOtherPixelsNeverACrash) {
    const Pixels picture;
    std::mt19937 random(7);
    int errors = 0;
    for (int round = 0; round < 200; ++round) {
        const auto compression =
            round % 3 == 0 ? Imf::PIZ_COMPRESSION
                           : (round % 3 == 1 ? Imf::ZIP_COMPRESSION : Imf::RLE_COMPRESSION);
        round % 2 == 0 ? picture.write_lines(path_, compression)
                       : picture.write_tiles(path_, 16, compression);
        std::string bytes = content(path_);
        if (round % 5 == 0) {
            bytes.resize(random() % bytes.size());
        } else {
            // Half of the flips in the header.
            const std::size_t end = round % 2 == 0 ? bytes.size() : 500;
            for (int flips = 1 + static_cast<int>(random() % 4); flips > 0; --flips)
                bytes[random() % end] ^= static_cast<char>(1u << random() % 8);
        }
        write(path_, bytes);
        const std::string error = error_of<InputError>([&] {
            const ImagePixels image(path_);
            image.for_each_block([](int, int, const PixelPlanes&) {});
        });
        errors += error.empty() ? 0 : 1;
    }
    EXPECT_GT(errors, 100);
}

}  // namespace
}  // namespace tesserae::render
