// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <utility>

namespace tesserae::python {

/// Makes one of the named tuples of the package's records.py.
template <class... Values>
pybind11::object record(const char* name, Values&&... values) {
    return pybind11::module_::import("tesserae.records")
        .attr(name)(std::forward<Values>(values)...);
}

}  // namespace tesserae::python
