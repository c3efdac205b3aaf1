# SPDX-License-Identifier: Apache-2.0
"""Worlds against closed forms, and what they promise: numbers, threads, errors."""

import copy
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import tesserae as ts
from heaps import heap


class Motion(unittest.TestCase):
    def test_what_falls_is_at_g_t_t_over_2(self):
        world = ts.World(gravity=[0, -9, 0, 3])
        ball = world.add(ts.Hypersphere(1), position=[1, 2, 3, 4], velocity=[0.5, 0, 0, 0])
        world.step(steps=120)
        np.testing.assert_allclose(world.state(ball).position, [1.25, 2 - 9 / 8, 3, 4 + 3 / 8], atol=1e-12)
        self.assertAlmostEqual(world.time, 0.5, places=14)

    def test_a_ball_comes_back_at_its_restitution(self):
        world = ts.World(gravity=[0, 0, 0, 0])
        world.add(ts.Hyperplane([0, 0, 0, 1]))
        ball = world.add(ts.Hypersphere(0.5), position=[0, 0, 0, 1], velocity=[0, 0, 0, -3], restitution=0.6, friction=0)
        world.step(steps=240)
        np.testing.assert_allclose(world.state(ball).velocity, [0, 0, 0, 1.8], atol=1e-9)

    def test_a_ball_spins_on_in_both_planes(self):
        omega = np.array([1.0, 0.2, 0, 0, -0.3, 2.0])
        world = ts.World(gravity=[0, 0, 0, 0])
        ball = world.add(ts.Hypersphere(1), angular_velocity=omega)
        world.step(0.01, steps=150)
        expected = ts.rotor.to_matrix(ts.rotor.exp(-1.5 / 2 * omega))
        np.testing.assert_allclose(ts.rotor.to_matrix(world.rotor)[ball], expected, atol=1e-12)

    def test_pushes_change_the_motion_as_newton_says(self):
        world = ts.World(gravity=[0, 0, 0, 0])
        box = ts.Hyperbox([1, 2, 3, 4])
        body = world.add(box, mass=12)
        world.apply_impulse(body, [0, 0, 0, 6])
        np.testing.assert_allclose(world.velocity[0], [0, 0, 0, 0.5], atol=1e-15)
        world.apply_impulse(body, [0, 5, 0, 0], point=[1, 0, 0, 0])  # r ^ p = 5 in xy
        np.testing.assert_allclose(world.angular_velocity[0], [5 / 5, 0, 0, 0, 0, 0], atol=1e-14)
        world.apply_angular_impulse(body, [0, 0, 0, 0, 0, 50])
        np.testing.assert_allclose(world.angular_velocity[0], [1, 0, 0, 0, 0, 2], atol=1e-14)

        still = ts.World(gravity=[0, 0, 0, 0])
        ball = still.add(ts.Hypersphere(1), mass=2)
        still.apply_force(ball, [3, 0, 0, 0])
        still.apply_force(ball, [1, 0, 0, 0])
        still.apply_torque(ball, [0, 0, 0, 0, 1, 0])
        still.step(0.1, steps=2)  # they act in the first only
        np.testing.assert_allclose(still.velocity[0], [0.2, 0, 0, 0], atol=1e-14)
        inertia = 2 * 2 / 6
        np.testing.assert_allclose(still.angular_velocity[0], [0, 0, 0, 0, 0.1 / inertia, 0], atol=1e-14)

    def test_energy_and_momentum_are_sums(self):
        world = ts.World(gravity=[0, -10, 0, 0])
        world.add(ts.Hyperbox([1, 2, 3, 4]), mass=12, position=[0, 3, 0, 0], velocity=[1, 0, 0, 2],
                  angular_velocity=[0, 0, 0, 0, 0, 2])
        self.assertAlmostEqual(world.kinetic_energy, 12 * 5 / 2 + 25 * 4 / 2)
        self.assertAlmostEqual(world.potential_energy, 360)
        np.testing.assert_allclose(world.momentum, [12, 0, 0, 24])
        expected = np.zeros(6)
        expected[0] = -3 * 12  # x ^ p of the centre
        expected[4] = 3 * 24
        expected[5] = 25 * 2
        np.testing.assert_allclose(world.angular_momentum, expected)


