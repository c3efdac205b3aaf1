// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "scenes/load/scene_text.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

const std::string kSeed = R"(# a scene to be damaged
[scene]
name = "fuzz"
[physics]
gravity = [0, -9.81, 0, 0]
duration = 2.5
seed = 0x7F
[[material]]
name = 'red # not a comment'
albedo = [0.8, 0.1, 0.1]
pattern = """checker"""
[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 2, 0, 0]
[[body]]
shape = "hypercapsule"
radius = 0.5
height = 1_0
rotation.xy = 30
rotation.zw = 1.5e1
[body.angular_velocity]
xw = 2.0
[[lattice]]
shape = "hyperbox"
size = [1, 1, 1, 1]
count = [2, 3, 1, 2]
spacing = [1,
  2, # comment "
  3, 4]
jitter = 0.1
[[joint]]
type = "general"
a = "body-1"
b = "floor"
anchor = [0, 1, 0, 0.5]
free = ["x", "yz"]
limits.x = [-1, 2]
motor = { yz = { target = 20, max = 5 } }
[camera]
look_at = [0, 1, 0, 0.5]
[[light]]
type = "sun"
direction = [1, -2, 1, 0.5]
[render]
size = [640, 360]
channels = ["color", "id"]
)";

class Damage {
  public:
    explicit Damage(std::uint64_t seed) : random_(seed) {}

    std::string operator()(std::string text) {
        for (std::size_t n = 1 + below(4); n > 0; --n) once(text);
        return text;
    }

  private:
    std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

    void once(std::string& text) {
        static const std::vector<std::string> kTokens = {"[",
                                                         "]",
                                                         "[[",
                                                         "]]",
                                                         "{",
                                                         "}",
                                                         "=",
                                                         ",",
                                                         ".",
                                                         "\"",
                                                         "'",
                                                         "\"\"\"",
                                                         "'''",
                                                         "#",
                                                         "\n",
                                                         "\r",
                                                         "\r\n",
                                                         "\\",
                                                         "\\u0000",
                                                         "nan",
                                                         "-inf",
                                                         "1e999",
                                                         "-1",
                                                         "0",
                                                         "9223372036854775807",
                                                         "[[body]]\n",
                                                         "[body.rotation]\n",
                                                         "[[lattice]]\n",
                                                         "[render]\n",
                                                         "body",
                                                         "name = \"floor\"\n",
                                                         "true",
                                                         "1979-05-27T07:32:00Z",
                                                         "a.b.c",
                                                         "\xff",
                                                         "\xe2\x82",
                                                         "\xe2\x80\xa8",
                                                         "\xef\xbb\xbf",
                                                         "[10000, 10000, 10000, 1]",
                                                         "{ xy = 1, xy = 2 }",
                                                         "1e300",
                                                         "5e-324",
                                                         "0.0000000001"};
        const std::size_t at = below(text.size());
        switch (below(6)) {
            case 0:
                if (!text.empty()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
                break;
            case 1:
                text.resize(at);
                break;
            case 2:
                text.insert(at, kTokens[below(kTokens.size())]);
                break;
            case 3:
                text.erase(at, 1 + below(30));
                break;
            case 4:
                text.insert(below(text.size()), text.substr(at, 1 + below(200)));
                break;
            default: {
                // Swap two lines' worth of text.
                const std::size_t length = 1 + below(20), other = below(text.size());
                const std::string piece = text.substr(at, length);
                text.replace(std::min(other, text.size()), length, piece);
            }
        }
    }

    std::mt19937_64 random_;
};

void expect_damaged_scenes_load_or_not(int scenes) {
    const SceneFile file("");
    Damage damage(20240607);
    int loaded = 0, refused = 0;
    for (int i = 0; i < scenes; ++i) {
        const std::string text = damage(kSeed);
        // A new file each time: some file systems sync one that is cut to nothing and written
        // again.
        std::filesystem::remove(file.path());
        std::ofstream(file.path(), std::ios::binary) << text;
        try {
            const Scene scene = load_scene(file.path(), {});
            for (const Vec4& p : scene.bodies.position) ASSERT_TRUE(p.allFinite()) << text;
            for (const BodyType& t : scene.bodies.types) ASSERT_TRUE(std::isfinite(t.mass)) << text;
            ++loaded;
        } catch (const InputError& error) {
            const std::string_view message = error.what();
            ASSERT_TRUE(message.starts_with(file.path().string())) << message << "\n" << text;
            ++refused;
        }
    }
    // Both roads were walked: most damage is seen, some (in comments and digits) does not matter.
    EXPECT_GT(loaded, scenes / 100);
    EXPECT_GT(refused, scenes / 2);
}

TEST(LoadFuzz, DamagedScenesLoadOrAreRefused) { expect_damaged_scenes_load_or_not(2000); }
TEST(LoadFuzzSlow, DamagedScenesLoadOrAreRefused) { expect_damaged_scenes_load_or_not(8000); }

void expect_damaged_overrides_load_or_not(int overrides) {
    const SceneFile file(kSeed);
    Damage damage(7);
    const std::vector<std::string> seeds = {
        "body.floor.normal=[0, 1, 0, 1]", "render.crop=[0, 0, 8, 8]",
        "lattice.body-2.count=[1, 2, 1, 1]", "body.\"body-1\".rotation={ xy = 30 }"};
    for (int i = 0; i < overrides; ++i) {
        const std::vector<std::string> sets = {
            damage(seeds[static_cast<std::size_t>(i) % seeds.size()])};
        try {
            load_scene(file.path(), sets);
        } catch (const InputError& error) {
            const std::string_view message = error.what();
            ASSERT_TRUE(message.starts_with("--set ") || message.starts_with(file.path().string()))
                << message;
        }
    }
}

TEST(LoadFuzz, DamagedOverridesLoadOrAreRefused) { expect_damaged_overrides_load_or_not(1000); }
TEST(LoadFuzzSlow, DamagedOverridesLoadOrAreRefused) { expect_damaged_overrides_load_or_not(4000); }

/// Cutting loses nothing: the pieces in the gaps of the rest are the text again.
TEST(LoadFuzz, PiecesAddUpToTheText) {
    Damage damage(99);
    for (int i = 0; i < 5000; ++i) {
        const std::string text = damage(kSeed + kSeed);
        SceneText cut;
        try {
            cut = cut_scene_text(text, "x");
        } catch (const InputError&) {
            continue;
        }
        ASSERT_EQ(std::count(cut.rest.begin(), cut.rest.end(), '\n'),
                  std::count(text.begin(), text.end(), '\n'));
        std::size_t total = cut.rest.size();
        for (const TextPiece& piece : cut.bodies) {
            total += piece.text.size();
            total -=
                static_cast<std::size_t>(std::count(piece.text.begin(), piece.text.end(), '\n'));
            const auto start = static_cast<std::size_t>(piece.text.data() - text.data());
            ASSERT_EQ(piece.lines_before,
                      static_cast<std::size_t>(std::count(
                          text.begin(), text.begin() + static_cast<std::ptrdiff_t>(start), '\n')));
        }
        ASSERT_EQ(total, text.size());
    }
}

}  // namespace
}  // namespace tesserae::scenes
