"""Walls and groups of grains that functions move."""
import math
import unittest

import dovetail as dv
import numpy as np

from test_run import beads


def floor(**motion):
    scene = beads(2)
    scene["walls"][0].update(motion)
    return scene


def gap(one, other):
    return np.abs(one.grains.x - other.grains.x).max()


class Walls(unittest.TestCase):
    def compare(self, scene, steps=3000, tolerance=1e-9, **motion):
        """A floor that a scene moves, and one that functions move."""
        one, other = dv.Run(scene), dv.Run(floor())
        other.move_wall("floor", **motion)
        rest = dv.Run(floor())
        for run in (one, other, rest):
            run.advance(steps)
        self.assertLess(gap(one, other), tolerance)
        self.assertGreater(gap(one, rest), 1e-4)
        brought = one.ledger["particles: work of walls and drives (minus)"]
        self.assertGreater(abs(brought), 1e-5)
        self.assertAlmostEqual(other.ledger["particles: work of walls and drives (minus)"], brought, 9)
        self.assertLess(abs(other.ledger["residual"]), 1e-2 * abs(brought))
        momenta = other.totals["residual"]["linear"]
        self.assertLess(np.abs(momenta).max(), 1e-12 * other.totals["turned_over"])

    def test_displacement(self):
        self.compare(floor(displacement=[0, 0, "0.002*sin(300*t)"]),
                     displacement=lambda t: [0, 0, 0.002 * math.sin(300 * t)])

    def test_velocity(self):
        self.compare(floor(velocity=[0.05, 0, "0.3*cos(200*t)"]),
                     velocity=lambda t: np.array([0.05, 0, 0.3 * math.cos(200 * t)]))

    def test_angular_velocity(self):
        self.compare(floor(turn={"axis": [0, 1, 0], "angle": "0.1*sin(100*t)", "point": [0.01, 0, 0]}), tolerance=1e-7,
                     angular_velocity=lambda t: 10 * math.cos(100 * t), axis=[0, 2, 0], point=[0.01, 0, 0])

    def test_goes_on_from_where_the_wall_is(self):
        scene = beads(1, spin=False)
        scene["walls"][0]["velocity"] = [0, 0, 0.1]
        run = dv.Run(scene)
        run.advance(1000)
        run.move_wall(0, displacement=lambda t: [0, 0, 7.0])  # it stops
        run.advance(20000)
        height = 0.1 * 1000 * 2e-5
        self.assertAlmostEqual(run.grains.x[0, 2], height + 0.01, delta=1e-3)
        run.move_wall("floor", velocity=lambda t: [0, 0, 0.2])
        run.advance(2000)
        self.assertAlmostEqual(run.grains.x[0, 2], height + 0.01 + 0.2 * 2000 * 2e-5, delta=2e-3)

    def test_takes_the_place_of_a_servo(self):
        scene = beads(2)
        scene["walls"].append({"shape": "plane", "name": "lid", "point": [0, 0, 0.06], "normal": [0, 0, -1],
                               "servo": {"keeps": "force", "force": -0.5, "axis": [0, 0, 1]}})
        run = dv.Run(scene)
        run.advance(500)
        run.move_wall("lid", velocity=lambda t: [0, 0, 1.0])
        run.advance(500)
        self.assertLess(abs(run.ledger["residual"]), 1e-3)

    def test_of_triangles(self):
        wall = {"shape": "mesh", "name": "floor",
                "file": {"points": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]],
                         "triangles": np.array([[0, 1, 2], [0, 2, 3]])}}
        one, other = dv.Run({**beads(2), "walls": [wall]}), dv.Run(beads(2))
        for run in (one, other):
            run.move_wall("floor", velocity=lambda t: [0, 0, 0.3 * math.cos(200 * t)])
            run.advance(2000)
        self.assertLess(gap(one, other), 1e-6)

    def test_states_go_on(self):
        def made():
            run = dv.Run(beads(2))
            run.move_wall("floor", velocity=lambda t: [0, 0, 0.3 * math.cos(200 * t)])
            return run

        one, other = made(), made()
        one.advance(500)
        state = one.save()
        one.advance(500)
        other.load(state)
        other.advance(500)
        np.testing.assert_array_equal(one.grains.x, other.grains.x)
        self.assertEqual(one.save(), other.save())

    def test_what_functions_raise_comes_through(self):
        run = dv.Run(beads(2))

        def late(t):
            if t > 1e-3:
                raise KeyError("no such time")
            return [0, 0, 0]

        run.move_wall("floor", velocity=late)
        with self.assertRaisesRegex(KeyError, "no such time"):
            run.advance(100)
        with self.assertRaisesRegex(dv.InputError, "broken off"):
            run.advance(1)

    def test_refused(self):
        run = dv.Run(beads(2))
        state, still = run.save(), lambda t: [0, 0, 0]
        for wall, motion, told in (("flor", {"velocity": still}, 'no wall "flor".*floor'),
                                   (3, {"velocity": still}, "no wall 3"),
                                   ("floor", {"velocity": still, "displacement": still}, "both a velocity and"),
                                   ("floor", {}, "no motion is given"),
                                   ("floor", {"angular_velocity": lambda t: 1.0}, "has no length"),
                                   ("floor", {"velocity": lambda t: [0, 0]}, r"shape is \(2\) \[velocity of wall"),
                                   ("floor", {"displacement": lambda t: [0, 0, math.inf]}, "not finite"),
                                   ("floor", {"angular_velocity": lambda t: math.nan, "axis": [0, 0, 1]}, "not finite")):
            with self.subTest(told), self.assertRaisesRegex(dv.InputError, told):
                run.move_wall(wall, **motion)
        self.assertEqual(run.save(), state)
        run.advance(1)
        scene = beads(2)
        scene["periodic"] = {"box": [[-0.1, -0.1, -0.1], [0.1, 0.1, 0.2]], "axes": ["x"]}
        with self.assertRaisesRegex(dv.InputError, "out of the period"):
            dv.Run(scene).move_wall("floor", angular_velocity=lambda t: 1.0, axis=[0, 1, 0])


