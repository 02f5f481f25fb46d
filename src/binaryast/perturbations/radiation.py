"""Sunlight: its pressure, and the mean torques of heat radiated unevenly."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import astropy.units as u
import numpy as np
from astropy.units import Quantity

from binaryast.bodies import RigidBody
from binaryast.errors import InputError
from binaryast.perturbations.base import Perturbation, Span, index_of
from binaryast.perturbations.distant import Distant
from binaryast.units import Floats, brief, numbers, quantity, to_si

SUNLIGHT = 3.828e26 / (4 * np.pi * 299792458.0)  # N: pressure times the square of the distance, IAU's luminosity


@dataclass(frozen=True, eq=False, repr=False)
class RadiationPressure(Perturbation):
    """The pressure of sunlight on a ball, or on a flat plate that turns with the body; nothing casts a shadow.

    Parameters
    ----------
    body : str
        Its name.
    sun : Sun or ThirdBody
        Where the Sun is. Its gravity acts only where it is one of the system's perturbations too.
    area : Quantity
        Of the ball's cross section, or of the plate.
    coefficient : float, optional
        Of a ball ("cannonball"), c_R: 1 where all is absorbed.
    normal : sequence of float, optional
        In its place, of a plate: (3,) in the body's frame. Both of its faces are alike.
    specular, diffuse : float
        Of a plate: the parts of the light that it reflects like a mirror, and evenly to all sides.
    point : Quantity, optional
        Of a plate: its middle (3,) in the body's frame, by default the mass centre; elsewhere there is a torque.

    Raises
    ------
    InputError
        For both a coefficient and a normal or neither, parts beyond 0 to 1, a body that is not in the system.

    References
    ----------
    O. Montenbruck, E. Gill, Satellite Orbits (2000), section 3.4.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> sun = ba.Sun(ba.Orbit(1.6442 * u.au, eccentricity=0.38385))
    >>> on_craft = ba.RadiationPressure("Hera", sun, area=14 * u.m**2, coefficient=1.3)
    """

    body: str
    sun: Distant
    area: Quantity
    coefficient: float | None = None
    normal: Sequence[float] | None = None
    specular: float = 0.0
    diffuse: float = 0.0
    point: Quantity | None = None

    conservative: ClassVar[bool] = False

    def __post_init__(self) -> None:
        name = "RadiationPressure"
        if not isinstance(self.sun, Distant):
            raise InputError(f"{name}: sun: expected such as ba.Sun(...), got {brief(repr(self.sun))}")
        self._set(area=quantity(to_si(self.area, "m2", f"{name}: area", sign="positive"), "m2"))
        if (self.coefficient is None) == (self.normal is None):
            raise InputError(f"{name}: give exactly one of coefficient= (of a ball) and normal= (of a plate)")
        if self.coefficient is not None:
            self._set(coefficient=float(numbers(self.coefficient, f"{name}: coefficient", ())))
            if self.coefficient < 0:
                raise InputError(f"{name}: coefficient: expected at least 0, got {self.coefficient:g}")
        if self.normal is not None:
            normal = numbers(self.normal, f"{name}: normal", (3,))
            if not np.any(normal):
                raise InputError(f"{name}: normal: expected a vector that is not zero")
            self._set(normal=normal / np.linalg.norm(normal))
        parts = [float(numbers(getattr(self, key), f"{name}: {key}", ())) for key in ("specular", "diffuse")]
        if min(parts) < 0 or sum(parts) > 1:
            raise InputError(f"{name}: specular and diffuse: expected 0 or more, 1 or less together, got {parts}")
        self._set(specular=parts[0], diffuse=parts[1])
        if self.point is not None:
            self._set(point=quantity(to_si(self.point, "m", f"{name}: point", shape=(3,)), "m"))

    @property
    def kernel(self) -> Callable[..., Any]:
        """The compiled force."""
        from binaryast.kernels.external.radiation import pressure

        return pressure

    def check(self, bodies: Sequence[RigidBody]) -> None:
        """Raise where it cannot act on these bodies."""
        body = bodies[index_of(self.body, bodies, "RadiationPressure: body")]
        if self.normal is not None and body.is_point:
            raise InputError(
                f"RadiationPressure: {self.body} is a point, on which there is no plate: give coefficient="
            )

    def parameters(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return what ``kernels/external/radiation.py`` reads."""
        index = index_of(self.body, bodies, "body")
        ball = -1.0 if self.coefficient is None else self.coefficient
        normal = np.zeros(3) if self.normal is None else np.asarray(self.normal)
        point = np.zeros(3) if self.point is None else self.point.value
        head = [index, SUNLIGHT, float(self.area.value), ball, self.specular, self.diffuse]
        return np.concatenate([head, normal, point, self.sun.path(bodies, span)])

    def check_start(self, bodies: Sequence[RigidBody], position: Floats, span: Span) -> None:
        """Raise where the Sun would be among the bodies."""
        self.sun.check_start(bodies, position, span)


