"""The free rotation of one body over a time: the variational integrator's, and the exact one."""

from binaryast.kernels.compensated import add_vector, turn_quaternion
from binaryast.kernels.implicit import solve_cayley
from binaryast.kernels.jit import Quaternion, Vector, jit
from binaryast.kernels.rotor import free_turn, pieces
from binaryast.kernels.so3 import cayley, cross

Turned = tuple[Quaternion, Quaternion, Vector, Vector, bool]


@jit()
def turn_momentum(p: Vector, f: Quaternion) -> Vector:
    """Return F^T P - P without cancellation: -2 w v x P + 2 v x (v x P), (v, w) being the turn's quaternion."""
    v = (f[0], f[1], f[2])
    c = cross(v, p)
    d = cross(v, c)
    w = f[3]
    return 2.0 * (d[0] - w * c[0]), 2.0 * (d[1] - w * c[1]), 2.0 * (d[2] - w * c[2])


@jit()
def turn_variationally(
    q: Quaternion, rq: Quaternion, p: Vector, rp: Vector, inverse: Vector, ratios: Vector, h: float
) -> Turned:
    """Turn one body freely for h by the discrete equation; whether it had a solution is the last value."""
    c, iterations = solve_cayley(inverse, ratios, (h * p[0], h * p[1], h * p[2]))  # (95), (123), (124)
    f = cayley(c)
    q, rq = turn_quaternion(q, rq, f)  # (97), (122), (127)
    p, rp = add_vector(p, rp, 1.0, turn_momentum(p, f))  # the F^T of (96), (120), (121)
    return q, rq, p, rp, iterations >= 0


@jit()
def turn_exactly(
    q: Quaternion, rq: Quaternion, p: Vector, rp: Vector, inverse: Vector, ratios: Vector, h: float
) -> Turned:
    """Turn one body freely for h as Euler's equations say; the last value is false where h is beyond all reason."""
    count = pieces(p, inverse, h)
    for _ in range(count):
        f = free_turn(p, inverse, h / count)
        q, rq = turn_quaternion(q, rq, f)
        p, rp = add_vector(p, rp, 1.0, turn_momentum(p, f))
    return q, rq, p, rp, count > 0
