// SPDX-License-Identifier: Apache-2.0
// HDF5 loses what it has read of a file when it then fails. The leak sanitizer asks a program for
// what it shall not tell.

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
