"""Solids whose forces are functions of numpy arrays: on their surface, and in an overlap."""
import unittest

import dovetail as dv
import numpy as np

from test_arrays import brick


class Net:
    """Point masses and springs between them, which grains hit."""
    stiffness = 400.0

    def __init__(self, n=11, width=1.0):
        number = np.arange(n * n).reshape(n, n)
        self.X = width / (n - 1) * np.stack([number % n, number // n, 0 * number], axis=-1).reshape(-1, 3)
        self.mass = np.full(n * n, 0.01)
        self.faces = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]],
                              axis=-1).reshape(-1, 4)
        self.springs = np.concatenate([np.stack([number[:, :-1], number[:, 1:]], axis=-1).reshape(-1, 2),
                                       np.stack([number[:-1], number[1:]], axis=-1).reshape(-1, 2)])
        self.length = np.linalg.norm(self.X[self.springs[:, 1]] - self.X[self.springs[:, 0]], axis=1)

    def stretch(self, u):
        x = self.X + u
        along = x[self.springs[:, 1]] - x[self.springs[:, 0]]
        distance = np.linalg.norm(along, axis=1)
        return distance - self.length, along / distance[:, None]

    def forces(self, t, u, v):
        stretch, along = self.stretch(u)
        f, pull = np.zeros_like(u), self.stiffness * stretch[:, None] * along
        np.add.at(f, self.springs[:, 0], pull)
        np.add.at(f, self.springs[:, 1], -pull)
        return f

    def energy(self, u):
        return 0.5 * self.stiffness * (self.stretch(u)[0] ** 2).sum()


