// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>

#include <cstddef>
#include <exception>
#include <string>

#include "scenes/python/topics.hpp"

// What holds of all calls of the module, whichever function or class they are of.
namespace tesserae::python {
namespace {

namespace py = pybind11;

/// Is asked for the memory of an object that holds nothing. pybind11 would leave it uninitialised.
void* refuse_empty_object(std::size_t) {
    throw py::type_error(
        "this object was made by __new__ alone and holds nothing; call its class, or a function "
        "that returns one");
}

/// A function as Python calls it: pybind11's, and the name by which it is known.
struct TellingFunction {
    PyMethodDef definition;
    py::object function;
    std::string name;
};

/// Replaces a TypeError of arguments that no function takes, which lists signatures of C++, by a
/// line that names the wrong one. Others stay.
void tell_arguments(const TellingFunction& of, PyObject* arguments, PyObject* keywords) {
    py::error_already_set error;
    const std::string text = py::str(error.value()).cast<std::string>();
    if (text.find("(): incompatible ") == std::string::npos) return error.restore();
    const py::object named =
        keywords != nullptr ? py::reinterpret_borrow<py::object>(keywords) : py::object(py::dict());
    const py::object line =
        py::module_::import("tesserae.arguments")
            .attr("complaint")(of.name, of.function, text, py::handle(arguments), named);
    PyErr_SetObject(PyExc_TypeError, line.ptr());
}

PyObject* call(PyObject* self, PyObject* arguments, PyObject* keywords) {
    const auto& of = *static_cast<TellingFunction*>(PyCapsule_GetPointer(self, nullptr));
    PyObject* result = PyObject_Call(of.function.ptr(), arguments, keywords);
    if (result != nullptr || PyErr_ExceptionMatches(PyExc_TypeError) == 0) return result;
    try {
        tell_arguments(of, arguments, keywords);
    } catch (py::error_already_set& error) {
        error.restore();
    } catch (const std::exception& error) {
        PyErr_SetString(PyExc_TypeError, error.what());
    }
    return nullptr;
}

/// Returns a function that tells what is wrong with its arguments. All else of it is as it was.
py::object telling(const py::object& function, std::string name) {
    const PyMethodDef* old = reinterpret_cast<PyCFunctionObject*>(function.ptr())->m_ml;
    auto* made = new TellingFunction{*old, function, std::move(name)};
    made->definition.ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&call));
    const py::capsule owner(made,
                            [](void* pointer) { delete static_cast<TellingFunction*>(pointer); });
    return py::reinterpret_steal<py::object>(
        PyCFunction_NewEx(&made->definition, owner.ptr(), function.attr("__module__").ptr()));
}

/// The same for what a class has under a name, or a null object if that is no function.
py::object telling_member(const py::handle& member, const std::string& name) {
    if (PyInstanceMethod_Check(member.ptr()) != 0) {
        const auto inside =
            py::reinterpret_borrow<py::object>(PyInstanceMethod_GET_FUNCTION(member.ptr()));
        return py::reinterpret_steal<py::object>(PyInstanceMethod_New(telling(inside, name).ptr()));
    }
    const py::module_ builtins = py::module_::import("builtins");
    if (py::isinstance(member, builtins.attr("staticmethod")))
        return builtins.attr("staticmethod")(telling(member.attr("__func__"), name));
    if (!py::isinstance(member, builtins.attr("property")) || member.attr("fset").is_none())
        return {};
    // Of what is read the only argument is the object itself.
    const py::object set = member.attr("fset");
    const py::object inside =
        PyInstanceMethod_Check(set.ptr()) != 0
            ? py::reinterpret_borrow<py::object>(PyInstanceMethod_GET_FUNCTION(set.ptr()))
            : set;
    return builtins.attr("property")(member.attr("fget"), telling(inside, name), py::none(),
                                     member.attr("__doc__"));
}

/// Gives a class whose objects are not made by calling it an __init__ that says so.
void refuse_construction(const py::handle& kind, const std::string& name) {
    const auto refuse = [name](const py::args&, const py::kwargs&) {
        throw py::type_error(name + "(): cannot be called; functions return objects of it");
    };
    py::setattr(kind, "__init__",
                py::cpp_function(refuse, py::is_method(kind), py::name("refuse_construction")));
}

void guard_class(const py::handle& kind, const std::string& name) {
    py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(kind.ptr()))->operator_new =
        &refuse_empty_object;
    const py::dict members = kind.attr("__dict__").attr("copy")();
    for (const auto& [member, value] : members) {
        const auto text = member.cast<std::string>();
        const py::object told =
            telling_member(value, text == "__init__" ? name : name + "." + text);
        if (told) py::setattr(kind, member, told);
    }
    if (PyInstanceMethod_Check(members["__init__"].ptr()) == 0) refuse_construction(kind, name);
}

/// Returns whether it is a class of pybind11, as errors are not.
bool is_bound_class(const py::handle& value) {
    return Py_TYPE(value.ptr()) == py::detail::get_internals().default_metaclass;
}

}  // namespace

void guard_calls(py::module_& module, const std::string& prefix) {
    const py::dict members = module.attr("__dict__").attr("copy")();
    for (const auto& [member, value] : members) {
        const auto name = prefix + member.cast<std::string>();
        if (PyCFunction_Check(value.ptr()) != 0)
            module.attr(member) = telling(py::reinterpret_borrow<py::object>(value), name);
        else if (is_bound_class(value))
            guard_class(value, name);
    }
}

}  // namespace tesserae::python
