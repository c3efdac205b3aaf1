# SPDX-License-Identifier: Apache-2.0
"""Holds pages of `tesserae view` against the renderer, in a real browser.

    python3 check_pages.py PROGRAM FOLDER
"""

import base64
import pathlib
import subprocess
import sys
import time

import h5py
import numpy
import OpenImageIO as oiio
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.keys import Keys

import scenes
from browser import Browser, js

SIZE = (320, 180)
# Of the pixels whose eight neighbours show the same body in the renderer's picture.
AGREEMENT = 0.995
# A frame by the number of bodies: several times what two idle cores take, as tests share theirs.
MOST_MILLISECONDS = {1_000: 800, 10_000: 1200}

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
        if name == "near":
            check_colours(browser, job)
        if name in ("near", "far-turned"):
            check_copied_camera(browser, job, name, [0.2, -0.1, 0.15])
    job = Job(program, folder, "cell120", scenes.one_120_cell())
    browser.open(job.view())
    check_ids("120-cell", job.ids(), page_ids(browser), 2)


def check_colours(browser, job):
    """The page's light is the renderer's, but for what is at the rims of shadows and bodies."""
    job.tesserae("render", job.scene, "-o", job.folder / f"{job.name}-colours", "--size", "%dx%d" % SIZE,
                 "--samples", 1, "--set", "light.0.angle=0")
    wanted = oiio.ImageBuf(str(next((job.folder / f"{job.name}-colours" / "preview").glob("*.png"))))
    page_ids(browser)
    check_picture(browser, job, wanted)


def check_picture(browser, job, wanted):
    """The page's picture as it stands is the renderer's preview."""
    url = browser.run("return document.getElementById('picture').toDataURL()")
    shown = job.folder / f"{job.name}-page.png"
    shown.write_bytes(base64.b64decode(url.split(",")[1]))
    differences = numpy.abs(wanted.get_pixels(oiio.UINT8)[:, :, :3].astype(int) -
                            oiio.ImageBuf(str(shown)).get_pixels(oiio.UINT8)[:, :, :3].astype(int))
    part = (differences.max(axis=2) <= 3).mean()
    check(part > 0.98, f"{job.name}: {100 * part:.2f} % of pixels have the renderer's colour")


def check_looks(browser, program, folder):
    """Patterns, hues and ghosts."""
    for name, text in {"patterns": scenes.patterns(), "patterns-of-bodies": scenes.patterns("body"),
                       "ghosts": scenes.ghosts()}.items():
        job = Job(program, folder, name, text)
        browser.open(job.view())
        if name == "ghosts":
            depth = browser.run("return tesserae.page.panel.sliders.ghost.value")
            check(abs(depth - 2.5) < 1e-6, f"the page begins with the scene's ghosts: {depth}")
        check_colours(browser, job)


def check_motion(browser, program, folder):
    """Bodies that move, packed; a moving camera; when they are in the slice."""
    job = Job(program, folder, "crossing", scenes.crossing())
    browser.open(job.view())
    for frame in (0, 17, 39):
        browser.run(f"tesserae.time({frame / 10}); const p = tesserae.page;"
                    "p.view.look(filmCamera(p.scene, p.poses, p.time))")
        check_ids(f"crossing, frame {frame}", job.ids(frame), page_ids(browser), 2)
    # Frames at 1, 1.1, ... 3 s show the ball; at just 1 s and 3 s the slice only touches it.
    parts = browser.run("const t = tesserae.page.timeline; while (t.work());"
                        "return Array.from(t.parts[t.rows.findIndex((r) => r.name === 'crosser')])")
    inside = [frame for frame, part in enumerate(parts) if part > 0]
    check(inside[0] in (10, 11) and inside[-1] in (29, 30) and len(inside) == inside[-1] - inside[0] + 1,
          f"timeline: the ball is in the slice in frames {inside[0]} to {inside[-1]}")
    velocity = browser.run("return tesserae.page.poses.velocity(0, 2)")
    check(max(abs(a - b) for a, b in zip(velocity, (0, 0, 0, 1))) < 0.02, f"velocity {velocity}")
    key = browser.run("return cameraKeyToml(tesserae.page.view.description(), 2.5)")
    check(key.startswith("[[camera.key]]\ntime = 2.5\nposition = ["), "a copied key")


