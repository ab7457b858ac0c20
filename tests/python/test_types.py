"""Types: what Python adds to the module is annotated, and mypy reads all of it."""
import importlib.util
import inspect
import os
import pathlib
import subprocess
import sys
import tempfile
import typing
import unittest

import dovetail as dv

FOLDER = pathlib.Path(dv.__file__).parent

GOOD = """
import typing
import numpy as np
import numpy.typing as npt
import dovetail as dv

Array = npt.NDArray[np.float64]
run = dv.Run("mine.json", speed="4 m/s")
scene: dict[str, typing.Any] = {"gravity": [0, 0, -9.81]}
other = dv.Run(scene)

@run.force
def wind(t: float, x: Array, v: Array) -> Array:
    return -0.1 * v

for made in run.steps(100, every=10):
    height: float = run.grains.x[:, 2].mean()
    run.grains.v = [0, 0, -1]
    energy: float = run.ledger["residual"]
    state: bytes = run.save()
    sag: float = run.solids["plate"].u[:, 2].min()
folder: str = dv.run(scene, out="there")
"""
# Each line is wrong; what mypy says of it.
WRONG = {
    'dv.Run(3)': "incompatible type",
    'run.advance("ten")': "incompatible type",
    'run.grains.y': 'no attribute "y"',
    'run.grains.x = 0': 'read-only',
    'run.time = 0.0': "read-only",
    'run.load("text")': "incompatible type",
    'dv.run(scene, folder_of_files="there", out=3)': "incompatible type",
    'dv.steps': 'no attribute "steps"',
}


def public_callables():
    """Functions and classes of Python's own, with their methods."""
    for name in dv.__all__:
        thing = getattr(dv, name)
        if inspect.isfunction(thing):
            yield name, thing
        elif inspect.isclass(thing) and thing.__module__.startswith("dovetail") and not thing.__module__.endswith("_core"):
            for member, value in vars(thing).items():
                value = value.fget if isinstance(value, property) else value
                if inspect.isfunction(value) and (not member.startswith("_") or member == "__init__"):
                    yield f"{name}.{member}", value


def mypy(text):
    """What it says of a script."""
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "script.py").write_text(text)
        environment = {name: value for name, value in os.environ.items() if name not in ("LD_PRELOAD", "PYTHONPATH")}
        done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "script.py"], cwd=folder,
                              env={**environment, "MYPYPATH": str(FOLDER.parent)}, capture_output=True, text=True)
        assert done.returncode < 2, done.stdout + done.stderr
        return [line for line in done.stdout.splitlines() if line.startswith("script.py:")]


class Annotations(unittest.TestCase):
    def test_what_python_adds_is_annotated(self):
        for name, function in public_callables():
            signature, hints = inspect.signature(function), typing.get_type_hints(function)
            wanted = {p for p in signature.parameters if p != "self"} | {"return"}
            self.assertLessEqual(wanted, set(hints), f"{name} is not annotated")
            self.assertTrue(name.endswith("__init__") or function.__doc__, f"{name} has no docstring")


@unittest.skipUnless(importlib.util.find_spec("mypy"), "needs mypy")
class Mypy(unittest.TestCase):
    def test_takes_what_is_right(self):
        self.assertEqual(mypy(GOOD), [])

    def test_finds_what_is_wrong(self):
        told = mypy(GOOD + "\n".join(WRONG))
        first = GOOD.count("\n") + 1
        for k, (line, message) in enumerate(WRONG.items()):
            about = [one for one in told if one.startswith(f"script.py:{first + k}:")]
            self.assertTrue(any(message in one for one in about), f"{line}: {about}")


if __name__ == "__main__":
    unittest.main()
