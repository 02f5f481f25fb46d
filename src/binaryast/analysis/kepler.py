"""The Kepler orbit of a position and a velocity, by its vectors, and the angles that these make."""

from typing import Any, NamedTuple

import numpy as np

from binaryast.errors import InputError
from binaryast.units import Floats

ROUND_OFF = 1e-11  # of an eccentricity or of the sine of an inclination, whose direction is then meaningless


class Angles(NamedTuple):
    """Angles of orbits (N,) [rad], and where node or periapsis are a matter of choice."""

    inclination: Floats
    node: Floats
    periapsis: Floats
    true_anomaly: Floats
    mean_anomaly: Floats
    mean_longitude: Floats
    circular: Any
    planar: Any


class Orbits(NamedTuple):
    """Kepler orbits by what has no special cases.

    Attributes
    ----------
    axis : ndarray
        Semi-major axis (N,) [m], negative of unbound ones.
    eccentricity : ndarray
        The vector towards the periapsis (N, 3).
    momentum : ndarray
        Angular momentum over reduced mass (N, 3) [m2/s].
    place : ndarray
        Position (N, 3) [m]; empty of means, which have a mean longitude instead.
    """

    axis: Floats
    eccentricity: Floats
    momentum: Floats
    place: Floats

    @property
    def size(self) -> Floats:
        """Eccentricity (N,), of the vector's part in the orbit plane."""
        x, y = self._eccentricity_in(*self._plane(np.eye(3))[:2])
        return np.asarray(np.hypot(x, y))

    def angles(self, axes: Floats, longitude: Floats | None) -> Angles:
        """Return the angles against reference axes (3, 3), in whose columns x and y span the plane they start from."""
        to_node, across, pole, planar = self._plane(axes)
        x, y = self._eccentricity_in(to_node, across)
        eccentricity = np.hypot(x, y)
        circular = eccentricity < ROUND_OFF
        periapsis = np.where(circular, 0.0, np.arctan2(y, x))
        node = np.arctan2(to_node @ axes[:, 1], to_node @ axes[:, 0])
        tilt = np.arctan2(np.hypot(pole @ axes[:, 0], pole @ axes[:, 1]), pole @ axes[:, 2])
        if longitude is None:
            latitude = np.arctan2(_dot(self.place, across), _dot(self.place, to_node))
            true: Floats = np.remainder(latitude - periapsis + np.pi, 2 * np.pi) - np.pi
            mean: Floats = mean_anomaly(true, eccentricity)
            longitude = np.asarray(node + periapsis + mean)
        else:
            mean = np.remainder(longitude - node - periapsis + np.pi, 2 * np.pi) - np.pi
            true = np.asarray(true_anomaly(mean, eccentricity))
        return Angles(tilt, node, periapsis, true, mean, longitude, circular, planar)

    def _plane(self, axes: Floats) -> tuple[Floats, Floats, Floats, Any]:
        """Return unit vectors (N, 3) to the node, across it and of the pole, and where the node is put on x."""
        pole = self.momentum / np.linalg.norm(self.momentum, axis=1, keepdims=True)
        node = np.cross(axes[:, 2], pole)
        planar = np.linalg.norm(node, axis=1) < ROUND_OFF
        node = np.where(planar[:, None], axes[:, 0], node)
        node = node - _dot(node, pole)[:, None] * pole
        node = node / np.linalg.norm(node, axis=1, keepdims=True)
        return node, np.cross(pole, node), pole, planar

    def _eccentricity_in(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        return _dot(self.eccentricity, x), _dot(self.eccentricity, y)


def orbits_of(x: Floats, v: Floats, gm: float) -> Orbits:
    """Return the Kepler orbits of positions (N, 3) [m] and velocities (N, 3) [m/s] about a centre of G m."""
    r = np.linalg.norm(x, axis=1)
    momentum = np.cross(x, v)
    if not np.all(np.linalg.norm(momentum, axis=1) > 1e-12 * r * np.linalg.norm(v, axis=1)):
        raise InputError("the pair moves on a line: there is no orbit plane")
    inverse = 2 / r - _dot(v, v) / gm
    inverse = np.where(np.abs(inverse) * r < ROUND_OFF, ROUND_OFF / r, inverse)  # a parabola: a very long ellipse
    return Orbits(1 / inverse, np.cross(v, momentum) / gm - x / r[:, None], momentum, x)


def mean_anomaly(true: Floats, e: Floats) -> Floats:
    """Return M = E - e sin E, of an unbound orbit e sinh H - H [rad]."""
    half = np.sqrt(np.abs(1 - e) / (1 + e)) * np.tan(true / 2)
    eccentric = 2 * np.arctan(half)
    hyperbolic = 2 * np.arctanh(np.clip(half, -1 + 1e-15, 1 - 1e-15))
    return np.asarray(np.where(e < 1, eccentric - e * np.sin(eccentric), e * np.sinh(hyperbolic) - hyperbolic))


def true_anomaly(mean: Floats, e: Floats) -> Floats:
    """Return the true anomaly of mean anomalies of bound orbits, by Newton's method on Kepler's equation."""
    eccentric = mean + 0.85 * e * np.sign(np.sin(mean))
    for _ in range(20):
        eccentric = eccentric - (eccentric - e * np.sin(eccentric) - mean) / (1 - e * np.cos(eccentric))
    return np.asarray(2 * np.arctan2(np.sqrt(1 + e) * np.sin(eccentric / 2), np.sqrt(1 - e) * np.cos(eccentric / 2)))


def unwrapped(time: Floats, angle: Floats, rate: Floats) -> Floats:
    """Return an angle (N,) that runs on, without jumps, though it may go round several times between two rows.

    It is told by the rate of each moment [rad/s], which need not be right to more than half a turn from row to row.
    """
    expected = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time))])
    return np.asarray(np.unwrap(angle - expected) + expected)


def _dot(x: Floats, y: Floats) -> Floats:
    return np.asarray(np.sum(x * y, axis=-1))
