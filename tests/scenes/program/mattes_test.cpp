// SPDX-License-Identifier: Apache-2.0
// Cryptomattes of films: what their manifests call bodies and materials.
#include "render/mattes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "render/file/image_info.hpp"
#include "render/file/image_pixels.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

/// A still of a ball, a hidden one and a lattice of so many, whose first three are seen.
std::string mattes_scene(int count) {
    return fmt::format(R"(
[scene]
name = "three"
[camera]
position = [0, 0, -8, 0]
look_at = [0, 0, 0, 0]
[render]
size = [64, 36]
samples = 4
channels = ["color", "id", "cryptomatte"]
[[material]]
name = "gold \"K\u00f6rper\""
[[material]]
name = "nothing has it"
[[body]]
name = "ball"
shape = "hypersphere"
radius = 1
[[body]]
name = "hidden"
shape = "hypersphere"
radius = 2
visible = false
material = "nothing has it"
[[lattice]]
name = "row"
shape = "hypersphere"
radius = 0.4
position = [0, 2, 0, 0]
material = "gold \"K\u00f6rper\""
count = [3, {}, 1, 1]
spacing = [2, 1000, 1, 1]
)",
                       count / 3);
}

Outcome render_to(const std::filesystem::path& folder, const std::string& scene,
                  std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"render", scene, "-o", folder.string(), "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    Outcome outcome = tesserae(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome;
}

std::map<std::string, std::string> matte_attributes(const std::filesystem::path& file) {
    std::map<std::string, std::string> found;
    for (const render::ImageAttribute& attribute : render::read_image_info(file).attributes)
        if (attribute.name.starts_with("cryptomatte/"))
            found[attribute.name.substr(12)] = std::get<std::string>(attribute.value);
    return found;
}

TEST(MattesOfAFilm, NameBodiesAndMaterialsInTheHeader) {
    const Folder folder("mattes");
    render_to(folder / "out", folder.write("a.toml", mattes_scene(3)));
    const auto file = folder / "out/frames/three.0000.exr";
    const auto found = matte_attributes(file);
    // The key is the beginning of the layer's own hash.
    std::map<std::string, std::string> names;
    for (const auto& [name, value] : found)
        if (name.ends_with("/name")) names[value] = name.substr(0, name.size() - 5);
    ASSERT_EQ(names.size(), 2u);
    EXPECT_EQ(found.size(), 8u);
    for (const auto& [layer, key] : names) {
        EXPECT_EQ(key.size(), 7u);
        EXPECT_EQ(key, fmt::format("{:08x}", render::murmur3(layer)).substr(0, 7));
        EXPECT_EQ(found.at(key + "/hash"), "MurmurHash3_32");
        EXPECT_EQ(found.at(key + "/conversion"), "uint32_to_float32");
    }
    const auto id = [](const char* name) { return fmt::format("{:08x}", render::matte_id(name)); };
    const nlohmann::json bodies = {{"ball", id("ball")},
                                   {"row.0", id("row.0")},
                                   {"row.1", id("row.1")},
                                   {"row.2", id("row.2")}};
    EXPECT_EQ(nlohmann::json::parse(found.at(names.at("CryptoObject") + "/manifest")), bodies);
    const char* gold = "gold \"K\u00f6rper\"";
    const nlohmann::json looks = {{"default", "42c9679f"}, {gold, id(gold)}};
    EXPECT_EQ(nlohmann::json::parse(found.at(names.at("CryptoMaterial") + "/manifest")), looks);
}

TEST(MattesOfAFilm, LatticeBodiesAreNamedInTheOrderOfTheirNumbers) {
    const Folder folder("mattes");
    render_to(folder / "out", folder.write("a.toml", mattes_scene(3)), {"--samples", "1"});
    const render::ImagePixels image(folder / "out/frames/three.0000.exr");
    std::map<std::uint32_t, std::set<std::string>> seen;  // by object id
    image.for_each_block([&](int, int, const render::PixelPlanes& block) {
        std::map<std::string, std::vector<std::uint32_t>> planes;
        for (std::size_t c = 0; c < block.size(); ++c) {
            const render::ImageChannel& channel = image.channels()[c];
            const std::size_t width = render::bytes_of(channel.type);
            for (std::size_t i = 0; width == 4 && i < block[c].size(); i += width) {
                std::uint32_t bits;
                std::memcpy(&bits, block[c].data() + i, sizeof bits);
                planes[channel.name].push_back(bits);
            }
        }
        for (std::size_t i = 0; i < planes["objectid"].size(); ++i)
            seen[planes["objectid"][i]].insert(fmt::format(
                "{:08x} {:08x}", planes["CryptoObject00.R"][i], planes["CryptoMaterial00.R"][i]));
    });
    const auto ids = [](const char* object, const char* material) {
        return std::set{
            fmt::format("{:08x} {:08x}", render::matte_id(object), render::matte_id(material))};
    };
    const char* gold = "gold \"K\u00f6rper\"";
    const std::map<std::uint32_t, std::set<std::string>> expected = {{0, {"00000000 00000000"}},
                                                                     {1, ids("ball", "default")},
                                                                     {3, ids("row.0", gold)},
                                                                     {4, ids("row.1", gold)},
                                                                     {5, ids("row.2", gold)}};
    EXPECT_EQ(seen, expected);
}

TEST(MattesOfAFilm, ManyNamesAreInAFileBesideTheFrames) {
    const Folder folder("mattes");
    // With the ball 10,000 names, then three more.
    for (const int count : {9'999, 10'002}) {
        const auto out = folder / std::to_string(count);
        render_to(out, folder.write("a.toml", mattes_scene(count)));
        int files = 0;
        for (const auto& [name, value] : matte_attributes(out / "frames/three.0000.exr")) {
            if (!name.ends_with("/manif_file")) continue;
            ++files;
            EXPECT_EQ(value, "three.CryptoObject.json");
            const auto names = nlohmann::json::parse(content(out / "frames" / value));
            EXPECT_EQ(names.size(), 10'003u);
            EXPECT_EQ(names.at("row.10001"), fmt::format("{:08x}", render::matte_id("row.10001")));
        }
        EXPECT_EQ(files, count == 9'999 ? 0 : 1);
    }
    // It is not a frame.
    const auto hashed = [&](const char* name) { return tesserae({"hash", folder.file(name)}).out; };
    const std::string before = hashed("10002/frames");
    EXPECT_FALSE(before.empty());
    std::filesystem::remove(folder / "10002/frames/three.CryptoObject.json");
    EXPECT_EQ(hashed("10002/frames"), before);
    render_to(folder / "10002", folder.file("a.toml"));
    EXPECT_TRUE(std::filesystem::exists(folder / "10002/frames/three.CryptoObject.json"));
}

}  // namespace
}  // namespace tesserae::scenes::testing
