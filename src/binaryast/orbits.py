"""Starting configurations of a pair as plain SI floats: circular orbits in the pair's own field, Keplerian elements."""

from collections.abc import Sequence
from math import cos, pi, sin, sqrt
from typing import Any, NamedTuple

import astropy.units as u
import numpy as np
from astropy.units import Quantity
from scipy.spatial.transform import Rotation

from binaryast.errors import InputError, UnitError
from binaryast.system import System
from binaryast.units import Floats, brief, numbers, to_si

PHASES = 24  # of a body that turns freely, in the mean over its turn: exact below that degree


class Motion(NamedTuple):
    """What a `binaryast.State` is made of, SI, primary first: (2, 3), (2, 3), (2, 3, 3), (2, 3)."""

    position: Floats
    velocity: Floats
    attitude: Floats
    spin: Floats


def circular_orbit(
    system: System, separation: Quantity | None, period: Quantity | None, pole: Any, spins: Sequence[Any]
) -> Motion:
    """Return a circular orbit in the pair's own field; see `binaryast.State.circular_orbit`."""
    if (separation is None) == (period is None):
        raise InputError("circular_orbit: give exactly one of separation= and period=")
    synchronous = [_is_synchronous(spin) for spin in _two(spins)]
    if separation is not None:
        r = float(to_si(separation, "m", "separation", sign="positive"))
        rate = sqrt(_square_rate(system, r, synchronous))
    else:
        rate = 2 * pi / float(to_si(period, "s", "period", sign="positive"))
        r = _separation(system, rate, synchronous)
    axes = pole_axes(pole)
    relative = r * axes[:, 0], rate * r * axes[:, 1]
    return _motion(system, *relative, axes, _spin_vectors(spins, rate))


def _square_rate(system: System, r: float, synchronous: Sequence[bool]) -> float:
    """Return n^2 = (dU/dr)/(m r), with the mean over the turn of a body that does not keep its face to the other."""
    turns = [np.zeros(1) if locked else np.arange(PHASES) * (2 * pi / PHASES) for locked in synchronous]
    total = 0.0
    for primary in turns[0]:
        n = np.array([cos(primary), -sin(primary), 0.0])  # the line of centres in the primary's frame
        for secondary in turns[1]:
            attitude = Rotation.from_euler("z", secondary - primary).as_matrix()
            total += float(np.dot(system.attraction(r * n, attitude)[1:4], n))
    square = total / (len(turns[0]) * len(turns[1])) / (system.reduced_mass * r)
    if not square > 0:
        raise InputError(
            f"circular_orbit: no circular orbit at a separation of {r:g} m: the pair does not attract there"
        )
    return square


def _separation(system: System, rate: float, synchronous: Sequence[bool]) -> float:
    """Return the separation at which the pair turns at a rate."""
    kepler = float(((system.primary.si.gm + system.secondary.si.gm) / rate**2) ** (1 / 3))

    def difference(r: float) -> float:
        return _square_rate(system, r, synchronous) / rate**2 - 1

    from scipy.optimize import brentq  # a third of a second, needed only here and for Kepler's equation

    try:
        return float(brentq(difference, 0.7 * kepler, 2 * kepler, xtol=1e-14 * kepler, rtol=1e-15))
    except ValueError:
        raise InputError(
            f"circular_orbit: no separation near {kepler:g} m has a period of {2 * pi / rate:g} s in this field"
        ) from None


def from_elements(
    system: System,
    semi_major_axis: Quantity,
    eccentricity: float,
    angles: dict[str, Quantity],
    true_anomaly: Quantity | None,
    mean_anomaly: Quantity | None,
    pole: Any,
    spins: Sequence[Any],
) -> Motion:
    """Return an osculating Keplerian orbit; see `binaryast.State.from_elements`."""
    a = float(to_si(semi_major_axis, "m", "semi_major_axis", sign="positive"))
    e = float(numbers(eccentricity, "eccentricity", ()))
    if not 0 <= e < 1:
        raise InputError(
            f"eccentricity: expected 0 <= e < 1, got {e:g}; give an unbound orbit by its vectors to ba.State"
        )
    i, node, apse = (float(to_si(value, "rad", name)) for name, value in angles.items())
    if true_anomaly is not None and mean_anomaly is not None:
        raise InputError("from_elements: give at most one of true_anomaly= and mean_anomaly=")
    anomaly = 0.0 if true_anomaly is None else float(to_si(true_anomaly, "rad", "true_anomaly"))
    if mean_anomaly is not None:
        anomaly = _true_anomaly(float(to_si(mean_anomaly, "rad", "mean_anomaly")), e)
    gm = system.primary.si.gm + system.secondary.si.gm
    plane = pole_axes(pole) @ Rotation.from_euler("ZXZ", [node, i, apse]).as_matrix()
    axes = plane @ Rotation.from_euler("z", anomaly).as_matrix()
    semi_latus = a * (1 - e * e)
    speed = sqrt(gm / semi_latus)
    position = semi_latus / (1 + e * cos(anomaly)) * axes[:, 0]
    velocity = plane @ (speed * np.array([-sin(anomaly), e + cos(anomaly), 0.0]))
    return _motion(system, position, velocity, axes, _spin_vectors(spins, sqrt(gm / a**3)))


