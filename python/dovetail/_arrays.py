"""Arrays in the dict of a scene: they become files that the scene names."""

from __future__ import annotations

import difflib
import hashlib
import os
import shutil
import tempfile
import typing
import weakref

import numpy as np

from . import _core

_Array = np.ndarray[typing.Any, typing.Any]
_Dict = typing.Dict[str, typing.Any]
_SPHERES = ("at", "radius", "velocity", "spin")
_MESH = ("nodes", "elements", "shape")
_SURFACE = ("points", "triangles")


def _refuse(problem: str, where: str, remedy: str) -> typing.NoReturn:
    raise _core.InputError(f"{problem} [{where}]: {remedy}")


def _numbers(value: typing.Any, where: str) -> _Array:
    try:
        return np.asarray(value, dtype=float, order="C")
    except (TypeError, ValueError) as error:
        _refuse(f"these are no numbers ({error})", where, "give an array of floats, in SI units")


def _integers(value: typing.Any, where: str) -> _Array:
    array = np.asarray(value)
    if array.dtype.kind not in "iu":
        _refuse(f"these are no integers but {array.dtype}", where, "give an array of integers")
    return np.asarray(array, dtype=np.int64, order="C")


def _require_keys(arrays: _Dict, known: tuple[str, ...], needed: tuple[str, ...], where: str) -> None:
    for key in arrays:
        if key not in known:
            near = difflib.get_close_matches(str(key), known, 1)
            _refuse(f'there is no key "{key}"', where, f'write "{near[0]}"' if near else "leave it out")
    for key in needed:
        if arrays.get(key) is None:
            _refuse(f'the key "{key}" is missing', where, "give it a value")


def _digest(*values: typing.Any) -> str:
    hashed = hashlib.blake2b(digest_size=8)
    for value in values:
        hashed.update(repr((getattr(value, "shape", None), getattr(value, "dtype", None))).encode())
        hashed.update(value if isinstance(value, np.ndarray) else repr(value).encode())
    return hashed.hexdigest()


def _write_surface(path: str, points: typing.Any, triangles: typing.Any, where: str) -> None:
    """PLY, to the last digit."""
    points, triangles = _numbers(points, where + ".points"), _integers(triangles, where + ".triangles")
    for name, array in (("points", points), ("triangles", triangles)):
        if array.ndim != 2 or array.shape[1] != 3 or len(array) == 0:
            _refuse(f"the shape of {name} is {array.shape}", where, "give rows of three")
    if triangles.min() < 0 or triangles.max() >= len(points):
        _refuse(f"triangles name point {max(triangles.max(), -triangles.min())} of {len(points)}", where,
                "numbers count from 0")
    faces = np.empty(len(triangles), dtype=[("count", "u1"), ("points", "<i4", 3)])
    faces["count"], faces["points"] = 3, triangles
    with open(path, "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty double x\n"
                    f"property double y\nproperty double z\nelement face {len(triangles)}\n"
                    "property list uchar int vertex_indices\nend_header\n").encode())
        file.write(points.astype("<f8").tobytes())
        file.write(faces.tobytes())


class Folder:
    """Where the arrays of one scene go, made as soon as there are any."""

    def __init__(self, path: str | None = None) -> None:
        self._path = path
        self._made: list[str] = []

    def file(self, name: str, *values: typing.Any) -> str:
        """A file in a folder of its own for this content; whoever calls writes it."""
        if self._path is None:
            self._path = tempfile.mkdtemp(prefix="dovetail-")
            weakref.finalize(self, shutil.rmtree, self._path, ignore_errors=True)
        folder = os.path.join(os.path.abspath(self._path), "arrays", _digest(*values))
        missing = []
        while not os.path.isdir(folder):
            missing.append(folder)
            folder = os.path.dirname(folder)
        for one in reversed(missing):
            os.mkdir(one)
        file = os.path.join(missing[0] if missing else folder, name)
        self._made += [*reversed(missing), file] if missing else []
        return file

    def take_back(self) -> None:
        """Leaves nothing behind of a run that was refused."""
        for path in reversed(self._made):
            try:
                os.rmdir(path) if os.path.isdir(path) else os.remove(path)
            except OSError:  # somebody else uses it, or it has not been written
                pass


def _place(folder: Folder | None, where: str, name: str, *values: typing.Any) -> str:
    if folder is None:
        _refuse("a scene with arrays is read where it is run", where, "give the dict to run, Run or check")
    return folder.file(name, *values)


def _spheres(group: _Dict, folder: Folder | None, where: str) -> _Dict:
    arrays = group["spheres"]
    _require_keys(arrays, _SPHERES, ("at", "radius"), where)
    values = [None if arrays.get(key) is None else _numbers(arrays[key], f"{where}.{key}") for key in _SPHERES]
    path = _place(folder, where, "spheres.csv", *values)
    if not os.path.exists(path):
        _core._write_spheres(path, *values, where)
    return {**{key: value for key, value in group.items() if key != "spheres"}, "from": "csv", "file": path}


def _file(arrays: _Dict, folder: Folder | None, where: str) -> str:
    if "points" in arrays or "triangles" in arrays:
        _require_keys(arrays, _SURFACE, _SURFACE, where)
        values = [arrays["points"], arrays["triangles"]]
        path = _place(folder, where, "surface.ply", *map(np.asarray, values))
        _write_surface(path, *values, where)
        return path
    _require_keys(arrays, _MESH, _MESH, where)
    values = [_numbers(arrays["nodes"], where + ".nodes"), _integers(arrays["elements"], where + ".elements")]
    path = _place(folder, where, "mesh.msh", *values, arrays["shape"])
    _core._write_mesh(path, *values, str(arrays["shape"]), where)
    return path


def written(value: typing.Any, folder: Folder | None, where: str = "") -> typing.Any:
    """A scene with names of files in place of the arrays of grains, meshes and surfaces, which `folder` gets."""
    def inner(key: typing.Any) -> str:
        return f"{where}.{key}" if where else str(key)

    if isinstance(value, dict):
        if value.get("from") == "list" and isinstance(value.get("spheres"), dict):
            value = _spheres(value, folder, inner("spheres"))
        return {key: _file(one, folder, inner(key)) if key == "file" and isinstance(one, dict)
                else written(one, folder, inner(key)) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [written(one, folder, inner(k)) for k, one in enumerate(value)]
    return value