class Groups(unittest.TestCase):
    def test_move_as_they_are_told(self):
        scene = beads(2)
        for sphere in scene["particles"][0]["spheres"]:
            sphere["velocity"] = [0, 0, 0]
        run = dv.Run(scene)
        run.advance(100)
        ids = run.grains.id[run.grains.x[:, 2] > 0.03]
        self.assertEqual(len(ids), 4)
        begin, since = run.grains.x, run.time
        run.drive(ids, velocity=lambda t: [0, 0, -0.2 * math.cos(50 * (t - since))], spin=lambda t: [0, 0, 3])
        run.advance(3000)
        moved = -0.2 / 50 * math.sin(50 * (run.time - since))
        np.testing.assert_allclose(run.grains.x[ids], begin[ids] + [0, 0, moved], atol=1e-12)
        np.testing.assert_allclose(run.grains.omega[ids], 4 * [[0, 0, 3]])
        self.assertGreater(abs(run.ledger["particles: work of walls and drives (minus)"]), 1e-5)
        self.assertLess(abs(run.ledger["residual"]), 1e-3)
        self.assertLess(np.abs(run.totals["residual"]["linear"]).max(), 1e-12 * run.totals["turned_over"])

    def test_displacement_counts_from_now(self):
        run = dv.Run(beads(2))
        run.advance(50)
        begin, since = run.grains.x, run.time
        run.drive([0], displacement=lambda t: [0.1 * t, 5, 0])
        run.advance(50)
        np.testing.assert_allclose(run.grains.x[0], begin[0] + [0.1 * (run.time - since), 0, 0], atol=1e-14)

    def test_turn_as_a_whole(self):
        run = dv.Run({**beads(2), "walls": [], "gravity": [0, 0, 0]})
        begin = run.grains.x
        run.drive(run.grains.id, angular_velocity=lambda t: 2.0, axis=[0, 0, 5], point=[0, 0, 0])
        run.advance(2000)
        angle = 2 * run.time
        turn = [[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]]
        np.testing.assert_allclose(run.grains.x, begin @ np.transpose(turn), atol=1e-9)
        np.testing.assert_allclose(run.grains.omega, 8 * [[0, 0, 2]])

    def test_clumps_move_in_whole(self):
        scene = beads(2)
        scene["clumps"] = [{"density": 2500, "at": [0, 0, 0.2],
                            "spheres": [{"at": [0, 0, 0], "radius": 0.01}, {"at": [0.01, 0, 0], "radius": 0.01}]}]
        run = dv.Run(scene)
        begin = run.grains.x
        with self.assertRaisesRegex(dv.InputError, "clump"):
            run.drive([8], velocity=lambda t: [0, 0, 0])
        run.drive([8, 9], velocity=lambda t: [0.5, 0, 0])
        run.advance(100)
        np.testing.assert_allclose(run.grains.x[8:], begin[8:] + [0.5 * run.time, 0, 0], atol=1e-12)

    def test_refused(self):
        run, smooth = dv.Run(beads(2)), dv.Run(beads(2, spin=False))
        still = lambda t: [0, 0, 0]
        run.drive([0], velocity=still)
        state = run.save()
        for ids, motion, told in (([8], {"velocity": still}, "no grain 8"), ([0], {"velocity": still}, "driven already"),
                                  ([1, 1], {"velocity": still}, "driven already"), ([], {"velocity": still}, "no grains"),
                                  ([1], {}, "no motion"), ([1], {"velocity": lambda t: 1}, "shape"),
                                  ([1], {"angular_velocity": lambda t: 1, "axis": [0, 0, 1]}, "no point on its axis"),
                                  ([1], {"angular_velocity": lambda t: 1, "axis": [0, 0, 1], "point": [0, 0, 0],
                                         "spin": still}, "both a spin and a turn")):
            with self.subTest(told), self.assertRaisesRegex(dv.InputError, told):
                run.drive(ids, **motion)
        self.assertEqual(run.save(), state)
        with self.assertRaisesRegex(dv.InputError, "do not spin"):
            smooth.drive([0], spin=still)
        scene = beads(2)
        scene["periodic"] = {"box": [[-0.1, -0.1, -0.1], [0.1, 0.1, 0.2]], "axes": ["x"]}
        with self.assertRaisesRegex(dv.InputError, "periodic space"):
            dv.Run(scene).drive([0], angular_velocity=lambda t: 1, axis=[0, 0, 1], point=[0, 0, 0])


if __name__ == "__main__":
    unittest.main()
