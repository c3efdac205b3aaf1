// SPDX-License-Identifier: Apache-2.0
// Previews of any size: means over areas, whoever renders which part of the picture.
#include "render/file/preview.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <fstream>

#include "render/file/part_file.hpp"
#include "render/file/preview_file.hpp"
#include "render/frame.hpp"
#include "tests/render/png_picture.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// Bodies, edges, a lamp and a sky, in a picture of any size.
TestScene scene_of(int width, int height, int preview_size, Sky sky) {
    Random random(7);
    TestScene scene;
    scene.settings.width = width, scene.settings.height = height;
    scene.settings.samples = 2;
    scene.settings.tile = 16;
    scene.settings.preview_size = preview_size;
    scene.settings.exposure = 0.5;
    scene.settings.sky = sky;
    for (int i = 0; i < 40; ++i)
        scene.add(random_shape(random, i % kShapeKinds, 0.6), random_vector(random, 2),
                  random_rotor(random));
    Sun sun;
    sun.direction = Vec4(0.3, -1, 0.4, 0.1).normalized();
    scene.lights.suns.push_back(sun);
    scene.lights.spheres.push_back({Vec4(0, 3, 3, 0), 1.5, Color(0.5, 0.25, 0)});
    scene.lights.sky = {0.2, 0.25, 0.3};
    return scene;
}

PreviewSize size_of(int width, int height, int preview_size) {
    Settings settings;
    settings.width = width, settings.height = height, settings.preview_size = preview_size;
    return preview_size_of(settings, settings.window());
}

TEST(Preview, IsAsLargeAsItSays) {
    struct Case {
        int width, height, preview_size, preview_width, preview_height;
    };
    const Case cases[] = {
        // What a scene does not say: the picture's size, up to 1920.
        {1280, 720, 0, 1280, 720},
        {1920, 1081, 0, 1920, 1081},
        {2048, 1152, 0, 1920, 1080},
        {2560, 1440, 0, 1920, 1080},
        {65536, 4, 0, 1920, 2},
        {100, 65536, 0, 100, 65536},
        // What it says: 57 * 40 / 101 = 22.6, 90 / 2 = 45 is as near to 44 as to 46.
        {3840, 2160, 3840, 3840, 2160},
        {3840, 2160, 2560, 2560, 1440},
        {101, 57, 40, 40, 22},
        {101, 57, 100, 100, 56},
        {101, 57, 101, 101, 57},
        {150, 90, 75, 75, 46},
        {64, 7, 1, 1, 2},
        {3, 1, 2, 2, 2}};
    for (const Case& c : cases) {
        const PreviewSize size = size_of(c.width, c.height, c.preview_size);
        EXPECT_EQ(size.width, c.preview_width) << c.width << "x" << c.height;
        EXPECT_EQ(size.height, c.preview_height) << c.width << "x" << c.height;
    }
    // A crop is shown in full where it is narrower.
    Settings settings;
    settings.width = 3000, settings.height = 2000, settings.preview_size = 1000;
    EXPECT_EQ(preview_size_of(settings, {0, 0, 900, 33}).width, 900);
    EXPECT_EQ(preview_size_of(settings, {0, 0, 900, 33}).height, 33);
    EXPECT_EQ(preview_size_of(settings, {500, 0, 2000, 300}).height, 200);
}

/// The mean over a pixel of the preview of what `value` says of the picture's pixels.
template <class Value>
double mean_over(const Image& image, const Png& png, int x, int y, const Value& value) {
    using Real = long double;
    const Real across = Real(image.width) / png.width, down = Real(image.height) / png.height;
    const auto overlap = [](Real begin, Real end, int pixel) {
        return std::max<Real>(0, std::min<Real>(end, pixel + 1) - std::max<Real>(begin, pixel));
    };
    // One more pixel on each side than the area can reach.
    const auto first = [](Real begin) { return std::max(0, static_cast<int>(begin) - 1); };
    const auto after = [](Real end, int size) { return std::min(size, static_cast<int>(end) + 2); };
    Real sum = 0;
    for (int v = first(y * down); v < after((y + 1) * down, image.height); ++v)
        for (int u = first(x * across); u < after((x + 1) * across, image.width); ++u) {
            const Real area =
                overlap(x * across, (x + 1) * across, u) * overlap(y * down, (y + 1) * down, v);
            if (area > 0) sum += area * value(u, v);
        }
    return static_cast<double>(sum / (across * down));
}

/// Half a code, and where sRGB is steepest (3295 codes per unit) the steps of 2^-20 of the sums.
constexpr double kStep = 3295.0 / (1 << 20);

