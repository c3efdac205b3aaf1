// SPDX-License-Identifier: Apache-2.0
// film SCENE.toml FOLDER: simulates a scene, renders a picture of its last frame, and steps a world
// beside it. Every public header is used.
#include <cstdio>
#include <tesserae/bivector.hpp>
#include <tesserae/body.hpp>
#include <tesserae/error.hpp>
#include <tesserae/joint.hpp>
#include <tesserae/picture.hpp>
#include <tesserae/report.hpp>
#include <tesserae/rotor.hpp>
#include <tesserae/scene.hpp>
#include <tesserae/settings.hpp>
#include <tesserae/shape.hpp>
#include <tesserae/threads.hpp>
#include <tesserae/trajectory.hpp>
#include <tesserae/vector.hpp>
#include <tesserae/world.hpp>

int main(int count, char** arguments) {
    if (count != 3) return 2;
    const std::filesystem::path folder = arguments[2];
    try {
        const tesserae::Scene scene = tesserae::Scene::read(arguments[1]);
        scene.simulate(folder / "film.h5", {.threads = 2});
        const tesserae::Trajectory trajectory(folder / "film.h5");
        const int last = scene.frames() - 1;
        scene.render_frame(last, folder / "film.h5").write_image(folder / "last.exr");

        tesserae::World world = scene.world(tesserae::threads(2));
        while (world.time() < trajectory.times().back()) world.step();
        const tesserae::BodyArrays there = trajectory.state(trajectory.size() - 1);
        std::size_t same = 0;
        for (std::size_t i = 0; i < world.size(); ++i)
            same += world.arrays().position[i] == there.position[i];
        std::printf("%zu of %zu bodies are where the trajectory has them\n", same, world.size());
        std::printf("%zu layers\n", scene.render(world).layers().size());
        return 0;
    } catch (const tesserae::InputError& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
