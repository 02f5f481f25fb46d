"""Where a pair is, for what events watch, also within a step."""

from numba import types

from binaryast.kernels.arrays import matrix_at, vector_at
from binaryast.kernels.events import looking
from binaryast.kernels.events.places import put_body
from binaryast.kernels.external.arguments import External
from binaryast.kernels.jit import PAIR_POINTER, VIEW, Array, jit
from binaryast.kernels.pair.layout import (
    ATTITUDE_1,
    ATTITUDE_2,
    INVERSE_1,
    INVERSE_2,
    MOMENTUM_1,
    MOMENTUM_2,
    POSITION,
    VELOCITY,
)
from binaryast.kernels.pointers import pointer_at, reader
from binaryast.kernels.steps import step_signature


@jit(VIEW)
def view(
    state: Array, constants: Array, shares: Array, position: Array, velocity: Array, attitude: Array, spin: Array
) -> None:
    """Put where both bodies are about the barycentre, the primary first."""
    x, v = vector_at(state, POSITION), vector_at(state, VELOCITY)
    for body in range(2):
        share = -shares[1] if body == 0 else shares[0]
        for k in range(3):
            position[body, k], velocity[body, k] = share * x[k], share * v[k]
    put_body(attitude, spin, 0, matrix_at(state, ATTITUDE_2), vector_at(state, MOMENTUM_2), constants, INVERSE_2)
    put_body(attitude, spin, 1, matrix_at(state, ATTITUDE_1), vector_at(state, MOMENTUM_1), constants, INVERSE_1)


STEP_POINTER = types.FunctionType(step_signature(PAIR_POINTER))
step_at = reader(STEP_POINTER)


@jit(looking.look_signature())
def look(
    functions: Array,
    scheme: Array,
    change: Array,
    back: Array,
    potentials: Array,
    parameters: Array,
    external: External,
    constants: Array,
    shares: Array,
    origin: Array,
    scratch: Array,
    h: float,
    position: Array,
    velocity: Array,
    attitude: Array,
    spin: Array,
) -> int:
    """Look at the bodies a time h after ``origin``, by the functions of a table; return the status."""
    status: int = looking.look(
        step_at(functions, looking.STEP),
        looking.view_at(functions, looking.VIEWING),
        scheme,
        change,
        back,
        pointer_at(functions, looking.POTENTIAL),
        parameters,
        external,
        constants,
        shares,
        origin,
        scratch,
        h,
        position,
        velocity,
        attitude,
        spin,
    )
    return status
