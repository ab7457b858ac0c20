"""Scenes that hold arrays: they say what lists and files say."""
import os
import pathlib
import tempfile
import unittest

import dovetail as dv
import numpy as np

RANDOM = np.random.default_rng(1)


def scene(spheres, **more):
    return {"gravity": np.array([0, 0, -9.81]),
            "contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.8, "friction": 0.4},
            "particles": [{"from": "list", "density": np.float64(2500), "spheres": spheres}],
            "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
            "steps": {"dt": 2e-5}, "stages": [{"do": "run", "time": 0.02}], **more}


def grid(n=4):
    places = 0.021 * np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) + [0, 0, 0.012]
    return {"at": places + RANDOM.uniform(-4e-4, 4e-4, places.shape), "radius": RANDOM.uniform(0.009, 0.0105, n ** 3),
            "velocity": RANDOM.normal(size=(n ** 3, 3)), "spin": RANDOM.normal(size=(n ** 3, 3))}


def listed(arrays):
    return [{"at": list(x), "radius": r, "velocity": list(v), "spin": list(w)} for x, r, v, w in
            zip(*(arrays[key].tolist() for key in ("at", "radius", "velocity", "spin")))]


def brick(cells, size):
    """Nodes and elements of a box of hexahedra, from (0, 0, 0)."""
    n = np.array(cells) + 1
    number = np.arange(n.prod()).reshape(n[::-1]).transpose(2, 1, 0)
    nodes = np.stack([i.ravel(order="F") for i in np.meshgrid(*[np.linspace(0, s, k) for s, k in zip(size, n)],
                                                              indexing="ij")], axis=-1)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    part = [number[i:n[0] - 1 + i, j:n[1] - 1 + j, k:n[2] - 1 + k].ravel(order="F") for i, j, k in corners]
    return nodes, np.stack(part, axis=-1)


class Grains(unittest.TestCase):
    def test_are_those_of_the_list_to_the_last_bit(self):
        arrays = grid()
        one, other = dv.Run(scene(arrays)), dv.Run(scene(listed(arrays)))
        np.testing.assert_array_equal(one.grains.x, arrays["at"])
        np.testing.assert_array_equal(one.grains.radius, arrays["radius"])
        np.testing.assert_array_equal(one.grains.omega, arrays["spin"])
        one.advance(300)
        other.advance(300)
        self.assertEqual(one.save(), other.save())

    def test_one_number_or_vector_for_all(self):
        run = dv.Run(scene({"at": grid()["at"].astype(np.float32), "radius": 0.009, "velocity": [0, 0, -1]}))
        np.testing.assert_array_equal(run.grains.radius, 64 * [0.009])
        np.testing.assert_array_equal(run.grains.v, 64 * [[0, 0, -1]])

    def test_many(self):
        at = np.stack(np.meshgrid(*[np.arange(30.0)] * 3), axis=-1).reshape(-1, 3)
        run = dv.Run(scene({"at": at + 1, "radius": 0.4}, steps={"dt": 1e-6}))
        np.testing.assert_array_equal(run.grains.x, at + 1)

    def test_what_is_wrong_is_told_with_its_place(self):
        arrays = grid()
        for change, told in (({"at": arrays["at"][:, :2]}, r"shape is \(64, 2\) \[particles.0.spheres.at\]"),
                             ({"at": np.empty((0, 3))}, "no rows"),
                             ({"radius": arrays["radius"][1:]}, "63 radii of 64 spheres"),
                             ({"radius": -1.0}, "radius 0 is not finite and > 0"),
                             ({"velocity": np.full((64, 3), np.nan)}, "number 0 of row 0 is not finite"),
                             ({"velocty": 0}, 'no key "velocty".*write "velocity"'),
                             ({"radius": None}, '"radius" is missing'),
                             ({"at": [["a", 0, 0]]}, "no numbers")):
            with self.subTest(told), self.assertRaisesRegex(dv.InputError, told):
                dv.Run(scene({**arrays, **change}))
        with self.assertRaisesRegex(dv.InputError, "read where it is run"):
            dv.read_scene(scene(arrays))

    def test_checks(self):
        self.assertIn("64", dv.check(scene(grid())))


