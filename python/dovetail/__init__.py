"""Grains and solids in one run.

    import dovetail as dv
    run = dv.Run("mine.json", speed="4 m/s")        # or a dict that says the same
    for _ in run.steps(1000, every=100):
        print(run.time, run.grains.x.mean(axis=0), run.ledger["residual"])
    dv.run("mine.json", out="mine-out")              # as `dovetail run mine.json` does

Quantities are SI. What a scene cannot say is refused with a ValueError (InputError) that tells what to write; a run
that breaks down raises a RuntimeError (NumericalError).
"""

import json
import os
import sys

from . import _core
from ._core import InputError, NumericalError, schema, set_threads, threads

__all__ = ["InputError", "NumericalError", "Run", "check", "read_scene", "resume", "run", "schema", "set_threads",
           "threads"]


def _text(value):
    return value if isinstance(value, str) else json.dumps(value)


def read_scene(scene, folder=None, **settings):
    """The scene of a file, or of a dict that says the same; `folder`: that a dict's names of files are relative to.

    `settings` are parameters of "let" by their names; other keys by their paths: `**{"steps.dt": "1e-5 s"}`.
    """
    changes = [f"{key}={_text(value)}" for key, value in settings.items()]
    if isinstance(scene, _core.Scene):
        if changes or folder is not None:
            raise InputError("this scene has been read: give folder and settings where it is")
        return scene
    if isinstance(scene, dict):
        return _core.Scene(json.dumps(scene), "scene", folder or os.getcwd(), changes)
    return _core.read_scene(os.fspath(scene), changes)


class Run(_core.Run):
    """A scene, built and started, that goes on when it is told to: arrays, ledger and own forces between the steps.

    Stages, outputs and their files are those of `dovetail.run`; here time simply passes.
    """

    def __init__(self, scene, folder=None, **settings):
        super().__init__(read_scene(scene, folder, **settings))

    @property
    def grains(self):
        """Grains as arrays, in the order of their ids."""
        return _core.Grains(self)

    @property
    def solids(self):
        """Solids by their names."""
        return {name: _core.Solid(self, k) for k, name in enumerate(self._solids)}

    def advance(self, steps=1):
        """So many macro steps. Ctrl-C ends between two of them, and the run can go on."""
        self._advance(steps)

    def steps(self, steps, every=1):
        """Goes on by `every` macro steps each time round, `steps` in all; gives those that have been made."""
        if every < 1:
            raise InputError(f"every is {every}: give 1 or more")
        made = 0
        while made < steps:
            now = min(every, steps - made)
            self._advance(now)
            made += now
            yield made

    def force(self, function=None, name=None):
        """Adds forces on the grains: `function(t, x, v)` gives N, (N, 3), in the order of ids; its work is booked.

            @run.force
            def wind(t, x, v):
                return -0.1 * v
        """
        if function is None:
            return lambda later: self.force(later, name)
        self._add_force(name or getattr(function, "__name__", "force"), function)
        return function


def _write(text):
    sys.stdout.write(text)
    sys.stdout.flush()


def _folder(scene, out):
    if out is not None:
        return os.fspath(out)
    if isinstance(scene, (dict, _core.Scene)):
        raise InputError("there is no folder for the files: give out")
    return os.path.splitext(os.path.basename(os.fspath(scene)))[0] + "-out"


def run(scene, out=None, replace=False, quiet=False, folder=None, **settings):
    """Runs all stages of a scene into the folder `out`, as `dovetail run` does; returns the folder.

    Ctrl-C ends with a checkpoint, from which `resume` goes on.
    """
    where = _folder(scene, out)
    _core.run_scene(read_scene(scene, folder, **settings), where, replace, (lambda text: None) if quiet else _write)
    return where


def resume(out, until=None, quiet=False):
    """Goes on from the last checkpoint in a folder; `until`: a new end of the last stage, s."""
    _core.resume_run(os.fspath(out), until, (lambda text: None) if quiet else _write)


def check(scene, folder=None, **settings):
    """Sizes, limits of the step, memory and time of a scene, as text."""
    return _core.check_scene(read_scene(scene, folder, **settings))
