"""Runs of scenes from Python, beside the program."""
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import unittest

import dovetail as dv
import numpy as np

SCENES = pathlib.Path(os.environ["DOVETAIL_SCENES"])
PROGRAM = os.environ["DOVETAIL_PROGRAM"]

# Of the shipped scenes, what is short; all with their files.
SHORT = {"ball-on-cells": "5e-4", "bonded-beam": "1e-3", "cantilever": "0.02", "chute": "2e-3", "column-collapse": "5e-3",
         "drum": "2e-3", "footing": "5e-4", "pile": "0.01", "plate": "2e-4", "silo": "2e-3", "snowball": "5e-4",
         "tray": "0.01", "wave": "2e-3", "wet-column": "2e-3"}


def beads(n=4, spin=True):
    """A heap of beads that fall on a floor; SI."""
    places = [[0.021 * i, 0.021 * j, 0.012 + 0.021 * k] for i in range(n) for j in range(n) for k in range(n)]
    return {"gravity": [0, 0, -9.81],
            "contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.8, **({"friction": 0.4} if spin else {})},
            "particles": [{"from": "list", "density": 2500,
                           "spheres": [{"at": at, "radius": 0.01, "velocity": [0.1, 0, -0.5]} for at in places]}],
            "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "name": "floor"}],
            "steps": {"dt": 2e-5}, "stages": [{"do": "run", "time": 0.1}]}


def files_of(folder):
    """What a run has written, but what tells times of the clock."""
    all_files = {}
    for path in sorted(pathlib.Path(folder).rglob("*")):
        if path.is_file() and not path.name.startswith("summary") and "times" not in path.name:
            all_files[str(path.relative_to(folder))] = path.read_bytes()
    return all_files


