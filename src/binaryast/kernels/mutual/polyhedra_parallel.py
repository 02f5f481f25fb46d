"""The gravity of two polyhedra on several cores: pairs of their clusters side by side.

The sum is that of ``polyhedra.py``, in another order: pairs that do not count as they are are replaced by pairs of
parts until there are enough to share out. Each pair fills its own row, and the rows are added up in order, so that the
result does not depend on how many threads there are. It is compiled, for some seconds, where it is first asked for.
"""

import numba
import numpy as np

from binaryast.kernels.jit import PAIR_POTENTIAL, Array, Indices, Matrix, PairGravity, Vector, jit
from binaryast.kernels.mutual.polyhedra import (
    ELEMENT,
    PARTS,
    PARTS_AT,
    PRIMARY,
    SECONDARY,
    STRENGTH,
    as_it_is,
    elements,
    first_has_parts,
)

MOST = 256  # pairs to be shared out


@jit(allocates=True)
def pairs(p: Array, x: Vector, r: Matrix) -> tuple[Indices, int]:
    """Return pairs of elements (MOST, 2) whose sum is that of the two bodies, and how many they are."""
    places = np.zeros((MOST, 2), dtype=np.int64)
    places[0, 0], places[0, 1] = int(p[SECONDARY]), int(p[PRIMARY])
    count, divided = 1, True
    while divided:  # one level after the other, so that all become smaller alike
        divided = False
        for at in range(count):
            a, b = places[at, 0], places[at, 1]
            first = first_has_parts(p, a, b)
            parts = int(p[a + PARTS]) if first else int(p[b + PARTS])
            if parts == 0 or count + parts - 1 > MOST or as_it_is(p, a, b, x, r)[0] > 0.0:
                continue
            for k in range(parts):  # one in its place, the others behind
                place = at if k == 0 else count + k - 1
                places[place, 0] = int(p[a + PARTS_AT]) + ELEMENT * k if first else a
                places[place, 1] = b if first else int(p[b + PARTS_AT]) + ELEMENT * k
            count += parts - 1
            divided = True
    return places, count


@jit(PAIR_POTENTIAL, allocates=True, parallel=True)
def potential(
    p: Array, x: float, y: float, z: float,
    r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
) -> PairGravity:  # fmt: skip
    """Return U, dU/dX and M; p is laid out by ``clusters.py``."""
    attitude = (r11, r12, r13, r21, r22, r23, r31, r32, r33)
    places, count = pairs(p, (x, y, z), attitude)
    rows = np.zeros((count, 7))
    for k in numba.prange(count):
        row = elements(p, places[k, 0], places[k, 1], (x, y, z), attitude)
        for i in range(7):
            rows[k, i] = row[i]
    u = gx = gy = gz = mx = my = mz = 0.0
    for k in range(count):
        u += rows[k, 0]
        gx, gy, gz = gx + rows[k, 1], gy + rows[k, 2], gz + rows[k, 3]
        mx, my, mz = mx + rows[k, 4], my + rows[k, 5], mz + rows[k, 6]
    f = p[STRENGTH]
    return f * u, f * gx, f * gy, f * gz, f * mx, f * my, f * mz
