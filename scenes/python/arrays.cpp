// SPDX-License-Identifier: Apache-2.0
#include "scenes/python/arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.hpp"

namespace tesserae::python {
namespace {

static_assert(sizeof(Rotor) == 8 * sizeof(double) && sizeof(Bivector) == 6 * sizeof(double));

std::string shape_text(const py::array& array) {
    return py::str(array.attr("shape")).cast<std::string>();
}

/// Copies numbers of shape (size,).
void copy_numbers(py::handle value, const char* name, double* to, py::ssize_t size) {
    const Numbers numbers = numbers_of(value, name);
    if (numbers.ndim() != 1 || numbers.shape(0) != size)
        throw InputError(fmt::format("{}: expected {} numbers, got an array of shape {}", name,
                                     size, shape_text(numbers)));
    std::copy_n(numbers.data(), size, to);
}

Bivector bivector_at(const double* n) { return {n[0], n[1], n[2], n[3], n[4], n[5]}; }
Rotor rotor_at(const double* n) { return {n[0], bivector_at(n + 1), n[7]}; }

template <class T>
py::array array_of_components(const T& value) {
    Numbers array(static_cast<py::ssize_t>(sizeof value / sizeof(double)));
    std::memcpy(array.mutable_data(), &value, sizeof value);
    return array;
}

}  // namespace

Numbers numbers_of(py::handle value, const char* name) {
    const auto array = py::array::ensure(value);
    if (!array || std::string("biuf").find(array.dtype().kind()) == std::string::npos) {
        PyErr_Clear();
        throw py::type_error(
            fmt::format("{}: expected numbers, got {}", name, py::repr(value).cast<std::string>()));
    }
    return Numbers::ensure(array);
}

double real_of(py::handle value, const std::string& name) {
    const double number = PyFloat_AsDouble(value.ptr());
    if (PyErr_Occurred() == nullptr) return number;
    PyErr_Clear();
    throw py::type_error(
        fmt::format("{}: expected a number, got {}", name, py::repr(value).cast<std::string>()));
}
std::int64_t integer_of(py::handle value, const std::string& name) {
    const py::object number = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    const std::int64_t integer = number ? PyLong_AsLongLong(number.ptr()) : 0;
    if (PyErr_Occurred() == nullptr) return integer;
    PyErr_Clear();
    throw py::type_error(
        fmt::format("{}: expected an integer, got {}", name, py::repr(value).cast<std::string>()));
}
Vec4 vec4_of(py::handle value, const char* name) {
    Vec4 vector;
    copy_numbers(value, name, vector.data(), 4);
    return vector;
}
Vec2 vec2_of(py::handle value, const char* name) {
    Vec2 vector;
    copy_numbers(value, name, vector.data(), 2);
    return vector;
}
Bivector bivector_of(py::handle value, const char* name) {
    double numbers[6];
    copy_numbers(value, name, numbers, 6);
    return bivector_at(numbers);
}
Rotor rotor_of(py::handle value, const char* name) {
    double numbers[8];
    copy_numbers(value, name, numbers, 8);
    return rotor_at(numbers);
}

Rows::Rows(py::handle value, const char* name, std::size_t width)
    : numbers_(numbers_of(value, name)), width_(width) {
    const auto size = static_cast<py::ssize_t>(width);
    single_ = numbers_.ndim() == 1;
    if (numbers_.ndim() < 1 || numbers_.ndim() > 2 || numbers_.shape(numbers_.ndim() - 1) != size)
        throw InputError(fmt::format("{}: expected an array of shape ({},) or (n, {}), got {}",
                                     name, width, width, shape_text(numbers_)));
    count_ = single_ ? 1 : static_cast<std::size_t>(numbers_.shape(0));
    for (std::size_t i = 0; i < count_ * width; ++i)
        if (const double number = numbers_.data()[i]; !std::isfinite(number))
            throw InputError(fmt::format("{}[{}][{}] = {}: expected a finite number", name,
                                         i / width, i % width, number));
}

Bivector Rows::bivector(std::size_t i) const { return bivector_at(row(i)); }
Rotor Rows::rotor(std::size_t i) const { return rotor_at(row(i)); }

std::vector<Vec4> Rows::vec4s() const {
    std::vector<Vec4> all(count_);
    for (std::size_t i = 0; i < count_; ++i) all[i] = vec4(i);
    return all;
}
std::vector<Bivector> Rows::bivectors() const {
    std::vector<Bivector> all(count_);
    for (std::size_t i = 0; i < count_; ++i) all[i] = bivector(i);
    return all;
}
std::vector<Rotor> Rows::rotors() const {
    std::vector<Rotor> all(count_);
    for (std::size_t i = 0; i < count_; ++i) all[i] = rotor(i);
    return all;
}

const Rows* several_of(std::initializer_list<const Rows*> rows) {
    const Rows* several = nullptr;
    for (const Rows* one : rows) {
        if (one == nullptr || one->is_single()) continue;
        if (several != nullptr && several->count() != one->count())
            throw InputError(
                fmt::format("the arguments have {} and {} rows: expected as many, or "
                            "one of a single dimension",
                            several->count(), one->count()));
        several = one;
    }
    return several;
}

RowResult::RowResult(std::initializer_list<const Rows*> rows, std::vector<py::ssize_t> shape) {
    for (const py::ssize_t size : shape) width_ *= static_cast<std::size_t>(size);
    if (const Rows* several = several_of(rows); several != nullptr) {
        count_ = several->count();
        shape.insert(shape.begin(), static_cast<py::ssize_t>(count_));
    }
    numbers_ = Numbers(shape);
}

void RowResult::set(std::size_t i, const Vec4& vector) { std::copy_n(vector.data(), 4, row(i)); }
void RowResult::set(std::size_t i, const Bivector& bivector) {
    std::memcpy(row(i), &bivector, sizeof bivector);
}
void RowResult::set(std::size_t i, const Rotor& rotor) {
    std::memcpy(row(i), &rotor, sizeof rotor);
}
py::object RowResult::array() const {
    if (numbers_.ndim() == 0) return py::float_(*numbers_.data());
    return numbers_;
}

py::array array_of(const Vec4& vector) { return array_of_components(vector); }
py::array array_of(const Bivector& bivector) { return array_of_components(bivector); }
py::array array_of(const Rotor& rotor) { return array_of_components(rotor); }

py::object owner_of(std::shared_ptr<const void> memory) {
    using Pointer = std::shared_ptr<const void>;
    return py::capsule(new Pointer(std::move(memory)),
                       [](void* pointer) { delete static_cast<Pointer*>(pointer); });
}

}  // namespace tesserae::python
