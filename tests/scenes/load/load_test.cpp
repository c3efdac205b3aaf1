// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/load.hpp"

#include <gtest/gtest.h>

#include "scenes/load/effective.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

constexpr const char* kSphere = "shape = \"hypersphere\"\nradius = 0.5\n";

TEST(LoadScene, EmptyTableHasAllDefaults) {
    const Scene scene = load_text("[scene]");
    EXPECT_EQ(scene.name, "test");
    EXPECT_FALSE(scene.physics);
    EXPECT_EQ(scene.bodies.size(), 0U);
    EXPECT_TRUE((scene.lights.sky == 1).all());
    EXPECT_EQ(scene.render.width, 1280);
    EXPECT_EQ(scene.render.samples, 16);
    EXPECT_FALSE(scene.render.channels.position);
    EXPECT_EQ(scene.hash.size(), 32U);
}

TEST(LoadScene, ReadsChannelsForCompositing) {
    const Scene scene = load_text(
        "[render]\nsky = \"transparent\"\n"
        "channels = [\"motion\", \"zplanar\", \"normal3\", \"light\", \"cryptomatte\"]");
    const render::Channels& c = scene.render.channels;
    EXPECT_TRUE(c.motion && c.zplanar && c.normal3 && c.light && c.cryptomatte);
    EXPECT_EQ(scene.render.sky, render::Sky::kTransparent);
    EXPECT_FALSE(c.color || c.depth || c.normal || c.albedo || c.id);
    EXPECT_FALSE(load_text("[scene]").render.has_layers());
}

TEST(LoadScene, ReadsEverything) {
    const Scene scene = load_text(kRich);
    EXPECT_EQ(scene.name, "rich");
    ASSERT_TRUE(scene.physics);
    EXPECT_EQ(scene.physics->gravity, Vec4(0, -9.81, 0, 0.1));
    EXPECT_EQ(scene.physics->integrator, RotationIntegrator::kMidpoint);
    EXPECT_EQ(scene.physics->seed, 9223372036854775807U);
    ASSERT_EQ(scene.bodies.size(), 2U + 120U);
    const BodyType& floor = scene.bodies.type_of(0);
    EXPECT_TRUE(std::get<Hyperplane>(floor.shape).normal.isApprox(Vec4(0, 0.6, 0, 0.8), 1e-15));
    const BodyType& capsule = scene.bodies.type_of(1);
    // Height 0 is a sphere: pi^2 R^4 / 2, to a few roundings.
    const double mass = 123.456 * M_PI * M_PI * 0.3 * 0.3 * 0.3 * 0.3 / 2;
    EXPECT_NEAR(capsule.mass, mass, 1e-14 * mass);
    EXPECT_TRUE(capsule.fixed_position && capsule.fixed_rotation);
    EXPECT_EQ(scene.bodies.angular_velocity[1], (Bivector{0, 0, 2, 0, 0, 0}));
    EXPECT_FALSE(scene.appearance[scene.bodies.type[1]].visible);
    EXPECT_EQ(scene.materials[scene.appearance[scene.bodies.type[1]].material].name,
              "dots \" \\ \t \xc3\xa4");
    // xy = 30 turns x toward y by 30 degrees, zw = 15 turns z toward w.
    const Vec4 x = rotate(scene.bodies.rotor[1], Vec4::UnitX());
    const Vec4 z = rotate(scene.bodies.rotor[1], Vec4::UnitZ());
    EXPECT_TRUE(x.isApprox(Vec4(std::sqrt(0.75), 0.5, 0, 0), 1e-14)) << x.transpose();
    EXPECT_TRUE(z.isApprox(Vec4(0, 0, std::cos(M_PI / 12), std::sin(M_PI / 12)), 1e-14));
    ASSERT_EQ(scene.names.size(), 3U);
    EXPECT_EQ(scene.names[1].name, "body-1");
    EXPECT_EQ(scene.names[2].first, 2U);
    EXPECT_EQ(scene.names[2].count, 120U);
    ASSERT_EQ(scene.lights.suns.size(), 1U);
    EXPECT_TRUE((scene.lights.suns[0].irradiance == 2).all());
    EXPECT_NEAR(scene.lights.suns[0].direction.norm(), 1, 1e-15);
    EXPECT_TRUE(scene.lights.sky.isApprox(render::Color(0.6, 0.7, 0.8), 1e-15));
    ASSERT_EQ(scene.lights.points.size(), 1U);
    EXPECT_EQ(scene.lights.points[0].position, Vec4(1, 2, 3, 4));
    EXPECT_TRUE((scene.lights.points[0].flux == render::Color(40, 20, 0)).all());
    ASSERT_EQ(scene.lights.spheres.size(), 1U);
    EXPECT_EQ(scene.lights.spheres[0].position, Vec4(-1, 2, -3, 4));
    EXPECT_EQ(scene.lights.spheres[0].radius, 0.25);
    EXPECT_TRUE((scene.lights.spheres[0].radiance == 3).all());
    EXPECT_EQ(scene.render.integrator, render::Integrator::kPath);
    EXPECT_EQ(scene.render.bounces, 7);
    ASSERT_EQ(scene.materials.size(), 3U);
    EXPECT_EQ(scene.materials[1].kind, render::MaterialKind::kDiffuse);
    EXPECT_EQ(scene.materials[2].kind, render::MaterialKind::kGlass);
    EXPECT_EQ(scene.materials[2].ior, 1.25);
    EXPECT_EQ(scene.materials[2].roughness, 0.5);
    EXPECT_TRUE((scene.materials[2].emission == render::Color(0, 0.5, 2)).all());
    EXPECT_TRUE(scene.render.channels.position && !scene.render.channels.depth);
}