class Readings(unittest.TestCase):
    def test_contacts_carry_the_weight(self):
        world = ts.World(gravity=[0, -10, 0, 0])
        floor = world.add(ts.Hyperplane([0, 1, 0, 0]))
        box = world.add(ts.Hyperbox([1, 1, 1, 1]), mass=3, position=[0, 0.5, 0, 0])
        world.step(steps=48)
        contacts = world.contacts()
        self.assertEqual(set(zip(contacts["a"].tolist(), contacts["b"].tolist())), {(floor, box)})
        np.testing.assert_allclose(contacts["impulse"].sum() * 240, 30, rtol=1e-6)
        np.testing.assert_allclose(contacts["normal"], np.tile([0, 1, 0, 0], (len(contacts), 1)), atol=1e-12)
        self.assertEqual(contacts["point"].shape, (len(contacts), 4))

    def test_changes_of_contacts_are_told_once(self):
        world = ts.World(gravity=[0, 0, 0, 0])
        a = world.add(ts.Hypersphere(0.5), velocity=[1, 0, 0, 0], restitution=1)
        b = world.add(ts.Hypersphere(0.5), position=[1.5, 0, 0, 0])
        began, ended = [], []
        for _ in range(240):
            world.step()
            changes = world.contact_changes()
            began += changes.began.tolist()
            ended += changes.ended.tolist()
        self.assertEqual((began, ended), ([[a, b]], [[a, b]]))

    def test_queries_find_what_is_there(self):
        world = ts.World()
        balls = [world.add(ts.Hypersphere(0.5), position=[3 * i, 0, 0, i]) for i in range(4)]
        hit = world.ray([-5, 0, 0, 0], [2, 0, 0, 0])
        self.assertEqual(hit.body, balls[0])
        self.assertAlmostEqual(hit.distance, 4.5)
        np.testing.assert_allclose(hit.normal, [-1, 0, 0, 0], atol=1e-12)
        self.assertIsNone(world.ray([-5, 0, 0, 0], [2, 0, 0, 0], reach=4))
        self.assertIsNone(world.ray([-5, 0, 0, 0], [-1, 0, 0, 0]))
        found = world.nearest([6, 2, 0, 2])
        self.assertEqual((found.body, round(found.distance, 12)), (balls[2], 1.5))
        self.assertIsNone(world.nearest([6, 2, 0, 2], reach=1))
        self.assertEqual(world.overlapping(ts.Hyperbox([3.5, 1, 1, 1.5]), [1.5, 0, 0, 0.5]).tolist(), balls[:2])
        turn = ts.rotor.from_planes(xw=np.pi / 2)
        self.assertEqual(world.overlapping(ts.Hyperbox([9, 0.1, 0.1, 0.1]), [0, 0, 0, 3], turn).tolist(), balls[:1])


