"""The step of a splitting of a pair into Kepler motion with exact rotation, and kicks by what gravity has beyond it."""

from math import sqrt

from binaryast.kernels import kepler
from binaryast.kernels.compensated import add_vector
from binaryast.kernels.external.arguments import External
from binaryast.kernels.free_rotation import turn_both_exactly
from binaryast.kernels.jit import PAIR_POINTER, Array, PairPotential, Vector, jit
from binaryast.kernels.pair.layout import GM, REDUCED_MASS
from binaryast.kernels.pair.stages import Motion, exert_alone, kick_alone, nothing_elapses, take_stages
from binaryast.kernels.so3 import dot
from binaryast.kernels.steps import step_signature


@jit()
def move_on_orbit(x: Vector, rx: Vector, v: Vector, rv: Vector, constants: Array, h: float) -> Motion:
    """Move as two points do."""
    dx, dv = kepler.drift(x, v, constants[GM], h)
    x, rx = add_vector(x, rx, 1.0, dx)
    v, rv = add_vector(v, rv, 1.0, dv)
    return x, rx, v, rv


@jit()
def beyond_points(gradient: Vector, x: Vector, constants: Array) -> Vector:
    """Return dU/dx less that of two points."""
    square = dot(x, x)
    k = constants[GM] * constants[REDUCED_MASS] / (square * sqrt(square))
    return gradient[0] - k * x[0], gradient[1] - k * x[1], gradient[2] - k * x[2]


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
        move_on_orbit,
        beyond_points,
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
