"""What all forms of the equations have in common: their variables in a flat array, and the way from and to a state."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property
from math import prod
from typing import Any, NamedTuple

import numpy as np
from astropy.time import Time
from astropy.units import Quantity

from binaryast.equations.legendre import Inertial, Relative, Snapshot
from binaryast.errors import InputError, did_you_mean
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats, brief, quantity

FORMS = ("lagrangian", "hamiltonian")
FRAMES = ("inertial", "relative")


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
        The variables in their order in ``y``, named as in the paper, each with its shape; what they are, in which
        units and frames, stands in `binaryast.equations`.
    size : int
        The length of ``y``.
    """

    numbers: str
    variables: dict[str, tuple[int, ...]]

    def __init__(self, system: System, frame: str, form: str) -> None:
        if not isinstance(system, System):
            raise InputError(f"equations: system: expected a ba.System, got {brief(system)}")
        for name, value, known in (("frame", frame, FRAMES), ("form", form, FORMS)):
            if not isinstance(value, str) or value not in known:
                near = did_you_mean(str(value), known)
                raise InputError(f"equations: {name}={brief(repr(value))}{near}: expected one of {', '.join(known)}")
        if frame == "relative" and len(system.bodies) > 2:
            raise InputError(
                f"equations: frame='relative' is for a pair, got {len(system.bodies)} bodies: take frame='inertial'"
            )
        self.system, self.frame, self.form = system, frame, form
        self._made_of: tuple[Any, ...] = (system, frame, form)
        self._inertial = Inertial(system)
        self._frame = Relative(system) if frame == "relative" else self._inertial

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._made_of  # compiled functions have other addresses in another process

    def __repr__(self) -> str:
        names = ", ".join(self.system.names)
        return f"<{type(self).__name__} {self.numbers}, {self.frame} {self.form} form, of {names}>"

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
        """Return the variables by name, where it can be as views of the flat array.

        Raises
        ------
        InputError
            Where the array has another length.
        """
        y = self._checked(y)
        return {name: y[place].reshape(shape) for name, (place, shape) in self._places.items()}

    def _checked(self, y: Any) -> Floats:
        """Return ``y`` as a flat array that kernels take: of floats, its own where it was read-only."""
        try:
            if isinstance(y, Quantity) or np.asarray(y).dtype.kind not in "iuf":
                raise TypeError
            array: Floats = np.require(y, np.float64, ["C", "W"])
        except (TypeError, ValueError):
            raise InputError(f"y: expected a flat array of plain numbers, got {brief(repr(y))}") from None
        if array.shape != (self.size,):
            raise InputError(f"y: expected a flat array of {self.size} numbers for {self.numbers}, got {array.shape}")
        return array

    def _call(self, kernel: Callable[..., Any], *arguments: Any) -> Any:
        """Call a compiled function; what a user's potential raises is said in our words."""
        try:
            return kernel(*arguments)
        except Exception as error:
            raise InputError(f"gravity: the potential raised {type(error).__name__}: {brief(error)}") from None

    def _finite(self, values: Floats) -> Floats:
        """Return values, or say that they are no numbers."""
        if not np.all(np.isfinite(values)):
            raise InputError(
                f"{self.numbers}: the result is not a number: bodies in one place, a potential that is wrong there, or "
                "numbers in y that are none"
            )
        return values

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
        return self._from_snapshot(Snapshot(velocity, spin, position, attitude))

    def to_state(self, y: Any, *, epoch: Time | None = None, frame: str = "local") -> State:
        """Return the state of a flat array of variables.

        Raises
        ------
        InputError
            Where an attitude has left SO(3) by more than 1e-9, as those of the continuous equations do in time.
        """
        v, Omega, x, R = self.snapshot(y)
        return State(quantity(x, "m"), quantity(v, "m / s"), R, quantity(Omega, "rad / s"), epoch, frame)

    def invariants(self, y: Any) -> Invariants:
        """Return what should be conserved, as it is in ``y``; attitudes need not be rotations."""
        from binaryast.kernels.invariants import invariants

        arrays = (np.array(array) for array in self.snapshot(y))
        U, measures = self._call(invariants, *self._inertial.arguments, *arrays)
        return Invariants(measures[0], U, np.array(measures[1:4]), np.array(measures[4:7]), measures[7], measures[8])

    def snapshot(self, y: Any) -> Snapshot:
        """Return positions, velocities, attitudes and spins of all bodies as floats, whatever the attitudes are."""
        return self._to_snapshot(**self.unpack(y))

    @abstractmethod
    def _from_snapshot(self, at: Snapshot) -> Floats:
        """Return the variables of a snapshot: the Legendre transform."""

    @abstractmethod
    def _to_snapshot(self, **variables: Floats) -> Snapshot:
        """Return the snapshot of variables: the inverse Legendre transform."""
