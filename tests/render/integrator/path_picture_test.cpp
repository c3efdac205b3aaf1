// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// Every light and every material, traced.
TestScene busy_scene(Integrator integrator) {
    Random random(531);
    TestScene scene;
    scene.settings.width = 60, scene.settings.height = 40;
    scene.settings.samples = 4;
    scene.settings.tile = 16;
    scene.settings.integrator = integrator;
    scene.materials.resize(5);
    scene.materials[1].kind = MaterialKind::kMirror;
    scene.materials[2].kind = MaterialKind::kGlass;
    scene.materials[3].kind = MaterialKind::kRough;
    scene.materials[4].pattern = Pattern::kChecker;
    scene.materials[4].emission = {0.2, 0, 0};
    for (int i = 0; i < 50; ++i)
        scene.add(random_shape(random, i % kShapeKinds, 0.6), random_vector(random, 2),
                  random_rotor(random), static_cast<std::uint32_t>(i % 5));
    scene.add(Hyperplane{Vec4::UnitY(), -2}, Vec4::Zero(), {}, 4);
    for (double angle : {0.0, 3.0}) {
        Sun sun;
        sun.direction = Vec4(0.3, -1, 0.4, angle / 10).normalized();
        sun.angle = angle;
        scene.lights.suns.push_back(sun);
    }
    scene.lights.points = {{Vec4(1, 3, -1, 0.5), Color(50, 40, 30)}};
    scene.lights.spheres = {{Vec4(-2, 2, 0, -0.3), 0.4, Color(3, 4, 5)}};
    scene.lights.sky = {0.2, 0.25, 0.3};
    return scene;
}

class EachIntegrator : public ::testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Picture, EachIntegrator,
                         ::testing::Values(Integrator::kDirect, Integrator::kPath));

TEST_P(EachIntegrator, HasTheSameBytesAtAnyThreadCount) {
    const TestScene scene = busy_scene(GetParam());
    const Folder folder;
    const FrameStats once = render(scene, folder / "1.exr", folder / "1.png", 1);
    EXPECT_GT(once.bounce_rays, 500u);
    EXPECT_EQ(once.invalid_samples, 0u);
    for (int threads : {2, 7}) {
        const FrameStats again = render(scene, folder / "n.exr", folder / "n.png", threads);
        EXPECT_EQ(content(folder / "n.exr"), content(folder / "1.exr")) << threads;
        EXPECT_EQ(content(folder / "n.png"), content(folder / "1.png")) << threads;
        EXPECT_EQ(again.bounce_rays, once.bounce_rays);
        EXPECT_EQ(again.shadow_rays, once.shadow_rays);
    }
}

TEST_P(EachIntegrator, HasTheSamePixelsWithAnyTileAndCrop) {
    TestScene scene = busy_scene(GetParam());
    const Image whole = picture_of(scene);
    const auto expect_same = [&](const Image& part) {
        for (int y = part.y0; y < part.y0 + part.height; ++y)
            for (int x = part.x0; x < part.x0 + part.width; ++x)
                for (const auto& [name, plane] : part.planes)
                    ASSERT_EQ(plane[part.index(x, y)], whole.at(name, x, y)) << name << x << y;
    };
    for (int tile : {8, 33}) {
        scene.settings.tile = tile;
        expect_same(picture_of(scene));
    }
    scene.settings.crop = Crop{17, 5, 43, 31};
    expect_same(picture_of(scene));
}

