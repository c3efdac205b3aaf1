// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/example.hpp"

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "core/dynamics/motion_version.hpp"
#include "core/dynamics/stepper.hpp"
#include "core/error.hpp"
#include "render/frame.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/load/load.hpp"
#include "scenes/trajectory/joint_datasets.hpp"

namespace tesserae::fuzz {

namespace fs = std::filesystem;

const char* const kSceneOfEverything = R"(
[scene]
name = "film"
[physics]
duration = 0.5
steps_per_second = 60
sleeping = true
[[material]]
name = "red"
albedo = [0.8, 0.1, 0.1]
[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 1, 0, 0]
rolling_friction = 0.01
[[body]]
name = "box"
shape = "hyperbox"
size = [1, 1, 1, 1]
position = [0, 0.5, 0, 0]
material = "red"
[[body]]
shape = "hypersphere"
radius = 0.5
position = [3, 0.5, 0, 0]
velocity = [1, 0, 0, 0]
[[lattice]]
name = "row"
shape = "hyperbox"
size = [0.5, 0.5, 0.5, 0.5]
count = [2, 1, 1, 1]
spacing = 1
position = [0, 1.25, 0, 0]
[[joint]]
name = "axle"
type = "hinge"
a = "box"
anchor = [0, 0.5, 0, 0]
plane = "xz"
motor = { speed = 3, max = 100 }
limits = [-90, 90]
[[joint]]
type = "rope"
a = "box"
anchor_b = [0, 2, 0, 0]
length = 2
break = { force = 1 }
[camera]
position = [0, 2, -8, 0]
look_at = [0, 1, 0, 0]
[[camera.key]]
time = 1
field_of_view = 40
[[light]]
type = "sun"
direction = [1, -2, 1, 0.5]
[[light]]
type = "sphere"
position = [0, 5, 0, 0]
radius = 0.2
[render]
size = [64, 48]
frames_per_second = 24
)";

void limit_memory() {
    // A job's share of a node [MiB], which every reader heeds.
    ::setenv("SLURM_MEM_PER_NODE", "800", 1);
}

std::string content_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
}

fs::path memory_folder(const char* name) {
    const fs::path memory = "/dev/shm";
    const fs::path parent = fs::is_directory(memory) ? memory : fs::temp_directory_path();
    std::string made = (parent / (std::string("tesserae-fuzz-") + name + "-XXXXXX")).string();
    if (::mkdtemp(made.data()) == nullptr) throw RunError("no folder " + made);
    return made;
}

namespace {

/// Calls render(picture, info) for a frame of a few tiles.
template <class Render>
void render_example(Render&& render) {
    const std::vector<std::string> sets = {"render.size=[20, 12]", "render.tile=8"};
    const scenes::Scene scene = scenes::load_scene_text("scene.toml", kSceneOfEverything, sets);
    const render::Picture picture = {scene.bodies, scene.appearance, scene.materials,
                                     scene.camera, scene.lights,     scene.render};
    const render::FrameInfo info = {scene.name, scene.hash, "0.1.0", 0, 0, {}};
    render(picture, info);
}

}  // namespace

std::string example_image() {
    const fs::path folder = memory_folder("image"), file = folder / "frame.exr";
    const std::atomic<bool> stop = false;
    render_example([&](const auto& picture, const auto& info) {
        render::render_frame(picture, info, file, {}, stop);
    });
    std::string bytes = content_of(file);
    fs::remove_all(folder);
    return bytes;
}

std::vector<std::string> example_parts(int count) {
    const fs::path folder = memory_folder("parts"), file = folder / "part";
    const std::atomic<bool> stop = false;
    std::vector<std::string> parts;
    render_example([&](const auto& picture, const auto& info) {
        for (int number = 1; number <= count; ++number) {
            render::render_part(picture, info, {number, count}, file, true, stop);
            parts.push_back(content_of(file));
            fs::remove(file);
        }
    });
    fs::remove_all(folder);
    return parts;
}

ExampleTrajectory::ExampleTrajectory()
    : scene_(scenes::load_scene_text("scene.toml", kSceneOfEverything, {})),
      steps_(scenes::stored_steps(scene_, 0)) {}

scenes::TrajectoryHeader ExampleTrajectory::header() const {
    scenes::TrajectoryHeader header;
    header.scene_name = scene_.name;
    header.source = scene_.source;
    header.effective = scene_.effective;
    header.hash = scene_.hash;
    header.motion_hash = scene_.motion_hash;
    header.program_version = "0.1.0";
    header.bodies = scene_.bodies.size();
    for (std::size_t i = 0; i < scene_.joints.size(); ++i)
        header.joints.push_back({scene_.joint_names[i], i == 0 ? "deg" : ""});
    header.joint_parts = make_joints(scene_.joints, scene_.bodies).parts();
    header.steps_per_second = scene_.physics->steps_per_second;
    header.motion_version = kMotionVersion;
    header.described = {scene_.bodies.types, scene_.bodies.type, scene_.names};
    return header;
}

void ExampleTrajectory::append(scenes::TrajectoryWriter& writer, std::size_t lacking) const {
    Bodies start = scene_.bodies;
    std::uint64_t step = 0;
    StepMemory memory;
    if (auto resume = writer.resume(start)) {
        step = resume->step;
        memory = std::move(resume->memory);
    }
    Stepper world(make_simulation(std::move(start), *scene_.physics, scene_.joints));
    world.memory() = std::move(memory);
    scenes::StepFacts facts;
    facts.joints = scenes::room_for_joints(scene_.joints.size());
    for (std::uint64_t row = writer.rows(); row + lacking < steps_.size(); ++row) {
        for (; step < steps_[row]; ++step)
            facts.report = world.step(1 / scene_.physics->steps_per_second);
        facts.step = step;
        facts.time = static_cast<double>(step) / scene_.physics->steps_per_second;
        facts.joints.impulse[0] = facts.joints.position[0] = facts.time;
        facts.joints.broken[1] = row > 2 ? 1 : 0;
        writer.append(facts, world.bodies(), world.memory());
    }
    if (lacking == 0) writer.finish();
}

std::string ExampleTrajectory::written(std::size_t lacking) const {
    const fs::path folder = memory_folder("example"), file = folder / "film.h5";
    {
        scenes::TrajectoryWriter writer(file, header(), steps_, false);
        append(writer, lacking);
    }
    std::string bytes = content_of(lacking == 0 ? file : folder / "film.h5.partial");
    fs::remove_all(folder);
    return bytes;
}

}  // namespace tesserae::fuzz
