// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "core/error.hpp"
#include "scenes/python/arrays.hpp"
#include "scenes/python/topics.hpp"

namespace tesserae::python {
namespace {

/// Rotors and matrices this far from rotations are mistakes, usual 1e-6; nearer ones have drifted.
constexpr double kDrift = 1e-6;

/// Rotors that are given.
class UnitRotors : public Rows {
  public:
    /// @throws InputError   as Rows; one is no unit rotor
    UnitRotors(py::handle value, const char* name) : Rows(value, name, 8) {
        for (std::size_t i = 0; i < count(); ++i) {
            const Rotor r = rotor(i);
            const double square = r.s * r.s + dot(r.b, r.b) + r.p * r.p;
            const double cross = 2 * r.s * r.p - wedge(r.b, r.b);
            if (std::abs(square - 1) > kDrift || std::abs(cross) > kDrift)
                throw InputError(fmt::format(
                    "{}[{}]: is no rotation: s^2 + |B|^2 + p^2 = {} and 2 s p - B ^ B = {}; "
                    "expected 1 and 0",
                    name, i, square, cross));
        }
    }
};

/// Matrices of shape (4, 4) or (n, 4, 4).
std::vector<Mat4> rotations_of(py::handle value, bool& single) {
    const Numbers numbers = numbers_of(value, "matrix");
    const py::ssize_t rank = numbers.ndim();
    if (rank < 2 || rank > 3 || numbers.shape(rank - 1) != 4 || numbers.shape(rank - 2) != 4)
        throw InputError(
            fmt::format("matrix: expected an array of shape (4, 4) or (n, 4, 4), got {}",
                        py::str(numbers.attr("shape")).cast<std::string>()));
    single = rank == 2;
    std::vector<Mat4> matrices(single ? 1 : static_cast<std::size_t>(numbers.shape(0)));
    for (std::size_t i = 0; i < matrices.size(); ++i) {
        using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
        matrices[i] = Eigen::Map<const RowMajor, Eigen::Unaligned>(numbers.data() + 16 * i);
        const Mat4& m = matrices[i];
        // Written so that what is not a number fails too.
        const bool is_orthogonal =
            (m.transpose() * m - Mat4::Identity()).cwiseAbs().maxCoeff() <= kDrift;
        if (!is_orthogonal || m.determinant() < 0)
            throw InputError(fmt::format(
                "matrix[{}]: is no rotation: expected orthogonal columns of length 1 and a "
                "determinant of 1",
                i));
    }
    return matrices;
}

py::object from_planes(double xy, double xz, double xw, double yz, double yw, double zw) {
    const Bivector angles{xy, xz, xw, yz, yw, zw};
    if (!std::isfinite(dot(angles, angles)))
        throw InputError("from_planes: an angle is not finite");
    return array_of(exp(-0.5 * angles));
}

py::object from_matrix(const py::object& matrix) {
    bool single = false;
    const std::vector<Mat4> matrices = rotations_of(matrix, single);
    if (single) return array_of(to_rotor(matrices[0]));
    Numbers rotors({static_cast<py::ssize_t>(matrices.size()), py::ssize_t{8}});
    for (std::size_t i = 0; i < matrices.size(); ++i) {
        const Rotor rotor = to_rotor(matrices[i]);
        std::memcpy(rotors.mutable_data() + 8 * i, &rotor, sizeof rotor);
    }
    return rotors;
}

py::object to_matrix_of(const py::object& rotor) {
    const UnitRotors r(rotor, "rotor");
    RowResult result({&r}, {4, 4});
    for (std::size_t i = 0; i < result.count(); ++i) {
        const Mat4 matrix = to_matrix(r.rotor(i)).transpose();  // numpy's rows are Eigen's columns
        std::copy_n(matrix.data(), 16, result.row(i));
    }
    return result.array();
}

py::object exp_of(const py::object& bivector) {
    const Rows b(bivector, "bivector", 6);
    RowResult result({&b}, {8});
    for (std::size_t i = 0; i < result.count(); ++i) result.set(i, exp(b.bivector(i)));
    return result.array();
}
py::object log_of(const py::object& rotor) {
    const UnitRotors r(rotor, "rotor");
    RowResult result({&r}, {6});
    for (std::size_t i = 0; i < result.count(); ++i) result.set(i, log(r.rotor(i)));
    return result.array();
}
py::object inverse(const py::object& rotor) {
    const UnitRotors r(rotor, "rotor");
    RowResult result({&r}, {8});
    for (std::size_t i = 0; i < result.count(); ++i) result.set(i, reverse(r.rotor(i)));
    return result.array();
}
py::object compose(const py::object& second, const py::object& first) {
    const UnitRotors a(second, "second"), b(first, "first");
    RowResult result({&a, &b}, {8});
    for (std::size_t i = 0; i < result.count(); ++i) result.set(i, a.rotor(i) * b.rotor(i));
    return result.array();
}
py::object rotated(const py::object& rotor, const py::object& points) {
    const UnitRotors r(rotor, "rotor");
    const Rows p(points, "points", 4);
    RowResult result({&r, &p}, {4});
    Mat4 turn = Mat4::Identity();
    for (std::size_t i = 0; i < result.count(); ++i) {
        if (i == 0 || !r.is_single()) turn = to_matrix(r.rotor(i));
        result.set(i, turn * p.vec4(i));
    }
    return result.array();
}
py::object interpolated(const py::object& a, const py::object& b, double t) {
    const UnitRotors from(a, "a"), to(b, "b");
    if (!std::isfinite(t)) throw InputError(fmt::format("t = {}: expected a finite number", t));
    RowResult result({&from, &to}, {8});
    for (std::size_t i = 0; i < result.count(); ++i)
        result.set(i, interpolate(from.rotor(i), to.rotor(i), t));
    return result.array();
}

}  // namespace

void add_rotors(py::module_& module) {
    py::module_ rotor = module.def_submodule("_rotor");
    using py::arg;
    rotor.def(
        "identity", [] { return array_of(Rotor{}); }, R"(identity()
--

Returns the rotor that turns nothing, (8,).

>>> ts.rotor.identity()
array([1., 0., 0., 0., 0., 0., 0., 0.])
)");
    rotor.def("from_planes", &from_planes, py::kw_only(), arg("xy") = 0.0, arg("xz") = 0.0,
              arg("xw") = 0.0, arg("yz") = 0.0, arg("yw") = 0.0, arg("zw") = 0.0,
              R"(from_planes(*, xy=0.0, xz=0.0, xw=0.0, yz=0.0, yw=0.0, zw=0.0)
--

Returns the rotor (8,) that turns by these angles [rad] at once: exp(-B/2), where B has them as
components. A positive xy turns x toward y. Turns one after the other are composed instead.

>>> quarter = ts.rotor.from_planes(xy=np.pi / 2)
>>> ts.rotor.rotate(quarter, [1, 0, 0, 0]).round(12) + 0.0
array([0., 1., 0., 0.])
)");
    rotor.def("from_matrix", &from_matrix, arg("matrix"), R"(from_matrix(matrix)
--

Returns the rotors (8,) or (n, 8) of orthogonal matrices (4, 4) or (n, 4, 4) of determinant 1. The
sign of each is chosen: R and -R turn alike.

>>> ts.rotor.from_matrix(np.eye(4))
array([1., 0., 0., 0., 0., 0., 0., 0.])
)");
    rotor.def("to_matrix", &to_matrix_of, arg("rotor"), R"(to_matrix(rotor)
--

Returns the orthogonal matrices (4, 4) or (n, 4, 4) of rotors (8,) or (n, 8): column i is where axis
i is turned to.

>>> ts.rotor.to_matrix(ts.rotor.from_planes(zw=np.pi)).round(12) + 0.0
array([[ 1.,  0.,  0.,  0.],
       [ 0.,  1.,  0.,  0.],
       [ 0.,  0., -1.,  0.],
       [ 0.,  0.,  0., -1.]])
)");
    rotor.def("exp", &exp_of, arg("bivector"), R"(exp(bivector)
--

Returns the rotors (8,) or (n, 8) that are e^B of bivectors (6,) or (n, 6). A turn at the angular
velocity omega [rad/s] for a time t [s] is exp(-t/2 omega).

>>> ts.rotor.exp([0, 0, 0, 0, 0, -0.5]).round(6) + 0.0
array([ 0.877583,  0.      ,  0.      ,  0.      ,  0.      ,  0.      ,
       -0.479426,  0.      ])
)");
    rotor.def("log", &log_of, arg("rotor"), R"(log(rotor)
--

Returns the bivectors B, (6,) or (n, 6), with exp(B) = R of rotors (8,) or (n, 8): the least ones.
The angles [rad] of the turn are -2 B.

>>> -2 * ts.rotor.log(ts.rotor.from_planes(xw=0.25, yz=1)) + 0.0
array([0.  , 0.  , 0.25, 1.  , 0.  , 0.  ])
)");
    rotor.def("inverse", &inverse, arg("rotor"), R"(inverse(rotor)
--

Returns the rotors that turn back, of the same shape.

>>> r = ts.rotor.from_planes(xy=0.5)
>>> bool(np.allclose(ts.rotor.inverse(r), ts.rotor.from_planes(xy=-0.5)))
True
)");
    rotor.def("compose", &compose, arg("second"), arg("first"), R"(compose(second, first)
--

Returns the rotors, (8,) or (n, 8), that turn by `first` and then by `second`: the products second
first. One of shape (8,) goes with any number of others.

>>> half = ts.rotor.from_planes(xy=0.5)
>>> bool(np.allclose(ts.rotor.compose(half, half), ts.rotor.from_planes(xy=1)))
True
)");
    rotor.def("rotate", &rotated, arg("rotor"), arg("points"), R"(rotate(rotor, points)
--

Returns the points (4,) or (n, 4) turned about the origin, R v R~ each. One rotor (8,) turns all
points, n rotors one each, or all of them one point.

>>> ts.rotor.rotate(ts.rotor.from_planes(xw=np.pi / 2), [[1, 2, 3, 0], [0, 0, 0, 1]]).round(12) + 0.0
array([[ 0.,  2.,  3.,  1.],
       [-1.,  0.,  0.,  0.]])
)");
    rotor.def("interpolate", &interpolated, arg("a"), arg("b"), arg("t"), R"(interpolate(a, b, t)
--

Returns the rotors, (8,) or (n, 8), at t on the shortest way from a (t = 0) to b (t = 1), gone at
constant angular velocity. Others call it slerp.

>>> a, b = ts.rotor.identity(), ts.rotor.from_planes(zw=1)
>>> bool(np.allclose(ts.rotor.interpolate(a, b, 0.25), ts.rotor.from_planes(zw=0.25)))
True
)");
}

}  // namespace tesserae::python
