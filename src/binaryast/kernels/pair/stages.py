"""A step of a pair: kicks by gravity and drifts without it, in turn, each by its share of h.

``scheme`` holds the shares b0, a1, b1, a2, .. an, bn: kicks b, drifts a. With 1/2, 1, 1/2 this is the leapfrog; a
method of higher order has more stages. What a drift is, and what is left to the kicks, differs from method to method:
those files name it. The state is in inertial axes, relative position and velocity, with each angular momentum in its
own body's frame and attitudes as unit quaternions. Values travel as tuples, which the compiler keeps in registers.
"""

from collections.abc import Callable

from numba import types

from binaryast.kernels.arrays import matrix_at, put_quaternion, put_vector, quaternion_at, vector_at
from binaryast.kernels.attraction import attract
from binaryast.kernels.compensated import add_vector
from binaryast.kernels.external.arguments import External
from binaryast.kernels.free_rotation import Attitude
from binaryast.kernels.jit import ARRAY, PAIR_POINTER, Array, Matrix, PairPotential, Vector, jit
from binaryast.kernels.pair.layout import (
    ATTITUDE_1,
    ATTITUDE_2,
    GRADIENT,
    INVERSE_1,
    INVERSE_2,
    MOMENTUM_1,
    MOMENTUM_2,
    POSITION,
    POTENTIAL,
    RATIOS_1,
    RATIOS_2,
    REDUCED_MASS,
    REMAINDER,
    TORQUE_1,
    TORQUE_2,
    VELOCITY,
)
from binaryast.kernels.so3 import quaternion_to_matrix
from binaryast.kernels.status import COMPLETED, NO_ROTATION, NOT_FINITE

Motion = tuple[Vector, Vector, Vector, Vector]  # x, v and what rounding took from them
Turning = tuple[Attitude, Attitude, Matrix, Matrix]  # of both bodies, and their attitudes as matrices
Exerted = tuple[float, Vector, Vector, Vector]  # U, dU/dx1, the torque on each body in its own frame


@jit()
def is_finite(u: float, x: Vector, v: Vector, p1: Vector, p2: Vector) -> bool:
    """Whether all of these are numbers, by one comparison: what is infinite or not a number spoils a sum."""
    total = (u - u) + (x[0] + x[1] + x[2]) + (v[0] + v[1] + v[2]) + (p1[0] + p1[1] + p1[2]) + (p2[0] + p2[1] + p2[2])
    return abs(total) < 1e300


@jit()
def put_exerted(state: Array, exerted: Exerted) -> None:
    """Put the potential and what it exerts into the state."""
    u, gradient, torque_2, torque_1 = exerted
    state[POTENTIAL] = u
    put_vector(state, GRADIENT, gradient)
    put_vector(state, TORQUE_2, torque_2)
    put_vector(state, TORQUE_1, torque_1)


@jit()
def attitude_at(state: Array, attitude: int, momentum: int) -> Attitude:
    """Return a body's attitude and angular momentum with their remainders."""
    q, rq = quaternion_at(state, attitude), quaternion_at(state, REMAINDER + attitude)
    p, rp = vector_at(state, momentum), vector_at(state, REMAINDER + momentum)
    return q, rq, p, rp


@jit()
def put_attitude(state: Array, attitude: int, momentum: int, a: Attitude) -> None:
    """Put a body's attitude and angular momentum with their remainders into the state."""
    q, rq, p, rp = a
    put_quaternion(state, attitude, q)
    put_quaternion(state, REMAINDER + attitude, rq)
    put_vector(state, momentum, p)
    put_vector(state, REMAINDER + momentum, rp)


@jit()
def spun_up(a: Attitude, h: float, torque: Vector) -> Attitude:
    """Return an attitude and angular momentum after a torque has worked for h."""
    q, rq, p, rp = a
    p, rp = add_vector(p, rp, h, torque)
    return q, rq, p, rp


@jit()
def move_freely(x: Vector, rx: Vector, v: Vector, rv: Vector, constants: Array, h: float) -> Motion:
    """Move uniformly."""
    x, rx = add_vector(x, rx, h, v)
    return x, rx, v, rv


@jit()
def whole(gradient: Vector, x: Vector, constants: Array) -> Vector:
    """Return dU/dx: all of it is left to the kicks."""
    return gradient


@jit()
def kick_alone(
    kicking: Callable[..., Vector],
    motion: Motion,
    turning: Turning,
    exerted: Exerted,
    state: Array,
    constants: Array,
    external: External,
    h: float,
) -> tuple[Vector, Vector, Attitude, Attitude]:
    """Return velocity and attitudes after what the bodies exert on each other has worked for h."""
    x, _, v, rv = motion
    a2, a1, _, _ = turning
    _, gradient, torque_2, torque_1 = exerted
    v, rv = add_vector(v, rv, -h / constants[REDUCED_MASS], kicking(gradient, x, constants))
    return v, rv, spun_up(a2, h, torque_2), spun_up(a1, h, torque_1)


