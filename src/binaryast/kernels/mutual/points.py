"""Two rigid sets of point masses: every pair of points attracts (section 5.1 of the paper, any number of points).

The sum is over d = X + R rho1 - rho2. Reassociating it lets the inner loop run in vector lanes; it changes round-off.
"""

from math import sqrt

from binaryast.kernels.jit import PAIR_POTENTIAL, Array, Matrix, PairGravity, Vector, jit
from binaryast.kernels.so3 import rotate

FREE = {"reassoc", "nsz", "contract"}


@jit(fastmath=FREE)
def exerted(p: Array, x: Vector, attitude: Matrix, first: int) -> PairGravity:
    """Return U, dU/dX and M of the secondary's points from the given one on; p as in `potential`."""
    n1, n2 = int(p[0]), int(p[1])
    x1, y1, z1, gm1 = p[2 : 2 + n1], p[2 + n1 : 2 + 2 * n1], p[2 + 2 * n1 : 2 + 3 * n1], p[2 + 3 * n1 : 2 + 4 * n1]
    start = 2 + 4 * n1
    x2, y2 = p[start : start + n2], p[start + n2 : start + 2 * n2]
    z2, m2 = p[start + 2 * n2 : start + 3 * n2], p[start + 3 * n2 : start + 4 * n2]
    energy = gx = gy = gz = mx = my = mz = 0.0
    for i in range(first, n1):
        ax, ay, az = rotate(attitude, (x1[i], y1[i], z1[i]))  # R rho1
        px, py, pz = x[0] + ax, x[1] + ay, x[2] + az
        u = fx = fy = fz = 0.0
        for j in range(n2):
            dx, dy, dz = px - x2[j], py - y2[j], pz - z2[j]
            square = dx * dx + dy * dy + dz * dz
            inverse = 1.0 / square  # one division: they and the root are what a pair costs
            k = m2[j] * sqrt(inverse)
            u += k
            k *= inverse
            fx += k * dx
            fy += k * dy
            fz += k * dz
        energy -= gm1[i] * u
        fx, fy, fz = gm1[i] * fx, gm1[i] * fy, gm1[i] * fz
        gx, gy, gz = gx + fx, gy + fy, gz + fz
        mx += ay * fz - az * fy  # M = sum of (R rho1) x d/|d|^3, by (54)
        my += az * fx - ax * fz
        mz += ax * fy - ay * fx
    return energy, gx, gy, gz, mx, my, mz


@jit(PAIR_POTENTIAL, fastmath=FREE)
def potential(
    p: Array, x: float, y: float, z: float,
    r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
) -> PairGravity:  # fmt: skip
    """Return U, dU/dX and M.

    p is n1, n2, then x, y, z and G m of the n1 points of the secondary, each contiguous, then x, y, z and m of the n2
    points of the primary.
    """
    return exerted(p, (x, y, z), (r11, r12, r13, r21, r22, r23, r31, r32, r33), 0)
