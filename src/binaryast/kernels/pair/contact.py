"""Whether a pair may touch within a step."""

from binaryast.kernels.arrays import quaternion_at, vector_at
from binaryast.kernels.contact import bulge, can_touch, may_touch
from binaryast.kernels.jit import TOUCH, Array, jit
from binaryast.kernels.pair.layout import ATTITUDE_1, ATTITUDE_2, POSITION, VELOCITY


@jit(TOUCH)
def touching(state: Array, surfaces: Array, before: Array) -> int:
    """Return 1 where the pair may touch on the way from the state before a step, else 0."""
    if not can_touch(surfaces, 1, 0):
        return 0
    x, y = vector_at(before, POSITION), vector_at(state, POSITION)
    way = (y[0] - x[0], y[1] - x[1], y[2] - x[2])
    aside = bulge(way, vector_at(before, VELOCITY), vector_at(state, VELOCITY))
    turns = (
        quaternion_at(before, ATTITUDE_2),
        quaternion_at(state, ATTITUDE_2),
        quaternion_at(before, ATTITUDE_1),
        quaternion_at(state, ATTITUDE_1),
    )
    return 1 if may_touch(x, y, aside, turns, surfaces, 1, 0) else 0