void expect_means(int width, int height, int preview_size, Sky sky) {
    const TestScene scene = scene_of(width, height, preview_size, sky);
    const Folder folder;
    render(scene, folder / "a.exr", folder / "a.png");
    const Image image = read_exr(folder / "a.exr");
    const Png png(folder / "a.png");
    ASSERT_EQ(png.width, static_cast<std::uint32_t>(preview_size));
    ASSERT_EQ(png.channels, sky == Sky::kTransparent ? 4u : 3u);
    const double gain = std::exp2(scene.settings.exposure);
    int clear = 0, partly = 0;
    for (int y = 0; y < static_cast<int>(png.height); ++y)
        for (int x = 0; x < static_cast<int>(png.width); ++x) {
            std::array<double, 3> light;
            for (std::size_t c = 0; c < 3; ++c)
                light[c] = mean_over(image, png, x, y, [&](int u, int v) {
                    return std::clamp(gain * image.at(std::string(1, "RGB"[c]), u, v), 0.0, 1.0);
                });
            double alpha = 1;
            if (sky == Sky::kTransparent) {
                alpha = mean_over(image, png, x, y,
                                  [&](int u, int v) { return double(image.at("A", u, v)); });
                // The disc of a lamp has no coverage.
                if (alpha == 0) alpha = *std::max_element(light.begin(), light.end());
                ASSERT_NEAR(png.at(x, y)[3], 255 * alpha, 0.5 + kStep) << x << " " << y;
                clear += alpha == 0, partly += alpha > 0 && alpha < 1;
            }
            for (std::size_t c = 0; c < 3; ++c) {
                const double colour = alpha > 0 ? std::min(1.0, light[c] / alpha) : 0;
                const double step = alpha > 0 ? kStep / alpha : 0;
                ASSERT_NEAR(png.at(x, y)[c], srgb_code(colour), 0.5 + step)
                    << x << " " << y << " of " << width << "x" << height;
            }
        }
    if (sky != Sky::kTransparent) return;
    EXPECT_GT(clear, 5);
    EXPECT_GT(partly, 20);
}

TEST(Preview, IsTheMeanOverAreas) {
    for (const Sky sky : {Sky::kOpaque, Sky::kTransparent})
        for (const int preview_size : {40, 100}) expect_means(101, 57, preview_size, sky);
    // Squares of two and of three pixels, an odd number of halves, wide and flat.
    expect_means(96, 60, 48, Sky::kOpaque);
    expect_means(96, 60, 32, Sky::kOpaque);
    expect_means(150, 90, 75, Sky::kOpaque);
    expect_means(67, 9, 1, Sky::kOpaque);
    expect_means(67, 1, 40, Sky::kOpaque);
}

TEST(Preview, HasThePicturesPixelsWhereItHasItsSize) {
    const TestScene scene = scene_of(101, 57, 0, Sky::kOpaque);
    const Folder folder;
    render(scene, folder / "a.exr", folder / "a.png");
    const Image image = read_exr(folder / "a.exr");
    const Png png(folder / "a.png");
    ASSERT_EQ(png.width, 101u);
    ASSERT_EQ(png.height, 57u);
    const double gain = std::exp2(scene.settings.exposure);
    for (int y = 0; y < 57; ++y)
        for (int x = 0; x < 101; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(
                    png.at(x, y)[c],
                    srgb_code(std::min(1.0, gain * image.at(std::string(1, "RGB"[c]), x, y))),
                    0.5 + kStep);
}

TEST(PreviewSlow, HasTheSameBytesHoweverThePictureIsCut) {
    for (const Sky sky : {Sky::kOpaque, Sky::kTransparent}) {
        TestScene scene = scene_of(101, 57, 40, sky);
        const Folder folder;
        render(scene, folder / "a.exr", folder / "a.png", 1);
        const std::string expected = content(folder / "a.png");
        ASSERT_TRUE(remake_preview(folder / "a.exr", scene.settings, {}, folder / "again.png"));
        EXPECT_EQ(content(folder / "again.png"), expected);
        for (const int tile : {8, 32, 64})
            for (const int threads : {1, 4}) {
                scene.settings.tile = tile;
                render(scene, folder / "b.exr", folder / "b.png", threads);
                EXPECT_EQ(content(folder / "b.png"), expected) << tile << " " << threads;
                for (const int count : {1, 3}) {
                    std::vector<std::filesystem::path> parts;
                    const std::atomic<bool> stop = false;
                    for (int number = 1; number <= count; ++number) {
                        parts.push_back(folder / ("part" + std::to_string(number)));
                        tbb::task_arena(threads).execute([&] {
                            render_part(scene.picture(), {}, {number, count}, parts.back(), true,
                                        stop);
                        });
                    }
                    join_parts(parts, folder / "c.exr", folder / "c.png");
                    EXPECT_EQ(content(folder / "c.png"), expected) << tile << " " << count;
                    for (const auto& part : parts) std::filesystem::remove(part);
                }
            }
    }
}

TEST(Preview, OfAnotherSizeIsDamaged) {
    const TestScene scene = scene_of(60, 40, 30, Sky::kOpaque);
    const Folder folder;
    render(scene, folder / "a.exr", folder / "a.png");
    EXPECT_EQ(damage_of_preview(folder / "a.png", {30, 20}), "");
    for (const PreviewSize& other : {PreviewSize{30, 21}, PreviewSize{60, 40}})
        EXPECT_NE(damage_of_preview(folder / "a.png", other).find("has 30x20 pixels, not"),
                  std::string::npos);
}

/// A part's header that claims a frame which its tiles do not cover takes no memory for it.
TEST(Preview, OfAForgedPartTakesNoMemory) {
    const TestScene scene = scene_of(60, 40, 30, Sky::kOpaque);
    const Folder folder;
    const std::atomic<bool> stop = false;
    const auto file = folder / "part";
    render_part(scene.picture(), {}, {1, 1}, file, true, stop);
    std::string bytes = content(file);
    // The magic and the part's two numbers, then x0, y0, x1, y1.
    const std::int32_t huge[2] = {65536, 65536};
    bytes.replace(16 + 2 * 4 + 2 * 4, sizeof huge, reinterpret_cast<const char*>(huge),
                  sizeof huge);
    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_NE(damage_of_part(file).find("do not cover"), std::string::npos) << damage_of_part(file);
}

}  // namespace
}  // namespace tesserae::render
