"""Librations in closed form: a sphere and an ellipsoid on a circular orbit, coupled; a light body's pendulum."""

from typing import NamedTuple

import numpy as np
from scipy.special import ellipj, ellipk


class CoupledLibration(NamedTuple):
    """Small planar oscillations of a sphere and an ellipsoid that shows it its long axis, gravity of second degree.

    With U(r, phi) = -G m1 m2/r - G m2 [A + B + C - 3 (A cos^2 phi + B sin^2 phi)]/(2 r^3), phi from the line of
    centres, m the reduced mass and the angular momentum kept, the equations about r, phi = 0, theta' = n are

        xi'' = (n^2 - U_rr/m) xi + 2 n r eta,   eta' = U_pp phi/(m r^2) - 2 n xi'/r,   phi'' = -U_pp phi/C - eta',

    xi that of r and eta of theta'. With zeta = xi' this is zeta'' = -a zeta + b phi, phi'' = -c phi + d zeta.

    Parameters
    ----------
    sphere, ellipsoid : float
        Masses [kg].
    moments : array-like
        A, B, C of the ellipsoid [kg m2].
    separation : float
        r [m].
    G : float
        The constant of gravity.
    """

    sphere: float
    ellipsoid: float
    moments: np.ndarray
    separation: float
    G: float

    @property
    def reduced_mass(self) -> float:
        """The reduced mass [kg]."""
        return self.sphere * self.ellipsoid / (self.sphere + self.ellipsoid)

    @property
    def rate(self) -> float:
        """The rate n of the equilibrium [rad/s]: m n^2 r = dU/dr."""
        A, B, C = self.moments
        r = self.separation
        pull = self.G * self.sphere * (self.ellipsoid / r**2 + 1.5 * (B + C - 2 * A) / r**4)
        return float(np.sqrt(pull / (self.reduced_mass * r)))

    def frequencies(self) -> tuple[float, float]:
        """Return the two frequencies over n: mostly of the distance, and mostly of the face."""
        A, B, C = self.moments
        m, r, n = self.reduced_mass, self.separation, self.rate
        U_rr = self.G * self.sphere * (-2 * self.ellipsoid / r**3 - 6 * (B + C - 2 * A) / r**5)
        U_pp = 3 * self.G * self.sphere * (B - A) / r**3
        a, b = 3 * n**2 + U_rr / m, 2 * n * U_pp / (m * r)
        c, d = U_pp * (1 / C + 1 / (m * r**2)), 2 * n / r
        half, root = (a + c) / 2, np.sqrt((a - c) ** 2 / 4 + b * d)
        return float(np.sqrt(half + root)) / n, float(np.sqrt(half - root)) / n

    def uncoupled(self) -> float:
        """Return the frequency of the face over n, were the orbit not to feel it and Kepler's: sqrt(3 (B - A)/C)."""
        A, B, C = self.moments
        return float(np.sqrt(3 * (B - A) / C))


def pendulum(amplitude: float, frequency: float, time: np.ndarray) -> np.ndarray:
    """Return phi with phi'' = -(frequency^2/2) sin(2 phi), from rest at an amplitude: sin(phi) = k sn(K + w t, k)."""
    k = np.sin(amplitude)
    return np.arcsin(k * ellipj(ellipk(k**2) + frequency * time, k**2)[0])


def slowed(amplitude: float) -> float:
    """Return the frequency of that pendulum over that of small amplitudes: pi/(2 K)."""
    return float(np.pi / 2 / ellipk(np.sin(amplitude) ** 2))


def pitch(moments: np.ndarray) -> float:
    """Return the frequency over n of a light body in the plane of its circular orbit, A along the line of centres."""
    A, B, C = moments
    return float(np.sqrt(3 * (B - A) / C))


def roll_and_yaw(moments: np.ndarray) -> tuple[float, float]:
    """Return the two frequencies over n out of the plane, the larger first; C is about the orbit's pole.

    w^4 - (1 + 3 k + k l) w^2 + 4 k l = 0 with k = (C - A)/B and l = (C - B)/A (DeBra and Delp 1961).
    """
    A, B, C = moments
    k, yaw = (C - A) / B, (C - B) / A
    half = (1 + 3 * k + k * yaw) / 2
    root = np.sqrt(half**2 - 4 * k * yaw)
    return float(np.sqrt(half + root)), float(np.sqrt(half - root))
