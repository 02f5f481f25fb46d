"""Events of two bodies: they touch, come or go to a distance, or escape each other."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from astropy.units import Quantity

from binaryast import constants
from binaryast.events.base import Event, Watched
from binaryast.system import System
from binaryast.units import quantity, to_si


@dataclass(frozen=True, eq=False)
class Contact(Event):
    """The surfaces of two bodies touch; a run ends by it unless it is asked for as not terminal.

    Surfaces are those of ellipsoids, spheres and their unions; a polyhedron is the ellipsoid of its volume and axes of
    inertia; points and point clouds touch nothing that has no extent. g is the least of Perram and Wertheim's function
    less 1.

    Parameters
    ----------
    bodies : tuple of two, optional
        By names or indices; any two by default.

    Examples
    --------
    >>> import binaryast as ba
    >>> through = ba.events.Contact(terminal=False)
    """

    bodies: Any = None
    direction: int = field(default=-1, kw_only=True)
    terminal: bool = field(default=True, kw_only=True)

    status: ClassVar[str] = "contact"
    turning: ClassVar[bool] = True

    def pairs(self, system: System) -> list[tuple[int, int]]:
        """Return the pairs that may touch."""
        return super().pairs(system) if self.bodies is None else [self._pair(system, self.bodies)]

    def watched(self, system: System) -> list[Watched]:
        """Return the clearance of each pair."""
        from binaryast.kernels import contact
        from binaryast.kernels.events.functions import contact as function
        from binaryast.working.base import surfaces

        known = surfaces(system)
        return [
            Watched(function, np.array([*known, one, two], dtype=float))
            for two, one in self.pairs(system)
            if contact.can_touch(known, one, two)
        ]

    def title(self, system: System) -> str:
        """Return who touches."""
        if self.bodies is None:
            return "contact"
        two, one = self._pair(system, self.bodies)
        return f"contact of {system.names[one]} and {system.names[two]}"


@dataclass(frozen=True, eq=False)
class Separation(Event):
    """The mass centres of two bodies come (direction -1) or go (1) to a distance.

    Parameters
    ----------
    distance : Quantity
        (length)
    bodies : tuple of two, optional
        By names or indices; needed where there are more than two.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> near = ba.events.Separation(1.19 * u.km, direction=-1)
    """

    distance: Quantity
    bodies: Any = None

    def _check(self) -> None:
        self._set(distance=quantity(to_si(self.distance, "m", "Separation: distance", sign="positive"), "m"))

    def pairs(self, system: System) -> list[tuple[int, int]]:
        """Return the two bodies."""
        return [self._pair(system, self.bodies)]

    def watched(self, system: System) -> list[Watched]:
        """Return the distance less that distance."""
        from binaryast.kernels.events.functions import separation

        two, one = self._pair(system, self.bodies)
        return [Watched(separation, np.array([one, two, self.distance.value]))]

    def title(self, system: System) -> str:
        """Return who and how far."""
        two, one = self._pair(system, self.bodies)
        return f"{system.names[one]} {self.distance.value:.6g} m from {system.names[two]}"


@dataclass(frozen=True, eq=False)
class Escape(Event):
    """A body is both further than a distance from the barycentre of the others, and faster than escapes from them.

    Of points: the speed is that of two, the body and all others in their barycentre. It ends a run, whose status then
    is ``escape``.

    Parameters
    ----------
    distance : Quantity
        (length)
    body : str or int
        Its name or index; the secondary by default.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> lost = ba.events.Escape(20 * u.km)
    """

    distance: Quantity
    body: str | int = 1
    direction: int = field(default=1, kw_only=True)
    terminal: bool = field(default=True, kw_only=True)

    status: ClassVar[str] = "escape"

    def _check(self) -> None:
        self._set(distance=quantity(to_si(self.distance, "m", "Escape: distance", sign="positive"), "m"))

    def watched(self, system: System) -> list[Watched]:
        """Return the smaller of what distance and speed are above theirs."""
        from binaryast.kernels.events.functions import escape

        masses = [body.si.mass for body in system.bodies]
        g = sum(body.si.gm for body in system.bodies) / sum(masses) or constants.G
        return [Watched(escape, np.array([system.index(self.body), *masses, g, self.distance.value]))]

    def title(self, system: System) -> str:
        """Return who escapes."""
        return f"escape of {system.names[system.index(self.body)]}"
