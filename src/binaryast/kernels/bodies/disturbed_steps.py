"""The steps of bodies on which something acts from outside, each compiled when it is first asked for."""

from binaryast.kernels.bodies.disturbed import elapse, exert_all, push
from binaryast.kernels.bodies.stages import take_stages
from binaryast.kernels.external.arguments import External
from binaryast.kernels.free_rotation import turn_exactly, turn_variationally
from binaryast.kernels.jit import PAIR_POINTERS, Array, deferred
from binaryast.kernels.steps import step_signature


@deferred(step_signature(PAIR_POINTERS))
def lgvi(
    state: Array, constants: Array, scheme: Array, potentials: Array, parameters: Array, external: External, h: float
) -> int:
    """Advance n bodies by h, as ``lgvi.step`` does."""
    return take_stages(
        turn_variationally, push, exert_all, elapse, state, constants, scheme, potentials, parameters, external, h
    )


@deferred(step_signature(PAIR_POINTERS))
def splitting(
    state: Array, constants: Array, scheme: Array, potentials: Array, parameters: Array, external: External, h: float
) -> int:
    """Advance n bodies by h, as ``splitting.step`` does."""
    return take_stages(
        turn_exactly, push, exert_all, elapse, state, constants, scheme, potentials, parameters, external, h
    )
