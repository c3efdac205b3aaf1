// SPDX-License-Identifier: Apache-2.0
#include "render/mattes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

TEST(Murmur3, HasThePublishedValues) {
    const std::pair<const char*, std::uint32_t> known[] = {
        {"", 0},
        {"a", 0x3c2569b2u},
        {"ab", 0x9bbfd75fu},
        {"abc", 0xb3dd93fau},
        {"abcd", 0x43ed676au},
        {"test", 0xba6bd213u},
        {"hello", 0x248bfa47u},
        {"Hello, world!", 0xc0363e43u},
        {"The quick brown fox jumps over the lazy dog", 0x2e4ff723u}};
    for (const auto& [text, hash] : known) EXPECT_EQ(murmur3(text), hash) << text;
    // Of Cryptomatte's specification.
    EXPECT_EQ(matte_id("bunny"), 0x13851a76u);
    EXPECT_EQ(matte_id("default"), 0x42c9679fu);
}

TEST(MatteId, IsAlwaysANormalNumber) {
    int turned = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::string name = "K\xc3\xb6rper." + std::to_string(i);
        const std::uint32_t id = matte_id(name), hash = murmur3(name);
        float number;
        std::memcpy(&number, &id, sizeof number);
        ASSERT_TRUE(std::isnormal(number)) << name;
        ASSERT_TRUE(id == hash || (id ^ hash) == 1u << 23) << name;
        turned += id != hash;
    }
    // Two exponents of 256.
    EXPECT_NEAR(turned, 20000 / 128, 5 * std::sqrt(20000 / 128));
}

/// A Cryptomatte layer's coverage of a pixel by id, its rules checked.
std::map<std::uint32_t, double> coverage(const Image& image, const std::string& layer, int x,
                                         int y) {
    std::map<std::uint32_t, double> found;
    double last = 1;
    for (int rank = 0; rank < 6; ++rank) {
        const std::string channels = layer + "0" + std::to_string(rank / 2) + ".";
        const float number = image.at(channels + (rank % 2 ? "B" : "R"), x, y);
        const float part = image.at(channels + (rank % 2 ? "A" : "G"), x, y);
        std::uint32_t id;
        std::memcpy(&id, &number, sizeof id);
        EXPECT_LE(part, last);
        EXPECT_EQ(id == 0, part == 0);
        last = part;
        if (id == 0) continue;
        EXPECT_FALSE(found.contains(id));
        found[id] = part;
    }
    return found;
}

/// Coverage of a pixel by one body, seen in the albedos of a picture in which it alone is white.
Image white_in_black(TestScene scene, const std::vector<BodyId>& white) {
    scene.mattes.reset();
    scene.settings.channels = {};
    scene.materials = {Material{}, Material{}};
    scene.materials[0].albedo = Color::Zero(), scene.materials[1].albedo = Color::Ones();
    for (Appearance& look : scene.appearance) look.material = 0;
    for (const BodyId id : white) scene.appearance[id].material = 1;
    return picture_of(scene);
}

TestScene blurred(std::uint64_t seed) {
    Random random(seed);
    TestScene scene;
    scene.materials.resize(3);
    scene.camera.position = Vec4(0, 0, -5, 0), scene.camera.look_at = Vec4::Zero();
    scene.camera.aperture = 0.1;
    scene.settings.width = 14, scene.settings.height = 10;
    scene.settings.samples = 64;
    scene.settings.filter = FilterKind::kGaussian;
    scene.settings.filter_width = 2;
    for (int i = 0; i < 15; ++i)
        scene.add(random_shape(random, i % kShapeKinds, 1.2), random_vector(random, 1.5),
                  random_rotor(random), static_cast<std::uint32_t>(i % 3));
    scene.closing = scene.bodies;
    for (Vec4& position : scene.closing->position) position += random_vector(random, 0.4);
    return scene;
}

TEST(Mattes, CoverAsTheBodiesDo) {
    for (const bool is_adaptive : {false, true}) {
        TestScene scene = blurred(is_adaptive ? 601 : 602);
        if (is_adaptive) {
            // As many samples whatever the bodies' colours, some pixels' noise and their halves'.
            scene.settings.noise_target = 1e-9;
            scene.settings.samples = 8, scene.settings.max_samples = 40;
        }
        scene.add_mattes();
        const Image image = picture_of(scene);
        int mixed = 0;
        std::map<std::uint32_t, double> missing;
        for (BodyId id = 0; id < scene.bodies.size(); ++id) {
            const Image white = white_in_black(scene, {id});
            for (int y = 0; y < 10; ++y)
                for (int x = 0; x < 14; ++x) {
                    auto found = coverage(image, "CryptoObject", x, y);
                    mixed += id == 0 && found.size() > 1;
                    if (found.size() == 6) continue;
                    // Albedos are halves.
                    EXPECT_NEAR(found[scene.mattes->objects[id]], white.at("albedo.R", x, y), 3e-4)
                        << id << " " << x << " " << y;
                }
        }
        EXPECT_GT(mixed, 20);
        for (std::uint32_t m = 0; m < 3; ++m) {
            std::vector<BodyId> of_material;
            for (BodyId id = m; id < scene.bodies.size(); id += 3) of_material.push_back(id);
            const Image white = white_in_black(scene, of_material);
            for (int y = 0; y < 10; ++y)
                for (int x = 0; x < 14; ++x)
                    EXPECT_NEAR(coverage(image, "CryptoMaterial", x, y)[scene.mattes->materials[m]],
                                white.at("albedo.R", x, y), 3e-4);
        }
    }
}

