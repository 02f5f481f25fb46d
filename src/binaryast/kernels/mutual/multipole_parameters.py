"""What the multipole potential needs to know of two bodies, and the terms that it leaves out.

The parameters are G m1 m2, then for each degree l from 2 and order m from 0 to l the specific harmonic moments c of
body 1 (the secondary) and of body 2, then s of both; those of body 1 are times (-1)^l.
"""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from binaryast.kernels.harmonics import harmonic_moments, place
from binaryast.kernels.lanes import Number
from binaryast.kernels.moments import Floats
from binaryast.kernels.mutual.multipole import Aligned, Moments, Numbers, aligned, coupled

C_1, C_2, S_1, S_2 = range(4)


def place_of(l: int, m: int) -> int:
    """Return where the four numbers of a degree and order begin."""
    return 1 + 4 * (place(l, m) - place(2, 0))


def parameters_of(monopole: float, secondary: Floats, primary: Floats, degree: int) -> Floats:
    """Return the parameters from G m1 m2 and the monomial moments of both bodies."""
    (c1, s1), (c2, s2) = (harmonic_moments(moments, degree) for moments in (secondary, primary))
    signs = np.repeat([(-1.0) ** l for l in range(degree + 1)], np.arange(1, degree + 2))
    table = np.stack([signs * c1, c2, signs * s1, s2], axis=1)
    return np.concatenate([[monopole], table[place(2, 0) :].ravel()])


def are_even(parameters: Floats, degree: int) -> bool:
    """Whether all moments vanish but those of c of even degree and order, as they do for ellipsoids."""
    return not np.any(parameters[_others(degree)])


@lru_cache
def _others(degree: int) -> NDArray[np.int64]:
    """Return where the parameters are that vanish for even moments."""
    c = [place_of(l, m) for l in range(2, degree + 1) for m in range(l + 1) if l % 2 or m % 2]
    s = [place_of(l, m) + S_1 for l in range(2, degree + 1) for m in range(l + 1)]
    return np.array([place + body for place in c + s for body in (C_1, C_2)], dtype=np.int64)


class ArrayLanes:
    """Pairs of arrays, one number for each configuration: see `Lanes`."""

    def sqrt(self, a: Number) -> Number:
        """Return the square root."""
        return np.sqrt(a)

    def pair(self, one: Number, two: Number) -> Number:
        """Return two arrays side by side."""
        return np.stack(np.broadcast_arrays(one, two))

    def first(self, pair: Number) -> Number:
        """Return the first of a pair; a constant stands for both."""
        return pair[0] if isinstance(pair, np.ndarray) else pair

    def second(self, pair: Number) -> Number:
        """Return the second of a pair; a constant stands for both."""
        return pair[1] if isinstance(pair, np.ndarray) else pair

    def swapped(self, pair: Number) -> Number:
        """Return a pair the other way round."""
        return pair[::-1] if isinstance(pair, np.ndarray) else pair

    def where_larger(self, a: Number, b: Number, one: Number, two: Number) -> Number:
        """Return ``one`` where a > b, ``two`` elsewhere."""
        return np.where(a > b, one, two)


def term_sizes(parameters: Floats, degree: int, x: Floats, r: Floats) -> Floats:
    """Return the size of the terms of U of this degree and the one below, over G m1 m2/r, at X (N, 3) and R (N, 3, 3).

    The degrees are two, because every other one vanishes for ellipsoids.
    """
    lanes = ArrayLanes()
    table = parameters[1:].reshape(-1, 4, 1)
    c: list[Numbers] = [[1.0], [0.0, 0.0]]
    s: list[Numbers] = [[0.0], [0.0, 0.0]]
    for l in range(2, degree + 1):
        rows = [table[place(l, m) - place(2, 0)] for m in range(l + 1)]
        c.append([row[C_1 : C_2 + 1] for row in rows])
        s.append([row[S_1 : S_2 + 1] for row in rows])
    frame: Aligned = aligned(lanes, Moments(c, s), degree, list(x.T), list(r.reshape(-1, 9).T))
    both = lanes.first(coupled(lanes, frame.moments, degree, lowest=degree - 1).u)
    last = lanes.first(coupled(lanes, frame.moments, degree, lowest=degree).u)
    return np.asarray(np.abs(both - last) + np.abs(last))
