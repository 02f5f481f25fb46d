"""What the equations for heyoka are written with: sums, powers, and what a pair exerts, as expressions.

A Taylor integrator pays for products of variables, hardly for sums and constant factors.
"""

from collections.abc import Callable
from fractions import Fraction
from math import factorial
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

Number = Any  # a heyoka expression, or a constant
Constant = Callable[[Any], Any]  # a rational or real number as a constant of the integrator's precision


class Exerted(NamedTuple):
    """The force on the secondary, in parts, and the torques on primary and secondary in their own axes.

    The force is ``radial`` times the relative position, and what is in the axes of the primary, and of the secondary.
    """

    radial: Number
    force2: np.ndarray
    force1: np.ndarray
    torque2: np.ndarray
    torque1: np.ndarray


class Place(NamedTuple):
    """Where the secondary is.

    ``x`` and ``y`` (3) are its place in its primary's axes and in its own, ``x2`` and ``y2`` their squares as far as
    they are needed, ``R`` (3, 3) the relative attitude and ``r`` the powers of the inverse distance.
    """

    x: np.ndarray
    y: np.ndarray
    x2: list[Number]
    y2: list[Number]
    R: np.ndarray
    r: "InversePowers"


def mean_factor(k: int) -> Fraction:
    """Return c_k: the mean of a harmonic f over an ellipsoid is sum c_k D^k f, D = sum a_i^2 (e_i . d)^2."""
    return Fraction(3, factorial(2 * k + 1) * (2 * k + 3))


def total(terms: list[Number]) -> Number:
    """Return the sum of expressions, as one sum."""
    return hy.sum(terms) if terms else hy.expression(0.0)


class Powers:
    """Powers of an expression, each made once, from those of half its exponent."""

    def __init__(self, base: Number) -> None:
        self.known = {1: base}

    def __getitem__(self, exponent: int) -> Number:
        if exponent == 0:
            return 1.0
        if exponent not in self.known:
            half = exponent // 2
            self.known[exponent] = self[half] * self[exponent - half]
        return self.known[exponent]


class InversePowers:
    """Powers of 1/r, each made once: odd ones from 1/r^3 and r^2."""

    def __init__(self, square: Number) -> None:
        self.known = {0: 1.0, 2: square**-1.0, 3: square**-1.5}

    def __getitem__(self, exponent: int) -> Number:
        if exponent not in self.known:
            if exponent == 1:
                self.known[1] = self.known[2] ** 0.5
            elif exponent % 2:
                self.known[exponent] = self[exponent - 2] * self.known[2]
            else:
                half = exponent // 4 * 2
                self.known[exponent] = self[half] * self[exponent - half]
        return self.known[exponent]


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the cross product."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