def check_pile(browser, program, folder):
    """A trajectory with collisions, from its file, at a frame in its midst."""
    text = subprocess.run([program, "generate", "pile", "--bodies", "300"], check=True,
                          capture_output=True, text=True).stdout
    job = Job(program, folder, "pile", text.replace("duration = 4", "duration = 1"))
    page = job.view()
    job.tesserae("view", page.with_suffix(".h5"), "-o", page, "--overwrite")
    browser.open(page)
    browser.run("tesserae.time(25 / 30)")
    check_ids("pile", job.ids(25), page_ids(browser), 15)


def check_hostile(browser, program, folder):
    """A name is text, wherever it comes to be shown."""
    job = Job(program, folder, "hostile", scenes.hostile())
    browser.open(job.view())
    browser.run("const p = tesserae.page, s = document.getElementById('stage');"
                "p.choose(s.clientWidth / 2, s.clientHeight / 2); p.drawUi(1)")
    name = browser.run("return document.getElementById('body-name').textContent")
    check(name == scenes.HOSTILE, "a hostile name is shown as it is")
    check(browser.run("return window.hit") is None and
          browser.run("return document.querySelectorAll('img').length") == 0, "and does nothing")
    toml = browser.run("return tesserae.camera_toml()")
    check(toml.count("[") == 5 and "script" not in toml, "nor is it in the TOML")
    check(browser.run("tesserae.size(64, 64); await tesserae.draw(); return tesserae.pick(32, 32)") == 1
          and browser.run("return tesserae.pick(0, 0)") == 0, "pick() gives the object id")


def check_small(browser, program, folder):
    """No body; no frame but one."""
    for name, text in {"empty": "[camera]\nposition = [0, 0, -5, 0]\n",
                       "still": scenes.one_120_cell()}.items():
        browser.open(Job(program, folder, name, text).view())
        check(browser.run("tesserae.size(32, 32); tesserae.time(3); await tesserae.draw(); return true"),
              f"{name}: is shown")


def check_controls(browser, program, folder):
    """Mouse and keys do what the help line says; ghosts are seen; the page plays."""
    browser.open(folder / "crossing.html")
    page, keys = "tesserae.page", lambda: ActionChains(browser.driver)
    overlay = browser.driver.find_element("id", "overlay")
    before = browser.run(f"return {page}.view.shown().right")
    keys().move_to_element(overlay).click_and_hold().move_by_offset(90, 30).release().perform()
    after = browser.run(f"return {page}.view.shown().right")
    check(max(abs(a - b) for a, b in zip(before, after)) > 0.1, "a drag orbits")
    check(abs(after[1]) < 1e-9, "and keeps the horizon level")
    away = browser.run(f"return {page}.view.distance")
    ActionChains(browser.driver).scroll_from_origin(ScrollOrigin.from_element(overlay), 0, 200).perform()
    check(browser.run(f"return {page}.view.distance") > away, "the wheel zooms")
    keys().send_keys("]").perform()
    check(browser.run(f"return {page}.view.shift") > 0, "] moves the slice along w")
    keys().send_keys("r0").perform()
    check(browser.run(f"return {page}.follows && {page}.view.shift === 0"), "R and 0 take all back")
    keys().send_keys(Keys.SPACE).perform()
    time.sleep(1.5)
    keys().send_keys(Keys.SPACE).perform()
    shown = browser.run(f"return {page}.time")
    check(0.3 < shown < 3.5 and abs(shown * 10 - round(shown * 10)) < 1e-6, f"it plays: {shown} s")
    keys().send_keys("d").perform()
    browser.run(f"{page}.goTo(2); {page}.drawUi(1)")
    keys().move_to_element(overlay).click().perform()
    chosen = browser.run("await new Promise((done) => setTimeout(done, 500));"
                         "return document.getElementById('body-name').textContent")
    check(chosen == "crosser", f"a click chooses a body: {chosen}")
    keys().send_keys(Keys.ESCAPE).perform()
    check_ghosts(browser)