TEST(LoadScene, EffectiveTextLoadsToItself) {
    for (const std::string& text : {std::string("[scene]"), kRich}) {
        const Scene first = load_text(text);
        const Scene second = load_text(first.effective);
        EXPECT_EQ(first.effective, second.effective);
        EXPECT_EQ(first.hash, second.hash);
        EXPECT_EQ(first.motion_hash, second.motion_hash);
        EXPECT_EQ(first.bodies.types, second.bodies.types);
        EXPECT_EQ(first.bodies.type, second.bodies.type);
        EXPECT_EQ(first.bodies.position, second.bodies.position);
        EXPECT_EQ(first.bodies.rotor, second.bodies.rotor);
        EXPECT_EQ(first.appearance, second.appearance);
    }
}

TEST(LoadScene, EveryMaterialKindAndItsDefaults) {
    using render::MaterialKind;
    const std::pair<const char*, MaterialKind> kinds[] = {{"diffuse", MaterialKind::kDiffuse},
                                                          {"mirror", MaterialKind::kMirror},
                                                          {"glass", MaterialKind::kGlass},
                                                          {"rough", MaterialKind::kRough}};
    for (const auto& [name, kind] : kinds) {
        const Scene scene =
            load_text(fmt::format("[[material]]\nname = \"m\"\nkind = \"{}\"\n", name));
        EXPECT_EQ(scene.materials.at(1).kind, kind) << name;
        EXPECT_EQ(scene.materials[1].ior, 1.5);
        EXPECT_EQ(scene.materials[1].roughness, 0.3);
        EXPECT_TRUE((scene.materials[1].emission == 0).all());
        EXPECT_NE(scene.effective.find(fmt::format("kind = \"{}\"", name)), std::string::npos);
    }
    EXPECT_EQ(load_text("[scene]").render.bounces, 4);
    EXPECT_EQ(load_text("[render]\nbounces = 1000000").render.bounces, 1'000'000);
    EXPECT_EQ(load_text("[scene]").render.specular_bounces, 128);
    EXPECT_EQ(load_text("[render]\nspecular_bounces = 5").render.specular_bounces, 5);
}

TEST(LoadScene, OddButLegal) {
    const std::string body = std::string("[[body]]\n") + kSphere;
    std::string crlf = body;
    for (std::size_t i = 0; (i = crlf.find('\n', i)) != std::string::npos; i += 2)
        crlf.replace(i, 1, "\r\n");
    const std::string hash = load_text(body).hash;
    for (const std::string& same :
         {crlf, "\xef\xbb\xbf" + body, "\xef\xbb\xbf" + crlf,
          std::string("body = [{shape = 'hypersphere', radius = 0.5}]"),
          std::string("[[ body ]]\nshape = \"\"\"hypersphere\"\"\"\nradius = 5e-1"),
          std::string("[[\"body\"]]\n\"shape\" = 'hypersphere'\n'radius' = 0.5"),
          std::string("render.samples = 0x10\nrender.tile = 3_2\nscene = {}\n") + body,
          body + "[body.rotation]\nxy = -0.0\n", body + "rotation.xy = 0\nrotation.zw = 0\n"})
        EXPECT_EQ(load_text(same).hash, hash) << same;
    // Defaults of what is not built yet.
    EXPECT_EQ(load_text(body + "[render]\nintegrator = \"direct\"\nbounces = 4\nspecular_bounces = "
                               "128\nfilter = \"box\"\n"
                               "max_samples = 16\n[camera]\nslices = 1\naperture = 0\n")
                  .hash,
              hash);
}

