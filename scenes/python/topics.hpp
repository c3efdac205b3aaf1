// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>

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

/// Makes the calls of all functions and classes of a module safe and their errors readable: what
/// was not initialised is refused, and wrong arguments are named. It comes last.
/// @param prefix   of the names in errors
void guard_calls(pybind11::module_& module, const std::string& prefix = "");

}  // namespace tesserae::python
