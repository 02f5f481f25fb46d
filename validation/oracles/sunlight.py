"""The pressure of sunlight as heyoka's expressions: photons that are absorbed, mirrored and scattered one by one.

A photon that comes in along -s gives its momentum; of those that leave, mirrored ones go along 2 (n.s) n - s, scattered
ones, by Lambert's law, have the mean direction 2/3 n. All of it for a plate whose face n is lit.
"""

from typing import Any

import heyoka as hy
import numpy as np

from validation.oracles.mutual_potentials import norm
from validation.oracles.outside import Force, Symbols
from validation.oracles.taylor import REAL, Array, Units, numbers

LUMINOSITY, LIGHT = 3.828e26, 299792458.0  # W, m/s


def real(value: float) -> Any:
    """Return a number as an expression of quadruple precision."""
    return numbers(np.array([value]).astype(REAL))[0]


def flux(area: float, units: Units, d: Array) -> Any:
    """Return the momentum of the light in a time that falls on an area [m2] across it, at d from the Sun."""
    at_one = LUMINOSITY / (4 * np.pi * LIGHT) * area  # N m2
    return real(at_one / (units.mass * units.length**3 / units.time**2)) / (d @ d)


def ball(body: int, sun: int, area: float, coefficient: float) -> Force:
    """Return the force on a ball."""

    def force(at: Symbols) -> tuple[Array, Array]:
        d = at.s[sun] - at.x[body]
        F, N = np.full((len(at.x), 3), hy.expression(0.0)), np.full((len(at.x), 3), hy.expression(0.0))
        F[body] = -real(coefficient) * flux(area, at.units, d) * d / norm(d)
        return F, N

    return force


def plate(body: int, sun: int, area: float, normal: Array, mirrored: float, scattered: float, point: Array) -> Force:
    """Return the force and the torque on a plate at a point of the body's frame [m]."""

    def force(at: Symbols) -> tuple[Array, Array]:
        R, d = at.R[body], at.s[sun] - at.x[body]
        s, n = d / norm(d), R @ numbers(normal.astype(REAL))
        cosine = s @ n
        falls = flux(area, at.units, d) * cosine
        two, third = real(2.0), real(REAL(2.0) / REAL(3.0))
        incoming = -1.0 * s
        leaving = real(mirrored) * (two * cosine * n - s) + real(scattered) * third * n
        F, N = np.full((len(at.x), 3), hy.expression(0.0)), np.full((len(at.x), 3), hy.expression(0.0))
        F[body] = falls * (incoming - leaving)
        N[body] = np.cross(numbers((point / at.units.length).astype(REAL)), R.T @ F[body])
        return F, N

    return force
