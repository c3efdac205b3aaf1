// SPDX-License-Identifier: Apache-2.0
#include "render/frame.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <set>
#include <sstream>
#include <thread>

#include "core/error.hpp"
#include "render/camera/camera.hpp"
#include "render/file/preview_file.hpp"
#include "tests/content.hpp"
#include "tests/render/png_picture.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// Everything that the renderer does, in a small picture.
TestScene busy_scene(std::uint64_t seed = 61) {
    Random random(seed);
    TestScene scene;
    scene.settings.width = 150, scene.settings.height = 90;
    scene.settings.samples = 4;
    scene.settings.channels.position = true;
    scene.settings.tile = 16;
    scene.materials.resize(3);
    scene.materials[1].pattern = Pattern::kChecker;
    scene.materials[2].pattern = Pattern::kStripes;
    scene.materials[2].albedo = {0.9, 0.3, 0.1};
    for (int i = 0; i < 90; ++i)
        scene.add(random_shape(random, i % kShapeKinds, 0.5), random_vector(random, 2),
                  random_rotor(random), static_cast<std::uint32_t>(i / 3 % 3));
    scene.add(Hyperplane{Vec4::UnitY(), -2}, Vec4::Zero(), {}, 1);
    for (double angle : {0.0, 4.0}) {
        Sun sun;
        sun.direction = Vec4(0.3, -1, 0.4, angle / 10).normalized();
        sun.angle = angle;
        scene.lights.suns.push_back(sun);
    }
    scene.lights.sky = {0.2, 0.25, 0.3};
    return scene;
}

/// The same bits, NaN included (there must be none).
void expect_same_pixels(const Image& part, const Image& whole) {
    ASSERT_EQ(part.planes.size(), whole.planes.size());
    for (int y = part.y0; y < part.y0 + part.height; ++y)
        for (int x = part.x0; x < part.x0 + part.width; ++x) {
            for (const auto& [name, plane] : part.planes)
                ASSERT_EQ(plane[part.index(x, y)], whole.at(name, x, y))
                    << name << " " << x << ", " << y;
            ASSERT_EQ(part.id(x, y), whole.id(x, y)) << x << ", " << y;
        }
}

TEST(Frame, SameBytesAtAnyThreadCount) {
    const TestScene scene = busy_scene();
    const Folder folder;
    const FrameStats once = render(scene, folder / "1.exr", folder / "1.png", 1);
    for (int threads : {2, 3, 8}) {
        const FrameStats again = render(scene, folder / "n.exr", folder / "n.png", threads);
        EXPECT_EQ(content(folder / "n.exr"), content(folder / "1.exr")) << threads;
        EXPECT_EQ(content(folder / "n.png"), content(folder / "1.png")) << threads;
        EXPECT_EQ(again.view_rays, once.view_rays);
        EXPECT_EQ(again.shadow_rays, once.shadow_rays);
        EXPECT_EQ(again.distance_evaluations, once.distance_evaluations);
    }
    EXPECT_EQ(folder.count(), 4u);
    // One ray through the centre and the samples, for each pixel.
    EXPECT_EQ(once.view_rays, 150u * 90 * 5);
    EXPECT_GT(once.shadow_rays, 10000u);
}

TEST(Frame, TileSizeChangesNoPixel) {
    TestScene scene = busy_scene();
    const Folder folder;
    render(scene, folder / "a.exr", folder / "a.png");
    const Image whole = read_exr(folder / "a.exr");
    for (int tile : {8, 33, 512}) {
        scene.settings.tile = tile;
        render(scene, folder / "b.exr", folder / "b.png");
        expect_same_pixels(read_exr(folder / "b.exr"), whole);
        EXPECT_EQ(content(folder / "b.png"), content(folder / "a.png")) << tile;
    }
}

TEST(Frame, CompressionChangesTheFileAndNoPixel) {
    TestScene scene = busy_scene();
    const Folder folder;
    scene.settings.compression = Compression::kNone;
    render(scene, folder / "none.exr");
    const Image none = read_exr(folder / "none.exr");
    std::set<std::string> files = {content(folder / "none.exr")};
    for (const auto compression :
         {Compression::kRle, Compression::kZips, Compression::kZip, Compression::kPiz}) {
        scene.settings.compression = compression;
        render(scene, folder / "small.exr");
        const Image small = read_exr(folder / "small.exr");
        EXPECT_EQ(small.planes, none.planes);
        EXPECT_EQ(small.ids, none.ids);
        EXPECT_LT(content(folder / "small.exr").size(), content(folder / "none.exr").size());
        files.insert(content(folder / "small.exr"));
    }
    EXPECT_EQ(files.size(), 5u);
}

