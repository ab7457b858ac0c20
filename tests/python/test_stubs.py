"""Types of the module: the stubs name what it has, what Python adds is annotated, and mypy reads both."""
import ast
import importlib.util
import inspect
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import typing
import unittest

import dovetail as dv
from dovetail import _core

FOLDER = pathlib.Path(dv.__file__).parent
STUBS = ast.parse((FOLDER / "_core.pyi").read_text())
OF_EVERY_CLASS = {"__module__", "__doc__", "__new__", "__dict__", "__weakref__", "__hash__"}

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


class Stubs(unittest.TestCase):
    def test_name_what_the_module_has(self):
        there = {name for name in vars(_core) if not name.startswith("__")}
        named = {node.name for node in STUBS.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        named |= {node.target.id for node in STUBS.body if isinstance(node, ast.AnnAssign)}
        self.assertEqual(named - {"_Settable"}, there)

    def test_name_the_members_of_classes(self):
        for node in STUBS.body:
            if not isinstance(node, ast.ClassDef) or node.name == "_Settable":
                continue
            kind = getattr(_core, node.name)
            there = set() if issubclass(kind, BaseException) else {
                name for name, value in vars(kind).items() if name not in OF_EVERY_CLASS
                and not name.startswith("_pybind11") and not (value.__doc__ or "").startswith("Initialize self")}
            named = {one.name if isinstance(one, ast.FunctionDef) else one.target.id for one in node.body
                     if isinstance(one, (ast.FunctionDef, ast.AnnAssign))}
            self.assertEqual(named, there, node.name)

    def test_have_the_parameters_of_the_docstrings(self):
        classes = [node for node in STUBS.body if isinstance(node, ast.ClassDef) and node.name != "_Settable"]
        checked = 0
        for holder, owner in [(STUBS, _core), *((node, getattr(_core, node.name)) for node in classes)]:
            skipped = int(holder is not STUBS)  # self, whose name differs
            for node in holder.body:
                if not isinstance(node, ast.FunctionDef) or node.decorator_list:
                    continue
                head = getattr(owner, node.name).__doc__.split("\n")[0]
                while (short := re.sub(r"\[[^\[\]]*\]", "", head)) != head:  # types within types are no parameters
                    head = short
                told = re.findall(r"[(,] ?\*{0,2}(\w+)(?=[:,)])", head[:head.index(" -> ")])
                args = [*node.args.posonlyargs, *node.args.args, node.args.vararg, *node.args.kwonlyargs, node.args.kwarg]
                self.assertEqual([one.arg for one in args if one][skipped:], told[skipped:], head)
                checked += 1
        self.assertGreater(checked, 10)

    def test_come_with_docstrings(self):
        for name, value in vars(_core).items():
            members = vars(value) if isinstance(value, type) and not issubclass(value, BaseException) else {}
            for member, one in {name: value, **{f"{name}.{m}": v for m, v in members.items()}}.items():
                if isinstance(one, property) and not member.split(".")[-1].startswith("_"):
                    self.assertTrue(one.__doc__, f"{member} has no docstring")

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