def balls(**steps):
    k = np.arange(4)
    at = np.stack([0.3 + 0.4 * (k % 2), 0.33 + 0.38 * (k // 2), 0 * k + 0.1], axis=-1)
    return {"contact": {"law": "linear", "stiffness": 2000},
            "particles": [{"from": "list", "density": 150,
                           "spheres": {"at": at, "radius": 0.05 + 0.01 * k,
                                       "velocity": np.stack([0 * k + 0.1, 0 * k, -1 - 0.2 * k], axis=-1)}}],
            "steps": {"dt": 5e-5, **steps}, "stages": [{"do": "run", "time": 0.4}]}


def losses(run, steps, every=100):
    """Largest loss of energy over that at the start, and of momentum."""
    energy, before = run.kinetic_energy, run.totals["momentum"]
    largest = max(abs(run.ledger["residual"]) for _ in run.steps(steps, every))
    return largest / energy, np.linalg.norm(run.totals["momentum"] - before) / np.linalg.norm(before)


class OnTheSurface(unittest.TestCase):
    def test_momentum_and_energy_are_kept(self):
        run = dv.Run(balls(), solids={"net": Net()})
        energy, momentum = losses(run, 8000)
        self.assertLess(momentum, 1e-13)
        self.assertLess(energy, 1e-5)
        self.assertGreater(run.ledger["net: own forces"], 0.01)
        self.assertAlmostEqual(run.ledger["net: own forces"], Net().energy(run.solids["net"].u), 14)
        self.assertLess(np.abs(run.totals["residual"]["linear"]).max(), 1e-12)

    def test_work_of_forces_without_an_energy_is_booked(self):
        class Without(Net):
            energy = None

        one, other = dv.Run(balls(), solids={"net": Net()}), dv.Run(balls(), solids={"net": Without()})
        one.advance(3000)
        other.advance(3000)
        np.testing.assert_array_equal(one.grains.x, other.grains.x)
        self.assertLess(abs(other.ledger["residual"]), 1e-4 * other.kinetic_energy)

    def test_sub_steps(self):
        run = dv.Run(balls(per_macro_step=4), solids={"net": Net()})
        energy, momentum = losses(run, 2000)
        self.assertLess(momentum, 1e-13)
        self.assertLess(energy, 1e-5)

    def test_states_go_on(self):
        one, other = (dv.Run(balls(), solids={"net": Net()}) for _ in range(2))
        one.advance(1500)
        state = one.save()
        one.advance(500)
        other.load(state)
        other.advance(500)
        self.assertEqual(one.save(), other.save())

    def test_limit_of_the_step_is_that_of_the_stiffest_motion(self):
        class Pair(Net):
            def __init__(self):
                super().__init__(2, 1.0)
                self.springs = self.springs[:1]
                self.length = self.length[:1]

        run = dv.Run(balls(), solids={"pair": Pair()})
        (limit,) = [dt for dt, owner in run.limits if "part 0" in owner and "pair" in owner]
        exact = 2 / np.sqrt(2 * Pair.stiffness / 0.01)
        self.assertLessEqual(limit, exact * (1 + 1e-9))
        self.assertGreater(limit, 0.99 * exact)
        told = Pair()
        told.critical_step = 1e-3
        self.assertIn(1e-3, [dt for dt, _ in dv.Run(balls(), solids={"pair": told}).limits])
        with self.assertRaisesRegex(dv.InputError, "critical step"):
            dv.Run(balls(dt=2 * exact), solids={"pair": Pair()})

    def test_nodes_that_are_held(self):
        net = Net()
        net.held = np.flatnonzero((net.X[:, 0] == 0) | (net.X[:, 0] == 1))
        run = dv.Run(balls(), solids={"net": net})
        run.advance(4000)
        solid = run.solids["net"]
        self.assertEqual(np.abs(solid.u[net.held]).max(), 0)
        self.assertGreater(np.abs(solid.reactions()[net.held]).max(), 0.1)
        self.assertLess(abs(run.ledger["residual"]), 1e-4)
        self.assertIn("net: supports", run.totals["given"])

    def test_beside_solids_of_the_scene(self):
        scene = balls()
        scene["solids"] = [{"name": "block", "mesh": "box", "cells": [2, 2, 1], "box": [[0, 0, -0.3], [1, 1, -0.2]],
                            "stepping": "implicit", "supports": [{"on": "z-"}],
                            "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0.3,
                                         "density": 1000}}]
        scene["couplings"] = [{"type": "surface", "solid": "block"}]
        run = dv.Run(scene, solids={"net": Net()})
        run.advance(3000)
        self.assertEqual(list(run.solids), ["block", "net"])
        self.assertLess(abs(run.ledger["residual"]), 1e-3)

    def test_beside_what_else_a_run_has(self):
        snow = {"name": "snow", "mesh": "points", "grid": {"spacing": 0.1}, "velocity": [0, 0, -1],
                "points": {"from": "box", "box": [[0.3, 0.3, 0.06], [0.7, 0.7, 0.3]]},
                "material": {"law": "neo-Hookean", "youngs_modulus": 1e4, "poisson_ratio": 0.3, "density": 50}}
        stream = {"region": [[0.3, 0.3, 0.4], [0.7, 0.7, 0.7]], "radius": {"smallest": 0.03, "largest": 0.04},
                  "density": 150, "number_per_second": 200, "velocity": [0, 0, -1]}
        for beside in ({"periodic": {"box": [[0, 0, -1], [1.2, 1.2, 2]], "axes": ["x", "y"]}}, {"insertions": [stream]},
                       {"particles": [], "solids": [snow], "couplings": [{"type": "points", "solid": "snow"}]}):
            with self.subTest(next(iter(beside))):
                run = dv.Run({**balls(), **beside}, solids={"net": Net()})
                energy = run.kinetic_energy
                for _ in run.steps(1500, 250):
                    energy = max(energy, run.kinetic_energy)
                totals = run.totals
                self.assertGreater(run.ledger["net: own forces"], 1e-3)
                self.assertLess(abs(run.ledger["residual"]), 1e-4 * energy)
                self.assertLess(np.linalg.norm(totals["residual"]["linear"]), 1e-12 * totals["turned_over"])

    def test_velocities_at_the_start_and_cells(self):
        X, cells = brick((2, 2, 1), (1, 1, 0.2))

        class Rigid:
            def __init__(self):
                self.X, self.cells, self.mass, self.v = X - [0, 0, 0.2], cells, 0.5, [0, 0, 2.0]

            def forces(self, t, u, v):
                return 0 * u

        rigid = Rigid()
        rigid.critical_step = 1.0
        run = dv.Run(balls(), solids={"block": rigid})
        run.advance(200)
        self.assertLess(run.solids["block"].v[:, 2].min(), 2.0)  # its skin has met grains
        self.assertEqual(run.solids["block"].v[:, 2].shape, (18,))

    def test_what_they_raise_comes_through(self):
        class Breaking(Net):
            def forces(self, t, u, v):
                if t > 1e-3:
                    raise KeyError("no such spring")
                return super().forces(t, u, v)

        run = dv.Run(balls(), solids={"net": Breaking()})
        with self.assertRaisesRegex(KeyError, "no such spring"):
            run.advance(100)
        with self.assertRaisesRegex(dv.InputError, "broken off"):
            run.advance(1)

    def test_refused(self):
        faces = Net().faces
        for change, told in (({"X": None}, 'no X .solid "net"'), ({"X": np.zeros((0, 3))}, "no nodes"),
                             ({"X": np.zeros((3, 2))}, "shape is"), ({"mass": 0.0}, "node 0 has no mass"),
                             ({"mass": np.ones(5)}, "5 numbers for 121 nodes"),
                             ({"faces": faces + 2}, "names number 121 of 121"), ({"faces": faces[:, :2]}, "no faces"),
                             ({"faces": None}, "has no faces"), ({"faces": 0.5 * faces}, "integers"),
                             ({"critical_step": -1.0}, "not > 0"), ({"held": [121]}, "121"),
                             ({"forces": lambda t, u, v: u[1:]}, r"shape is \(120, 3\).*forces"),
                             ({"forces": lambda t, u, v: u + np.nan}, "not finite"),
                             ({"energy": lambda u: np.inf}, "not finite"), ({"v": np.zeros((2, 3))}, "shape")):
            net = Net()
            for name, value in change.items():
                setattr(net, name, value)
            with self.subTest(told), self.assertRaisesRegex((dv.InputError, dv.NumericalError), told):
                dv.Run(balls(), solids={"net": net})
        with self.assertRaisesRegex(dv.InputError, "has no forces"):
            dv.Run(balls(), solids={"net": object()})
        with self.assertRaisesRegex(dv.InputError, "of that name"):
            dv.Run(balls(), solids={"particles": Net()})


class Springs:
    """Springs along z on the cells of a box, of which it keeps the fraction 1 − w: the other half of a lattice."""
    modulus, density, edge, floor = 1e8, 1500.0, 0.1, 1e-3

    def __init__(self, across=2, along=20, overlapping=6):
        self.X, self.cells = brick((across, across, along), (across * self.edge, across * self.edge, along * self.edge))
        s = self.X[:, 2] / (overlapping * self.edge)
        self.grain_weight = w = np.where(s > 1 + 1e-9, 0, self.floor + (1 - 2 * self.floor) * (1 - np.minimum(s, 1)))
        part = lambda x, size: np.where((x < 1e-9) | (x > size - 1e-9), 0.5, 1.0)
        size = across * self.edge
        area = part(self.X[:, 0], size) * part(self.X[:, 1], size) * self.edge ** 2
        self.mass = self.density * area * part(self.X[:, 2], along * self.edge) * self.edge * (1 - w)
        layer = (across + 1) ** 2
        self.lower = np.arange(len(self.X) - layer)
        self.upper = self.lower + layer
        self.stiffness = (self.modulus * area / self.edge)[self.lower] * (1 - 0.5 * (w[self.lower] + w[self.upper]))

    def forces(self, t, u, v):
        f = np.zeros_like(u)
        pull = self.stiffness * (u[self.upper, 2] - u[self.lower, 2])
        np.add.at(f[:, 2], self.lower, pull)
        np.add.at(f[:, 2], self.upper, -pull)
        return f

    def energy(self, u):
        return 0.5 * (self.stiffness * (u[self.upper, 2] - u[self.lower, 2]) ** 2).sum()


def lattice():
    """Bonded grains, four to a face of a cell, from below the springs to the end of the overlap; a wave starts below."""
    d = 0.5 * Springs.edge
    k, j, i = (n.ravel() for n in np.meshgrid(np.arange(-40, 12), np.arange(4), np.arange(4), indexing="ij"))
    return {"contact": {"law": "linear", "stiffness": Springs.modulus * d, "bonded": True},
            "particles": [{"from": "list", "density": Springs.density * 6 / np.pi,
                           "spheres": {"at": d * (np.stack([i, j, k], axis=-1) + 0.5), "radius": 0.5 * d,
                                       "velocity": np.where(k < -36, 0.1, 0.0)[:, None] * [0, 0, 1]}}],
            "steps": {"dt": 5e-6}, "stages": [{"do": "run", "time": 0.014}]}


class InAnOverlap(unittest.TestCase):
    def hand_over(self, **overlap):
        springs = Springs()
        springs.overlap = overlap
        run = dv.Run(lattice(), solids={"springs": springs})
        before = run.kinetic_energy
        energy, momentum = losses(run, 2800, 200)
        self.assertLess(momentum, 1e-13)
        self.assertLess(energy, 1e-4)
        ledger = run.ledger
        self.assertGreater((ledger["springs: kinetic"] + ledger["springs: own forces"]) / before, 0.4)
        return energy, momentum

    def test_by_a_penalty(self):
        self.hand_over(constraint="penalty", penalty=20 * Springs.modulus / Springs.edge ** 2)

    def test_by_multipliers(self):
        self.hand_over(constraint="multiplier")

    def test_refused(self):
        for change, told in (({"overlap": {"constraint": "penalty"}}, "penalty has a number"),
                             ({"overlap": {"constraint": "multiplier", "penalty": 1.0}}, "multiplier has none"),
                             ({"overlap": {"constraint": "glue"}}, '"constraint": glue'),
                             ({"overlap": {"width": 1}}, '"width": 1'), ({"cells": None}, "no cells"),
                             ({"cells": Springs().cells[:, [4, 5, 6, 7, 0, 1, 2, 3]]}, "elements 0, 1"),
                             ({"grain_weight": [1.0]}, "1 numbers for 189 nodes")):
            springs = Springs()
            for name, value in change.items():
                setattr(springs, name, value)
            with self.subTest(told), self.assertRaisesRegex(dv.InputError, told):
                dv.Run(lattice(), solids={"springs": springs})


if __name__ == "__main__":
    unittest.main()
