"""Impulses: sudden changes of a body's velocity and spin, by a kick or by something that hits it."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from astropy.units import Quantity

from binaryast.errors import InputError
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats, brief, numbers, quantity, span, to_si
from binaryast.values import Value

ON_SURFACE = 1e-6  # relative: a point computed to lie on the sphere that holds a body may be out of it by round-off


class Kick(Value, ABC):
    """What is sudden: at a time, of a body's velocity and spin."""

    time: Quantity
    body: str | int

    def check(self, system: System) -> None:
        """Raise where it cannot happen to this system."""
        system.index(self.body)

    @abstractmethod
    def velocity_change(self, system: System) -> Quantity:
        """Return by how much the velocity of its body changes (3,), inertial."""

    def spin_change(self, state: State, system: System) -> Floats:  # noqa: ARG002
        """Return by how much the spin of its body changes (3,), in its own frame [rad/s]."""
        return np.zeros(3)

    def apply(self, state: State, system: System) -> State:
        """Return the state after it.

        Parameters
        ----------
        state : State
            Just before.
        system : System
            Whose state it is.

        Returns
        -------
        State
            The same places, attitudes and epoch.

        Raises
        ------
        InputError
            For a body that the system does not have, or a point that is none of its surface or of a point mass.
        """
        self.check(system)
        index = system.index(self.body)
        velocity, spin = state.si.velocity.copy(), state.si.spin.copy()
        velocity[index] += self.velocity_change(system).value
        spin[index] += self.spin_change(state, system)
        return replace(state, velocity=quantity(velocity, "m / s"), spin=quantity(spin, "rad / s"))


@dataclass(frozen=True, eq=False)
class Impulse(Kick):
    """A sudden change of the velocity of a body's mass centre; its spin stays as it is.

    Parameters
    ----------
    time : Quantity
        When, since the start of the run (time); met exactly. It may be 0, or the end of the run.
    delta_v : Quantity
        Change of the velocity (3,), inertial.
    body : str or int
        Whose: its name or its index.

    Raises
    ------
    UnitError, InputError
        For a wrong unit or shape, values that are not finite, or a time below zero.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> kick = ba.Impulse(1 * u.day, [0, 0, -2] * u.mm / u.s, "Dimorphos")
    >>> print((kick.apply(state, system).velocity - state.velocity)[1].to("mm / s").round(6))
    [ 0.  0. -2.] mm / s
    """

    time: Quantity
    delta_v: Quantity
    body: str | int

    def __post_init__(self) -> None:
        self._set(
            time=quantity(to_si(self.time, "s", "time", sign="non-negative"), "s"),
            delta_v=quantity(to_si(self.delta_v, "m / s", "delta_v", shape=(3,)), "m / s"),
        )

    def velocity_change(self, system: System) -> Quantity:  # noqa: ARG002
        """Return by how much the velocity of its body changes (3,), inertial."""
        return self.delta_v


