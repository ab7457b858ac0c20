"""Studies and calibration with functions."""
import json
import math
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import unittest

import dovetail as dv
import numpy as np
from test_run import PROGRAM, SCENES


def drop(**output):
    """A ball that falls on a floor and bounces once."""
    return {"let": {"restitution": 0.5}, "gravity": [0, 0, -9.81],
            "contact": {"law": "linear", "stiffness": 1e5, "restitution": "restitution"},
            "particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0, 0, 0.02], "radius": 0.01,
                                                                         "velocity": [0, 0, -1]}]}],
            "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
            "steps": {"dt": 1e-5}, "stages": [{"do": "run", "time": 0.02}],
            "output": {"series": 0.01, **output}}


def rebound(run):
    run.advance(1500)
    return {"speed": float(run.grains.v[0, 2]), "where": os.getpid()}


class Studies(unittest.TestCase):
    def test_rows_are_those_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "drop.json"
            path.write_text(json.dumps(drop()))
            rows = dv.study(path, {"restitution": [0.3, 0.6], "steps.dt": ["1e-5", "2e-5"]}, out=folder + "/here",
                            processes=2, quiet=True)
            subprocess.run([PROGRAM, "study", path, "--over", "restitution=0.3,0.6", "--over", "steps.dt=1e-5,2e-5",
                            "--workers", "2", "--out", folder + "/there"], check=True, capture_output=True)
            there = json.loads((pathlib.Path(folder) / "there/study.json").read_text())["runs"]
            self.assertEqual([row["label"] for row in rows], [row["label"] for row in there])
            for row, other in zip(rows, there):
                for name, value in other.items():
                    if name not in ("settings", "wall_seconds", "processor_seconds", "on_front"):
                        self.assertEqual(row[name], value, name)
                self.assertEqual(row["outcome"], "finished")
            self.assertEqual([(row["restitution"], row["steps.dt"]) for row in rows],
                             [(0.3, "1e-5"), (0.3, "2e-5"), (0.6, "1e-5"), (0.6, "2e-5")])
            series = dv.series(rows[2]["folder"])
            self.assertEqual(series["residual_J"][-1], rows[2]["residual_J"])
            self.assertTrue((pathlib.Path(folder) / "here/study.svg").exists())

    def test_measures_of_folders(self):
        def measure(folder):
            series = dv.series(folder)
            return {"up": series["momentum_z_Ns"][-1], "rows": len(series["time_s"]), "by": os.path.basename(folder),
                    "none": math.nan}

        with tempfile.TemporaryDirectory() as folder:
            rows = dv.study(drop(), [{"restitution": 0.9}, {"restitution": 0.4}], out=folder + "/s", measure=measure,
                            processes=2, quiet=True)
            self.assertEqual([row["by"] for row in rows], ["001", "002"])
            self.assertEqual([row["rows"] for row in rows], [3, 3])
            self.assertGreater(rows[0]["up"], rows[1]["up"])
            np.testing.assert_array_equal(rows.column("up"), [rows[0]["up"], rows[1]["up"]])
            self.assertTrue(np.isnan(rows.column("none")).all())
            with self.assertRaisesRegex(ValueError, "no row has 'sideways'"):
                rows.column("sideways")
            with self.assertRaisesRegex(ValueError, "run"):  # it is there
                dv.study(drop(), [{"restitution": 0.9}], out=folder + "/s", quiet=True)

    def test_acts_on_runs_in_processes_of_their_own(self):
        e = [0.3, 0.5, 0.7, 0.9]
        with tempfile.TemporaryDirectory() as folder:
            rows = dv.study(drop(), {"restitution": np.array(e)}, out=folder, act=rebound, error="speed", exact=0.5,
                            processes=2, quiet=True)
            alone = dv.study(drop(), {"restitution": e}, out=folder + "/b", act=rebound, processes=0, quiet=True)
        speed = rows.column("speed")
        np.testing.assert_array_equal(speed, alone.column("speed"))
        np.testing.assert_allclose(rows.column("error"), speed - 0.5, rtol=1e-15)
        hit = math.sqrt(1 + 2 * 9.81 * 0.01)
        np.testing.assert_allclose(speed + 9.81 * 0.005, e * np.full(4, hit), atol=0.06)
        self.assertEqual(len(set(rows.column("where"))), 4)
        self.assertEqual(set(alone.column("where")), {os.getpid()})
        self.assertTrue(any(row["on_front"] for row in rows))

    def test_after_runs_on_all_threads(self):
        dv.make_cells({"grains": "discs", "count": 20, "radius": {"smallest": "4 mm", "largest": "6 mm"},
                       "density": 2500, "thickness": 0.1, "number": 4, "prepare": [{"pressure": 1e5}],
                       "contact": {"law": "linear", "modulus": 1e8, "friction": 0.5}})
        with tempfile.TemporaryDirectory() as folder:
            rows = dv.study(drop(), {"restitution": [0.5, 0.6]}, out=folder, act=rebound, processes=2, quiet=True)
        self.assertEqual([row["outcome"] for row in rows], ["finished"] * 2)

    def test_rows_say_what_went_wrong(self):
        def act(run):
            kind = run.scene
            e = json.loads(str(kind))["contact"]["restitution"]
            if e == 0.2:
                raise KeyError("mine")
            if e == 0.3:
                raise dv.InputError("not so little")
            if e == 0.4:
                os.kill(os.getpid(), signal.SIGKILL)
            return {"e": e} if e < 0.6 else {"array": np.zeros(3)}

        with tempfile.TemporaryDirectory() as folder:
            rows = dv.study(drop(), {"restitution": [0.2, 0.3, 0.4, 0.5, 0.6, 7]}, out=folder, act=act, processes=2,
                            quiet=True)
        self.assertEqual([row["outcome"] for row in rows],
                         ["broke down", "refused", "broke down", "finished", "refused", "refused"])
        for row, message in zip(rows, ("KeyError: 'mine'", "not so little", "signal 9", "", "'array' is ndarray",
                                       "restitution")):
            self.assertIn(message, row["message"])
        self.assertTrue(math.isnan(rows.column("e")[0]))

    def test_ctrl_c_ends_all_processes(self):
        def act(run):
            run.advance(10**12)
            return {}

        with tempfile.TemporaryDirectory() as folder:
            threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
            with self.assertRaises(KeyboardInterrupt):
                dv.study(drop(), {"restitution": [0.5, 0.6, 0.7]}, out=folder, act=act, processes=2, quiet=True)
        with self.assertRaises(ChildProcessError):
            os.waitpid(-1, os.WNOHANG)

    def test_refusals(self):
        with tempfile.TemporaryDirectory() as folder:
            out = folder + "/s"
            for words, message in (({"over": {}}, "nothing to vary"), ({"over": {"restitution": []}}, "nothing to vary"),
                                   ({"over": {"restitution": "0.5"}}, "no list"), ({"processes": -1}, "-1 processes"),
                                   ({"over": {"restitutoin": [1]}}, "restitutoin"),
                                   ({"act": rebound, "measure": rebound}, "leave out act or measure"),
                                   ({"act": rebound, "exact": 1.0}, "exact value of no figure"),
                                   ({"error": "speed_of_light"}, "no column of this name"), ({"out": None}, "give out")):
                with self.subTest(**{key: str(value) for key, value in words.items()}):
                    with self.assertRaisesRegex(ValueError, message):
                        dv.study(drop(), **{"over": {"restitution": [0.5]}, "out": out, "quiet": True, **words})
            with self.assertRaisesRegex(ValueError, "has been read"):
                dv.study(dv.read_scene(drop()), {"restitution": [0.5]}, out=out)
            with self.assertRaisesRegex(ValueError, "no series"):
                dv.study({**drop(), "output": {}}, {"restitution": [0.5]}, out=out, quiet=True)

    def test_tables_of_pandas(self):
        try:
            import pandas
        except ModuleNotFoundError:
            self.skipTest("pandas is not here")
        table = dv.Rows([{"a": 1}, {"a": 2, "b": 3}]).frame()
        self.assertIsInstance(table, pandas.DataFrame)
        self.assertEqual(list(table["a"]), [1, 2])


