"""Cells of grains."""

from __future__ import annotations

import os
import typing

from . import _core
from ._core import InputError

_Path = typing.Union[str, "os.PathLike[str]"]


def make_cells(cells: dict[str, typing.Any] | _Path, folder: _Path | None = None,
               **settings: typing.Any) -> list[_core.Rve]:
    """Cells of grains, prepared: a list of Rve. `cells`: a dict as an item of "cells" in scenes, or a file of one."""
    from . import _json, _text
    changes = [f"{key}={_text(value)}" for key, value in settings.items()]
    if isinstance(cells, dict):
        named = {"name": "cells", **cells}
        return _core.make_cells(_json(named), "cells", folder or os.getcwd(), changes)
    path = os.fspath(cells)
    if folder is not None:
        raise InputError("a file has its folder [make_cells]: leave folder out")
    with open(path, encoding="utf-8") as file:
        return _core.make_cells(file.read(), path, os.path.dirname(os.path.abspath(path)), changes)
