"""Sums that carry what rounding takes from them: they keep digits that plain sums lose in a long run."""

from binaryast.kernels.jit import Quaternion, Vector, jit

MENDED = 1.0 / 32.0  # of the length that a quaternion lacks, in one step; all of it would be 1/2


@jit()
def add(total: float, remainder: float, increment: float) -> tuple[float, float]:
    """Return total + increment, and what rounding took from that sum (Kahan).

    The remainder is exact where the total is the larger, and else as small as the increment's own rounding.
    """
    term = increment + remainder
    result = total + term
    return result, (total - result) + term


@jit()
def add_vector(v: Vector, remainder: Vector, scale: float, increment: Vector) -> tuple[Vector, Vector]:
    """Return v + scale increment and its remainder."""
    x, rx = add(v[0], remainder[0], scale * increment[0])
    y, ry = add(v[1], remainder[1], scale * increment[1])
    z, rz = add(v[2], remainder[2], scale * increment[2])
    return (x, y, z), (rx, ry, rz)


@jit()
def turn_quaternion(q: Quaternion, remainder: Quaternion, f: Quaternion) -> tuple[Quaternion, Quaternion]:
    """Return q f, the attitude R F, of unit length, and its remainder.

    Added is q (f - 1), which loses nothing for small turns. Of what the length of q with its remainder lacks, a part is
    made up for at each step: all of it would put the rounding of 1 - |q|^2 into q each time, a part averages it out. It
    is formed from 1 - w^2 downwards, so that its rounding has no preferred sign. Only the length is touched: the
    attitude is the direction of q, so neither energy nor momentum sees it.
    """
    x, y, z, w = q
    fx, fy, fz, fw = f
    g = -(fx * fx + fy * fy + fz * fz) / (1.0 + fw)  # fw - 1
    lacking = (((1.0 - w * w) - x * x) - y * y) - z * z
    lacking -= 2.0 * (x * remainder[0] + y * remainder[1] + z * remainder[2] + w * remainder[3])
    g += MENDED * lacking
    nx, rx = add(x, remainder[0], (w * fx + y * fz - z * fy) + g * x)
    ny, ry = add(y, remainder[1], (w * fy + z * fx - x * fz) + g * y)
    nz, rz = add(z, remainder[2], (w * fz + x * fy - y * fx) + g * z)
    nw, rw = add(w, remainder[3], g * w - (x * fx + y * fy + z * fz))
    return (nx, ny, nz, nw), (rx, ry, rz, rw)