def line_pixels(browser, a, b):
    """Colours along a line of the world, each the nearest to the line's own of a few pixels about
    it; what is drawn over the picture, r g b a."""
    return browser.run("""
        const overlay = tesserae.page.overlay, copy = document.createElement("canvas");
        copy.width = overlay.canvas.width, copy.height = overlay.canvas.height;
        const pen = copy.getContext("2d", {willReadFrequently: true});
        pen.drawImage(overlay.canvas, 0, 0);
        const [a, b] = args.map((point) => overlay.project(point)), seen = [];
        for (let i = 1; i < 8; ++i) {
            const x = Math.round(a.x + (i / 8) * (b.x - a.x)), y = Math.round(a.y + (i / 8) * (b.y - a.y));
            const all = pen.getImageData(x - 1, y - 1, 3, 3).data, brightness = (k) => all[k] + all[k + 1] + all[k + 2];
            let best = 0;
            for (let k = 4; k < 36; k += 4) if (brightness(k) > brightness(best)) best = k;
            seen.push(Array.from(all.slice(best, best + 4)));
        }
        return seen""", a, b)


def check_joints(browser, program, folder):
    """Lines from centre to anchor to anchor to centre, as what they hold is seen."""
    job = Job(program, folder, "jointed", scenes.jointed())
    browser.open(job.view())
    page = "tesserae.page"

    def show(time, more=""):
        browser.run(f"{page}.goTo({time}); {page}.showsFrame = false; {more}; {page}.drawUi(1)")

    def drawn(a, b):
        return min(pixel[3] for pixel in line_pixels(browser, a, b)) > 60

    def centre(body):
        return browser.run(f"return [...{page}.poses.position.subarray(4 * {body}, 4 * {body} + 4)]")

    with h5py.File(job.page.with_suffix(".h5")) as file:
        bodies = file["particles/bodies"]
        times, rotors = bodies["position/time"][:], bodies["rotor/value"][:]
        positions, broken = bodies["position/value"][:], file["joints/broken/value"][:]
    show(0)
    check(drawn((-2, 1, 0, 0), (-2.5, 1, 0, 0)) and drawn((0, 1, 0, 0), (-0.5, 1.5, 0, 0)) and
          drawn((1.5, 1.5, 0, 0), (2.5, 0.25, 0, 0.8)) and drawn((2.5, 0.25, 0, 0.8), (2.5, 0, 0, 0.8)),
          "joints are lines at the beginning")
    check(not drawn((1, 0, 0, 0), (1, -1, 0, 0)), "and nothing is where there is none")
    near = line_pixels(browser, (1.5, 1.5, 0, 0), (2.5, 0.25, 0, 0.8))
    ghost = line_pixels(browser, (2.5, 0.25, 0, 0.8), (2.5, 0, 0, 0.8))[3]
    check(near[0][1] > near[0][0] and ghost[0] > ghost[2] + 40 and near[-1][0] > near[-1][2] + 40,
          f"the half at the body in the slice is green, that at the ghost in its colour: {near[0]} {near[-1]}")

    # Both bodies have turned far by then: their ends stay at the world's points.
    for time_shown in (0.7, 1.3):
        show(time_shown)
        ends = browser.run(f"""
            const p = {page}, shown = p.view.shown();
            return [0, 1].map((joint) => p.joints.pointOn(p.joints.b[joint], p.joints.onB, 4 * joint))""")
        wanted = browser.run(f"return args.map((point) => {page}.overlay.project(point))",
                             [-2.5, 1, 0, 0], [-0.5, 1.5, 0, 0])
        off = max(abs(e[k] - w[k]) for e, w in zip(ends, wanted) for k in "xy")
        row = int(numpy.argmin(numpy.abs(times - time_shown)))
        turned = numpy.abs(rotors[row, 1] - rotors[0, 1]).max()
        check(off < 0.5 and turned > 0.1, f"{time_shown} s: ends are {off:.2f} pixels off their places, "
              f"the rotor has changed by {turned:.2f}")
        check(drawn(centre(0), (-2.5, 1, 0, 0)) and drawn(centre(1), (-0.5, 1.5, 0, 0)), "and lines lead there")

    # The thread is taut after 0.245 s; the next frame is that at 0.3 s.
    first = times[numpy.argmax(broken[:, 3] > 0)]
    check(0.2 < first < 0.301, f"the thread breaks after {first:.3f} s")
    show(0.2)
    check(drawn(centre(4), (-3, 1.5, 0, 0)), "it is drawn before that")
    show(0.3)
    check(not drawn(centre(4), (-3, 1.5, 0, 0)), "and not after")
    show(0.3, f"{page}.options.chosen = 4")
    text = browser.run("return document.getElementById('body-joints').textContent")
    check(text == "thread (broken)", f"a chosen body's joints are named: {text}")
    show(0, f"{page}.options.chosen = -1; {page}.panel.setGhosts(false, 1)")
    check(not drawn((2.5, 0.25, 0, 0.8), (2.5, 0, 0, 0.8)) and drawn((-2, 1, 0, 0), (-2.5, 1, 0, 0)),
          "without ghosts their lines are not there")
    ActionChains(browser.driver).send_keys("j").perform()
    show(0)
    check(not drawn((-2, 1, 0, 0), (-2.5, 1, 0, 0)), "J takes lines away")

    job = Job(program, folder, "joint-free", scenes.crossing())
    page_text = job.view().read_text()
    check("class JointLines" not in page_text, "a page without joints has nothing of them")


