// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/error.hpp"
#include "core/file/read_file.hpp"
#include "scenes/film/frame_in_memory.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/python/running.hpp"
#include "scenes/python/scene.hpp"
#include "scenes/python/topics.hpp"
#include "scenes/python/world.hpp"
#include "scenes/view/view.hpp"

// Pages to look around in, as strings.
namespace tesserae::python {
namespace {

using py::arg;
namespace fs = std::filesystem;

/// A folder for files that are needed for a moment.
class TemporaryFolder {
  public:
    TemporaryFolder()
        : folder_(py::module_::import("tempfile").attr("mkdtemp")().cast<std::string>()) {}
    ~TemporaryFolder() {
        std::error_code nothing_to_do;
        fs::remove_all(folder_, nothing_to_do);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const fs::path& path() const { return folder_; }

  private:
    fs::path folder_;
};

std::string page_text(const scenes::Scene& scene, const fs::path& trajectory,
                      const fs::path& folder) {
    scenes::ViewOptions options;
    options.quiet = true;
    const fs::path file = folder / "view.html";
    scenes::write_view(scene, trajectory, file, options);
    return read_file(file);
}

py::object page_of(const std::string& text, int height) {
    return py::module_::import("tesserae.page").attr("Page")(text, height);
}

py::object view_scene(const Scene& self, const std::optional<fs::path>& trajectory, int threads,
                      const py::object& progress, int height) {
    const TemporaryFolder folder;
    std::string text;
    run_watched(progress, [&](const Control& control) {
        fs::path moved = trajectory.value_or(fs::path());
        if (moved.empty() && scenes::make_plan(self.inside(), 1).moves) {
            moved = folder.path() / "trajectory.h5";
            SimulationOptions options;
            options.threads = threads;
            options.progress = control.progress;
            options.stop = control.stop;
            self.simulate(moved, options);
        }
        text = page_text(self.inside(), moved, folder.path());
    });
    return page_of(text, height);
}

/// A scene for a world that has none: light from above, and a camera that sees all bodies that end
/// somewhere.
Scene scene_around(const World& world) {
    py::list centres, radii;
    for (const BodyId body : world.ids()) {
        const double radius = bounding_radius(world.type(body).shape);
        if (!std::isfinite(radius)) continue;
        centres.append(array_of(world.state(body).position));
        radii.append(radius);
    }
    const py::object text =
        py::module_::import("tesserae.page").attr("scene_around")(centres, radii);
    return Scene::parse(text.cast<std::string>(), {}, "world.toml");
}

py::object view_world(SharedWorld& self, const Scene* scene, int height) {
    SharedWorld::Use use(self);
    const Scene looks = scene == nullptr ? scene_around(use.world()) : *scene;
    const TemporaryFolder folder;
    std::string text;
    run_watched(py::none(), [&](const Control&) {
        scenes::Scene shown = scenes::scene_of_world(looks.inside(), use.world());
        // A moment, not a film.
        shown.physics.reset();
        shown.joints.clear();
        shown.joint_names.clear();
        text = page_text(shown, {}, folder.path());
    });
    return page_of(text, height);
}

}  // namespace

void add_views(SceneClass& scene) {
    scene.def("view", &view_scene, arg("trajectory") = py::none(), py::kw_only(),
              arg("threads") = 0, arg("progress") = py::none(), arg("height") = 480,
              R"(view(self, trajectory=None, *, threads=0, progress=None, height=480)
--

Returns a Page to look around in, which notebooks show: the film's slice at any moment, with time
and w on sliders. Without a trajectory it is made first. The height is of its frame [pixels].
)");
}

void add_views(WorldClass& world) {
    world.def("view", &view_world, arg("scene") = py::none(), py::kw_only(), arg("height") = 480,
              R"(view(self, scene=None, *, height=480)
--

Returns a Page to look around in, which notebooks show: the world as it is now. Camera, light and
looks are those of a scene, or else a grey look from where all is seen.

>>> world = ts.World()
>>> ball = world.add(ts.Hypersphere(0.5))
>>> world.view().html.startswith("<!DOCTYPE html>")
True
)");
}

}  // namespace tesserae::python
