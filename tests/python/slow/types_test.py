# SPDX-License-Identifier: Apache-2.0
"""The stubs as a type checker sees them, where mypy is."""

import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest

import tesserae as ts

RIGHT = """
import numpy as np
import tesserae as ts

world = ts.World(gravity=[0, -10, 0, 0], threads=2)
ball: int = world.add(ts.Hypersphere(0.5), mass=2, position=np.zeros(4))
world.join("hinge", ball, anchor=[0, 0, 0, 0], plane="xy", motor={"speed": 3})
balls = world.add_many(ts.Hypersphere(0.5), position=np.zeros((3, 4)))
last: int = int(balls[-1])
again: ts.World = ts.World.load(bytearray(world.save()))
heaviest: float = float(world.masses.max())
settings = (world.substeps + world.iterations + world.seed, world.tolerance, world.integrator.upper(), world.sleeping)
world.velocity = np.zeros((1, 4))
contacts: int = world.step(steps=3).contacts
hit = world.ray([0, 0, 0, -5], [0, 0, 0, 1])
where = hit.point if hit is not None else None
scene = ts.Scene.parse("", {"physics.duration": 2})
color = scene.render(world, progress=lambda done, total: None)["color"]
turned = ts.rotor.rotate(ts.rotor.from_planes(xy=1.5), world.position)
"""
# (line, what is wrong with it)
WRONG = [
    ("ts.Hypersphere('big')", "arg-type"),
    ("ts.World(gravitation=3)", "call-arg"),
    ("ts.World().join('hinge', 0, anchor=[0, 0, 0, 0], length=3)", "call-overload"),
    ("ts.World().ray([0] * 4, [0] * 4).point", "union-attr"),
    ("ts.World().time = 3", "misc"),
    ("ts.World().iterations = 3", "misc"),
    ("ts.World().add_many(ts.Hypersphere(1), positions=[[0] * 4])", "call-arg"),
    ("ts.World.load('text')", "arg-type"),
    ("ts.rotor.exp()", "call-arg"),
]


def mypy(text):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "program.py"
        file.write_text(text)
        done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--show-error-codes", "--cache-dir", folder, str(file)],
                              capture_output=True, text=True, cwd=folder)
    return done.stdout


@unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
class Types(unittest.TestCase):
    def test_a_program_that_is_right_passes(self):
        self.assertIn("Success", mypy(RIGHT))

    def test_mistakes_are_found(self):
        told = mypy("import tesserae as ts\n" + "".join(line + "\n" for line, _ in WRONG)).splitlines()
        for number, (line, code) in enumerate(WRONG, 2):
            self.assertTrue(any(f":{number}:" in t and f"[{code}]" in t for t in told), f"{line}: {told}")

    def test_the_package_itself_is_sound(self):
        done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "-p", "tesserae"], capture_output=True, text=True,
                              cwd=pathlib.Path(ts.__file__).parents[1])
        self.assertIn("Success", done.stdout)


if __name__ == "__main__":
    unittest.main()
