"""Studies: a scene over values of its keys, with functions."""

from __future__ import annotations

import json
import os
import signal
import sys
import typing

from numpy.typing import NDArray

from . import _core
from ._core import InputError


_Path = typing.Union[str, "os.PathLike[str]"]


class Rows(typing.List[typing.Dict[str, typing.Any]]):
    """Rows of a study, a dict a run: values of the keys, `outcome` (finished, not stable, broke down, refused),
    `message`, `wall_seconds`, `processor_seconds`, and figures; `folder` where the run has files."""

    def column(self, name: str) -> NDArray[typing.Any]:
        """Values of all rows as an array; NaN where a row has none."""
        import numpy as np
        if not any(name in row for row in self):
            names = sorted({key for row in self for key in row})
            raise InputError(f"no row has '{name}' [rows of a study]: take one of {', '.join(names)}")
        values = [row.get(name) for row in self]
        if any(isinstance(value, (str, list, dict)) for value in values):
            return np.array(values, dtype=object)
        return np.array([float("nan") if value is None else value for value in values])

    def frame(self) -> typing.Any:
        """A table of pandas."""
        import pandas
        return pandas.DataFrame(list(self))


def _points(values):
    """Label and settings of each dict."""
    from . import _text
    return [(", ".join(f"{key}={_text(value)}" for key, value in one.items()),
             [(key, _text(value)) for key, value in one.items()]) for one in values]


def _axes(over):
    """Axes of dicts: one a key, or a single one of the dicts given."""
    if isinstance(over, dict):
        axes = []
        for key, values in over.items():
            if isinstance(values, (str, bytes)) or not hasattr(values, "__iter__"):
                raise InputError(f"the values of '{key}' are no list [over]: give [a, b, c]")
            axes.append([{key: value.item() if hasattr(value, "item") else value} for value in values])
    else:
        axes = [[dict(one) for one in over]]
    if not axes or not all(axes):
        raise InputError("there is nothing to vary [over]: give {key: [a, b]}, or a list of dicts")
    return axes


def figures_text(figures, who):
    """What a function of a study gives, as JSON."""
    def plain(name, value):
        value = value.item() if hasattr(value, "item") and getattr(value, "size", 1) == 1 else value
        if not isinstance(name, str) or not isinstance(value, (bool, int, float, str, type(None))):
            raise InputError(f"'{name}' is {type(value).__name__} [{who}]: give numbers and texts by name, a dict")
        return None if isinstance(value, float) and value - value != 0 else value
    if not isinstance(figures, dict):
        raise InputError(f"the answer is {type(figures).__name__} [{who}]: give numbers by name, a dict")
    return json.dumps({name: plain(name, value) for name, value in figures.items()})


def _called(function, who, home, make=lambda argument: argument):
    def call(argument):
        if os.getpid() != home:  # a process of its own: Ctrl-C ends it
            signal.signal(signal.SIGINT, signal.default_int_handler)
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
        text = figures_text(function(make(argument)), who)
        sys.stdout.flush()
        return text
    return call


def _reader(scene, folder, settings):
    """"key=value" … → Scene."""
    from . import _json, _text
    fixed = [f"{key}={_text(value)}" for key, value in settings.items()]
    if isinstance(scene, _core.Scene):
        raise InputError("this scene has been read, and a study reads it with other values [study]: give its file or "
                         "its dict")
    if isinstance(scene, dict):
        text, where = _json(scene), folder or os.getcwd()
        return lambda values: _core.Scene(text, "scene", where, fixed + values)
    path = os.fspath(scene)
    return lambda values: _core.read_scene(path, fixed + values)


def _study_folder(scene, out):
    if out is not None:
        return os.fspath(out)
    if isinstance(scene, dict):
        raise InputError("there is no folder for the files: give out")
    return os.path.splitext(os.path.basename(os.fspath(scene)))[0] + "-study"


def study(scene: _Path | dict[str, typing.Any],
          over: dict[str, typing.Any] | typing.Sequence[dict[str, typing.Any]], out: _Path | None = None,
          measure: typing.Callable[[str], dict[str, typing.Any]] | None = None,
          act: typing.Callable[[typing.Any], dict[str, typing.Any]] | None = None, error: str | None = None,
          exact: float | None = None, processes: int | None = None, replace: bool = False, quiet: bool = False,
          folder: _Path | None = None, **settings: typing.Any) -> Rows:
    """Runs a scene with every combination of values, as `dovetail study` does; returns its Rows.

    `over`: {key: values} of keys or parameters, or a list of dicts of them. Each run is the scene's stages, with files
    in a folder below `out`, and `measure(folder)` gives more figures, a dict of numbers and texts; or it is `act(run)`,
    which does what it likes with a Run and gives all figures. A run that raises is a row that broke down, what it
    refuses (InputError) one that was refused. `error` names a figure, `exact` its exact value: tables and figure in
    `out` show it against the run time. Runs share `processes` (one for each processor; 0: all in this one, one after
    the other); functions are called there, and what they change is lost.
    """
    from . import Run, _write
    axes = _axes(over)
    if act is not None and measure is not None:
        raise InputError("a run is either its stages or act [study]: leave out act or measure")
    where, home = _study_folder(scene, out), os.getpid()
    sys.stdout.flush()
    _core.run_study(_reader(scene, folder, settings), [_points(axis) for axis in axes], where,
                    act and _called(act, "act", home, Run), measure and _called(measure, "measure", home),
                    error or "", exact, processes, replace, (lambda text: None) if quiet else _write)
    with open(os.path.join(where, "study.json"), encoding="utf-8") as file:
        runs = json.load(file)["runs"]
    cases = [{}]
    for axis in axes:
        cases = [{**some, **point} for some in cases for point in axis]
    rows = Rows()
    for values, run in zip(cases, runs):
        given = run.pop("settings", {})
        if "folder" in given:
            run["folder"] = os.path.join(where, given["folder"])
        rows.append({**values, **run})
    return rows
