"""A step of n bodies: kicks by gravity and free drifts, in turn, each by its share of h.

``scheme`` holds the shares b0, a1, b1, a2, .. an, bn: kicks b, drifts a. How a body turns in a drift differs from
method to method. Velocities stand for linear momenta, attitudes are unit quaternions. A point has none: it is only
moved.
"""

from collections.abc import Callable
from math import sqrt
from typing import Any

from numba import types

from binaryast.kernels.arrays import matrix_at, put_quaternion, put_vector, quaternion_at, vector_at
from binaryast.kernels.attraction import attract
from binaryast.kernels.bodies.layout import (
    AS_POINTS,
    BEGIN,
    BOTH,
    END,
    FELT_BY,
    INVERSE,
    IS_POINT,
    MASS,
    ONLY_PRIMARY,
    ONLY_SECONDARY,
    PRIMARY,
    RATIOS,
    SECONDARY,
    attitude_of,
    body_constants,
    gradient_of,
    momentum_of,
    pair_constants,
    potential_of,
    remainder_of,
    torque_of,
    velocity_of,
)
from binaryast.kernels.compensated import add_vector
from binaryast.kernels.external.arguments import External
from binaryast.kernels.jit import ARRAY, PAIR_POINTERS, Array, Vector, jit
from binaryast.kernels.pointers import pointer_at
from binaryast.kernels.so3 import dot
from binaryast.kernels.status import COMPLETED, NO_ROTATION, NOT_FINITE


@jit()
def increase(state: Array, at: int, remainder: int, scale: float, increment: Vector) -> Vector:
    """Add to a vector of the state, with its remainder; return the sum."""
    v, rv = add_vector(vector_at(state, at), vector_at(state, remainder + at), scale, increment)
    put_vector(state, at, v)
    put_vector(state, remainder + at, rv)
    return v


@jit()
def add(state: Array, at: int, sign: float, increment: Vector) -> None:
    """Add to a vector of the state."""
    x, y, z = increment
    state[at] += sign * x
    state[at + 1] += sign * y
    state[at + 2] += sign * z


@jit(types.int64(ARRAY, ARRAY, types.float64))
def kick_alone(state: Array, constants: Array, h: float) -> int:
    """Add to the momenta what gravity at this configuration does in a time h."""
    n = int(constants[0])
    remainder = remainder_of(n)
    total = state[potential_of(n)] - state[potential_of(n)]  # what is infinite or not a number spoils a sum
    for i in range(n):
        body = body_constants(i)
        x, gradient = vector_at(state, 3 * i), vector_at(state, gradient_of(n) + 3 * i)
        v = increase(state, velocity_of(n) + 3 * i, remainder, -h / constants[body + MASS], gradient)
        total += x[0] + x[1] + x[2] + v[0] + v[1] + v[2]
        if constants[body + IS_POINT]:
            continue
        p = increase(state, momentum_of(n) + 3 * i, remainder, h, vector_at(state, torque_of(n) + 3 * i))
        total += p[0] + p[1] + p[2]
    return COMPLETED if abs(total) < 1e300 else NOT_FINITE


@jit()
def drift(turn: Callable[..., Any], state: Array, constants: Array, h: float) -> int:
    """Move and turn all bodies freely."""
    n = int(constants[0])
    remainder = remainder_of(n)
    for i in range(n):
        body = body_constants(i)
        increase(state, 3 * i, remainder, h, vector_at(state, velocity_of(n) + 3 * i))
        if constants[body + IS_POINT]:
            continue
        p_at, q_at = momentum_of(n) + 3 * i, attitude_of(n) + 4 * i
        q, rq = quaternion_at(state, q_at), quaternion_at(state, remainder + q_at)
        p, rp = vector_at(state, p_at), vector_at(state, remainder + p_at)
        a, solved = turn((q, rq, p, rp), (vector_at(constants, body + INVERSE), vector_at(constants, body + RATIOS)), h)
        if not solved:
            return NO_ROTATION + i
        q, rq, p, rp = a
        put_quaternion(state, q_at, q)
        put_quaternion(state, remainder + q_at, rq)
        put_vector(state, p_at, p)
        put_vector(state, remainder + p_at, rp)
    return COMPLETED


