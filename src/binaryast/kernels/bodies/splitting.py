"""The step of a splitting into T and V for n bodies: free motion with exact rotation, and kicks by gravity."""

from binaryast.kernels.bodies.stages import take_stages
from binaryast.kernels.free_rotation import turn_exactly
from binaryast.kernels.jit import PAIR_POINTERS, Array, jit, step_signature


@jit(step_signature(PAIR_POINTERS))
def step(state: Array, constants: Array, scheme: Array, potentials: Array, parameters: Array, h: float) -> int:
    """Advance n bodies by h."""
    return take_stages(turn_exactly, state, constants, scheme, potentials, parameters, h)