class Folders(unittest.TestCase):
    def test_runs_go_on_from_their_folder_alone(self):
        arrays = grid()
        with tempfile.TemporaryDirectory() as folder:
            out, whole = folder + "/out", folder + "/whole"
            half = scene(arrays, stages=[{"do": "run", "time": 0.01}], output={"checkpoints": 0.005})
            dv.run(half, out=out, quiet=True)
            (file,) = pathlib.Path(out, "arrays").glob("*/spheres.csv")
            self.assertIn(str(file), pathlib.Path(out, "scene.json").read_text())
            dv.resume(out, until=0.02, quiet=True)
            dv.run(scene(listed(arrays), output={"checkpoints": 0.005}), out=whole, quiet=True)
            ends = [dv.Run({**scene(listed(arrays)), "steps": {"dt": 2e-5}, "particles": [
                {"from": "state", "file": f"{one}/checkpoint.state"}]}) for one in (out, whole)]
            np.testing.assert_array_equal(ends[0].grains.x, ends[1].grains.x)
            self.assertGreater(np.abs(ends[0].grains.x - arrays["at"]).max(), 1e-3)
            dv.run(out + "/scene.json", out=folder + "/again", quiet=True)

    def test_are_left_as_they_were_by_runs_that_are_refused(self):
        arrays = grid()
        with tempfile.TemporaryDirectory() as folder:
            out = folder + "/out"
            with self.assertRaisesRegex(dv.InputError, "gravty"):
                dv.run(scene(arrays, gravty=[0, 0, 0]), out=out, quiet=True)
            self.assertEqual(os.listdir(folder), [])
            short = scene(arrays, stages=[{"do": "run", "time": 1e-3}])
            dv.run(short, out=out, quiet=True)
            kept = sorted(pathlib.Path(out).rglob("*"))
            with self.assertRaisesRegex(dv.InputError, "run"):
                dv.run({**short, "particles": scene(grid())["particles"]}, out=out, quiet=True)
            with self.assertRaisesRegex(dv.InputError, "run"):
                dv.run(short, out=out, quiet=True)
            self.assertEqual(sorted(pathlib.Path(out).rglob("*")), kept)
            dv.run(short, out=out, quiet=True, replace=True)

    def test_of_steps_go_with_the_run(self):
        run = dv.Run(scene(grid()))
        file = pathlib.Path(run._arrays._path)
        self.assertTrue(file.exists())
        del run
        self.assertFalse(file.exists())


class Meshes(unittest.TestCase):
    solid = {"name": "beam", "supports": [{"on": "end"}],
             "sets": [{"name": "end", "place": "plane", "point": [0, 0, 0], "normal": [1, 0, 0]}],
             "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000}}
    rest = {"gravity": [0, 0, -9.81], "steps": {"dt": 1e-4}, "stages": [{"do": "run", "time": 0.1}]}

    def test_of_arrays_are_those_of_boxes(self):
        nodes, elements = brick((6, 2, 2), (1, 0.2, 0.2))
        mesh = {"mesh": "file", "file": {"nodes": nodes, "elements": elements, "shape": "hex8"}}
        box = {"mesh": "box", "cell": "hex8", "cells": [6, 2, 2], "box": [[0, 0, 0], [1, 0.2, 0.2]]}
        one, other = (dv.Run({**self.rest, "solids": [{**self.solid, **kind}]}) for kind in (mesh, box))
        for run in (one, other):
            run.advance(200)
        beam, same = one.solids["beam"], other.solids["beam"]
        np.testing.assert_allclose(beam.X, same.X, atol=1e-15)
        np.testing.assert_allclose(beam.u, same.u, rtol=1e-9, atol=1e-15)
        self.assertGreater(np.abs(beam.u).max(), 1e-4)

    def test_what_is_wrong_is_told_with_its_place(self):
        nodes, elements = brick((2, 1, 1), (1, 0.2, 0.2))
        for change, told in (({"shape": "hex9"}, r'"hex9" \[solids.0.file\]: give one of hex8'),
                             ({"shape": "tet4"}, r"rows of 4 numbers \[solids.0.file.elements\]"),
                             ({"elements": elements + 1}, "names number 12 of 12"),
                             ({"elements": elements.astype(float)}, "no integers but float64"),
                             ({"elements": elements[:, [4, 5, 6, 7, 0, 1, 2, 3]]}, "element"),
                             ({"nodes": None}, '"nodes" is missing'),
                             ({"node": nodes}, 'write "nodes"')):
            file = {"nodes": nodes, "elements": elements, "shape": "hex8", **change}
            with self.subTest(told), self.assertRaisesRegex(dv.InputError, told):
                dv.Run({**self.rest, "solids": [{**self.solid, "mesh": "file", "file": file}]})


class Walls(unittest.TestCase):
    def floor(self, **change):
        triangles = {"points": np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]]) + 1e-17,
                     "triangles": np.array([[0, 1, 2], [0, 2, 3]]), **change}
        return scene(grid(), walls=[{"shape": "mesh", "file": triangles}])

    def test_of_triangles_bear_grains(self):
        run = dv.Run(self.floor())
        run.advance(2000)
        contacts = run.grains.contacts()
        self.assertTrue((contacts["second"] < 0).any())
        self.assertGreater(run.grains.x[:, 2].min(), 0.008)

    def test_what_is_wrong_is_told_with_its_place(self):
        for change, told in (({"triangles": [[0, 1, 4]]}, r"point 4 of 4 \[walls.0.file\]"),
                             ({"points": np.zeros((4, 2))}, r"shape of points is \(4, 2\)"),
                             ({"triangles": [[0, 1, -1]]}, "count from 0")):
            with self.subTest(told), self.assertRaisesRegex(dv.InputError, told):
                dv.Run(self.floor(**change))


if __name__ == "__main__":
    unittest.main()
