"""Grains and solids in one run.

    import dovetail as dv
    run = dv.Run("mine.json", speed="4 m/s")        # or a dict that says the same
    for _ in run.steps(1000, every=100):
        print(run.time, run.grains.x.mean(axis=0), run.ledger["residual"])
    dv.run("mine.json", out="mine-out")              # as `dovetail run mine.json` does

Quantities are SI. What a scene cannot say is refused with a ValueError (InputError) that tells what to write; a run
that breaks down raises a RuntimeError (NumericalError).
"""

from __future__ import annotations

import json
import operator
import os
import sys
import typing

try:
    from numpy.typing import ArrayLike, NDArray

    from . import _core
except ImportError as error:
    raise ImportError(f"{error}: dovetail was built for another Python than {sys.executable} {sys.version.split()[0]}, or "
                      "this one has no numpy; Debian's is /usr/bin/python3") from error
from ._arrays import Folder, written
from ._calibration import Fit, calibrate
from ._cells import make_cells
from ._core import InputError, NumericalError, Rve, read_cells, schema, set_threads, threads, write_cells
from ._looking import Looks, Picture, fields, picture, series
from ._moves import Moves
from ._own_laws import InPlace, Law, contact_law, load_laws
from ._progress import Progress, in_terminal
from ._studies import Rows, study
from ._views import Grains

__all__ = ["Fit", "Grains", "InputError", "NumericalError", "Picture", "Rows", "Run", "Rve", "calibrate", "check",
           "contact_law", "fields", "load_laws", "make_cells", "picture", "read_cells", "read_scene", "resume", "run",
           "schema", "series", "set_threads", "study", "threads", "write_cells"]

_Path = typing.Union[str, "os.PathLike[str]"]
_Scene = typing.Union[_Path, typing.Dict[str, typing.Any], _core.Scene]
_Array = NDArray[typing.Any]
_Force = typing.Callable[[float, _Array, _Array], ArrayLike]


def _plain(value: typing.Any) -> typing.Any:
    if hasattr(value, "tolist"):  # of numpy
        return value.tolist()
    raise InputError(f"a scene cannot say {value!r} of {type(value)}: write numbers, text, lists, arrays or dicts")


def _json(value: typing.Any) -> str:
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except ValueError as error:
        raise error if isinstance(error, InputError) else InputError("a number of the scene is not finite: give one that is")


def _text(value: typing.Any) -> str:
    return value if isinstance(value, str) else _json(value)


def read_scene(scene: _Scene, folder: _Path | None = None, **settings: typing.Any) -> _core.Scene:
    """The scene of a file, or of a dict that says the same, arrays in place of lists as well; `folder`: that a dict's
    names of files are relative to. Arrays in place of files are refused here: `run`, `Run` and `check` take them.

    `settings` are parameters of "let" by their names; other keys by their paths: `**{"steps.dt": "1e-5 s"}`.
    """
    return _read(scene, folder, settings, None)


def _read(scene: _Scene, folder: _Path | None, settings: dict[str, typing.Any],
          arrays: Folder | None) -> _core.Scene:
    """As read_scene; arrays go into `arrays`."""
    changes = [f"{key}={_text(value)}" for key, value in settings.items()]
    if isinstance(scene, _core.Scene):
        if changes or folder is not None:
            raise InputError("this scene has been read: give folder and settings where it is")
        return scene
    if isinstance(scene, dict):
        return _core.Scene(_json(written(scene, arrays)), "scene", folder or os.getcwd(), changes)
    return _core.read_scene(os.fspath(scene), changes)


