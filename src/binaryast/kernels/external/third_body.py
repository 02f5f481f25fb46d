"""What a distant mass does to bodies near the origin, which it pulls along: the tide on them, and a torque on each.

Its place s(t) from the origin is known. A body of mass m at x has the potential energy
-GM m (1/|x - s| - 1/s - x.s/s^3), in which the last term is what it feels of the origin's own fall. Nothing is
subtracted there: with q = x.(x - 2 s)/s^2 and w = sqrt(1 + q) = |x - s|/s all differences are taken by hand, as Battin
does (An Introduction to the Mathematics and Methods of Astrodynamics, 1999, section 8.4) for the force
-GM m (x + f(q) s)/|x - s|^3, f = w^3 - 1. Added is MacCullagh's term for the body's moments of inertia.

The formulas are plain Python on numbers of any kind, and are written out for two bodies side by side.
"""

from functools import partial
from math import sqrt
from typing import Any

from numba import types
from numba.extending import intrinsic

from binaryast.kernels.external.action import add_to_row, matrix_at_row, row_at
from binaryast.kernels.external.paths import place_at
from binaryast.kernels.jit import EXTERNAL_POTENTIAL, Array, jit
from binaryast.kernels.lanes import Lanes, Number
from binaryast.kernels.so3 import cross as compiled_cross
from binaryast.kernels.so3 import dot as compiled_dot
from binaryast.kernels.so3 import rotate as compiled_rotate
from binaryast.kernels.so3 import rotate_back as compiled_rotate_back
from binaryast.kernels.so3 import weighted as compiled_weighted
from binaryast.kernels.symbols import written_out_twice

_compiled: Any = (compiled_cross, compiled_dot, compiled_rotate, compiled_rotate_back, compiled_weighted)
cross, dot, rotate, rotate_back, weighted = (function.py_func for function in _compiled)
Numbers = tuple[Number, Number, Number]

# Parameters: GM, whether only the tide's first term is wanted, where the path begins, and for each body its mass,
# whether it counts in the energy, and its principal moments.
GM = 0
FIRST_TERM = 1
PATH = 2
HEADER = 3
BODY = 5


Distant = tuple[Numbers, Numbers, Number]  # s, its rate, and 1/|s|
Tide = tuple[Number, Numbers, Number, Numbers, Number]  # potential, acceleration, rate; the way to the mass, 1/|way|


def whole_tide(lanes: Lanes, x: Numbers, distant: Distant) -> Tide:
    """Return the tide's potential, acceleration and rate, over GM, on a body at x; its way to the mass, and 1/|way|."""
    s, sdot, inverse = distant
    square = inverse * inverse
    xx = dot(x, x) * square
    q = dot(x, weighted(x, -2.0, s)) * square
    w = lanes.sqrt(1.0 + q)
    one, other = 1.0 / (1.0 + w), 1.0 / w
    less = q * one  # w - 1
    f = less * (w * w + w + 1.0)
    near = inverse * other
    third = near * near * near
    potential = 0.5 * inverse * (xx - less * less * (w + 2.0) * other)
    acceleration = -third * (x[0] + f * s[0]), -third * (x[1] + f * s[1]), -third * (x[2] + f * s[2])
    g = 1.5 * xx - 0.5 * less * less * (((3.0 * w + 6.0) * w + 4.0) * w + 2.0) * (other * other * other)
    rate = f * third * dot(x, sdot) - g * (square * inverse) * dot(s, sdot)
    return potential, acceleration, rate, weighted(s, -1.0, x), near


def first_term(_: Lanes, x: Numbers, distant: Distant) -> Tide:
    """Return the same of the first term alone, quadratic in x: Hill's tide. The body is as far away as the origin."""
    s, sdot, inverse = distant
    square = inverse * inverse
    third, xx, along = square * inverse, dot(x, x), dot(x, s)
    fifth = third * square
    potential = 0.5 * third * xx - 1.5 * fifth * along * along
    acceleration = weighted((-third * x[0], -third * x[1], -third * x[2]), 3.0 * fifth * along, s)
    rate = (7.5 * along * along * square - 1.5 * xx) * fifth * dot(s, sdot) - 3.0 * fifth * along * dot(x, sdot)
    return potential, acceleration, rate, s, inverse


