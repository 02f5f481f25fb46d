"""A user's own forces, and potentials from outside."""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from binaryast.bodies import RigidBody
from binaryast.compiling import Function, compiled
from binaryast.errors import InputError
from binaryast.perturbations.base import Perturbation, Span
from binaryast.units import Floats, brief, numbers


class OfUser(Perturbation):
    """What a compiled function of a user's does."""

    function: Callable[..., Any] | str
    values: Sequence[float]
    decorator: ClassVar[str]

    @staticmethod
    @abstractmethod
    def signature() -> Any:
        """Return what the function must be compiled to."""

    def _check_function(self) -> None:
        """Raise for a function that is not compiled, and take in the values."""
        name = type(self).__name__
        if not isinstance(self.function, str) and self.signature().args not in getattr(self.function, "overloads", {}):
            raise InputError(f"{name}: {brief(self.function)} is not compiled: decorate it with @ba.{self.decorator}")
        count = len(self.values) if isinstance(self.values, (Sequence, np.ndarray)) else 0
        self._set(values=numbers(self.values, f"{name}: values", (count,)).copy())

    @property
    def kernel(self) -> Callable[..., Any]:
        """The compiled function."""
        if isinstance(self.function, str):  # read from a file on which only the name could be kept
            raise InputError(
                f"{type(self).__name__}: the function {self.function} cannot be imported here: build the system anew"
            )
        return self.function

    def check(self, bodies: Sequence[RigidBody]) -> None:
        """Raise where it cannot act on these bodies: who wrote it knows."""

    def parameters(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return the user's values."""
        return np.array(self.values)


@dataclass(frozen=True, eq=False, repr=False)
class Force(OfUser):
    """A force of your own.

    Parameters
    ----------
    function : callable
        Compiled by `binaryast.force`.
    values : sequence of float
        What it gets as ``p``, plain SI.

    Examples
    --------
    A drag on body 1, in the frame of the barycentre:

    >>> import binaryast as ba
    >>> @ba.force
    ... def drag(p, t, position, velocity, attitude, spin, force, torque):
    ...     for k in range(3):
    ...         force[1, k] -= p[0] * velocity[1, k]
    >>> perturbation = ba.Force(drag, [1e-3])
    """

    function: Callable[..., Any] | str
    values: Sequence[float] = ()

    conservative: ClassVar[bool] = False
    decorator: ClassVar[str] = "force"

    def __post_init__(self) -> None:
        self._check_function()

    @staticmethod
    def signature() -> Any:
        """Return what the function must be compiled to."""
        from binaryast.kernels.jit import FORCE

        return FORCE


@dataclass(frozen=True, eq=False, repr=False)
class ExternalPotential(OfUser):
    """A potential of your own, from outside the system; it may change with time.

    Parameters
    ----------
    function : callable
        Compiled by `binaryast.external_potential`.
    values : sequence of float
        What it gets as ``p``, plain SI.

    Examples
    --------
    A spring that holds body 0 at the origin:

    >>> import binaryast as ba
    >>> @ba.external_potential
    ... def spring(p, t, position, attitude, force, torque):
    ...     energy = 0.0
    ...     for k in range(3):
    ...         force[0, k] -= p[0] * position[0, k]
    ...         energy += 0.5 * p[0] * position[0, k] ** 2
    ...     return energy, 0.0
    >>> perturbation = ba.ExternalPotential(spring, [10.0])
    """

    function: Callable[..., Any] | str
    values: Sequence[float] = ()

    conservative: ClassVar[bool] = True
    decorator: ClassVar[str] = "external_potential"

    def __post_init__(self) -> None:
        self._check_function()

    @staticmethod
    def signature() -> Any:
        """Return what the function must be compiled to."""
        from binaryast.kernels.jit import EXTERNAL_POTENTIAL

        return EXTERNAL_POTENTIAL


def force(function: Function) -> Function:
    """Compile a force of your own, for `binaryast.Force`.

    Parameters
    ----------
    function : callable
        ``function(p, t, position, velocity, attitude, spin, force, torque)``: values ``p`` (float array); the time
        since the start of the run [s]; of all bodies position and velocity (n, 3) from the barycentre at the start,
        inertial [m, m/s], attitude (n, 3, 3) body -> inertial, and spin (n, 3) in the body's frame [rad/s]. It adds to
        ``force`` (n, 3), inertial [N], and ``torque`` (n, 3) about the mass centre, in the body's frame [N m], and
        returns nothing. What work it does is found from the motion.

    Returns
    -------
    callable
        The compiled function.

    Raises
    ------
    InputError
        Where numba cannot compile it to that signature.
    """
    return compiled(function, Force.signature(), "force", "8 arguments, and nothing as the result")


def external_potential(function: Function) -> Function:
    """Compile a potential of your own, for `binaryast.ExternalPotential`.

    Parameters
    ----------
    function : callable
        ``function(p, t, position, attitude, force, torque)``, as for `binaryast.force`. It adds to ``force`` and
        ``torque`` what the potential exerts, minus its gradients, and returns U [J] and dU/dt [W] at a fixed place.

    Returns
    -------
    callable
        The compiled function.

    Raises
    ------
    InputError
        Where numba cannot compile it to that signature.
    """
    return compiled(function, ExternalPotential.signature(), "external_potential", "6 arguments, and U and dU/dt")
