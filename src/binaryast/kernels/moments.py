"""Monomial moments of a mass distribution up to a total degree N: how the flat array of them is ordered, and some.

The moments are the integrals of x^i y^j z^k dm over the mass. They are ordered by total degree n = i + j + k, then i
from n down to 0, then j from n - i down to 0: 1, x, y, z, x^2, xy, xz, y^2, yz, z^2, x^3, ... The index of (i, j, k) is
n (n + 1) (n + 2)/6 + (n - i) (n - i + 1)/2 + k. Specific moments are over the mass: the first is 1.
"""

from functools import lru_cache
from math import prod
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.floating[Any]]
CHUNK = 4096  # points that are summed at once: all monomials of each are in memory


def count(degree: int) -> int:
    """Return how many moments there are up to a total degree."""
    return (degree + 1) * (degree + 2) * (degree + 3) // 6


@lru_cache
def exponents(degree: int) -> NDArray[np.int64]:
    """Return the exponents (count, 3) of x, y and z of each moment."""
    rows = [(i, j, n - i - j) for n in range(degree + 1) for i in range(n, -1, -1) for j in range(n - i, -1, -1)]
    result = np.array(rows, dtype=np.int64)
    result.flags.writeable = False
    return result


def index(i: int, j: int, k: int) -> int:
    """Return where the moment of x^i y^j z^k is."""
    n = i + j + k
    return n * (n + 1) * (n + 2) // 6 + (n - i) * (n - i + 1) // 2 + k


def of_ellipsoid(axes: Floats, degree: int) -> Floats:
    """Return the specific moments of a homogeneous ellipsoid with semi-axes (3,), about its centre.

    They are 3 (2i - 1)!! (2j - 1)!! (2k - 1)!!/(2n + 3)!! a^2i b^2j c^2k for the even exponents 2i, 2j, 2k with
    n = i + j + k, and zero for others: Dirichlet's integral.
    """
    result = np.zeros(count(degree))
    for at, powers in enumerate(exponents(degree).tolist()):
        if all(power % 2 == 0 for power in powers):
            ways = 3 * prod(_odd_factorial(power - 1) for power in powers)
            result[at] = ways / _odd_factorial(sum(powers) + 3) * np.prod(axes**powers)
    return result


def _odd_factorial(n: int) -> int:
    """Return n!! = n (n - 2) .. 1 of an odd number, 1 for -1."""
    return prod(range(n, 0, -2))


def of_points(positions: Floats, fractions: Floats, degree: int) -> Floats:
    """Return the specific moments of points (k, 3) with fractions of the mass (k,)."""
    i, j, k = exponents(degree).T
    total = np.zeros(count(degree))
    for first in range(0, len(positions), CHUNK):
        some = positions[first : first + CHUNK]
        powers = np.ones((degree + 1, *some.shape))
        for n in range(degree):
            powers[n + 1] = powers[n] * some
        total += (powers[i, :, 0] * powers[j, :, 1] * powers[k, :, 2]) @ fractions[first : first + CHUNK]
    return total


def moved(moments: Floats, degree: int, origin: Floats, turn: Floats) -> Floats:
    """Return the moments in the frame with that origin (3,), whose axes are the columns of turn (3, 3).

    The new coordinates turn^T (p - origin) are linear in the old ones: their products are multiplied out one by one.
    """
    if not np.any(origin) and np.array_equal(turn, np.eye(3)):
        return moments
    constants, slopes = -origin @ turn, turn.T
    raised, factors = _neighbours(degree)
    lower = raised.shape[1]
    products = np.zeros((len(moments), len(moments)))  # of the new coordinates, over the old monomials
    products[0, 0] = 1.0
    for at, (axis, factor) in enumerate(factors.tolist(), start=1):
        products[at] = constants[axis] * products[factor]
        for along in range(3):
            products[at, raised[along]] += slopes[axis, along] * products[factor, :lower]
    return np.asarray(products @ moments)


@lru_cache
def _neighbours(degree: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return where x, y and z times each lower monomial are (3, count of lower), and how to make each but the first.

    The latter is an axis and where the monomial is of which that coordinate is a multiple.
    """
    powers, units = exponents(degree), np.eye(3, dtype=np.int64)
    lower = powers[: count(degree - 1)] if degree else powers[:0]
    raised = np.array([[index(*power) for power in (lower + unit).tolist()] for unit in units], dtype=np.int64)
    axes = np.argmax(powers[1:] > 0, axis=1)
    below = [index(*power) for power in (powers[1:] - units[axes]).tolist()]
    return raised, np.column_stack([axes, np.array(below, dtype=np.int64)])


def second_degree(moments: Floats) -> Floats:
    """Return the integrals of p p^T (3, 3) over the mass, from moments of degree 2 or more."""
    xx, xy, xz, yy, yz, zz = moments[4:10]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def specific_inertia(second: Floats) -> Floats:
    """Return the inertia matrix (3, 3) over the mass from the integrals of p p^T."""
    return np.asarray(np.trace(second) * np.eye(3) - second)


def from_inertia(inertia: Floats) -> Floats:
    """Return the integrals of p p^T (3, 3) from an inertia matrix: the way back of `specific_inertia`."""
    return np.asarray(0.5 * np.trace(inertia) * np.eye(3) - inertia)
