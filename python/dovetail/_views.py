"""Views of the grains: arrays that are the run's own memory while it stands still."""

from __future__ import annotations

import functools
import typing

import numpy as np

from . import _core


class Views:
    """Opened by `with run.grains.views() as g:`; see `Grains.views`."""

    def __init__(self, run: _core.Run) -> None:
        self._run = run
        self._lent: _core._Views | None = None
        self._open = [False]

    def __enter__(self) -> Views:
        if self._lent is not None:
            raise _core.InputError("these views are open, or have been: open others by run.grains.views()")
        self._lent = _core._Views(self._run)
        self._open = [True]
        return self

    def __exit__(self, kind: typing.Any, *_: typing.Any) -> None:
        self._open[0] = False
        if self._lent is not None:
            self._lent.close(kind is None)

    def _array(self, field: str) -> View:
        if self._lent is None:
            raise _core.InputError("these views are not open: write `with run.grains.views() as g:`")
        array = self._lent.array(field).view(View)
        array._open = self._open
        return typing.cast(View, array)

    @property
    def id(self) -> View:
        """Names of the grains, in the order in which the run keeps them; (N)."""
        return self._array("id")

    @property
    def x(self) -> View:
        """Centres, m; (N, 3)."""
        return self._array("x")

    @property
    def v(self) -> View:
        """Velocities, m/s; (N, 3). May be written."""
        return self._array("v")

    @property
    def omega(self) -> View:
        """Angular velocities, rad/s; (N, 3). May be written."""
        return self._array("omega")

    @property
    def f(self) -> View:
        """Forces with weights, N; (N, 3)."""
        return self._array("f")

    @property
    def radius(self) -> View:
        """m; (N)."""
        return self._array("radius")

    @property
    def mass(self) -> View:
        """kg; (N)."""
        return self._array("mass")


class Grains(_core.Grains):
    """Grains of a run. Arrays are copies, one row a grain, in the order of ids."""

    def __init__(self, run: _core.Run) -> None:
        super().__init__(run)
        self._run = run

    def views(self) -> Views:
        """Arrays without a copy, in the order in which the run keeps its grains, for a `with` that locks the run:

            with run.grains.views() as g:
                g.v[g.x[:, 2] > 0.1] = 0

        `g.v` and `g.omega` may be written; the energy that this brings is booked as a change when the `with` ends, and
        nothing has changed if it ends by an error. `g.id`, `x`, `f`, `radius` and `mass` are read. Until then the run
        does nothing else; afterwards the arrays raise an InputError. Refused with clumps and grains at points of solids.
        """
        return Views(self._run)


class View(np.ndarray[typing.Any, typing.Any]):
    """An array of a view. Once its `with` has ended, whatever it is asked for raises an InputError; what numpy has
    made a plain array of keeps the last numbers, apart from the run."""

    _open = [True]

    def __array_finalize__(self, of: typing.Any) -> None:
        self._open = getattr(of, "_open", [True])

    def _require(self) -> None:
        if not self._open[0]:
            raise _core.InputError("the `with` of this view has ended, and the run may have moved on: copy what is "
                                   "to stay, by array.copy(), within it")

    def __array_ufunc__(self, ufunc: typing.Any, method: str, *inputs: typing.Any, out: typing.Any = (),
                        **options: typing.Any) -> typing.Any:
        if out:
            options["out"] = tuple(_bare(one) for one in out)
        result = getattr(ufunc, method)(*(_bare(one) for one in inputs), **options)
        return out[0] if len(out) == 1 else result

    def __array_function__(self, function: typing.Any, types: typing.Any, inputs: typing.Any,
                           options: typing.Any) -> typing.Any:
        self._require()
        return super().__array_function__(function, types, inputs, options)


def _bare(array: typing.Any) -> typing.Any:
    """The same numbers as a plain array."""
    if not isinstance(array, View):
        return array
    array._require()
    return np.ndarray.view(array, np.ndarray)


def _checked(name: str) -> typing.Any:
    plain = getattr(np.ndarray, name)

    @functools.wraps(plain)
    def checked(self: View, *inputs: typing.Any, **options: typing.Any) -> typing.Any:
        self._require()
        result = plain(self, *inputs, **options)
        copied = isinstance(result, View) and not np.may_share_memory(_bare(result), _bare(self))
        return _bare(result) if copied else result

    return checked


_OPERATORS = ("getitem", "setitem", "iter", "eq", "ne", "lt", "le", "gt", "ge", "contains", "float", "int", "bool", "repr",
              "str", "copy", "deepcopy", "reduce", "reduce_ex")
for _name in [name for name in dir(np.ndarray) if not name.startswith("_")] + [f"__{name}__" for name in _OPERATORS]:
    if callable(getattr(np.ndarray, _name)):
        setattr(View, _name, _checked(_name))
