"""Whether any two of n bodies touch within a step."""

from binaryast.kernels.arrays import matrix_at, vector_at
from binaryast.kernels.bodies.layout import attitude_of, size_of
from binaryast.kernels.contact import HEADER, PULLS, RADIUS, can_touch, touch_on_the_way
from binaryast.kernels.jit import TOUCH, Array, jit


@jit(TOUCH)
def touching(state: Array, surfaces: Array, before: Array) -> int:
    """Return which pair touches, counted from 1 in the order (0, 1), (0, 2), .. (1, 2), .., or 0."""
    n = (state.size - size_of(0)) // (size_of(1) - size_of(0))
    extent = 0.0
    for i in range(n):
        extent += surfaces[HEADER * i + RADIUS]
    if extent == 0.0:  # points only
        return 0
    pair = 0
    for two in range(n):
        x2, y2 = vector_at(before, 3 * two), vector_at(state, 3 * two)
        for one in range(two + 1, n):
            if surfaces[HEADER * one + PULLS] + surfaces[HEADER * two + PULLS] == 0.0:  # they are no pair
                continue
            pair += 1
            if not can_touch(surfaces, one, two):
                continue
            x1, y1 = vector_at(before, 3 * one), vector_at(state, 3 * one)
            if touch_on_the_way(
                (x1[0] - x2[0], x1[1] - x2[1], x1[2] - x2[2]),
                (y1[0] - y2[0], y1[1] - y2[1], y1[2] - y2[2]),
                matrix_at(state, attitude_of(n) + 4 * two),
                matrix_at(state, attitude_of(n) + 4 * one),
                surfaces,
                one,
                two,
            ):
                return pair
    return 0
