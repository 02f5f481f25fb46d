"""What all events have in common."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import Any, ClassVar, NamedTuple

from astropy.units import Quantity

from binaryast.errors import InputError
from binaryast.system import System
from binaryast.units import Floats, brief, quantity, to_si
from binaryast.values import Value

TURN = 2 * pi


class Watched(NamedTuple):
    """A compiled function g(p, t, position, velocity, attitude, spin), its parameters p, and its period or 0."""

    function: Callable[..., float]
    parameters: Floats
    period: float = 0.0


@dataclass(frozen=True, eq=False, kw_only=True)
class Event(Value, ABC):
    """What all events have in common.

    Parameters
    ----------
    direction : {0, 1, -1}
        Of the passes that count: both, those where g grows, those where it falls. With 0, a touch of zero counts too.
    terminal : bool
        Whether it ends the run.
    accuracy : Quantity, optional
        To which its time is found (time); to round-off by default.
    interval : Quantity, optional
        The longest time between looks; by default a sixteenth of the shortest time in which a pair goes round or, where
        attitudes matter, a body turns, as they are at the start. Steps are always looked at. An event is missed only
        where g turns twice within three looks.
    """

    direction: int = 0
    terminal: bool = False
    accuracy: Quantity | None = None
    interval: Quantity | None = None

    status: ClassVar[str] = "event"
    turning: ClassVar[bool] = False  # whether attitudes matter

    def __post_init__(self) -> None:
        name = type(self).__name__
        if isinstance(self.direction, bool) or self.direction not in (-1, 0, 1):
            raise InputError(f"{name}: direction: expected 1, -1 or 0 for both, got {brief(repr(self.direction))}")
        if not isinstance(self.terminal, bool):
            raise InputError(f"{name}: terminal: expected True or False, got {brief(repr(self.terminal))}")
        for key in ("accuracy", "interval"):
            value = getattr(self, key)
            if value is not None:
                self._set(**{key: quantity(to_si(value, "s", f"{name}: {key}", sign="positive"), "s")})
        self._set(direction=int(self.direction))
        self._check()

    def _check(self) -> None:
        """Take units off, and raise for what cannot be."""

    @abstractmethod
    def watched(self, system: System) -> list[Watched]:
        """Return the functions whose zeros are this event.

        Raises
        ------
        InputError
            Where it cannot happen to this system.
        """

    def pairs(self, system: System) -> list[tuple[int, int]]:
        """Return the pairs of bodies whose motion decides how often it is looked at."""
        return [(pair.primary, pair.secondary) for pair in system.pairs]

    @abstractmethod
    def title(self, system: System) -> str:
        """Return what it is called in a line."""

    def _pair(self, system: System, bodies: Any) -> tuple[int, int]:
        """Return the indices of two bodies; a pair's own where none are named."""
        what, names = f"{type(self).__name__}: bodies", system.names
        if bodies is None and len(names) == 2:
            return 0, 1
        if isinstance(bodies, str) or not isinstance(bodies, (tuple, list)) or len(bodies) != 2:
            raise InputError(f"{what}: expected two, such as {names[:2]!r}, got {brief(bodies)}")
        two, one = (system.index(body) for body in bodies)
        if one == two:
            raise InputError(f"{what}: {names[one]} twice: expected two bodies, such as {names[:2]!r}")
        return two, one
