"""Where several bodies are, for what events watch, also within a step."""

from numba import types

from binaryast.kernels.arrays import matrix_at, vector_at
from binaryast.kernels.bodies.layout import INVERSE, attitude_of, body_constants, momentum_of, velocity_of
from binaryast.kernels.events import looking
from binaryast.kernels.events.places import put_body
from binaryast.kernels.external.arguments import External
from binaryast.kernels.jit import PAIR_POINTERS, VIEW, Array, jit
from binaryast.kernels.pointers import reader
from binaryast.kernels.steps import step_signature


@jit(VIEW)
def view(
    state: Array, constants: Array, shares: Array, position: Array, velocity: Array, attitude: Array, spin: Array
) -> None:
    """Put where all bodies are about the barycentre."""
    n = int(constants[0])
    for body in range(n):
        for k in range(3):
            position[body, k] = state[3 * body + k]
            velocity[body, k] = state[velocity_of(n) + 3 * body + k]
        r = matrix_at(state, attitude_of(n) + 4 * body)
        momentum = vector_at(state, momentum_of(n) + 3 * body)
        put_body(attitude, spin, body, r, momentum, constants, body_constants(body) + INVERSE)


STEP_POINTER = types.FunctionType(step_signature(PAIR_POINTERS))
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
        potentials,
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