@dataclass(frozen=True, eq=False, repr=False)
class Yorp(Perturbation):
    """A steady torque along the spin of a body: what YORP does in the mean.

    Parameters
    ----------
    body : str
        Its name.
    torque : Quantity, optional
        Along its spin; negative slows it down.
    acceleration : Quantity, optional
        In its place, how fast the spin of a body changes that turns about its shortest axis (angle/time^2).

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> yorp = ba.Yorp("Didymos", acceleration=2e-8 * u.rad / u.day**2)
    """

    body: str
    torque: Quantity | None = None
    acceleration: Quantity | None = None

    conservative: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if (self.torque is None) == (self.acceleration is None):
            raise InputError("Yorp: give exactly one of torque= and acceleration=")
        if self.torque is not None:
            self._set(torque=quantity(to_si(self.torque, "N m", "Yorp: torque"), "N m"))
        if self.acceleration is not None:
            rate = to_si(self.acceleration, "rad / s2", "Yorp: acceleration")
            self._set(acceleration=quantity(rate, "rad / s2"))

    @property
    def kernel(self) -> Callable[..., Any]:
        """The compiled force."""
        from binaryast.kernels.external.radiation import along_spin

        return along_spin

    def check(self, bodies: Sequence[RigidBody]) -> None:
        """Raise where it cannot act on these bodies."""
        if bodies[index_of(self.body, bodies, "Yorp: body")].is_point:
            raise InputError(f"Yorp: {self.body} is a point, which does not turn")

    def parameters(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return which body, and the torque [N m]."""
        index = index_of(self.body, bodies, "body")
        if self.torque is not None:
            return np.array([index, float(self.torque.value)])
        assert self.acceleration is not None
        return np.array([index, float(self.acceleration.value) * bodies[index].si.moments.max()])


@dataclass(frozen=True, eq=False, repr=False)
class Byorp(Perturbation):
    """A steady force on a body along its orbit about another: what BYORP does to a synchronous secondary in the mean.

    The orbit about a heavy primary then grows by da/dt = 2 F/(m n).

    Parameters
    ----------
    body : str
        The secondary's name.
    about : str
        The primary's.
    force : Quantity
        Along the orbit; negative shrinks it. `Byorp.from_coefficient` gives it from the coefficient B.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> byorp = ba.Byorp.from_coefficient("Dimorphos", "Didymos", 1e-3, radius=75 * u.m, semi_major_axis=1.64 * u.au)
    """

    body: str
    about: str
    force: Quantity

    conservative: ClassVar[bool] = False

    def __post_init__(self) -> None:
        self._set(force=quantity(to_si(self.force, "N", "Byorp: force"), "N"))

    @classmethod
    def from_coefficient(
        cls,
        body: str,
        about: str,
        coefficient: float,
        *,
        radius: Quantity,
        semi_major_axis: Quantity,
        eccentricity: float = 0.0,
    ) -> "Byorp":
        """Return it for the coefficient B: F = B R^2 P, with P the pressure of sunlight in the mean of the orbit.

        Parameters
        ----------
        body, about : str
            Names of secondary and primary.
        coefficient : float
            B, without unit, of the secondary's shape.
        radius : Quantity
            R of the secondary.
        semi_major_axis, eccentricity : Quantity, float
            Of the orbit about the Sun, over which the pressure is 1/(a^2 sqrt(1 - e^2)) in the mean.
        """
        size = float(to_si(radius, "m", "Byorp: radius", sign="positive"))
        a = float(to_si(semi_major_axis, "m", "Byorp: semi_major_axis", sign="positive"))
        e = float(numbers(eccentricity, "Byorp: eccentricity", ()))
        if not 0 <= e < 1:
            raise InputError(f"Byorp: eccentricity: expected 0 <= e < 1, got {e:g}")
        b = float(numbers(coefficient, "Byorp: coefficient", ()))
        return cls(body, about, b * size**2 * SUNLIGHT / (a**2 * np.sqrt(1 - e * e)) * u.N)

    @property
    def kernel(self) -> Callable[..., Any]:
        """The compiled force."""
        from binaryast.kernels.external.radiation import along_orbit

        return along_orbit

    def check(self, bodies: Sequence[RigidBody]) -> None:
        """Raise where it cannot act on these bodies."""
        if index_of(self.body, bodies, "Byorp: body") == index_of(self.about, bodies, "Byorp: about"):
            raise InputError(f"Byorp: {self.body} is named twice: expected two bodies")

    def parameters(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return which bodies, and the force [N]."""
        i, j = (index_of(name, bodies, "body") for name in (self.body, self.about))
        return np.array([i, j, float(self.force.value)])
