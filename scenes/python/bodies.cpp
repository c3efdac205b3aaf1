// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "scenes/python/record.hpp"
#include "scenes/python/shape.hpp"
#include "scenes/python/world.hpp"

// Bodies of worlds: added and removed, read, moved and pushed.
namespace tesserae::python {
namespace {

using py::arg;

/// Returns a bit for each of some groups; None are all.
std::uint64_t groups_of(const py::object& groups) {
    if (groups.is_none()) return kAllGroups;
    if (!py::isinstance<py::iterable>(groups))
        throw py::type_error(fmt::format("collides_with: expected a list of groups, got {}",
                                         py::repr(groups).cast<std::string>()));
    std::uint64_t bits = 0;
    for (const py::handle group : groups) {
        const std::int64_t number = integer_of(group, "collides_with");
        if (number < 0 || number >= kMostGroups)
            throw InputError(fmt::format("collides_with: group {}: expected a number from 0 to {}",
                                         number, kMostGroups - 1));
        bits |= std::uint64_t{1} << number;
    }
    return bits;
}
py::object groups_to(std::uint64_t bits) {
    if (bits == kAllGroups) return py::none();
    py::list groups;
    for (int group = 0; group < kMostGroups; ++group)
        if ((bits >> group & 1) != 0) groups.append(group);
    return py::tuple(groups);
}

/// Changes those parts of a state that are given.
void change(BodyState& state, const py::object& position, const py::object& rotor,
            const py::object& velocity, const py::object& angular_velocity) {
    if (!position.is_none()) state.position = vec4_of(position, "position");
    if (!rotor.is_none()) state.rotor = rotor_of(rotor, "rotor");
    if (!velocity.is_none()) state.velocity = vec4_of(velocity, "velocity");
    if (!angular_velocity.is_none())
        state.angular_velocity = bivector_of(angular_velocity, "angular_velocity");
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The mass that Python is told: what stands still cannot be moved.
double mass_of(const BodyType& type) { return is_bounded(type.shape) ? type.mass : kInfinity; }

BodyType made_type(const AnyShape& shape, double mass, double friction, double rolling_friction,
                   double restitution, bool fixed_position, bool fixed_rotation,
                   double gravity_scale, double damping, int group,
                   const py::object& collides_with) {
    if (group < 0 || group >= kMostGroups)
        throw InputError(
            fmt::format("group = {}: expected a number from 0 to {}", group, kMostGroups - 1));
    BodyType type{.shape = shape.shape,
                  .mass = mass,
                  .friction = friction,
                  .rolling_friction = rolling_friction,
                  .restitution = restitution,
                  .fixed_position = fixed_position,
                  .fixed_rotation = fixed_rotation,
                  .gravity_scale = gravity_scale,
                  .damping = damping,
                  .group = static_cast<std::uint8_t>(group),
                  .collides_with = groups_of(collides_with)};
    if (mass == kInfinity && !is_bounded(type.shape)) type.mass = BodyType().mass;
    return type;
}

BodyId add(SharedWorld& self, const AnyShape& shape, double mass, double friction,
           double rolling_friction, double restitution, bool fixed_position, bool fixed_rotation,
           double gravity_scale, double damping, int group, const py::object& collides_with,
           const py::object& position, const py::object& rotor, const py::object& velocity,
           const py::object& angular_velocity) {
    BodyState state;
    change(state, position, rotor, velocity, angular_velocity);
    return self.get().add(
        made_type(shape, mass, friction, rolling_friction, restitution, fixed_position,
                  fixed_rotation, gravity_scale, damping, group, collides_with),
        state);
}

/// Returns the rows of a part of states, if it is given.
std::optional<Rows> rows_of(const py::object& value, const char* name, std::size_t width) {
    if (value.is_none()) return {};
    return Rows(value, name, width);
}

/// Returns a state for each row of arrays, of which one has several rows.
std::vector<BodyState> states_of_rows(const py::object& position, const py::object& rotor,
                                      const py::object& velocity,
                                      const py::object& angular_velocity) {
    const auto positions = rows_of(position, "position", 4), rotors = rows_of(rotor, "rotor", 8),
               velocities = rows_of(velocity, "velocity", 4),
               turns = rows_of(angular_velocity, "angular_velocity", 6);
    const auto given = [](const std::optional<Rows>& rows) { return rows ? &*rows : nullptr; };
    const Rows* several =
        several_of({given(positions), given(rotors), given(velocities), given(turns)});
    if (several == nullptr)
        throw InputError("expected rows, such as a position of shape (n, 4): a body for each");
    std::vector<BodyState> states(several->count());
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (positions) states[i].position = positions->vec4(i);
        if (rotors) states[i].rotor = rotors->rotor(i);
        if (velocities) states[i].velocity = velocities->vec4(i);
        if (turns) states[i].angular_velocity = turns->bivector(i);
    }
    return states;
}

py::array add_many(SharedWorld& self, const AnyShape& shape, double mass, double friction,
                   double rolling_friction, double restitution, bool fixed_position,
                   bool fixed_rotation, double gravity_scale, double damping, int group,
                   const py::object& collides_with, const py::object& position,
                   const py::object& rotor, const py::object& velocity,
                   const py::object& angular_velocity) {
    const auto ids = self.get().add_many(
        made_type(shape, mass, friction, rolling_friction, restitution, fixed_position,
                  fixed_rotation, gravity_scale, damping, group, collides_with),
        states_of_rows(position, rotor, velocity, angular_velocity));
    return py::array_t<BodyId>(static_cast<py::ssize_t>(ids.size()), ids.data());
}

py::object type_of(const SharedWorld& self, const py::object& body) {
    const BodyType& type = self.get().type(body_of(body, "body"));
    return record("BodyType", object_of(type.shape), mass_of(type), type.friction,
                  type.rolling_friction, type.restitution, type.fixed_position, type.fixed_rotation,
                  type.gravity_scale, type.damping, int{type.group}, groups_to(type.collides_with));
}

py::array masses_of(const SharedWorld& self) {
    const World& of = self.get();
    const auto ids = of.ids();
    py::array_t<double> masses(static_cast<py::ssize_t>(ids.size()));
    double* mass = masses.mutable_data();
    for (const BodyId id : ids) *mass++ = mass_of(of.type(id));
    return masses;
}

py::object state_of(const SharedWorld& self, const py::object& body) {
    const BodyState state = self.get().state(body_of(body, "body"));
    return record("BodyState", array_of(state.position), array_of(state.rotor),
                  array_of(state.velocity), array_of(state.angular_velocity));
}
void set_state(SharedWorld& self, const py::object& body, const py::object& position,
               const py::object& rotor, const py::object& velocity,
               const py::object& angular_velocity) {
    const BodyId id = body_of(body, "body");
    BodyState state = self.get().state(id);
    change(state, position, rotor, velocity, angular_velocity);
    self.get().set_state(id, state);
}

py::array ids_of(const SharedWorld& self) {
    const auto ids = self.get().ids();
    return py::array_t<BodyId>(static_cast<py::ssize_t>(ids.size()), ids.data());
}

bool has(const SharedWorld& self, const py::object& body) {
    const std::optional<BodyId> id = number_in(body);
    return id && self.get().has(*id);
}

/// An array of a world, (n, width), as property: read without a copy, set as a whole.
template <class T>
void add_array(WorldClass& world, const char* name, std::span<const T> BodyArrays::*member,
               void (*set)(World& world, const Rows& rows), const char* doc) {
    const std::size_t width = sizeof(T) / sizeof(double);
    world.def_property(
        name,
        [member](const SharedWorld& self) {
            const BodyArrays arrays = self.get().arrays();
            return view_of(arrays.*member, owner_of(arrays.memory));
        },
        [set, name, width](SharedWorld& self, const py::object& value) {
            const Rows rows(value, name, width);
            const std::size_t bodies = self.get().size();
            if (rows.is_single() || rows.count() != bodies)
                throw InputError(
                    fmt::format("{}: expected an array of shape ({}, {}), a row for "
                                "each body",
                                name, bodies, width));
            set(self.get(), rows);
        },
        doc);
}

void add_arrays(WorldClass& world) {
    add_array<Vec4>(
        world, "position", &BodyArrays::position,
        [](World& of, const Rows& rows) { of.set_arrays(rows.vec4s(), {}, {}, {}); },
        "The centres (n, 4) [m], in the order of ids. The array is the world's memory and cannot "
        "be written;\nset it as a whole. Once bodies are added or removed it keeps the last values "
        "before that.");
    add_array<Rotor>(
        world, "rotor", &BodyArrays::rotor,
        [](World& of, const Rows& rows) { of.set_arrays({}, rows.rotors(), {}, {}); },
        "The rotors (n, 8), body to world, with the components s, xy, xz, xw, yz, yw, zw, p; as "
        "position.");
    add_array<Vec4>(
        world, "velocity", &BodyArrays::velocity,
        [](World& of, const Rows& rows) { of.set_arrays({}, {}, rows.vec4s(), {}); },
        "The velocities (n, 4) [m/s]; as position.");
    add_array<Bivector>(
        world, "angular_velocity", &BodyArrays::angular_velocity,
        [](World& of, const Rows& rows) { of.set_arrays({}, {}, {}, rows.bivectors()); },
        "The angular velocities (n, 6) [rad/s] in the planes xy, xz, xw, yz, yw, zw of the world; "
        "as\nposition.");
}

void add_pushes(WorldClass& world) {
    world
        .def(
            "apply_impulse",
            [](SharedWorld& self, const py::object& body, const py::object& impulse,
               const py::object& point) {
                const BodyId id = body_of(body, "body");
                World& of = self.get();
                of.apply_impulse(id, vec4_of(impulse, "impulse"),
                                 point.is_none() ? of.state(id).position : vec4_of(point, "point"));
            },
            arg("body"), arg("impulse"), arg("point") = py::none(),
            R"(apply_impulse(self, body, impulse, point=None)
--

Changes a body's motion at once by an impulse (4,) [N s] that acts at a point of the world (4,) [m],
or else at its centre.

>>> world = ts.World()
>>> ball = world.add(ts.Hypersphere(0.5), mass=2)
>>> world.apply_impulse(ball, [0, 0, 0, 6])
>>> world.velocity
array([[0., 0., 0., 3.]])
)")
        .def(
            "apply_angular_impulse",
            [](SharedWorld& self, const py::object& body, const py::object& impulse) {
                self.get().apply_angular_impulse(body_of(body, "body"),
                                                 bivector_of(impulse, "impulse"));
            },
            arg("body"), arg("impulse"), R"(apply_angular_impulse(self, body, impulse)
--

Changes at once how a body turns, by an angular impulse (6,) [N m s].
)")
        .def(
            "apply_force",
            [](SharedWorld& self, const py::object& body, const py::object& force,
               const py::object& point) {
                const BodyId id = body_of(body, "body");
                World& of = self.get();
                of.apply_force(id, vec4_of(force, "force"),
                               point.is_none() ? of.state(id).position : vec4_of(point, "point"));
            },
            arg("body"), arg("force"), arg("point") = py::none(),
            R"(apply_force(self, body, force, point=None)
--

Lets a force (4,) [N] act on a body during the next step only, at a point of the world (4,) [m], or
else at its centre. Forces of several calls are added.
)")
        .def(
            "apply_torque",
            [](SharedWorld& self, const py::object& body, const py::object& torque) {
                self.get().apply_torque(body_of(body, "body"), bivector_of(torque, "torque"));
            },
            arg("body"), arg("torque"), R"(apply_torque(self, body, torque)
--

Lets a torque (6,) [N m] act on a body during the next step only.
)");
}

}  // namespace

void add_bodies(WorldClass& world) {
    world.def(
        "add", &add, arg("shape"), py::kw_only(), arg("mass") = 1.0, arg("friction") = 0.5,
        arg("rolling_friction") = 0.0, arg("restitution") = 0.0, arg("fixed_position") = false,
        arg("fixed_rotation") = false, arg("gravity_scale") = 1.0, arg("damping") = 0.0,
        arg("group") = 0, arg("collides_with") = py::none(), arg("position") = py::none(),
        arg("rotor") = py::none(), arg("velocity") = py::none(),
        arg("angular_velocity") = py::none(),
        R"(add(self, shape, *, mass=1.0, friction=0.5, rolling_friction=0.0, restitution=0.0, fixed_position=False, fixed_rotation=False, gravity_scale=1.0, damping=0.0, group=0, collides_with=None, position=None, rotor=None, velocity=None, angular_velocity=None)
--

Adds a body and returns its number. The properties are those of a scene's [[body]]: mass [kg],
rolling_friction [m], damping [1/s]; a group from 0 to 63, and the groups that it collides with,
None: all. It is at position (4,) [m], turned by rotor (8,), and moves at velocity (4,) [m/s] and
angular_velocity (6,) [rad/s]. A hyperplane stands still: it has a friction, restitution and group, and none of the others.

>>> world = ts.World()
>>> world.add(ts.Hyperplane([0, 1, 0, 0]))
0
>>> world.add(ts.Hyperbox([1, 1, 1, 1]), position=[0, 0.5, 0, 0])
1
)");
    world.def(
        "add_many", &add_many, arg("shape"), py::kw_only(), arg("mass") = 1.0,
        arg("friction") = 0.5, arg("rolling_friction") = 0.0, arg("restitution") = 0.0,
        arg("fixed_position") = false, arg("fixed_rotation") = false, arg("gravity_scale") = 1.0,
        arg("damping") = 0.0, arg("group") = 0, arg("collides_with") = py::none(),
        arg("position") = py::none(), arg("rotor") = py::none(), arg("velocity") = py::none(),
        arg("angular_velocity") = py::none(),
        R"(add_many(self, shape, *, mass=1.0, friction=0.5, rolling_friction=0.0, restitution=0.0, fixed_position=False, fixed_rotation=False, gravity_scale=1.0, damping=0.0, group=0, collides_with=None, position=None, rotor=None, velocity=None, angular_velocity=None)
--

Adds bodies that differ in where they are and how they move, and returns their numbers (n,). They
have the properties of add(). There is a body for each row of position (n, 4), rotor (n, 8),
velocity (n, 4) or angular_velocity (n, 6); a single row is that of all.

>>> world = ts.World()
>>> world.add_many(ts.Hypersphere(0.1), mass=2, position=[[0, 1, 0, 0], [0, 2, 0, 0]], velocity=[0, 0, 0, 1])
array([0, 1], dtype=uint32)
>>> world.velocity[1], world.masses
(array([0., 0., 0., 1.]), array([2., 2.]))
)");
    world.def(
        "remove",
        [](SharedWorld& self, const py::object& body) { self.get().remove(body_of(body, "body")); },
        arg("body"), R"(remove(self, body)
--

Removes a body and its joints.

>>> world = ts.World()
>>> world.remove(world.add(ts.Hypersphere(1)))
>>> world.add(ts.Hypersphere(1)), len(world)
(1, 1)
)");
    world.def("__contains__", &has, arg("body"));
    world.def("__len__", [](const SharedWorld& self) { return self.get().size(); });
    world.def("__iter__",
              [](const SharedWorld& self) { return py::iter(ids_of(self).attr("tolist")()); });
    world.def_property_readonly(
        "ids", &ids_of, "The numbers of the bodies (n,), ascending. All arrays have this order.");
    world.def_property_readonly(
        "masses", &masses_of,
        "The masses (n,) [kg], in the order of ids; infinite for a hyperplane. A copy.");
    world.def("type", &type_of, arg("body"), R"(type(self, body)
--

Returns the BodyType that a body was added with.

>>> world = ts.World()
>>> world.type(world.add(ts.Hypersphere(1), mass=3)).mass
3.0
)");
    world.def("state", &state_of, arg("body"), R"(state(self, body)
--

Returns where a body is and how it moves, a BodyState of copies.

>>> world = ts.World()
>>> world.state(world.add(ts.Hypersphere(1), velocity=[1, 0, 0, 0])).velocity
array([1., 0., 0., 0.])
)");
    world.def(
        "set_state", &set_state, arg("body"), py::kw_only(), arg("position") = py::none(),
        arg("rotor") = py::none(), arg("velocity") = py::none(),
        arg("angular_velocity") = py::none(),
        R"(set_state(self, body, *, position=None, rotor=None, velocity=None, angular_velocity=None)
--

Moves a body and gives it another velocity; what is None stays. It wakes the body.

>>> world = ts.World()
>>> ball = world.add(ts.Hypersphere(1))
>>> world.set_state(ball, position=[0, 3, 0, 0])
>>> world.state(ball).position
array([0., 3., 0., 0.])
)");
    world.def(
        "is_asleep",
        [](const SharedWorld& self, const py::object& body) {
            return self.get().is_asleep(body_of(body, "body"));
        },
        arg("body"), R"(is_asleep(self, body)
--

Returns whether a body sleeps, in a world that was made with sleeping=True.
)");
    world.def(
        "wake",
        [](SharedWorld& self, const py::object& body) { self.get().wake(body_of(body, "body")); },
        arg("body"), R"(wake(self, body)
--

Wakes a body, and what sleeps with it.
)");
    add_arrays(world);
    add_pushes(world);
}

}  // namespace tesserae::python
