# SPDX-License-Identifier: Apache-2.0
"""What holds of every class and function of the module: what is wrong ends in one line, never in a crash."""

import copy
import inspect
import pickle
import unittest

import numpy as np

import tesserae as ts

#: Classes that are made in C++.
BOUND = [value for name in dir(ts) for value in [getattr(ts, name)]
         if isinstance(value, type) and type(value).__name__ == "pybind11_type"]
#: An argument of a name, so that a call gets as far as the object.
ARGUMENTS = {
    "a": 0, "body": 0, "data": b"", "direction": [1, 0, 0, 0], "directions": [1, 0, 0, 0], "folder": "/none", "force": [0] * 4,
    "frame": 0, "impulse": [0] * 4, "joint": 0, "layer": "color", "memo": {}, "name": "ball", "origin": [0] * 4,
    "path": "/none/file", "point": [0] * 4, "points": [0] * 4, "position": [0] * 4, "shape": ts.Hypersphere(1),
    "text": "", "torque": [0] * 6, "type": "point", "world": ts.World(),
}


def empty(kind):
    """An object that was never initialised."""
    return kind.__new__(kind)


def arguments_of(function):
    """Arguments for all parameters without a default but self."""
    parameters = list(inspect.signature(function).parameters.values())
    return [ARGUMENTS[p.name] for p in parameters[1:]
            if p.default is inspect.Parameter.empty and p.kind is not inspect.Parameter.VAR_KEYWORD]


def error_of(call):
    """(class, text) of what a call raises."""
    try:
        call()
    except Exception as error:
        return type(error), str(error)
    return None, ""


class Empty(unittest.TestCase):
    def test_the_classes_are_found(self):
        self.assertEqual({kind.__name__ for kind in BOUND}, {
            "Cubinder", "Duocylinder", "Duoprism", "Hyperbox", "Hypercapsule", "Hyperplane", "Hypersphere", "Picture",
            "Polychoron", "Scene", "Shape", "Spherinder", "Trajectory", "World"})

    def test_every_call_of_what_was_not_initialised_is_refused(self):
        calls = 0
        for kind in BOUND:
            for base in kind.__mro__:
                for name, member in vars(base).items():
                    if base not in BOUND or isinstance(member, staticmethod) or name in ("__init__", "__setstate__"):
                        continue
                    if isinstance(member, property):
                        tries = [lambda m=member: m.fget(empty(kind))]
                        if member.fset is not None:
                            tries.append(lambda m=member: m.fset(empty(kind), np.zeros((0, 4))))
                    elif name in ("__eq__", "__contains__", "__getitem__"):
                        tries = [lambda m=member: m.__get__(empty(kind))(0)]
                    elif name in ("__deepcopy__",):
                        tries = [lambda m=member: m.__get__(empty(kind))({})]
                    elif callable(member) and member.__doc__ is not None and name not in ("__new__",):
                        function = getattr(base, name)
                        try:
                            given = arguments_of(function)
                        except ValueError:  # a special method without a signature
                            given = []
                        tries = [lambda n=name, g=given: getattr(empty(kind), n)(*g)]
                    else:
                        continue
                    for call in tries:
                        self.assertEqual(error_of(call)[0], TypeError, f"{kind.__name__}.{name}")
                        calls += 1
        self.assertGreater(calls, 200)

    def test_what_python_does_by_itself_is_refused_too(self):
        for kind in BOUND:
            for call in (copy.copy, copy.deepcopy, pickle.dumps):
                self.assertEqual(error_of(lambda: call(empty(kind)))[0], TypeError, f"{call.__name__} of {kind.__name__}")
            kept = [empty(kind) for _ in range(100)]
            del kept
        for kind in (ts.World, ts.Hypersphere, ts.Shape):
            self.assertEqual(error_of(lambda: repr(empty(kind)))[0], TypeError)
        self.assertEqual(error_of(lambda: len(empty(ts.World)))[0], TypeError)
        self.assertEqual(error_of(lambda: hash(empty(ts.Hypersphere)))[0], TypeError)
        self.assertEqual(error_of(lambda: ts.Hypersphere(1) == empty(ts.Hypersphere))[0], TypeError)

    def test_as_an_argument_it_is_refused(self):
        scene = ts.Scene.parse('body = [{ shape = "hypersphere", radius = 1 }]')
        for kind in BOUND:
            if issubclass(kind, ts.Shape):
                self.assertEqual(error_of(lambda: ts.World().add(empty(kind)))[0], TypeError, kind)
                self.assertEqual(error_of(lambda: ts.World().overlapping(empty(kind), [0] * 4))[0], TypeError, kind)
        self.assertEqual(error_of(lambda: scene.render(empty(ts.World)))[0], TypeError)
        self.assertEqual(error_of(lambda: ts.World().view(empty(ts.Scene)))[0], TypeError)

    def test_it_can_be_initialised_later(self):
        ball = empty(ts.Hypersphere)
        ball.__init__(2)
        self.assertEqual(ball.radius, 2)
        world = empty(ts.World)
        self.assertEqual(error_of(lambda: world.__init__(gravity="down"))[0], TypeError)
        self.assertEqual(error_of(lambda: world.step())[0], TypeError)
        world.__init__(gravity=[0, 0, 0, 0])
        self.assertEqual(world.step().contacts, 0)

    def test_a_class_of_python_that_forgets_to_is_told(self):
        class Forgetful(ts.World):
            def __init__(self):
                pass

        self.assertRaisesRegex(TypeError, "__init__", Forgetful)


