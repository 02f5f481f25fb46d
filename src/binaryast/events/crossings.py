"""Events of a plane or a quantity: something passes through it."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from astropy.units import Quantity

from binaryast.errors import InputError, did_you_mean
from binaryast.events.base import TURN, Event, Watched
from binaryast.system import System
from binaryast.units import brief, numbers, quantity, to_si


@dataclass(frozen=True, eq=False)
class PlaneCrossing(Event):
    """A body crosses a plane, in the direction of its normal (1) or against it (-1).

    Parameters
    ----------
    normal : array-like
        n (3,), of any length; the z axis by default, so that in inertial axes crossings are the nodes.
    body, origin : str or int
        Whose mass centre crosses, and whose the plane is counted from: the secondary, and the primary.
    axes : str or int, optional
        The body in whose axes the normal is fixed, by name or index; inertial axes by default.
    offset : Quantity, optional
        Of the plane from the origin, along the normal (length).

    Examples
    --------
    >>> import binaryast as ba
    >>> ascending = ba.events.PlaneCrossing([0, 0, 1], direction=1)
    >>> equator = ba.events.PlaneCrossing([0, 0, 1], axes=0)
    """

    normal: Any = (0.0, 0.0, 1.0)
    body: str | int = 1
    origin: str | int = 0
    axes: str | int | None = None
    offset: Quantity | None = None

    @property
    def turning(self) -> bool:  # type: ignore[override]
        """Whether attitudes matter."""
        return self.axes is not None

    def _check(self) -> None:
        normal = numbers(self.normal, "PlaneCrossing: normal", (3,))
        if not np.any(normal):
            raise InputError("PlaneCrossing: normal: expected a direction, got zeros")
        offset = 0.0 if self.offset is None else float(to_si(self.offset, "m", "PlaneCrossing: offset"))
        self._set(normal=normal.copy(), offset=quantity(offset, "m"))

    def pairs(self, system: System) -> list[tuple[int, int]]:
        """Return the two bodies."""
        return [self._pair(system, (self.origin, self.body))]

    def watched(self, system: System) -> list[Watched]:
        """Return the distance from the plane."""
        from binaryast.kernels.events.functions import plane

        two, one = self._pair(system, (self.origin, self.body))
        axes = -1 if self.axes is None else system.index(self.axes)
        normal = self.normal / np.linalg.norm(self.normal)
        return [Watched(plane, np.array([one, two, axes, *normal, self.offset.value]))]  # type: ignore[union-attr]

    def title(self, system: System) -> str:
        """Return who crosses what."""
        two, one = self._pair(system, (self.origin, self.body))
        return f"{system.names[one]} through a plane of {system.names[two]}"


class Kind(NamedTuple):
    """A quantity whose values may be passed: its unit, its period or 0, and whether it depends on attitudes."""

    unit: str
    period: float = 0.0
    turning: bool = True


QUANTITIES = {
    "separation": Kind("m", turning=False),
    "radial_velocity": Kind("m / s", turning=False),
    "spin_rate": Kind("rad / s"),
    "roll": Kind("rad", TURN),
    "pitch": Kind("rad"),
    "yaw": Kind("rad", TURN),
    "longitude": Kind("rad", TURN),
    "latitude": Kind("rad"),
}


@dataclass(frozen=True, eq=False)
class Crossing(Event):
    """A quantity passes a value, growing (direction 1) or falling (-1).

    Parameters
    ----------
    quantity : str
        ``separation`` and ``radial_velocity`` of two mass centres: at a radial velocity of 0 they are at their nearest
        (direction 1) or furthest (-1); ``roll``, ``pitch``, ``yaw`` of the second body, Euler angles 1-2-3 from the
        frame of its orbit about the first (x away from it, z the pole) to its own; ``longitude``, ``latitude`` of its
        mass centre in the axes of the first; ``spin_rate``, of the second.
    value : Quantity, optional
        Which is passed; 0 by default.
    bodies : tuple of two, optional
        By names or indices; needed where there are more than two.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> nearest = ba.events.Crossing("radial_velocity", direction=1)
    >>> ahead = ba.events.Crossing("yaw", 5 * u.deg)
    """

    quantity: str
    value: Quantity | None = None
    bodies: Any = None

    @property
    def turning(self) -> bool:  # type: ignore[override]
        """Whether attitudes matter."""
        return QUANTITIES[self.quantity].turning

    def _check(self) -> None:
        if not isinstance(self.quantity, str) or self.quantity not in QUANTITIES:
            near = did_you_mean(str(self.quantity), QUANTITIES)
            raise InputError(
                f"Crossing: quantity={brief(repr(self.quantity))} is not known{near}; there are {', '.join(QUANTITIES)}"
            )
        unit = QUANTITIES[self.quantity].unit
        value = 0.0 if self.value is None else float(to_si(self.value, unit, "Crossing: value"))
        self._set(value=quantity(value, unit))

    def pairs(self, system: System) -> list[tuple[int, int]]:
        """Return the two bodies."""
        return [self._pair(system, self.bodies)]

    def watched(self, system: System) -> list[Watched]:
        """Return the quantity less the value."""
        from binaryast.kernels.events import functions

        two, one = self._pair(system, self.bodies)
        turned = {"roll": one, "pitch": one, "yaw": one, "spin_rate": one, "longitude": two, "latitude": two}
        whose = turned.get(self.quantity)
        if whose is not None and system.bodies[whose].is_point:
            raise InputError(f"Crossing: {self.quantity}: {system.names[whose]} is a point, which has no axes")
        parameters = np.array([one, two, self.value.value])  # type: ignore[union-attr]
        return [Watched(getattr(functions, self.quantity), parameters, QUANTITIES[self.quantity].period)]

    def title(self, system: System) -> str:
        """Return what passes what."""
        two, one = self._pair(system, self.bodies)
        value = self.value.to("deg") if QUANTITIES[self.quantity].unit == "rad" else self.value  # type: ignore[union-attr]
        what = self.quantity.replace("_", " ")
        of = f" about {system.names[two]}" if self.quantity != "spin_rate" else ""
        return f"{what} of {system.names[one]}{of} {value.value:.6g} {value.unit}"  # type: ignore[union-attr]