TEST_P(EachIntegrator, LeavesOutSamplesThatAreNoNumbersAndSaysWhich) {
    for (double bad :
         {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        TestScene scene;
        scene.settings.width = 40, scene.settings.height = 30;
        scene.settings.tile = 8;
        scene.settings.integrator = GetParam();
        scene.settings.samples = 4;
        scene.lights.sky = Color::Ones();
        scene.materials[0].emission[1] = bad;
        scene.add(Hypersphere{1}, Vec4::Zero());
        const Folder folder;
        const FrameStats stats = render(scene, folder / "a.exr", folder / "a.png");
        const Image image = read_exr(folder / "a.exr");
        // The samples that meet the body are black, those beside it show the sky.
        double covered = 0;
        SampleNumber lowest{99, 99, 0};
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x) {
                covered += 4 * image.at("A", x, y);
                EXPECT_EQ(image.at("G", x, y), 1 - image.at("A", x, y));
                if (image.at("A", x, y) > 0) lowest = std::min(lowest, SampleNumber{y, x, 0});
            }
        EXPECT_GT(covered, 100);
        EXPECT_EQ(static_cast<double>(stats.invalid_samples), covered);
        EXPECT_EQ(stats.first_invalid.y, lowest.y);
        EXPECT_EQ(stats.first_invalid.x, lowest.x);
    }
}

TEST(Picture, OfDirectLightIsTheSameFromBothIntegratorsOutsidePenumbrae) {
    // Hard lights, diffuse bodies, no sky, no bounces: the same light at every sample, so the
    // halves differ by their last bit at most, where a sum rounds to either side.
    TestScene scene = busy_scene(Integrator::kDirect);
    for (Material& m : scene.materials) m.kind = MaterialKind::kDiffuse;
    scene.lights.suns.resize(1);
    scene.lights.spheres.clear();
    scene.lights.sky = Color::Zero();
    scene.settings.bounces = 0;
    // Emission lights other bodies in one of the two only.
    scene.materials[4].emission = Color::Zero();
    const Image direct = picture_of(scene);
    scene.settings.integrator = Integrator::kPath;
    const Image path = picture_of(scene);
    int lit = 0, shaded = 0;
    for (const char* channel : {"R", "G", "B"})
        for (std::size_t i = 0; i < direct.planes.at(channel).size(); ++i) {
            const float a = direct.planes.at(channel)[i], b = path.planes.at(channel)[i];
            ASSERT_NEAR(a, b, 1e-3 * a) << channel << i;
            lit += a > 0.05, shaded += a < 0.001 && direct.planes.at("A")[i] == 1;
        }
    EXPECT_GT(lit, 1000);
    EXPECT_GT(shaded, 100);
}

TEST(Picture, OfASceneProlongedAlongWHasTheShadowsOfThreeDimensions) {
    // A box and a floor without end along w, a sun without a part along w: the slice is a 3D scene,
    // whose shadow a 3D ray decides, slab by slab.
    for (Integrator integrator : {Integrator::kDirect, Integrator::kPath}) {
        TestScene scene;
        scene.settings.width = 120, scene.settings.height = 80;
        scene.settings.samples = 1;
        scene.settings.channels.position = true;
        scene.settings.integrator = integrator;
        scene.settings.bounces = 0;
        scene.add(Hyperplane{Vec4::UnitY(), 0}, Vec4::Zero());
        scene.add(Hyperbox{{1, 2, 1.5, 1e6}}, {0, 1.2, 0, 0});
        Sun sun;
        sun.direction = Vec4(0.6, -1, -0.4, 0).normalized();
        sun.angle = 0;
        scene.lights.suns = {sun};
        const Image image = picture_of(scene);
        int dark = 0, light = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (image.id(x, y) != 1) continue;
                double enter = 0, leave = 1e9;
                const char* channels[] = {"P.X", "P.Y", "P.Z"};
                const double centre[] = {0, 1.2, 0}, half[] = {0.5, 1, 0.75};
                for (int k = 0; k < 3; ++k) {
                    const double p = image.at(channels[k], x, y) - centre[k];
                    const double d = -sun.direction[k];
                    enter = std::max(enter, (-std::copysign(half[k], d) - p) / d);
                    leave = std::min(leave, (std::copysign(half[k], d) - p) / d);
                }
                // Positions are floats: leave out rays that graze an edge.
                if (std::abs(enter - leave) < 1e-4) continue;
                const bool is_dark = enter < leave;
                EXPECT_EQ(image.at("R", x, y) == 0, is_dark) << x << ", " << y;
                (is_dark ? dark : light) += 1;
            }
        EXPECT_GT(dark, 50);
        EXPECT_GT(light, 1000);
    }
}

}  // namespace
}  // namespace tesserae::render
