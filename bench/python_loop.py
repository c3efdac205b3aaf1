#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A loop of steps in Python against the same in C++, in turns: the ratio of their times.

    python_loop.py BUILD [--bodies 10000] [--steps 1000] [--threads 1] [--repeats 3]

Prints a line a pair of runs, and then the ratio of the least times. Both end in the same bytes, or it
fails. BUILD is a build folder with the Python module; the loop in C++ is built there."""

import argparse
import hashlib
import pathlib
import subprocess
import sys
import tempfile

IN_PYTHON = """
import hashlib, sys, time
import tesserae as ts
world = ts.Scene.read(sys.argv[1]).world(threads=int(sys.argv[3]))
begin = time.perf_counter()
for _ in range(int(sys.argv[2])):
    world.step()
print(time.perf_counter() - begin)
open(sys.argv[4], "wb").write(world.save())
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--bodies", type=int, default=10_000)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=3)
    asked = parser.parse_args()
    build = asked.build.resolve()
    subprocess.run(["cmake", "--build", build, "--target", "python_loop"], check=True, stdout=sys.stderr)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene = folder / "pile.toml"
        with open(scene, "w") as file:
            subprocess.run([build / "tesserae", "generate", "pile", "--bodies", str(asked.bodies)], stdout=file, check=True)
        arguments = [str(scene), str(asked.steps), str(asked.threads)]
        commands = {"C++": [str(build / "python_loop")], "Python": [sys.executable, "-c", IN_PYTHON]}
        times = {who: [] for who in commands}
        states = set()
        for _ in range(asked.repeats):
            for who, command in commands.items():
                done = subprocess.run([*command, *arguments, str(folder / "state")], check=True, capture_output=True,
                                      text=True, env={"PYTHONPATH": str(build / "python"), "PATH": "/usr/bin:/bin"})
                times[who].append(float(done.stdout))
                states.add(hashlib.sha256((folder / "state").read_bytes()).hexdigest())
            print(", ".join(f"{who} {all_[-1]:.3f} s" for who, all_ in times.items()), flush=True)
        if len(states) != 1:
            sys.exit("the worlds end in different states")
        print(f"Python / C++: {min(times['Python']) / min(times['C++']):.4f}")


if __name__ == "__main__":
    main()
