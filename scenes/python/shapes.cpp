// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "core/error.hpp"
#include "core/world/check.hpp"
#include "scenes/python/arrays.hpp"
#include "scenes/python/attributes.hpp"
#include "scenes/python/shape.hpp"
#include "scenes/python/topics.hpp"

namespace tesserae::python {
namespace {

using py::arg;

template <class S>
OneShape<S> made(S shape) {
    OneShape<S> made{{std::move(shape)}};
    make_complete(made.shape);
    return made;
}

// ---- parameters to Python --------------------------------------------------------------------

py::object value_of(double value) { return py::float_(value); }
py::object value_of(const Vec4& value) {
    return py::make_tuple(value[0], value[1], value[2], value[3]);
}
py::object value_of(const Vec2& value) { return py::make_tuple(value[0], value[1]); }
py::object value_of(const std::array<std::int64_t, 2>& value) {
    return py::make_tuple(value[0], value[1]);
}
py::object value_of(const std::vector<Vec4>& points) {
    py::tuple all(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) all[i] = value_of(points[i]);
    return all;
}
py::object value_of(RegularPolychoron which) {
    return py::str(kRegularNames[static_cast<std::size_t>(which) - 1]);
}

/// Returns the parameters in use, by name.
py::dict parameters_of(const AnyShape& self) {
    py::dict all;
    std::visit(
        [&]<class S>(const S& shape) {
            S::parameters(shape, [&](const Key& key, const auto& value, Rule) {
                all[key.name] = value_of(value);
            });
        },
        self.shape);
    return all;
}

/// Returns one of the parameters; None where the shape does not use it.
auto parameter(const char* name) {
    return [name](const AnyShape& self) -> py::object {
        const py::dict all = parameters_of(self);
        return all.contains(name) ? py::object(all[name]) : py::none();
    };
}

std::string text_of(const py::object& self) {
    std::string text;
    for (const auto& [name, value] : parameters_of(self.cast<const AnyShape&>()))
        text += fmt::format("{}{}={}", text.empty() ? "" : ", ", name.cast<std::string>(),
                            py::repr(value).cast<std::string>());
    return fmt::format("{}({})", py::type::of(self).attr("__name__").cast<std::string>(), text);
}

/// What has moved through a pickle is of length 1 but for decimals.
void require_unit(const Hyperplane& plane) {
    check(plane);
    if (std::abs(plane.normal.norm() - 1) > 1e-12)
        throw InputError("hyperplane: normal: expected a direction of length 1");
}

RegularPolychoron regular_of(const std::string& name) {
    for (std::size_t i = 0; i < std::size(kRegularNames); ++i)
        if (name == kRegularNames[i]) return static_cast<RegularPolychoron>(i + 1);
    throw InputError(
        fmt::format("polychoron: regular = \"{}\": expected one of 5-cell, 8-cell, "
                    "16-cell, 24-cell, 120-cell, 600-cell",
                    name));
}

// ---- pickles ---------------------------------------------------------------------------------

/// Reads parameters as value_of() writes them.
void read(const py::handle& value, double& number) { number = real_of(value, "parameter"); }
void read(const py::handle& value, Vec4& vector) { vector = vec4_of(value, "parameter"); }
void read(const py::handle& value, Vec2& vector) { vector = vec2_of(value, "parameter"); }
void read(const py::handle& value, std::array<std::int64_t, 2>& numbers) {
    numbers = value.cast<std::array<std::int64_t, 2>>();
}
void read(const py::handle& value, std::vector<Vec4>& points) {
    points = Rows(value, "parameter", 4).vec4s();
}
void read(const py::handle& value, RegularPolychoron& which) {
    which = regular_of(value.cast<std::string>());
}

/// The state of a pickle: parameters and attributes.
py::tuple pickle_state(const py::object& self) {
    return py::make_tuple(parameters_of(self.cast<const AnyShape&>()), attributes_of(self));
}
template <class S>
std::pair<OneShape<S>, py::dict> of_state(const py::tuple& state) {
    const py::dict parameters = state[0];
    S shape;
    if constexpr (std::is_same_v<S, Polychoron>)
        if (parameters.contains("vertices")) shape.regular = RegularPolychoron::kNone;
    S::parameters(shape,
                  [&](const Key& key, auto& value, Rule) { read(parameters[key.name], value); });
    OneShape<S> made{{shape}};
    // Its normal is unit already, and would be rounded once more.
    if constexpr (std::is_same_v<S, Hyperplane>)
        require_unit(shape);
    else
        make_complete(made.shape);
    return {made, py::dict(state[1])};
}

// ---- functions of points ---------------------------------------------------------------------

py::object distances(const AnyShape& self, const py::object& points) {
    const Rows p(points, "points", 4);
    RowResult result({&p}, {});
    std::visit(
        [&](const auto& shape) {
            for (std::size_t i = 0; i < result.count(); ++i)
                *result.row(i) = signed_distance(shape, p.vec4(i));
        },
        self.shape);
    return result.array();
}
py::object normals(const AnyShape& self, const py::object& points) {
    const Rows p(points, "points", 4);
    RowResult result({&p}, {4});
    std::visit(
        [&](const auto& shape) {
            for (std::size_t i = 0; i < result.count(); ++i)
                result.set(i, normal(shape, p.vec4(i)));
        },
        self.shape);
    return result.array();
}
void require_bounded(const AnyShape& self, const char* what) {
    if (!is_bounded(self.shape))
        throw InputError(fmt::format("a {} has no {}: expected a shape that ends somewhere",
                                     name_of(self.shape), what));
}
py::object supports(const AnyShape& self, const py::object& directions) {
    require_bounded(self, "support");
    const Rows d(directions, "directions", 4);
    RowResult result({&d}, {4});
    std::visit(
        [&](const auto& shape) {
            for (std::size_t i = 0; i < result.count(); ++i)
                result.set(i, support(shape, d.vec4(i)));
        },
        self.shape);
    return result.array();
}

// ---- whole shapes ----------------------------------------------------------------------------

double volume_of(const AnyShape& self) {
    return std::visit([](const auto& shape) { return volume(shape); }, self.shape);
}
Vec4 moments_of(const AnyShape& self, double mass) {
    require_bounded(self, "moments");
    if (!(mass > 0) || !std::isfinite(mass))
        throw InputError(fmt::format("mass = {}: expected a number > 0", mass));
    return std::visit([&](const auto& shape) { return second_moments(shape, mass); }, self.shape);
}
py::array inertia_of(const AnyShape& self, double mass) {
    const Vec4 j = moments_of(self, mass);
    return array_of(
        Bivector{j[0] + j[1], j[0] + j[2], j[0] + j[3], j[1] + j[2], j[1] + j[3], j[2] + j[3]});
}
py::array principal_axes_in(const AnyShape& self) {
    const Rotor* axes = principal_axes_of(self.shape);
    return array_of(axes == nullptr ? Rotor{} : *axes);
}

// ---- classes ---------------------------------------------------------------------------------

template <class S>
auto add_class(py::module_& module, const char* name, const char* doc) {
    return py::class_<OneShape<S>, AnyShape>(module, name, doc)
        .def(py::pickle(&pickle_state, &of_state<S>));
}

void add_base(py::module_& module) {
    py::class_<AnyShape>(module, "Shape", R"(A shape, in its own frame [m]. It does not change.

What it is made of is checked as in scene files. Equal shapes compare equal.)")
        .def("distance", &distances, arg("points"), R"(distance(self, points)
--

Returns the signed distances [m] of points from the surface, negative inside: an array (n,) for
points (n, 4), a float for one point (4,).

>>> ts.Hypersphere(1).distance([[3, 0, 0, 0], [0, 0, 0, 0.5]])
array([ 2. , -0.5])
)")
        .def("normal_at", &normals, arg("points"), R"(normal_at(self, points)
--

Returns the unit gradients of the distance at points, of their shape (4,) or (n, 4): on the surface
the outward normals. Where there is none, a fixed direction.

>>> ts.Hyperbox([1, 1, 1, 1]).normal_at([0, 0, 0, -2]) + 0.0
array([ 0.,  0.,  0., -1.])
)")
        .def("support", &supports, arg("directions"), R"(support(self, directions)
--

Returns points of the shape [m] that are farthest along directions of any length, of their shape
(4,) or (n, 4).

>>> ts.Hyperbox([2, 4, 6, 8]).support([1, -1, 1, 1])
array([ 1., -2.,  3.,  4.])
)")
        .def_property_readonly("volume", &volume_of,
                               "The 4D content [m^4]; infinite for a hyperplane.")
        .def_property_readonly(
            "bounding_radius", [](const AnyShape& self) { return bounding_radius(self.shape); },
            "The radius of the ball about the centre that holds the shape [m].")
        .def(
            "second_moments",
            [](const AnyShape& self, double mass) { return array_of(moments_of(self, mass)); },
            arg("mass") = 1.0, R"(second_moments(self, mass=1.0)
--

Returns the integrals (4,) of density x_i^2 [kg m^2] along the principal axes, for a mass [kg].

>>> ts.Hyperbox([1, 2, 3, 4]).second_moments(12)
array([ 1.,  4.,  9., 16.])
)")
        .def("inertia", &inertia_of, arg("mass") = 1.0, R"(inertia(self, mass=1.0)
--

Returns the moments of inertia (6,) [kg m^2] in the planes xy, xz, xw, yz, yw, zw of the principal
axes, for a mass [kg].

>>> ts.Hyperbox([1, 2, 3, 4]).inertia(12)
array([ 5., 10., 17., 13., 20., 25.])
)")
        .def_property_readonly("principal_axes", &principal_axes_in,
                               "The rotor (8,) that turns the principal axes to the shape's own.")
        .def("__eq__",
             [](const AnyShape& self, const py::object& other) {
                 return py::isinstance<AnyShape>(other) &&
                        self.shape == other.cast<const AnyShape&>().shape;
             })
        .def("__hash__",
             [](const AnyShape& self) {
                 const py::dict all = parameters_of(self);
                 return py::hash(
                     py::make_tuple(name_of(self.shape), py::tuple(all.attr("values")())));
             })
        .def("__repr__", &text_of)
        .def("__getstate__", &pickle_state)
        .def("__reduce__", &reduced);
}

void add_boxes_and_balls(py::module_& module) {
    add_class<Hypersphere>(module, "Hypersphere", "All points within a radius [m] of the centre.")
        .def(py::init([](double radius) { return made(Hypersphere{radius}); }), arg("radius"),
             "__init__(self, radius)\n--\n\n")
        .def_property_readonly("radius", parameter("radius"), "The radius [m].");
    add_class<Hypercapsule>(module, "Hypercapsule",
                            "All points within a radius [m] of a "
                            "segment along y of this length [m].")
        .def(py::init([](double radius, double height) {
                 return made(Hypercapsule{radius, height});
             }),
             arg("radius"), arg("height"), "__init__(self, radius, height)\n--\n\n")
        .def_property_readonly("radius", parameter("radius"), "The radius [m].")
        .def_property_readonly("height", parameter("height"), "Length of the segment [m].");
    add_class<Hyperbox>(module, "Hyperbox", "A box with these four full sides [m].")
        .def(py::init([](const py::object& size) { return made(Hyperbox{vec4_of(size, "size")}); }),
             arg("size"), "__init__(self, size)\n--\n\n")
        .def_property_readonly("size", parameter("size"), "The four full sides [m].");
    add_class<Hyperplane>(module, "Hyperplane",
                          "Solid where normal . p < offset [m], "
                          "with the normal made unit. It never moves.")
        .def(py::init([](const py::object& normal, double offset) {
                 return made(Hyperplane{vec4_of(normal, "normal"), offset});
             }),
             arg("normal"), arg("offset") = 0.0, "__init__(self, normal, offset=0.0)\n--\n\n")
        .def_property_readonly("normal", parameter("normal"), "Of length 1.")
        .def_property_readonly("offset", parameter("offset"),
                               "Where the plane is along its normal [m].");
}

void add_hulls(py::module_& module) {
    add_class<Polychoron>(
        module, "Polychoron",
        "The convex hull of points (n, 4) "
        "[m], about its centre of mass; or the regular polychoron of a name such as \"24-cell\" "
        "whose vertices are at a radius [m].")
        .def(py::init([](const py::object& vertices, const std::optional<std::string>& regular,
                         std::optional<double> radius) {
                 if (vertices.is_none() != regular.has_value() ||
                     regular.has_value() != radius.has_value())
                     throw InputError("polychoron: expected either vertices or regular and radius");
                 Polychoron shape;
                 if (regular) {
                     shape.regular = regular_of(*regular);
                     shape.radius = *radius;
                 } else {
                     shape.regular = RegularPolychoron::kNone;
                     shape.vertices = Rows(vertices, "vertices", 4).vec4s();
                 }
                 return made(std::move(shape));
             }),
             arg("vertices") = py::none(), py::kw_only(), arg("regular") = py::none(),
             arg("radius") = py::none(),
             "__init__(self, vertices=None, *, regular=None, radius=None)\n--\n\n")
        .def_property_readonly("vertices", parameter("vertices"),
                               "The points that were given [m]; None for a regular one.")
        .def_property_readonly("regular", parameter("regular"),
                               "The name of a regular one, or None.")
        .def_property_readonly("radius", parameter("radius"), "Of a regular one [m], or None.");
    add_class<Duoprism>(module, "Duoprism",
                        "A regular polygon in x and y times one in z and "
                        "w, with these two numbers of sides and circumradii [m].")
        .def(py::init([](const std::array<std::int64_t, 2>& polygons, const py::object& radii) {
                 Duoprism shape;
                 shape.polygons = polygons;
                 shape.radii = vec2_of(radii, "radii");
                 return made(std::move(shape));
             }),
             arg("polygons"), arg("radii"), "__init__(self, polygons, radii)\n--\n\n")
        .def_property_readonly("polygons", parameter("polygons"), "The two numbers of sides.")
        .def_property_readonly("radii", parameter("radii"), "The two circumradii [m].");
}

void add_products(py::module_& module) {
    add_class<Spherinder>(module, "Spherinder",
                          "A ball in x, z and w [m] times a segment "
                          "along y of this length [m].")
        .def(py::init([](double radius, double height) {
                 Spherinder shape;
                 shape.radius = radius;
                 shape.height = height;
                 return made(shape);
             }),
             arg("radius"), arg("height"), "__init__(self, radius, height)\n--\n\n")
        .def_property_readonly("radius", parameter("radius"), "The radius [m].")
        .def_property_readonly("height", parameter("height"), "The length along y [m].");
    add_class<Cubinder>(module, "Cubinder",
                        "A disc in x and y of this radius [m] times a "
                        "rectangle with these two full sides along z and w [m].")
        .def(py::init([](double radius, const py::object& size) {
                 Cubinder shape;
                 shape.radius = radius;
                 shape.size = vec2_of(size, "size");
                 return made(shape);
             }),
             arg("radius"), arg("size"), "__init__(self, radius, size)\n--\n\n")
        .def_property_readonly("radius", parameter("radius"), "The radius [m].")
        .def_property_readonly("size", parameter("size"), "The full sides along z and w [m].");
    add_class<Duocylinder>(module, "Duocylinder",
                           "A disc in x and y times a disc in z and w, of these "
                           "two radii [m].")
        .def(py::init([](const py::object& radii) {
                 Duocylinder shape;
                 shape.radii = vec2_of(radii, "radii");
                 return made(shape);
             }),
             arg("radii"), "__init__(self, radii)\n--\n\n")
        .def_property_readonly("radii", parameter("radii"), "The two radii [m].");
}

}  // namespace

py::object object_of(const Shape& shape) {
    return std::visit(
        [&]<class S>(const S& one) -> py::object { return py::cast(OneShape<S>{{one}}); }, shape);
}

void add_shapes(py::module_& module) {
    add_base(module);
    add_boxes_and_balls(module);
    add_hulls(module);
    add_products(module);
}

}  // namespace tesserae::python
