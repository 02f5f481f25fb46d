"""Whether any two of n bodies may touch within a step."""

from binaryast.kernels.arrays import quaternion_at, vector_at
from binaryast.kernels.bodies.layout import attitude_of, size_of, velocity_of
from binaryast.kernels.contact import HEADER, PULLS, RADIUS, bulge, can_touch, may_touch
from binaryast.kernels.jit import TOUCH, Array, Vector, jit


@jit()
def apart(a: Array, one: int, two: int) -> Vector:
    """Return the difference of two vectors of an array."""
    x1, x2 = vector_at(a, one), vector_at(a, two)
    return x1[0] - x2[0], x1[1] - x2[1], x1[2] - x2[2]


@jit(TOUCH)
def touching(state: Array, surfaces: Array, before: Array) -> int:
    """Return which pair may touch, counted from 1 in the order (0, 1), (0, 2), .. (1, 2), .., or 0."""
    n = (state.size - size_of(0)) // (size_of(1) - size_of(0))
    extent, pulling = 0.0, 0.0
    for i in range(n):
        extent += surfaces[HEADER * i + RADIUS]
        pulling += surfaces[HEADER * i + PULLS]
    if extent == 0.0:  # points only
        return 0
    pair, v, q = 0, velocity_of(n), attitude_of(n)
    for two in range(n):
        pulling -= surfaces[HEADER * two + PULLS]
        if pulling == 0.0 and surfaces[HEADER * two + PULLS] == 0.0:  # no pairs are left
            break
        for one in range(two + 1, n):
            if surfaces[HEADER * one + PULLS] + surfaces[HEADER * two + PULLS] == 0.0:  # they are no pair
                continue
            pair += 1
            if not can_touch(surfaces, one, two):
                continue
            x, y = apart(before, 3 * one, 3 * two), apart(state, 3 * one, 3 * two)
            way = (y[0] - x[0], y[1] - x[1], y[2] - x[2])
            aside = bulge(way, apart(before, v + 3 * one, v + 3 * two), apart(state, v + 3 * one, v + 3 * two))
            turns = (
                quaternion_at(before, q + 4 * two),
                quaternion_at(state, q + 4 * two),
                quaternion_at(before, q + 4 * one),
                quaternion_at(state, q + 4 * one),
            )
            if may_touch(x, y, aside, turns, surfaces, one, two):
                return pair
    return 0
