#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error of `direct` where the penumbrae of many bodies overlap, against `path` with the same light: CSV on standard output.

    penumbrae.py PROGRAM [PROGRAM...]

Each PROGRAM is a `tesserae`: two of them, before and after a change, are measured side by side, their frames in turn. Errors are in
codes of 255 of the previews, over all channels of all pixels; the time is the least of the frames' seconds, in parts of the first program's.
"""

import pathlib
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

REPEATS = 7
REFERENCE_SAMPLES = 2048

HEAD = """
camera = { position = [0, 6, -7, 0], look_at = [0, 0, 0.5, 0], field_of_view = 40 }
render = { size = [320, 180], samples = 36, bounces = 0, channels = ["color"] }
light = [{ type = "sun", angle = 3, direction = [0.6, -1, 0.35, 0.1], strength = 5 }]
body = [{ shape = "hyperplane", normal = [0, 1, 0, 0], offset = -1 }]
[[lattice]]
jitter = 0.2
"""
SCENES = {
    "balls": HEAD + 'shape = "hypersphere"\nradius = 0.25\ncount = [6, 3, 5, 4]\nspacing = [0.7, 0.7, 0.7, 0.5]\nposition = [0, 1.2, 0, 0.1]\n',
    "boxes": HEAD + 'shape = "hyperbox"\nsize = [0.5, 0.3, 0.4, 0.5]\nrotation = { xy = 20, zw = 30, yz = 50 }\ncount = [6, 3, 5, 4]\n'
    "spacing = [0.7, 0.7, 0.7, 0.5]\nposition = [0, 1.2, 0, 0.1]\n",
    "capsules": HEAD + 'shape = "hypercapsule"\nradius = 0.08\nheight = 0.7\nrotation = { xy = 40, zw = 30, yz = 70 }\ncount = [6, 3, 5, 4]\n'
    "spacing = [0.7, 0.7, 0.7, 0.5]\nposition = [0, 1.2, 0, 0.1]\n",
    "one ball": HEAD + 'shape = "hypersphere"\nradius = 0.8\ncount = [1, 1, 1, 1]\nspacing = 2\nposition = [0, 1.2, 0, 0]\n',
}


def render(program, scene, folder, *more):
    """Seconds that the processors took for one frame, and its preview."""
    shutil.rmtree(folder, ignore_errors=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([program, "render", scene, "-o", folder, "--quiet", *more], check=True, stdout=subprocess.DEVNULL)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return seconds, next(pathlib.Path(folder, "preview").glob("*.png"))


def paeth(a, b, c):
    p = a + b - c
    return min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]


def codes(path):
    """The values of an image of 8 bits without interlacing, row by row."""
    data = path.read_bytes()
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    assert depth == 8
    size = {0: 1, 2: 3, 4: 2, 6: 4}[kind]
    packed, at = b"", 8
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at : at + 8])
        if name == b"IDAT":
            packed += data[at + 8 : at + 8 + length]
        at += 12 + length
    raw, stride = zlib.decompress(packed), width * size
    values, above = [], bytearray(stride)
    for y in range(height):
        begin = y * (stride + 1)
        row = bytearray(raw[begin + 1 : begin + 1 + stride])
        for i in range(stride):
            left = row[i - size] if i >= size else 0
            corner = above[i - size] if i >= size else 0
            row[i] = (row[i] + (0, left, above[i], (left + above[i]) // 2, paeth(left, above[i], corner))[raw[begin]]) & 255
        values.extend(row)
        above = row
    return values


def measure(name, programs, folder):
    scene = folder / f"{name.replace(' ', '_')}.toml"
    scene.write_text(SCENES[name])
    more = ("--set", 'render.integrator="path"', "--set", f"render.samples={REFERENCE_SAMPLES}")
    exact = codes(render(programs[-1], scene, folder / "reference", *more)[1])
    seconds, previews = [[] for _ in programs], []
    for repeat in range(REPEATS):
        for i, program in enumerate(programs):
            time, preview = render(program, scene, folder / f"direct{i}")
            seconds[i].append(time)
            if repeat == 0:
                previews.append(codes(preview))
    for i, program in enumerate(programs):
        errors = sorted(abs(a - b) for a, b in zip(previews[i], exact, strict=True))
        rms = (sum(e * e for e in errors) / len(errors)) ** 0.5
        part = [errors[int(p * len(errors))] for p in (0.95, 0.99)]
        ratio = min(seconds[i]) / min(seconds[0])
        print(f"{name},{i},{rms:.2f},{part[0]},{part[1]},{errors[-1]},{min(seconds[i]):.3f},{ratio:.3f}", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("scene,program,rms,percentile_95,percentile_99,largest,seconds,of_the_first")
    with tempfile.TemporaryDirectory() as temporary:
        for scene_name in SCENES:
            measure(scene_name, sys.argv[1:], pathlib.Path(temporary))
