"""Gravity that is chosen by distance: a multipole far away, an exact model near, joined into one potential."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from astropy.units import Quantity

from binaryast.bodies import RigidBody
from binaryast.errors import InputError
from binaryast.gravity import EllipsoidPair, Gravity, Multipole
from binaryast.units import Floats, brief, numbers, quantity

FINEST, COARSEST = 1e-15, 1e-2  # what an accuracy can be
WIDTH = 0.25  # of the interval in which both are joined, over the distance where it begins
SAMPLES = 100  # configurations at which the multipole's next terms are looked at
ROUNDS = 8  # of the search for the distance at which they are as large as the accuracy


@dataclass(frozen=True, eq=False, kw_only=True)
class Adaptive(Gravity):
    """An exact model near and a multipole far away, joined smoothly into one conservative potential.

    U = w U_near + (1 - w) U_far, where w falls from 1 to 0 over an interval of distances as a polynomial with four
    continuous derivatives. The interval begins where the multipole's next terms, the largest of many configurations,
    are as large as the accuracy, and not before spheres about both bodies are apart. Beyond it, a step costs what the
    multipole costs. Force and torques are the derivatives of this U, so that energy does not jump at any accuracy.

    Parameters
    ----------
    accuracy : float
        What the multipole may leave out of U, over G m1 m2/r: 1e-15 to 1e-2. Of the force it is about the degree times
        as much.
    near : Gravity
        The model for what is near, `EllipsoidPair` by default.
    far : Multipole or SecondDegree
        The model for what is far away, a series that is cut at a degree; ``Multipole(8)`` by default.

    Raises
    ------
    InputError
        For an accuracy out of these limits, or models that are not these; from `System`, where one of them cannot take
        the bodies.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> bodies = [ba.RigidBody(n, ba.Ellipsoid(5 * u.m, 4 * u.m, 3 * u.m), mass=1e6 * u.kg) for n in "AB"]
    >>> gravity = ba.Adaptive(accuracy=1e-6, far=ba.Multipole(4))
    >>> system = ba.System(bodies, gravity)
    >>> print(gravity.interval(*bodies).round(2))
    [33.16 41.46] m
    >>> for x in (8.5, 37, 50) * u.m:
    ...     print(system.mutual_gravity([0, x.value, 0] * u.m).energy.round(6))
    -7.828343 J
    -1.803351 J
    -1.334649 J
    """

    accuracy: float = 1e-10
    near: Gravity = field(default_factory=EllipsoidPair)
    far: Gravity = field(default_factory=lambda: Multipole(8))

    def __post_init__(self) -> None:
        accuracy = float(numbers(self.accuracy, "Adaptive: accuracy", ()))
        if not FINEST <= accuracy <= COARSEST:
            raise InputError(f"Adaptive: accuracy: expected {FINEST:g} to {COARSEST:g}, got {accuracy:g}")
        if not isinstance(self.near, Gravity) or isinstance(self.near, Adaptive):
            raise InputError(f"Adaptive: near: expected a model such as ba.EllipsoidPair(), got {brief(self.near)}")
        if not isinstance(self.far, Gravity) or self.far.cut_at is None:
            raise InputError(f"Adaptive: far: expected a series such as ba.Multipole(8), got {brief(self.far)}")
        self._set(accuracy=accuracy)

    @property
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential, one for all models: the parameters hold pointers to theirs."""
        from binaryast.kernels.mutual.blend import potential

        return potential

    def parameters(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return pointers to both potentials, the interval, and what both need.

        The pointers are good in this process; a system that is unpickled or read from a file has its own.
        """
        from binaryast.kernels.mutual import blend
        from binaryast.kernels.pointers import table_of

        near, far = (model.parameters(secondary, primary) for model in (self.near, self.far))
        first = blend.FIRST_FAR + 1
        table = table_of([self.far.potential_for(far), self.near.potential_for(near)])
        header = [*self._interval(secondary, primary), first, first + len(near)]
        return np.concatenate([table.view(np.float64), header, near, far])

    def interval(self, primary: RigidBody, secondary: RigidBody) -> Quantity:
        """Return the two distances of the mass centres (2,) between which the models are joined [m]."""
        return quantity(self._interval(secondary, primary), "m")

    def check_place(self, secondary: RigidBody, primary: RigidBody, x: Floats, r: Floats) -> None:
        """Raise where the near model cannot be asked, see `Gravity.check_place`."""
        self.near.check_place(secondary, primary, x, r)

    def _interval(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return where the interval begins and ends [m]: its next terms fall with a power of the distance."""
        towards, attitudes = _configurations()
        nearest = distance = _reach(secondary) + _reach(primary)
        power = 1 / ((self.far.cut_at or 0) + 2)
        for _ in range(ROUNDS):
            terms = self.far.next_terms(secondary, primary, distance * towards, attitudes)
            if terms is None:
                raise InputError(
                    f"Adaptive: {self.far!r}: its next terms are not known for {primary.name} and {secondary.name}, "
                    "whose moments must be known two degrees further: take a lower degree"
                )
            distance = max(nearest, distance * float(terms.max() / self.accuracy) ** power)
        return np.array([distance, distance * (1 + WIDTH)])


def _reach(body: RigidBody) -> float:
    """Return the radius of a sphere about the mass centre that holds the body."""
    points = 0.0 if body.points is None else float(np.linalg.norm(body.points[0], axis=1).max())
    return max(body.bounding_radius, points)


def _configurations() -> tuple[Floats, Floats]:
    """Return directions (N, 3) and attitudes (N, 3, 3): axes along each other in all ways, and some by chance."""
    random = np.random.default_rng(0)
    axes = np.eye(3)
    swaps = np.array([axes[list(order)] for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))])
    vectors = random.normal(size=(SAMPLES, 3))
    turns = np.linalg.qr(random.normal(size=(SAMPLES, 3, 3)))[0]
    turns *= np.sign(np.linalg.det(turns))[:, None, None]
    return (
        np.concatenate([np.repeat(axes, 3, axis=0), vectors / np.linalg.norm(vectors, axis=1, keepdims=True)]),
        np.concatenate([np.tile(swaps, (3, 1, 1)), turns]),
    )