def _true_anomaly(mean: float, e: float) -> float:
    """Return the true anomaly of a mean anomaly, by Kepler's equation."""
    from scipy.optimize import brentq

    mean = mean % (2 * pi)
    eccentric = brentq(lambda angle: angle - e * sin(angle) - mean, mean - 1, mean + 1, xtol=1e-15, rtol=1e-15)
    return float(2 * np.arctan2(sqrt(1 + e) * sin(eccentric / 2), sqrt(1 - e) * cos(eccentric / 2)))


def pole_axes(pole: Any) -> Floats:
    """Return inertial axes (columns) of an orbit plane: x on its ascending node, z along its pole.

    ``pole`` is None for the inertial z axis, a vector of three numbers, or right ascension and declination.
    """
    if pole is None:
        return np.eye(3)
    if is_celestial(pole):
        ascension, declination = to_si(pole, "rad", "pole (right ascension, declination)", shape=(2,))
        z = np.array([cos(declination) * cos(ascension), cos(declination) * sin(ascension), sin(declination)])
    else:
        z = numbers(pole, "pole", (3,))
        if not np.any(z):
            raise InputError("pole: expected a vector that is not zero")
        z = z / np.abs(z).max()
        z = z / np.linalg.norm(z)
    node = np.array([-z[1], z[0], 0.0])
    length = np.linalg.norm(node)
    x = node / length if length > 1e-12 else np.array([1.0, 0.0, 0.0])
    y = np.cross(z, x)
    y /= np.linalg.norm(y)
    return np.column_stack([np.cross(y, z), y, z])


def is_celestial(pole: Any) -> bool:
    """Whether a pole is given by right ascension and declination."""
    return isinstance(pole, Quantity) or (
        isinstance(pole, (list, tuple)) and any(isinstance(item, Quantity) for item in pole)
    )


def _two(spins: Sequence[Any]) -> Sequence[Any]:
    """Return the spins of the two bodies, or say what is expected."""
    if not isinstance(spins, (list, tuple)) or len(spins) != 2:
        raise InputError(f"spins: expected a list of one for each body, primary first, got {brief(spins)}")
    return spins


def _is_synchronous(spin: Any) -> bool:
    return isinstance(spin, str) and spin == "synchronous"


def _spin_vectors(spins: Sequence[Any], rate: float) -> Floats:
    """Return the spins (2, 3) in the body frames [rad/s]; ``rate`` is that of the orbit."""
    return np.array([_spin_vector(spin, f"spins[{i}]", rate) for i, spin in enumerate(_two(spins))])


def _spin_vector(spin: Any, name: str, rate: float) -> Floats:
    """Return one spin: a period or a rate about the body's z axis, a vector, or the orbit's rate."""
    if _is_synchronous(spin):
        return np.array([0.0, 0.0, rate])
    if isinstance(spin, Quantity) and spin.unit.is_equivalent(u.s):
        return np.array([0.0, 0.0, 2 * pi / float(to_si(spin, "s", name, sign="positive"))])
    if isinstance(spin, Quantity) and spin.unit.is_equivalent(u.rad / u.s):
        if spin.isscalar:
            return np.array([0.0, 0.0, float(to_si(spin, "rad / s", name))])
        return to_si(spin, "rad / s", name, shape=(3,))
    raise UnitError(
        f"{name}={brief(spin)}: expected a period such as 2.26 * u.h, a rate such as 1e-4 * u.rad / u.s, "
        'a vector of three rates in the body frame, or "synchronous"'
    )


def _motion(system: System, position: Floats, velocity: Floats, axes: Floats, spin: Floats) -> Motion:
    """Share a relative motion between the bodies about their barycentre; both attitudes are ``axes``."""
    one, two = system.secondary.si.mass, system.primary.si.mass
    shares = np.array([[-one], [two]]) / (one + two)
    return Motion(shares * position, shares * velocity, np.array([axes, axes]), spin)
