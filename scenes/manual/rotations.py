#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Rotations by which the regular polychora stand on a vertex, an edge, a face or a cell.

    rotations.py                             prints the table of four-dimensions.md
    rotations.py --check four-dimensions.md  reads the rotations of that page, applies them, and looks
                                             at what is lowest then; exit status 1 if anything is wrong

Needs numpy. Axes are x, y, z, w, and down is -y. A rotation is one bivector in degrees; a positive xy
turns x toward y, as in scene files. Coordinates: Coxeter, Regular Polytopes (1973), sections 8.2 to
8.7. The 8-cell is the tesseract.
"""
import itertools
import re
import sys

import numpy

PLANES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
NAMES = ["xy", "xz", "xw", "yz", "yw", "zw"]
PARTS = ["vertex", "edge", "face", "cell"]
# How many vertices each part has: vertex, edge, face, cell.
VERTICES_OF = {
    "5-cell": (1, 2, 3, 4),
    "8-cell": (1, 2, 4, 8),
    "16-cell": (1, 2, 3, 4),
    "24-cell": (1, 2, 3, 6),
    "120-cell": (1, 2, 5, 20),
    "600-cell": (1, 2, 3, 4),
}
# The dual's vertices point to the cells, and its edges to the faces.
DUAL_OF = {"8-cell": "16-cell", "16-cell": "8-cell", "120-cell": "600-cell", "600-cell": "120-cell"}
DOWN = numpy.array([0.0, -1.0, 0.0, 0.0])


# The polychora, with a circumradius of 1.


def unit(vectors):
    return vectors / numpy.linalg.norm(vectors, axis=-1, keepdims=True)


def with_signs(vector):
    """The vector with every choice of signs, each result once."""
    choices = itertools.product(*[(1, -1) if value else (1,) for value in vector])
    return [numpy.multiply(vector, signs) for signs in choices]


def is_even(order):
    return sum(a > b for a, b in itertools.combinations(order, 2)) % 2 == 0


def vertices_of_600_cell():
    phi = (1 + 5**0.5) / 2
    found = with_signs([0.5] * 4)
    for axis in numpy.eye(4):
        found += with_signs(axis)
    for order in itertools.permutations(range(4)):
        if is_even(order):
            value = numpy.zeros(4)
            value[list(order)] = [phi / 2, 0.5, 0.5 / phi, 0]
            found += with_signs(value)
    return numpy.array(found)


def edges_of(vertices):
    """Pairs of vertices at the least distance."""
    products = vertices @ vertices.T - 2 * numpy.eye(len(vertices))
    return numpy.argwhere(numpy.triu(products > products.max() - 1e-9))


def vertices_of_120_cell():
    """The centres of the 600-cell's cells: four of its vertices of which each two share an edge."""
    corners = vertices_of_600_cell()
    near = numpy.zeros((len(corners), len(corners)), dtype=bool)
    for a, b in edges_of(corners):
        near[a, b] = True
    centres = []
    for a in range(len(corners)):
        for b in numpy.flatnonzero(near[a]):
            for c in numpy.flatnonzero(near[a] & near[b]):
                for d in numpy.flatnonzero(near[a] & near[b] & near[c]):
                    centres.append(corners[[a, b, c, d]].sum(axis=0))
    return unit(numpy.array(centres))


def vertices_of(name):
    if name == "5-cell":
        low = -1 / 5**0.5
        found = [(1, 1, 1, low), (1, -1, -1, low), (-1, 1, -1, low), (-1, -1, 1, low), (0, 0, 0, -4 * low)]
    elif name == "8-cell":
        found = with_signs([1, 1, 1, 1])
    elif name == "16-cell":
        found = [sign for axis in numpy.eye(4) for sign in with_signs(axis)]
    elif name == "24-cell":
        pairs = itertools.combinations(numpy.eye(4), 2)
        found = [sign for a, b in pairs for sign in with_signs(a + b)]
    elif name == "120-cell":
        found = vertices_of_120_cell()
    else:
        found = vertices_of_600_cell()
    return unit(numpy.array(found, dtype=float))


def vertices_of_dual(name):
    if name == "5-cell":
        return -vertices_of(name)
    if name == "24-cell":
        return numpy.concatenate([vertices_of("8-cell"), vertices_of("16-cell")])
    return vertices_of(DUAL_OF[name])


def directions_to(name, part):
    """Unit vectors from the centre to the middle of every vertex, edge, face or cell."""
    vertices = vertices_of(name) if part in ("vertex", "edge") else vertices_of_dual(name)
    if part in ("vertex", "cell"):
        return vertices
    return unit(vertices[edges_of(vertices)].sum(axis=1))