class Files(unittest.TestCase):
    def test_same_bytes_as_the_program(self):
        for name, time in SHORT.items():
            with self.subTest(scene=name), tempfile.TemporaryDirectory() as folder:
                mine, its = f"{folder}/mine", f"{folder}/its"
                dv.run(SCENES / f"{name}.json", out=mine, quiet=True, time=time)
                subprocess.run([PROGRAM, "run", SCENES / f"{name}.json", "--out", its, "--set", f"time={time}"],
                               check=True, capture_output=True)
                here, there = files_of(mine), files_of(its)
                self.assertEqual(list(here), list(there))
                for file, data in here.items():
                    self.assertEqual(data, there[file], f"{name}: {file}")

    def test_refuses_folders_of_runs_until_told(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = beads(2)
            scene["stages"] = [{"do": "run", "time": 1e-3}]
            dv.run(scene, out=folder + "/a", quiet=True)
            with self.assertRaisesRegex(ValueError, "run"):
                dv.run(scene, out=folder + "/a", quiet=True)
            dv.run(scene, out=folder + "/a", quiet=True, replace=True)
            with self.assertRaisesRegex(ValueError, "give out"):
                dv.run(scene)

    def test_checks(self):
        self.assertIn("macro steps", dv.check(beads(2)))
        self.assertIn("\"particles\"", dv.schema())


class Steps(unittest.TestCase):
    def test_arrays(self):
        run = dv.Run(beads())
        self.assertEqual(len(run.grains), 64)
        self.assertEqual(run.grains.x.shape, (64, 3))
        np.testing.assert_array_equal(run.grains.id, np.arange(64))
        np.testing.assert_allclose(run.grains.mass, 2500 * 4 / 3 * np.pi * 1e-6)
        run.advance(250)
        self.assertAlmostEqual(run.time, 0.005)
        np.testing.assert_array_equal(run.grains.id, np.arange(64))
        touching = run.grains.contacts()
        on_floor = touching["second"] < 0
        self.assertTrue(on_floor.any())
        np.testing.assert_allclose(touching["normal"][on_floor], [[0, 0, 1]] * on_floor.sum())
        self.assertTrue((touching["force"][on_floor][:, 2] > 0).all())
        held = run.grains.x
        held[:] = 0  # a copy
        self.assertGreater(run.grains.x[:, 2].min(), 0.009)

    def test_the_same_digits_however_often_it_stops(self):
        once, often = dv.Run(beads()), dv.Run(beads())
        once.advance(2000)
        self.assertEqual(list(often.steps(2000, every=300)), [300, 600, 900, 1200, 1500, 1800, 2000])
        np.testing.assert_array_equal(once.grains.x, often.grains.x)
        self.assertEqual(once.save(), often.save())

    def test_goes_on_from_states(self):
        run = dv.Run(beads())
        run.advance(500)
        state = run.save()
        run.advance(500)
        end = run.save()
        other = dv.Run(beads())
        other.load(state)
        other.advance(500)
        self.assertEqual(other.save(), end)
        with self.assertRaises(ValueError):
            other.load(state[:-10])
        self.assertEqual(other.save(), end)  # as it was

    def test_books(self):
        run = dv.Run(beads())
        brought = run.kinetic_energy
        run.advance(4000)
        ledger, totals = run.ledger, run.totals
        self.assertLess(abs(ledger["residual"]), 1e-3 * brought)
        self.assertGreater(ledger["particles: friction"], 1e-3 * brought)
        self.assertLess(np.abs(totals["residual"]["linear"]).max(), 1e-12 * totals["turned_over"])
        self.assertIn("particles: gravity", totals["given"])
        self.assertGreater(run.limits[0][0], 0)

    def test_solids(self):
        run = dv.Run(SCENES / "cantilever.json")
        (name, beam), = run.solids.items()
        self.assertEqual(beam.name, name)
        self.assertEqual(beam.X.shape, (len(beam), 3))
        run.advance(20)
        np.testing.assert_array_equal(beam.x, beam.X + beam.u)
        self.assertGreater(np.abs(beam.reactions()).max(), 0)
        self.assertGreater(beam.mass.sum(), 0)

    def test_velocities_are_set_and_booked(self):
        run = dv.Run(beads(2))
        run.advance(100)
        before = run.kinetic_energy
        run.grains.v = [0, 0, 0]
        self.assertEqual(np.abs(run.grains.v).max(), 0)
        ledger = run.ledger
        brought = -ledger["particles: changes (minus)"] if "particles: changes (minus)" in ledger else -ledger["changes (minus)"]
        self.assertAlmostEqual(brought, -before + run.kinetic_energy, delta=1e-12)
        run.advance(200)
        self.assertLess(abs(run.ledger["residual"]), 1e-6)
        with self.assertRaisesRegex(ValueError, r"shape is \(3, 2\)"):
            run.grains.v = np.zeros((3, 2))
        with self.assertRaisesRegex(ValueError, "not finite"):
            run.grains.v = [np.nan, 0, 0]


class Forces(unittest.TestCase):
    def test_act_and_are_booked(self):
        scene = beads(2, spin=False)
        scene["gravity"], scene["walls"] = [0, 0, 0], []
        run = dv.Run(scene)
        mass = run.grains.mass

        @run.force
        def weight(t, x, v):
            self.assertEqual(x.shape, (8, 3))
            return mass[:, None] * [0, 0, -9.81]

        run.advance(1000)
        np.testing.assert_allclose(run.grains.v, [[0.1, 0, -0.5 - 9.81 * run.time]] * 8, rtol=1e-12)
        ledger = run.ledger
        self.assertLess(abs(ledger["residual"]), 1e-12)
        given = run.totals["given"]["particles: weight"]["linear"]
        np.testing.assert_allclose(given, [0, 0, -9.81 * run.time * mass.sum()], rtol=1e-9, atol=1e-15)

    def test_what_they_raise_comes_through(self):
        run = dv.Run(beads(2))
        state = run.save()

        @run.force
        def late(t, x, v):
            if t > 1e-3:
                raise KeyError("no such field")
            return np.zeros_like(x)

        with self.assertRaisesRegex(KeyError, "no such field"):
            run.advance(100)
        with self.assertRaisesRegex(ValueError, "broken off"):
            run.advance(1)

    def test_cannot_step_or_look_at_the_run_within_a_step(self):
        for act in (lambda run: run.advance(1), lambda run: run.grains.x, lambda run: run.ledger,
                    lambda run: run.save()):
            run = dv.Run(beads(2))
            started = []

            def force(t, x, v):
                if started:
                    act(run)
                return 0 * x

            run.force(force)
            started.append(True)
            with self.assertRaisesRegex(ValueError, "a step is under way"):
                run.advance(1)

    def test_of_the_wrong_shape_are_refused(self):
        run = dv.Run(beads(2))
        with self.assertRaisesRegex(ValueError, r"the shape is \(7, 3\) \[drag\]"):
            run.force(lambda t, x, v: np.zeros((7, 3)), name="drag")


class Errors(unittest.TestCase):
    def test_have_the_text_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = beads(2)
            scene["contact"]["stifness"] = 1
            path = pathlib.Path(folder) / "s.json"
            path.write_text(json.dumps(scene))
            told = subprocess.run([PROGRAM, "check", path], capture_output=True, text=True).stderr
            with self.assertRaises(dv.InputError) as caught:
                dv.check(path)
            self.assertIn(str(caught.exception), told)
            self.assertIsInstance(caught.exception, ValueError)

    def test_settings_are_checked(self):
        with self.assertRaisesRegex(ValueError, "sped"):
            dv.Run(SCENES / "plate.json", sped=1)
        run = dv.Run(beads(2), **{"steps.dt": 1e-5})
        self.assertEqual(run.dt, 1e-5)

    def test_changes_of_the_first_stage_are_refused_step_by_step(self):
        scene = beads(2)
        scene["stages"][0]["changes"] = {"gravity": [0, 0, 0]}
        with self.assertRaisesRegex(ValueError, "first stage changes"):
            dv.Run(scene)

    def test_runs_that_break_down(self):
        run = dv.Run(beads(2))
        with self.assertRaises(dv.InputError):
            run.advance(-1)
        self.assertTrue(issubclass(dv.NumericalError, RuntimeError))


class Python(unittest.TestCase):
    def test_ctrl_c_ends_between_steps(self):
        run = dv.Run(beads(2))
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            run.advance(10**9)
        self.assertGreater(run.time, 0)
        self.assertLess(abs(run.ledger["residual"]), 1e-2)
        run.advance(10)

    def test_others_go_on_meanwhile(self):
        counted, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                done.wait(1e-3)

        other = threading.Thread(target=count)
        run = dv.Run(beads())
        other.start()
        before = counted[0]
        run.advance(3000)
        during = counted[0] - before
        done.set()
        other.join()
        self.assertGreater(during, 5)

    def test_others_wait_for_the_end_of_a_step(self):
        run = dv.Run(beads())
        seen = []

        def look():
            for _ in range(50):
                try:
                    seen.append(run.grains.x.shape)
                except ValueError as error:
                    seen.append(str(error))

        other = threading.Thread(target=look)
        other.start()
        run.advance(3000)
        other.join()
        self.assertTrue(all(one == (64, 3) or "under way" in one for one in seen))

    def test_runs_live_as_long_as_what_is_of_them(self):
        grains = dv.Run(beads(2)).grains
        self.assertEqual(grains.x.shape, (8, 3))


if __name__ == "__main__":
    unittest.main()
