"""What runs look like from Python, beside the program: fields, pictures, series, progress."""
import os
import pathlib
import pty
import re
import struct
import subprocess
import sys
import tempfile
import types
import unittest
import zlib
from unittest import mock

import dovetail as dv
import numpy as np
from test_run import PROGRAM, SCENES, beads

NAMES = ("density", "solid_fraction", "momentum", "velocity", "stress", "contact_stress", "kinetic_stress", "pressure",
         "temperature", "wall_force")


def program(*arguments):
    subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True)


def falling(time=0.004, **output):
    """The heap of beads with files; it has come to the floor."""
    scene = beads(3)
    scene["stages"] = [{"do": "run", "time": time}]
    scene["output"] = {"series": time / 4, "frames": time, "checkpoints": time, **output}
    return scene


def read_vti(path):
    """Arrays of a VTI file by their names, x fastest."""
    data = pathlib.Path(path).read_bytes()
    start = data.index(b"_", data.index(b"<AppendedData")) + 1
    head = data[:start].decode("latin-1")
    word = "<Q" if 'header_type="UInt64"' in head else "<I"
    size = struct.calcsize(word)
    arrays = {}
    for tag in re.findall(r"<DataArray[^>]*type=\"Float64\"[^>]*>", head):
        at = start + int(re.search(r'offset="(\d+)"', tag).group(1))
        count = struct.unpack_from(word, data, at)[0]
        sizes = [struct.unpack_from(word, data, at + (3 + k) * size)[0] for k in range(count)]
        at += (3 + count) * size
        raw = b""
        for one in sizes:
            raw += zlib.decompress(data[at:at + one])
            at += one
        arrays[re.search(r'Name="([^"]*)"', tag).group(1)] = np.frombuffer(raw)
    return arrays


class Fields(unittest.TestCase):
    def test_the_numbers_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = falling()
            scene["contact"]["restitution"] = 1.0  # forces of dashpots are those of half a step before
            dv.run(scene, out=folder + "/run", quiet=True)
            program("fields", folder + "/run", "--width", "0.02", "--spacing", "0.015", "--kernel", "gauss")
            there = read_vti(folder + "/run/fields.vti")
            run = dv.Run(scene)
            run.advance(round(0.004 / run.macro_step))
            for here in (dv.fields(folder + "/run", "gauss", 0.02, 0.015), run.fields("gauss", 0.02, 0.015)):
                shape = here["x"].shape[:3]
                for name in NAMES:
                    lies = np.moveaxis(here[name], (0, 1, 2), (2, 1, 0))  # x fastest
                    np.testing.assert_array_equal(lies.ravel(), there[name], name)
                    self.assertEqual(here[name].shape[:3], shape)
                self.assertGreater(np.prod(shape), 8)
                self.assertEqual(here["stress"].shape[3:], (3, 3))
                np.testing.assert_allclose(here["x"][1, 0, 0] - here["x"][0, 0, 0], [0.015, 0, 0])

    def test_integrals_are_those_of_the_grains(self):
        run = dv.Run(falling())
        run.advance(100)
        box = [[-0.05, -0.05, -0.05], [0.1, 0.1, 0.1]]
        spacing = 0.005
        found = run.fields(width=0.02, spacing=spacing, box=box)
        volume = spacing ** 3
        np.testing.assert_allclose(found["density"].sum() * volume, run.grains.mass.sum(), rtol=1e-3)
        momentum = (run.grains.mass[:, None] * run.grains.v).sum(axis=0)
        np.testing.assert_allclose(found["momentum"].sum(axis=(0, 1, 2)) * volume, momentum, rtol=1e-3, atol=1e-9)
        np.testing.assert_allclose(found["stress"], found["contact_stress"] + found["kinetic_stress"], rtol=1e-14)
        np.testing.assert_allclose(found["pressure"], -np.trace(found["stress"], axis1=3, axis2=4) / 3, rtol=1e-14)

    def test_at_points(self):
        run = dv.Run(falling())
        run.advance(50)
        grid = run.fields(width=0.03, spacing=0.01)
        points = grid["x"].reshape(-1, 3)
        some = run.fields(width=0.03, points=points)
        for name in NAMES:
            np.testing.assert_array_equal(some[name], grid[name].reshape(some[name].shape), name)
        self.assertEqual(run.fields(width=0.03, points=points[0])["density"].shape, (1,))
        self.assertEqual(some["width"], 0.03)
        self.assertAlmostEqual(some["time"], run.time)

    def test_leave_the_run_as_it_is(self):
        looked, other = dv.Run(falling()), dv.Run(falling())
        for run in (looked, other):
            run.advance(100)
            if run is looked:
                run.fields(width=0.02), run.series(), run.picture()
            run.advance(100)
        self.assertEqual(looked.save(), other.save())

    def test_with_clumps_and_bonds_and_periods(self):
        for name, steps in (("pile", 5), ("bonded-beam", 5), ("chute", 5)):
            with self.subTest(scene=name):
                run = dv.Run(SCENES / f"{name}.json")
                run.advance(steps)
                self.assertTrue(np.isfinite(run.fields()["stress"]).all())

    def test_advise_the_width(self):
        run = dv.Run(beads(6))
        run.advance(10)
        found = run.fields(advise_width=True, box=[[0.04, 0.04, 0.04], [0.07, 0.07, 0.07]], spacing=0.01)
        self.assertIn("width", found["advice"])
        self.assertGreater(found["width"], 0.01)

    def test_refusals(self):
        run = dv.Run(falling())
        for words, message in (({"kernel": "Lucie"}, "no kernel 'Lucie'"), ({"width": -1}, "width"),
                               ({"width": float("nan")}, "width"), ({"spacing": 0}, "spacing"),
                               ({"spacing": 1e-7}, "more than 1e7 points"), ({"box": [0, 0, 0]}, "two corners"),
                               ({"box": [[1, 1, 1], [0, 0, 0]]}, "no extent"), ({"points": np.zeros((2, 2))}, "shape"),
                               ({"points": [[np.nan, 0, 0]]}, "not finite"), ({"points": np.zeros((0, 3))}, "no points"),
                               ({"points": [0, 0, 0], "spacing": 1}, "points as well as a grid"),
                               ({"width": 0.02, "advise_width": True}, "given and asked for")):
            with self.subTest(**words), self.assertRaisesRegex(ValueError, message):
                run.fields(**words)
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(ValueError, "no folder of a run"):
            dv.fields(folder)
        with self.assertRaisesRegex(ValueError, "no grains"):
            dv.Run(SCENES / "frequencies.json").fields()