class Numbers(unittest.TestCase):
    def test_random_calls_agree_with_a_model_of_them(self):
        for seed in range(20):
            random = np.random.default_rng(seed)
            world, model, next_id = ts.World(gravity=[0, 0, 0, 0]), {}, 0
            for _ in range(100):
                what = random.integers(6)
                if what <= 1:
                    position = random.uniform(-50, 50, 4)
                    self.assertEqual(world.add(ts.Hypersphere(0.1), position=position), next_id)
                    model[next_id] = position
                    next_id += 1
                elif what == 2 and model:
                    body = int(random.choice(list(model)))
                    world.remove(body)
                    del model[body]
                elif what == 3 and model:
                    body = int(random.choice(list(model)))
                    model[body] = random.uniform(-50, 50, 4)
                    world.set_state(body, position=model[body])
                elif what == 4 and model:
                    model = {body: random.uniform(-50, 50, 4) for body in model}
                    world.position = np.array(list(model.values()))
                elif what == 5 and next_id:
                    gone = int(random.integers(next_id))
                    self.assertEqual(gone in world, gone in model)
                    if gone not in model:
                        with self.assertRaises(ts.InputError):
                            world.remove(gone)
                self.assertEqual(len(world), len(model))
            self.assertEqual(world.ids.tolist(), list(model), f"seed {seed}")
            self.assertEqual(list(world), list(model))
            if model:
                np.testing.assert_array_equal(world.position, np.array(list(model.values())), f"seed {seed}")

    def test_types_are_told(self):
        world = ts.World()
        world.add(ts.Hyperplane([0, 1, 0, 0]))
        body = world.add(ts.Hyperbox([1, 2, 3, 4]), mass=2, friction=0.1, rolling_friction=0.2, restitution=0.3,
                         fixed_rotation=True, gravity_scale=0.5, damping=0.6, group=7, collides_with=[0, 7, 63])
        self.assertEqual(world.type(body), ts.BodyType(
            shape=ts.Hyperbox([1, 2, 3, 4]), mass=2, friction=0.1, rolling_friction=0.2, restitution=0.3,
            fixed_position=False, fixed_rotation=True, gravity_scale=0.5, damping=0.6, group=7, collides_with=(0, 7, 63)))
        self.assertEqual(world.type(0).mass, np.inf)
        self.assertIsNone(world.type(0).collides_with)

    def test_many_bodies_are_added_as_one_by_one(self):
        random = np.random.default_rng(3)
        position, velocity = random.uniform(-5, 5, (2, 40, 4))
        rotor = ts.rotor.exp(random.uniform(-1, 1, (40, 6)))
        one_by_one, at_once = ts.World(), ts.World()
        for world in (one_by_one, at_once):
            world.remove(world.add(ts.Hypersphere(1)))
        box, omega = ts.Hyperbox([1, 2, 3, 4]), [0, 0, 1, 0, 0, 0]
        for i in range(40):
            one_by_one.add(box, mass=2, group=3, position=position[i], rotor=rotor[i], velocity=velocity[i], angular_velocity=omega)
        ids = at_once.add_many(box, mass=2, group=3, position=position, rotor=rotor, velocity=velocity, angular_velocity=omega)
        self.assertEqual(ids.tolist(), list(range(1, 41)))
        self.assertEqual(at_once.save(), one_by_one.save())
        self.assertEqual(at_once.add_many(box, position=np.zeros((0, 4))).tolist(), [])
        before = at_once.save()
        for arguments, text in (
            ({}, "expected rows"),
            ({"position": [0, 1, 0, 0]}, "expected rows"),
            ({"position": position, "velocity": velocity[:3]}, "40 and 3 rows"),
            ({"position": np.zeros((2, 3))}, r"\(n, 4\), got \(2, 3\)"),
            ({"position": [[0] * 4, [0, np.nan, 0, 0]]}, r"position\[1\]\[1\] = nan"),
            ({"rotor": [[1] + [0] * 7, [2] + [0] * 7]}, "row 1: rotor: is no rotation"),
            ({"position": position, "mass": -1}, "mass = -1"),
        ):
            with self.assertRaisesRegex(ts.InputError, text):
                at_once.add_many(box, **arguments)
        self.assertEqual(at_once.save(), before)

    def test_masses_are_those_of_the_types(self):
        world = ts.World()
        world.add(ts.Hyperplane([0, 1, 0, 0]))
        gone = world.add(ts.Hypersphere(1), mass=7)
        world.add_many(ts.Hypersphere(1), mass=3, position=np.zeros((2, 4)))
        world.remove(gone)
        np.testing.assert_array_equal(world.masses, [np.inf, 3, 3])

    def test_settings_can_be_read(self):
        given = dict(steps_per_second=100.0, substeps=2, iterations=7, tolerance=1e-9, integrator="euler", sleeping=True, seed=5)
        world = ts.World(**given)
        for other in (world, copy.copy(world), pickle.loads(pickle.dumps(world))):
            self.assertEqual({name: getattr(other, name) for name in given}, given)
        self.assertEqual(ts.World().integrator, "midpoint")

    def test_what_stands_still_is_given_nothing_that_moves_it(self):
        world = ts.World()
        plane = ts.Hyperplane([0, 1, 0, 0])
        for given in ({"mass": 3}, {"gravity_scale": 0}, {"damping": 1}):
            with self.assertRaisesRegex(ts.InputError, f"{list(given)[0]} = .*a hyperplane never moves"):
                world.add(plane, **given)
        again = world.type(world.add(plane, friction=0.1, restitution=0.2))._asdict()
        self.assertEqual(world.type(world.add(**again))._asdict(), again)

    def test_groups_that_do_not_collide_pass_through_each_other(self):
        world = ts.World(gravity=[0, 0, 0, 0])
        world.add(ts.Hypersphere(0.5), velocity=[4, 0, 0, 0], group=1, collides_with=[0])
        world.add(ts.Hypersphere(0.5), position=[2, 0, 0, 0], group=1)
        world.step(steps=240)
        np.testing.assert_allclose(world.position[:, 0], [4, 2], atol=1e-12)


