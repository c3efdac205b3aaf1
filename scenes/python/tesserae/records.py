# SPDX-License-Identifier: Apache-2.0
"""What worlds, scenes and films tell, as named tuples."""

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Optional, Tuple

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from . import Shape

__all__ = ["BodyState", "BodyType", "ContactChanges", "FilmResult", "JointReading", "Nearest", "RayHit",
           "SimulationResult", "StepReport"]

Array = npt.NDArray[np.float64]
Ids = npt.NDArray[np.uint32]


class BodyState(NamedTuple):
    """Where a body is and how it moves, in the world."""

    position: Array  #: centre (4,) [m]
    rotor: Array  #: body to world (8,)
    velocity: Array  #: (4,) [m/s]
    angular_velocity: Array  #: (6,) [rad/s]


class BodyType(NamedTuple):
    """What a body was added with."""

    shape: "Shape"
    mass: float  #: [kg], infinite for a hyperplane
    friction: float
    rolling_friction: float  #: [m]
    restitution: float
    fixed_position: bool
    fixed_rotation: bool
    gravity_scale: float
    damping: float  #: [1/s]
    group: int
    collides_with: Optional[Tuple[int, ...]]  #: groups; None: all


class StepReport(NamedTuple):
    """What a step found in the middle of its last sub-step."""

    contacts: int  #: number of contact points that touch or overlap
    penetration: float  #: deepest overlap [m]
    mean_penetration: float  #: of these points [m]
    residual: float  #: what the solver still changed in its last sweep [m/s]
    asleep: int  #: number of bodies asleep
    sweeps: int  #: the most that a solve of a group of touching bodies took


class ContactChanges(NamedTuple):
    """Pairs of bodies that began and ended to touch, each a row (m, 2), ascending."""

    began: Ids
    ended: Ids


class JointReading(NamedTuple):
    """What a joint is and did in the last step."""

    a: int
    b: Optional[int]  #: None: the world
    broken: bool  #: its load was too much: it holds nothing any more
    impulse: float  #: between the bodies [N s]
    angular_impulse: float  #: about the anchor [N m s]
    error: float  #: how far held points are apart [m]
    angular_error: float  #: by what angle held directions are off [rad]
    position: float  #: of its one free coordinate [m, rad]; NaN if it has not one


class RayHit(NamedTuple):
    """Where a ray meets a body."""

    body: int
    distance: float  #: from the origin [m]
    point: Array  #: (4,) [m]
    normal: Array  #: unit, outward (4,)


class Nearest(NamedTuple):
    """The body that is nearest to a point."""

    body: int
    distance: float  #: of its surface [m], negative inside
    point: Array  #: on its surface (4,) [m]
    normal: Array  #: unit, outward (4,)


class SimulationResult(NamedTuple):
    """What Scene.simulate() did."""

    first_step: int  #: where the work began: 0, or what was stored before
    last_step: int  #: of the file
    stored: int  #: number of stored steps in the file
    kept: bool  #: nothing was missing
    seconds: float  #: that it took


class FilmResult(NamedTuple):
    """What Scene.film() did."""

    rendered: int
    copied: int  #: from the frame before, which looks the same
    kept: int  #: were there
    seconds: float
    frames: Path  #: the folder of the images
    preview: Path  #: of the last frame
