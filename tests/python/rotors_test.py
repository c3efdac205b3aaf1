# SPDX-License-Identifier: Apache-2.0
"""Rotors against matrices: the exponential of a matrix by its series."""

import unittest

import numpy as np

import tesserae as ts
from tesserae import rotor

PLANES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]


def generator(angles):
    """The antisymmetric matrix of a turn: a positive angle in xy turns x toward y."""
    matrix = np.zeros((4, 4))
    for (i, j), angle in zip(PLANES, angles):
        matrix[j, i], matrix[i, j] = angle, -angle
    return matrix


def matrix_exp(matrix):
    """By its series, of a 1/1024 of it, squared ten times."""
    part, term, total = matrix / 1024, np.eye(4), np.eye(4)
    for k in range(1, 16):
        term = term @ part / k
        total = total + term
    for _ in range(10):
        total = total @ total
    return total


def random_angles(count, seed=1, most=np.pi):
    return np.random.default_rng(seed).uniform(-most, most, (count, 6)) / 2


class Rotors(unittest.TestCase):
    def close(self, a, b, tolerance=1e-12):  # rounding of ten squarings
        np.testing.assert_allclose(a, b, rtol=0, atol=tolerance)

    def test_exp_is_that_of_matrices(self):
        angles = random_angles(200)
        angles[0] = [0.7, 0, 0, 0, 0, 0.7]  # isoclinic: both planes turn alike
        angles[1] = 0
        for one, matrix in zip(angles, rotor.to_matrix(rotor.exp(-angles / 2))):
            self.close(matrix, matrix_exp(generator(one)))

    def test_planes_have_their_angles(self):
        for name, (i, j) in zip(["xy", "xz", "xw", "yz", "yw", "zw"], PLANES):
            turned = rotor.rotate(rotor.from_planes(**{name: 0.3}), np.eye(4)[i])
            expected = np.cos(0.3) * np.eye(4)[i] + np.sin(0.3) * np.eye(4)[j]
            self.close(turned, expected, 1e-15)

    def test_compose_turns_by_the_second_argument_first(self):
        a, b = rotor.exp(random_angles(50, 2)), rotor.exp(random_angles(50, 3))
        self.close(rotor.to_matrix(rotor.compose(a, b)), rotor.to_matrix(a) @ rotor.to_matrix(b))

    def test_one_goes_with_many(self):
        many, one = rotor.exp(random_angles(5, 4)), rotor.from_planes(xy=0.4, zw=1)
        for i, product in enumerate(rotor.compose(many, one)):
            self.close(product, rotor.compose(many[i], one), 0)
        points = np.random.default_rng(5).normal(size=(5, 4))
        self.assertEqual(rotor.rotate(one, points).shape, (5, 4))
        self.assertEqual(rotor.rotate(many, points[0]).shape, (5, 4))
        self.close(rotor.rotate(many, points)[3], rotor.to_matrix(many[3]) @ points[3], 1e-14)
        self.assertEqual(rotor.log(many[:0]).shape, (0, 6))

    def test_log_and_inverse_undo(self):
        r = rotor.exp(random_angles(100, 6))
        self.close(rotor.exp(rotor.log(r)), r)
        self.close(rotor.compose(r, rotor.inverse(r)), np.tile(rotor.identity(), (100, 1)))
        small = random_angles(100, 7, most=0.5)
        self.close(rotor.log(rotor.exp(small)), small)

    def test_matrices_come_back(self):
        r = rotor.exp(random_angles(100, 8))
        self.close(rotor.to_matrix(rotor.from_matrix(rotor.to_matrix(r))), rotor.to_matrix(r))
        self.assertEqual(rotor.from_matrix(np.eye(4)).shape, (8,))

    def test_interpolation_turns_at_constant_speed(self):
        a, angles = rotor.exp(random_angles(30, 9)), random_angles(30, 10, most=1)
        b = rotor.compose(rotor.exp(-angles / 2), a)
        for t in (0, 0.3, 1):
            expected = rotor.compose(rotor.exp(-t * angles / 2), a)
            self.close(rotor.to_matrix(rotor.interpolate(a, b, t)), rotor.to_matrix(expected))
            # The other sign is the same rotation: the way stays short.
            self.close(rotor.to_matrix(rotor.interpolate(a, -b, t)), rotor.to_matrix(expected))

    def test_bad_input_is_told(self):
        cases = [
            (lambda: rotor.log([1, 1, 0, 0, 0, 0, 0, 0]), ts.InputError, "is no rotation"),
            (lambda: rotor.log([1, 0, 0]), ts.InputError, r"expected an array of shape \(8,\) or \(n, 8\), got \(3,\)"),
            (lambda: rotor.exp([0, 0, np.nan, 0, 0, 0]), ts.InputError, r"bivector\[0\]\[2\] = nan"),
            (lambda: rotor.exp("turn"), TypeError, "expected numbers"),
            (lambda: rotor.from_matrix(np.diag([1, 1, 1, -1])), ts.InputError, "determinant"),
            (lambda: rotor.from_matrix(np.ones((4, 4))), ts.InputError, "orthogonal"),
            (lambda: rotor.from_matrix(np.full((4, 4), np.nan)), ts.InputError, "orthogonal"),
            (lambda: rotor.from_planes(xy=np.inf), ts.InputError, "finite"),
            (lambda: rotor.rotate(np.tile(rotor.identity(), (2, 1)), np.ones((3, 4))), ts.InputError, "2 and 3 rows"),
        ]
        for call, error, text in cases:
            with self.assertRaisesRegex(error, text):
                call()


if __name__ == "__main__":
    unittest.main()
