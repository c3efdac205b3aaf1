# SPDX-License-Identifier: Apache-2.0
"""Error against render time of one still in tesserae and in Blender's Cycles: CSV and plots.

usage: blender -b --factory-startup -noaudio --python-exit-code 1 --python compare.py -- \
           TESSERAE RAW_FOLDER
Writes cycles.csv (no head) and the converged pictures (reference_*.npy) into RAW_FOLDER. Errors are
root mean squares over pixels and channels, linear light, unclipped, in parts of the picture's mean,
against the same renderer's picture of REFERENCE_SAMPLES with other random numbers. Times are
processor time (user and system, one thread) of a whole render less that of one of 8 x 6 pixels: so
without start and scene; ours with writing its files, Cycles' without.
"""

import itertools
import os
import resource
import statistics
import subprocess
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import in_blender
import still

ALONE, AMONG = "alone", "among"  # see still.py
SIZE = (160, 120)
TINY = (8, 6)
SAMPLES = (1, 4, 16, 64, 256)
REFERENCE_SAMPLES = 4096
REPEATS = 3
SEED, REFERENCE_SEED = 1, 12345
REFERENCE_THREADS = os.cpu_count()


def read_exr(path):
    """Linear colours, from the bottom row up."""
    image = bpy.data.images.load(path, check_existing=False)
    image.colorspace_settings.name = "Non-Color"
    image.alpha_mode = "CHANNEL_PACKED"
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    width, height = image.size
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[..., :3].astype(float)


def processor_time(who):
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


class Tesserae:
    def __init__(self, program, folder, still_name, intersector):
        self.name, self.way, self.still = "tesserae", intersector, still_name
        self.raw, self.program = folder, program
        self.folder = f"{folder}/{still_name}_{intersector}"
        os.makedirs(self.folder, exist_ok=True)
        for is_turned in (False, True):
            with open(f"{self.folder}/still{int(is_turned)}.toml", "w") as file:
                file.write(still.toml(is_turned, intersector, still_name == AMONG))

    def render(self, size, samples, is_reference=False):
        """(seconds, picture)"""
        name = f"still{int(is_reference)}"
        command = [self.program, "render", f"{self.folder}/{name}.toml", "-o", self.folder,
                   "--quiet", "--overwrite", "--samples", str(samples), "--size",
                   f"{size[0]}x{size[1]}", "--threads",
                   str(REFERENCE_THREADS if is_reference else 1)]
        exr = f"{self.folder}/frames/{name}.0000.exr"
        if os.path.exists(exr):
            os.remove(exr)  # a whole frame would be kept
        begin = processor_time(resource.RUSAGE_CHILDREN)
        subprocess.run(command, check=True)
        seconds = processor_time(resource.RUSAGE_CHILDREN) - begin
        picture = read_exr(exr)
        return seconds, picture[::-1, ::-1] if is_reference else picture


class Cycles:
    def __init__(self, folder, pattern):
        self.name, self.way, self.still = "cycles", pattern.lower(), ALONE
        self.raw, self.pattern = folder, pattern

    def render(self, size, samples, is_reference=False):
        scene = in_blender.build(pattern=self.pattern)
        in_blender.set_job(scene, *size, samples, REFERENCE_SEED if is_reference else SEED,
                           REFERENCE_THREADS if is_reference else 1)
        begin = processor_time(resource.RUSAGE_SELF)
        bpy.ops.render.render()
        seconds = processor_time(resource.RUSAGE_SELF) - begin
        exr = f"{self.raw}/cycles.exr"
        bpy.data.images["Render Result"].save_render(exr, scene=scene)
        return seconds, read_exr(exr)


def relative_error(picture, reference):
    return np.sqrt(np.mean((picture - reference) ** 2)) / np.mean(reference)


def time_at(error, points):
    """Of a renderer's (error, seconds), interpolated in logarithms; nan beyond them."""
    error_logs, second_logs = np.log(sorted(points)).T
    return np.exp(np.interp(np.log(error), error_logs, second_logs, left=np.nan, right=np.nan))


def measure(renderers):
    """{(renderer, samples): (error, seconds)}; saves the references."""
    times, pictures = {}, {}
    for _ in range(REPEATS):
        # In turn, so that what else happens on the machine falls on all.
        for samples, renderer in itertools.product((None, *SAMPLES), renderers):
            key = renderer, samples
            seconds, pictures[key] = renderer.render(SIZE if samples else TINY, samples or 1)
            times.setdefault(key, []).append(seconds)
    times = {key: statistics.median(value) for key, value in times.items()}

    references = {}
    for renderer in renderers:
        name = f"{renderer.name}_{renderer.still}"
        if name not in references:  # all ways of one have the same picture
            references[name] = renderer.render(SIZE, REFERENCE_SAMPLES, True)[1]
            np.save(f"{renderer.raw}/reference_{name}.npy", references[name])
    return {(r, n): (relative_error(pictures[r, n], references[f"{r.name}_{r.still}"]),
                     times[r, n] - times[r, None])
            for r, n in itertools.product(renderers, SAMPLES)}


def main():
    program, folder = sys.argv[sys.argv.index("--") + 1:]
    ours = [Tesserae(program, folder, ALONE, "trace"), Tesserae(program, folder, AMONG, "trace")]
    renderers = [*ours, Tesserae(program, folder, ALONE, "analytic"),
                 Cycles(folder, "PROGRESSIVE_MULTI_JITTER"), Cycles(folder, "SOBOL")]
    points = measure(renderers)
    with open(f"{folder}/cycles.csv", "w") as file:
        print("renderer,way,still,samples,relative_rmse,seconds,ns_per_sample,over_alone,"
              "over_among", file=file)
        for (renderer, samples), (error, seconds) in points.items():
            ratios = [seconds / time_at(error, [points[our, n] for n in SAMPLES]) for our in ours]
            per_sample = seconds / (SIZE[0] * SIZE[1] * samples)
            print(f"{renderer.name},{renderer.way},{renderer.still},{samples},{error:.4g},"
                  f"{seconds:.4g},{1e9 * per_sample:.0f},{ratios[0]:.3g},{ratios[1]:.3g}",
                  file=file)


main()
