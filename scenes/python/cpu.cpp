// SPDX-License-Identifier: Apache-2.0
// The module tesserae._cpu: importing it raises ImportError on a CPU that lacks what the rest was
// compiled for. The package imports it before all else. It is compiled for any CPU.
#include <Python.h>

#include "core/cpu_check.hpp"

extern "C" __attribute__((visibility("default"))) PyObject* PyInit__cpu() {
    static PyModuleDef module = {PyModuleDef_HEAD_INIT,
                                 "_cpu",
                                 "Is imported where the CPU suffices.",
                                 -1,
                                 nullptr,
                                 nullptr,
                                 nullptr,
                                 nullptr,
                                 nullptr};
    if (cpu_suffices()) return PyModule_Create(&module);
    PyErr_SetString(PyExc_ImportError, kCpuMessage);
    return nullptr;
}
