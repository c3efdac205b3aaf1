# SPDX-License-Identifier: Apache-2.0
"""Shapes against closed forms, numeric gradients and random points."""

import copy
import pickle
import unittest

import numpy as np

import tesserae as ts

PI = np.pi
POINTS = np.random.default_rng(1).normal(size=(26, 4))  # of a hull

# One of each, with its content [m^4].
SHAPES = [
    (ts.Hypersphere(0.7), PI**2 / 2 * 0.7**4),
    (ts.Hypercapsule(0.5, 1.5), PI**2 / 2 * 0.5**4 + 4 / 3 * PI * 0.5**3 * 1.5),
    (ts.Hyperbox([1, 2, 0.5, 0.25]), 0.25),
    (ts.Polychoron(regular="24-cell", radius=1), 2),
    (ts.Duoprism([5, 6], [0.8, 0.6]), 5 / 2 * 0.8**2 * np.sin(2 * PI / 5) * 3 * 0.6**2 * np.sin(PI / 3)),
    (ts.Spherinder(0.6, 1.1), 4 / 3 * PI * 0.6**3 * 1.1),
    (ts.Cubinder(0.6, [1, 0.7]), PI * 0.6**2 * 0.7),
    (ts.Duocylinder([0.6, 0.9]), PI**2 * 0.6**2 * 0.9**2),
]
HULL = ts.Polychoron(POINTS)


class Named:
    """What a class of Python adds to a shape."""

    def __init__(self, name, *arguments):
        super().__init__(*arguments)
        self.name = name


class NamedBall(Named, ts.Hypersphere):
    pass


class NamedPlane(Named, ts.Hyperplane):
    pass


class NamedHull(Named, ts.Polychoron):
    pass


def outside_and_in(*distances):
    """The distance from a product of bodies, from those of its factors."""
    d = np.stack(distances, axis=-1)
    return np.linalg.norm(np.maximum(d, 0), axis=-1) + np.minimum(d.max(axis=-1), 0)


def expected_distance(shape, p):
    norm = np.linalg.norm
    if isinstance(shape, ts.Hypersphere):
        return norm(p, axis=-1) - shape.radius
    if isinstance(shape, ts.Hypercapsule):
        core = np.clip(p[:, 1], -shape.height / 2, shape.height / 2)
        return norm(p - np.outer(core, [0, 1, 0, 0]), axis=-1) - shape.radius
    if isinstance(shape, ts.Hyperbox):
        return outside_and_in(*(abs(p) - np.array(shape.size) / 2).T)
    if isinstance(shape, ts.Spherinder):
        return outside_and_in(norm(p[:, [0, 2, 3]], axis=-1) - shape.radius, abs(p[:, 1]) - shape.height / 2)
    if isinstance(shape, ts.Cubinder):
        return outside_and_in(norm(p[:, :2], axis=-1) - shape.radius, *(abs(p[:, 2:]) - np.array(shape.size) / 2).T)
    if isinstance(shape, ts.Duocylinder):
        return outside_and_in(norm(p[:, :2], axis=-1) - shape.radii[0], norm(p[:, 2:], axis=-1) - shape.radii[1])
    if isinstance(shape, ts.Hyperplane):
        return p @ np.array(shape.normal) - shape.offset
    return None


