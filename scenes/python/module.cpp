// SPDX-License-Identifier: Apache-2.0
// The module tesserae._tesserae. The package's __init__.py says what is public.
#include <pybind11/pybind11.h>

#include "core/error.hpp"
#include "scenes/process/version.hpp"
#include "scenes/python/topics.hpp"

namespace tesserae::python {

void add_errors(pybind11::module_& module) {
    pybind11::register_exception<RunError>(module, "RunError", PyExc_RuntimeError);
    pybind11::register_exception<InputError>(module, "InputError", PyExc_ValueError);
    module.attr("InputError").attr("__doc__") =
        "What was given is wrong. The message names the place, the value and what was expected.";
    module.attr("RunError").attr("__doc__") =
        "Something failed while it ran: a full disk, a body that left the finite range.";
}

/// What pybind11 says of an item of a list that has a wrong type names types of C++.
void tell_wrong_types() {
    pybind11::register_exception_translator([](std::exception_ptr error) {
        try {
            std::rethrow_exception(error);
        } catch (const pybind11::cast_error&) {
            PyErr_SetString(PyExc_TypeError,
                            "an argument, or an item of one, has a wrong type; the function's "
                            "docstring tells what is expected");
        }
    });
}

}  // namespace tesserae::python

PYBIND11_MODULE(_tesserae, module) {
    using namespace tesserae::python;
    pybind11::options options;
    options.disable_function_signatures();
    add_errors(module);
    tell_wrong_types();
    module.attr("__version__") = tesserae::scenes::program_version();
    add_rotors(module);
    add_shapes(module);
    add_worlds(module);
    add_pictures(module);
    add_scenes(module);
    add_trajectories(module);
    guard_calls(module);
    pybind11::module_ rotor = module.attr("_rotor");
    guard_calls(rotor, "rotor.");
}