TEST(Frame, CropIsAPartOfTheWhole) {
    TestScene scene = busy_scene();
    const Image whole = picture_of(scene);
    for (const Crop& crop : {Crop{0, 0, 1, 1}, Crop{7, 3, 100, 61}, Crop{149, 0, 150, 90}}) {
        scene.settings.crop = crop;
        const Image part = picture_of(scene);
        EXPECT_EQ(part.x0, crop.x0);
        EXPECT_EQ(part.y0, crop.y0);
        EXPECT_EQ(part.width, crop.x1 - crop.x0);
        EXPECT_EQ(part.height, crop.y1 - crop.y0);
        expect_same_pixels(part, whole);
    }
}

TEST(Frame, IntersectorsShowTheSamePicture) {
    TestScene scene = busy_scene();
    const Image traced = picture_of(scene);
    scene.settings.intersector = Intersector::kAnalytic;
    const Image exact = picture_of(scene);
    // Only a pixel whose centre grazes an edge within 1e-11 m could differ.
    EXPECT_EQ(traced.ids, exact.ids);
    for (std::size_t i = 0; i < traced.ids.size(); ++i)
        if (traced.ids[i] != 0) {
            EXPECT_NEAR(traced.planes.at("Z")[i], exact.planes.at("Z")[i], 1e-5);
        }
}

template <class Attribute>
auto value(const Imf::Header& header, const char* name) {
    const auto* attribute = header.findTypedAttribute<Attribute>(name);
    EXPECT_NE(attribute, nullptr) << name;
    return attribute->value();
}

