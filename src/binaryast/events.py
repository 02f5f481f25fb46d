"""What may happen in a run: two bodies touch, come or go to a distance, cross a plane, a quantity passes a value.

Each event has a function g that is zero when it happens. A run looks at g after each step, and within a step where that
is long, and finds the root where g has passed through zero, or turned at it.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import pi
from typing import Any, ClassVar, NamedTuple, TypeVar

import numpy as np
from astropy.units import Quantity

from binaryast import constants
from binaryast.errors import InputError, did_you_mean
from binaryast.system import System
from binaryast.units import Floats, brief, numbers, quantity, to_si
from binaryast.values import Value

Function = TypeVar("Function", bound=Callable[..., Any])
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
    from numba.core.errors import NumbaError

    from binaryast.kernels.jit import EVENT, compile_for_user

    try:
        return compile_for_user(function, EVENT)
    except (NumbaError, TypeError) as error:
        reason = next((line.strip() for line in str(error).splitlines()[1:] if line.strip()), brief(error))
        raise InputError(
            f"event: {getattr(function, '__name__', function)} cannot be compiled: {brief(reason)}; expected 6 "
            "arguments (p, t, position, velocity, attitude, spin) and a float as the result"
        ) from None


KINDS: dict[str, type[Event]] = {kind.__name__: kind for kind in (Contact, Separation, Escape, PlaneCrossing, Crossing)}


def through(events: Sequence[Event]) -> bool:
    """Whether some bodies may go through each other, so that steps do not look for contact by themselves."""
    return any(isinstance(event, Contact) and not event.terminal for event in events)


def checked(events: Any, system: System) -> tuple[Event, ...]:
    """Return events that can happen to a system.

    Where two bodies may go through each other, the contacts of all others become events that end the run.

    Raises
    ------
    InputError
        For what is no event, or cannot happen to this system.
    """
    if isinstance(events, str) or not isinstance(events, Sequence):
        raise InputError(f"events: expected a list of ba.events, got {brief(events)}")
    for i, one in enumerate(events):
        if not isinstance(one, Event):
            raise InputError(f"events[{i}]: expected one of ba.events, such as ba.events.Contact(), got {brief(one)}")
        try:
            one.watched(system)
        except InputError as error:
            raise InputError(f"events[{i}]: {error}") from None
    if not through(events):
        return tuple(events)
    known = {pair for one in events if isinstance(one, Contact) for pair in one.pairs(system)}
    others = [(pair.primary, pair.secondary) for pair in system.pairs]
    return (*events, *(Contact(pair) for pair in others if pair not in known))
