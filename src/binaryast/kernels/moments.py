"""Monomial moments of a mass distribution up to a total degree N: how the flat array of them is ordered.

The moments are the integrals of x^i y^j z^k dm over the mass. They are ordered by total degree n = i + j + k, then i
from n down to 0, then j from n - i down to 0: 1, x, y, z, x^2, xy, xz, y^2, yz, z^2, x^3, ... The index of (i, j, k) is
n (n + 1) (n + 2)/6 + (n - i) (n - i + 1)/2 + k.
"""

import numpy as np
from numpy.typing import NDArray


def count(degree: int) -> int:
    """Return how many moments there are up to a total degree."""
    return (degree + 1) * (degree + 2) * (degree + 3) // 6


def exponents(degree: int) -> NDArray[np.int64]:
    """Return the exponents (count, 3) of x, y and z of each moment."""
    rows = [(i, j, n - i - j) for n in range(degree + 1) for i in range(n, -1, -1) for j in range(n - i, -1, -1)]
    return np.array(rows, dtype=np.int64)