class Run(Looks, Moves, _core.Run):
    """A scene, built and started, that goes on when it is told to: arrays, ledger and own forces between the steps.

    Stages, outputs and their files are those of `dovetail.run`; here time simply passes, and a dict needs no stages.
    """

    def __init__(self, scene: _Scene, folder: _Path | None = None, contact_law: Law | None = None,
                 solids: typing.Mapping[str, typing.Any] | None = None, **settings: typing.Any) -> None:
        """`contact_law` stands in place of the scene's: see `dovetail.contact_law`. `solids` of one's own by their
        names: objects with X, mass, faces or cells, and forces(t, u, v)."""
        if isinstance(scene, dict) and not {"stages", "include"} & set(scene):
            scene = {**scene, "stages": [{"do": "run", "time": 1}]}
        self._law = InPlace(contact_law)
        self._arrays = Folder()
        with self._law():
            super().__init__(self._law.scene(_read(scene, folder, settings, self._arrays)), dict(solids or {}))

    @property
    def limits(self) -> list[tuple[float, str]]:
        """Limits of the step now: (s, what sets it)."""
        with self._law():
            return super().limits

    @property
    def notes(self) -> list[str]:
        """Decisions that the scene leaves open, and what is not booked."""
        return super().notes + self._law.notes

    def __str__(self) -> str:
        return "\n".join([super().__str__(), *self._law.notes])

    @property
    def grains(self) -> Grains:
        """Grains as arrays, in the order of their ids."""
        return Grains(self)

    @property
    def solids(self) -> dict[str, _core.Solid]:
        """Solids by their names."""
        return {name: _core.Solid(self, k) for k, name in enumerate(self._solids)}

    def advance(self, steps: int = 1) -> None:
        """So many macro steps. Ctrl-C ends between two of them, and the run can go on."""
        self._advance(operator.index(steps))

    def steps(self, steps: int, every: int = 1, progress: bool = False) -> typing.Iterator[int]:
        """Goes on by `every` macro steps each time round, `steps` in all; gives those that have been made. `progress`:
        a line in terminals and notebooks says how far it is."""
        if every < 1:
            raise InputError(f"every is {every}: give 1 or more")
        shown = Progress("steps", steps) if progress else None
        made = 0
        try:
            while made < steps:
                now = min(every, steps - made)
                self._advance(now)
                made += now
                if shown:
                    shown.update(made, f"t = {self.time:.6g} s")
                yield made
        finally:
            if shown:
                shown.finish()

    def force(self, function: _Force | None = None, name: str | None = None) -> typing.Any:
        """Adds forces on the grains: `function(t, x, v)` gives N, (N, 3), in the order of ids; its work is booked.

            @run.force
            def wind(t, x, v):
                return -0.1 * v
        """
        if function is None:
            return lambda later: self.force(later, name)
        if not callable(function):
            raise InputError(f"the force is {function!r}: give a function of t, x, v")
        self._add_force(name or str(getattr(function, "__name__", "force")), function)
        return function


def _write(text: str) -> None:
    sys.stdout.write(text)
    sys.stdout.flush()


def _folder(scene: _Scene, out: _Path | None) -> str:
    if out is not None:
        return os.fspath(out)
    if isinstance(scene, (dict, _core.Scene)):
        raise InputError("there is no folder for the files: give out")
    return os.path.splitext(os.path.basename(os.fspath(scene)))[0] + "-out"


def run(scene: _Scene, out: _Path | None = None, replace: bool = False, quiet: bool = False,
        folder: _Path | None = None, contact_law: Law | None = None, **settings: typing.Any) -> str:
    """Runs all stages of a scene into the folder `out`, as `dovetail run` does; returns the folder.

    Ctrl-C ends with a checkpoint, from which `resume` goes on.
    """
    where = _folder(scene, out)
    law, arrays = InPlace(contact_law), Folder(where)
    try:
        with law():
            _core.run_scene(law.scene(_read(scene, folder, settings, arrays)), where, replace,
                            (lambda text: None) if quiet else _write, not quiet and in_terminal())
    except InputError:
        arrays.take_back()
        raise
    return where


def resume(out: _Path, until: float | None = None, quiet: bool = False, contact_law: Law | None = None) -> None:
    """Goes on from the last checkpoint in a folder; `until`: a new end of the last stage, s."""
    with InPlace(contact_law)():
        _core.resume_run(os.fspath(out), until, (lambda text: None) if quiet else _write,
                         not quiet and in_terminal())


def check(scene: _Scene, folder: _Path | None = None, contact_law: Law | None = None, **settings: typing.Any) -> str:
    """Sizes, limits of the step, memory and time of a scene, as text."""
    law, arrays = InPlace(contact_law), Folder()
    with law():
        return _core.check_scene(law.scene(_read(scene, folder, settings, arrays)))
