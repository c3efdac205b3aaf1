// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/load.hpp"

#include <gtest/gtest.h>

#include "scenes/load/effective.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

constexpr const char* kSphere = "shape = \"hypersphere\"\nradius = 0.5\n";

/// A bit of everything.
const std::string kRich = R"(
[scene]
name = "rich"
[physics]
gravity = [0, -9.81, 0, 0.1]
duration = 3
integrator = "midpoint"
seed = 9223372036854775807
[[material]]
name = "dots \" \\ \t ä"
albedo = [0.1, 0.25, 1]
pattern = "checker"
[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 3, 0, 4]
offset = -0.1
[[body]]
shape = "hypercapsule"
radius = 0.3
height = 0
position = [1, 2, 3, 4]
rotation = { xy = 30, zw = 15 }
velocity = [1e-7, 0, 0, -0.1]
angular_velocity = { xw = 2.0 }
density = 123.456
friction = 0.1
restitution = 0.9
fixed = ["rotation", "position"]
material = "dots \" \\ \t ä"
visible = false
[[lattice]]
name = "rain"
shape = "hyperbox"
size = [0.1, 0.2, 0.3, 0.4]
position = [0, 5, 0, 0]
count = [2, 3, 4, 5]
spacing = [1, 2, 3, 4]
jitter = 0.05
seed = 7
[[material]]
name = "lens"
kind = "glass"
ior = 1.25
roughness = 0.5
emission = [0, 0.5, 2]
[camera]
position = [0, 1, -5, 2]
up = [1, 1, 0, 0]
[[light]]
type = "sun"
direction = [1, -3, 0.5, 0.25]
strength = 2
angle = 0
[[light]]
type = "sky"
color = [0.1, 0.2, 0.3]
[[light]]
type = "sky"
strength = 0.5
[[light]]
type = "point"
position = [1, 2, 3, 4]
color = [1, 0.5, 0]
strength = 40
[[light]]
type = "sphere"
position = [-1, 2, -3, 4]
radius = 0.25
strength = 3
[render]
integrator = "path"
bounces = 7
size = [640, 360]
samples = 4
channels = ["position", "color"]
exposure = -1.5
)";

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

TEST(Overrides, ReachEveryTable) {
    const auto with = [](const std::vector<std::string>& sets) { return load_text(kRich, sets); };
    EXPECT_EQ(with({"physics.iterations=20"}).physics->iterations, 20);
    EXPECT_EQ(with({"physics.iterations = 20 # more", "physics.iterations=30"}).physics->iterations,
              30);
    EXPECT_EQ(with({"body.body-1.mass=2"}).bodies.type_of(1).mass, 2);  // instead of its density
    EXPECT_EQ(with({"body.body-1.position=[9, 8, 7, 6]"}).bodies.position[1], Vec4(9, 8, 7, 6));
    EXPECT_EQ(with({"body.body-1.angular_velocity.yz=1"}).bodies.angular_velocity[1],
              (Bivector{0, 0, 2, 1, 0, 0}));
    EXPECT_EQ(with({"lattice.rain.count=[1, 1, 1, 1]"}).bodies.size(), 3U);
    EXPECT_EQ(with({"material.\"dots \\\" \\\\ \\t ä\".albedo=[0, 0, 0]"}).materials[1].albedo[2],
              0);
    EXPECT_EQ(with({"light.0.strength=5"}).lights.suns[0].irradiance[0], 5);
    EXPECT_EQ(with({"camera.position=[0, 0, -1, 0]"}).camera.position, Vec4(0, 0, -1, 0));
    EXPECT_EQ(with({"render.size=[8, 9]"}).render.height, 9);
    EXPECT_EQ(with({"scene.name=\"other\""}).name, "other");
    const Scene cropped = with({"render.crop=[1, 2, 3, 4]"});
    ASSERT_TRUE(cropped.render.crop);
    EXPECT_EQ(cropped.render.crop->y1, 4);
    EXPECT_TRUE(cropped.effective.ends_with("\ncrop = [1, 2, 3, 4]\n"));
    // Tables that the file does not have, and bodies as inline tables.
    EXPECT_EQ(load_text("[scene]", {"physics.seed=3"}).physics->seed, 3U);
    EXPECT_EQ(load_text("body = [{shape = 'hypersphere', radius = 1}]", {"body.body-0.mass=2"})
                  .bodies.types[0]
                  .mass,
              2);
    EXPECT_EQ(with({"physics.seed=4"}).hash, load_text(with({"physics.seed=4"}).effective).hash);
}

