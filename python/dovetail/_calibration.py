"""Parameters fitted to measurements."""

from __future__ import annotations

import dataclasses
import json
import os
import typing

from numpy.typing import ArrayLike, NDArray

from . import _core
from ._core import InputError


@dataclasses.dataclass
class Fit:
    """What a fit has found; `print(fit)` is the report of `dovetail calibrate`."""
    value: dict[str, float]  #: of the parameters, by name
    uncertainty: dict[str, float]  #: standard; infinite where the targets do not determine the parameter
    correlation: NDArray[typing.Any] | None  #: of the estimates, (n, n); None without covariance
    covariance: NDArray[typing.Any] | None  #: the same times both uncertainties; None without
    residual: NDArray[typing.Any]  #: at the estimate, in standard deviations, (targets)
    at_bound: dict[str, bool]  #: whether a parameter lies at one of its bounds
    chi_squared: float  #: sum of the squares of the residuals
    freedom: int  #: targets less parameters
    iterations: int
    converged: bool
    message: str  #: why it ended
    evaluations: int  #: of the model
    text: str

    def __str__(self) -> str:
        return self.text


def _parameters(parameters):
    rows = []
    for name, given in dict(parameters).items():
        numbers = [float(number) for number in given]
        if len(numbers) not in (3, 4):
            raise InputError(f"'{name}' has {len(numbers)} numbers [parameters]: give (start, least, most), and the "
                             "step of differences over most - least if it is not 0.02")
        rows.append((name, *numbers, *([0.02] if len(numbers) == 3 else [])))
    if not rows:
        raise InputError("there are no parameters [calibrate]: give {name: (start, least, most)}")
    return rows


def _deviations(targets, uncertainty):
    import numpy as np
    targets = np.asarray(targets, dtype=float)
    if targets.ndim != 1 or not np.isfinite(targets).all():
        raise InputError("targets are no list of finite numbers [targets]: give one number for each value of the model")
    deviations = np.broadcast_to(np.abs(0.01 * targets) if uncertainty is None else np.asarray(uncertainty, float),
                                 targets.shape)
    if not (np.isfinite(deviations) & (deviations > 0)).all():
        raise InputError("a standard deviation is not > 0 [uncertainty]: give one for all targets, or one for each; "
                         "1 % of the target if not given, which must not be 0 then")
    return targets, deviations


def _fit(model, parameters, targets, uncertainty, tolerance, iterations, evaluations, title):
    import numpy as np
    rows = _parameters(parameters)
    names = [row[0] for row in rows]
    if targets is None and uncertainty is not None:
        raise InputError("there is an uncertainty of no targets [uncertainty]: give targets, or divide the residuals")
    if targets is not None:
        targets, deviations = _deviations(targets, uncertainty)

    def residuals(values):
        now = np.asarray(model(**dict(zip(names, values))), dtype=float)
        if targets is None:
            return now
        if now.shape != targets.shape:
            raise InputError(f"the model gives {now.shape} for targets of {targets.shape} [model]: give one value each")
        return (now - targets) / deviations

    found = _core.fit_model(rows, residuals, tolerance, iterations, evaluations, title)
    for name in ("value", "uncertainty", "at_bound"):
        found[name] = dict(zip(names, found[name]))
    spread = np.array(list(found["uncertainty"].values()))
    found["correlation"] = np.array(found["correlation"]) if found["correlation"] else None
    found["covariance"] = None if found["correlation"] is None else found["correlation"] * np.outer(spread, spread)
    return Fit(**found)


def _file(file, out, rehearse, seed, quiet, settings):
    from . import _text, _write
    changes = [f"{key}={_text(value)}" for key, value in settings.items()]
    name = os.path.splitext(os.path.basename(file))[0]
    folder = os.fspath(out) if out is not None else f"{name}-calibration"
    _core.calibrate_file(file, changes, folder, rehearse, seed, (lambda text: None) if quiet else _write)
    with open(os.path.join(folder, "calibration.json"), encoding="utf-8") as text:
        return json.load(text)


def calibrate(model: typing.Callable[..., ArrayLike] | str | os.PathLike[str],
              parameters: typing.Mapping[str, typing.Sequence[float]] | None = None, targets: ArrayLike | None = None,
              uncertainty: ArrayLike | None = None, tolerance: float = 1e-3, iterations: int = 50,
              evaluations: int = 500, title: str = "", out: str | os.PathLike[str] | None = None, rehearse: int = 0,
              seed: int = 1, quiet: bool = False, **settings: typing.Any) -> typing.Any:
    """Fits parameters to measurements, as `dovetail calibrate` does; returns a Fit.

    `model(**parameters)` gives a value for each target, or without `targets` residuals in standard deviations, an
    array. `parameters`: {name: (start, least, most)}, and the step of central differences over most - least as a fourth
    number if it is not 0.02: well above what rearrangements of grains do. `uncertainty` of the targets: one, or one for
    each, standard; 1 % of the target if not given. Where the model raises InputError or NumericalError the fit looks
    elsewhere; it ends after so many `evaluations`, or when parameters or the sum of squares change by less than
    `tolerance`.

    With the name of a calibration file in place of a model: what `dovetail calibrate` does with it, `rehearse` times a
    rehearsal of it; returns what calibration.json in the folder `out` has.
    """
    if not callable(model):
        if parameters is not None or targets is not None or uncertainty is not None:
            raise InputError("a file has its own parameters and targets [calibrate]: leave them out")
        return _file(os.fspath(model), out, rehearse, seed, quiet, settings)
    if settings or out is not None or rehearse:
        raise InputError("a model has no settings, folder and rehearsals [calibrate]: give those of a file")
    if parameters is None:
        raise InputError("there are no parameters [calibrate]: give {name: (start, least, most)}")
    return _fit(model, parameters, targets, uncertainty, tolerance, iterations, evaluations, title)
