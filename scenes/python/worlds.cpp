// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <chrono>

#include "core/error.hpp"
#include "parallel/world_threads.hpp"
#include "scenes/python/record.hpp"
#include "scenes/python/topics.hpp"
#include "scenes/python/world.hpp"

namespace tesserae::python {
namespace {

using py::arg;

/// Python is asked for signals, such as that of Ctrl-C, this often while a world steps, usual
/// 20 ms: more often costs time, less often makes the user wait.
constexpr std::chrono::milliseconds kBetweenSignals{20};

RotationIntegrator integrator_of(const std::string& name) {
    if (name == "midpoint") return RotationIntegrator::kMidpoint;
    if (name == "euler") return RotationIntegrator::kEuler;
    throw InputError(fmt::format("integrator = \"{}\": expected \"midpoint\" or \"euler\"", name));
}

SharedWorld made(const py::object& gravity, double steps_per_second, int substeps, int iterations,
                 double tolerance, const std::string& integrator, bool sleeping, std::uint64_t seed,
                 int threads) {
    PhysicsSettings settings;
    if (!gravity.is_none()) settings.gravity = vec4_of(gravity, "gravity");
    settings.steps_per_second = steps_per_second;
    settings.substeps = substeps;
    settings.iterations = iterations;
    settings.tolerance = tolerance;
    settings.integrator = integrator_of(integrator);
    settings.sleeping = sleeping;
    settings.seed = seed;
    return {World(settings, workers_of(threads)), threads};
}

py::object step(SharedWorld& self, std::optional<double> dt, std::int64_t steps) {
    if (steps < 1) throw InputError(fmt::format("steps = {}: expected a number > 0", steps));
    SharedWorld::Use use(self);
    const double time_step = dt ? *dt : 1 / use.world().settings().steps_per_second;
    StepReport report;
    for (std::int64_t done = 0; done < steps;) {
        {
            const py::gil_scoped_release without_lock;
            const auto begin = std::chrono::steady_clock::now();
            do {
                report = use.world().step(time_step);
                ++done;
            } while (done < steps && std::chrono::steady_clock::now() - begin < kBetweenSignals);
        }
        if (done < steps && PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    return record("StepReport", report.contacts, report.penetration, report.mean_penetration,
                  report.residual, report.asleep);
}

SharedWorld copied(const SharedWorld& self) { return {self.get(), self.threads()}; }

SharedWorld loaded(const py::bytes& bytes, int threads) {
    return {World::load(bytes.cast<std::string_view>(), workers_of(threads)), threads};
}

std::string text_of(const SharedWorld& self) {
    const World& world = self.get();
    return fmt::format("<World: {} bodies, {} joints, t = {} s>", world.size(),
                       world.joint_ids().size(), world.time());
}

void add_settings(WorldClass& world) {
    world
        .def_property(
            "gravity",
            [](const SharedWorld& self) { return array_of(self.get().settings().gravity); },
            [](SharedWorld& self, const py::object& gravity) {
                self.get().set_gravity(vec4_of(gravity, "gravity"));
            },
            "The acceleration (4,) of what falls [m/s^2].")
        .def_property("threads", &SharedWorld::threads, &SharedWorld::set_threads,
                      "The number of threads that step it; 0: as many as cores. It changes no "
                      "result.")
        .def_property_readonly(
            "steps_per_second",
            [](const SharedWorld& self) { return self.get().settings().steps_per_second; },
            "A step advances by 1 over this [1/s].");
}

void add_state(WorldClass& world) {
    world
        .def(
            "save", [](const SharedWorld& self) { return py::bytes(self.get().save()); },
            R"(save(self)
--

Returns the whole state as bytes. A world that is loaded from them goes on with the same bits.
Worlds can be pickled, too.

>>> world = ts.World()
>>> ball = world.add(ts.Hypersphere(0.5))
>>> len(ts.World.load(world.save()))
1
)")
        .def_static("load", &loaded, arg("data"), arg("threads") = 0, R"(load(data, threads=0)
--

Makes a world from the bytes of save(). InputError if they are of something else, are damaged, or
of a tesserae that moves bodies otherwise.

>>> ts.World.load(b"no world")
Traceback (most recent call last):
...
tesserae.InputError: ...
)")
        .def("__copy__", &copied)
        .def(
            "__deepcopy__", [](const SharedWorld& self, const py::object&) { return copied(self); },
            arg("memo"))
        .def("__reduce__", [](const SharedWorld& self) {
            return py::make_tuple(py::module_::import("tesserae.records").attr("loaded_world"),
                                  py::make_tuple(py::bytes(self.get().save()), self.threads()));
        });
}

}  // namespace

std::shared_ptr<Workers> workers_of(int count) { return threads(count); }

void SharedWorld::set_threads(int threads) {
    get().set_workers(workers_of(threads));
    threads_ = threads;
}

BodyId body_of(const py::object& body, const char* name) {
    if (body.is_none()) return kWorld;
    const py::object number = py::reinterpret_steal<py::object>(PyNumber_Index(body.ptr()));
    if (!number) {
        PyErr_Clear();
        throw py::type_error(
            fmt::format("{}: expected a number, got {}", name, py::repr(body).cast<std::string>()));
    }
    const auto id = PyLong_AsLongLong(number.ptr());
    // What is too large for a number is no body's either; the world says so.
    if (PyErr_Occurred() != nullptr) PyErr_Clear();
    if (id < 0 || id >= kWorld)
        throw InputError(fmt::format("{} = {}: the world has none with this number", name,
                                     py::repr(body).cast<std::string>()));
    return static_cast<BodyId>(id);
}

void add_worlds(py::module_& module) {
    WorldClass world(module, "World",
                     R"(Rigid bodies in four dimensions, stepped on any number of threads.

Bodies and joints have numbers, counted from 0 as they are added; the number of one that was removed
is not used again. The same calls give the same bits with any number of threads. While one Python
thread steps a world, calls of others raise RuntimeError.

>>> world = ts.World(gravity=[0, -10, 0, 0])
>>> ball = world.add(ts.Hypersphere(0.5), position=[0, 2, 0, 0.2])
>>> report = world.step(steps=240)
>>> world.position.round(3)
array([[ 0. , -3. ,  0. ,  0.2]])
)");
    world.def(py::init(&made), py::kw_only(), arg("gravity") = py::none(),
              arg("steps_per_second") = 240.0, arg("substeps") = 1, arg("iterations") = 10,
              arg("tolerance") = 1e-6, arg("integrator") = "midpoint", arg("sleeping") = false,
              arg("seed") = 1, arg("threads") = 0,
              "__init__(self, *, gravity=None, steps_per_second=240.0, substeps=1, iterations=10, "
              "tolerance=1e-06, integrator='midpoint', sleeping=False, seed=1, threads=0)\n--\n\n"
              "Makes an empty world. The settings are those of a scene's [physics]: gravity (4,) "
              "[m/s^2], by\ndefault (0, -10, 0, 0); threads 0: as many as cores.\n");
    world.def("step", &step, arg("dt") = py::none(), arg("steps") = 1,
              R"(step(self, dt=None, steps=1)
--

Steps so many times, by dt [s] each or else by 1 / steps_per_second, and returns the StepReport of
the last step. Other Python threads run meanwhile, and Ctrl-C stops it between two steps. RunError
if a body became too fast or too far away: the world is then as before that step.

>>> world = ts.World()
>>> world.step(0.5, steps=2).contacts
0
>>> world.time
1.0
)");
    world.def_property_readonly(
        "time", [](const SharedWorld& self) { return self.get().time(); },
        "The time of all steps [s].");
    world.def("__repr__", &text_of);
    add_settings(world);
    add_state(world);
    add_bodies(world);
    add_joints(world);
    add_readings(world);
    add_views(world);
}

}  // namespace tesserae::python
