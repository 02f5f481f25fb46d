"""Where a mass is that nothing here moves: on a Kepler orbit, or on a spline through a table.

The numbers of a path begin with its kind. Of a hyperbola, or a long ellipse, follow position and velocity at a time, G
times the masses, and that time: Kepler's equation is solved. Of another ellipse, which is seen at every step of a long
run, follow a time, the period, and polynomials for equal parts of it that give the place to the last digits: it takes a
quarter of the time. Of a table follow the pieces of its spline.
"""

from math import floor

from binaryast.kernels import kepler
from binaryast.kernels.arrays import vector_at
from binaryast.kernels.jit import Array, Vector, jit
from binaryast.kernels.so3 import weighted

KEPLER, ELLIPSE, SPLINE = 0.0, 1.0, 2.0
DEGREE_OF_ELLIPSE, DEGREE_OF_SPLINE = 9, 5


@jit()
def place_at(p: Array, begin: int, t: float) -> tuple[Vector, Vector]:
    """Return position and velocity at a time."""
    if p[begin] == ELLIPSE:
        return _on_ellipse(p, begin + 1, t)
    if p[begin] == SPLINE:
        return _on_spline(p, begin + 1, t)
    s, v = vector_at(p, begin + 1), vector_at(p, begin + 4)
    ds, dv = kepler.drift(s, v, p[begin + 7], t - p[begin + 8])
    return weighted(s, 1.0, ds), weighted(v, 1.0, dv)


@jit()
def _polynomials(p: Array, at: int, degree: int, x: float) -> tuple[Vector, Vector]:
    """Return three polynomials and their derivatives, by Horner's scheme; the highest power of each comes first."""
    a, b, c = vector_at(p, at)
    da, db, dc = 0.0, 0.0, 0.0
    for k in range(1, degree + 1):
        da, db, dc = da * x + a, db * x + b, dc * x + c
        a, b, c = a * x + p[at + 3 * k], b * x + p[at + 3 * k + 1], c * x + p[at + 3 * k + 2]
    return (a, b, c), (da, db, dc)


@jit()
def _on_ellipse(p: Array, begin: int, t: float) -> tuple[Vector, Vector]:
    """Return place and velocity of the time, the period, the number of parts, and their polynomials on -1 < x < 1."""
    period, count = p[begin + 1], p[begin + 2]
    turns = (t - p[begin]) / period
    part = (turns - floor(turns)) * count
    k = min(int(part), int(count) - 1)
    at = begin + 3 + 3 * (DEGREE_OF_ELLIPSE + 1) * k
    place, slope = _polynomials(p, at, DEGREE_OF_ELLIPSE, 2.0 * (part - k) - 1.0)
    scale = 2.0 * count / period
    return place, (scale * slope[0], scale * slope[1], scale * slope[2])


@jit()
def _on_spline(p: Array, begin: int, t: float) -> tuple[Vector, Vector]:
    """Return place and velocity of the number of pieces, their ends, and their polynomials; the end pieces go on."""
    count = int(p[begin])
    low, high = 0, count  # piece k lies between the ends k and k + 1
    while high - low > 1:
        middle = (low + high) // 2
        if p[begin + 1 + middle] <= t:
            low = middle
        else:
            high = middle
    at = begin + 2 + count + 3 * (DEGREE_OF_SPLINE + 1) * low
    return _polynomials(p, at, DEGREE_OF_SPLINE, t - p[begin + 1 + low])