class Shapes(unittest.TestCase):
    def test_distances_are_those_of_closed_forms(self):
        points = np.random.default_rng(2).normal(size=(500, 4))
        for shape in [s for s, _ in SHAPES] + [ts.Hyperplane([1, 2, 0, -1], 0.3)]:
            expected = expected_distance(shape, points)
            if expected is not None:
                np.testing.assert_allclose(shape.distance(points), expected, atol=1e-13, err_msg=repr(shape))

    def test_a_duoprism_of_squares_is_a_turned_box(self):
        half = np.sqrt(0.5)
        turn = ts.rotor.from_planes(xy=PI / 4, zw=PI / 4)
        points = np.random.default_rng(3).normal(size=(200, 4))
        box = ts.Hyperbox([half * 2, half * 2, half, half])
        np.testing.assert_allclose(
            ts.Duoprism([4, 4], [1, 0.5]).distance(ts.rotor.rotate(turn, points)), box.distance(points), atol=1e-13)

    def test_contents_are_those_of_closed_forms(self):
        for shape, content in SHAPES:
            self.assertAlmostEqual(shape.volume / content, 1, places=12, msg=repr(shape))
        self.assertEqual(ts.Hyperplane([0, 1, 0, 0]).volume, np.inf)

    def test_content_and_moments_are_those_of_random_points(self):
        random = np.random.default_rng(4)
        for shape in [s for s, _ in SHAPES] + [HULL]:
            size = shape.bounding_radius
            points = random.uniform(-size, size, (200_000, 4))
            inside = points[shape.distance(points) < 0]
            part = len(inside) / len(points)
            deviation = (2 * size) ** 4 * np.sqrt(part * (1 - part) / len(points))
            self.assertLess(abs(part * (2 * size) ** 4 - shape.volume), 5 * deviation, repr(shape))
            # Along the principal axes.
            squares = ts.rotor.rotate(ts.rotor.inverse(shape.principal_axes), inside) ** 2
            deviation = squares.std(axis=0) / np.sqrt(len(inside))
            moments = shape.second_moments(3) / 3
            self.assertTrue(np.all(abs(squares.mean(axis=0) - moments) < 5 * deviation), repr(shape))
            j = shape.second_moments(2)
            expected = [j[0] + j[1], j[0] + j[2], j[0] + j[3], j[1] + j[2], j[1] + j[3], j[2] + j[3]]
            np.testing.assert_allclose(shape.inertia(2), expected, rtol=1e-15)

    def test_normals_are_gradients_of_the_distance(self):
        points = np.random.default_rng(5).normal(size=(100, 4)) * 3
        step = 1e-6
        for shape in [s for s, _ in SHAPES] + [HULL, ts.Hyperplane([1, 0, 2, 0], 0.1)]:
            points_outside = points[shape.distance(points) > 0.1]
            gradient = np.stack(
                [(shape.distance(points_outside + e) - shape.distance(points_outside - e)) / (2 * step)
                 for e in np.eye(4) * step], axis=-1)
            # The difference of distances of size 3 is rounded to 1e-15 / step.
            np.testing.assert_allclose(shape.normal_at(points_outside), gradient, atol=1e-5, err_msg=repr(shape))

    def test_supports_are_on_the_surface_and_farthest(self):
        random = np.random.default_rng(6)
        for shape in [s for s, _ in SHAPES] + [HULL]:
            directions = random.normal(size=(50, 4))
            supports = shape.support(directions)
            np.testing.assert_allclose(shape.distance(supports), 0, atol=1e-12)
            points = random.uniform(-1, 1, (20_000, 4)) * shape.bounding_radius
            inside = points[shape.distance(points) < 0]
            reach = (directions * supports).sum(axis=1)
            self.assertTrue(np.all(inside @ directions.T <= reach + 1e-12), repr(shape))
        centred = POINTS - POINTS[0] + HULL.support(POINTS[0] * 0 + [1, 0, 0, 0]) - POINTS[POINTS[:, 0].argmax()] + POINTS[0]
        np.testing.assert_allclose(HULL.support([0, -1, 0, 0]), centred[centred[:, 1].argmin()], atol=1e-12)

    def test_one_point_gives_one_answer(self):
        ball = ts.Hypersphere(1)
        self.assertIs(type(ball.distance([0, 0, 0, 3])), float)
        self.assertEqual(ball.normal_at([0, 0, 0, 3]).shape, (4,))
        self.assertEqual(ball.support([[1, 0, 0, 0]]).shape, (1, 4))
        self.assertEqual(ball.distance(np.zeros((0, 4))).shape, (0,))

    def test_copies_and_pickles_are_equal(self):
        random = np.random.default_rng(7)
        planes = [ts.Hyperplane(normal, 0.1) for normal in random.normal(size=(300, 4))]
        for shape in [s for s, _ in SHAPES] + [HULL] + planes:
            for again in (pickle.loads(pickle.dumps(shape)), copy.deepcopy(shape)):
                self.assertEqual(again, shape)
                self.assertEqual(hash(again), hash(shape))
                self.assertIs(type(again), type(shape))
        self.assertNotEqual(ts.Hypersphere(1), ts.Hypersphere(2))
        self.assertNotEqual(ts.Hypersphere(1), 1)

    def test_what_python_adds_to_a_class_is_kept(self):
        turned = ts.rotor.rotate(ts.rotor.from_planes(xz=0.3, yw=1.1), [0.1, 0.2, 0.7, -0.4])
        for kind, of, arguments in ((NamedBall, ts.Hypersphere, (0.1 + 0.2,)), (NamedPlane, ts.Hyperplane, (turned, 1 / 3)),
                                    (NamedHull, ts.Polychoron, (POINTS,))):
            shape = kind("mine", *arguments)
            for other in (copy.copy(shape), copy.deepcopy(shape), pickle.loads(pickle.dumps(shape))):
                self.assertIs(type(other), kind)
                self.assertEqual((other.name, other), ("mine", of(*arguments)))
            # The same bits also after many copies: a unit normal is not scaled again.
            for _ in range(5):
                shape = pickle.loads(pickle.dumps(shape))
            self.assertEqual(shape, of(*arguments))

    def test_damaged_pickles_are_refused(self):
        for state in (({"radius": -1.0}, {}), ({"radius": "big"}, {}), ({}, {}), (), (3, 4)):
            with self.assertRaises((TypeError, ValueError, KeyError, IndexError)):
                ts.Hypersphere.__new__(ts.Hypersphere).__setstate__(state)

    def test_parameters_are_told(self):
        self.assertEqual(repr(ts.Cubinder(0.5, [1, 2])), "Cubinder(radius=0.5, size=(1.0, 2.0))")
        self.assertEqual(ts.Hyperplane([0, 0, 3, 4], 2).normal, (0, 0, 0.6, 0.8))
        self.assertEqual(ts.Polychoron(regular="5-cell", radius=2).regular, "5-cell")
        self.assertIsNone(HULL.regular)
        self.assertEqual(len(HULL.vertices), 26)

    def test_bad_input_is_told(self):
        cases = [
            (lambda: ts.Hypersphere(-1), "radius = -1"),
            (lambda: ts.Hypersphere(float("nan")), "radius = nan"),
            (lambda: ts.Hyperbox([1, 2, 3]), r"expected 4 numbers, got an array of shape \(3,\)"),
            (lambda: ts.Hyperbox([1, 2, 0, 3]), r"size\[2\] = 0"),
            (lambda: ts.Hyperplane([0, 0, 0, 0]), "not zero"),
            (lambda: ts.Polychoron(regular="7-cell", radius=1), "expected one of 5-cell"),
            (lambda: ts.Polychoron(), "either vertices or regular"),
            (lambda: ts.Polychoron(np.zeros((5, 4))), ""),
            (lambda: ts.Duoprism([2, 3], [1, 1]), "polygons = 2"),
            (lambda: ts.Hypersphere(1).inertia(0), "mass = 0"),
            (lambda: ts.Hyperplane([0, 1, 0, 0]).support([0, 1, 0, 0]), "has no support"),
            (lambda: ts.Hypersphere(1).distance([[1, 2, 3]]), "expected an array of shape"),
            (lambda: ts.Hypersphere(1).distance([1, 2, np.inf, 3]), r"points\[0\]\[2\] = inf"),
        ]
        for call, text in cases:
            with self.assertRaisesRegex(ts.InputError, text):
                call()
        with self.assertRaises(TypeError):
            ts.Hypersphere("big")


if __name__ == "__main__":
    unittest.main()