class Pictures(unittest.TestCase):
    def test_the_bytes_of_the_program(self):
        scenes = [(falling(), 0.004), (SCENES / "plate.json", 2e-4)]
        for scene, time in scenes:
            with self.subTest(scene=str(scene)[-20:]), tempfile.TemporaryDirectory() as folder:
                words = {} if isinstance(scene, dict) else {"time": time, "output.frames": time}
                dv.run(scene, out=folder + "/run", quiet=True, **words)
                program("picture", folder + "/run", "--azimuth", "30", "--size", "400", "300", "--cut", "y", "0.01")
                view = {"azimuth": 30, "size": (400, 300), "cut": ("y", 0.01)}
                there = pathlib.Path(folder + "/run/picture.png").read_bytes()
                drawn = dv.picture(folder + "/run", **view)
                self.assertEqual(drawn.png, there)
                run = dv.Run(scene, **words)
                run.advance(round(time / run.macro_step))
                now = run.picture(**view)
                self.assertEqual(now.png, there)
                self.assertEqual(now.caption, drawn.caption)

    def test_inline_and_as_files(self):
        drawn = dv.Run(falling()).picture(size=(300, 200))
        self.assertEqual(drawn._repr_png_()[:4], b"\x89PNG")
        self.assertEqual(drawn._repr_mimebundle_()["image/png"], drawn.png)
        with tempfile.TemporaryDirectory() as folder:
            path = drawn.save(pathlib.Path(folder) / "a.png")
            self.assertEqual(pathlib.Path(path).read_bytes(), drawn.png)
            with self.assertRaisesRegex(ValueError, "ends in .png"):
                drawn.save(folder + "/a.jpg")

    def test_films_and_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            dv.run(falling(frames=0.001), out=folder + "/run", quiet=True)
            film = dv.picture(folder + "/run", film=True, size=(200, 150))
            self.assertEqual(film.gif[:4], b"GIF8")
            self.assertIsNone(film.png)
            first, last = (dv.picture(folder + "/run", frame=k, size=(200, 150)).png for k in (0, -1))
            self.assertNotEqual(first, last)
        run = dv.Run(falling())
        run.advance(200)
        self.assertNotEqual(run.picture(lines="contacts", size=(300, 200)).png, run.picture(size=(300, 200)).png)

    def test_leave_nothing_behind(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.dict(os.environ, {"TMPDIR": folder}):
            run = dv.Run(falling())
            run.picture()
            with self.assertRaises(ValueError):
                run.picture(grains="no_such_field")
            self.assertEqual(os.listdir(folder), [])

    def test_refusals(self):
        run = dv.Run(falling())
        for words, message in (({"size": (10, 10)}, "size is not possible"), ({"size": 5}, "another type"),
                               ({"cut": ("w", 0)}, "'w' is no axis"), ({"cut": ("x", np.inf)}, "axis"),
                               ({"azimuth": 1000}, "nobody looks"), ({"elevation": np.nan}, "nobody looks"),
                               ({"warp": -1}, "warp"), ({"background": "whitish"}, "no colour"),
                               ({"grain_range": (1, 0)}, "range is empty"), ({"grains": "sped"}, "no field 'sped'"),
                               ({"lines": "arrows"}, "no lines of 'arrows'"), ({"colour": 1}, "no option 'colour'"),
                               ({"film": True}, "one picture"), ({"mode": 1}, "one picture"),
                               ({"cut": ("x", 0), "uncut": True}, "cut and uncut"), ({"cell": "a"}, "no frames of a cell")):
            with self.subTest(**words), self.assertRaisesRegex(ValueError, message):
                run.picture(**words)
        with tempfile.TemporaryDirectory() as folder:
            dv.run(falling(), out=folder + "/run", quiet=True)
            for words, message in (({"frame": 7}, "no frame 7"), ({"frame": 1, "film": True}, "leave out frame"),
                                   ({"mode": 1, "cell": "a"}, "cells have no modes"), ({"mode": 1}, "no frames of modes")):
                with self.subTest(**words), self.assertRaisesRegex(ValueError, message):
                    dv.picture(folder + "/run", **words)


class Series(unittest.TestCase):
    def test_rows_of_the_file(self):
        words = {"time": 4e-4, "output.series": 2e-4}
        for scene in ("plate", "ball-on-cells"):
            with self.subTest(scene=scene), tempfile.TemporaryDirectory() as folder:
                dv.run(SCENES / f"{scene}.json", out=folder, quiet=True, **words)
                columns = dv.series(folder)
                run = dv.Run(SCENES / f"{scene}.json", **words)
                first, both = (round(time / run.macro_step) for time in (2e-4, 4e-4))
                for row in range(3):
                    now = run.series()
                    self.assertEqual(list(now), list(columns))
                    for name, values in columns.items():
                        if name != "limit_s" or row == 0:
                            self.assertEqual(now[name], values[row], f"{name}, row {row}")
                    if row < 2:
                        run.advance(first if row == 0 else both - first)
                probes = run.probes()
                self.assertEqual(probes, {name: now[name] for name in probes})
                self.assertEqual(any(name.startswith("ball_") for name in probes), scene == "ball-on-cells")

    def test_probes_keep_to_their_grain_over_states(self):
        scene = beads(2)
        scene["output"] = {"series": 1e-3, "probes": [{"name": "first", "of": "grain", "at": [0, 0, 0.012]}]}
        run = dv.Run(scene)
        run.advance(500)
        other = dv.Run(scene)
        other.load(run.save())
        self.assertEqual(other.probes(), run.probes())
        np.testing.assert_array_equal([run.probes()[f"first_{c}_m"] for c in "xyz"], run.grains.x[0])

    def test_probes_of_what_is_not_there_are_refused(self):
        scene = beads(2)
        scene["output"] = {"series": 1e-3, "probes": [{"name": "a", "of": "wall", "wall": "ceiling"}]}
        with self.assertRaisesRegex(ValueError, "ceiling"):
            dv.Run(scene)
        with self.assertRaises(ValueError):
            dv.series("/no/such/folder.csv")


class Line:
    """A line of a notebook, in the place of IPython's."""
    def __init__(self):
        self.texts = []

    def update(self, data, raw):
        self.texts.append(data["text/plain"])


class ProgressOfSteps(unittest.TestCase):
    script = ("import sys; sys.path.insert(0, '.'); import dovetail as dv; from test_run import beads\n"
              "run = dv.Run(beads(2))\nfor _ in run.steps(2000, every=100, progress=True): pass\nprint('done')\n")

    def test_is_shown_in_terminals(self):
        here, there = pty.openpty()
        done = subprocess.Popen([sys.executable, "-c", self.script], stdout=there, stderr=there)
        os.close(there)
        told = b""
        try:
            while part := os.read(here, 4096):
                told += part
        except OSError:  # its end is closed
            pass
        os.close(here)
        self.assertEqual(done.wait(), 0)
        self.assertRegex(told.decode(), r"steps +\d+ %  ETA \d+ s  t = 0\.")
        self.assertTrue(told.decode().endswith("\r\x1b[Kdone\r\n"))

    def test_is_silent_elsewhere(self):
        done = subprocess.run([sys.executable, "-c", self.script], capture_output=True, text=True, check=True)
        self.assertEqual((done.stdout, done.stderr), ("done\n", ""))

    def test_is_a_line_in_notebooks(self):
        line = Line()
        shell = types.SimpleNamespace(kernel=1)
        ipython = types.ModuleType("IPython")
        ipython.get_ipython = lambda: shell
        shows = types.ModuleType("IPython.display")
        shows.display = lambda data, raw, display_id: line
        with mock.patch.dict(sys.modules, {"IPython": ipython, "IPython.display": shows}):
            for _ in dv.Run(beads(2)).steps(400, every=100, progress=True):
                pass
        self.assertRegex(line.texts[0], r"^steps +\d+ %  ETA")
        self.assertEqual(line.texts[-1], "")

    def test_gives_what_steps_without_it_give(self):
        self.assertEqual(list(dv.Run(beads(2)).steps(10, every=4, progress=True)), [4, 8, 10])


if __name__ == "__main__":
    unittest.main()
