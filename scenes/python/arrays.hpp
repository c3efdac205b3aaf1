// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/algebra/rotor.hpp"

// Numbers from Python and back. Rotors have eight components s, xy, xz, xw, yz, yw, zw, p, as in
// memory; bivectors six.
namespace tesserae::python {

namespace py = pybind11;

/// A contiguous array of doubles.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Returns numbers as an array of any shape.
/// @param name   of the argument, for errors
/// @throws py::type_error   they are none
Numbers numbers_of(py::handle value, const char* name);

/// Returns one number, four, or the components of a rotor or bivector.
/// @throws py::type_error   it is no number, or these are none
/// @throws InputError       they are too few or too many
double real_of(py::handle value, const std::string& name);
std::int64_t integer_of(py::handle value, const std::string& name);
Vec4 vec4_of(py::handle value, const char* name);
Vec2 vec2_of(py::handle value, const char* name);
Bivector bivector_of(py::handle value, const char* name);
Rotor rotor_of(py::handle value, const char* name);

/// Rows of a fixed number of components: one row, of shape (width,), or several, (n, width).
class Rows {
  public:
    /// @throws py::type_error   they are no numbers
    /// @throws InputError       the shape is another; a number is not finite
    Rows(py::handle value, const char* name, std::size_t width);

    std::size_t count() const { return count_; }
    /// Returns whether it is of shape (width,), which goes with any number of rows.
    bool is_single() const { return single_; }
    /// Returns the components of a row; of a single one for any i.
    const double* row(std::size_t i) const { return numbers_.data() + (single_ ? 0 : i * width_); }
    Vec4 vec4(std::size_t i) const { return Eigen::Map<const Vec4, Eigen::Unaligned>(row(i)); }
    Bivector bivector(std::size_t i) const;
    Rotor rotor(std::size_t i) const;

    /// Returns all rows as vectors, and so on.
    std::vector<Vec4> vec4s() const;
    std::vector<Bivector> bivectors() const;
    std::vector<Rotor> rotors() const;

  private:
    Numbers numbers_;
    std::size_t width_, count_;
    bool single_;
};

/// Returns those of some rows that are several and with which the others go; null where all are
/// single, or null.
/// @throws InputError   two have different numbers of rows
const Rows* several_of(std::initializer_list<const Rows*> rows);

/// Makes an array of rows by calling write(i, row) for each, where the arguments were `rows`.
/// @param shape   of a row, for example {4, 4}
/// @throws InputError   two arguments have different numbers of rows
class RowResult {
  public:
    RowResult(std::initializer_list<const Rows*> rows, std::vector<py::ssize_t> shape);

    std::size_t count() const { return count_; }
    double* row(std::size_t i) { return numbers_.mutable_data() + i * width_; }
    void set(std::size_t i, const Vec4& vector);
    void set(std::size_t i, const Bivector& bivector);
    void set(std::size_t i, const Rotor& rotor);
    /// Returns the array. Of single rows without a shape it is a float.
    py::object array() const;

  private:
    Numbers numbers_;
    std::size_t width_ = 1, count_ = 1;
};

/// Returns a copy as an array of shape (4,), (6,) or (8,).
py::array array_of(const Vec4& vector);
py::array array_of(const Bivector& bivector);
py::array array_of(const Rotor& rotor);

/// Returns an array of shape (n, width) that shows memory which `owner` keeps. It cannot be
/// written.
template <class T>
py::array view_of(std::span<const T> rows, const py::object& owner) {
    static_assert(sizeof(T) % sizeof(double) == 0);
    constexpr auto width = static_cast<py::ssize_t>(sizeof(T) / sizeof(double));
    py::array_t<double> view({static_cast<py::ssize_t>(rows.size()), width},
                             reinterpret_cast<const double*>(rows.data()), owner);
    view.attr("flags").attr("writeable") = false;
    return view;
}
/// Returns an object that keeps memory alive, the base of such arrays.
py::object owner_of(std::shared_ptr<const void> memory);

}  // namespace tesserae::python
