"""A system: bodies and how they attract, checked once."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from astropy.units import Quantity

from binaryast.bodies import RigidBody
from binaryast.errors import InputError
from binaryast.gravity import Gravity, SecondDegree
from binaryast.units import Floats, brief, numbers, quantity, to_si
from binaryast.values import Value

ROTATION_TOLERANCE = 1e-9  # ||I - R^T R|| of an attitude that a user gives


@dataclass(frozen=True, eq=False)
class MutualGravity:
    """The mutual gravity of a pair in one configuration; vectors are in the primary's frame.

    Attributes
    ----------
    energy : Quantity
        U [J].
    gradient : Quantity
        dU/dX (3,) [N].
    moment : Quantity
        The paper's M (3,), equation (54) [N m].
    force_on_secondary, torque_on_secondary, torque_on_primary : Quantity
        -dU/dX, -M and X x dU/dX + M (3,), each torque about that body's mass centre.
    """

    energy: Quantity
    gradient: Quantity
    moment: Quantity
    force_on_secondary: Quantity
    torque_on_secondary: Quantity
    torque_on_primary: Quantity


@dataclass(frozen=True, eq=False)
class System(Value):
    """Bodies under mutual gravity.

    Parameters
    ----------
    bodies : sequence of RigidBody
        Index 0 is the primary (the paper's body 2), which owns the relative frame; index 1 the secondary (body 1).
    gravity : Gravity
        How the pair attracts; `SecondDegree` by default.

    Raises
    ------
    InputError
        For other than two bodies, names that are not unique, or a gravity that cannot take these bodies.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> one, two = (ba.RigidBody(n, ba.Sphere(1 * u.km), mass=1e12 * u.kg) for n in ("one", "two"))
    >>> system = ba.System([one, two])
    >>> attraction = system.mutual_gravity(position=[10, 0, 0] * u.km)
    >>> print(attraction.gradient)
    [667430.      0.      0.] N
    """

    bodies: Sequence[RigidBody]
    gravity: Gravity = field(default_factory=SecondDegree)

    def __post_init__(self) -> None:
        if not isinstance(self.bodies, Sequence):
            raise InputError(
                f"System: bodies: expected a list of ba.RigidBody, primary first, got {brief(self.bodies)}"
            )
        bodies = tuple(self.bodies)
        for body in bodies:
            if not isinstance(body, RigidBody):
                raise InputError(f"System: bodies: expected ba.RigidBody, got {brief(body)}")
        if len(bodies) != 2:
            raise InputError(f"System: bodies: this version takes a pair, primary first; got {len(bodies)}")
        if bodies[0].name == bodies[1].name:
            raise InputError(f"System: two bodies are called {bodies[0].name!r}: give each its own name")
        if not isinstance(self.gravity, Gravity):
            raise InputError(f"System: gravity: expected a model such as ba.SecondDegree(), got {brief(self.gravity)}")
        self._set(bodies=bodies)
        parameters = self.gravity.parameters(bodies[1], bodies[0])
        if not np.all(np.isfinite(parameters)):
            raise InputError("System: the masses are beyond what can be computed with")
        self._set(_parameters=parameters)

    _parameters: Floats = field(init=False, repr=False)

    @property
    def parameters(self) -> Floats:
        """What the potential needs of the bodies: a copy, for compiled functions take no read-only array."""
        return self._parameters.copy()

    @property
    def primary(self) -> RigidBody:
        """The paper's body 2."""
        return self.bodies[0]

    @property
    def secondary(self) -> RigidBody:
        """The paper's body 1."""
        return self.bodies[1]

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the bodies."""
        return tuple(body.name for body in self.bodies)

    @property
    def reduced_mass(self) -> float:
        """The paper's m = m1 m2/(m1 + m2) [kg]."""
        one, two = self.secondary.si.mass, self.primary.si.mass
        return one * two / (one + two)

    def attraction(self, x: Floats, r: Floats) -> tuple[float, ...]:
        """Return U, dU/dX (3) and M (3) at X (3,) and R (3, 3), all plain SI floats.

        Raises
        ------
        InputError
            Where the potential gives something that is not a number, or raises.
        """
        try:
            values: tuple[float, ...] = self.gravity.potential(self.parameters, *x, *r.ravel())
        except InputError:
            raise
        except Exception as error:  # whatever a user's function raises
            raise InputError(f"gravity: the potential raised {type(error).__name__}: {brief(error)}") from None
        if not np.all(np.isfinite(values)):
            raise InputError(
                f"gravity: at X = {brief(x)} m it is not a number: too near, too far, or a wrong potential"
            )
        return values

    def mutual_gravity(self, position: Quantity, attitude: Any = None) -> MutualGravity:
        """Return energy, force and torques of one configuration.

        Parameters
        ----------
        position : Quantity
            X (3,): the secondary's mass centre in the primary's frame (length).
        attitude : array-like or Rotation, optional
            R (3, 3): secondary's body frame -> primary's; the identity by default.

        Returns
        -------
        MutualGravity

        Raises
        ------
        InputError
            For an attitude that is not a rotation, or coinciding mass centres.
        """
        x = to_si(position, "m", "position", shape=(3,))
        if not np.any(x):
            raise InputError("position: the mass centres coincide: expected a position that is not zero")
        r = np.eye(3) if attitude is None else rotation(attitude, "attitude", ())
        u, *rest = self.attraction(x, r)
        gradient, moment = np.array(rest[:3]), np.array(rest[3:])
        return MutualGravity(
            energy=quantity(u, "J"),
            gradient=quantity(gradient, "N"),
            moment=quantity(moment, "N m"),
            force_on_secondary=quantity(-gradient, "N"),
            torque_on_secondary=quantity(-moment, "N m"),
            torque_on_primary=quantity(np.cross(x, gradient) + moment, "N m"),
        )


def rotation(value: Any, name: str, shape: tuple[int, ...]) -> Floats:
    """Return rotation matrices of shape (*shape, 3, 3), from matrices or from a SciPy ``Rotation``; read-only.

    Raises
    ------
    InputError
        Where ||I - R^T R|| is above 1e-9 or a determinant is -1.
    """
    matrices = numbers(value.as_matrix() if hasattr(value, "as_matrix") else value, name, (*shape, 3, 3))
    error = np.linalg.norm(np.eye(3) - np.swapaxes(matrices, -1, -2) @ matrices, axis=(-2, -1))
    if np.any(error > ROTATION_TOLERANCE):
        raise InputError(
            f"{name}: not a rotation: ||I - R^T R|| is {np.max(error):.3g}, expected below {ROTATION_TOLERANCE:g}; "
            "scipy.spatial.transform.Rotation.from_matrix(R) gives the nearest one"
        )
    if np.any(np.linalg.det(matrices) < 0):
        raise InputError(f"{name}: a reflection, with determinant -1: expected a rotation; turn one axis round")
    return matrices
