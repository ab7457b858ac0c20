"""What runs look like: fields, pictures, rows of series."""

from __future__ import annotations

import os
import typing

from numpy.typing import ArrayLike, NDArray

from . import _core
from ._core import InputError

_Path = typing.Union[str, "os.PathLike[str]"]
_Fields = typing.Dict[str, typing.Any]


class Picture:
    """A picture, as bytes of a PNG file, or a film, as bytes of a GIF file: `caption` says what it shows."""

    def __init__(self, data: bytes, caption: str, kind: str = "png") -> None:
        self._data, self.caption, self._kind = data, caption, kind

    @property
    def png(self) -> bytes | None:
        """Bytes of a PNG file; None of a film."""
        return self._data if self._kind == "png" else None

    @property
    def gif(self) -> bytes | None:
        """Bytes of a GIF file; None of a single picture."""
        return self._data if self._kind == "gif" else None

    def _repr_png_(self) -> bytes | None:
        return self.png

    def _repr_mimebundle_(self, include: typing.Any = None, exclude: typing.Any = None) -> dict[str, typing.Any]:
        return {f"image/{self._kind}": self._data, "text/plain": repr(self)}

    def __repr__(self) -> str:
        return f"<{'Picture' if self._kind == 'png' else 'Film'}: {self.caption}>"

    def save(self, path: _Path) -> str:
        """Writes the file, over one that is there; returns its path."""
        path = os.fspath(path)
        if not path.endswith("." + self._kind):
            raise InputError(f"this is a {self._kind.upper()} file [{path}]: give a name that ends in .{self._kind}")
        with open(path, "wb") as file:
            file.write(self._data)
        return path


def _given(grains: str | None, solids: str | None, lines: str | None,
           options: dict[str, typing.Any]) -> dict[str, typing.Any]:
    known = ("azimuth", "elevation", "cut", "uncut", "warp", "size", "background", "grain_range", "solid_range", "cell",
             "frame", "film", "mode")
    for name in options:
        if name not in known:
            raise InputError(f"pictures have no option '{name}' [picture]: give grains, solids, lines or one of "
                             f"{', '.join(known)}")
    if options.get("cut") is not None and options.get("uncut"):
        raise InputError("the picture is cut and uncut [picture]: leave out one of them")
    both = {"grains": grains, "solids": solids, "lines": lines, **options}
    return {name: value for name, value in both.items() if value is not None}


def fields(folder: _Path, kernel: str = "lucy", width: float | None = None, spacing: float | None = None,
           box: ArrayLike | None = None, points: ArrayLike | None = None, advise_width: bool = False) -> _Fields:
    """Coarse-grained fields of the last checkpoint in a folder, as `dovetail fields` writes them.

    Arrays by name (density, solid_fraction, momentum, velocity, stress, contact_stress, kinetic_stress, pressure,
    temperature, wall_force), of shape (nx, ny, nz, …) on a grid of `spacing` (m; half the width) in `box`
    ([[x, y, z], [x, y, z]], around all grains), or (n, …) at `points` (n, 3); `x` has the places, m. `width` of the
    kernel ("lucy" or "gauss"), m; 1.5 mean diameters if not given; `advise_width` takes the one on which fields depend
    least, with the table as `advice`. Stresses are Pa, tension positive.
    """
    return _core.fields_of_folder(os.fspath(folder), kernel, width, spacing, box, points, advise_width)


def picture(folder: _Path, frame: int = -1, film: bool = False, mode: int | None = None, cell: str | None = None,
            grains: str | None = None, solids: str | None = None, lines: str | None = None,
            **options: typing.Any) -> Picture:
    """Draws a frame of a run, a natural `mode` of its solids (from 1), or all frames as a `film`, as
    `dovetail picture` does, with its options: azimuth, elevation (degrees), cut=("y", 0.1), uncut, warp,
    size=(width, height), background, grain_range, solid_range=(low, high)."""
    if (film or mode is not None) and frame != -1:
        raise InputError("a film shows all frames, and a mode none [picture]: leave out frame")
    if cell is not None and mode is not None:
        raise InputError("cells have no modes [picture]: leave out cell or mode")
    given = _given(grains, solids, lines, {**options, "frame": frame, "film": film, "mode": mode, "cell": cell})
    return Picture(*_core.picture_of_folder(os.fspath(folder), given), "gif" if film else "png")


def series(folder: _Path) -> dict[str, NDArray[typing.Any]]:
    """Columns of series.csv in the folder of a run, or of any table that Dovetail writes, as arrays by their names with
    units."""
    path = os.fspath(folder)
    return _core.columns_of(os.path.join(path, "series.csv") if os.path.isdir(path) else path)


class Looks:
    """What a Run looks like now."""

    def fields(self, kernel: str = "lucy", width: float | None = None, spacing: float | None = None,
               box: ArrayLike | None = None, points: ArrayLike | None = None, advise_width: bool = False) -> _Fields:
        """Coarse-grained fields of the grains now: see dovetail.fields."""
        return _core.fields_of_run(self, kernel, width, spacing, box, points, advise_width)

    def picture(self, grains: str | None = None, solids: str | None = None, lines: str | None = None,
                **options: typing.Any) -> Picture:
        """The run as it is now, as `dovetail picture` draws a frame of it: grains and solids coloured by a field
        ("none": left out), `lines` "contacts" or "bonds"; options as of dovetail.picture."""
        return Picture(*_core.picture_of_run(self, _given(grains, solids, lines, options)))

    def probes(self) -> dict[str, float]:
        """Probes of the scene's output now, by the names of their columns with units."""
        return _core.probes_of_run(self)

    def series(self) -> dict[str, float]:
        """What a row of series.csv has, now, by the names of the columns with units."""
        return _core.series_of_run(self)

    @property
    def cells(self) -> dict[str, list[_core.Rve]]:
        """Cells of grains of the scene as prepared, by the names of their descriptions: lists of Rve."""
        return _core.cells_of_run(self)