TEST(Overrides, ErrorsNameTheEntry) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"physics.iterations=0", "[physics]: iterations = 0: expected an integer from 1 to 10000"},
        {"physics.itertions=1", "did you mean \"iterations\"?"},
        {"phsyics.seed=1", "no table is called \"phsyics\"; did you mean \"physics\"?"},
        {"physics=1", "expected physics.KEY=VALUE"},
        {"body.floor=1", "expected body.NAME.KEY=VALUE"},
        {"body.flor.friction=1", "no body is called \"flor\"; did you mean \"floor\"?"},
        {"lattice.rian.jitter=1", "no lattice is called \"rian\"; did you mean \"rain\"?"},
        {"light.9.strength=1", "no light is called \"9\""},
        {"body.floor.position=[0, 0, 0, 0]", "never moves"},
        {"lattice.rain.size=[1, 1, 1]", "has 3 values"},
        {"render.intersector=analytic", "a string needs quotes"},
        {"render.samples", "expected KEY=VALUE"},
        {"", "expected KEY=VALUE"},
        {"[physics]", "expected KEY=VALUE"},
        {"render.samples=1\nrender.tile=8", "control character"},
        {"physics.gravity.x=1", "\"gravity\" is no table"},
        {"render.integrator=\"pathe\"", "did you mean \"path\"?"},
        {"render.crop=[0, 0, 641, 10]", "x1 <= 640"},
        {"render.crop=[5, 0, 5, 10]", "x0 < x1"},
        {"render.crop=[-1, 0, 5, 10]", "crop[0] = -1"},
    };
    for (const auto& [set, words] : cases) {
        const std::string message = error_of(kRich, {set});
        EXPECT_TRUE(message.starts_with("--set " + printable(set) + ": "))
            << set << " gave " << message;
        EXPECT_NE(message.find(words), std::string::npos) << set << " gave " << message;
    }
}

TEST(SceneHash, IgnoresHowTheFileIsWritten) {
    const Scene scene =
        load_text("[physics]\nseed = 3 # hi\nduration = 2\n\n[render]\nsamples = 4");
    EXPECT_EQ(scene.hash,
              load_text("# x\nrender = {samples=4}\n[physics]\nduration=2.0\n  seed=0x3\n").hash);
}

/// Every line of the canonical text matters to the hash; those of the motion part to both.
TEST(SceneHash, SeesEveryValue) {
    const Scene scene = load_text(kRich);
    const auto changed = [&](const std::string& set) { return load_text(kRich, {set}); };
    for (const char* motion : {"physics.seed=1",
                               "physics.gravity=[0,0,0,0]",
                               "physics.steps_per_second=1",
                               "physics.iterations=1",
                               "physics.substeps=2",
                               "physics.sleeping=true",
                               "physics.integrator=\"euler\"",
                               "body.floor.offset=1",
                               "body.body-1.radius=1",
                               "body.body-1.mass=1",
                               "body.body-1.position=[0,0,0,0]",
                               "body.body-1.rotation.xy=1",
                               "body.body-1.velocity=[0,0,0,0]",
                               "body.body-1.friction=1",
                               "body.body-1.rolling_friction=0.1",
                               "lattice.rain.rolling_friction=0.1",
                               "body.floor.rolling_friction=0.1",
                               "body.body-1.restitution=1",
                               "body.body-1.fixed=[]",
                               "lattice.rain.seed=1",
                               "lattice.rain.jitter=0",
                               "lattice.rain.spacing=1",
                               "lattice.rain.count=[1,1,1,1]"}) {
        EXPECT_NE(changed(motion).hash, scene.hash) << motion;
        EXPECT_NE(changed(motion).motion_hash, scene.motion_hash) << motion;
    }
    for (const char* picture :
         {"scene.name=\"b\"", "physics.duration=1", "body.floor.name=\"b\"",
          "body.floor.visible=false", "render.samples=1", "camera.field_of_view=49",
          "light.0.color=[0,0,0]", "light.3.strength=1", "light.3.position=[0,0,0,0]",
          "light.4.radius=1", "render.integrator=\"direct\"", "render.bounces=0",
          "render.exposure=0", "render.preview_size=7", "render.crop=[0,0,1,1]",
          "body.floor.material=\"dots \\\" \\\\ \\t ä\""}) {
        EXPECT_NE(changed(picture).hash, scene.hash) << picture;
        EXPECT_EQ(changed(picture).motion_hash, scene.motion_hash) << picture;
    }
}

