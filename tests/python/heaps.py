# SPDX-License-Identifier: Apache-2.0
"""Heaps that several tests look at."""

import numpy as np

import tesserae as ts


def heap(threads=0, count=60, **settings):
    """Shapes of several kinds that fall onto a floor."""
    random = np.random.default_rng(1)
    world = ts.World(threads=threads, **settings)
    world.add(ts.Hyperplane([0, 1, 0, 0]))
    shapes = [ts.Hypersphere(0.3), ts.Hyperbox([0.5, 0.4, 0.6, 0.5]), ts.Hypercapsule(0.2, 0.5),
              ts.Duocylinder([0.3, 0.25])]
    for i in range(count):
        world.add(shapes[i % 4], position=random.uniform(-1, 1, 4) + [0, 3, 0, 0], mass=1 + i % 3)
    return world