TEST(Mattes, CoverageAddsUpToAlpha) {
    for (const int samples : {1, 5, 64}) {
        TestScene scene = blurred(603);
        scene.settings.samples = samples;
        scene.add_mattes();
        const Image image = picture_of(scene);
        for (int y = 0; y < 10; ++y)
            for (int x = 0; x < 14; ++x)
                for (const char* layer : {"CryptoObject", "CryptoMaterial"}) {
                    double sum = 0;
                    const auto found = coverage(image, layer, x, y);
                    for (const auto& [id, part] : found) sum += part;
                    if (found.size() < 6) {
                        EXPECT_NEAR(sum, image.at("A", x, y), 3e-4);
                    }
                    if (samples == 1 && std::string(layer) == "CryptoObject") {
                        const std::uint32_t id = image.id(x, y);
                        EXPECT_EQ(found.size(), id > 0 ? 1u : 0u);
                        if (id > 0) {
                            EXPECT_EQ(found.begin()->first, scene.mattes->objects[id - 1]);
                        }
                    }
                }
    }
}

TEST(Mattes, OfManyBodiesTheSixOfLargestCoverageAreKept) {
    // One pixel, nine slabs side by side of widths 1 to 9 forty-fifths of it.
    TestScene scene;
    scene.camera.position = Vec4(0, 0, -1, 0), scene.camera.look_at = Vec4::Zero();
    scene.camera.field_of_view = 2 * std::atan(0.5) * 180 / 3.141592653589793;
    scene.settings.width = scene.settings.height = 1;
    scene.settings.samples = 4096;
    double left = -0.5;
    for (int i = 0; i < 9; ++i) {
        const double width = (i + 1) / 45.0;
        scene.add(Hyperbox{{width, 9, 1e-3, 9}}, {left + width / 2, 0, 0, 0});
        left += width;
    }
    scene.add_mattes();
    const auto found = coverage(picture_of(scene), "CryptoObject", 0, 0);
    EXPECT_EQ(found.size(), 6u);
    for (int i = 3; i < 9; ++i) {
        const auto at = found.find(scene.mattes->objects[static_cast<std::size_t>(i)]);
        ASSERT_NE(at, found.end()) << i;
        EXPECT_NEAR(at->second, (i + 1) / 45.0, 2e-3) << i;
    }
    // Bodies of one name are one.
    for (std::size_t i = 0; i < 9; i += 2) scene.mattes->objects[i] = matte_id("stripe");
    EXPECT_NEAR(coverage(picture_of(scene), "CryptoObject", 0, 0)[matte_id("stripe")], 25 / 45.0,
                4e-3);
}

TEST(TransparentSky, OverTheSkysColourItIsTheOpaquePicture) {
    for (const Integrator integrator : {Integrator::kDirect, Integrator::kPath}) {
        TestScene scene = blurred(604);
        scene.settings.integrator = integrator;
        scene.materials[0].kind = MaterialKind::kMirror;
        scene.materials[1].kind = MaterialKind::kGlass;
        scene.lights.sky = Color(0.5, 1, 2);
        Sun sun;
        sun.direction = Vec4(1, -1, 1, 0).normalized();
        scene.lights.suns.push_back(sun);
        const Image opaque = picture_of(scene);
        scene.settings.sky = Sky::kTransparent;
        const Image transparent = picture_of(scene);
        int covered = 0, clear = 0;
        for (int y = 0; y < 10; ++y)
            for (int x = 0; x < 14; ++x) {
                const double alpha = transparent.at("A", x, y);
                EXPECT_EQ(alpha, opaque.at("A", x, y));
                covered += alpha == 1, clear += alpha < 0.5;
                for (int c = 0; c < 3; ++c) {
                    const std::string channel(1, "RGB"[c]);
                    const double over =
                        transparent.at(channel, x, y) + (1 - alpha) * scene.lights.sky[c];
                    // Both are halves, of numbers up to 4.
                    EXPECT_NEAR(over, opaque.at(channel, x, y), 4e-3) << x << " " << y;
                    if (alpha == 1) {
                        EXPECT_EQ(transparent.at(channel, x, y), opaque.at(channel, x, y));
                    }
                    if (alpha == 0) {
                        EXPECT_EQ(transparent.at(channel, x, y), 0);
                    }
                }
            }
        EXPECT_GT(covered, 5);
        EXPECT_GT(clear, 5);
    }
}

TEST(TransparentSky, LeavesLightsInThePicture) {
    for (const Integrator integrator : {Integrator::kDirect, Integrator::kPath}) {
        TestScene scene;
        scene.camera.position = Vec4::Zero(), scene.camera.look_at = Vec4::UnitZ();
        scene.settings.width = scene.settings.height = 9;
        scene.settings.integrator = integrator;
        scene.settings.sky = Sky::kTransparent;
        scene.lights.sky = Color::Ones();
        scene.lights.spheres.push_back({Vec4(0, 0, 9, 0), 1, Color(1, 2, 3)});
        const Image image = picture_of(scene);
        EXPECT_EQ(image.at("G", 4, 4), 2);
        EXPECT_EQ(image.at("A", 4, 4), 0);
        EXPECT_EQ(image.at("G", 0, 0), 0);
    }
}

}  // namespace
}  // namespace tesserae::render
