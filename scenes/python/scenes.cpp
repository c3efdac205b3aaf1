// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "parallel/world_threads.hpp"
#include "scenes/python/record.hpp"
#include "scenes/python/running.hpp"
#include "scenes/python/scene.hpp"
#include "scenes/python/topics.hpp"
#include "scenes/python/world.hpp"
#include "scenes/scene_file.hpp"

namespace tesserae::python {
namespace {

using py::arg;
namespace fs = std::filesystem;

using OptionalPath = std::optional<fs::path>;

std::vector<std::string> sets_of(const py::object& sets) {
    return py::module_::import("tesserae.settings")
        .attr("set_texts")(sets)
        .cast<std::vector<std::string>>();
}

/// Options of work, with what it has to heed.
template <class Options>
Options heeding(Options options, const Control& control, int threads) {
    options.threads = threads;
    options.progress = control.progress;
    options.stop = control.stop;
    return options;
}

py::object simulate(const Scene& self, const fs::path& path, std::uint64_t store_every,
                    bool overwrite, int threads, const py::object& progress) {
    SimulationOptions options;
    options.store_every = store_every;
    options.overwrite = overwrite;
    SimulationResult result;
    run_watched(progress, [&](const Control& control) {
        result = self.simulate(path, heeding(options, control, threads));
    });
    return record("SimulationResult", result.first_step, result.last_step, result.stored,
                  result.kept, result.seconds);
}

Picture render(const Scene& self, SharedWorld& world, int frame, int threads,
               const py::object& progress) {
    PictureOptions options;
    options.frame = frame;
    SharedWorld::Use use(world);
    std::optional<Picture> picture;
    run_watched(progress, [&](const Control& control) {
        picture = self.render(use.world(), heeding(options, control, threads));
    });
    return *picture;
}

Picture render_frame(const Scene& self, int frame, const OptionalPath& trajectory, int threads,
                     const py::object& progress) {
    std::optional<Picture> picture;
    run_watched(progress, [&](const Control& control) {
        picture = self.render_frame(frame, trajectory.value_or(fs::path()),
                                    heeding(PictureOptions(), control, threads));
    });
    return *picture;
}

py::object film(const Scene& self, const fs::path& folder, const OptionalPath& trajectory,
                const std::vector<int>& frames, bool overwrite, int threads,
                const py::object& progress) {
    FilmOptions options;
    options.frames = frames;
    options.overwrite = overwrite;
    FilmResult result;
    run_watched(progress, [&](const Control& control) {
        result =
            self.film(folder, trajectory.value_or(fs::path()), heeding(options, control, threads));
    });
    const auto path = py::module_::import("pathlib").attr("Path");
    return record("FilmResult", result.rendered, result.copied, result.kept, result.seconds,
                  path(result.frames.string()), path(result.preview.string()));
}

std::string text_of(const Scene& self) {
    return fmt::format("<Scene \"{}\": {} bodies, {} joints, {} frames of {} x {}>", self.name(),
                       self.bodies(), self.joints(), self.frames(), self.width(), self.height());
}

void add_making(SceneClass& scene) {
    scene
        .def_static(
            "read",
            [](const fs::path& path, const py::object& sets) {
                return Scene::read(path, sets_of(sets));
            },
            arg("path"), arg("sets") = py::tuple(), R"(read(path, sets=())
--

Reads a scene file. `sets` are settings over its keys: a dict such as {"physics.duration": 2}, or
a list of texts as for --set, such as ["physics.duration=2"].
)")
        .def_static(
            "parse",
            [](std::string text, const py::object& sets, const fs::path& path) {
                return Scene::parse(std::move(text), sets_of(sets), path);
            },
            arg("text"), arg("sets") = py::tuple(), arg("path") = "scene.toml",
            R"(parse(text, sets=(), path='scene.toml')
--

Reads the text of a scene file; `path` names it in messages.

>>> ts.Scene.parse('body = [{ shape = "hypersphere", radius = -1 }]')
Traceback (most recent call last):
...
tesserae.InputError: scene.toml:1:43: ...
)");
}

void add_properties(SceneClass& scene) {
    scene.def_property_readonly("name", &Scene::name, "Its name.")
        .def_property_readonly("text", &Scene::text,
                               "The scene with all defaults and settings, itself a scene file.")
        .def_property_readonly("hash", &Scene::hash, "32 hexadecimal digits of the text.")
        .def_property_readonly("motion_hash", &Scene::motion_hash,
                               "32 hexadecimal digits of what moves bodies.")
        .def_property_readonly("unused_keys", &Scene::unused_keys,
                               "A line for each key that changes nothing.")
        .def_property_readonly(
            "duration",
            [](const Scene& self) { return self.physics() ? self.physics()->duration : 0; },
            "How long its physics lasts [s]; 0 for a still.")
        .def_property_readonly("width", &Scene::width, "Of its pictures [pixels].")
        .def_property_readonly("height", &Scene::height, "Of its pictures [pixels].")
        .def_property_readonly("frames", &Scene::frames, "The number of frames, at least 1.")
        .def_property_readonly("frames_per_second", &Scene::frames_per_second, "[1/s]")
        .def_property_readonly("bodies", &Scene::bodies, "The number of bodies.")
        .def_property_readonly("joints", &Scene::joints, "The number of joints.")
        .def("time_of_frame", &Scene::time_of_frame, arg("frame"), R"(time_of_frame(self, frame)
--

Returns the time of a frame [s].
)")
        .def("body", &Scene::body, arg("name"), R"(body(self, name)
--

Returns the number of the body of this name.
)")
        .def("bodies_of", &Scene::bodies_of, arg("name"), R"(bodies_of(self, name)
--

Returns the numbers of all bodies of a name, ascending: those of a lattice share theirs.
)")
        .def(
            "name_of",
            [](const Scene& self, const py::object& body) {
                return self.name_of(body_of(body, "body"));
            },
            arg("body"), R"(name_of(self, body)
--

Returns the name of a body.
)")
        .def("joint", &Scene::joint, arg("name"), R"(joint(self, name)
--

Returns the number of the joint of this name.
)")
        .def("__repr__", &text_of);
}

void add_work(SceneClass& scene) {
    scene
        .def(
            "world",
            [](const Scene& self, int count) {
                return SharedWorld(self.world(workers_of(count)), count);
            },
            arg("threads") = 0, R"(world(self, threads=0)
--

Makes a World with the scene's bodies and joints as they are at time 0. They have the same numbers.

>>> scene = ts.Scene.parse('body = [{ name = "ball", shape = "hypersphere", radius = 1 }]')
>>> scene.world().state(scene.body("ball")).position
array([0., 0., 0., 0.])
)")
        .def("simulate", &simulate, arg("path"), py::kw_only(), arg("store_every") = 0,
             arg("overwrite") = false, arg("threads") = 0, arg("progress") = py::none(),
             R"(simulate(self, path, *, store_every=0, overwrite=False, threads=0, progress=None)
--

Moves the bodies through the scene's time and stores their states in a trajectory, as `tesserae
simulate` does: a whole file of the same motion is kept, an unfinished one continued. Every so many
steps are stored, 0: those that frames need. `progress` is called with (done, total) steps; True
shows a line. Ctrl-C ends it, and what is stored is kept. Returns a SimulationResult.
)")
        .def("render", &render, arg("world"), py::kw_only(), arg("frame") = 0, arg("threads") = 0,
             arg("progress") = py::none(),
             R"(render(self, world, *, frame=0, threads=0, progress=None)
--

Returns the Picture of a world as it is now, with the scene's camera, lights and settings. A body
looks like the scene's body of the same number; others are grey. Noise differs from frame to frame.
)")
        .def("render_frame", &render_frame, arg("frame"), arg("trajectory") = py::none(),
             py::kw_only(), arg("threads") = 0, arg("progress") = py::none(),
             R"(render_frame(self, frame, trajectory=None, *, threads=0, progress=None)
--

Returns the Picture of a frame, with the pixels that film() gives. Where bodies have moved by then
it needs the scene's trajectory.
)")
        .def(
            "film", &film, arg("folder"), arg("trajectory") = py::none(), py::kw_only(),
            arg("frames") = std::vector<int>(), arg("overwrite") = false, arg("threads") = 0,
            arg("progress") = py::none(),
            R"(film(self, folder, trajectory=None, *, frames=(), overwrite=False, threads=0, progress=None)
--

Renders frames into a folder, as `tesserae render` does: all, or those of these numbers. Frames that
are there are kept. Without a trajectory it is made first, in the folder. `progress` is called with
(done, total) frames; True shows a line. Ctrl-C ends it, and finished frames are kept. Returns a
FilmResult.
)");
}

}  // namespace

void add_scenes(py::module_& module) {
    SceneClass scene(module, "Scene",
                     R"(A scene file, read and checked. It does not change.

>>> scene = ts.Scene.parse('body = [{ shape = "hypersphere", radius = 1 }]')
>>> scene.bodies, scene.width, scene.height
(1, 1280, 720)
)");
    add_making(scene);
    add_properties(scene);
    add_work(scene);
    add_views(scene);
}

}  // namespace tesserae::python
