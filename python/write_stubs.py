#!/usr/bin/env python3
"""write_stubs.py FOLDER: writes FOLDER/_core.pyi, types of dovetail._core in FOLDER, from what its docstrings say.

pybind11 puts the signature into the first line of a docstring. Editors and mypy read the result; a test compares it
with the module. A type of C++ that no class of Python stands for is an error: bind the class before what uses it.
"""
import ast
import inspect
import pathlib
import re
import sys

ARRAY = "numpy.typing.NDArray"
HEAD = '''# Written by python/write_stubs.py from the module.
"""{doc}"""
import collections.abc
import os
import typing

import numpy
import numpy.typing


class _Settable:
    """An array that is given as a copy, and set from anything that numpy takes for such an array."""

    def __get__(self, instance: object, owner: typing.Any = ...) -> {array}[numpy.float64]: ...
    def __set__(self, instance: object, value: numpy.typing.ArrayLike) -> None: ...
'''

# What pybind11 calls a type: what it gives, what it takes.
TYPES = {
    "function": ("collections.abc.Callable[..., typing.Any]",) * 2,
    "Callable": ("collections.abc.Callable[..., typing.Any]",) * 2,
    "object": ("typing.Any",) * 2,
    "handle": ("typing.Any",) * 2,
    "dict": ("dict[str, typing.Any]",) * 2,
    "list": ("list[typing.Any]", "collections.abc.Sequence[typing.Any]"),
    "tuple": ("tuple[typing.Any, ...]",) * 2,
    "numpy.ndarray": ("numpy.typing.NDArray[typing.Any]", "numpy.typing.ArrayLike"),
    "os.PathLike": ("str", "str | os.PathLike[str]"),
    "Iterator": ("collections.abc.Iterator[typing.Any]",) * 2,
}
GENERIC = {"List": ("list", "collections.abc.Sequence"), "Dict": ("dict", "collections.abc.Mapping"),
           "Tuple": ("tuple", "tuple"), "Set": ("set", "collections.abc.Set"),
           "Callable": ("collections.abc.Callable",) * 2, "Iterator": ("collections.abc.Iterator",) * 2}
PLAIN = {"int", "float", "bool", "str", "bytes", "None", "..."}


def split(text, separator=","):
    """Parts of text at separators outside of all brackets and quotes."""
    parts, depth, quote, start = [], 0, "", 0
    for k, c in enumerate(text):
        if quote:
            quote = "" if c == quote else quote
        elif c in "'\"":
            quote = c
        elif c in "[(<{":
            depth += 1
        elif c in "])}" or (c == ">" and text[k - 1] != "-"):
            depth -= 1
        elif c == separator and depth == 0:
            parts.append(text[start:k].strip())
            start = k + 1
    parts.append(text[start:].strip())
    return [part for part in parts if part]


def python_type(text, taken, classes):
    """The type of pybind11's text; `taken`: of a parameter."""
    text = text.strip()
    if text in TYPES:
        return TYPES[text][taken]
    if text in PLAIN:
        return text
    if text.startswith("numpy.ndarray["):
        number = split(text[len("numpy.ndarray["):-1])[0].replace("bool", "numpy.bool_")
        return "numpy.typing.ArrayLike" if taken else f"{ARRAY}[{number}]"
    name, bracket, inside = text.partition("[")
    if bracket:
        inside = split(inside[:-1])
        if name in ("Optional", "Union"):
            inside += ["None"] * (name == "Optional")
            return " | ".join(python_type(one, taken, classes) for one in inside)
        if name in GENERIC:
            parts = [f"[{', '.join(python_type(p, False, classes) for p in split(one[1:-1]))}]" if one.startswith("[")
                     else python_type(one, taken and name != "Callable", classes) for one in inside]
            return f"{GENERIC[name][taken]}[{', '.join(parts)}]"
    own = text.removeprefix("dovetail._core.")
    if own in classes:
        return own
    raise ValueError(f"no class of Python stands for {text}: bind it before what uses it")


def default(text):
    try:
        ast.literal_eval(text)
        return text
    except (ValueError, SyntaxError):
        return "..."


def signatures(doc):
    """(name, parameters, result) of each overload that a docstring begins with, and the rest of it."""
    lines = (doc or "").strip("\n").split("\n")
    head = r"(\w*)\((.*)\) -> (.*)"
    if len(lines) > 1 and lines[1] == "Overloaded function.":
        numbered = [re.fullmatch(r"\d+\. " + head, line) for line in lines]
        found = [match.groups() for match in numbered if match]
        rest = [line for line, match in zip(lines[2:], numbered[2:]) if not match]
    else:
        match = re.fullmatch(head, lines[0])
        found, rest = ([match.groups()], lines[1:]) if match else ([], lines)
    return found, re.sub(r"\n\s*\n+", "\n\n", "\n".join(rest)).strip()


