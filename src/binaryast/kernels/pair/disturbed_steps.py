"""The steps of a pair on which something acts from outside, each compiled when it is first asked for."""

from binaryast.kernels.external.arguments import External
from binaryast.kernels.free_rotation import turn_both_exactly, turn_both_variationally
from binaryast.kernels.jit import PAIR_POINTER, Array, PairPotential, deferred
from binaryast.kernels.pair.disturbed import elapse, exert, kick
from binaryast.kernels.pair.kepler_splitting import beyond_points, move_on_orbit
from binaryast.kernels.pair.stages import move_freely, take_stages, whole
from binaryast.kernels.steps import step_signature


@deferred(step_signature(PAIR_POINTER))
def lgvi(
    state: Array,
    constants: Array,
    scheme: Array,
    potential: PairPotential,
    parameters: Array,
    external: External,
    h: float,
) -> int:
    """Advance a pair by h, as ``lgvi.step`` does."""
    return take_stages(
        move_freely,
        whole,
        turn_both_variationally,
        kick,
        exert,
        elapse,
        state,
        constants,
        scheme,
        potential,
        parameters,
        external,
        h,
    )


@deferred(step_signature(PAIR_POINTER))
def splitting(
    state: Array,
    constants: Array,
    scheme: Array,
    potential: PairPotential,
    parameters: Array,
    external: External,
    h: float,
) -> int:
    """Advance a pair by h, as ``splitting.step`` does."""
    return take_stages(
        move_freely,
        whole,
        turn_both_exactly,
        kick,
        exert,
        elapse,
        state,
        constants,
        scheme,
        potential,
        parameters,
        external,
        h,
    )


@deferred(step_signature(PAIR_POINTER))
def kepler_splitting(
    state: Array,
    constants: Array,
    scheme: Array,
    potential: PairPotential,
    parameters: Array,
    external: External,
    h: float,
) -> int:
    """Advance a pair by h, as ``kepler_splitting.step`` does."""
    return take_stages(
        move_on_orbit,
        beyond_points,
        turn_both_exactly,
        kick,
        exert,
        elapse,
        state,
        constants,
        scheme,
        potential,
        parameters,
        external,
        h,
    )