/// Bodies between other tables are numbered in file order, and lattices come after all of them.
TEST(LoadScene, NumbersBodiesThenLattices) {
    std::string text = "[[lattice]]\nname = \"z\"\ncount = [2, 1, 1, 2]\nspacing = [10, 1, 1, 1]\n";
    text += std::string(kSphere) + "position = [100, 0, 0, 0]\n";
    for (int i = 0; i < 1000; ++i) {
        text += fmt::format("[[body]]\n{}position = [{}, 0, 0, 0]\n", kSphere, i);
        if (i % 250 == 0) text += fmt::format("[[material]]\nname = \"{}\"\n", i);
    }
    text += "[[lattice]]\nname = \"a\"\ncount = [1, 2, 1, 1]\nspacing = 3\n" + std::string(kSphere);
    const Scene scene = load_text(text);
    ASSERT_EQ(scene.bodies.size(), 1006U);
    for (BodyId id = 0; id < 1000; ++id) ASSERT_EQ(scene.bodies.position[id].x(), id);
    const std::vector<Vec4> lattices = {{95, 0, 0, -0.5}, {95, 0, 0, 0.5}, {105, 0, 0, -0.5},
                                        {105, 0, 0, 0.5}, {0, -1.5, 0, 0}, {0, 1.5, 0, 0}};
    for (std::size_t i = 0; i < lattices.size(); ++i)
        EXPECT_EQ(scene.bodies.position[1000 + i], lattices[i]) << i;
    EXPECT_EQ(scene.bodies.types.size(), 1U);
    EXPECT_EQ(scene.names[1000].name, "z");
    EXPECT_EQ(scene.names[999].name, "body-999");
    BodyId next = 0;
    for (const NamedBodies& names : scene.names) {
        EXPECT_EQ(names.first, next);
        next += names.count;
    }
}

/// Errors in bodies parsed piece by piece still name the file's line.
TEST(LoadScene, PlacesAreThoseOfTheFile) {
    std::string text;
    for (int i = 0; i < 1000; ++i) text += std::string("[[body]]\n") + kSphere;
    text += "[physics]\nseed = 1\n[[body]]\nshape = \"hypersphere\"\nradius = -1\n";
    EXPECT_TRUE(error_of(text).starts_with("test.toml:3005:10: body 1000: radius = -1: "))
        << error_of(text);
}

TEST(LoadScene, TakesEveryKeyOfPhysicsOrItsDefault) {
    const PhysicsSettings plain = *load_text("[physics]\n").physics, defaults;
    EXPECT_EQ(plain.gravity, defaults.gravity);
    EXPECT_EQ(plain.duration, defaults.duration);
    EXPECT_EQ(plain.steps_per_second, defaults.steps_per_second);
    EXPECT_EQ(plain.iterations, defaults.iterations);
    EXPECT_EQ(plain.tolerance, defaults.tolerance);
    EXPECT_EQ(plain.substeps, defaults.substeps);
    EXPECT_EQ(plain.integrator, defaults.integrator);
    EXPECT_EQ(plain.sleeping, defaults.sleeping);
    const char* all =
        "[physics]\ntolerance = 0.001\nsubsteps = 1000\nsolver = \"impulse\"\nintegrator = "
        "\"euler\"\nsleeping = true\n";
    for (const std::string& text : {std::string(all), load_text(all).effective}) {
        const Scene scene = load_text(text);
        EXPECT_EQ(scene.physics->tolerance, 0.001);
        EXPECT_EQ(scene.physics->substeps, 1000);
        EXPECT_EQ(scene.physics->integrator, RotationIntegrator::kEuler);
        EXPECT_TRUE(scene.physics->sleeping);
        EXPECT_EQ(scene.hash, load_text(all).hash);
    }
}

TEST(LoadScene, EqualTypesAreShared) {
    const std::string a = std::string("[[body]]\n") + kSphere, b = a + "friction = 0.1\n";
    const std::string c = a + "visible = false\n";
    const Scene scene = load_text(a + b + c + a + c + b);
    EXPECT_EQ(scene.bodies.type, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 1}));
    EXPECT_EQ(scene.appearance.size(), 3U);
}

}  // namespace
}  // namespace tesserae::scenes
