// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "core/dynamics/stepper.hpp"
#include "render/tile/frame_scene.hpp"
#include "scenes/film/film.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/plan/plan_picture.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

// That what the plan says is what happens: counted in small frames and in worlds that step.
namespace tesserae::scenes {
namespace {

/// Whether the plan needs a part; a failure if it does not tell.
bool needs(const Scene& scene, const std::string& part) {
    const Plan plan = make_plan(scene, 1);
    const auto found = std::find_if(plan.decisions.begin(), plan.decisions.end(),
                                    [&](const Decision& d) { return d.part == part; });
    EXPECT_NE(found, plan.decisions.end()) << part;
    return found != plan.decisions.end() && found->needed;
}

/// What was counted in a small frame 0 of a scene, and its preview's bytes.
struct Frame {
    Scene scene;
    render::FrameStats stats;
    std::string preview;

    explicit Frame(const std::string& text, std::vector<std::string> sets = {}) {
        sets.insert(sets.begin(), {"render.size=[16, 12]", "render.samples=2"});
        const SceneFile file(text);
        scene = load_scene(file.path(), sets);
        const FilmReport report =
            film(scene, {0}, {}, file.folder() / "out", Replace::kNothing, true);
        stats = report.stats;
        std::ifstream in(report.preview, std::ios::binary);
        preview.assign(std::istreambuf_iterator<char>(in), {});
    }
};

/// The bytes of the preview of frame 0.
std::string preview_of(const Scene& scene) {
    const SceneFile file("");
    const FilmReport report = film(scene, {0}, {}, file.folder() / "out", Replace::kNothing, true);
    std::ifstream in(report.preview, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

const std::string kMaterials = R"(
[[material]]
name = "mirror"
kind = "mirror"
[[material]]
name = "glass"
kind = "glass"
albedo = [0.8, 0.8, 0.8]
[[material]]
name = "glow"
emission = [1, 1, 1]
)";

std::string ball(double x, const std::string& lines = "") {
    return fmt::format(
        "[[body]]\nshape = \"hypersphere\"\nradius = 1\nposition = [{}, 0, 0, 0]\n{}\n", x, lines);
}

TEST(PlanOfAPicture, SaysWhichRaysAreTraced) {
    const std::string lights[] = {
        "", "[[light]]\ntype = \"sun\"\ndirection = [0.3, -1, 0.5, 0]\nstrength = 0\n",
        "[[light]]\ntype = \"sun\"\ndirection = [0.3, -1, 0.5, 0]\n",
        "[[light]]\ntype = \"point\"\nposition = [0, 5, -5, 0]\n",
        "[[light]]\ntype = \"sphere\"\nposition = [0, 6, -6, 0]\nradius = 1\n"};
    const std::string mirror = ball(2, "material = \"mirror\""),
                      glass = ball(-2, "material = \"glass\""), hidden = ball(0, "visible = false");
    const std::string bodies[] = {"",
                                  hidden,
                                  ball(0),
                                  ball(0) + ball(3),
                                  mirror,
                                  glass,
                                  mirror + glass,
                                  ball(0) + mirror + hidden,
                                  ball(0) + ball(3, "material = \"glow\"")};
    for (const std::string& light : lights)
        for (const std::string& body : bodies)
            for (const bool is_path : {false, true}) {
                SCOPED_TRACE(light + body + (is_path ? "path" : "direct"));
                const Frame frame(
                    kMaterials + light + body,
                    {is_path ? "render.integrator=\"path\"" : "render.integrator=\"direct\""});
                EXPECT_EQ(needs(frame.scene, "shadow rays"), frame.stats.shadow_rays > 0);
                // Without a visible body there is nothing that light paths could leave.
                EXPECT_EQ(needs(frame.scene, "global illumination"), is_path);
                if (!is_path) {
                    EXPECT_EQ(needs(frame.scene, "reflected and refracted rays"),
                              frame.stats.bounce_rays > 0);
                } else {
                    EXPECT_EQ(frame.stats.bounce_rays > 0, !body.empty() && body != hidden);
                }
            }
}

TEST(PlanOfAPicture, SaysWhetherOneOfManyLampsIsAsked) {
    const auto asks_one = [](int lights, int bodies, const char* integrator) {
        std::string text = kMaterials + ball(0);
        for (int i = 0; i < lights; ++i)
            text += fmt::format(
                "[[light]]\ntype = \"sphere\"\nposition = [{}, 6, -6, 0]\nradius = 0.1\n", i);
        for (int i = 0; i < bodies; ++i) text += ball(3 * i + 3, "material = \"glow\"");
        const Frame frame(text, {std::string("render.integrator=") + integrator});
        return needs(frame.scene, "choice of lamps");
    };
    EXPECT_FALSE(asks_one(2, 2, "\"path\""));
    EXPECT_TRUE(asks_one(3, 2, "\"path\""));
    EXPECT_TRUE(asks_one(0, 5, "\"path\""));
}

TEST(PlanOfAPicture, WarnsOfGlassInsideLaterGlass) {
    const auto warnings_of = [](const std::string& bodies) {
        const SceneFile file(kMaterials + bodies);
        const Scene scene = load_scene(file.path(), {});
        Plan plan = make_plan(scene, 1);
        EXPECT_TRUE(plan.warnings.empty());
        warn_of_hidden_glass(scene, plan);
        return plan.warnings;
    };
    const std::string small =
        "[[body]]\nname = \"small\"\nshape = \"hyperbox\"\nsize = [1, 1, 1, 0.5]\n";
    const std::string lattice =
        "[[lattice]]\nname = \"bubbles\"\nshape = \"hypersphere\"\nradius = 0.1\n"
        "count = [3, 1, 1, 1]\nspacing = [0.3, 1, 1, 1]\n";
    const std::string glass = "material = \"glass\"\n",
                      large = ball(0, "name = \"large\"\n" + glass);
    const auto found = warnings_of(small + glass + large);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0],
              "\"small\" lies wholly inside the glass \"large\", which is declared later and rules "
              "there: it is not seen");
    // The other way round, of another material, invisible, sticking out.
    EXPECT_TRUE(warnings_of(large + small + glass).empty());
    EXPECT_TRUE(warnings_of(small + large).empty());
    EXPECT_TRUE(warnings_of(small + glass + ball(0)).empty());
    EXPECT_TRUE(warnings_of(small + glass + "visible = false\n" + large).empty());
    EXPECT_TRUE(warnings_of(small + glass + "position = [0.3, 0, 0, 0]\n" + large).empty());
    // All lattices come after all bodies.
    EXPECT_TRUE(warnings_of(lattice + glass + large).empty());
    const auto in_lattice = warnings_of(lattice + glass +
                                        "[[lattice]]\nshape = \"hypersphere\"\n"
                                        "name = \"drops\"\nradius = 1\ncount = [1, 1, 1, 1]\n"
                                        "spacing = [1, 1, 1, 1]\n" +
                                        glass);
    ASSERT_EQ(in_lattice.size(), 1u);
    EXPECT_EQ(in_lattice[0].find("a body of \"bubbles\" lies wholly inside the glass \"drops\""),
              0u);
}

TEST(PlanOfAPicture, CountsTheViewRays) {
    for (const char* channels : {"[\"color\"]", "[\"color\", \"id\"]", "[\"albedo\", \"depth\"]"})
        for (const char* samples : {"1", "2", "20"}) {
            const Frame frame(ball(0), {std::string("render.channels=") + channels,
                                        std::string("render.samples=") + samples});
            EXPECT_EQ(make_plan(frame.scene, 1).view_rays, frame.stats.view_rays)
                << channels << samples;
        }
    const Frame noisy(ball(0), {"render.noise_target=0.01", "render.max_samples=64"});
    EXPECT_TRUE(needs(noisy.scene, "noise target"));
    EXPECT_GT(noisy.stats.view_rays, 16u * 12 * 3);
    EXPECT_LE(noisy.stats.view_rays, make_plan(noisy.scene, 1).view_rays);
    EXPECT_FALSE(needs(Frame(ball(0), {"render.max_samples=64"}).scene, "noise target"));
}

TEST(PlanOfAPicture, SaysWhetherNoiseMoves) {
    const std::string light =
        "[[light]]\ntype = \"sphere\"\nposition = [0, 6, -6, 0]\nradius = 1\n";
    const std::string bodies[] = {"",    ball(0, "visible = false"),     ball(0), light + ball(0),
                                  light, ball(0, "material = \"glass\"")};
    for (const std::string& body : bodies)
        for (const char* integrator : {"\"direct\"", "\"path\""})
            for (const char* samples : {"1", "2"}) {
                SCOPED_TRACE(body + integrator + samples);
                const auto scene = [&](const std::string& more) {
                    return load_text(
                        kMaterials + body,
                        {"render.size=[16, 12]", more, std::string("render.samples=") + samples,
                         std::string("render.integrator=") + integrator});
                };
                // What is said to be the same is the same in other frames and with other seeds.
                if (!needs(scene("render.seed=0"), "moving noise")) {
                    EXPECT_EQ(preview_of(scene("render.seed=0")),
                              preview_of(scene("render.seed=1")));
                }
                EXPECT_FALSE(needs(scene("render.lock_noise=true"), "moving noise"));
            }
    // And what can differ does.
    for (const std::vector<std::string>& sets :
         {std::vector<std::string>{"render.samples=2"},
          {"render.samples=1", "render.integrator=\"path\""}}) {
        std::vector<std::string> other = sets;
        other.push_back("render.seed=1");
        const std::string text = "[render]\nsize = [16, 12]\n" + light + ball(0) + ball(2);
        EXPECT_TRUE(needs(load_text(text, sets), "moving noise"));
        EXPECT_NE(preview_of(load_text(text, sets)), preview_of(load_text(text, other)));
    }
    EXPECT_FALSE(needs(load_text(light + ball(0), {"render.samples=1"}), "moving noise"));
}

TEST(PlanOfAPicture, SaysWhereRaysEnd) {
    // The default camera is some 8 m from the ball.
    const std::string mirror = kMaterials + ball(0, "material = \"mirror\"");
    const Frame without(mirror), near(mirror, {"render.max_distance=5"});
    EXPECT_FALSE(needs(without.scene, "distance limit"));
    EXPECT_GT(without.stats.bounce_rays, 0u);
    EXPECT_TRUE(needs(near.scene, "distance limit"));
    EXPECT_EQ(near.stats.bounce_rays, 0u);
}

TEST(PlanOfAPicture, SaysWhereViewRaysStart) {
    const auto is_pinhole = [](const Scene& scene) {
        const render::Picture picture = {scene.bodies, scene.appearance, scene.materials,
                                         scene.camera, scene.lights,     scene.render};
        return render::FrameScene(picture, true).is_pinhole();
    };
    for (const std::vector<std::string>& sets :
         {std::vector<std::string>{},
          {"camera.aperture=0.1"},
          {"camera.slice_thickness=0.5"},
          {"camera.slice_thickness=0.5", "camera.slices=4"}}) {
        const Scene scene = load_text(ball(0), sets);
        const bool is_sheet = scene.camera.slices > 1;
        const bool several = is_sheet && needs(scene, "several slices");
        const bool thick = !is_sheet && needs(scene, "thick slice");
        EXPECT_EQ(is_pinhole(scene), !needs(scene, "lens") && !several && !thick);
    }
}

TEST(PlanOfAPicture, SaysWhetherAnOpenShutterSeesMotion) {
    const std::string still = ball(0, "material = \"glass\""),
                      turning =
                          "[physics]\n[[camera.key]]\ntime = 0\nposition = [0, 2, -8, 0]\n"
                          "[[camera.key]]\ntime = 1\nposition = [9, 2, -3, 0]\n" +
                          still;
    for (const std::string& text : {still, turning}) {
        const std::string body = kMaterials + text;
        const Frame open(body,
                         {"camera.shutter=1", "render.samples=16", "physics.gravity=[0,0,0,0]"});
        const Frame shut(body, {"render.samples=16", "physics.gravity=[0,0,0,0]"});
        EXPECT_FALSE(needs(shut.scene, "motion blur"));
        EXPECT_EQ(needs(open.scene, "motion blur"), open.preview != shut.preview);
    }
}

TEST(PlanOfMotion, SaysWhetherAnythingMoves) {
    const std::string held = "fixed = [\"position\", \"rotation\"]\n";
    const std::string weightless = "[physics]\ngravity = [0, 0, 0, 0]\n", falls = "[physics]\n";
    const std::string wall = "[[body]]\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\n";
    const std::string driven =
        "[[joint]]\ntype = \"slider\"\na = \"body-0\"\naxis = [1, 0, 0, 0]\n"
        "motor = { speed = 1 }\n";
    for (const std::string& text :
         {weightless + ball(0), weightless + ball(0, "velocity = [0, 0, 0, 1]"),
          weightless + ball(0, "angular_velocity = { xw = 1 }"), weightless + ball(0) + ball(1),
          weightless + ball(0, held) + ball(5, held), falls + ball(0), falls + ball(0, held),
          falls + ball(0, "fixed = [\"position\"]"), falls + wall,
          falls + ball(0, held + "velocity = [1, 0, 0, 0]"), weightless + ball(0) + driven}) {
        const Scene scene = load_text(text);
        Stepper world(make_simulation(scene.bodies, *scene.physics, scene.joints));
        for (int step = 0; step < 10; ++step) world.step(0.01);
        bool moved = false;
        for (BodyId id = 0; id < scene.bodies.size(); ++id)
            moved |= world.bodies().position[id] != scene.bodies.position[id] ||
                     !(world.bodies().rotor[id] == scene.bodies.rotor[id]);
        EXPECT_EQ(make_plan(scene, 1).moves, moved) << text;
    }
}

TEST(PlanOfMotion, SaysWhatAStepNeeds) {
    const std::string wall =
        "[[body]]\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\n"
        "offset = -1\n";
    const std::string box =
        "[[body]]\nshape = \"hyperbox\"\nsize = [1, 2, 1, 1]\nposition = [5, 3, 0, 0]\n";
    for (const std::string& bodies :
         {ball(0), ball(0, "friction = 0"), ball(0, "restitution = 1"),
          ball(0, "friction = 0\nangular_velocity = { xw = 1 }"), box, ball(0) + box,
          ball(0, "friction = 0\nrestitution = 0.5") + wall, ball(0, "rolling_friction = 0.1"),
          ball(0, "friction = 0\nrolling_friction = 0.1")})
        for (const bool sleeps : {false, true}) {
            const Scene scene =
                load_text("[physics]\nsleeping = " + toml_text(sleeps) + "\n" + bodies + wall);
            Stepper world(scene.bodies, *scene.physics);
            const Needs& step = world.simulation().needs;
            SCOPED_TRACE(bodies);
            EXPECT_EQ(needs(scene, "friction"), step.friction);
            EXPECT_EQ(needs(scene, "rolling friction"), step.rolling);
            EXPECT_EQ(needs(scene, "restitution"), step.restitution);
            EXPECT_EQ(needs(scene, "rotors and angular velocities"), step.turning);
            EXPECT_EQ(needs(scene, "gyroscopic term and 6x6 inertia"), step.uneven_inertia);
            EXPECT_EQ(needs(scene, "sleeping"), sleeps);
        }
    // A ball at rest on a wall falls asleep where it may.
    for (const bool sleeps : {false, true}) {
        const Scene scene =
            load_text("[physics]\nsleeping = " + toml_text(sleeps) + "\n" + ball(0) + wall);
        Stepper world(scene.bodies, *scene.physics);
        StepReport report;
        for (int step = 0; step < 480; ++step) report = world.step(1.0 / 240);
        EXPECT_GT(report.contacts, 0u);
        EXPECT_EQ(needs(scene, "sleeping"), report.asleep > 0);
    }
}

}  // namespace
}  // namespace tesserae::scenes
