# SPDX-License-Identifier: Apache-2.0
"""Joints against closed forms, and what is told of wrong ones."""

import unittest

import numpy as np

import tesserae as ts


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
        def held(type, steps_per_second=240, **keys):
            world = ts.World(gravity=[0, 0, 0, 0], steps_per_second=steps_per_second)
            a = world.add(ts.Hypersphere(0.5), fixed_position=True, fixed_rotation=True)
            b = world.add(ts.Hypersphere(0.5), position=[2, 0, 0, 0], velocity=[0, 1, 0.5, 0.25],
                          angular_velocity=[0, 0.3, 0, 0, 0.2, 0])
            joint = world.join(type, a, b, **keys)
            world.step(steps=steps_per_second // 2)
            self.assertEqual(world.joint_ids.tolist(), [joint])
            return world.state(b), world.joint(joint)

        centre = [2, 0, 0, 0]
        state, _ = held("point", anchor=centre)
        np.testing.assert_allclose(state.position, centre, atol=1e-6)
        state, _ = held("weld", anchor=centre)
        np.testing.assert_allclose(state.rotor, ts.rotor.identity(), atol=1e-6)
        # A step ends in the middle of a chord of the circle, v h long: (v h)^2 / 8 r inside.
        square = 1 + 0.5**2 + 0.25**2
        for type, keys, radius in (("distance", {}, 2), ("rope", {"length": 2.05}, 2.05)):
            for rate in (120, 240, 480):
                state, _ = held(type, rate, **keys)
                speed = np.linalg.norm(state.velocity)
                inside = (speed / rate) ** 2 / (8 * radius)
                self.assertAlmostEqual((radius - np.linalg.norm(state.position)) / inside, 1, places=3, msg=f"{type} {rate}")
        state, reading = held("slider", axis=[0, 1, 0, 0])
        np.testing.assert_allclose(state.position, [2, 0.5, 0, 0], atol=1e-13)
        self.assertAlmostEqual(reading.position, 0.5, places=13)
        state, _ = held("general", anchor=centre, free=["z", "yw"], limits={"z": (-1, 0.1)})
        np.testing.assert_allclose(state.position, [2, 0, 0.1, 0], atol=1e-13)
        np.testing.assert_allclose(state.rotor, ts.rotor.from_planes(yw=0.1), atol=1e-13)
        state, _ = held("swivel", anchor=centre, axis=[1, 0, 0, 0])
        np.testing.assert_allclose(ts.rotor.rotate(state.rotor, [1, 0, 0, 0]), [1, 0, 0, 0], atol=1e-6)
        # On its circle a spring is longer by m v^2 / k r; the damping has ended all else. The error
        # is of second order in the step.
        longer = [np.linalg.norm(held("spring", rate, length=2, stiffness=1e4, damping_force=100)[0].position) - 2
                  for rate in (240, 480, 960)]
        errors = np.array(longer) - square / 2 / 1e4
        self.assertLess(abs(errors[0]), 2e-6)
        np.testing.assert_allclose(errors[:-1] / errors[1:], 4, rtol=0.1)
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
            (("point",), {"anchr": [0] * 4}, r"^point joint: anchor is missing, and there is 'anchr': expected the point"),
            (("hinge",), {"anchor": [0] * 4, "plane": "xy", "limit": (-1, 1)}, "unknown key 'limit': expected .*did you mean \"limits\""),
            (("hinge",), {"anchor": [0] * 4, "plane": 3}, r"^joint\.plane: expected two axes"),
            (("general",), {"anchor": [0] * 4, "free": [3]}, 'free coordinate "3"'),
            # All by the keys that were typed.
            (("hinge",), {"anchor": [0] * 4, "plane": "xy", "limits": (-4, 1)}, r"^joint\.limits = -4: expected a number from -3\.14"),
            (("hinge",), {"anchor": [0] * 4, "plane": "xy", "limits": (1, 2)}, r"^joint\.limits: expected limits with 0 between"),
            (("hinge",), {"anchor": [0] * 4, "plane": "xy", "motor": {"speed": 1, "max": 0}}, r"^joint\.motor\.max = 0: "),
            (("slider",), {"axis": [0] * 4}, r"^joint\.axis: expected a direction"),
            (("slider",), {"axis": [1, 0, 0, 0], "motor": {}}, r"^joint\.motor\.speed: expected a speed, or a target"),
            (("spring",), {"anchor_b": [3, 0, 0, 0]}, r"^joint\.frequency: expected one in Hz, or a stiffness"),
            (("spring",), {"anchor_b": [3, 0, 0, 0], "frequency": -1}, r"^joint\.frequency = -1: "),
            (("spring",), {"anchor_b": [3, 0, 0, 0], "frequency": 1, "stiffness": 1}, r"^joint\.stiffness: there is a frequency too"),
            (("general",), {"anchor": [0] * 4, "free": ["yw"], "limits": {"yw": (2, -2)}}, r"^joint\.limits\.yw: expected \[low, high\]"),
            (("general",), {"anchor": [0] * 4, "free": ["y"], "spring": {"y": {"damping": 1}}}, r"^joint\.spring\.y\.frequency: "),
            (("general",), {"anchor": [0] * 4, "free": ["y"], "motor": {"y": {"speed": 1, "frequency": 1}}}, r"^joint\.motor\.y\.frequency: goes with"),
            (("general",), {"anchor": [0] * 4, "free": ["y"], "rotor": [2] + [0] * 7}, r"^joint\.rotor: is no rotation"),
            (("general",), {"anchor": [0] * 4, "free": []}, r"^joint\.free: expected at least one"),
            (("point",), {"anchor": [0] * 4, "breaks": {}}, r"^joint\.breaks\.force: expected one in N, or a torque"),
            (("point",), {"anchor": [0] * 4, "breaks": {"torque": -1}}, r"^joint\.breaks\.torque = -1: "),
        ]
        for arguments, keys, text in cases:
            with self.assertRaisesRegex(ts.InputError, text):
                world.join(*arguments, a, **keys)
        for keys, text in (({"collide": "yes"}, r"^joint\.collide: expected True or False, got 'yes'"),
                           ({"breaks": {"force": "big"}}, r"^joint\.breaks\.force: expected a number, got 'big'"),
                           ({"breaks": 3}, r"^joint\.breaks: expected a dict, got 3")):
            with self.assertRaisesRegex(TypeError, text):
                world.join("point", a, anchor=[0] * 4, **keys)
        for number in (-1, 7, 2**70, "axle", None):
            self.assertFalse(world.has_joint(number))
        with self.assertRaisesRegex(ts.InputError, "a = 7|body 7"):
            world.join("point", 7, anchor=[0] * 4)


if __name__ == "__main__":
    unittest.main()
