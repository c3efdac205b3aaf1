// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene_file.hpp"

#include <algorithm>
#include <utility>

#include "core/dynamics/step/step.hpp"
#include "core/error.hpp"
#include "core/world/make_world.hpp"
#include "parallel/threads.hpp"
#include "scenes/film/film.hpp"
#include "scenes/film/frame_in_memory.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/load/load.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/timeline.hpp"

namespace tesserae {
namespace {

namespace fs = std::filesystem;

/// Set by nobody: signals belong to the program that the library is in.
const std::atomic<bool> never_stopped{false};

template <class Options>
scenes::Watch watch_of(const Options& options) {
    return {options.stop != nullptr ? options.stop : &never_stopped, options.progress};
}

int threads_of(int asked) { return asked == 0 ? parallel::granted_cores() : asked; }

template <class Work>
void run_on(int threads, Work&& work) {
    parallel::Threads(threads_of(threads)).run(work);
}

/// @throws InputError   what names no thing of this kind
[[noreturn]] void fail_name(const scenes::Scene& scene, const char* kind, std::string_view name,
                            const std::vector<std::string_view>& known) {
    throw InputError(fmt::format("{}: {} \"{}\": the scene has none of this name{}",
                                 scene.file.string(), kind, name,
                                 scenes::did_you_mean(name, known)));
}

const scenes::NamedBodies& named(const scenes::Scene& scene, std::string_view name) {
    const auto at = std::find_if(scene.names.begin(), scene.names.end(),
                                 [&](const auto& bodies) { return bodies.name == name; });
    if (at != scene.names.end()) return *at;
    std::vector<std::string_view> known;
    for (const scenes::NamedBodies& bodies : scene.names) known.push_back(bodies.name);
    fail_name(scene, "body", name, known);
}

/// Makes the trajectory of a film, where it is not there.
void simulate_for(const scenes::Scene& scene, const scenes::Plan& plan, const fs::path& file,
                  const FilmOptions& options) {
    if (scenes::how_served(scene, file, 0, options.frames) == scenes::Served::kByMore) return;
    scenes::SimulateOptions how;
    how.frames = options.frames;
    how.overwrite = options.overwrite;
    how.quiet = true;
    how.watch.stop = watch_of(options).stop;
    scenes::simulate(scene, plan, file, how);
}

}  // namespace

Scene Scene::read(const fs::path& file, const std::vector<std::string>& sets) {
    return Scene(std::make_shared<scenes::Scene>(scenes::load_scene(file, sets)));
}

Scene Scene::parse(std::string text, const std::vector<std::string>& sets, const fs::path& file) {
    return Scene(
        std::make_shared<scenes::Scene>(scenes::load_scene_text(file, std::move(text), sets)));
}

const std::string& Scene::name() const { return inside_->name; }
const std::string& Scene::text() const { return inside_->effective; }
const std::string& Scene::hash() const { return inside_->hash; }
const std::string& Scene::motion_hash() const { return inside_->motion_hash; }
const std::vector<std::string>& Scene::unused_keys() const { return inside_->unused; }
const std::optional<PhysicsSettings>& Scene::physics() const { return inside_->physics; }

int Scene::width() const {
    const render::Crop window = inside_->render.window();
    return window.x1 - window.x0;
}
int Scene::height() const {
    const render::Crop window = inside_->render.window();
    return window.y1 - window.y0;
}
int Scene::frames() const { return scenes::frame_count(*inside_); }
double Scene::frames_per_second() const { return inside_->render.frames_per_second; }

double Scene::time_of_frame(int frame) const {
    if (!scenes::has_frame(*inside_, frame))
        throw InputError(fmt::format("{}: frame {}: the scene has frames 0 to {}",
                                     inside_->file.string(), frame, frames() - 1));
    return scenes::frame_instant(*inside_, frame).time;
}

std::size_t Scene::bodies() const { return inside_->bodies.size(); }
std::size_t Scene::joints() const { return inside_->joints.size(); }

BodyId Scene::body(std::string_view name) const {
    const scenes::NamedBodies& bodies = named(*inside_, name);
    if (bodies.count != 1)
        throw InputError(fmt::format("{}: body \"{}\": is a lattice of {} bodies",
                                     inside_->file.string(), name, bodies.count));
    return bodies.first;
}

std::vector<BodyId> Scene::bodies_of(std::string_view name) const {
    const scenes::NamedBodies& bodies = named(*inside_, name);
    std::vector<BodyId> ids(bodies.count);
    for (std::uint32_t i = 0; i < bodies.count; ++i) ids[i] = bodies.first + i;
    return ids;
}

const std::string& Scene::name_of(BodyId body) const {
    if (body >= bodies())
        throw InputError(fmt::format("{}: body {}: the scene has {} bodies", inside_->file.string(),
                                     body, bodies()));
    const auto after = std::upper_bound(
        inside_->names.begin(), inside_->names.end(), body,
        [](BodyId id, const scenes::NamedBodies& names) { return id < names.first; });
    return std::prev(after)->name;
}

JointId Scene::joint(std::string_view name) const {
    const std::vector<std::string>& names = inside_->joint_names;
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) fail_name(*inside_, "joint", name, {names.begin(), names.end()});
    return static_cast<JointId>(at - names.begin());
}

