# SPDX-License-Identifier: Apache-2.0
"""Scenes, trajectories, pictures and pages: against worlds, files and numbers known beforehand."""

import html
import io
import os
import pathlib
import re
import signal
import tempfile
import threading
import time
import unittest
from contextlib import redirect_stderr

import numpy as np

import tesserae as ts
from tesserae.settings import set_texts

SCENE = """
physics = { duration = 0.5 }
camera = { position = [0, 0, -4, 0], look_at = [0, 0, 0, 0], field_of_view = 40 }
light = [{ type = "sky", color = [1, 1, 1], strength = 0.5 }]
render = { size = [24, 16], samples = 4, frames_per_second = 8, channels = ["color", "depth", "normal", "id", "position"] }
material = [{ name = "red", albedo = [0.9, 0.1, 0.1] }]
body = [{ name = "ball", shape = "hypersphere", radius = 1, material = "red" }]
lattice = [{ name = "row", shape = "hyperbox", size = [0.2, 0.2, 0.2, 0.2], count = [3, 1, 1, 1], spacing = 0.5, position = [0, 0, 3, 5] }]
"""


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = ts.Scene.parse(SCENE)


class Scenes(Folder):
    def test_scenes_tell_what_they_are(self):
        scene = self.scene
        self.assertEqual((scene.bodies, scene.joints, scene.width, scene.height), (4, 0, 24, 16))
        self.assertEqual((scene.frames, scene.frames_per_second, scene.duration), (4, 8, 0.5))
        self.assertEqual(scene.time_of_frame(2), 0.25)
        self.assertEqual((scene.body("ball"), scene.bodies_of("row"), scene.name_of(2)), (0, [1, 2, 3], "row"))
        self.assertRegex(scene.hash, "^[0-9a-f]{32}$")
        again = ts.Scene.parse(scene.text)
        self.assertEqual((again.text, again.motion_hash), (scene.text, scene.motion_hash))

    def test_files_and_settings_are_read(self):
        path = self.folder / "small.toml"
        path.write_text(SCENE)
        scene = ts.Scene.read(path, {"physics.duration": 2, "render.samples": 9})
        self.assertEqual(scene.name, "small")
        self.assertEqual(scene.duration, 2)
        self.assertEqual(scene.hash, ts.Scene.read(str(path), ["physics.duration=2", "render.samples=9"]).hash)

    def test_settings_are_written_as_toml(self):
        sets = {"a": True, "b": 1.5, "c": [1, 2.0], "d": 'say "x"', "e": {"x": 1}, "f": np.array([1, 2]), "g": np.float64(2)}
        self.assertEqual(set_texts(sets), ["a=true", "b=1.5", "c=[1, 2.0]", 'd="say \\"x\\""', "e={ x = 1 }", "f=[1, 2]", "g=2.0"])

    def test_errors_have_place_and_rule(self):
        cases = [
            (lambda: ts.Scene.parse("body = 3"), "scene.toml:1"),
            (lambda: ts.Scene.parse(SCENE, path="my.toml", sets=["physics.duration=-1"]), "duration"),
            (lambda: ts.Scene.read(self.folder / "none.toml"), "none.toml"),
            (lambda: self.scene.body("bal"), "ball"),
            (lambda: self.scene.body("row"), "lattice of 3"),
            (lambda: self.scene.name_of(9), "has 4 bodies"),
            (lambda: self.scene.time_of_frame(5), "frames 0 to 3"),
            (lambda: self.scene.render_frame(3), "trajectory"),
            (lambda: ts.Trajectory(self.folder / "none.h5"), "none.h5"),
            (lambda: ts.Picture.read(self.folder / "none.exr"), "none.exr"),
            (lambda: self.scene.world(threads=-2), "threads"),
        ]
        for call, text in cases:
            with self.assertRaisesRegex(ts.InputError, text):
                call()
        with self.assertRaises(TypeError):
            ts.Scene.parse(SCENE, sets="physics.duration=1")
        with self.assertRaises(TypeError):
            self.scene.simulate(self.folder / "a.h5", progress=3)


