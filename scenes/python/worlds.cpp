// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "core/error.hpp"
#include "parallel/world_threads.hpp"
#include "scenes/python/attributes.hpp"
#include "scenes/python/record.hpp"
#include "scenes/python/topics.hpp"
#include "scenes/python/world.hpp"

namespace tesserae::python {
namespace {

using py::arg;

/// Python is asked for signals, such as that of Ctrl-C, this often while a world steps, usual
/// 20 ms: more often costs time, less often makes the user wait.
constexpr std::chrono::milliseconds kBetweenSignals{20};

/// Asks Python for signals amid steps: the thread that steps does, which alone may.
class Signals {
  public:
    /// Returns whether a signal has raised an exception, which then is Python's.
    bool have_raised() const {
        if (raised_ || std::this_thread::get_id() != asking_) return raised_;
        const auto now = std::chrono::steady_clock::now();
        if (now < next_) return false;
        next_ = now + kBetweenSignals;
        const py::gil_scoped_acquire lock;
        raised_ = PyErr_CheckSignals() != 0;
        return raised_;
    }

  private:
    const std::thread::id asking_ = std::this_thread::get_id();
    mutable std::chrono::steady_clock::time_point next_ =
        std::chrono::steady_clock::now() + kBetweenSignals;
    mutable std::atomic<bool> raised_ = false;
};

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
    const Signals signals;
    const auto have_raised = [&] { return signals.have_raised(); };
    try {
        const py::gil_scoped_release without_lock;
        for (std::int64_t done = 0; done < steps; ++done)
            report = use.world().step(time_step, have_raised);
    } catch (const Stopped&) {
        throw py::error_already_set();
    }
    return record("StepReport", report.contacts, report.penetration, report.mean_penetration,
                  report.residual, report.asleep, report.sweeps);
}

/// The bytes of an object of Python that has some, such as bytes, bytearray or memoryview.
class Bytes {
  public:
    /// @throws py::type_error   it has none, or not one after the other
    explicit Bytes(const py::object& data) {
        if (PyObject_GetBuffer(data.ptr(), &buffer_, PyBUF_SIMPLE) == 0) return;
        PyErr_Clear();
        throw py::type_error(fmt::format("data: expected the bytes of save(), got {}",
                                         py::str(py::type::of(data)).cast<std::string>()));
    }
    ~Bytes() { PyBuffer_Release(&buffer_); }
    Bytes(const Bytes&) = delete;
    Bytes& operator=(const Bytes&) = delete;

    std::string_view view() const {
        return {static_cast<const char*>(buffer_.buf), static_cast<std::size_t>(buffer_.len)};
    }

