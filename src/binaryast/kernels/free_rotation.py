"""The free rotation of bodies over a time, compiled: the variational integrator's, and the exact one."""

from functools import partial
from math import sqrt
from typing import Any

from numba import types
from numba.extending import intrinsic

from binaryast.kernels import rotor
from binaryast.kernels.compensated import add_vector, turn_quaternion
from binaryast.kernels.implicit import solve_both, solve_cayley
from binaryast.kernels.jit import Quaternion, Vector, jit
from binaryast.kernels.so3 import cayley, cross
from binaryast.kernels.symbols import written_out, written_out_twice

MOST_PARTS = 1e5  # of a drift

QUATERNION = types.UniTuple(types.float64, 4)
Attitude = tuple[Quaternion, Quaternion, Vector, Vector]  # q and P, each followed by what rounding took from it
Body = tuple[Vector, Vector]  # 1/I_i and (I_j - I_k)/I_i


@jit()
def turn_momentum(p: Vector, f: Quaternion) -> Vector:
    """Return F^T P - P without cancellation: -2 w v x P + 2 v x (v x P), (v, w) being the turn's quaternion."""
    v = (f[0], f[1], f[2])
    c = cross(v, p)
    d = cross(v, c)
    w = f[3]
    return 2.0 * (d[0] - w * c[0]), 2.0 * (d[1] - w * c[1]), 2.0 * (d[2] - w * c[2])


@jit()
def turned(a: Attitude, f: Quaternion) -> Attitude:
    """Return R F and F^T P: (97) and the F^T of (96), and likewise (122), (127), (120), (121)."""
    q, rq, p, rp = a
    q, rq = turn_quaternion(q, rq, f)
    p, rp = add_vector(p, rp, 1.0, turn_momentum(p, f))
    return q, rq, p, rp


@jit()
def turn_variationally(a: Attitude, body: Body, h: float) -> tuple[Attitude, bool]:
    """Turn one body freely for h by the discrete equation; whether it had a solution is the last value."""
    p = a[2]
    c, iterations = solve_cayley(body[0], body[1], (h * p[0], h * p[1], h * p[2]))  # (95), (123), (124)
    return turned(a, cayley(c)), iterations >= 0


@jit()
def turn_both_variationally(
    a2: Attitude, body_2: Body, a1: Attitude, body_1: Body, h: float
) -> tuple[Attitude, Attitude, bool, bool]:
    """Turn two bodies freely for h by the discrete equation; whether it had solutions are the last values."""
    p2, p1 = a2[2], a1[2]
    g2, g1 = (h * p2[0], h * p2[1], h * p2[2]), (h * p1[0], h * p1[1], h * p1[2])
    c2, c1, solved_2, solved_1 = solve_both(body_2[0], body_2[1], g2, body_1[0], body_1[1], g1)  # (124), (123)
    return turned(a2, cayley(c2)), turned(a1, cayley(c1)), solved_2, solved_1


@intrinsic  # type: ignore[untyped-decorator]
def free_turn(_: Any, p: Any, inverse: Any, h: Any) -> Any:
    """Return the quaternion of the exact turn of one body: ``rotor.py`` written out."""
    return QUATERNION(p, inverse, h), partial(written_out, rotor.free_turn)


@intrinsic  # type: ignore[untyped-decorator]
def free_turns(_: Any, p2: Any, p1: Any, inverse_2: Any, inverse_1: Any, h: Any) -> Any:
    """Return the quaternions of the exact turns of two bodies, side by side."""
    both = types.UniTuple(QUATERNION, 2)
    return both(p2, p1, inverse_2, inverse_1, h), partial(written_out_twice, rotor.free_turn)


@jit()
def parts(p: Vector, inverse: Vector, h: float) -> float:
    """Return how often h exceeds what one call of the rotor can take, squared."""
    i1, i2, i3 = inverse
    e1, e2, e3 = i3 - i2, i1 - i3, i2 - i1
    s1, s2, s3 = p[0] * p[0], p[1] * p[1], p[2] * p[2]
    nutation = max(abs(e2 * e3) * s1, abs(e3 * e1) * s2, abs(e1 * e2) * s3)
    spin = s1 * i1 * i1 + s2 * i2 * i2 + s3 * i3 * i3
    square = h * h * max(nutation * (1.0 / rotor.LONGEST**2), spin * (1.0 / rotor.LARGEST_TURN**2))
    return square + (spin - spin)  # not a number where the spin is none


@jit()
def count_of(square: float) -> int:
    """Return into how many parts a drift is cut; 0 where it is far too long, or something is not a number."""
    if square <= 1.0:
        return 1
    return 1 + int(sqrt(square)) if square < MOST_PARTS * MOST_PARTS else 0


@jit()
def turn_exactly(a: Attitude, body: Body, h: float) -> tuple[Attitude, bool]:
    """Turn one body freely for h as Euler's equations say; the last value is false where h is beyond all reason."""
    inverse = body[0]
    count = count_of(parts(a[2], inverse, h))
    for _ in range(count):
        a = turned(a, free_turn(a[2], inverse, h / count))
    return a, count > 0


@jit()
def turn_both_exactly(
    a2: Attitude, body_2: Body, a1: Attitude, body_1: Body, h: float
) -> tuple[Attitude, Attitude, bool, bool]:
    """Turn two bodies freely for h as Euler's equations say; the last values are false where h is beyond all reason."""
    inverse_2, inverse_1 = body_2[0], body_1[0]
    square_2, square_1 = parts(a2[2], inverse_2, h), parts(a1[2], inverse_1, h)
    count = count_of(max(square_2, square_1))
    for _ in range(count):
        f2, f1 = free_turns(a2[2], a1[2], inverse_2, inverse_1, h / count)
        a2, a1 = turned(a2, f2), turned(a1, f1)
    return a2, a1, count_of(square_2) > 0, count_of(square_1) > 0
