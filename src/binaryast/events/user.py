"""Events of a user's function: it passes through zero."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from binaryast.compiling import Function, compiled
from binaryast.errors import InputError
from binaryast.events.base import Event, Watched
from binaryast.system import System
from binaryast.units import brief, numbers


@dataclass(frozen=True, eq=False)
class UserEvent(Event):
    """A function of the user's passes through zero.

    Parameters
    ----------
    function : callable
        A function compiled by `binaryast.event`.
    values : sequence of float
        Its parameters ``p``, in SI.
    name : str
        What it is called; by default as the function.
    period : float
        Of an angle that jumps by a turn: such a jump is no pass. 0 without one.

    Examples
    --------
    >>> import binaryast as ba
    >>> @ba.event
    ... def height(p, t, position, velocity, attitude, spin):
    ...     return position[1, 2] - position[0, 2] - p[0]
    >>> up = ba.events.UserEvent(height, [50.0], direction=1)
    """

    function: Callable[..., Any] | str
    values: Sequence[float] = ()
    name: str = ""
    period: float = 0.0

    turning: ClassVar[bool] = True

    def _check(self) -> None:
        from binaryast.kernels.jit import EVENT

        if not isinstance(self.function, str) and EVENT.args not in getattr(self.function, "overloads", {}):
            raise InputError(f"UserEvent: {brief(self.function)} is not compiled: decorate it with @ba.event")
        count = len(self.values) if isinstance(self.values, (Sequence, np.ndarray)) else 0
        period = float(numbers(self.period, "UserEvent: period", ()))
        if not isinstance(self.name, str) or period < 0:
            raise InputError("UserEvent: expected a text as the name and a period of zero or more")
        own = self.function if isinstance(self.function, str) else self.function.__name__
        values = numbers(self.values, "UserEvent: values", (count,)).copy()
        self._set(values=values, name=self.name or own, period=period)

    def watched(self, system: System) -> list[Watched]:  # noqa: ARG002
        """Return the user's function."""
        if isinstance(self.function, str):  # read from a file on which only the name could be kept
            raise InputError(f"UserEvent: the function {self.function} cannot be imported here: build the event anew")
        return [Watched(self.function, np.array(self.values), self.period)]

    def title(self, system: System) -> str:  # noqa: ARG002
        """Return its name."""
        return self.name


def event(function: Function) -> Function:
    """Compile a user's function, for `binaryast.events.UserEvent`.

    Parameters
    ----------
    function : callable
        ``function(p, t, position, velocity, attitude, spin)``: parameters ``p`` (float array), the time since the start
        of the run [s], positions [m] and velocities [m/s] of all bodies (n, 3) about the barycentre in inertial axes,
        attitudes (n, 3, 3), body frame -> inertial, and spins (n, 3) in the bodies' frames [rad/s]. It returns a float,
        which is zero when the event happens.

    Returns
    -------
    callable
        The compiled function. It can still be called from Python.

    Raises
    ------
    InputError
        Where numba cannot compile it to that signature.

    Examples
    --------
    >>> import binaryast as ba
    >>> @ba.event
    ... def height(p, t, position, velocity, attitude, spin):
    ...     return position[1, 2] - position[0, 2] - p[0]
    """
    from binaryast.kernels.jit import EVENT

    expected = "6 arguments (p, t, position, velocity, attitude, spin) and a float as the result"
    return compiled(function, EVENT, "event", expected)
