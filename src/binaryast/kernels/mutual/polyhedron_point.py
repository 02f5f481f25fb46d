"""A body of polyhedra and a point mass, or a sphere outside it: exact at every distance."""

from math import nan

from binaryast.kernels.jit import PAIR_POTENTIAL, Array, PairGravity, jit
from binaryast.kernels.polyhedron_field import INSIDE, WEIGHT, field_at
from binaryast.kernels.so3 import cross, rotate, rotate_back

POINT_IS_PRIMARY = 0  # 1 where it is
MASS = 1  # of the point
TABLE = 2  # where that of the polyhedra begins


@jit(PAIR_POTENTIAL)
def potential(
    p: Array, x: float, y: float, z: float,
    r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
) -> PairGravity:  # fmt: skip
    """Return U, dU/dX and M; U is not a number where the point is inside the surface.

    A point feels no torque, so M = 0 where it is the secondary. Where it is the primary, at the origin, the polyhedra
    see it at -R^T X, and as torques add up to zero, M = -X x dU/dX.
    """
    attitude, mass = (r11, r12, r13, r21, r22, r23, r31, r32, r33), p[MASS]
    point_is_primary = p[POINT_IS_PRIMARY] != 0.0
    at = rotate_back(attitude, (-x, -y, -z)) if point_is_primary else (x, y, z)
    u, gx, gy, gz, _, _, _, _, _, _, laplacian = field_at(p, TABLE, at)
    energy = nan if laplacian > INSIDE * p[TABLE + WEIGHT] else mass * u
    if not point_is_primary:
        return energy, mass * gx, mass * gy, mass * gz, 0.0, 0.0, 0.0
    gradient = rotate(attitude, (-mass * gx, -mass * gy, -mass * gz))
    mx, my, mz = cross(gradient, (x, y, z))
    return energy, *gradient, mx, my, mz
