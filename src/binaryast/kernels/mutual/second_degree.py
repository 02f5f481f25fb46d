"""MacCullagh's second-degree field of both bodies: the monopole and each body's quadrupole on the other's mass.

U = -G m1 m2/r - G m2 (tr J1 - 3 n.J_R n)/(2 r^3) - G m1 (tr J2 - 3 n.J2 n)/(2 r^3), n = X/r, J_R = R J1 R^T.
"""

from math import sqrt

from binaryast.kernels.jit import PAIR_POTENTIAL, Array, PairGravity, jit
from binaryast.kernels.so3 import cross, rotate, rotate_back


@jit(PAIR_POTENTIAL)
def potential(
    p: Array, x: float, y: float, z: float,
    r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
) -> PairGravity:  # fmt: skip
    """Return U, dU/dX and M; p is G m1 m2, then G m2 J1 (3 principal moments), then G m1 J2 (3)."""
    monopole, a1, b1, c1, a2, b2, c2 = p[0], p[1], p[2], p[3], p[4], p[5], p[6]
    inverse_square = 1.0 / (x * x + y * y + z * z)
    inverse = sqrt(inverse_square)
    inverse_cube = inverse * inverse_square
    inverse_fifth = inverse_cube * inverse_square
    # J_R X of the secondary and J2 X of the primary, each times G and the other's mass
    attitude = (r11, r12, r13, r21, r22, r23, r31, r32, r33)
    u, v, w = rotate_back(attitude, (x, y, z))
    jx, jy, jz = rotate(attitude, (a1 * u, b1 * v, c1 * w))
    mx, my, mz = cross((x, y, z), (jx, jy, jz))
    jx, jy, jz = jx + a2 * x, jy + b2 * y, jz + c2 * z
    trace = a1 + b1 + c1 + a2 + b2 + c2
    xjx = x * jx + y * jy + z * jz
    energy = -monopole * inverse - 0.5 * trace * inverse_cube + 1.5 * xjx * inverse_fifth
    radial = monopole * inverse_cube + 1.5 * trace * inverse_fifth - 7.5 * xjx * inverse_fifth * inverse_square
    q = 3.0 * inverse_fifth
    gradient = (radial * x + q * jx, radial * y + q * jy, radial * z + q * jz)
    return energy, *gradient, -q * mx, -q * my, -q * mz  # the torque on the secondary is -M = 3 G m2 X x J_R X/r^5
