"""A step of a pair: kicks by gravity and drifts without it, in turn, each by its share of h.

``scheme`` holds the shares b0, a1, b1, a2, .. an, bn: kicks b, drifts a. With 1/2, 1, 1/2 this is the leapfrog; a
method of higher order has more stages. What a drift is, and what is left to the kicks, differs from method to method:
those files name it. The state is in inertial axes, relative position and velocity, with each angular momentum in its
own body's frame and attitudes as unit quaternions. Values travel as tuples, which the compiler keeps in registers.
"""

from collections.abc import Callable
from typing import Any

from numba import types

from binaryast.kernels.arrays import matrix_at, put_quaternion, put_vector, quaternion_at, vector_at
from binaryast.kernels.attraction import attract
from binaryast.kernels.compensated import add_vector
from binaryast.kernels.jit import ARRAY, PAIR_POINTER, Array, PairPotential, Vector, jit
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


@jit()
def is_finite(u: float, x: Vector, v: Vector, p1: Vector, p2: Vector) -> bool:
    """Whether all of these are numbers, by one comparison: what is infinite or not a number spoils a sum."""
    total = (u - u) + (x[0] + x[1] + x[2]) + (v[0] + v[1] + v[2]) + (p1[0] + p1[1] + p1[2]) + (p2[0] + p2[1] + p2[2])
    return abs(total) < 1e300


@jit()
def put_exerted(state: Array, u: float, gradient: Vector, torque_2: Vector, torque_1: Vector) -> None:
    """Put the potential and what it exerts into the state."""
    state[POTENTIAL] = u
    put_vector(state, GRADIENT, gradient)
    put_vector(state, TORQUE_2, torque_2)
    put_vector(state, TORQUE_1, torque_1)


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
def take_stages(
    move: Callable[..., Motion],
    kicking: Callable[..., Vector],
    turn: Callable[..., Any],
    state: Array,
    constants: Array,
    scheme: Array,
    potential: PairPotential,
    parameters: Array,
    h: float,
) -> int:
    """Advance a pair by h; the state is left as it was where a stage has no solution, and the status says so.

    ``move`` is the drift of the positions, ``turn`` that of each body, ``kicking`` the part of dU/dx that kicks.
    """
    x, rx = vector_at(state, POSITION), vector_at(state, REMAINDER + POSITION)
    v, rv = vector_at(state, VELOCITY), vector_at(state, REMAINDER + VELOCITY)
    q2, rq2 = quaternion_at(state, ATTITUDE_2), quaternion_at(state, REMAINDER + ATTITUDE_2)
    p2, rp2 = vector_at(state, MOMENTUM_2), vector_at(state, REMAINDER + MOMENTUM_2)
    q1, rq1 = quaternion_at(state, ATTITUDE_1), quaternion_at(state, REMAINDER + ATTITUDE_1)
    p1, rp1 = vector_at(state, MOMENTUM_1), vector_at(state, REMAINDER + MOMENTUM_1)
    u, gradient = state[POTENTIAL], vector_at(state, GRADIENT)
    torque_2, torque_1 = vector_at(state, TORQUE_2), vector_at(state, TORQUE_1)
    to_velocity = -h / constants[REDUCED_MASS]

    kick = scheme[0]
    for stage in range(scheme.size // 2):
        v, rv = add_vector(v, rv, kick * to_velocity, kicking(gradient, x, constants))
        p2, rp2 = add_vector(p2, rp2, kick * h, torque_2)
        p1, rp1 = add_vector(p1, rp1, kick * h, torque_1)
        drift = scheme[2 * stage + 1] * h
        kick = scheme[2 * stage + 2]

        x, rx, v, rv = move(x, rx, v, rv, constants, drift)
        inverse, ratios = vector_at(constants, INVERSE_2), vector_at(constants, RATIOS_2)
        q2, rq2, p2, rp2, solved = turn(q2, rq2, p2, rp2, inverse, ratios, drift)
        if not solved:
            return NO_ROTATION
        inverse, ratios = vector_at(constants, INVERSE_1), vector_at(constants, RATIOS_1)
        q1, rq1, p1, rp1, solved = turn(q1, rq1, p1, rp1, inverse, ratios, drift)
        if not solved:
            return NO_ROTATION + 1

        r2, r1 = quaternion_to_matrix(q2), quaternion_to_matrix(q1)
        u, gradient, torque_2, torque_1 = attract(x, r2, r1, potential, parameters)
        if not is_finite(u, x, v, p1, p2):
            return NOT_FINITE
    v, rv = add_vector(v, rv, kick * to_velocity, kicking(gradient, x, constants))
    p2, rp2 = add_vector(p2, rp2, kick * h, torque_2)
    p1, rp1 = add_vector(p1, rp1, kick * h, torque_1)
    if not is_finite(u, x, v, p1, p2):
        return NOT_FINITE

    put_vector(state, POSITION, x)
    put_vector(state, VELOCITY, v)
    put_quaternion(state, ATTITUDE_2, q2)
    put_vector(state, MOMENTUM_2, p2)
    put_quaternion(state, ATTITUDE_1, q1)
    put_vector(state, MOMENTUM_1, p1)
    put_exerted(state, u, gradient, torque_2, torque_1)
    put_vector(state, REMAINDER + POSITION, rx)
    put_vector(state, REMAINDER + VELOCITY, rv)
    put_quaternion(state, REMAINDER + ATTITUDE_2, rq2)
    put_vector(state, REMAINDER + MOMENTUM_2, rp2)
    put_quaternion(state, REMAINDER + ATTITUDE_1, rq1)
    put_vector(state, REMAINDER + MOMENTUM_1, rp1)
    return COMPLETED


@jit(types.void(ARRAY, PAIR_POINTER, ARRAY))
def prepare(state: Array, potential: PairPotential, parameters: Array) -> None:
    """Fill in what the motion in the state exerts: a working state is complete after this."""
    u, gradient, torque_2, torque_1 = attract(
        vector_at(state, POSITION), matrix_at(state, ATTITUDE_2), matrix_at(state, ATTITUDE_1), potential, parameters
    )
    put_exerted(state, u, gradient, torque_2, torque_1)