class Arguments(unittest.TestCase):
    def test_a_wrong_name_is_told_with_the_nearest_ones(self):
        world = ts.World()
        ball = ts.Hypersphere(1)
        cases = [
            (lambda: ts.World(gravty=[0] * 4), "World(): there is no argument 'gravty'; did you mean 'gravity'?"),
            (lambda: ts.World(step_per_second=1), "World(): there is no argument 'step_per_second'; did you mean 'steps_per_second'?"),
            (lambda: world.add(ball, fixed_positon=True, mass=2),
             "World.add(): there is no argument 'fixed_positon'; did you mean 'fixed_position' or 'fixed_rotation'?"),
            (lambda: world.add_many(ball, positions=[[0] * 4]),
             "World.add_many(): there is no argument 'positions'; did you mean 'position' or 'fixed_position'?"),
            (lambda: world.step(number=4), "World.step(): there is no argument 'number'; expected dt, steps"),
            (lambda: ts.Hypersphere(r=1), "Hypersphere(): there is no argument 'r'; expected radius"),
            (lambda: ts.rotor.from_planes(yx=1), "rotor.from_planes(): there is no argument 'yx'; expected xy, xz, xw, yz, yw, zw"),
            (lambda: ts.Scene.read("a", set=[]), "Scene.read(): there is no argument 'set'; did you mean 'sets'?"),
            (lambda: world.save(path="x"), "World.save(): there is no argument 'path'; expected none by name"),
        ]
        for call, text in cases:
            self.assertEqual(error_of(call), (TypeError, text))

    def test_what_is_missing_or_too_much_is_told(self):
        world = ts.World()
        cases = [
            (lambda: ts.Hypercapsule(1), "Hypercapsule(): missing a required argument: 'height'"),
            (lambda: world.remove(), "World.remove(): missing a required argument: 'body'"),
            (lambda: world.remove(1, 2), "World.remove(): too many positional arguments"),
            (lambda: world.add(ts.Hypersphere(1), 3), "World.add(): too many positional arguments"),
            (lambda: world.step(0.1, dt=0.1), "World.step(): multiple values for argument 'dt'"),
        ]
        for call, text in cases:
            self.assertEqual(error_of(call), (TypeError, text))

    def test_a_wrong_type_is_told_by_its_argument(self):
        world = ts.World()
        ball = ts.Hypersphere(1)
        scene = ts.Scene.parse('body = [{ shape = "hypersphere", radius = 1 }]')
        cases = [
            (lambda: ts.Hypersphere("big"), "Hypersphere(): radius = 'big': expected a number"),
            (lambda: world.add("ball"), "World.add(): shape = 'ball': expected a Shape"),
            (lambda: world.add(ball, mass="2 kg"), "World.add(): mass = '2 kg': expected a number"),
            (lambda: world.add(ball, group=1.5), "World.add(): group = 1.5: expected an integer"),
            (lambda: world.step(steps=2.5), "World.step(): steps = 2.5: expected an integer"),
            (lambda: world.step("fast"), "World.step(): dt = 'fast': expected a number, or None"),
            (lambda: ts.World(seed=-1), "World(): seed = -1: expected an integer >= 0"),
            (lambda: ts.World(integrator=3), "World(): integrator = 3: expected a string"),
            (lambda: ts.World(iterations=2**40), "World(): iterations = 1099511627776: expected an integer"),
            (lambda: setattr(world, "threads", "all"), "World.threads = 'all': expected an integer"),
            (lambda: world.join(3, 0), "World.join(): type = 3: expected a string"),
            (lambda: scene.body(3), "Scene.body(): name = 3: expected a string"),
            (lambda: scene.render(5), "Scene.render(): world = 5: expected a World"),
            (lambda: ts.Trajectory(3), "Trajectory(): path = 3: expected a path"),
            (lambda: world.view(5), "World.view(): scene = 5: expected a Scene, or None"),
            (lambda: world.view(None, height="high"), "World.view(): height = 'high': expected an integer"),
            (lambda: scene.film("x", frames=5), "Scene.film(): frames = 5: expected a list of integers"),
            (lambda: scene.film("x", frames=["a"]), "Scene.film(): frames = ['a']: expected a list of integers"),
            (lambda: ts.Duoprism([3], [1, 1]), "Duoprism(): polygons = [3]: expected 2 integers"),
            (lambda: ts.Duoprism([3, 4.5], [1, 1]), "Duoprism(): polygons = [3, 4.5]: expected 2 integers"),
            (lambda: world.add(ball, collides_with=["a"]), "collides_with: expected an integer, got 'a'"),
            (lambda: world.add(ball, collides_with=3), "collides_with: expected a list of groups, got 3"),
            (lambda: ts.Scene.parse("", 5), 'sets: expected a dict, or a list of "KEY=VALUE"'),
            (lambda: ts.Scene.parse("", [3]), 'sets: expected a dict, or a list of "KEY=VALUE"'),
            (lambda: scene.render(world)[3], "Picture.__getitem__(): layer = 3: expected a string"),
        ]
        for call, text in cases:
            self.assertEqual(error_of(call), (TypeError, text))

    def test_classes_that_functions_make_say_so(self):
        for kind in (ts.Shape, ts.Scene, ts.Picture):
            raised, text = error_of(kind)
            self.assertEqual((raised, text.split(";")[0]), (TypeError, f"{kind.__name__}(): cannot be called"))

    def test_no_wrong_argument_lists_signatures(self):
        for kind in BOUND:
            for name, member in vars(kind).items():
                function = getattr(kind, name)
                if name.startswith("__") and name != "__init__" or isinstance(member, property) or not callable(function):
                    continue
                called = kind if name == "__init__" else function
                for given in ({"nothing_like_it": 1}, {}):
                    raised, text = error_of(lambda: called(*[object()] * 20, **given))
                    self.assertEqual(raised, TypeError, f"{kind.__name__}.{name}")
                    self.assertNotIn("\n", text, f"{kind.__name__}.{name}")
                    self.assertNotIn("tesserae._tesserae", text, f"{kind.__name__}.{name}")


if __name__ == "__main__":
    unittest.main()
