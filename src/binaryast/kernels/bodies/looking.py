"""Where several bodies are, for what events watch, also within a step."""

from binaryast.kernels.arrays import matrix_at, vector_at
from binaryast.kernels.bodies.layout import INVERSE, attitude_of, body_constants, momentum_of, velocity_of
from binaryast.kernels.events import looking
from binaryast.kernels.events.places import put_body
from binaryast.kernels.jit import PAIR_POINTERS, VIEW, Array, jit


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


look = jit(looking.look_signature(PAIR_POINTERS))(looking.look)