@jit()
def exert_alone(
    x: Vector,
    r2: Matrix,
    r1: Matrix,
    state: Array,
    constants: Array,
    potential: PairPotential,
    parameters: Array,
    external: External,
) -> Exerted:
    """Return what the bodies exert on each other."""
    return attract(x, r2, r1, potential, parameters)


@jit()
def nothing_elapses(state: Array, constants: Array, h: float) -> None:
    """Move what is neither of the bodies: nothing."""


@jit()
def take_stages(
    move: Callable[..., Motion],
    kicking: Callable[..., Vector],
    turn_both: Callable[..., tuple[Attitude, Attitude, bool, bool]],
    push: Callable[..., tuple[Vector, Vector, Attitude, Attitude]],
    exert: Callable[..., Exerted],
    elapse: Callable[..., None],
    state: Array,
    constants: Array,
    scheme: Array,
    potential: PairPotential,
    parameters: Array,
    external: External,
    h: float,
) -> int:
    """Advance a pair by h; the state is left as it was where a stage has no solution, and the status says so.

    ``move`` is the drift of the position, ``turn_both`` that of the bodies, ``kicking`` the part of dU/dx that kicks.
    ``push`` is a kick, ``exert`` what is exerted somewhere, ``elapse`` what else a drift moves: of a pair alone
    `kick_alone`, `exert_alone` and `nothing_elapses`.
    """
    x, rx = vector_at(state, POSITION), vector_at(state, REMAINDER + POSITION)
    v, rv = vector_at(state, VELOCITY), vector_at(state, REMAINDER + VELOCITY)
    a2 = attitude_at(state, ATTITUDE_2, MOMENTUM_2)
    a1 = attitude_at(state, ATTITUDE_1, MOMENTUM_1)
    body_2 = vector_at(constants, INVERSE_2), vector_at(constants, RATIOS_2)
    body_1 = vector_at(constants, INVERSE_1), vector_at(constants, RATIOS_1)
    u, gradient = state[POTENTIAL], vector_at(state, GRADIENT)
    exerted = u, gradient, vector_at(state, TORQUE_2), vector_at(state, TORQUE_1)
    turning = body_2[0][0] + body_1[0][0] > 0.0  # points do not
    r2, r1 = quaternion_to_matrix(a2[0]), quaternion_to_matrix(a1[0])

    kick = scheme[0]
    for stage in range(scheme.size // 2):
        v, rv, a2, a1 = push(kicking, (x, rx, v, rv), (a2, a1, r2, r1), exerted, state, constants, external, kick * h)
        drift = scheme[2 * stage + 1] * h
        kick = scheme[2 * stage + 2]

        x, rx, v, rv = move(x, rx, v, rv, constants, drift)
        elapse(state, constants, drift)
        if turning:
            a2, a1, solved_2, solved_1 = turn_both(a2, body_2, a1, body_1, drift)
            if not solved_2:
                return NO_ROTATION
            if not solved_1:
                return NO_ROTATION + 1
            r2, r1 = quaternion_to_matrix(a2[0]), quaternion_to_matrix(a1[0])

        exerted = exert(x, r2, r1, state, constants, potential, parameters, external)
        if not is_finite(exerted[0], x, v, a2[2], a1[2]):
            return NOT_FINITE
    v, rv, a2, a1 = push(kicking, (x, rx, v, rv), (a2, a1, r2, r1), exerted, state, constants, external, kick * h)
    if not is_finite(exerted[0], x, v, a2[2], a1[2]):
        return NOT_FINITE

    put_vector(state, POSITION, x)
    put_vector(state, REMAINDER + POSITION, rx)
    put_vector(state, VELOCITY, v)
    put_vector(state, REMAINDER + VELOCITY, rv)
    put_attitude(state, ATTITUDE_2, MOMENTUM_2, a2)
    put_attitude(state, ATTITUDE_1, MOMENTUM_1, a1)
    put_exerted(state, exerted)
    return COMPLETED


@jit(types.void(ARRAY, PAIR_POINTER, ARRAY))
def prepare(state: Array, potential: PairPotential, parameters: Array) -> None:
    """Fill in what the motion in the state exerts: a working state is complete after this."""
    r2, r1 = matrix_at(state, ATTITUDE_2), matrix_at(state, ATTITUDE_1)
    put_exerted(state, attract(vector_at(state, POSITION), r2, r1, potential, parameters))