  private:
    Py_buffer buffer_ = {};
};

SharedWorld loaded(const py::object& data, int threads) {
    const Bytes bytes(data);
    return {World::load(bytes.view(), workers_of(threads)), threads};
}

// The state of a pickle: the bytes, or in copies the world itself; threads; attributes.

py::tuple pickle_state(const py::object& self) {
    const auto& world = self.cast<const SharedWorld&>();
    return py::make_tuple(py::bytes(world.get().save()), world.threads(), attributes_of(self));
}
std::pair<SharedWorld, py::dict> of_state(const py::tuple& state) {
    const auto threads = state[1].cast<int>();
    const py::dict attributes = state[2];
    if (!py::isinstance<SharedWorld>(state[0])) return {loaded(state[0], threads), attributes};
    return {SharedWorld(state[0].cast<const SharedWorld&>().get(), threads), attributes};
}

py::object copy_with(const py::object& self, const py::dict& attributes) {
    return made_like(self, py::type::of<SharedWorld>(),
                     py::make_tuple(self, self.cast<const SharedWorld&>().threads(), attributes));
}
py::object copied(const py::object& self) { return copy_with(self, attributes_of(self)); }
py::object deeply_copied(const py::object& self, const py::dict& memo) {
    const py::dict attributes = attributes_of(self);
    py::object made = copy_with(self, {});
    // First: an attribute may lead back to the world.
    memo[py::module_::import("builtins").attr("id")(self)] = made;
    if (!attributes.empty())
        made.attr("__dict__")
            .attr("update")(py::module_::import("copy").attr("deepcopy")(attributes, memo));
    return made;
}

std::string text_of(const SharedWorld& self) {
    const World& world = self.get();
    return fmt::format("<World: {} bodies, {} joints, t = {} s>", world.size(),
                       world.joint_ids().size(), world.time());
}

/// Returns what reads a setting.
template <class T>
auto setting(T PhysicsSettings::*member) {
    return [member](const SharedWorld& self) { return self.get().settings().*member; };
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
        .def_property_readonly("steps_per_second", setting(&PhysicsSettings::steps_per_second),
                               "A step advances by 1 over this [1/s].")
        .def_property_readonly("substeps", setting(&PhysicsSettings::substeps),
                               "A step consists of so many.")
        .def_property_readonly("iterations", setting(&PhysicsSettings::iterations),
                               "The solver sweeps at most so many times a sub-step.")
        .def_property_readonly("tolerance", setting(&PhysicsSettings::tolerance),
                               "The solver ends where a sweep changes no velocity by more [m/s].")
        .def_property_readonly(
            "integrator",
            [](const SharedWorld& self) {
                const auto which = self.get().settings().integrator;
                return which == RotationIntegrator::kEuler ? "euler" : "midpoint";
            },
            "How bodies are turned: \"midpoint\" or \"euler\".")
        .def_property_readonly("sleeping", setting(&PhysicsSettings::sleeping),
                               "Whether bodies at rest are left out until something touches them.")
        .def_property_readonly("seed", setting(&PhysicsSettings::seed),
                               "A number that changes no motion; scenes have it, too.");
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

Makes a World from the bytes of save(), of any type that holds bytes. InputError if they are of something else, are damaged, or
of a tesserae that moves bodies otherwise.

>>> ts.World.load(b"no world")
Traceback (most recent call last):
...
tesserae.InputError: ...
)")
        .def("__copy__", &copied)
        .def("__deepcopy__", &deeply_copied, arg("memo"))
        .def("__reduce__", &reduced)
        .def(py::pickle(&pickle_state, &of_state));
}

}  // namespace

std::shared_ptr<Workers> workers_of(int count) { return threads(count); }

void SharedWorld::set_threads(int threads) {
    get().set_workers(workers_of(threads));
    threads_ = threads;
}

std::optional<BodyId> number_in(const py::object& object) {
    if (PyIndex_Check(object.ptr()) == 0) return {};
    const py::object number = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
    if (!number) throw py::error_already_set();
    int overflow = 0;
    const long long id = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
    if (overflow != 0 || id < 0 || id >= kWorld) return {};
    return static_cast<BodyId>(id);
}

BodyId body_of(const py::object& body, const char* name) {
    if (body.is_none()) return kWorld;
    if (const std::optional<BodyId> id = number_in(body)) return *id;
    const auto text = py::repr(body).cast<std::string>();
    if (PyIndex_Check(body.ptr()) == 0)
        throw py::type_error(fmt::format("{}: expected a number, got {}", name, text));
    throw InputError(fmt::format("{} = {}: the world has none with this number", name, text));
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
              arg("steps_per_second") = 240.0, arg("substeps") = 1, arg("iterations") = 100,
              arg("tolerance") = 1e-6, arg("integrator") = "midpoint", arg("sleeping") = false,
              arg("seed") = 1, arg("threads") = 0,
              "__init__(self, *, gravity=None, steps_per_second=240.0, substeps=1, iterations=100, "
              "tolerance=1e-06, integrator='midpoint', sleeping=False, seed=1, threads=0)\n--\n\n"
              "Makes an empty world. The settings are those of a scene's [physics]: gravity (4,) "
              "[m/s^2], by\ndefault (0, -10, 0, 0); threads 0: as many as cores.\n");
    world.def("step", &step, arg("dt") = py::none(), arg("steps") = 1,
              R"(step(self, dt=None, steps=1)
--

Steps so many times, by dt [s] each or else by 1 / steps_per_second, and returns the StepReport of
the last step. Other Python threads run meanwhile. Ctrl-C stops it, also amid a step, and RunError
comes if a body became too fast or too far away: the world is then as before that step.

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
