"""Stubs of the module name what it has."""
import ast
import pathlib
import re
import unittest

import dovetail
from dovetail import _core

STUBS = ast.parse((pathlib.Path(dovetail.__file__).parent / "_core.pyi").read_text())
OF_EVERY_CLASS = {"__module__", "__doc__", "__new__", "__dict__", "__weakref__", "__hash__"}


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


if __name__ == "__main__":
    unittest.main()