class Trajectories(Folder):
    def test_a_world_moves_as_the_trajectory_says(self):
        path = self.folder / "motion.h5"
        result = self.scene.simulate(path, store_every=60, threads=2)
        self.assertEqual((result.first_step, result.last_step, result.stored, result.kept), (0, 120, 3, False))
        self.assertTrue(self.scene.simulate(path, store_every=60).kept)
        trajectory = ts.Trajectory(path)
        self.assertEqual(len(trajectory), 3)
        self.assertEqual(trajectory.steps.tolist(), [0, 60, 120])
        np.testing.assert_allclose(trajectory.times, [0, 0.25, 0.5], atol=1e-15)
        self.assertEqual(trajectory.bodies, 4)
        self.assertEqual(trajectory.names, ["ball", "row", "row", "row"])
        self.assertEqual(len(trajectory.masses), 4)
        self.assertEqual(trajectory.motion_hash, self.scene.motion_hash)
        self.assertEqual(ts.Scene.parse(trajectory.scene_text).motion_hash, self.scene.motion_hash)

        world = self.scene.world(threads=1)
        for i in range(3):
            state = trajectory[i]
            for part in ("position", "rotor", "velocity", "angular_velocity"):
                np.testing.assert_array_equal(getattr(state, part), getattr(world, part))
            world.step(steps=60)
        all_states = trajectory[:]
        self.assertEqual(all_states.rotor.shape, (3, 4, 8))
        np.testing.assert_array_equal(all_states.position[1], trajectory[1].position)
        np.testing.assert_array_equal(trajectory[::-2].velocity, all_states.velocity[::-2])
        np.testing.assert_array_equal(trajectory[-1].position, all_states.position[2])
        self.assertEqual(trajectory[1:1].position.shape, (0, 4, 4))
        self.assertEqual([len(state.position) for state in trajectory], [4, 4, 4])  # ends by IndexError
        kept = trajectory[1].position
        del trajectory
        np.testing.assert_array_equal(kept, all_states.position[1])
        with self.assertRaises(ValueError):
            kept[0] = 1

    def test_progress_is_told_and_can_end_the_work(self):
        told = []
        self.scene.simulate(self.folder / "a.h5", progress=lambda done, total: told.append((done, total)))
        self.assertEqual(told, sorted(told))
        self.assertTrue(all(done <= total for done, total in told))

        class Enough(Exception):
            pass

        def enough(done, total):
            raise Enough

        long = ts.Scene.parse(SCENE, {"physics.duration": 10_000})
        begin = time.perf_counter()
        with self.assertRaises(Enough):
            long.simulate(self.folder / "b.h5", progress=enough)
        self.assertLess(time.perf_counter() - begin, 5)
        lines = io.StringIO()
        with redirect_stderr(lines):
            ts.Scene.parse(SCENE, {"physics.duration": 30}).simulate(self.folder / "c.h5", progress=True)
        self.assertRegex(lines.getvalue(), r"^(\r\d+ of \d+)*\n?$")

    def test_ctrl_c_keeps_what_is_stored(self):
        signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have it ignored
        scene = ts.Scene.parse(SCENE, {"physics.duration": 10})

        def interrupt(done, total):
            if done > 500:
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            scene.simulate(self.folder / "a.h5", progress=interrupt)
        result = scene.simulate(self.folder / "a.h5")
        self.assertGreater(result.first_step, 300)  # it went on from there
        self.assertEqual(result.last_step, 2370)  # that of the last frame
        scene.simulate(self.folder / "b.h5")
        a, b = ts.Trajectory(self.folder / "a.h5"), ts.Trajectory(self.folder / "b.h5")
        np.testing.assert_array_equal(a[:].position, b[:].position)
        np.testing.assert_array_equal(a[:].angular_velocity, b[:].angular_velocity)


