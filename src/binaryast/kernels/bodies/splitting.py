"""The step of a splitting into T and V for n bodies: free motion with exact rotation, and kicks by gravity."""

from binaryast.kernels.bodies.stages import exert_alone, nothing_elapses, push_alone, take_stages
from binaryast.kernels.external.arguments import External
from binaryast.kernels.free_rotation import turn_exactly
from binaryast.kernels.jit import PAIR_POINTERS, Array, jit
from binaryast.kernels.steps import step_signature


@jit(step_signature(PAIR_POINTERS))
def step(
    state: Array, constants: Array, scheme: Array, potentials: Array, parameters: Array, external: External, h: float
) -> int:
    """Advance n bodies by h."""
    return take_stages(
        turn_exactly,
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
