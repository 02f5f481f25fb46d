"""Two potentials joined into one by distance: U = w(r) U_near + (1 - w(r)) U_far, r = |X|.

w goes from 1 to 0 between two distances as the polynomial whose first four derivatives vanish at both ends. The
gradient has the term w'(r) (U_near - U_far) X/r, so the whole is one conservative potential, however much they differ.
"""

from math import sqrt

from binaryast.kernels.jit import PAIR_POTENTIAL, Array, PairGravity, jit
from binaryast.kernels.pointers import WORDS, pointer_at

# the parameters begin with the pointers of both potentials, as their table holds them (``pointers.py``)
FAR, NEAR = 0, 1  # in that table
INNER, OUTER, FIRST_NEAR, FIRST_FAR = 2 * WORDS, 2 * WORDS + 1, 2 * WORDS + 2, 2 * WORDS + 3


@jit()
def falling(s: float) -> tuple[float, float]:
    """Return 1 - s^5 (126 - 420 s + 540 s^2 - 315 s^3 + 70 s^4), from 1 at s = 0 to 0 at s = 1, and its derivative."""
    t = s * (1.0 - s)
    return 1.0 - s**5 * (126.0 + s * (-420.0 + s * (540.0 + s * (-315.0 + s * 70.0)))), -630.0 * t**4


@jit(PAIR_POTENTIAL)
def potential(
    p: Array, x: float, y: float, z: float,
    r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
) -> PairGravity:  # fmt: skip
    """Return U, dU/dX and M; only one of the two is evaluated outside the interval in which they are joined."""
    near, far = p[int(p[FIRST_NEAR]) : int(p[FIRST_FAR])], p[int(p[FIRST_FAR]) :]
    r = sqrt(x * x + y * y + z * z)
    if r >= p[OUTER]:
        return pointer_at(p, FAR)(far, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33)  # type: ignore[no-any-return]
    u1, a1, b1, c1, l1, m1, n1 = pointer_at(p, NEAR)(near, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33)
    if r <= p[INNER]:
        return u1, a1, b1, c1, l1, m1, n1
    u2, a2, b2, c2, l2, m2, n2 = pointer_at(p, FAR)(far, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33)
    width = p[OUTER] - p[INNER]
    w, slope = falling((r - p[INNER]) / width)
    v = 1.0 - w
    k = slope / width * (u1 - u2) / r
    return (
        w * u1 + v * u2,
        w * a1 + v * a2 + k * x,
        w * b1 + v * b2 + k * y,
        w * c1 + v * c2 + k * z,
        w * l1 + v * l2,
        w * m1 + v * m2,
        w * n1 + v * n2,
    )
