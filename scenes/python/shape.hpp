// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <utility>

#include "core/shape/shape.hpp"

namespace tesserae::python {

/// What Python's class Shape holds: one shape, checked and complete. It does not change.
struct AnyShape {
    Shape shape;
};
/// The same for each of Python's classes of shapes.
template <class S>
struct OneShape : AnyShape {};

/// Returns the Python object of a shape.
pybind11::object object_of(const Shape& shape);

}  // namespace tesserae::python
