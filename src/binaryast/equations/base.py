"""What all forms of the equations have in common: their variables in a flat array, and the way from and to a state."""

from abc import ABC, abstractmethod
from functools import cached_property
from math import prod
from typing import Any, NamedTuple

import numpy as np
from astropy.time import Time

from binaryast.errors import InputError, did_you_mean
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats, brief, quantity

FORMS = ("lagrangian", "hamiltonian")
FRAMES = ("inertial", "relative")


class Moment(NamedTuple):
    """All bodies at one moment as plain SI floats: v (n, 3), Omega (n, 3), x (n, 3), R (n, 3, 3) of (25)-(28)."""

    v: Floats
    Omega: Floats
    x: Floats
    R: Floats


class Invariants(NamedTuple):
    """What a moment's motion conserves, SI; energy and angular momentum are about the barycentre.

    Attributes
    ----------
    energy, potential_energy : float
        E and U [J].
    angular_momentum, linear_momentum : ndarray
        pi_T (3,) [kg m2/s] and gamma_T (3,) [kg m/s], inertial.
    rotation_error : float
        The largest ||I - R^T R|| of the bodies.
    separation : float
        The smallest distance of two mass centres [m].
    """

    energy: float
    potential_energy: float
    angular_momentum: Floats
    linear_momentum: Floats
    rotation_error: float
    separation: float

    @property
    def measures(self) -> tuple[float, ...]:
        """In the order of the compiled loops: E, pi_T, gamma_T, ||I - R^T R||, the separation."""
        return (self.energy, *self.angular_momentum, *self.linear_momentum, self.rotation_error, self.separation)


