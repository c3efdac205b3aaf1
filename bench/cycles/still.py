# SPDX-License-Identifier: Apache-2.0
"""The still that both renderers draw: balls on a plane under a soft sun and an even sky.

Ours are hyperspheres of which the slice w = 0 cuts balls of `radius`; Cycles gets these balls. An
open surface shows the same light in both: a sun of irradiance E is reflected as
3 albedo E cos/(4 pi) in four dimensions and albedo E cos/pi in three, so ours has 4/3 of the
irradiance.

A ray that is scattered in 4D leaves the slice, and beside it there is nothing but sky: so our paths
are shorter. That is made up for in the still `among`, where hyperspheres beside the slice, seen by
no view ray, lie as dense to both sides as those in it.
"""

import collections
import functools
import math
import random

BALLS = 300
HALF_SIDE = 3.2  # of the square of floor that they lie over [m]
HEIGHT = 1.6  # of the box that they fill
RADII = (0.12, 0.42)
OTHERS = 4000  # beside the slice, as many a metre of w as in it
ALBEDOS = ((0.80, 0.25, 0.15), (0.20, 0.55, 0.60), (0.75, 0.65, 0.30))
FLOOR = (0.5, 0.5, 0.5)
POSITION, LOOK_AT = (1.8, 6.2, -8.2), (0.0, 0.5, 0.2)  # every view ray meets the floor
FIELD_OF_VIEW = 40  # vertical [degrees]
SUN_DIRECTION, SUN_HALF_ANGLE = (0.75, -1.0, 0.35), 3  # [degrees]
SUN_IRRADIANCE = 2.0  # in three dimensions
SKY = (0.25, 0.32, 0.45)
BOUNCES = 3  # after direct light

Ball = collections.namedtuple("Ball", "x y z w radius hyper_radius material")


@functools.cache
def balls():
    """None touch, neither in the slice nor in 4D; each hypersphere's centre is up to 0.8 of its
    radius off the slice."""
    numbers = random.Random(1)
    placed = []
    while len(placed) < BALLS:
        hyper = numbers.uniform(*RADII)
        w = hyper * numbers.uniform(-0.8, 0.8)
        ball = Ball(numbers.uniform(-HALF_SIDE, HALF_SIDE), numbers.uniform(hyper, HEIGHT),
                    numbers.uniform(-HALF_SIDE, HALF_SIDE), w, math.sqrt(hyper**2 - w**2), hyper,
                    len(placed) % len(ALBEDOS))
        if all(math.dist(ball[:3], b[:3]) > ball.hyper_radius + b.hyper_radius for b in placed):
            placed.append(ball)
    return placed


def others():
    """The hyperspheres beside the slice. They may overlap each other: only rays meet them."""
    numbers = random.Random(2)
    placed = []
    while len(placed) < OTHERS:
        hyper = numbers.uniform(*RADII)
        w = numbers.uniform(-HALF_SIDE, HALF_SIDE)
        if abs(w) > hyper:
            placed.append(Ball(numbers.uniform(-HALF_SIDE, HALF_SIDE),
                               numbers.uniform(hyper, HEIGHT),
                               numbers.uniform(-HALF_SIDE, HALF_SIDE), w, 0, hyper,
                               len(placed) % len(ALBEDOS)))
    return placed


def toml(is_turned, intersector, is_among):
    """Our scene file. A turned camera draws the picture upside down, with other random numbers,
    since these are a function of the pixel."""
    def vector(v, *more):
        return "[" + ", ".join(f"{x:.17g}" for x in (*v, *more)) + "]"

    bodies = balls() + (others() if is_among else [])
    parts = [
        f"[camera]\nposition = {vector(POSITION, 0)}\nlook_at = {vector(LOOK_AT, 0)}\n"
        f"up = [0, {-1 if is_turned else 1}, 0, 0]\nfield_of_view = {FIELD_OF_VIEW}",
        f'[render]\nintegrator = "path"\nbounces = {BOUNCES}\nchannels = ["color"]\n'
        f'intersector = "{intersector}"',
        f'[[light]]\ntype = "sun"\ndirection = {vector(SUN_DIRECTION, 0)}\n'
        f"strength = {SUN_IRRADIANCE * 4 / 3:.17g}\nangle = {SUN_HALF_ANGLE}",
        f'[[light]]\ntype = "sky"\ncolor = {vector(SKY)}',
        *(f'[[material]]\nname = "m{i}"\nalbedo = {vector(a)}'
          for i, a in enumerate((*ALBEDOS, FLOOR))),
        f'[[body]]\nshape = "hyperplane"\nnormal = [0, 1, 0, 0]\nmaterial = "m{len(ALBEDOS)}"',
        *(f'[[body]]\nshape = "hypersphere"\nradius = {b.hyper_radius:.17g}\n'
          f'position = {vector(b[:4])}\nmaterial = "m{b.material}"' for b in bodies)]
    return "\n\n".join(parts) + "\n"