TEST(Hashes, KnowAToleranceThatIsNotTheDefault) {
    const Scene plain = load_text(kRich);
    EXPECT_EQ(plain.effective.find("tolerance"), std::string::npos);
    EXPECT_EQ(load_text(kRich, {"physics.tolerance=1e-6"}).effective, plain.effective);
    const Scene zero = load_text(kRich, {"physics.tolerance=0"});
    EXPECT_EQ(first_motion_difference(plain.effective, zero.effective),
              "physics: nothing there, tolerance = 0 here");
    EXPECT_EQ(load_text(zero.effective).hash, zero.hash);
}

TEST(Hashes, KnowAPreviewOfAnotherSizeThanTheDefault) {
    for (const auto& [size, usual] :
         {std::pair("[640, 360]", "640"), std::pair("[4000, 360]", "1920")}) {
        const std::string text = std::string("[render]\nsize = ") + size + "\n";
        const Scene plain = load_text(text);
        EXPECT_EQ(plain.effective.find("preview_size"), std::string::npos);
        EXPECT_EQ(load_text(text, {std::string("render.preview_size=") + usual}).hash, plain.hash);
        const Scene other = load_text(text, {"render.preview_size=321"});
        EXPECT_NE(other.hash, plain.hash);
        EXPECT_EQ(other.render.preview_size, 321);
        EXPECT_EQ(load_text(other.effective).hash, other.hash);
    }
}

TEST(Hashes, OfScenesWithoutRollingFrictionAreThoseOfBeforeThereWasAny) {
    const Scene without = load_text(kRich),
                zero = load_text(kRich, {"body.body-1.rolling_friction=0"});
    EXPECT_EQ(without.effective.find("rolling_friction"), std::string::npos);
    EXPECT_EQ(zero.effective, without.effective);
    const Scene some = load_text(kRich, {"body.body-1.rolling_friction=0.25"});
    EXPECT_EQ(first_motion_difference(without.effective, some.effective),
              "body 1 \"body-1\": nothing there, rolling_friction = 0.25 here");
    EXPECT_EQ(first_difference(some.effective, without.effective),
              "body 1 \"body-1\": rolling_friction = 0.25 there, nothing here");
    EXPECT_EQ(load_text(some.effective).hash, some.hash);
}

TEST(FirstDifference, NamesKeyAndValues) {
    const auto effective = [](const std::vector<std::string>& sets) {
        return load_text(kRich, sets).effective;
    };
    const std::string base = effective({});
    EXPECT_EQ(first_difference(base, base), "");
    EXPECT_EQ(first_difference(base, effective({"render.samples=16"})),
              "render.samples: 4 there, 16 here");
    EXPECT_EQ(first_difference(base, effective({"body.body-1.friction=0.7"})),
              "body 1 \"body-1\".friction: 0.1 there, 0.7 here");
    EXPECT_EQ(first_difference(base, effective({"body.floor.name=\"f\""})),
              "body 0.name: \"floor\" there, \"f\" here");
    EXPECT_EQ(first_difference(base, effective({"render.crop=[0, 0, 1, 1]"})),
              "render: nothing there, crop = [0, 0, 1, 1] here");

    // What does not decide motion is passed over, but still names the body.
    const auto motion = [&](const std::vector<std::string>& sets) {
        return first_motion_difference(base, effective(sets));
    };
    const std::string shown = "scene.name=\"b\"", longer = "physics.duration=9";
    EXPECT_EQ(motion({shown, longer, "render.samples=16"}), "");
    EXPECT_EQ(motion({shown, longer, "physics.seed=9"}),
              "physics.seed: 9223372036854775807 there, 9 here");
    EXPECT_EQ(motion({shown, longer, "body.floor.visible=false", "body.body-1.friction=0.7"}),
              "body 1 \"body-1\".friction: 0.1 there, 0.7 here");
}

}  // namespace
}  // namespace tesserae::scenes
