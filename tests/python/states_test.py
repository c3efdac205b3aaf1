# SPDX-License-Identifier: Apache-2.0
"""The whole state of worlds: copies, pickles and bytes."""

import copy
import pickle
import unittest

import numpy as np

import tesserae as ts
from heaps import heap


class Lab(ts.World):
    """A world with attributes of its own."""

    def __init__(self, name):
        super().__init__(threads=2)
        self.name, self.log = name, [1, 2]
        self.itself = self
        self.add_many(ts.Hypersphere(0.3), position=np.arange(20.0).reshape(5, 4))


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

    def test_copies_and_pickles_are_of_the_same_class_with_the_same_attributes(self):
        world = Lab("first")
        world.step(steps=10)
        before = world.save()
        for other in (copy.copy(world), copy.deepcopy(world), *(pickle.loads(pickle.dumps(world, p)) for p in range(6))):
            self.assertIs(type(other), Lab)
            self.assertEqual((other.name, other.save(), other.threads), ("first", before, 2))
            self.assertEqual(other.log, world.log)
        self.assertIs(copy.copy(world).log, world.log)
        deep = copy.deepcopy(world)
        self.assertIsNot(deep.log, world.log)
        self.assertIs(deep.itself, deep)  # what leads back to it does so to the copy
        self.assertIs(pickle.loads(pickle.dumps(world)).itself.__class__, Lab)
        deep.step(steps=5)
        self.assertEqual(world.save(), before)
        self.assertIs(type(Lab.load(before)), ts.World)

        class Slotted(ts.World):
            __slots__ = ("name",)

        for call in (copy.copy, copy.deepcopy, pickle.dumps):
            self.assertRaisesRegex(TypeError, "Slotted: has __slots__", call, Slotted())

    def test_any_bytes_are_loaded(self):
        data = heap(count=5).save()
        for kind in (bytes, bytearray, memoryview, lambda b: np.frombuffer(b, np.uint8)):
            self.assertEqual(ts.World.load(kind(data)).save(), data)
        for wrong in ("text", 5, None, memoryview(data)[::2]):
            with self.assertRaisesRegex(TypeError, r"data: expected the bytes of save\(\), got"):
                ts.World.load(wrong)

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


if __name__ == "__main__":
    unittest.main()