class Equations(ABC):
    """One form of the equations of motion of a system.

    Attributes
    ----------
    system : System
        Whose motion they are.
    frame, form : str
        ``inertial`` or ``relative``, ``lagrangian`` or ``hamiltonian``.
    numbers : str
        Those of the equations in the paper.
    variables : dict of str to tuple of int
        The variables in their order in ``y``, named as in the paper, each with its shape. Inertial ones have a row for
        each body; relative ones are in the primary's frame, but for those that end in 2 in lower case, and R2.
    size : int
        The length of ``y``.
    """

    numbers: str
    variables: dict[str, tuple[int, ...]]

    def __init__(self, system: System, frame: str, form: str) -> None:
        if not isinstance(system, System):
            raise InputError(f"equations: system: expected a ba.System, got {brief(system)}")
        for name, value, known in (("frame", frame, FRAMES), ("form", form, FORMS)):
            if value not in known:
                near = did_you_mean(str(value), known)
                raise InputError(f"equations: {name}={brief(repr(value))}{near}: expected one of {', '.join(known)}")
        if frame == "relative" and len(system.bodies) > 2:
            raise InputError(
                f"equations: frame='relative' is for a pair, got {len(system.bodies)} bodies: take frame='inertial'"
            )
        self.system, self.frame, self.form = system, frame, form
        self.m = np.array([body.si.mass for body in system.bodies])
        self.J = np.array([np.diag(body.si.moments) for body in system.bodies])
        self._everything = _arguments(system, self.m, self.J)
        self._arguments: tuple[Any, ...]
        if frame == "relative":
            self.m1, self.m2, self.J1, self.J2 = float(self.m[1]), float(self.m[0]), self.J[1], self.J[0]
            self.reduced_mass = system.reduced_mass
            self._arguments = (*self._everything[:2], self.m1, self.m2, self.J1, self.J2)
        else:
            self._arguments = self._everything

    @cached_property
    def _places(self) -> dict[str, tuple[slice, tuple[int, ...]]]:
        """Where each variable is in ``y``, and its shape."""
        places, begin = {}, 0
        for name, shape in self.variables.items():
            places[name] = slice(begin, begin + prod(shape)), shape
            begin += prod(shape)
        return places

    @cached_property
    def size(self) -> int:
        """The length of ``y``."""
        return sum(prod(shape) for shape in self.variables.values())

    def unpack(self, y: Any) -> dict[str, Floats]:
        """Return the variables by name, as views of the flat array.

        Raises
        ------
        InputError
            Where the array has another length.
        """
        y = np.ascontiguousarray(y, dtype=np.float64)
        if y.shape != (self.size,):
            raise InputError(f"y: expected a flat array of {self.size} numbers for {self.numbers}, got {y.shape}")
        return {name: y[place].reshape(shape) for name, (place, shape) in self._places.items()}

    def pack(self, **variables: Any) -> Floats:
        """Return a flat array of variables given by name."""
        if set(variables) != set(self.variables):
            raise InputError(f"pack: expected {', '.join(self.variables)}, got {', '.join(variables)}")
        arrays = [np.asarray(variables[name], dtype=np.float64) for name in self.variables]
        for array, (name, shape) in zip(arrays, self.variables.items(), strict=True):
            if array.shape != shape:
                raise InputError(f"pack: {name}: expected shape {shape}, got {array.shape}")
        return np.concatenate([array.ravel() for array in arrays])

    def from_state(self, state: State) -> Floats:
        """Return the variables of a state as a flat array.

        Raises
        ------
        InputError
            Where the state has another number of bodies.
        """
        if not isinstance(state, State) or len(state.si.position) != len(self.system.bodies):
            raise InputError(f"state: expected a ba.State of {len(self.system.bodies)} bodies, got {brief(state)}")
        position, velocity, attitude, spin = state.si
        return self._from_moment(Moment(velocity, spin, position, attitude))

    def to_state(self, y: Any, *, epoch: Time | None = None, frame: str = "local") -> State:
        """Return the state of a flat array of variables.

        Raises
        ------
        InputError
            Where an attitude has left SO(3) by more than 1e-9, as those of the continuous equations do in time.
        """
        v, Omega, x, R = self.to_moment(y)
        return State(quantity(x, "m"), quantity(v, "m / s"), R, quantity(Omega, "rad / s"), epoch, frame)

    def invariants(self, y: Any) -> Invariants:
        """Return what should be conserved, as it is in ``y``; attitudes need not be rotations."""
        from binaryast.kernels.invariants import invariants

        arrays = (np.ascontiguousarray(array) for array in self.to_moment(y))
        U, measures = invariants(*self._everything, *arrays)
        return Invariants(measures[0], U, np.array(measures[1:4]), np.array(measures[4:7]), measures[7], measures[8])

    def to_moment(self, y: Any) -> Moment:
        """Return positions, velocities, attitudes and spins of all bodies as floats, whatever the attitudes are."""
        return self._to_moment(**self.unpack(y))

    @abstractmethod
    def _from_moment(self, moment: Moment) -> Floats:
        """Return the variables of a moment: the Legendre transform."""

    @abstractmethod
    def _to_moment(self, **variables: Floats) -> Moment:
        """Return the moment of variables: the inverse Legendre transform."""

    def relative(self, moment: Moment) -> dict[str, Floats]:
        """Return (34)-(39) and the momenta below (62), with v2, x2 and R2."""
        v, Omega, x, R = moment
        R2 = R[0]
        relative = R2.T @ R[1]  # (35)
        V = R2.T @ (v[1] - v[0])  # (36)
        return {
            "V": V,
            "Omega": relative @ Omega[1],  # (37)
            "Omega2": Omega[0],
            "Gamma": self.reduced_mass * V,
            "Pi": relative @ self.J1 @ Omega[1],
            "Pi2": self.J2 @ Omega[0],
            "X": R2.T @ (x[1] - x[0]),  # (34)
            "R": relative,
            "v2": v[0],
            "gamma2": self.m2 * v[0],
            "x2": x[0],
            "R2": R2,
        }


def from_relative(
    V: Floats, Omega: Floats, Omega2: Floats, X: Floats, R: Floats, v2: Floats, x2: Floats, R2: Floats
) -> Moment:
    """Return both bodies, primary first, from relative variables, by (34)-(37)."""
    return Moment(
        v=np.array([v2, v2 + R2 @ V]),
        Omega=np.array([Omega2, R.T @ Omega]),
        x=np.array([x2, x2 + R2 @ X]),
        R=np.array([R2, R2 @ R]),
    )


def angular_velocity(J: Floats, Pi: Floats) -> Floats:
    """Return Omega of J Omega = Pi; a point, which has no inertia, does not turn."""
    return np.linalg.solve(J, Pi) if np.any(J) else np.zeros(3)


def _arguments(system: System, m: Floats, J: Floats) -> tuple[Any, ...]:
    """Return what the inertial kernels need: potentials, parameters, pairs, masses, inertia."""
    from binaryast.kernels.pointers import table_of

    ends = np.cumsum([len(pair.parameters) for pair in system.pairs])
    pairs = [
        (pair.primary, pair.secondary, end - len(pair.parameters), end)
        for pair, end in zip(system.pairs, ends, strict=True)
    ]
    return (
        table_of([pair.gravity.potential for pair in system.pairs]),
        np.concatenate([pair.parameters for pair in system.pairs]),
        np.array(pairs, dtype=np.int64),
        m,
        J,
    )
