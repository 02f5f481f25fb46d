"""Starting configurations as plain SI floats: circular orbits in the pair's own field, Keplerian elements."""

from collections.abc import Mapping, Sequence
from math import cos, pi, sin, sqrt
from typing import Any, NamedTuple

import astropy.units as u
import numpy as np
from astropy.units import Quantity
from scipy.spatial.transform import Rotation

from binaryast.bodies import RigidBody
from binaryast.elements import Orbit
from binaryast.errors import InputError, UnitError
from binaryast.system import System
from binaryast.units import Floats, brief, numbers, to_si

PHASES = 24  # of a body that turns freely, in the mean over its turn: exact below that degree


class Motion(NamedTuple):
    """What a `binaryast.State` is made of, SI, primary first: (n, 3), (n, 3), (n, 3, 3), (n, 3)."""

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
    synchronous = [_is_synchronous(spin) for spin in _one_each(spins, 2, "spins", "one for each body, primary first")]
    if separation is not None:
        r = float(to_si(separation, "m", "separation", sign="positive"))
        rate = sqrt(_square_rate(system, r, synchronous))
    else:
        rate = 2 * pi / float(to_si(period, "s", "period", sign="positive"))
        r = _separation(system, rate, synchronous)
    axes = pole_axes(pole)
    relative = r * axes[:, 0], rate * r * axes[:, 1]
    return _motion(system, *relative, axes, _spin_vectors(system, spins, [rate, rate]))


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


def from_orbits(
    system: System, orbits: Sequence[Orbit], pole: Any, spins: Sequence[Any], poles: Mapping[str, Any] | None
) -> Motion:
    """Return several bodies on osculating Keplerian orbits; see `binaryast.State.from_orbits`."""
    count = len(system.bodies)
    _one_each(orbits, count - 1, "orbits", "a ba.Orbit for each body but the primary")
    for orbit in orbits:
        if not isinstance(orbit, Orbit):
            raise InputError(f"orbits: expected ba.Orbit, got {brief(orbit)}")
    if poles is not None and not isinstance(poles, Mapping):
        raise InputError(f"poles: expected a table of poles by the names of bodies, got {brief(poles)}")
    masses = np.array([body.si.mass for body in system.bodies])
    gms = np.array([body.si.gm for body in system.bodies])
    reference = pole_axes(pole)
    position, velocity = np.zeros((count, 3)), np.zeros((count, 3))
    axes, rates = np.zeros((count, 3, 3)), np.zeros(count)
    for k, orbit in enumerate(orbits, start=1):
        inner = slice(0, 1) if orbit.about == "primary" else slice(0, k)
        gm = float(gms[inner].sum() + gms[k])
        x, v, axes[k] = orbit.place(gm, reference)
        shares = masses[inner] / masses[inner].sum()
        position[k], velocity[k] = shares @ position[inner] + x, shares @ velocity[inner] + v
        rates[k] = orbit.rate(gm)
    axes[0], rates[0] = axes[1], rates[1]
    for name, direction in (poles or {}).items():
        i = system.index(name)
        axes[i] = _with_pole(axes[i], pole_axes(direction)[:, 2])
    shares = masses / masses.sum()
    spin = _spin_vectors(system, spins, list(rates))
    return Motion(position - shares @ position, velocity - shares @ velocity, axes, spin)


def _with_pole(axes: Floats, z: Floats) -> Floats:
    """Return axes with another pole, their x as near to the old one as it can be."""
    x = axes[:, 0] - (axes[:, 0] @ z) * z
    if np.linalg.norm(x) < 1e-9:  # along the pole: any other axis does
        x = axes[:, 1] - (axes[:, 1] @ z) * z
    x = x / np.linalg.norm(x)
    y = np.cross(z, x)
    return np.column_stack([x, y / np.linalg.norm(y), z])


def pole_axes(pole: Any) -> Floats:
    """Return inertial axes (columns) of an orbit plane: x on its ascending node, z along its pole.

    ``pole`` is None for the inertial z axis, a vector of three numbers, right ascension and declination, or an astropy
    ``SkyCoord``.
    """
    if pole is None:
        return np.eye(3)
    if is_celestial(pole):
        pole = [pole.icrs.ra, pole.icrs.dec] if hasattr(pole, "icrs") else pole
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
    """Whether a pole is given by right ascension and declination, or as a ``SkyCoord``."""
    return (
        isinstance(pole, Quantity)
        or hasattr(pole, "icrs")
        or (isinstance(pole, (list, tuple)) and any(isinstance(item, Quantity) for item in pole))
    )


def _one_each(values: Any, count: int, name: str, expected: str) -> Sequence[Any]:
    """Return a list with one for each body, or say what is expected."""
    if not isinstance(values, (list, tuple)) or len(values) != count:
        raise InputError(f"{name}: expected a list of {count}, {expected}, got {brief(values)}")
    return values


def _is_synchronous(spin: Any) -> bool:
    return isinstance(spin, str) and spin == "synchronous"


def _spin_vectors(system: System, spins: Sequence[Any], rates: Sequence[float]) -> Floats:
    """Return the spins (n, 3) in the body frames [rad/s]; ``rates`` are those of the orbits."""
    _one_each(spins, len(system.bodies), "spins", "one for each body, primary first")
    return np.array([_spin_of(system.bodies[i], spins[i], f"spins[{i}]", rates[i]) for i in range(len(spins))])


def _spin_of(body: RigidBody, spin: Any, name: str, rate: float) -> Floats:
    """Return the spin of a body, which a point has not."""
    if not body.is_point:
        return _spin_vector(spin, name, rate)
    if spin is None or (isinstance(spin, str) and spin == "none"):
        return np.zeros(3)
    raise InputError(f'{name}={brief(spin)}: {body.name} is a point, which does not turn: expected None or "none"')


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
