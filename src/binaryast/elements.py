"""Keplerian elements of one orbit: what a user gives, and the place and velocity that they mean."""

from dataclasses import dataclass
from math import cos, pi, sin, sqrt

import astropy.units as u
import numpy as np
from astropy.units import Quantity
from scipy.spatial.transform import Rotation

from binaryast.errors import InputError
from binaryast.units import Floats, brief, numbers, quantity, to_si
from binaryast.values import Value

CENTRES = ("primary", "inner")
ZERO = Quantity(0.0, u.deg)
ZERO.flags.writeable = False


@dataclass(frozen=True, eq=False)
class Orbit(Value):
    """Osculating Keplerian elements of one orbit, for `binaryast.State.from_orbits` and `binaryast.Sun`.

    Parameters
    ----------
    semi_major_axis : Quantity
        Of the orbit about its centre (length).
    eccentricity : float
        At least 0 and below 1.
    inclination, longitude_of_ascending_node, argument_of_periapsis : Quantity
        Orientation of the orbit (angles).
    true_anomaly, mean_anomaly : Quantity
        Place on the orbit (angle), at most one of the two; the periapsis by default.
    about : {"primary", "inner"}
        What the orbit's centre is: the primary, or the barycentre of all bodies before this one (Jacobi's elements).
        G times the masses of the centre and of the body is what attracts.

    Raises
    ------
    InputError
        For an eccentricity outside of 0 <= e < 1, both anomalies, or another centre.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> orbit = ba.Orbit(semi_major_axis=3.8 * u.km, eccentricity=0.016, inclination=165 * u.deg)
    """

    semi_major_axis: Quantity
    eccentricity: float = 0.0
    inclination: Quantity = ZERO
    longitude_of_ascending_node: Quantity = ZERO
    argument_of_periapsis: Quantity = ZERO
    true_anomaly: Quantity | None = None
    mean_anomaly: Quantity | None = None
    about: str = "primary"

    def __post_init__(self) -> None:
        a = to_si(self.semi_major_axis, "m", "semi_major_axis", sign="positive")
        e = float(numbers(self.eccentricity, "eccentricity", ()))
        if not 0 <= e < 1:
            raise InputError(
                f"eccentricity: expected 0 <= e < 1, got {e:g}; give an unbound orbit by its vectors to ba.State"
            )
        self._set(semi_major_axis=quantity(a, "m"), eccentricity=e)
        for name in ("inclination", "longitude_of_ascending_node", "argument_of_periapsis"):
            self._set(**{name: quantity(to_si(getattr(self, name), "rad", name), "rad")})
        if self.true_anomaly is not None and self.mean_anomaly is not None:
            raise InputError("give at most one of true_anomaly= and mean_anomaly=")
        for name in ("true_anomaly", "mean_anomaly"):
            if getattr(self, name) is not None:
                self._set(**{name: quantity(to_si(getattr(self, name), "rad", name), "rad")})
        if not isinstance(self.about, str) or self.about not in CENTRES:
            raise InputError(f"about={brief(repr(self.about))}: expected one of {', '.join(CENTRES)}")

    def rate(self, gm: float) -> float:
        """Return the mean motion [rad/s] about a centre, ``gm`` being G times both masses."""
        return sqrt(gm / float(self.semi_major_axis.to_value(u.m)) ** 3)

    def place(self, gm: float, reference: Floats) -> tuple[Floats, Floats, Floats]:
        """Return position (3,) and velocity (3,) about the centre, and axes (3, 3) along position, motion and pole.

        ``reference`` (3, 3) has in its columns the axes from which the angles are counted.
        """
        a, e = float(self.semi_major_axis.to_value(u.m)), float(self.eccentricity)
        i, node, apse = (
            float(angle.to_value(u.rad))
            for angle in (self.inclination, self.longitude_of_ascending_node, self.argument_of_periapsis)
        )
        anomaly = 0.0 if self.true_anomaly is None else float(self.true_anomaly.to_value(u.rad))
        if self.mean_anomaly is not None:
            anomaly = true_anomaly(float(self.mean_anomaly.to_value(u.rad)), e)
        plane = reference @ Rotation.from_euler("ZXZ", [node, i, apse]).as_matrix()
        axes = plane @ Rotation.from_euler("z", anomaly).as_matrix()
        semi_latus = a * (1 - e * e)
        position = semi_latus / (1 + e * cos(anomaly)) * axes[:, 0]
        velocity = plane @ (sqrt(gm / semi_latus) * np.array([-sin(anomaly), e + cos(anomaly), 0.0]))
        return position, velocity, axes


def true_anomaly(mean: float, e: float) -> float:
    """Return the true anomaly of a mean anomaly, by Kepler's equation."""
    from scipy.optimize import brentq

    mean = mean % (2 * pi)
    eccentric = brentq(lambda angle: angle - e * sin(angle) - mean, mean - 1, mean + 1, xtol=1e-15, rtol=1e-15)
    return float(2 * np.arctan2(sqrt(1 + e) * sin(eccentric / 2), sqrt(1 - e) * cos(eccentric / 2)))