def parameters(text, classes):
    all_of_them = []
    for one in split(text):
        if one.startswith("*"):
            all_of_them.append(one if one == "*" else f"{one}: typing.Any")
            continue
        name, colon, kind = one.partition(":")
        if name == "self" or not colon:
            all_of_them.append(name)
            continue
        kind, equals, value = kind.partition(" = ")
        all_of_them.append(f"{name}: {python_type(kind, True, classes)}" + (f" = {default(value)}" if equals else ""))
    return all_of_them


def quoted(doc, indent):
    """As the body of a function."""
    if not doc:
        return " ..."
    text = doc.replace("\\", "\\\\").replace('"""', "'''").replace("\n", "\n" + indent)
    return f'\n{indent}"""{text}"""'.replace(f"\n{indent}\n", "\n\n")


def function(name, doc, classes, indent, method, static=False):
    found, rest = signatures(doc)
    if not found:
        raise ValueError(f"the docstring of {name} has no signature")
    lines = []
    for _, given, result in found:
        names = parameters(given, classes)
        if method and not static and names:
            names[0] = "self"
        lines += [f"{indent}@typing.overload"] * (len(found) > 1) + [f"{indent}@staticmethod"] * static
        kind = python_type(result, False, classes)
        lines.append(f"{indent}def {name}({', '.join(names)}) -> {kind}:{quoted(rest, indent + '    ')}")
        rest = ""
    return lines


def field(name, value, classes):
    """A property. Its getter's docstring has the type, its own the meaning."""
    found, _ = signatures(value.fget.__doc__)
    kind = python_type(found[0][2], False, classes) if found else "typing.Any"
    doc = quoted(inspect.cleandoc(value.__doc__ or ""), "        ")
    if value.fset and kind == f"{ARRAY}[numpy.float64]":
        text = [f"    {name}: _Settable"]
        return text + ([f"    {doc.strip()}"] if value.__doc__ else [])
    lines = ["    @property", f"    def {name}(self) -> {kind}:{doc}"]
    if value.fset:
        lines += [f"    @{name}.setter", f"    def {name}(self, value: {kind}) -> None: ..."]
    return lines


def is_public(name, value):
    hidden = {"__module__", "__doc__", "__new__", "__dict__", "__weakref__", "__entries", "__hash__"}
    if name == "__init__" and not signatures(value.__doc__)[0]:
        return False  # made by functions of C++ alone
    return name not in hidden and not name.startswith("_pybind11") and value is not None


def of_class(name, kind, classes):
    """Its members, in the order they were bound in."""
    base = kind.__base__.__name__ if kind.__base__.__module__ in ("builtins", "dovetail._core") else "object"
    base = "" if base in ("object", "pybind11_object") else f"({base})"
    lines = ["", "", f"class {name}{base}:"]
    doc = inspect.cleandoc(kind.__doc__ or "")
    body = [f'    """{doc}"""'.replace("\n", "\n    ")] if doc else []
    for member, value in vars(kind).items():
        if issubclass(kind, BaseException) or not is_public(member, value):
            continue
        if isinstance(value, property):
            body += field(member, value, classes)
        elif isinstance(value, kind):
            body.append(f"    {member}: typing.ClassVar[{name}]")
        elif callable(value):
            static = isinstance(value, staticmethod)
            body += function(member, value.__doc__, classes, "    ", True, static)
        else:
            body.append(f"    {member}: typing.Any")
    return lines + (body or ["    ..."])


def stubs(module):
    members = {name: value for name, value in vars(module).items() if not name.startswith("__")}
    classes = [name for name, value in members.items() if isinstance(value, type)]
    lines = HEAD.format(doc=module.__doc__, array=ARRAY).rstrip().split("\n")
    for name in classes:
        lines += of_class(name, members[name], classes)
    for name, value in members.items():
        if name in classes:
            continue
        lines += ["", ""]
        if callable(value):
            lines += function(name, value.__doc__, classes, "", False)
        else:
            lines.append(f"{name}: {type(value).__name__}")
    return "\n".join(lines) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1])
    sys.path.insert(0, str(folder.parent))
    from dovetail import _core
    (folder / "_core.pyi").write_text(stubs(_core))


if __name__ == "__main__":
    main()
