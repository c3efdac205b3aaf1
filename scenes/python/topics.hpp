// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

// What the module consists of: each topic adds its classes and functions. Their docstrings begin
// with the signature, as Python's own functions have it, so that help() and inspect show it.
namespace tesserae::python {

void add_errors(pybind11::module_& module);
void add_rotors(pybind11::module_& module);
void add_shapes(pybind11::module_& module);
void add_worlds(pybind11::module_& module);
void add_pictures(pybind11::module_& module);
void add_scenes(pybind11::module_& module);
void add_trajectories(pybind11::module_& module);

}  // namespace tesserae::python
