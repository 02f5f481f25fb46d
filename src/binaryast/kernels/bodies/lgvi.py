"""The production step of the Lie group variational integrator for n bodies: the map (93)-(97), to the last digit.

It is the printed map in other variables: half a kick gives the brackets of (93)-(96), the drift is (93) with (95)
solved in Cayley coordinates, (97) and the F^T of (96), and the other half of the kick completes (94) and (96). Higher
orders are compositions of such steps of different lengths.
"""

from binaryast.kernels.bodies.stages import exert_alone, nothing_elapses, push_alone, take_stages
from binaryast.kernels.external.arguments import External
from binaryast.kernels.free_rotation import turn_variationally
from binaryast.kernels.jit import PAIR_POINTERS, Array, jit
from binaryast.kernels.steps import step_signature


@jit(step_signature(PAIR_POINTERS))
def step(
    state: Array, constants: Array, scheme: Array, potentials: Array, parameters: Array, external: External, h: float
) -> int:
    """Advance n bodies by h."""
    return take_stages(
        turn_variationally,
        push_alone,
        exert_alone,
        nothing_elapses,
        state,
        constants,
        scheme,
        potentials,
        parameters,
        external,
        h,
    )
