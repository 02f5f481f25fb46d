"""Two point masses, or two bodies with the field of spheres."""

from math import sqrt

from binaryast.kernels.jit import PAIR_POTENTIAL, Array, PairGravity, jit


@jit(PAIR_POTENTIAL)
def potential(
    p: Array, x: float, y: float, z: float,
    r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
) -> PairGravity:  # fmt: skip
    """Return U, dU/dX and M = 0; p[0] is G m1 m2."""
    square = x * x + y * y + z * z
    r = sqrt(square)
    w = p[0] / (square * r)
    return -p[0] / r, w * x, w * y, w * z, 0.0, 0.0, 0.0
