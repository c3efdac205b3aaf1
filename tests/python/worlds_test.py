# SPDX-License-Identifier: Apache-2.0
"""Worlds against closed forms, and what they promise: numbers, threads, copies, errors."""

import copy
import os
import pickle
import signal
import threading
import time
import unittest

import numpy as np

import tesserae as ts


def heap(threads=0, count=60, **settings):
    """Shapes of several kinds that fall onto a floor."""
    random = np.random.default_rng(1)
    world = ts.World(threads=threads, **settings)
    world.add(ts.Hyperplane([0, 1, 0, 0]))
    shapes = [ts.Hypersphere(0.3), ts.Hyperbox([0.5, 0.4, 0.6, 0.5]), ts.Hypercapsule(0.2, 0.5),
              ts.Duocylinder([0.3, 0.25])]
    for i in range(count):
        world.add(shapes[i % 4], position=random.uniform(-1, 1, 4) + [0, 3, 0, 0], mass=1 + i % 3)
    return world


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

    def test_groups_that_do_not_collide_pass_through_each_other(self):
        world = ts.World(gravity=[0, 0, 0, 0])
        world.add(ts.Hypersphere(0.5), velocity=[4, 0, 0, 0], group=1, collides_with=[0])
        world.add(ts.Hypersphere(0.5), position=[2, 0, 0, 0], group=1)
        world.step(steps=240)
        np.testing.assert_allclose(world.position[:, 0], [4, 2], atol=1e-12)


class Joints(unittest.TestCase):
    def test_a_hinge_swings_as_a_pendulum(self):
        world = ts.World(gravity=[0, -10, 0, 0], steps_per_second=2000)
        ball = ts.Hypersphere(0.1)
        bob = world.add(ball, mass=2, position=[0.05, -1, 0, 0])
        hinge = world.join("hinge", bob, anchor=[0, 0, 0, 0], plane="xy")
        length = np.hypot(0.05, 1)
        inertia = 2 * ball.second_moments()[0] + length**2  # per kg
        period = 2 * np.pi * np.sqrt(inertia / (10 * length)) * (1 + np.arctan(0.05) ** 2 / 16)
        crossings, before = [], world.position[0, 0]
        while len(crossings) < 3:
            world.step()
            now = world.position[0, 0]
            if before > 0 >= now or before < 0 <= now:
                crossings.append(world.time + now / (before - now) / 2000)
            before = now
        # A step of 0.5 ms: its error is of second order, 1e-6 of the period.
        self.assertAlmostEqual((crossings[2] - crossings[0]) / period, 1, delta=1e-4)
        reading = world.joint(hinge)
        self.assertEqual((reading.a, reading.b, reading.broken), (bob, None, False))
        self.assertLess(reading.error, 1e-6)

    def test_each_type_holds_what_it_says(self):
        def held(type, **keys):
            world = ts.World(gravity=[0, 0, 0, 0])
            a = world.add(ts.Hypersphere(0.5), fixed_position=True, fixed_rotation=True)
            b = world.add(ts.Hypersphere(0.5), position=[2, 0, 0, 0], velocity=[0, 1, 0.5, 0.25],
                          angular_velocity=[0, 0.3, 0, 0, 0.2, 0])
            joint = world.join(type, a, b, **keys)
            world.step(steps=120)
            self.assertEqual(world.joint_ids.tolist(), [joint])
            return world.state(b), world.joint(joint)

        centre = [2, 0, 0, 0]
        state, _ = held("point", anchor=centre)
        np.testing.assert_allclose(state.position, centre, atol=1e-6)
        state, _ = held("weld", anchor=centre)
        np.testing.assert_allclose(state.rotor, ts.rotor.identity(), atol=1e-6)
        state, _ = held("distance")
        self.assertAlmostEqual(np.linalg.norm(state.position), 2, places=4)
        state, _ = held("rope", length=2.2)
        self.assertLess(np.linalg.norm(state.position), 2.2 + 1e-4)
        state, reading = held("slider", axis=[0, 1, 0, 0])
        np.testing.assert_allclose(state.position, [2, 0.5, 0, 0], atol=1e-3)
        self.assertAlmostEqual(reading.position, 0.5, places=3)
        state, _ = held("general", anchor=centre, free=["z", "yw"], limits={"z": (-1, 0.1)})
        np.testing.assert_allclose(state.position, [2, 0, 0.1, 0], atol=1e-3)
        np.testing.assert_allclose(state.rotor, ts.rotor.from_planes(yw=0.1), atol=1e-6)
        state, _ = held("swivel", anchor=centre, axis=[1, 0, 0, 0])
        np.testing.assert_allclose(ts.rotor.rotate(state.rotor, [1, 0, 0, 0]), [1, 0, 0, 0], atol=1e-6)
        state, _ = held("spring", length=2, stiffness=1e4, damping_force=100)
        self.assertAlmostEqual(np.linalg.norm(state.position), 2, places=3)
        _, reading = held("distance", breaks={"force": 1e-3})
        self.assertTrue(reading.broken)

    def test_motors_drive(self):
        world = ts.World(gravity=[0, 0, 0, 0])
        wheel = world.add(ts.Hypersphere(1))
        hinge = world.join("hinge", wheel, anchor=[0, 0, 0, 0], plane=([1, 0, 0, 0], [0, 0, 0, 1]), motor={"speed": 3})
        world.step(steps=120)
        np.testing.assert_allclose(world.angular_velocity[0], [0, 0, 3, 0, 0, 0], atol=1e-6)
        world.remove_joint(hinge)
        self.assertFalse(world.has_joint(hinge))
        self.assertEqual(len(world.joint_ids), 0)

    def test_bad_joints_are_told(self):
        world = ts.World()
        a = world.add(ts.Hypersphere(1))
        cases = [
            (("hing",), {}, 'type "hing": expected one of point'),
            (("hinge",), {"anchor": [0] * 4}, "plane is missing"),
            (("hinge",), {"anchor": [0] * 4, "plane": "xq"}, 'axis "q"'),
            (("hinge",), {"anchor": [0] * 4, "plane": "xy", "length": 3}, "unknown key 'length'.*anchor, plane"),
            (("hinge",), {"anchor": [0] * 4, "plane": "xy", "motor": {"sped": 3}}, "joint.motor: unknown key 'sped'"),
            (("general",), {"anchor": [0] * 4, "free": ["x"], "limits": {"y": (0, 1)}}, "limits.y: this coordinate is held"),
            (("general",), {"anchor": [0] * 4, "free": "zw"}, "free: expected a list"),
            (("general",), {"anchor": [0] * 4, "free": ["q"]}, 'free coordinate "q"'),
            (("point",), {"anchor": [0, 0, 0, np.nan]}, "anchor.*nan"),
            (("distance",), {}, "anchors"),
        ]
        for arguments, keys, text in cases:
            with self.assertRaisesRegex(ts.InputError, text):
                world.join(*arguments, a, **keys)
        with self.assertRaisesRegex(ts.InputError, "a = 7|body 7"):
            world.join("point", 7, anchor=[0] * 4)


