// SPDX-License-Identifier: Apache-2.0
#include "scenes/python/attributes.hpp"

#include <fmt/format.h>

#include <string>

namespace tesserae::python {

namespace py = pybind11;

py::dict attributes_of(const py::object& self) {
    for (const py::handle kind : py::type::of(self).attr("__mro__")) {
        const py::object own = kind.attr("__dict__");
        if (!own.contains("__slots__") || py::len(own["__slots__"]) == 0) continue;
        throw py::type_error(
            fmt::format("{}: has __slots__, which copies and pickles would lose; expected a class "
                        "without them, or one with a __reduce__ of its own",
                        kind.attr("__name__").cast<std::string>()));
    }
    if (!py::hasattr(self, "__dict__")) return {};
    return self.attr("__dict__").attr("copy")();
}

py::object made_like(const py::object& other, const py::object& kind, const py::tuple& state) {
    const py::object of = py::type::of(other);
    py::object made = of.attr("__new__")(of);
    kind.attr("__setstate__")(made, state);
    return made;
}

py::tuple reduced(const py::object& self) {
    return py::make_tuple(py::module_::import("copyreg").attr("__newobj__"),
                          py::make_tuple(py::type::of(self)), self.attr("__getstate__")());
}

}  // namespace tesserae::python
