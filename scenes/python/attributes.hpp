// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

// Copies and pickles of objects whose class is made in Python from one of ours: they are of the
// same class and have the same attributes, without __init__ being called.
namespace tesserae::python {

/// Returns the attributes of an object.
/// @throws py::type_error   its class has __slots__, which would be lost
pybind11::dict attributes_of(const pybind11::object& self);

/// Makes an object of the class of another, from a state that __setstate__ of `kind` takes.
pybind11::object made_like(const pybind11::object& other, const pybind11::object& kind,
                           const pybind11::tuple& state);

/// Returns what __reduce__ returns for a class that has __getstate__ and __setstate__.
pybind11::tuple reduced(const pybind11::object& self);

}  // namespace tesserae::python