World Scene::world(std::shared_ptr<Workers> workers) const {
    return make_world(
        make_simulation(inside_->bodies, physics().value_or(PhysicsSettings()), inside_->joints),
        std::move(workers));
}

SimulationResult Scene::simulate(const fs::path& file, const SimulationOptions& options) const {
    const scenes::Plan plan = scenes::make_plan(*inside_, threads_of(options.threads));
    scenes::require_memory(plan, *inside_);
    scenes::SimulateOptions how;
    how.store_every = options.store_every;
    how.overwrite = options.overwrite;
    how.quiet = true;
    how.watch = watch_of(options);
    scenes::SimulateReport report;
    run_on(options.threads, [&] { report = scenes::simulate(*inside_, plan, file, how); });
    return {report.first_step, report.last_step, report.rows, report.kept, report.seconds};
}

Picture Scene::render(const World& world, const PictureOptions& options) const {
    if (options.frame < 0)
        throw InputError(fmt::format("frame = {}: expected a number >= 0", options.frame));
    std::optional<Picture> picture;
    run_on(options.threads, [&] {
        picture = scenes::world_in_memory(*inside_, world, options.frame, watch_of(options));
    });
    return *std::move(picture);
}

Picture Scene::render_frame(int frame, const fs::path& trajectory,
                            const PictureOptions& options) const {
    std::optional<Picture> picture;
    run_on(options.threads, [&] {
        picture = scenes::frame_in_memory(*inside_, frame, trajectory, watch_of(options));
    });
    return *std::move(picture);
}

FilmResult Scene::film(const fs::path& folder, const fs::path& trajectory,
                       const FilmOptions& options) const {
    const scenes::Plan plan = scenes::make_plan(*inside_, threads_of(options.threads));
    scenes::require_memory(plan, *inside_);
    std::vector<int> frames = options.frames;
    if (frames.empty()) frames = scenes::parse_frames("", this->frames());
    std::sort(frames.begin(), frames.end());
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    for (const int frame : frames) time_of_frame(frame);
    const auto replace = options.overwrite ? scenes::Replace::kAll : scenes::Replace::kNothing;
    scenes::FilmReport report;
    run_on(options.threads, [&] {
        fs::path moved = trajectory;
        if (moved.empty() && plan.moves) {
            scenes::require_folder_of(*inside_, folder, replace);
            scenes::create_folder(folder);
            moved = folder / "trajectory.h5";
            simulate_for(*inside_, plan, moved, options);
        }
        report =
            scenes::film(*inside_, frames, moved, folder, replace, true, {}, watch_of(options));
    });
    return {report.rendered, report.copied, report.kept,
            report.seconds,  report.frames, report.preview};
}

}  // namespace tesserae
