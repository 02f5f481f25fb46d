"""The step of a splitting into T and V for a pair: free motion with exact rotation, and kicks by all of gravity."""

from binaryast.kernels.external.arguments import External
from binaryast.kernels.free_rotation import turn_both_exactly
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
        turn_both_exactly,
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
