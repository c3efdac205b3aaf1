// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "core/error.hpp"
#include "scenes/python/record.hpp"
#include "scenes/python/shape.hpp"
#include "scenes/python/world.hpp"

// What worlds tell: contacts, sums and queries.
namespace tesserae::python {
namespace {

using py::arg;

/// A row of World.contacts(): see ContactReading.
struct ContactRow {
    BodyId a, b;
    std::array<double, 4> point, normal;
    double separation, impulse;
    std::array<double, 4> friction;
};

std::array<double, 4> numbers_of(const Vec4& v) { return {v[0], v[1], v[2], v[3]}; }

py::array contacts_of(const SharedWorld& self) {
    const auto contacts = self.get().contacts();
    py::array_t<ContactRow> rows(static_cast<py::ssize_t>(contacts.size()));
    ContactRow* row = rows.mutable_data();
    for (const ContactReading& contact : contacts)
        *row++ = {contact.a,
                  contact.b,
                  numbers_of(contact.point),
                  numbers_of(contact.normal),
                  contact.separation,
                  contact.impulse,
                  numbers_of(contact.friction)};
    return rows;
}

py::array pairs_of(const std::vector<TouchingPair>& pairs) {
    py::array_t<BodyId> rows({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}});
    BodyId* number = rows.mutable_data();
    for (const TouchingPair& pair : pairs) {
        *number++ = pair.a;
        *number++ = pair.b;
    }
    return rows;
}
py::object changes_of(SharedWorld& self) {
    const ContactChanges changes = self.get().contact_changes();
    return record("ContactChanges", pairs_of(changes.began), pairs_of(changes.ended));
}

py::object ray(const SharedWorld& self, const py::object& origin, const py::object& direction,
               std::optional<double> reach) {
    const auto hit = self.get().ray(vec4_of(origin, "origin"), vec4_of(direction, "direction"),
                                    reach.value_or(kNoLimit));
    if (!hit) return py::none();
    return record("RayHit", hit->body, hit->distance, array_of(hit->point), array_of(hit->normal));
}
py::object nearest(const SharedWorld& self, const py::object& point, std::optional<double> reach) {
    const auto found = self.get().nearest(vec4_of(point, "point"), reach.value_or(kNoLimit));
    if (!found) return py::none();
    return record("Nearest", found->body, found->distance, array_of(found->point),
                  array_of(found->normal));
}
py::array overlapping(const SharedWorld& self, const AnyShape& shape, const py::object& position,
                      const py::object& rotor) {
    const auto ids = self.get().overlapping(shape.shape, vec4_of(position, "position"),
                                            rotor.is_none() ? Rotor{} : rotor_of(rotor, "rotor"));
    return py::array_t<BodyId>(static_cast<py::ssize_t>(ids.size()), ids.data());
}

void add_sums(WorldClass& world) {
    world
        .def_property_readonly(
            "kinetic_energy", [](const SharedWorld& self) { return self.get().kinetic_energy(); },
            "The sum of all m v^2 / 2 + omega . L / 2 [J].")
        .def_property_readonly(
            "potential_energy",
            [](const SharedWorld& self) { return self.get().potential_energy(); },
            "The sum of all -m g . x [J].")
        .def_property_readonly(
            "momentum", [](const SharedWorld& self) { return array_of(self.get().momentum()); },
            "The sum (4,) of all m v [kg m/s].")
        .def_property_readonly(
            "angular_momentum",
            [](const SharedWorld& self) { return array_of(self.get().angular_momentum()); },
            "The angular momentum (6,) about the origin [kg m^2/s].");
}

void add_queries(WorldClass& world) {
    world
        .def("ray", &ray, arg("origin"), arg("direction"), arg("reach") = py::none(),
             R"(ray(self, origin, direction, reach=None)
--

Returns the first body that a ray meets, a RayHit, or None. The direction (4,) has any length but 0;
reach is the greatest distance [m], None: any. A ray that starts in a body meets it at once.

>>> world = ts.World()
>>> ball = world.add(ts.Hypersphere(1))
>>> world.ray([0, 0, 0, -5], [0, 0, 0, 1]).distance
4.0
)")
        .def("overlapping", &overlapping, arg("shape"), arg("position"), arg("rotor") = py::none(),
             R"(overlapping(self, shape, position, rotor=None)
--

Returns the numbers (m,) of the bodies that touch or overlap a shape at a place.

>>> world = ts.World()
>>> ball = world.add(ts.Hypersphere(1))
>>> world.overlapping(ts.Hyperbox([1, 1, 1, 1]), [0, 0, 0, 1.4]).tolist()
[0]
)")
        .def("nearest", &nearest, arg("point"), arg("reach") = py::none(),
             R"(nearest(self, point, reach=None)
--

Returns the body whose surface is nearest to a point (4,) [m], a Nearest, or None. Inside a body the
distance is negative, and the deepest counts; reach is the greatest distance [m], None: any.

>>> world = ts.World()
>>> ball = world.add(ts.Hypersphere(1))
>>> world.nearest([0, 3, 0, 0]).point
array([0., 1., 0., 0.])
)");
}

}  // namespace

void add_readings(WorldClass& world) {
    PYBIND11_NUMPY_DTYPE(ContactRow, a, b, point, normal, separation, impulse, friction);
    world
        .def("contacts", &contacts_of, R"(contacts(self)
--

Returns the contact points of the last step as a structured array (m,), ascending by bodies, with
the fields a, b (the bodies, a < b), point (4) [m], normal (4) from a to b, separation [m], negative
in overlap, impulse [N s] on b along the normal, and friction (4) [N s], its impulse on b at rest.

>>> world = ts.World()
>>> floor = world.add(ts.Hyperplane([0, 1, 0, 0]))
>>> ball = world.add(ts.Hypersphere(0.5), mass=3, position=[0, 0.5, 0, 0])
>>> report = world.step()
>>> world.contacts()["impulse"] * 240  # a force [N]
array([30.])
)")
        .def("contact_changes", &changes_of, R"(contact_changes(self)
--

Returns which pairs of bodies touch since the last call, and which do so no more, a ContactChanges.
Call it after every step to miss none.

>>> world = ts.World()
>>> floor = world.add(ts.Hyperplane([0, 1, 0, 0]))
>>> ball = world.add(ts.Hypersphere(0.5), position=[0, 0.5, 0, 0])
>>> report = world.step()
>>> world.contact_changes().began.tolist()
[[0, 1]]
)");
    add_sums(world);
    add_queries(world);
}

}  // namespace tesserae::python
