"""Contact laws of one's own: functions that numpy answers for all contacts at once, or compiled ones."""

from __future__ import annotations

import contextlib
import inspect
import math
import os
import typing

import numpy as np

from . import _core
from ._core import InputError

_Function = typing.Callable[..., typing.Any]
_Parameters = typing.Dict[str, float]
_Value = typing.Union[float, str, _Function]
_Slope = typing.Union[_Value, typing.Tuple[_Value, _Value]]


def _numbers(given: dict[str, typing.Any], what: str) -> _Parameters:
    for name, value in given.items():
        if isinstance(value, bool) or not isinstance(value, (int, float, np.floating, np.integer)) \
                or not math.isfinite(value):
            raise InputError(f"{name} of {what} is {value!r}: give a finite number, in SI units")
    return {name: float(value) for name, value in given.items()}


class Law:
    """A law by its name, and its parameters, floats in SI units."""

    def __init__(self, name: str, parameters: _Parameters) -> None:
        self.name, self.parameters = name, parameters
        self._what = f"contact law {name}"

    def __call__(self, **parameters: float) -> Law:
        """The same law with other parameters."""
        for name in parameters:
            if name not in self.parameters:
                known = ", ".join(self.parameters) or "none"
                raise InputError(f"{self._what} has no parameter {name}: it has {known}")
        return self._with({**self.parameters, **_numbers(parameters, self._what)})

    def _with(self, parameters: _Parameters) -> Law:
        raise NotImplementedError

    def _make(self) -> _core._Laws:
        raise NotImplementedError

    def __repr__(self) -> str:
        return f"{self.name}({', '.join(f'{k}={v:g}' for k, v in self.parameters.items())})"


class ContactLaw(Law):
    """A law that a function of numpy arrays is; see `contact_law`."""

    def __init__(self, function: _Function, stiffness: _Slope, damping: _Value = 0.0, memory: int = 0,
                 tangential: typing.Sequence[int] = (), torques: bool = True, reach: float = 0.0,
                 name: str | None = None, parameters: _Parameters | None = None) -> None:
        name = name or getattr(function, "__name__", type(function).__name__)
        own = list(inspect.signature(function).parameters.values())[1:]
        for one in own:
            if one.default is inspect.Parameter.empty or one.kind is inspect.Parameter.VAR_KEYWORD:
                raise InputError(f"parameter {one.name} of contact law {name} has no value: "
                                 "write name=number, in SI units")
        super().__init__(name, parameters or _numbers({one.name: one.default for one in own}, f"contact law {name}"))
        self._function, self._slope = function, (stiffness, damping)
        self._traits = (memory, list(tangential), torques, reach)

    def _with(self, parameters: _Parameters) -> Law:
        return ContactLaw(self._function, *self._slope, *self._traits, name=self.name, parameters=parameters)

    def _value(self, given: _Value, contacts: _core.Contacts) -> typing.Any:
        """N numbers from a number, a parameter's name, or a function like the law itself."""
        if isinstance(given, str):
            if given not in self.parameters:
                raise InputError(f"{self._what} has no parameter {given}: give N/m, a parameter or a function")
            given = self.parameters[given]
        if callable(given):
            wanted = inspect.signature(given).parameters
            given = given(contacts, **{k: v for k, v in self.parameters.items() if k in wanted})
        values = np.asarray(given, dtype=float)
        if values.shape not in ((), (len(contacts),)):
            raise InputError(f"the shape of a stiffness of {self._what} is {values.shape}: give ({len(contacts)},)")
        return np.broadcast_to(values, len(contacts))

    def _slopes(self, contacts: _core.Contacts) -> tuple[typing.Any, ...]:
        stiffness, damping = self._slope
        normal, tangential = stiffness if isinstance(stiffness, tuple) else (stiffness, 0.0)
        return tuple(np.array(self._value(one, contacts)) for one in (normal, tangential, damping))

    def _make(self) -> _core._Laws:
        function, parameters = self._function, self.parameters
        damps = not (isinstance(self._slope[1], (int, float)) and self._slope[1] == 0)
        return _core._called_laws(self.name, *self._traits, damps, lambda contacts: function(contacts, **parameters),
                                  self._slopes, parameters)


class CompiledLaw(Law):
    """A law of a library, see `load_laws`."""

    def __init__(self, name: str, law: _core._CompiledLaw, parameters: _Parameters) -> None:
        super().__init__(name, parameters)
        self._law = law

    def _with(self, parameters: _Parameters) -> Law:
        return CompiledLaw(self.name, self._law, parameters)

    def _make(self) -> _core._Laws:
        return self._law._make(self.name, self.parameters)


def contact_law(stiffness: _Slope, damping: _Value = 0.0, memory: int = 0, tangential: typing.Sequence[int] = (),
                torques: bool = True, reach: float = 0.0, name: str | None = None) -> typing.Callable[[_Function], Law]:
    """Makes a contact law of a function that numpy answers for all contacts of a sweep at once.

        @dv.contact_law(stiffness="k")
        def spring(c, k=1e5):
            return k * c.overlap                     # N along the normals, > 0 pushes apart; or (N, 3)

        run = dv.Run("mine.json", contact_law=spring(k=2e5))

    The function is given contacts (`overlap`, `normal`, … of `Contacts`) and its parameters, numbers in SI units. It
    gives the force on the first of each two, N, or a dictionary: `force`; `couple` beyond arm × force, N m, (N, 3);
    and, so that the ledger closes, `elastic_energy` (J, of what the overlap stores), `tangential_energy` (J, of what is
    remembered; lost when the contact ends), `dissipated_power`, `friction_power` (W, lost in this step); (N).

    stiffness   N/m, which limits of the step follow from: a number, a parameter's name, a function as the law itself,
                or two of these, normal and tangential. It is asked at rest, with memories of 0.
    damping     N s/m, of the dashpot along the normal, in the same ways. With it contacts remember how they moved, and
                `separating`, `slip` and `spin` are those of the instant. A dashpot acts on `c.seen(slope)` with the
                factor `c.engagement`; springs are stretched by `c.slipped` and `c.turned`
    memory      numbers that each contact remembers: `c.memory`, (N, memory)
    tangential  first numbers of the tangential vectors among them, which turn with their contacts
    torques     whether forces turn grains; without, they do not spin
    reach       m beyond touch up to which contacts act
    name        that checkpoints know it by, beside the parameters; else the function's
    """
    return lambda function: ContactLaw(function, stiffness, damping, memory, tangential, torques, reach, name)


def load_laws(path: str | os.PathLike[str]) -> dict[str, Law]:
    """Laws of a library that `dovetail_add_laws` has built, by their names. Loading runs code: trust the file."""
    return {name: CompiledLaw(name, law, dict(law._parameters)) for name, law in _core._open_laws(path).items()}


class InPlace:
    """What a run takes in place of its scene's law; empty for None."""

    def __init__(self, law: Law | None) -> None:
        if law is not None and not isinstance(law, Law):
            raise InputError("contact_law is no contact law: give what dv.contact_law or dv.load_laws has made")
        self.law = law
        self._made = law._make() if law is not None else None

    def scene(self, scene: _core.Scene) -> _core.Scene:
        """Without its own law."""
        return _core._without_contact(scene) if self._made else scene

    def __call__(self) -> typing.ContextManager[typing.Any]:
        return _core._LawsInPlace(self._made) if self._made else contextlib.nullcontext()

    @property
    def notes(self) -> list[str]:
        """What is not booked."""
        if self.law is None or self._made is None or not self._made._lacks_energies:
            return []
        return [f"contact law {self.law.name} gives no energies: what contacts store and lose is in the residual"]
