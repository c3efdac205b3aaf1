#include "scenes/generate/generate.hpp"

#include <gtest/gtest.h>

#include "core/dynamics/world.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

std::uint64_t movable_bodies(const Scene& scene) {
    std::uint64_t count = 0;
    for (BodyId id = 0; id < scene.bodies.size(); ++id) count += scene.bodies.is_movable(id);
    return count;
}

TEST(Generate, HasExactlyTheBodiesAskedForAndNoneStartsInAnother) {
    for (const std::string_view name : kGenerators)
        for (const std::uint64_t bodies : {1, 2, 10, 17, 256, 1003}) {
            SCOPED_TRACE(std::string(name) + " " + std::to_string(bodies));
            const Scene scene = load_text(generated_scene(name, bodies));
            EXPECT_EQ(movable_bodies(scene), bodies);
            World world(scene.bodies, *scene.physics);
            // Half a step of falling moves them by rounding only.
            EXPECT_LT(world.step(1e-6).penetration, 1e-9);
        }
}

TEST(Generate, PyramidAndStacksStandAndAGasMoves) {
    const auto moved = [](const std::string& text) {
        const Scene scene = load_text(text);
        World world(scene.bodies, *scene.physics);
        for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
        double farthest = 0;
        for (BodyId id = 0; id < scene.bodies.size(); ++id)
            farthest = std::max(farthest,
                                (world.bodies().position[id] - scene.bodies.position[id]).norm());
        return farthest;
    };
    // They sink by the overlap that the solver leaves, 5 mm a contact of boxes of 1 m, and no more.
    EXPECT_LT(moved(generated_scene("pyramid", 36)), 8 * 0.005);
    EXPECT_LT(moved(generated_scene("stacks", 40)), 10 * 0.005);
    EXPECT_GT(moved(generated_scene("gas", 40)), 1);
}

TEST(Generate, SaysHowItWasMade) {
    EXPECT_EQ(generated_scene("pile", 12).substr(0, 33), "# tesserae generate pile --bodies");
}

}  // namespace
}  // namespace tesserae::scenes