@dataclass(frozen=True, eq=False)
class Impact(Kick):
    """Something that hits a body and changes its velocity, and its spin where it hits off the mass centre.

    The momentum of the body changes by beta m v, and its angular momentum about its mass centre by r x beta m v, where
    r leads from the mass centre to the point that is hit. Its mass and shape stay: what hits is not added to it, and
    what is thrown out is not taken off.

    Parameters
    ----------
    time : Quantity
        When, since the start of the run (time); met exactly. It may be 0, or the end of the run.
    mass : Quantity
        m, of what hits.
    velocity : Quantity
        v (3,), inertial axes, relative to the mass centre of the body that is hit. How fast the surface turns is not
        taken off.
    body : str or int
        Which is hit: its name or its index.
    beta : float
        By how much the momentum that is gained exceeds the one that is brought: 1 where all stays in the body, more
        where matter is thrown out backwards. What is thrown out is taken to recoil along v.
    point : Quantity, optional
        r (3,), in the body's frame; by default the line of flight goes through the mass centre, and no spin changes.

    Raises
    ------
    UnitError, InputError
        For a wrong unit or shape, values that are not finite, a time below zero, or a mass or beta not above it.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> impact = ba.Impact(1 * u.day, 579.4 * u.kg, [0, 0, -6.14] * u.km / u.s, "Dimorphos", 3.3, [0, 20, 50] * u.m)
    >>> after = impact.apply(state, system)
    >>> print((after.velocity - state.velocity)[1].to("mm / s").round(2))
    [ 0.    0.   -2.63] mm / s
    """

    time: Quantity
    mass: Quantity
    velocity: Quantity
    body: str | int
    beta: float = 1.0
    point: Quantity | None = None

    def __post_init__(self) -> None:
        point = None if self.point is None else quantity(to_si(self.point, "m", "point", shape=(3,)), "m")
        beta = float(numbers(self.beta, "beta", ()))
        if not beta > 0:
            raise InputError(f"beta: expected a number above 0, 1 where all momentum stays in the body, got {beta:g}")
        self._set(
            time=quantity(to_si(self.time, "s", "time", sign="non-negative"), "s"),
            mass=quantity(to_si(self.mass, "kg", "mass", sign="positive"), "kg"),
            velocity=quantity(to_si(self.velocity, "m / s", "velocity", shape=(3,)), "m / s"),
            beta=beta,
            point=point,
        )

    def check(self, system: System) -> None:
        """Raise where it cannot happen to this system."""
        body = system.bodies[system.index(self.body)]
        if self.point is None or not np.any(self.point.value):
            return
        if body.is_point:
            raise InputError(f"point: {body.name} is a point, which does not turn: leave the point of impact out")
        distance = float(np.linalg.norm(self.point.value))
        if distance > body.bounding_radius * (1 + ON_SURFACE):
            raise InputError(
                f"point: {distance:g} m from the mass centre of {body.name}, none of whose surface is further than "
                f"{body.bounding_radius:g} m: expected a point of it, in the body's frame"
            )

    def spin_change(self, state: State, system: System) -> Floats:
        """Return by how much the spin of its body changes (3,), in its own frame [rad/s]."""
        index = system.index(self.body)
        body = system.bodies[index]
        if self.point is None or body.is_point:
            return np.zeros(3)
        return np.asarray(np.cross(self.point.value, state.si.attitude[index].T @ self._momentum) / body.si.moments)

    @property
    def _momentum(self) -> Floats:
        """What the body gains [kg m/s], inertial."""
        return np.asarray(self.beta * self.mass.value * self.velocity.value)

    def velocity_change(self, system: System) -> Quantity:
        """Return by how much the velocity of its body changes (3,), inertial."""
        return quantity(self._momentum / system.bodies[system.index(self.body)].si.mass, "m / s")


AnyImpulse: TypeAlias = Impulse | Impact
KINDS: dict[str, type[AnyImpulse]] = {"Impulse": Impulse, "Impact": Impact}


def in_order(impulses: Any, system: System, end: float) -> tuple[AnyImpulse, ...]:
    """Return impulses in the order of their times, those at one time as they are given.

    Raises
    ------
    InputError
        For what is no impulse, none of this system's bodies, or after the end [s].
    """
    if isinstance(impulses, str) or not isinstance(impulses, Sequence):
        raise InputError(f"impulses: expected a list of ba.Impulse and ba.Impact, got {brief(impulses)}")
    for i, impulse in enumerate(impulses):
        if not isinstance(impulse, (Impulse, Impact)):
            raise InputError(f"impulses[{i}]: expected a ba.Impulse or a ba.Impact, got {brief(impulse)}")
        try:
            impulse.check(system)
        except InputError as error:
            raise InputError(f"impulses[{i}]: {error}") from None
        if impulse.time.value > end:
            raise InputError(
                f"impulses[{i}]: its time, {span(impulse.time.value)}, is after the end of the run of {span(end)}: "
                "run longer, or leave it out"
            )
    return tuple(sorted(impulses, key=lambda impulse: float(impulse.time.value)))