class Errors(unittest.TestCase):
    def test_bad_input_is_told_and_changes_nothing(self):
        world = ts.World()
        ball = world.add(ts.Hypersphere(1))
        before = world.save()
        cases = [
            (lambda: world.add(ts.Hypersphere(1), mass=float("nan")), "mass = nan"),
            (lambda: world.add(ts.Hypersphere(1), restitution=2), "restitution = 2"),
            (lambda: world.add(ts.Hypersphere(1), position=[1, 2, 3]), r"position: expected 4 numbers.*\(3,\)"),
            (lambda: world.add(ts.Hypersphere(1), rotor=[2, 0, 0, 0, 0, 0, 0, 0]), "rotor: is no rotation"),
            (lambda: world.add(ts.Hypersphere(1), group=64), "group = 64"),
            (lambda: world.add(ts.Hypersphere(1), collides_with=[-1]), "group -1"),
            (lambda: world.add(ts.Hyperplane([0, 1, 0, 0]), position=[0, 1, 0, 0]), "stands still"),
            (lambda: world.set_state(ball, velocity=[np.inf, 0, 0, 0]), "velocity.*inf"),
            (lambda: world.state(5), "5"),
            (lambda: world.state(-1), "-1"),
            (lambda: world.state(2**70), "none with this number"),
            (lambda: world.step(0), "0"),
            (lambda: world.step(steps=0), "steps = 0"),
            (lambda: world.ray([0] * 4, [0] * 4), "direction"),
            (lambda: setattr(world, "position", np.zeros((2, 4))), r"expected an array of shape \(1, 4\)"),
            (lambda: setattr(world, "position", np.zeros(4)), r"expected an array of shape \(1, 4\)"),
            (lambda: setattr(world, "gravity", [0, np.nan, 0, 0]), "gravity"),
            (lambda: setattr(world, "threads", -1), "threads = -1"),
            (lambda: ts.World(steps_per_second=0), "steps_per_second"),
            (lambda: ts.World(integrator="rk4"), "integrator"),
        ]
        for call, text in cases:
            with self.assertRaisesRegex(ts.InputError, text):
                call()
        for call in (lambda: world.state("ball"), lambda: world.add("ball"), lambda: world.apply_impulse(ball, "up")):
            with self.assertRaises(TypeError):
                call()
        self.assertEqual(world.save(), before)
        self.assertFalse("ball" in world)

    def test_a_body_that_leaves_the_finite_range_is_named(self):
        world = ts.World()
        world.add(ts.Hypersphere(1))
        world.add(ts.Hypersphere(1), position=[5, 0, 0, 0], velocity=[0, 0, 0, 1e14])
        before = world.position.copy()
        with self.assertRaisesRegex(ts.RunError, "1"):
            world.step(1e150, steps=3)
        np.testing.assert_array_equal(world.position, before)


class Threads(unittest.TestCase):
    def test_other_python_threads_run_while_a_world_steps(self):
        world, counted = heap(threads=1), 0
        stepping = threading.Thread(target=lambda: world.step(steps=200))
        stepping.start()
        begin = time.perf_counter()
        while stepping.is_alive() and time.perf_counter() - begin < 60:
            counted += 1
            time.sleep(0.001)
        stepping.join()
        self.assertAlmostEqual(world.time, 200 / 240)
        # With Python's lock held, not one turn would have come before the end.
        self.assertGreater(counted, 5)

    def test_a_world_that_is_stepped_elsewhere_refuses(self):
        world = heap(threads=1)
        stepping = threading.Thread(target=lambda: world.step(steps=200))
        stepping.start()
        refused = 0
        while stepping.is_alive():
            try:
                world.state(0)
                self.assertIsInstance(len(world), int)
            except RuntimeError as error:
                self.assertIn("stepped by another thread", str(error))
                refused += 1
            time.sleep(0.001)
        stepping.join()
        self.assertGreater(refused, 3)
        self.assertEqual(len(world), 61)  # and can be used again

    def test_worlds_of_several_numbers_of_threads_live_beside_each_other(self):
        program = """
import tesserae as ts
worlds = [ts.World(threads=n) for n in (1, 2, 4, 3, 8)]
for world in worlds:
    world.add_many(ts.Hypersphere(0.3), position=[[i, 0, 0, 0] for i in range(100)])
    world.step(steps=3)
assert len({world.save() for world in worlds}) == 1
"""
        ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
        self.assertEqual((ran.returncode, ran.stdout, ran.stderr), (0, "", ""))

    def test_ctrl_c_stops_between_steps(self):
        world = heap(count=20)
        signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have it ignored
        threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        begin = time.perf_counter()
        with self.assertRaises(KeyboardInterrupt):
            world.step(steps=10_000_000)
        self.assertLess(time.perf_counter() - begin, 3)
        self.assertGreater(world.time, 0)
        world.step()

    def test_ctrl_c_stops_amid_a_step_which_then_has_done_nothing(self):
        # A box that flies at 100 km/s into others makes all of them fast: a step takes seconds.
        world = ts.World(threads=2)
        box = ts.Hyperbox([0.3] * 4)
        places = np.stack(np.meshgrid(*[np.arange(10)] * 4), -1).reshape(-1, 4)
        world.add_many(box, position=0.31 * places + 1e-3 * np.sin(np.arange(40_000)).reshape(-1, 4))
        world.add(box, position=[-3, 1, 1, 1], velocity=[1e5, 0, 0, 0])
        world.step()
        before = world.save()
        signal.signal(signal.SIGINT, signal.default_int_handler)
        begin = time.perf_counter()
        threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            world.step()
        self.assertLess(time.perf_counter() - begin, 1.2)
        self.assertEqual(world.save(), before)


if __name__ == "__main__":
    unittest.main()