@jit(types.void(ARRAY, ARRAY, PAIR_POINTERS, ARRAY))
def exert(state: Array, constants: Array, potentials: Array, parameters: Array) -> None:
    """Put U, dU/dx_i and M_i of this configuration into the state: the sum over all pairs."""
    n = int(constants[0])
    for i in range(potential_of(n), remainder_of(n)):
        state[i] = 0.0
    total, last, on_last = 0.0, 0, (0.0, 0.0, 0.0)  # pairs with one primary follow each other: its sum is kept aside
    for k in range(int(constants[1])):
        pair = pair_constants(n, k)
        two, one = int(constants[pair + PRIMARY]), int(constants[pair + SECONDARY])
        x2, x1 = vector_at(state, 3 * two), vector_at(state, 3 * one)
        x = (x1[0] - x2[0], x1[1] - x2[1], x1[2] - x2[2])
        if constants[pair + AS_POINTS]:  # the same, without attitudes
            inverse_square = 1.0 / dot(x, x)
            u = -parameters[int(constants[pair + BEGIN])] * sqrt(inverse_square)
            pull = u * inverse_square
            total += u
            add(state, gradient_of(n) + 3 * one, -pull, x)
            if two != last:
                add(state, gradient_of(n) + 3 * last, 1.0, on_last)
                last, on_last = two, (0.0, 0.0, 0.0)
            on_last = (on_last[0] + pull * x[0], on_last[1] + pull * x[1], on_last[2] + pull * x[2])
            continue
        u, gradient, torque_2, torque_1 = attract(
            x,
            matrix_at(state, attitude_of(n) + 4 * two),
            matrix_at(state, attitude_of(n) + 4 * one),
            pointer_at(potentials, k),
            parameters[int(constants[pair + BEGIN]) : int(constants[pair + END])],
        )
        felt_by = constants[pair + FELT_BY]
        if felt_by == BOTH:  # what does not pull has no part in the energy of those that do
            total += u
        if felt_by != ONLY_PRIMARY:
            add(state, gradient_of(n) + 3 * one, 1.0, gradient)
            add(state, torque_of(n) + 3 * one, 1.0, torque_1)
        if felt_by != ONLY_SECONDARY:
            add(state, gradient_of(n) + 3 * two, -1.0, gradient)
            add(state, torque_of(n) + 3 * two, 1.0, torque_2)
    state[potential_of(n)] = total
    add(state, gradient_of(n) + 3 * last, 1.0, on_last)


@jit()
def push_alone(state: Array, constants: Array, external: External, h: float) -> int:
    """Kick by what the bodies exert on each other."""
    return kick_alone(state, constants, h)


@jit()
def exert_alone(state: Array, constants: Array, potentials: Array, parameters: Array, external: External) -> None:
    """Put what the bodies exert on each other into the state."""
    exert(state, constants, potentials, parameters)


@jit()
def nothing_elapses(state: Array, constants: Array, h: float) -> None:
    """Move what is none of the bodies: nothing."""


@jit()
def take_stages(
    turn: Callable[..., Any],
    push: Callable[..., int],
    exert_all: Callable[..., None],
    elapse: Callable[..., None],
    state: Array,
    constants: Array,
    scheme: Array,
    potentials: Array,
    parameters: Array,
    external: External,
    h: float,
) -> int:
    """Advance n bodies by h; where a stage has no solution the state is spoilt, and the status says so.

    ``turn`` is the drift of a body's attitude; ``push`` is a kick, ``exert_all`` what is exerted somewhere, ``elapse``
    what else a drift moves: of bodies alone `push_alone`, `exert_alone` and `nothing_elapses`.
    """
    status = push(state, constants, external, scheme[0] * h)
    for stage in range(scheme.size // 2):
        if status == COMPLETED:
            elapse(state, constants, scheme[2 * stage + 1] * h)
            status = drift(turn, state, constants, scheme[2 * stage + 1] * h)
        if status == COMPLETED:
            exert_all(state, constants, potentials, parameters, external)
            status = push(state, constants, external, scheme[2 * stage + 2] * h)
    return status
