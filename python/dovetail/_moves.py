"""Walls and grains of a run that functions move."""

from __future__ import annotations

import typing

from numpy.typing import ArrayLike

from . import _core

_Vector = typing.Callable[[float], ArrayLike]
_Rate = typing.Callable[[float], float]


class Moves:
    """What a Run has of this."""

    def move_wall(self, wall: str | int, displacement: _Vector | None = None, velocity: _Vector | None = None,
                  angular_velocity: _Rate | None = None, axis: ArrayLike = (0, 0, 0),
                  point: ArrayLike | None = None) -> None:
        """Moves a wall, by its name or number, from where it is now, in place of the motion or servo of the scene.

        Functions of the run's time t, s: `displacement(t)`, m, of which counts what it changes from now on, or
        `velocity(t)`, m/s, both 3 numbers; and `angular_velocity(t)`, rad/s, one number, about an `axis` through
        `point`, m (that of the wall if None). The work of the wall is booked.
        """
        _core._move_wall(typing.cast(_core.Run, self), str(wall), displacement, velocity, angular_velocity, axis, point)

    def drive(self, ids: ArrayLike, displacement: _Vector | None = None, velocity: _Vector | None = None,
              spin: _Vector | None = None, angular_velocity: _Rate | None = None,
              axis: ArrayLike = (0, 0, 0), point: ArrayLike | None = None) -> None:
        """Moves grains, by their ids, from where they are now, as `move_wall` moves walls, to the end of the run.

        They keep `spin(t)`, rad/s, 3 numbers, 0 if None, each about its own centre; with an angular velocity they turn
        as a whole about an axis through `point`, m. The work of the drive is booked.
        """
        _core._drive_grains(typing.cast(_core.Run, self), ids, displacement, velocity, spin, angular_velocity, axis,
                            point)