def check_ghosts(browser):
    """The ball is 0.5 m off the slice at 0.5 s: a ghost that fades to nothing at that depth."""
    browser.run("tesserae.page.goTo(0.5); tesserae.page.options.shadows = false")
    pictures = []
    for depth in (0, 0.502, 6):
        browser.run(f"tesserae.page.options.ghostDepth = {depth}")
        page_ids(browser, 160, 90)
        pictures.append(numpy.array(browser.run(
            "const gl = tesserae.page.renderer.gl, p = new Uint8Array(4 * 160 * 90);"
            "gl.readPixels(0, 0, 160, 90, gl.RGBA, gl.UNSIGNED_BYTE, p); return Array.from(p)")))
    seen = [numpy.abs(picture - pictures[0]).max() for picture in pictures[1:]]
    check(seen[0] <= 1 and seen[1] > 20, f"a ghost fades with its depth: {seen[0]}, {seen[1]}")


def check_speed(browser, program, folder):
    """Milliseconds a frame of moving bodies at 640x360, software GL: the best of several."""
    for bodies, most in MOST_MILLISECONDS.items():
        text = subprocess.run([program, "generate", "pile", "--bodies", str(bodies)], check=True,
                              capture_output=True, text=True).stdout
        job = Job(program, folder, f"pile{bodies}", text)
        browser.open(job.view("--set", "physics.duration=0.3"))
        took = browser.run("""
            tesserae.size(640, 360);
            const best = {};
            for (const shadows of [true, false]) {
                tesserae.page.options.shadows = shadows;
                best[shadows] = 1e9;
                for (let i = 0; i < 6; ++i) {
                    tesserae.time(0.1 + 0.02 * i);
                    const begin = performance.now();
                    await tesserae.draw();
                    best[shadows] = Math.min(best[shadows], performance.now() - begin);
                }
            }
            return best""")
        check(took["true"] < most, f"{bodies} bodies: {took['false']:.0f} ms a frame, with shadows "
              f"{took['true']:.0f} ms (at most {most})")


def check_size(program, folder):
    """500 bodies that fly and turn, 250 frames."""
    text = subprocess.run([program, "generate", "gas", "--bodies", "500"], check=True,
                          capture_output=True, text=True).stdout
    job = Job(program, folder, "gas", text)
    size = job.view("--set", "physics.duration=10", "--set", "render.frames_per_second=25",
                    "--set", "physics.steps_per_second=50").stat().st_size
    check(size <= 4e6, f"500 bodies x 250 frames: {size / 1e6:.2f} MB")


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    begin = time.time()
    check_size(program, folder)
    with Browser() as browser:
        for checks in (check_stills, check_motion, check_pile, check_hostile, check_looks, check_small,
                       check_controls, check_joints, check_speed):
            start = time.time()
            checks(browser, program, folder)
            complaints = browser.complaints()
            check(not complaints, f"{checks.__name__}: {time.time() - start:.0f} s, no word in the console {complaints}")
    print(f"{time.time() - begin:.0f} s, {len(failures)} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