TEST(Frame, HeaderSaysWhatWasRendered) {
    TestScene scene = busy_scene();
    Random random(62);
    scene.camera = random_camera(random, 6);
    scene.settings.crop = Crop{10, 20, 60, 70};
    scene.settings.frames_per_second = 24;
    const Folder folder;
    FrameInfo info = {"first", "0123abcd", "9.8.7", 42, 1.75, R"({"1": "ground"})", 3, 5};
    const std::atomic<bool> stop = false;
    render_frame(scene.picture(), info, folder / "a.exr", {}, stop);

    const Imf::TiledInputFile file((folder / "a.exr").c_str());
    const Imf::Header& h = file.header();
    EXPECT_EQ(h.dataWindow(), Imath::Box2i({10, 20}, {59, 69}));
    EXPECT_EQ(h.displayWindow(), Imath::Box2i({0, 0}, {149, 89}));
    EXPECT_EQ(h.compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(h.lineOrder(), Imf::RANDOM_Y);
    EXPECT_EQ(h.tileDescription(), Imf::TileDescription(16, 16, Imf::ONE_LEVEL));
    EXPECT_TRUE(file.isComplete());
    using Text = Imf::StringAttribute;
    EXPECT_EQ(value<Text>(h, "tesserae/scene"), "first");
    EXPECT_EQ(value<Text>(h, "tesserae/sceneHash"), "0123abcd");
    EXPECT_EQ(value<Text>(h, "tesserae/version"), "9.8.7");
    EXPECT_EQ(value<Text>(h, "tesserae/idNames"), R"({"1": "ground"})");
    EXPECT_EQ(value<Imf::IntAttribute>(h, "tesserae/frame"), 42);
    EXPECT_EQ(value<Imf::IntAttribute>(h, "tesserae/samples"), 4);
    EXPECT_EQ(value<Imf::IntAttribute>(h, "tesserae/motionVersion"), 3);
    EXPECT_EQ(value<Imf::IntAttribute>(h, "tesserae/pictureVersion"), 5);
    EXPECT_EQ(value<Imf::DoubleAttribute>(h, "tesserae/time"), 1.75);
    EXPECT_EQ(value<Imf::DoubleAttribute>(h, "tesserae/fieldOfView"), 50);
    const Imf::Rational fps = value<Imf::RationalAttribute>(h, "framesPerSecond");
    EXPECT_EQ(fps.n, 24);
    EXPECT_EQ(fps.d, 1u);
    const Imf::Chromaticities rec709 = value<Imf::ChromaticitiesAttribute>(h, "chromaticities");
    EXPECT_NEAR(rec709.red.x, 0.64, 1e-6);
    EXPECT_NEAR(rec709.white.y, 0.329, 1e-6);

    const Camera camera(scene.camera, 150, 90);
    const auto expect_vector = [&](const char* name, const Vec4& expected) {
        std::istringstream in(value<Text>(h, name));
        Vec4 v;
        in >> v[0] >> v[1] >> v[2] >> v[3];
        EXPECT_EQ(v, expected) << name;
    };
    expect_vector("tesserae/cameraOrigin", scene.camera.position);
    expect_vector("tesserae/cameraRight", camera.right());
    expect_vector("tesserae/cameraUp", camera.up());
    expect_vector("tesserae/cameraForward", camera.forward());
    expect_vector("tesserae/cameraFourth", camera.fourth());
}

TEST(Frame, ChannelsAreThoseAskedFor) {
    const auto names = [](const Channels& channels) {
        TestScene scene;
        scene.settings.width = scene.settings.height = 8;
        scene.settings.channels = channels;
        const Folder folder;
        render(scene, folder / "a.exr");
        const Imf::InputFile file((folder / "a.exr").c_str());
        std::string text;
        const Imf::ChannelList& list = file.header().channels();
        for (auto c = list.begin(); c != list.end(); ++c)
            text += std::string(c.name()) + "=" + std::to_string(c.channel().type) + " ";
        return text;
    };
    // Types: 0 uint, 1 half, 2 float; OpenEXR sorts by name.
    EXPECT_EQ(names({}),
              "A=1 B=1 G=1 N.W=2 N.X=2 N.Y=2 N.Z=2 R=1 Z=2 albedo.B=1 albedo.G=1 "
              "albedo.R=1 objectid=0 ");
    EXPECT_EQ(names({true, false, false, false, false, false}), "A=1 B=1 G=1 R=1 ");
    EXPECT_EQ(names({false, true, false, false, true, false}), "Z=2 objectid=0 ");
    EXPECT_EQ(names({false, false, false, false, false, true}), "P.W=2 P.X=2 P.Y=2 P.Z=2 ");
}

TEST(Frame, NoChannelsIsAnInputError) {
    TestScene scene;
    scene.settings.channels = {false, false, false, false, false, false};
    const Folder folder;
    EXPECT_THROW(render(scene, folder / "a.exr"), InputError);
    EXPECT_EQ(folder.count(), 0u);
}

TEST(Frame, AuxiliaryChannelsAloneCastNoShadowRays) {
    TestScene scene = busy_scene();
    scene.settings.channels = {false, true, true, true, true, false};
    const Folder folder;
    const FrameStats stats = render(scene, folder / "a.exr");
    EXPECT_EQ(stats.shadow_rays, 0u);
    scene.settings.channels.albedo = false;
    EXPECT_EQ(render(scene, folder / "a.exr").view_rays, 150u * 90);
}

/// Straight alpha, as PNG has it: laid over black in linear light it is the image's own colour.
TEST(Frame, PreviewOfATransparentSkyHasItsAlpha) {
    TestScene scene = busy_scene();
    scene.settings.sky = Sky::kTransparent;
    scene.lights.spheres.push_back({Vec4(0, 3, 3, 0), 1.5, Color(0.5, 0.25, 0)});
    const Folder folder;
    render(scene, folder / "a.exr", folder / "a.png");
    const Image image = read_exr(folder / "a.exr");
    const Png png(folder / "a.png");
    ASSERT_EQ(png.channels, 4u);
    int edges = 0, clear = 0, lamp = 0;
    for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 150; ++x) {
            const auto* code = &png.codes[static_cast<std::size_t>(4 * (150 * y + x))];
            const double covered = image.at("A", x, y);
            const auto light = [&](int c) {
                return std::min(1.f, image.at(std::string(1, "RGB"[c]), x, y));
            };
            // The disc of the lamp has no coverage.
            const double alpha = covered > 0 ? covered : std::max({light(0), light(1), light(2)});
            ASSERT_NEAR(code[3], 255 * alpha, 0.501);
            edges += covered > 0 && covered < 1, clear += alpha == 0, lamp += covered < alpha;
            for (int c = 0; c < 3; ++c) {
                const double colour = alpha > 0 ? std::min(1.0, light(c) / alpha) : 0;
                const double expected = srgb_code(colour);
                // Steps of 2^-20 of colour and coverage, the latter at least a quarter.
                ASSERT_NEAR(code[c], expected, 0.53) << x << " " << y;
            }
        }
    EXPECT_GT(edges, 50);
    EXPECT_GT(clear, 100);
    EXPECT_GT(lamp, 20);
    // From the image the same bytes are made again.
    ASSERT_TRUE(remake_preview(folder / "a.exr", scene.settings, {}, folder / "b.png"));
    EXPECT_EQ(testing::content(folder / "b.png"), testing::content(folder / "a.png"));
}