class States(unittest.TestCase):
    def test_any_number_of_threads_gives_the_same_bytes(self):
        states = set()
        for threads in (1, 2, 4):
            world = heap(threads)
            world.step(steps=120)
            states.add(world.save())
        self.assertEqual(len(states), 1)

    def test_copies_and_pickles_go_on_with_the_same_bits(self):
        world = heap(sleeping=True)
        world.join("rope", 5, 6, length=3)
        world.step(steps=100)
        world.remove(3)
        others = [pickle.loads(pickle.dumps(world)), copy.copy(world), copy.deepcopy(world),
                  ts.World.load(world.save(), threads=2)]
        self.assertEqual(others[3].threads, 2)
        world.step(steps=60)
        for other in others:
            other.step(steps=60)
            self.assertEqual(other.save(), world.save())
            self.assertEqual(other.position.tobytes(), world.position.tobytes())
        self.assertEqual(others[0].add(ts.Hypersphere(1)), 61)  # numbers go on, too

    def test_one_call_of_many_steps_is_many_calls_of_one(self):
        a, b = heap(), heap()
        a.step(steps=30)
        for _ in range(30):
            report = b.step()
        self.assertEqual(a.save(), b.save())
        self.assertGreater(report.contacts, 0)

    def test_damaged_bytes_are_refused(self):
        data = heap(count=5).save()
        for wrong in (b"", data[:-1], data[:50], data + b"x", bytes([data[0] ^ 1]) + data[1:]):
            with self.assertRaises(ts.InputError):
                ts.World.load(wrong)


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


if __name__ == "__main__":
    unittest.main()