# The rotations.


def turn_down(direction):
    """The bivector [degrees] of the smallest turn that takes a unit vector to -y: of their plane."""
    wedge = numpy.array([direction[i] * DOWN[j] - direction[j] * DOWN[i] for i, j in PLANES])
    sine = numpy.linalg.norm(wedge)
    angle = numpy.arctan2(sine, direction @ DOWN)
    return numpy.degrees(angle) * wedge / sine if sine > 1e-9 else numpy.zeros(6)


def smallest_turn(name, part):
    """Of the parts of one kind the one that the smallest turn takes down. Of equal turns the one in
    the fewest planes, then the one with the largest angles in the order of the planes."""
    turns = [turn_down(d) for d in directions_to(name, part) if d @ DOWN > 0]
    turns = [numpy.where(abs(turn) < 1e-9, 0, turn).round(6) + 0.0 for turn in turns]
    return min(turns, key=lambda turn: (numpy.linalg.norm(turn).round(4), numpy.count_nonzero(turn), *-turn))


def text_of(turn):
    planes = ", ".join(f"{name} = {value:.6f}".rstrip("0").rstrip(".") for name, value in zip(NAMES, turn) if value)
    return f"`rotation = {{ {planes} }}`" if planes else "none: it stands so by itself"


def table():
    """Rows: polychoron, part, rotation, height of the centre over the ground, vertices on the ground."""
    yield "| polychoron | stands on | rotation | height of the centre, in radii | vertices on the ground |"
    yield "|---|---|---|---|---|"
    for name, numbers in VERTICES_OF.items():
        for part, number in zip(PARTS, numbers):
            turn = smallest_turn(name, part)
            height = -(vertices_of(name) @ matrix_of(turn).T)[:, 1].min()
            yield f"| {name} | {part} | {text_of(turn)} | {height:.6f} | {number} |"


# The check, which knows of the page only.


def matrix_of(turn):
    """exp(M) by its series, for the matrix M of a bivector [degrees]: of the 1024th part, squared ten times."""
    matrix = numpy.zeros((4, 4))
    for (i, j), degrees in zip(PLANES, turn):
        matrix[j, i] += numpy.radians(degrees) / 1024
        matrix[i, j] -= numpy.radians(degrees) / 1024
    total, term = numpy.eye(4), numpy.eye(4)
    for order in range(1, 12):
        term = term @ matrix / order
        total = total + term
    for _ in range(10):
        total = total @ total
    return total


def turn_of(text):
    """The bivector [degrees] that a cell of the table writes."""
    turn = numpy.zeros(6)
    for name, value in re.findall(r"(\w\w) = (-?[0-9.]+)", text):
        turn[NAMES.index(name)] = float(value)
    return turn


def faults_of_row(name, part, turn, height, number):
    """What is wrong with a row: nothing, if exactly one such part is lowest."""
    expected = VERTICES_OF[name][PARTS.index(part)]
    placed = vertices_of(name) @ matrix_of(turn).T
    lowest = placed[:, 1].min()
    on_ground = placed[placed[:, 1] < lowest + 1e-6]
    dimension = numpy.linalg.matrix_rank(on_ground - on_ground[0], tol=1e-6)
    if len(on_ground) != expected or number != expected:
        yield f"{len(on_ground)} vertices are lowest, {number} are written; expected {expected}"
    if dimension != PARTS.index(part):
        yield f"what is lowest has {dimension} dimensions; expected {PARTS.index(part)}"
    if abs(height + lowest) > 1e-6:
        yield f"the centre is {-lowest:.6f} radii high, {height} is written"


def check(path):
    """The number of faults of a page, each printed."""
    lines = open(path, encoding="utf-8").read().splitlines()
    faults = 0
    rows = [line for line in lines if re.match(r"\| (%s) \| (vertex|edge|face|cell) \|" % "|".join(VERTICES_OF), line)]
    for row in rows:
        name, part, turn, height, number = [cell.strip() for cell in row.strip("|").split("|")]
        for fault in faults_of_row(name, part, turn_of(turn), float(height), int(number)):
            print(f"{path}: {name}, {part}: {fault}")
            faults += 1
    expected = list(table())
    if expected[2:] != rows or not set(expected[:2]) <= set(lines):
        print(f"{path}: the table is not what rotations.py prints")
        faults += 1
    print(f"{len(rows)} rotations checked, {faults} faults")
    return faults


if __name__ == "__main__":
    if len(sys.argv) == 1:
        print("\n".join(table()))
    elif len(sys.argv) == 3 and sys.argv[1] == "--check":
        sys.exit(1 if check(sys.argv[2]) else 0)
    else:
        sys.exit(__doc__)
