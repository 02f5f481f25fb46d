"""How far bodies are from touching, at positions (n, 3) and attitudes (n, 3, 3) in inertial axes."""

from math import inf

from numba import types

from binaryast.kernels.contact import can_touch, clearance
from binaryast.kernels.events.places import apart, matrix_of
from binaryast.kernels.jit import ARRAY, BODY_MATRICES, ROWS, Array, jit
from binaryast.kernels.so3 import relative_attitude, rotate_back


@jit()
def clearance_of(position: Array, attitude: Array, surfaces: Array, one: int, two: int) -> float:
    """Return the clearance of two bodies, at inertial positions (n, 3) and attitudes (n, 3, 3)."""
    r2, r1 = matrix_of(attitude, two), matrix_of(attitude, one)
    return clearance(rotate_back(r2, apart(position, one, two)), relative_attitude(r2, r1), surfaces, one, two)


@jit(types.UniTuple(types.float64, 2)(ROWS, BODY_MATRICES, ARRAY))
def least_clearance(position: Array, attitude: Array, surfaces: Array) -> tuple[float, float]:
    """Return the smallest `clearance` of all pairs of bodies, and which pair has it, counted from 0.

    Positions (n, 3) and attitudes (n, 3, 3) are inertial. It is infinite where nothing can touch.
    """
    n = position.shape[0]
    least, which, pair = inf, 0, 0
    for two in range(n):
        for one in range(two + 1, n):
            if can_touch(surfaces, one, two):
                value = clearance_of(position, attitude, surfaces, one, two)
                if value < least:
                    least, which = value, pair
            pair += 1
    return least, float(which)
