# SPDX-License-Identifier: Apache-2.0
"""Rotations of four-dimensional space as rotors.

A rotor has the eight components s, xy, xz, xw, yz, yw, zw, p and turns v to R v R~. All functions
take one, of shape (8,), or several, (n, 8), such as World.rotor. Angles are in radians; a positive
angle in xy turns x toward y.
"""

from ._tesserae import _rotor

__all__ = ["compose", "exp", "from_matrix", "from_planes", "identity", "interpolate", "inverse", "log",
           "rotate", "to_matrix"]

compose = _rotor.compose
exp = _rotor.exp
from_matrix = _rotor.from_matrix
from_planes = _rotor.from_planes
identity = _rotor.identity
interpolate = _rotor.interpolate
inverse = _rotor.inverse
log = _rotor.log
rotate = _rotor.rotate
to_matrix = _rotor.to_matrix
