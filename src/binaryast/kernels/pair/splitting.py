"""The step of a splitting into T and V for a pair: free motion with exact rotation, and kicks by all of gravity."""

from binaryast.kernels.free_rotation import turn_both_exactly
from binaryast.kernels.jit import PAIR_POINTER, Array, PairPotential, jit, step_signature
from binaryast.kernels.pair.stages import move_freely, take_stages, whole


@jit(step_signature(PAIR_POINTER))
def step(state: Array, constants: Array, scheme: Array, potential: PairPotential, parameters: Array, h: float) -> int:
    """Advance a pair by h."""
    return take_stages(move_freely, whole, turn_both_exactly, state, constants, scheme, potential, parameters, h)
