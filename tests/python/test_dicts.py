"""Scenes as dicts: what numpy has in place of what JSON has, and what is refused."""
import os
import subprocess
import sys
import unittest

import dovetail as dv
import numpy as np


def beads(**changes):
    places = np.indices((3, 3, 3)).reshape(3, -1).T * 0.021 + [0, 0, 0.011]
    return {"contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.8},
            "particles": [{"from": "list", "density": 2500, "spheres": [{"at": at, "radius": 0.01} for at in places]}],
            **changes}


class Dicts(unittest.TestCase):
    def test_may_have_arrays_and_numbers_of_numpy(self):
        spheres = [{"at": [0.0, 0.021 * k, 0.011], "radius": 0.01} for k in range(4)]
        arrays = [{"at": np.array(one["at"]), "radius": np.float32(0.01).astype(float)} for one in spheres]
        plain = beads(gravity=[0, 0, -9.81], steps={"dt": 1e-5, "per_macro_step": 2})
        other = beads(gravity=np.array([0, 0, -9.81]), steps={"dt": np.float64(1e-5), "per_macro_step": np.int64(2)})
        plain["particles"][0]["spheres"], other["particles"][0]["spheres"] = spheres, arrays
        ours, theirs = dv.Run(other), dv.Run(plain)
        ours.advance(100)
        theirs.advance(100)
        np.testing.assert_allclose(ours.grains.x, theirs.grains.x, rtol=1e-7)
        self.assertEqual(dv.Run(plain, **{"steps.per_macro_step": np.int64(4)}).macro_step, 4e-5)

    def test_need_no_stages_step_by_step(self):
        scene = beads(steps={"dt": 1e-5})
        run = dv.Run(scene)
        run.advance(10)
        self.assertAlmostEqual(run.time, 1e-4)
        self.assertNotIn("stages", scene)  # as it was
        with self.assertRaisesRegex(ValueError, "stages"):
            dv.run(scene, out="never")

    def test_with_what_no_scene_says_are_refused(self):
        for value in (object(), {1, 2}, b"bytes"):
            with self.assertRaisesRegex(dv.InputError, "a scene cannot say"):
                dv.Run(beads(gravity=value))
        for value in (np.nan, np.array([0, np.inf, 0])):
            with self.assertRaisesRegex(dv.InputError, "not finite"):
                dv.Run(beads(gravity=value))
        with self.assertRaisesRegex(dv.InputError, "not finite"):
            dv.Run(beads(), **{"steps.dt": np.nan})


class Arguments(unittest.TestCase):
    def test_numbers_of_steps_are_whole(self):
        run = dv.Run(beads())
        run.advance(np.int32(2))
        with self.assertRaisesRegex(TypeError, "'float' object cannot be interpreted as an integer"):
            run.advance(10.0)

    def test_forces_are_functions(self):
        with self.assertRaisesRegex(dv.InputError, "the force is 'wind': give a function of t, x, v"):
            dv.Run(beads()).force("wind")

    def test_another_python_is_told_which_one_to_take(self):
        told = subprocess.run([sys.executable, "-S", "-c", "import dovetail"], capture_output=True, text=True,
                              env=os.environ).stderr
        self.assertIn("No module named 'numpy'", told)
        self.assertIn("Debian's is /usr/bin/python3", told)


if __name__ == "__main__":
    unittest.main()
