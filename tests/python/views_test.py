# SPDX-License-Identifier: Apache-2.0
"""numpy's views of a world: no copies, not writable, and never freed memory."""

import gc
import unittest

import numpy as np

import tesserae as ts

PARTS = {"position": 4, "rotor": 8, "velocity": 4, "angular_velocity": 6}


def world_of(count, seed=1):
    random = np.random.default_rng(seed)
    world = ts.World(gravity=[0, 0, 0, 0])
    for _ in range(count):
        world.add(ts.Hypersphere(0.1), position=random.uniform(-100, 100, 4), velocity=random.normal(size=4),
                  rotor=ts.rotor.exp(random.normal(size=6)), angular_velocity=random.normal(size=6))
    return world


class Views(unittest.TestCase):
    def test_views_show_each_body_and_go_on_with_the_world(self):
        world = world_of(50)
        views = {name: getattr(world, name) for name in PARTS}
        for name, width in PARTS.items():
            self.assertEqual(views[name].shape, (50, width))
            self.assertEqual(views[name].dtype, np.float64)
        for i, body in enumerate(world):
            state = world.state(body)
            for name in PARTS:
                np.testing.assert_array_equal(views[name][i], getattr(state, name))
        pointer = views["position"].ctypes.data
        before = views["position"].copy()
        world.step(0.5)
        np.testing.assert_allclose(views["position"], before + 0.5 * views["velocity"], atol=1e-12)
        self.assertEqual(world.position.ctypes.data, pointer)

    def test_views_cannot_be_written(self):
        world = world_of(3)
        for name in PARTS:
            view = getattr(world, name)
            with self.assertRaises(ValueError):
                view[0] = 0
            with self.assertRaises(ValueError):
                view.flags.writeable = True

    def test_views_keep_their_memory_and_last_values(self):
        world = world_of(200)
        views = {name: getattr(world, name) for name in PARTS}
        values = {name: view.copy() for name, view in views.items()}
        for _ in range(1000):
            world.add(ts.Hypersphere(0.1), position=[500, 0, 0, 0])
        world.remove(0)
        world.step()
        for name in PARTS:
            np.testing.assert_array_equal(views[name], values[name])
            self.assertEqual(len(getattr(world, name)), 1199)
        last = {name: getattr(world, name) for name in PARTS}
        values = {name: view.copy() for name, view in last.items()}
        del world
        gc.collect()
        filler = [np.full(200 * 8, np.nan) for _ in range(1000)]  # takes what was freed
        for name in PARTS:
            np.testing.assert_array_equal(last[name], values[name])
        self.assertEqual(len(filler), 1000)

    def test_random_changes_leave_every_view_as_it_was(self):
        for seed in range(10):
            random = np.random.default_rng(seed)
            world, kept = world_of(5, seed), []
            for _ in range(150):
                what = random.integers(4)
                if what == 0 or len(world) == 0:
                    world.add(ts.Hypersphere(0.1), position=random.uniform(-100, 100, 4))
                elif what == 1:
                    world.remove(int(random.choice(world.ids)))
                elif what == 2:
                    world.step()
                else:
                    view = world.position
                    kept.append((view, len(world)))
                # Those of another number of bodies do not change any more.
                for view, count in kept:
                    self.assertEqual(len(view), count)
                    self.assertTrue(np.isfinite(view).all())
            del world
            self.assertTrue(all(np.isfinite(view).all() for view, _ in kept))

    def test_arrays_are_set_as_a_whole(self):
        world = world_of(20)
        random = np.random.default_rng(3)
        velocity, position = random.normal(size=(20, 4)), random.normal(size=(20, 4))
        rotor = ts.rotor.exp(random.normal(size=(20, 6)))
        world.velocity, world.position, world.rotor = velocity, position, rotor
        world.angular_velocity = np.zeros((20, 6))
        np.testing.assert_array_equal(world.velocity, velocity)
        np.testing.assert_array_equal(world.position, position)
        np.testing.assert_array_equal(world.rotor, rotor)
        self.assertFalse(world.angular_velocity.any())
        world.position = world.position  # of its own memory
        np.testing.assert_array_equal(world.position, position)
        with self.assertRaisesRegex(ts.InputError, "row 7"):
            world.rotor = np.where(np.arange(20)[:, None] == 7, 2, rotor)
        np.testing.assert_array_equal(world.rotor, rotor)

    def test_an_empty_world_has_empty_arrays(self):
        world = ts.World()
        self.assertEqual(world.position.shape, (0, 4))
        world.position = np.zeros((0, 4))
        world.step()
        self.assertEqual(world.contacts().shape, (0,))


if __name__ == "__main__":
    unittest.main()
