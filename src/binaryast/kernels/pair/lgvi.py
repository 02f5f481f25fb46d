"""The production step of the Lie group variational integrator for a pair: the map (118)-(127), to the last digit.

It is the printed map in other variables, with (123) and (124) solved in Cayley coordinates: half a kick gives the
brackets of (118)-(121), (123) and (124), the drift is (118) with (122), (127) and the F^T of (120), (121), and the
other half of the kick at the new configuration completes (119)-(121). Of the reconstruction only (127) is stepped:
instead of (125) and (126) the barycentre moves uniformly. Higher orders are compositions of such steps of different
lengths.
"""

from binaryast.kernels.external.arguments import External
from binaryast.kernels.free_rotation import turn_both_variationally
from binaryast.kernels.jit import PAIR_POINTER, Array, PairPotential, jit
from binaryast.kernels.pair.stages import (
    exert_alone,
    kick_alone,
    move_freely,
    nothing_elapses,
    take_stages,
    whole,
)
from binaryast.kernels.steps import step_signature


@jit(step_signature(PAIR_POINTER))
def step(
    state: Array,
    constants: Array,
    scheme: Array,
    potential: PairPotential,
    parameters: Array,
    external: External,
    h: float,
) -> int:
    """Advance a pair by h."""
    return take_stages(
        move_freely,
        whole,
        turn_both_variationally,
        kick_alone,
        exert_alone,
        nothing_elapses,
        state,
        constants,
        scheme,
        potential,
        parameters,
        external,
        h,
    )
