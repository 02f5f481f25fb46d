"""Many steps: watch each, save every k-th, stop on contact or trouble. Never prints, never allocates.

`advance` is compiled for a pair and for several bodies, in ``pair/loop.py`` and ``bodies/loop.py``; a step, what
is watched and how bodies attract are pointers, so neither is compiled again for another method or model.
"""

from collections.abc import Callable
from math import sqrt
from typing import Any

from numba import types

from binaryast.kernels.external.arguments import EXTERNAL, External
from binaryast.kernels.jit import ARRAY, MEASURE, ROWS, TOUCH, Array, Measures
from binaryast.kernels.status import COMPLETED, CONTACT
from binaryast.kernels.steps import step_signature

# What is watched: the references first, then the extremes over every step.
ENERGY = 0  # E0
ANGULAR_MOMENTUM = 1  # pi_T0 (3)
LINEAR_MOMENTUM = 4  # gamma_T0 (3)
REFERENCES = 7  # how many there are
ENERGY_ERROR = 7  # largest |E - E0|
ANGULAR_ERROR = 8  # largest |pi_T - pi_T0|
LINEAR_ERROR = 9  # largest |gamma_T - gamma_T0|
ROTATION_ERROR = 10  # largest ||I - R^T R||
CLOSEST = 11  # smallest distance of two mass centres
CLOSEST_STEP = 12  # and the step after which it was seen
STEPS = 13  # steps done
WATCH_SIZE = 14


def loop_signature(attraction: Any) -> Any:
    """Return the signature of `advance` for one potential or a table of them."""
    return types.int64(
        types.FunctionType(step_signature(attraction)),
        types.FunctionType(MEASURE),
        types.FunctionType(TOUCH),
        ARRAY,  # scheme
        attraction,
        ARRAY,  # parameters
        EXTERNAL,  # what acts from outside
        ARRAY,  # constants
        ARRAY,  # surfaces
        ARRAY,  # state
        ARRAY,  # before
        ARRAY,  # watch
        types.float64,  # h
        types.int64,  # count
        types.int64,  # stride
        ROWS,  # rows
    )


def advance(
    step: Callable[..., int],
    measure: Callable[..., Measures],
    touching: Callable[..., int],
    scheme: Array,
    attraction: Any,
    parameters: Array,
    external: External,
    constants: Array,
    surfaces: Array,
    state: Array,
    before: Array,
    watch: Array,
    h: float,
    count: int,
    stride: int,
    rows: Array,
) -> int:
    """Take ``count`` steps of h.

    The number of steps done is kept in ``watch``; after every ``stride``-th of them the start of the state goes into
    the next of ``rows``, the row of step k being k/stride - 1, and after the last of them into the first again. Whether
    surfaces touch is looked at all along the way of each step. ``before`` keeps the state before a step. Returns a
    status; a step that goes wrong or in which bodies seem to touch is not taken: the state is that before it.
    """
    for _ in range(count):
        for i in range(before.size):
            before[i] = state[i]
        status = step(state, constants, scheme, attraction, parameters, external, h)
        if status != COMPLETED:
            for i in range(before.size):
                state[i] = before[i]
            return status
        pair = touching(state, surfaces, before)
        if pair > 0:
            for i in range(before.size):
                state[i] = before[i]
            return CONTACT + pair - 1
        energy, l1, l2, l3, p1, p2, p3, rotation_error, separation = measure(state, constants)
        watch[STEPS] += 1.0
        watch[ENERGY_ERROR] = max(watch[ENERGY_ERROR], abs(energy - watch[ENERGY]))
        l1 -= watch[ANGULAR_MOMENTUM]
        l2 -= watch[ANGULAR_MOMENTUM + 1]
        l3 -= watch[ANGULAR_MOMENTUM + 2]
        watch[ANGULAR_ERROR] = max(watch[ANGULAR_ERROR], sqrt(l1 * l1 + l2 * l2 + l3 * l3))
        p1 -= watch[LINEAR_MOMENTUM]
        p2 -= watch[LINEAR_MOMENTUM + 1]
        p3 -= watch[LINEAR_MOMENTUM + 2]
        watch[LINEAR_ERROR] = max(watch[LINEAR_ERROR], sqrt(p1 * p1 + p2 * p2 + p3 * p3))
        watch[ROTATION_ERROR] = max(watch[ROTATION_ERROR], rotation_error)
        if separation < watch[CLOSEST]:
            watch[CLOSEST] = separation
            watch[CLOSEST_STEP] = watch[STEPS]
        done = int(watch[STEPS])
        if done % stride == 0:
            row = (done // stride - 1) % rows.shape[0]
            for i in range(rows.shape[1]):
                rows[row, i] = state[i]
    return COMPLETED