class Pictures(Folder):
    def test_the_layers_of_a_ball_are_known_beforehand(self):
        world = self.scene.world()
        picture = self.scene.render(world)
        self.assertEqual((picture.width, picture.height, picture.left, picture.top), (24, 16, 0, 0))
        self.assertEqual(set(picture.layers), {"color", "depth", "normal", "id", "position"})
        for name, channels in [("color", 4), ("depth", 1), ("normal", 4), ("id", 1), ("position", 4)]:
            self.assertEqual(picture[name].shape, (16, 24, channels))
            self.assertEqual(len(picture.channels(name)), channels)
            self.assertTrue(name in picture)
        # In the middle the ball of radius 1 is 3 m away, and faces the camera.
        self.assertAlmostEqual(float(picture["depth"][8, 12, 0]), 3, delta=0.05)
        np.testing.assert_allclose(picture["normal"][8, 12], [0, 0, -1, 0], atol=0.2)
        self.assertEqual(picture["id"][8, 12, 0], 1)
        self.assertEqual(picture["id"][0, 0, 0], 0)
        self.assertEqual(picture["depth"][0, 0, 0], np.inf)
        red, green = picture["color"][8, 12, :2]
        self.assertAlmostEqual(float(red / green), 9, delta=0.5)  # albedos 0.9 and 0.1 under a white sky
        self.assertEqual(picture.warnings, [])
        with self.assertRaises(ValueError):
            picture["color"][0] = 0
        with self.assertRaises(ts.InputError):
            picture["albedo"]

    def test_a_world_that_has_changed_is_shown_as_it_is(self):
        world = self.scene.world()
        world.remove(0)
        self.assertFalse(self.scene.render(world)["id"].any())
        added = world.add(ts.Hyperbox([1, 1, 1, 1]))
        picture = self.scene.render(world)
        self.assertEqual(picture["id"][8, 12, 0], added + 1)
        self.assertAlmostEqual(float(picture["depth"][8, 12, 0]), 3.5, delta=0.05)
        color = picture["color"][8, 12]
        self.assertAlmostEqual(float(color[0] / color[1]), 1, delta=0.01)  # grey

    def test_pictures_are_those_of_the_film(self):
        told = []
        result = self.scene.film(self.folder / "film", frames=[0, 2], progress=lambda *p: told.append(p))
        self.assertEqual((result.rendered + result.copied, result.kept), (2, 0))
        self.assertEqual(self.scene.film(self.folder / "film", frames=[0, 2]).kept, 2)
        images = sorted(result.frames.glob("*.exr"))
        self.assertEqual(len(images), 2)
        trajectory = self.folder / "film" / "trajectory.h5"
        frame = self.scene.render_frame(2, trajectory, threads=1)
        stored = ts.Picture.read(images[1])
        for layer in frame.layers:
            np.testing.assert_array_equal(frame[layer], stored[layer])
        frame.write_image(self.folder / "frame.exr")
        self.assertEqual((self.folder / "frame.exr").read_bytes(), images[1].read_bytes())
        first = self.scene.render_frame(0)
        frame.write_preview(self.folder / "frame.png")
        self.assertEqual(frame._repr_png_()[:4], b"\x89PNG")
        self.assertEqual((self.folder / "frame.png").read_bytes(), frame._repr_png_())
        self.assertFalse(np.array_equal(first["depth"], frame["depth"]))  # the ball has fallen

    def test_pictures_are_numbered_from_0_and_files_named_as_what_they_are(self):
        scene = ts.Scene.parse('body = [{ shape = "hypersphere", radius = 1 }]', {"render.size": [8, 8], "render.samples": 1})
        world = scene.world()
        with self.assertRaisesRegex(ts.InputError, "frame = -1: expected a number >= 0"):
            scene.render(world, frame=-1)
        picture = scene.render(world, frame=1000)
        for name in ("look.jpg", "look.exr", "look"):
            with self.assertRaisesRegex(ts.InputError, "expected a name that ends in .png"):
                picture.write_preview(self.folder / name)
        with self.assertRaisesRegex(ts.InputError, "expected a name that ends in .exr"):
            picture.write_image(self.folder / "look.png")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_layers_outlive_their_picture(self):
        picture = self.scene.render(self.scene.world())
        depth, copy = picture["depth"], picture["depth"].copy()
        del picture
        filler = [np.full(24 * 16, np.nan, np.float32) for _ in range(1000)]
        np.testing.assert_array_equal(depth, copy)
        self.assertEqual(len(filler), 1000)

    def test_a_world_is_not_stepped_while_it_is_rendered(self):
        scene = ts.Scene.parse(SCENE, {"render.size": [320, 240], "render.samples": 64})
        world, refused = scene.world(), 0
        rendering = threading.Thread(target=lambda: scene.render(world, threads=1))
        rendering.start()
        while rendering.is_alive():
            try:
                world.step()
            except RuntimeError:
                refused += 1
            time.sleep(0.002)
        rendering.join()
        self.assertGreater(refused, 0)


class Pages(Folder):
    def test_pages_show_scenes_and_worlds(self):
        for page in (self.scene.view(), self.scene.world().view(self.scene), self.scene.world().view()):
            self.assertIn("<!DOCTYPE html>", page.html[:200])
            page.save(self.folder / "page.html")
            self.assertEqual((self.folder / "page.html").read_text(), page.html)
            frame = page._repr_html_()
            source = re.fullmatch(r'<iframe srcdoc="([^"]*)" style="[^"]*" allowfullscreen></iframe>', frame)
            self.assertEqual(html.unescape(source[1]), page.html)

    def test_a_page_of_a_trajectory_has_its_moments(self):
        path = self.folder / "a.h5"
        self.scene = ts.Scene.parse(SCENE, {"physics.duration": 5})
        self.scene.simulate(path)
        self.assertGreater(len(self.scene.view(path).html), len(self.scene.world().view(self.scene).html))
        with self.assertRaises(ts.InputError):
            ts.Scene.parse(SCENE, {"physics.gravity": [0, -1, 0, 0]}).view(path)


if __name__ == "__main__":
    unittest.main()
