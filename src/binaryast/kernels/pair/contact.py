"""Whether a pair touches within a step."""

from binaryast.kernels.arrays import matrix_at, vector_at
from binaryast.kernels.contact import can_touch, touch_on_the_way
from binaryast.kernels.jit import TOUCH, Array, jit
from binaryast.kernels.pair.layout import ATTITUDE_1, ATTITUDE_2, POSITION


@jit(TOUCH)
def touching(state: Array, surfaces: Array, before: Array) -> int:
    """Return 1 where the pair touches on the straight way from the position before a step, else 0."""
    if not can_touch(surfaces, 1, 0):
        return 0
    way = (vector_at(before, POSITION), vector_at(state, POSITION))
    if touch_on_the_way(*way, matrix_at(state, ATTITUDE_2), matrix_at(state, ATTITUDE_1), surfaces, 1, 0):
        return 1
    return 0
