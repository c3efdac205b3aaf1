"""Holds pages of `tesserae view` against the renderer, in a real browser.

    python3 check_pages.py PROGRAM FOLDER
"""

import pathlib
import subprocess
import sys
import time

import numpy
import OpenImageIO as oiio

import scenes
from browser import Browser, js

SIZE = (320, 180)
# Of the pixels whose eight neighbours show the same body in the renderer's picture.
AGREEMENT = 0.995

failures = []


def check(fact, text):
    print(("ok      " if fact else "FAILED  ") + text, flush=True)
    if not fact:
        failures.append(text)


class Job:
    """A scene with its page and its frames."""

    def __init__(self, program, folder, name, text):
        self.program, self.folder, self.name = program, folder, name
        self.scene, self.page = folder / f"{name}.toml", folder / f"{name}.html"
        self.scene.write_text(text)

    def tesserae(self, *arguments):
        subprocess.run([self.program, *map(str, arguments), "--quiet"], check=True,
                       stdout=subprocess.DEVNULL)

    def view(self, *options):
        self.tesserae("view", self.scene, "-o", self.page, "--overwrite", *options)
        return self.page

    def ids(self, frame=0, scene=None, size=SIZE):
        """Object ids of a frame, by rows."""
        out = self.folder / f"{self.name}-frames"
        trajectory = self.page.with_suffix(".h5")
        motion = ["--trajectory", trajectory] if trajectory.exists() else []
        self.tesserae("render", scene or self.scene, *motion, "-o", out, "--frames", frame,
                      "--size", "%dx%d" % size, "--samples", 1, "--overwrite",
                      "--set", 'render.channels=["id"]')
        # A scene under another name has frames of another name.
        newest = max((out / "frames").glob("*.exr"), key=lambda path: path.stat().st_mtime)
        image = oiio.ImageInput.open(str(newest))
        return numpy.asarray(image.read_image("uint")).reshape(size[1], size[0])


def page_ids(browser, width=SIZE[0], height=SIZE[1]):
    """The ids that the page's picture shows, by rows."""
    browser.run(f"tesserae.size({width}, {height}); await tesserae.draw()")
    seen = browser.run("return Array.from(tesserae.ids())")
    return numpy.array(seen, dtype=numpy.uint32).reshape(height, width)


def agreement(wanted, seen):
    """Over pixels inside of bodies: which part is equal, how many there are, how many bodies."""
    inside = numpy.ones_like(wanted, dtype=bool)
    inside[0, :] = inside[-1, :] = inside[:, 0] = inside[:, -1] = False
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            inside &= numpy.roll(wanted, (dy, dx), (0, 1)) == wanted
    return (wanted == seen)[inside].mean(), inside.sum(), len(numpy.unique(wanted))


def check_ids(name, wanted, seen, least_bodies):
    part, pixels, bodies = agreement(wanted, seen)
    check(part >= AGREEMENT and bodies >= least_bodies,
          f"{name}: {100 * part:.3f} % of {pixels} pixels inside of {bodies} ids are equal")


def check_copied_camera(browser, job, name, fourth_turn):
    """What "Copy camera" gives renders what the page shows."""
    browser.run("const v = tesserae.page.view; v.orbit(0.4, -0.1); v.move(0.3, 0.2, 0.5);"
                f"v.angles = {js(fourth_turn)}; v.shift = 0.05")
    seen = page_ids(browser)
    toml = browser.run("return tesserae.camera_toml()")
    text = job.scene.read_text()
    other = job.folder / f"{job.name}-copied.toml"
    other.write_text(toml + text[text.index("[[light]]"):])
    check_ids(f"{name}, copied camera", job.ids(scene=other), seen, 3)
    before = browser.run("return tesserae.page.view.shown()")
    job.tesserae("view", other, "-o", other.with_suffix(".html"), "--overwrite")
    browser.open(other.with_suffix(".html"))
    after = browser.run("return tesserae.page.view.shown()")
    worst = max(numpy.abs(numpy.subtract(before[key], after[key])).max()
                for key in ("right", "up", "forward", "fourth", "position"))
    check(worst < 1e-9, f"{name}: the copied camera is the same to {worst:.1e}")


def check_stills(browser, program, folder):
    """Every shape, near and far, with the slice as it is and turned."""
    cases = {"near": scenes.all_shapes(), "far": scenes.all_shapes(scenes.FAR),
             "turned": scenes.all_shapes(more=scenes.TURNED),
             "far-turned": scenes.all_shapes(scenes.FAR, scenes.TURNED)}
    for name, text in cases.items():
        job = Job(program, folder, name, text)
        browser.open(job.view())
        check_ids(name, job.ids(), page_ids(browser), 8 if "turned" in name else 14)
        if name in ("near", "far-turned"):
            check_copied_camera(browser, job, name, [0.2, -0.1, 0.15])
    job = Job(program, folder, "cell120", scenes.one_120_cell())
    browser.open(job.view())
    check_ids("120-cell", job.ids(), page_ids(browser), 2)


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    begin = time.time()
    with Browser() as browser:
        check_stills(browser, program, folder)
        complaints = browser.complaints()
        check(not complaints, f"no word in the console {complaints}")
    print(f"{time.time() - begin:.0f} s, {len(failures)} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
