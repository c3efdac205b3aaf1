# SPDX-License-Identifier: Apache-2.0
"""Rigid bodies in four dimensions: worlds, scenes and pictures.

Axes are x, y, z, w; planes always xy, xz, xw, yz, yw, zw. Metres, seconds, kilograms, radians.

>>> import tesserae as ts
>>> world = ts.World()
>>> ball = world.add(ts.Hypersphere(0.5), position=[0, 2, 0, 0.2])
>>> report = world.step(steps=24)
>>> round(world.time, 3)
0.1
"""

from . import _cpu  # first: raises ImportError on a CPU that this was not built for
from . import _tesserae, records
from ._tesserae import (Cubinder, Duocylinder, Duoprism, Hyperbox, Hypercapsule, Hyperplane, Hypersphere,
                        InputError, Picture, Polychoron, RunError, Scene, Shape, Spherinder, Trajectory, World)
from ._tesserae import __version__
from . import rotor
from .page import Page
from .records import (BodyState, BodyType, ContactChanges, FilmResult, JointReading, Nearest, RayHit,
                      SimulationResult, StepReport)

__all__ = [
    "BodyState", "BodyType", "ContactChanges", "Cubinder", "Duocylinder", "Duoprism", "FilmResult", "Hyperbox",
    "Hypercapsule", "Hyperplane", "Hypersphere", "InputError", "JointReading", "Nearest", "Page", "Picture",
    "Polychoron", "RayHit", "RunError", "Scene", "Shape", "SimulationResult", "Spherinder", "StepReport",
    "Trajectory", "World", "rotor",
]

# They are shown, and pickled, under the names by which they are reached.
for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = __name__
del _name
