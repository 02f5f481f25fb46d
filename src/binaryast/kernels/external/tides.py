"""The torque of tides that lag behind, and the force that goes with it: the angular momentum of both together is kept.

A body of radius R and Love number k2 is raised by a mass m at r from it. With a constant lag angle (quality factor
1/Q = sin 2 epsilon) the torque has the size 3/2 k2/Q G m^2 R^5/r^6 and opposes the turning of the body beside the line
of centres (C. D. Murray, S. F. Dermott, Solar System Dynamics, 1999, section 4.9). With a constant time lag it grows
with that turning (F. Mignard, Moon and Planets 20, 1979, 301).
"""

from math import sqrt

from binaryast.kernels.external.action import add_to_row, matrix_at_row, row_at
from binaryast.kernels.jit import FORCE, Array, Vector, jit
from binaryast.kernels.so3 import cross, dot, rotate, rotate_back, weighted

# Parameters: which body is raised, by which, 3/2 k2/Q G m^2 R^5 or 3 k2 G m^2 R^5 times the time lag, whether the lag
# is one of time, and the turning [rad/s] below which a lag angle falls to zero.
RAISED, RAISED_BY, STRENGTH, IN_TIME, SLOW = 0, 1, 2, 3, 4


@jit()
def by_angle(r: Vector, v: Vector, spin: Vector, strength: float, slow: float) -> Vector:
    """Return the force on the one that raises the tide, of a constant lag angle."""
    square = dot(r, r)
    orbital = cross(r, v)
    across = weighted(spin, -dot(spin, r) / square, r)  # spin about the line of centres lags behind nothing
    turning = weighted(across, -1.0 / square, orbital)
    size = sqrt(dot(turning, turning) + slow * slow)
    if size == 0.0:
        return 0.0, 0.0, 0.0
    scale = strength / (square * square * square * square * size)
    pull = cross(turning, r)
    return scale * pull[0], scale * pull[1], scale * pull[2]


@jit()
def by_time(r: Vector, v: Vector, spin: Vector, strength: float) -> Vector:
    """Return the force on the one that raises the tide, of a constant time lag: Mignard's (5)."""
    square = dot(r, r)
    lagging = weighted(cross(r, spin), 1.0, v)
    scale = -strength / (square * square * square * square)
    along = 2.0 * dot(r, v) / square
    return (
        scale * (along * r[0] + lagging[0]),
        scale * (along * r[1] + lagging[1]),
        scale * (along * r[2] + lagging[2]),
    )


@jit(FORCE)
def force(p: Array, t: float, x: Array, v: Array, R: Array, Omega: Array, F: Array, N: Array) -> None:
    """Add the force on both bodies, and the torque on the one that is raised."""
    i, j, strength = int(p[RAISED]), int(p[RAISED_BY]), p[STRENGTH]
    r = weighted(row_at(x, j), -1.0, row_at(x, i))
    moves = weighted(row_at(v, j), -1.0, row_at(v, i))
    attitude = matrix_at_row(R, i)
    spin = rotate(attitude, row_at(Omega, i))
    pull = by_time(r, moves, spin, strength) if p[IN_TIME] != 0.0 else by_angle(r, moves, spin, strength, p[SLOW])
    add_to_row(F, j, 1.0, pull)
    add_to_row(F, i, -1.0, pull)
    add_to_row(N, i, -1.0, rotate_back(attitude, cross(r, pull)))