class Calibration(unittest.TestCase):
    x = np.linspace(0, 1, 6)

    def line(self, slope, offset):
        return slope * self.x + offset

    def test_linear_models_have_the_uncertainty_of_the_normal_equations(self):
        noise = np.array([0.3, -0.2, 0.1, -0.4, 0.2, 0.1]) * 0.05
        sigma = 0.05
        targets = self.line(2.0, 0.5) + noise
        found = dv.calibrate(self.line, {"slope": (1, -10, 10), "offset": (0, -10, 10)}, targets=targets,
                             uncertainty=sigma, tolerance=1e-10)
        J = np.stack([self.x, np.ones(6)], axis=1) / sigma
        best = np.linalg.lstsq(J, targets / sigma, rcond=None)[0]
        np.testing.assert_allclose(list(found.value.values()), best, rtol=1e-7)
        np.testing.assert_allclose(found.covariance, np.linalg.inv(J.T @ J), rtol=1e-6)
        np.testing.assert_allclose(list(found.uncertainty.values()), np.sqrt(np.diag(found.covariance)), rtol=1e-12)
        np.testing.assert_allclose(found.residual, J @ best - targets / sigma, atol=1e-6)
        self.assertAlmostEqual(found.chi_squared, (found.residual ** 2).sum())
        self.assertTrue(found.converged)
        self.assertEqual(found.freedom, 4)
        self.assertIn("slope", str(found))
        self.assertEqual(found.at_bound, {"slope": False, "offset": False})

    def test_residuals_of_ones_own_are_the_same(self):
        targets = self.line(2.0, 0.5)
        parameters = {"slope": (1, -10, 10), "offset": (0, -10, 10)}
        one = dv.calibrate(self.line, parameters, targets=targets, uncertainty=0.1)
        other = dv.calibrate(lambda slope, offset: (self.line(slope, offset) - targets) / 0.1, parameters)
        self.assertEqual(one.value, other.value)
        self.assertEqual(one.uncertainty, other.uncertainty)

    def test_bounds_hold_and_nothing_is_evaluated_twice(self):
        seen = []

        def model(slope):
            seen.append(slope)
            return slope * self.x

        found = dv.calibrate(model, {"slope": (1, 0, 1.5)}, targets=2 * self.x, uncertainty=0.1)
        self.assertEqual(found.value["slope"], 1.5)
        self.assertTrue(found.at_bound["slope"])
        self.assertTrue(all(0 <= slope <= 1.5 for slope in seen))
        self.assertEqual(len(seen), len(set(seen)))
        self.assertEqual(found.evaluations, len(seen))

    def test_restitution_from_a_bounce(self):
        def speed(restitution):
            run = dv.Run(drop(), restitution=restitution)
            run.advance(1500)
            return [run.grains.v[0, 2]]

        found = dv.calibrate(speed, {"restitution": (0.5, 0.2, 0.95)}, targets=speed(0.73), uncertainty=0.01)
        self.assertAlmostEqual(found.value["restitution"], 0.73, delta=1e-3)

    def test_goes_round_what_breaks_down(self):
        def model(slope):
            if slope > 1.2:
                raise dv.NumericalError("too steep")
            if slope < 0.3:
                raise dv.InputError("too flat")
            return slope * self.x

        found = dv.calibrate(model, {"slope": (1.0, 0, 10)}, targets=0.8 * self.x + 0.01, uncertainty=0.1)
        self.assertAlmostEqual(found.value["slope"], 0.8, delta=0.05)
        with self.assertRaisesRegex(ValueError, "where the parameters start: too steep"):
            dv.calibrate(model, {"slope": (5, 0, 10)}, targets=self.x, uncertainty=0.1)

    def test_ends_when_evaluations_are_used_up(self):
        found = dv.calibrate(self.line, {"slope": (1, -10, 10), "offset": (0, -10, 10)}, targets=self.line(2, 1),
                             uncertainty=0.1, evaluations=3)
        self.assertFalse(found.converged)
        self.assertIn("used up", found.message)
        self.assertIsNone(found.covariance)

    def test_what_the_model_raises_comes_through(self):
        calls = []

        def model(slope):
            calls.append(slope)
            if len(calls) > 2:
                raise KeyError("mine")
            return slope * self.x

        with self.assertRaisesRegex(KeyError, "mine"):
            dv.calibrate(model, {"slope": (1, 0, 10)}, targets=self.x, uncertainty=0.1)

    def test_files_give_what_the_program_writes(self):
        path = SCENES / "calibration/stiffness.json"
        with tempfile.TemporaryDirectory() as folder:
            here = dv.calibrate(path, out=folder + "/here", quiet=True)
            subprocess.run([PROGRAM, "calibrate", path, "--out", folder + "/there"], check=True, capture_output=True)
            there = json.loads((pathlib.Path(folder) / "there/calibration.json").read_text())
        for key in ("parameters", "fit", "targets"):
            self.assertEqual(here[key], there[key])

    def test_refusals(self):
        line = {"slope": (1, -10, 10), "offset": (0, -10, 10)}
        for act, message in (
                (lambda: dv.calibrate(self.line, {}), "no parameters"),
                (lambda: dv.calibrate(self.line), "no parameters"),
                (lambda: dv.calibrate(self.line, {"slope": (1, 2)}), "2 numbers"),
                (lambda: dv.calibrate(self.line, {"slope": (20, -10, 10), "offset": (0, -1, 1)}, targets=self.x + 1), "slope"),
                (lambda: dv.calibrate(self.line, line, targets=self.x), "not > 0"),
                (lambda: dv.calibrate(self.line, line, targets=[1.0, math.nan]), "finite"),
                (lambda: dv.calibrate(self.line, line, targets=[1.0, 2.0]), r"\(6,\) for targets of \(2,\)"),
                (lambda: dv.calibrate(self.line, line, uncertainty=1), "uncertainty of no targets"),
                (lambda: dv.calibrate(lambda slope, offset: np.zeros((2, 2)), line), "2 dimensions"),
                (lambda: dv.calibrate(lambda slope, offset: [0.0], line), "1 targets for 2 parameters"),
                (lambda: dv.calibrate(self.line, line, targets=self.x + 1, out="a"), "those of a file"),
                (lambda: dv.calibrate("a.json", line), "its own parameters"),
                (lambda: dv.calibrate("no-such.json", out=tempfile.gettempdir() + "/x"), "no-such.json")):
            with self.subTest(message=message), self.assertRaisesRegex(ValueError, message):
                act()


if __name__ == "__main__":
    unittest.main()
