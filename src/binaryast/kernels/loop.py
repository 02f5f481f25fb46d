"""Many steps: watch each, save every k-th, stop on contact or trouble. Never prints, never allocates."""

from collections.abc import Callable
from math import sqrt

from numba import types

from binaryast.kernels.jit import ARRAY, MEASURE, PAIR_POTENTIAL, ROWS, STEP, TOUCH, Array, PairPotential, jit
from binaryast.kernels.layout import POSITION, vector_at
from binaryast.kernels.status import COMPLETED, CONTACT

# What is watched: the references first, then the extremes over every step.
ENERGY = 0  # E0
ANGULAR_MOMENTUM = 1  # pi_T0 (3)
ENERGY_ERROR = 4  # largest |E - E0|
MOMENTUM_ERROR = 5  # largest |pi_T - pi_T0|
ROTATION_ERROR = 6  # largest ||I - R^T R||
CLOSEST = 7  # smallest |x|
CLOSEST_STEP = 8  # and the step after which it was seen
STEPS = 9  # steps done
WATCH_SIZE = 10

_LOOP = types.int64(
    types.FunctionType(STEP),
    types.FunctionType(MEASURE),
    types.FunctionType(TOUCH),
    types.FunctionType(PAIR_POTENTIAL),
    ARRAY,  # parameters
    ARRAY,  # constants
    ARRAY,  # surfaces
    ARRAY,  # state
    ARRAY,  # watch
    types.float64,  # h
    types.int64,  # count
    types.int64,  # stride
    ROWS,  # rows
)


@jit(_LOOP)
def advance(
    step: Callable[..., int],
    measure: Callable[..., tuple[float, float, float, float, float, float]],
    touch: Callable[..., bool],
    potential: PairPotential,
    parameters: Array,
    constants: Array,
    surfaces: Array,
    state: Array,
    watch: Array,
    h: float,
    count: int,
    stride: int,
    rows: Array,
) -> int:
    """Take ``count`` steps of h.

    The number of steps done is kept in ``watch``; after every ``stride``-th of them the start of the state goes into
    the next of ``rows``, the row of step k being k/stride - 1. Whether surfaces touch is looked at all along the way of
    each step. Returns a status; the state
    then is the last good one, or the first with contact.
    """
    for _ in range(count):
        before = vector_at(state, POSITION)
        status = step(state, constants, potential, parameters, h)
        if status != COMPLETED:
            return status
        energy, l1, l2, l3, rotation_error, separation = measure(state, constants)
        watch[STEPS] += 1.0
        watch[ENERGY_ERROR] = max(watch[ENERGY_ERROR], abs(energy - watch[ENERGY]))
        l1 -= watch[ANGULAR_MOMENTUM]
        l2 -= watch[ANGULAR_MOMENTUM + 1]
        l3 -= watch[ANGULAR_MOMENTUM + 2]
        watch[MOMENTUM_ERROR] = max(watch[MOMENTUM_ERROR], sqrt(l1 * l1 + l2 * l2 + l3 * l3))
        watch[ROTATION_ERROR] = max(watch[ROTATION_ERROR], rotation_error)
        if separation < watch[CLOSEST]:
            watch[CLOSEST] = separation
            watch[CLOSEST_STEP] = watch[STEPS]
        done = int(watch[STEPS])
        if done % stride == 0:
            row = done // stride - 1
            for i in range(rows.shape[1]):
                rows[row, i] = state[i]
        if touch(state, surfaces, *before):
            return CONTACT
    return COMPLETED
