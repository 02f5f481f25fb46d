"""The production step of the Lie group variational integrator for n bodies: the map (93)-(97), to the last digit.

It is the printed map in other variables: half a kick gives the brackets of (93)-(96), the drift is (93) with (95)
solved in Cayley coordinates, (97) and the F^T of (96), and the other half of the kick completes (94) and (96). Higher
orders are compositions of such steps of different lengths.
"""

from binaryast.kernels.bodies.stages import take_stages
from binaryast.kernels.free_rotation import turn_variationally
from binaryast.kernels.jit import PAIR_POINTERS, Array, jit, step_signature


@jit(step_signature(PAIR_POINTERS))
def step(state: Array, constants: Array, scheme: Array, potentials: Array, parameters: Array, h: float) -> int:
    """Advance n bodies by h."""
    return take_stages(turn_variationally, state, constants, scheme, potentials, parameters, h)