TEST(Frame, ExtremeExposuresGiveBlackOrWhite) {
    for (double exposure : {-5000.0, 5000.0}) {
        TestScene scene;
        scene.settings.width = scene.settings.height = 8;
        scene.settings.exposure = exposure;
        scene.lights.sky = {0, 1, 1};
        const Folder folder;
        render(scene, folder / "a.exr", folder / "a.png");
        const Png png(folder / "a.png");
        EXPECT_EQ(png.codes[0], 0);
        EXPECT_EQ(png.codes[1], exposure > 0 ? 255 : 0);
    }
}

// A sanitizer keeps freed memory and shadows all of it.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryIsOurs = false;
#elif defined(__has_feature)
constexpr bool kMemoryIsOurs =
    !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
constexpr bool kMemoryIsOurs = true;
#endif

TEST(Frame, WidestPictureNeedsOnlyItsTiles) {
    if (!kMemoryIsOurs) GTEST_SKIP() << "memory is not measurable under a sanitizer";
    TestScene scene;
    scene.settings.width = 65536, scene.settings.height = 4;
    scene.settings.samples = 1;
    scene.add(Hyperplane{}, Vec4::Zero());
    const Folder folder;
    rusage before = {}, after = {};
    getrusage(RUSAGE_SELF, &before);
    render(scene, folder / "a.exr", folder / "a.png");
    getrusage(RUSAGE_SELF, &after);
    // 262144 pixels of 60 bytes would be 15.7 MB; 32 tiles of 128 pixels are under way, and
    // the preview's sums take 0.05 MB. The rest is the libraries' start.
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 12000);  // kB
    EXPECT_EQ(read_exr(folder / "a.exr").width, 65536);
}

TEST(Frame, StopLeavesNothing) {
    const TestScene scene = busy_scene();
    const Folder folder;
    const std::atomic<bool> stop = true;
    EXPECT_THROW(render_frame(scene.picture(), {}, folder / "a.exr", folder / "a.png", stop),
                 Stopped);
    EXPECT_EQ(folder.count(), 0u);
}

TEST(Frame, StopsWithinATile) {
    // A picture of minutes: each of its two tiles alone takes far longer than the wait here.
    TestScene scene = busy_scene();
    scene.settings.samples = 1 << 14;
    scene.settings.tile = 128;
    const Folder folder;
    std::atomic<bool> stop = false;
    std::thread user([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        stop = true;
    });
    const auto start = std::chrono::steady_clock::now();
    EXPECT_THROW(render_frame(scene.picture(), {}, folder / "a.exr", folder / "a.png", stop),
                 Stopped);
    user.join();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));
    EXPECT_EQ(folder.count(), 0u);
}

TEST(Frame, MissingFolderIsARunError) {
    const TestScene scene = busy_scene();
    const Folder folder;
    const std::atomic<bool> stop = false;
    EXPECT_THROW(render_frame(scene.picture(), {}, folder / "no/a.exr", {}, stop), RunError);
    EXPECT_THROW(render_frame(scene.picture(), {}, folder / "a.exr", folder / "no/a.png", stop),
                 RunError);
    EXPECT_EQ(folder.count(), 0u);
}

TEST(Frame, FullDiskLeavesNothing) {
    // A limit on the file size stands for the full disk: write() fails at some byte of the header,
    // of the tiles, or of the table at the end, or only in the preview.
    const TestScene scene = busy_scene();
    const Folder folder;
    const std::atomic<bool> stop = false;
    render_frame(scene.picture(), {}, folder / "a.exr", folder / "a.png", stop);
    const rlim_t whole = content(folder / "a.exr").size();
    std::filesystem::remove(folder / "a.exr");
    std::filesystem::remove(folder / "a.png");
    rlimit old = {};
    getrlimit(RLIMIT_FSIZE, &old);
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    for (rlim_t limit : {rlim_t{10}, rlim_t{3000}, whole / 2, whole - 1}) {
        const rlimit tight = {limit, old.rlim_max};
        setrlimit(RLIMIT_FSIZE, &tight);
        EXPECT_THROW(render_frame(scene.picture(), {}, folder / "a.exr", folder / "a.png", stop),
                     RunError)
            << limit;
        setrlimit(RLIMIT_FSIZE, &old);
        EXPECT_FALSE(std::filesystem::exists(folder / "a.exr")) << limit;
    }
    std::signal(SIGXFSZ, old_handler);
}

}  // namespace
}  // namespace tesserae::render