def of_moments(d: Numbers, inverse: Number, r: Any, moments: Numbers) -> tuple[Number, Numbers, Numbers]:
    """Return potential, force and torque (in its frame), over GM, on a body with these moments from a mass at d."""
    square = inverse * inverse
    third = square * inverse
    fifth = third * square
    b = rotate_back(r, d)
    jb = moments[0] * b[0], moments[1] * b[1], moments[2] * b[2]
    trace, along = moments[0] + moments[1] + moments[2], dot(b, jb)
    jd, n = rotate(r, jb), cross(b, jb)
    scale, three = 1.5 * fifth * (trace - 5.0 * along * square), 3.0 * fifth
    force = scale * d[0] + three * jd[0], scale * d[1] + three * jd[1], scale * d[2] + three * jd[2]
    return 1.5 * fifth * along - 0.5 * third * trace, force, (three * n[0], three * n[1], three * n[2])


def exerted(tide: Any, lanes: Lanes, x: Numbers, r: Any, body: Any, distant: Any) -> Any:
    """Return potential and rate, and force and torque, over GM, on a body at x, with attitude, mass and moments."""
    mass, *moments = body
    s, sdot, inverse = distant[:3], distant[3:6], distant[6]
    potential, acceleration, rate, way, near = tide(lanes, x, (s, sdot, inverse))
    of_body, pull, turn = of_moments(way, near, r, tuple(moments))
    potential, rate = mass * potential + of_body, mass * rate + dot(pull, sdot)
    force = tuple(mass * a for a in acceleration)
    return potential, rate, force if tide is first_term else weighted(force, 1.0, pull), turn


RESULT = types.UniTuple(types.float64, 8)


@intrinsic  # type: ignore[untyped-decorator]
def whole_tides(
    _: Any, x2: Any, x1: Any, r2: Any, r1: Any, body_2: Any, body_1: Any, distant_2: Any, distant_1: Any
) -> Any:
    """Return what is exerted on two bodies, side by side."""
    both = types.UniTuple(RESULT, 2)(x2, x1, r2, r1, body_2, body_1, distant_2, distant_1)
    return both, partial(written_out_twice, partial(exerted, whole_tide))


@intrinsic  # type: ignore[untyped-decorator]
def first_terms(
    _: Any, x2: Any, x1: Any, r2: Any, r1: Any, body_2: Any, body_1: Any, distant_2: Any, distant_1: Any
) -> Any:
    """Return the same of the tide's first term alone."""
    both = types.UniTuple(RESULT, 2)(x2, x1, r2, r1, body_2, body_1, distant_2, distant_1)
    return both, partial(written_out_twice, partial(exerted, first_term))


@jit()
def numbers_of(p: Array, i: int) -> tuple[float, float, float, float]:
    """Return mass and moments of a body."""
    at = HEADER + BODY * i
    return p[at], p[at + 2], p[at + 3], p[at + 4]


@jit()
def add(result: Any, gm: float, counts: float, i: int, F: Array, N: Array) -> tuple[float, float]:
    """Add what is exerted on a body; return the potential and its rate, as far as they count."""
    energy, change, f0, f1, f2, n0, n1, n2 = result
    add_to_row(F, i, gm, (f0, f1, f2))
    add_to_row(N, i, gm, (n0, n1, n2))
    return counts * energy, counts * change


@jit(EXTERNAL_POTENTIAL)
def potential(p: Array, t: float, x: Array, R: Array, F: Array, N: Array) -> tuple[float, float]:
    """Add what a distant mass exerts on each body; return U and dU/dt."""
    s, sdot = place_at(p, int(p[PATH]), t)
    distant = *s, *sdot, 1.0 / sqrt(compiled_dot(s, s))
    gm, u, rate = p[GM], 0.0, 0.0
    n = x.shape[0]
    for i in range(0, n, 2):
        j = min(i + 1, n - 1)
        xi, xj, ri, rj = row_at(x, i), row_at(x, j), matrix_at_row(R, i), matrix_at_row(R, j)
        body_i, body_j = numbers_of(p, i), numbers_of(p, j)
        if p[FIRST_TERM] != 0.0:
            both = first_terms(xi, xj, ri, rj, body_i, body_j, distant, distant)
        else:
            both = whole_tides(xi, xj, ri, rj, body_i, body_j, distant, distant)
        energy, change = add(both[0], gm, gm * p[HEADER + BODY * i + 1], i, F, N)
        u, rate = u + energy, rate + change
        if j > i:
            energy, change = add(both[1], gm, gm * p[HEADER + BODY * j + 1], j, F, N)
            u, rate = u + energy, rate + change
    return u, rate
