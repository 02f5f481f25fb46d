"""Two homogeneous ellipsoids, exactly: the mean over the focal disc of one of the field of the other one.

With the potential phi of the one per unit of G m, U = G m1 m2 sum of w phi(d) over the nodes, and dU/dX and M are the
exact derivatives of this sum. Rules and their choice are explained in ``ellipsoid_parameters.py``.
"""

from binaryast.kernels.arrays import vector_at
from binaryast.kernels.carlson import rf_and_rd
from binaryast.kernels.contact import separation_function, turned
from binaryast.kernels.jit import PAIR_POTENTIAL, Array, Matrix, PairGravity, Vector, jit
from binaryast.kernels.mutual.ellipsoid_parameters import DISC, FIELD, HEADER, NODE, NODES, RULE, RULES, SIDE
from binaryast.kernels.so3 import cross, dot, rotate, rotate_back

ENOUGH = 1e-9  # a Newton step that is smaller than this part leaves an error of its square
STEPS = 60  # at most; some five from far, three from a neighbouring node
LOOKS = 7  # at the function of Perram and Wertheim


@jit()
def confocal_coordinate(squares: Vector, x: Vector, guess: float) -> float:
    """Return the largest root of x^2/(a^2 + q) + y^2/(b^2 + q) + z^2/(c^2 + q) = 1, zero for a point inside.

    The inverse of the sum is concave in q and nearly linear: Newton's steps for it need few, and from the first on they
    come from below.
    """
    x2, y2, z2 = x[0] * x[0], x[1] * x[1], x[2] * x[2]
    q = guess
    for _ in range(STEPS):
        a, b, c = squares[0] + q, squares[1] + q, squares[2] + q
        ab, bc, ca = a * b, b * c, c * a
        inverse = 1.0 / (ab * c)
        i, j, k = bc * inverse, ca * inverse, ab * inverse
        total = x2 * i + y2 * j + z2 * k
        slope = x2 * i * i + y2 * j * j + z2 * k * k
        new = max(0.0, q + total * (total - 1.0) / slope)
        change, q = abs(new - q), new
        if change < ENOUGH * min(a, b, c):
            break
    return q


@jit()
def field(squares: Vector, x: Vector, guess: float) -> tuple[float, Vector, float]:
    """Return the potential of a homogeneous ellipsoid of unit G m, its gradient, and the confocal coordinate.

    DLMF 19.33, from a guess of that coordinate.
    """
    q = confocal_coordinate(squares, x, guess)
    rf, rx, ry, rz = rf_and_rd(squares[0] + q, squares[1] + q, squares[2] + q)
    gx, gy, gz = x[0] * rx, x[1] * ry, x[2] * rz
    return 0.5 * (x[0] * gx + x[1] * gy + x[2] * gz) - 1.5 * rf, (gx, gy, gz), q


@jit()
def rule_for(p: Array, x: Vector, r: Matrix) -> int:
    """Return where the coarsest rule is whose confocal ellipsoid, at X and R, does not reach the other's focal disc.

    That they are apart is proved by one s at which the function of Perram and Wertheim is above 1. Where no s of those
    looked at proves it, the next finer rule is as good.
    """
    a, b, c = vector_at(p, DISC)
    disc = (a, 0.0, 0.0, b, 0.0, c)
    a, b, c = vector_at(p, NODES)
    body = turned(r, (a, 0.0, 0.0, b, 0.0, c))
    last = int(p[RULES]) - 1
    for rule in range(last):
        q = p[HEADER + RULE * rule]
        confocal = (body[0] + q, body[1], body[2], body[3] + q, body[4], body[5] + q)
        for look in range(LOOKS):
            if separation_function((0.4, 0.2, 0.6, 0.1, 0.03, 0.8, 0.01)[look], x, disc, confocal) > 1.0:
                return HEADER + RULE * rule
    return HEADER + RULE * last


@jit()
def summed(p: Array, x: Vector, r: Matrix) -> tuple[float, Vector, Vector]:
    """Return U, dU/dX and M with the nodes in a body at X, R in the frame of the one whose field is taken."""
    squares = vector_at(p, FIELD)
    rule = rule_for(p, x, r)
    first, count = int(p[rule + 1]), int(p[rule + 2])
    q = max(0.0, dot(x, x) - max(*squares))  # of a node, and the guess for the next
    u = gx = gy = gz = mx = my = mz = 0.0
    for i in range(count):
        at = first + NODE * i
        ax, ay, az = rotate(r, vector_at(p, at))  # R rho
        phi, (fx, fy, fz), q = field(squares, (x[0] + ax, x[1] + ay, x[2] + az), q)
        w = p[at + 3]
        u += w * phi
        fx, fy, fz = w * fx, w * fy, w * fz
        gx, gy, gz = gx + fx, gy + fy, gz + fz
        mx += ay * fz - az * fy  # M = sum of (R rho) x dU/dx, by (54)
        my += az * fx - ax * fz
        mz += ax * fy - ay * fx
    k = p[0]
    return k * u, (k * gx, k * gy, k * gz), (k * mx, k * my, k * mz)


@jit(PAIR_POTENTIAL)
def potential(
    p: Array, x: float, y: float, z: float,
    r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
) -> PairGravity:  # fmt: skip
    """Return U, dU/dX and M; p is laid out in ``ellipsoid_parameters.py``."""
    r = (r11, r12, r13, r21, r22, r23, r31, r32, r33)
    if p[SIDE] > 0.0:
        u, g, m = summed(p, (x, y, z), r)
        return u, *g, *m
    # the other way round: the primary is at -R^T X with the attitude R^T in the frame of the secondary
    u, g, m = summed(p, rotate_back(r, (-x, -y, -z)), (r11, r21, r31, r12, r22, r32, r13, r23, r33))
    gx, gy, gz = rotate(r, (-g[0], -g[1], -g[2]))
    m2 = rotate(r, m)  # minus the torque on the primary, which is X x dU/dX + M
    arm = cross((x, y, z), (gx, gy, gz))
    return u, gx, gy, gz, -m2[0] - arm[0], -m2[1] - arm[1], -m2[2] - arm[2]
