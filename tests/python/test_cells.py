"""Cells of grains from Python."""
import csv
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
from test_run import PROGRAM, SCENES

DISCS = {"grains": "discs", "count": 80, "radius": {"smallest": "3 mm", "largest": "7 mm"}, "density": 2650,
         "thickness": "10 cm", "contact": {"law": "linear", "modulus": "600 MPa", "friction": 0.5},
         "prepare": [{"pressure": "100 kPa", "friction": 0.1}]}
SPHERES = {"grains": "spheres", "count": 150, "radius": {"smallest": "0.8 mm", "largest": "1.2 mm"}, "density": 2500,
           "contact": {"law": "Hertz", "youngs_modulus": "60 GPa", "poisson_ratio": 0.2, "friction": 0.4},
           "prepare": [{"pressure": "1 MPa", "friction": 0.1}]}


def setUpModule():
    global discs, spheres
    discs, = dv.make_cells(DISCS)
    spheres, = dv.make_cells(SPHERES)


def cell(of=None):
    return (of or discs).copy()


class States(unittest.TestCase):
    def test_stress_fabric_and_forces_are_those_of_the_contacts(self):
        for of in (discs, spheres):
            now = cell(of)
            found = now.contacts()
            virial = np.einsum("ci,cj->ij", found["force"], found["branch"]) / now.volume
            np.testing.assert_allclose(now.stress, (virial + virial.T) / 2, rtol=1e-10, atol=1e-6 * now.pressure)
            normals = found["branch"] / np.linalg.norm(found["branch"], axis=1)[:, None]
            np.testing.assert_allclose(now.fabric, np.einsum("ci,cj->ij", normals, normals) / len(normals), rtol=1e-12,
                                       atol=1e-14)
            forces = np.zeros_like(now.x)
            np.add.at(forces, found["first"], found["force"])
            np.add.at(forces, found["second"], -found["force"])
            np.testing.assert_allclose(now.f, forces, atol=1e-9 * np.abs(found["force"]).max())
            self.assertEqual(now.balance["contacts"], len(normals))
            self.assertLess(now.balance["unbalanced"], 1e-3)
            self.assertEqual(now.x.shape, (len(now), 3))
            np.testing.assert_allclose(np.abs(np.linalg.det(now.lattice)), now.volume, rtol=1e-12)
            F, J = now.F, np.linalg.det(now.F)
            np.testing.assert_allclose(now.nominal_stress, J * now.stress @ np.linalg.inv(F).T, rtol=1e-12, atol=1e-6)

    def test_pressure_is_that_of_the_preparation(self):
        np.testing.assert_allclose(np.diag(discs.stress)[:2], -1e5, rtol=1e-3)
        np.testing.assert_allclose(np.diag(spheres.stress), -1e6, rtol=1e-3)
        self.assertEqual((discs.shape, spheres.shape), ("disc", "sphere"))

    def test_goes_on_from_states_to_the_same_digits(self):
        F = np.eye(3)
        F[1, 1] = 0.998
        for of in (discs, spheres):
            once, again = cell(of), cell(of)
            state = once.save()
            once.follow_path(F)
            again.relax(tolerance=1e-6)
            again.load(state)
            again.follow_path(F)
            self.assertEqual(once.save(), again.save())
            self.assertNotEqual(once.save(), state)
            np.testing.assert_array_equal(of.F, np.eye(3))  # copies are their own

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            now = cell()
            now.follow_path(np.diag([1.0, 0.999, 1.0]))
            dv.write_cells(folder + "/a.cells", [now, discs])
            one, two = dv.read_cells(folder + "/a.cells")
            self.assertEqual((one.save(), two.save()), (now.save(), discs.save()))
            same, _ = dv.make_cells({"grains": "file", "file": "a.cells"}, folder=folder)
            self.assertEqual(same.save(), now.save())
            data = bytearray(pathlib.Path(folder + "/a.cells").read_bytes())
            data[len(data) // 2] ^= 1
            pathlib.Path(folder + "/b.cells").write_bytes(data)
            for wrong in ("b.cells", "none.cells"):
                with self.assertRaises(ValueError):
                    dv.read_cells(f"{folder}/{wrong}")

    def test_of_a_scene(self):
        run = dv.Run(SCENES / "ball-on-cells.json")
        (name, cells), = run.cells.items()
        self.assertTrue(all(one.pressure > 0 for one in cells), name)
        before = run.save()
        cells[0].compress(2 * cells[0].pressure)
        self.assertEqual(run.save(), before)


class Paths(unittest.TestCase):
    def test_tangent_is_the_derivative_of_the_stress(self):
        now = cell()
        now.set_springs(friction=np.inf)
        now.relax(tolerance=1e-9)
        A, before = now.elastic_tangent(), now.nominal_stress
        dF = np.zeros((3, 3))
        dF[0, 0], dF[0, 1] = 1e-7, 2e-7
        now.follow_path(np.eye(3) + dF, rest=1e-9)
        answer = now.nominal_stress - before
        np.testing.assert_allclose(answer, np.einsum("iJkL,kL->iJ", A, dF), atol=3e-3 * np.abs(answer).max())

    def test_operators_are_ordered(self):
        elastic, voigt = discs.elastic_tangent(), discs.voigt_tangent()
        stretch = np.diag([1.0, -1.0, 0.0])
        energy = [np.einsum("ij,ijkl,kl", stretch, A, stretch) for A in (elastic, voigt)]
        self.assertGreater(energy[1], energy[0])
        self.assertGreater(energy[0], 0)
        moduli = discs.moduli(voigt)
        self.assertGreater(moduli["bulk"], discs.moduli(elastic)["bulk"])

    def test_drives_keep_what_they_hold_and_close_the_ledger(self):
        now, seen = cell(), []
        start = now.ledger["stored"]
        found = now.drive(np.linspace(0.002, 0.01, 5), "biaxial", axis="y", pressure=1e5,
                          each=lambda state: seen.append((state["strain"], now.F.copy())))
        self.assertEqual(found["F"].shape, (6, 3, 3))
        np.testing.assert_allclose(found["stress"][1:, 0, 0], -1e5, rtol=1e-3)
        np.testing.assert_allclose(found["F"][:, 1, 1], np.exp(-found["strain"]), rtol=1e-9)
        self.assertGreater(-found["stress"][-1, 1, 1], 1.2e5)
        for (strain, F), other, G in zip(seen, found["strain"], found["F"]):
            self.assertEqual(strain, other)
            np.testing.assert_array_equal(F, G)
        book = {name: found[name][-1] - found[name][0] for name in ("work", "friction", "damping", "stored", "kinetic")}
        self.assertLess(abs(book["work"] - book["friction"] - book["damping"] - book["stored"] - book["kinetic"]),
                        1e-3 * abs(book["work"]) + 1e-9 * start)

    def test_undrained_keeps_the_volume(self):
        found = cell(spheres).drive([0.002, 0.004], "triaxial", axis="z")
        np.testing.assert_allclose(found["volume"], found["volume"][0], rtol=1e-12)
        rate = np.diag([0.5, 0.5, -1.0])
        own = cell(spheres).drive([0.002, 0.004], rate=rate)
        np.testing.assert_array_equal(own["stress"], found["stress"])

    def test_the_numbers_of_the_program(self):
        plan = {"cells": [{"name": "d", **DISCS}],
                "drive": [{"name": "t", "do": "biaxial", "strain": 0.004, "outputs": 4}]}
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "plan.json"
            path.write_text(json.dumps(plan))
            subprocess.run([PROGRAM, "cell", path, "--out", folder + "/out"], check=True, capture_output=True)
            lines = [line for line in (pathlib.Path(folder) / "out/t_cells.csv").read_text().splitlines()
                     if not line.startswith("#")]
            rows = list(csv.DictReader(lines))
        found = cell().drive(np.arange(1, 5) * 0.001, "biaxial", pressure=discs.pressure)
        columns = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
        for name, values in (("sigma_yy_Pa", found["stress"][:, 1, 1]), ("void_ratio", found["void_ratio"]),
                             ("coordination", found["coordination"])):
            np.testing.assert_array_equal(columns[name], values, name)

    def test_pressing_and_deforming(self):
        now = cell()
        now.compress([2e5, 1e5, 1e5], friction=0.2)
        np.testing.assert_allclose(np.diag(now.stress)[:2], [-2e5, -1e5], rtol=1e-3)
        np.testing.assert_array_equal(now.F, np.eye(3))
        G = np.diag([1.0, 0.9999, 1.0])
        now.deform(G)
        np.testing.assert_allclose(now.F, G, rtol=1e-14)
        grains, stress = len(now), now.stress
        now.repeat()
        self.assertEqual(len(now), 2 * grains)
        np.testing.assert_allclose(now.stress, stress, rtol=1e-9)
        now.follow_path(np.diag([1.0, 0.9995, 1.0]), rest=None)
        self.assertGreater(now.ledger["kinetic"], 0)
        now.stop()
        self.assertEqual(np.abs(now.v).max(), 0)

    def test_refusals(self):
        out_of_plane = np.diag([1.0, 1.0, 0.99])
        for act, message in (
                (lambda: cell().follow_path(np.zeros((2, 2))), r"no matrix of \(3, 3\)"),
                (lambda: cell().follow_path(np.full((3, 3), np.nan)), "not finite"),
                (lambda: cell().follow_path(-np.eye(3)), "det"),
                (lambda: cell().follow_path(out_of_plane), "plane"),
                (lambda: cell().follow_path(np.diag([1.0, 0.9, 1.0])), "5 %|strain"),
                (lambda: cell().follow_path(np.eye(3), inertial_number=1.0), "inertial"),
                (lambda: cell().compress(-1e5), "pressure"),
                (lambda: cell().drive([0.01], "triaxial"), "discs have no triaxial"),
                (lambda: cell().drive([0.01], "bend"), "no test 'bend'"),
                (lambda: cell().drive([0.01], "biaxial", axis="q"), "'q' is no axis"),
                (lambda: cell().drive([0.01]), "no single test"),
                (lambda: cell().drive([np.nan], "biaxial"), "strain"),
                (lambda: cell().drive([0.01], rate=np.eye(3)), "plane"),
                (lambda: cell().drive([0.01], "shear", stress=np.eye(3)), "stress of no rate"),
                (lambda: cell().set_springs(frction=0.1), "no 'frction'"),
                (lambda: cell().set_springs(friction=-1), "friction"),
                (lambda: cell().load(b"xyz"), ""),
                (lambda: cell().load(discs.save()[:-8]), ""),
                (lambda: cell().load(discs.save() + b"1234"), "more than a state"),
                (lambda: cell().load(spheres.save()), ""),
                (lambda: cell().moduli(np.eye(3)), r"\(3, 3, 3, 3\)"),
                (lambda: cell().relax(tolerance=0), "tolerance"),
                (lambda: dv.make_cells({**DISCS, "number_of": 3}), "number_of"),
                (lambda: dv.make_cells({**DISCS, "radius": "1 kg"}), "kg"),
                (lambda: dv.write_cells("/no/such/folder/a.cells", [discs]), "")):
            with self.subTest(message=message), self.assertRaisesRegex(ValueError, message):
                act()


class Python(unittest.TestCase):
    def test_nobody_looks_while_a_cell_changes(self):
        now, seen = cell(), []
        done = threading.Event()

        def look():
            while not done.is_set():
                try:
                    seen.append(now.x.shape)
                except ValueError as error:
                    seen.append(str(error))
                done.wait(1e-3)

        other = threading.Thread(target=look)
        other.start()
        now.drive(np.linspace(0.005, 0.02, 4), "biaxial", pressure=1e5)
        done.set()
        other.join()
        self.assertTrue(any("being changed" in str(one) for one in seen))
        self.assertTrue(all(one == (len(now), 3) or "being changed" in one for one in seen))

    def test_functions_within_a_drive_look_and_change_nothing(self):
        now = cell()
        with self.assertRaisesRegex(ValueError, "being changed"):
            now.drive([0.001], "biaxial", pressure=1e5, each=lambda state: now.relax())
        with self.assertRaisesRegex(KeyError, "mine"):
            now.drive([0.001], "biaxial", pressure=1e5, each=lambda state: {}["mine"])
        now.relax()  # it is free again

    def test_ctrl_c_ends_at_an_output(self):
        now = cell()
        threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            now.drive(np.linspace(0.0001, 5.0, 50000), "shear", pressure=1e5)
        now.relax()


if __name__ == "__main__":
    unittest.main()
