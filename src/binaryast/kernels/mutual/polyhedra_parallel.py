"""The gravity of two polyhedra on several cores: clusters of one against clusters of the other, side by side.

Each pair of clusters fills its own row, and the rows are added up in order: the result does not depend on how many
threads there are. It is compiled, for some seconds, where it is first asked for.
"""

import numba
import numpy as np

from binaryast.kernels.jit import PAIR_POTENTIAL, Array, Indices, PairGravity, jit
from binaryast.kernels.mutual import polyhedra
from binaryast.kernels.mutual.polyhedra import ELEMENT, PARTS, PARTS_AT

TASKS = 8  # clusters of each body, at most; that many squared are shared out


@jit(allocates=True)
def clusters(p: Array, root: int) -> tuple[Indices, int]:
    """Return the places of the largest clusters of a body, and how many they are: a node makes way for its parts."""
    places = np.zeros(TASKS, dtype=np.int64)
    places[0], count, at = root, 1, 0
    while at < count:
        parts, begin = int(p[places[at] + PARTS]), int(p[places[at] + PARTS_AT])
        if parts == 0 or count + parts - 1 > TASKS:
            at += 1
            continue
        places[at] = places[count - 1]  # the last takes its place, and the parts come behind
        count -= 1
        for k in range(parts):
            places[count] = begin + ELEMENT * k
            count += 1
        at = 0 if count < TASKS else at
    return places, count


@jit(PAIR_POTENTIAL, allocates=True, parallel=True)
def potential(
    p: Array, x: float, y: float, z: float,
    r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
) -> PairGravity:  # fmt: skip
    """Return U, dU/dX and M; p is laid out by ``clusters.py``."""
    attitude = (r11, r12, r13, r21, r22, r23, r31, r32, r33)
    places1, n1 = clusters(p, int(p[polyhedra.SECONDARY]))
    places2, n2 = clusters(p, int(p[polyhedra.PRIMARY]))
    rows = np.zeros((n1 * n2, 7))
    for k in numba.prange(n1 * n2):
        row = polyhedra.elements(p, places1[k % n1], places2[k // n1], (x, y, z), attitude)
        for i in range(7):
            rows[k, i] = row[i]
    u = gx = gy = gz = mx = my = mz = 0.0
    for k in range(n1 * n2):
        u += rows[k, 0]
        gx, gy, gz = gx + rows[k, 1], gy + rows[k, 2], gz + rows[k, 3]
        mx, my, mz = mx + rows[k, 4], my + rows[k, 5], mz + rows[k, 6]
    f = p[polyhedra.STRENGTH]
    return f * u, f * gx, f * gy, f * gz, f * mx, f * my, f * mz
