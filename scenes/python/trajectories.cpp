// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "scenes/python/arrays.hpp"
#include "scenes/python/record.hpp"
#include "scenes/python/topics.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/trajectory_file.hpp"

namespace tesserae::python {
namespace {

using py::arg;
namespace fs = std::filesystem;

py::object state_at(const Trajectory& self, std::size_t i) {
    const BodyArrays state = self.state(i);
    const py::object owner = owner_of(state.memory);
    return record("BodyState", view_of(state.position, owner), view_of(state.rotor, owner),
                  view_of(state.velocity, owner), view_of(state.angular_velocity, owner));
}

/// Copies one part of a state to its place in the array of several.
template <class T>
void copy_rows(std::span<const T> rows, Numbers& to, std::size_t step) {
    const std::size_t width = sizeof(T) / sizeof(double);
    std::copy_n(reinterpret_cast<const double*>(rows.data()), rows.size() * width,
                to.mutable_data() + step * rows.size() * width);
}

py::object states_at(const Trajectory& self, const py::slice& slice) {
    py::ssize_t start = 0, stop = 0, by = 0, count = 0;
    if (!slice.compute(static_cast<py::ssize_t>(self.size()), &start, &stop, &by, &count))
        throw py::error_already_set();
    const auto bodies = static_cast<py::ssize_t>(self.bodies());
    const auto empty = [&](py::ssize_t width) { return Numbers({count, bodies, width}); };
    Numbers position = empty(4), rotor = empty(8), velocity = empty(4), angular_velocity = empty(6);
    for (py::ssize_t i = 0; i < count; ++i) {
        const BodyArrays state = self.state(static_cast<std::size_t>(start + i * by));
        const auto at = static_cast<std::size_t>(i);
        copy_rows(state.position, position, at);
        copy_rows(state.rotor, rotor, at);
        copy_rows(state.velocity, velocity, at);
        copy_rows(state.angular_velocity, angular_velocity, at);
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    return record("BodyState", position, rotor, velocity, angular_velocity);
}

py::object item(const Trajectory& self, const py::object& index) {
    if (py::isinstance<py::slice>(index)) return states_at(self, index.cast<py::slice>());
    const py::ssize_t number = PyNumber_AsSsize_t(index.ptr(), PyExc_IndexError);
    if (number == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
    const auto size = static_cast<py::ssize_t>(self.size());
    const py::ssize_t i = number < 0 ? number + size : number;
    if (i < 0 || i >= size)
        throw py::index_error(fmt::format("{}: the trajectory has {} stored steps", number, size));
    return state_at(self, static_cast<std::size_t>(i));
}

}  // namespace

void add_trajectories(py::module_& module) {
    py::class_<Trajectory>(module, "Trajectory", R"(A trajectory, finished or not, open for reading.

trajectory[i] is the state of all bodies at a stored step, a BodyState of arrays (bodies, 4) and so
on; trajectory[a:b] of several, with arrays (steps, bodies, 4). A step is read when it is asked for.)")
        .def(py::init<const fs::path&>(), arg("path"), "__init__(self, path)\n--\n\n")
        .def("__len__", &Trajectory::size)
        .def("__getitem__", &item, arg("index"))
        .def_property_readonly(
            "steps",
            [](const Trajectory& self) {
                const auto steps = self.steps();
                return py::array_t<std::uint64_t>(static_cast<py::ssize_t>(steps.size()),
                                                  steps.data());
            },
            "The numbers of the stored steps, ascending.")
        .def_property_readonly(
            "times",
            [](const Trajectory& self) {
                const auto times = self.times();
                return py::array_t<double>(static_cast<py::ssize_t>(times.size()), times.data());
            },
            "The times of the stored steps [s].")
        .def_property_readonly("bodies", &Trajectory::bodies, "The number of bodies.")
        .def_property_readonly("names", &Trajectory::names,
                               "Each body's name. Those of a lattice share theirs.")
        .def_property_readonly(
            "masses",
            [](const Trajectory& self) {
                const std::vector<double> masses = self.masses();
                return py::array_t<double>(static_cast<py::ssize_t>(masses.size()), masses.data());
            },
            "Each body's mass [kg], infinite for a hyperplane.")
        .def_property_readonly("scene_name", &Trajectory::scene_name,
                               "The name of the scene that was simulated.")
        .def_property_readonly("scene_text", &Trajectory::scene_text,
                               "The effective text of that scene: Scene.parse() reads it.")
        .def_property_readonly("motion_hash", &Trajectory::motion_hash,
                               "That of Scene.motion_hash: 32 hexadecimal digits.");
}

}  // namespace tesserae::python
