"""The production step of the Lie group variational integrator for a pair: the map (118)-(127), to the last digit.

It is the printed map in other variables: the relative position in inertial axes instead of the primary's frame, each
angular momentum in its own body's frame, attitudes as unit quaternions, and (123), (124) solved in Cayley coordinates.
Of the reconstruction only (127) is stepped: instead of (125) and (126) the barycentre moves uniformly.
Values travel as tuples, which the compiler keeps in registers.
"""

from numba import types

from binaryast.kernels.arrays import matrix_at, put_quaternion, put_vector, quaternion_at, vector_at
from binaryast.kernels.attraction import attract
from binaryast.kernels.compensated import add_vector
from binaryast.kernels.free_rotation import turn
from binaryast.kernels.jit import ARRAY, PAIR_POINTER, Array, PairPotential, Vector, jit, step_signature
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


@jit(step_signature(PAIR_POINTER))
def step(state: Array, constants: Array, potential: PairPotential, parameters: Array, h: float) -> int:
    """Advance a pair by h; the state is left as it was where the step has no solution, and the status says so."""
    to_velocity = -0.5 * h / constants[REDUCED_MASS]
    half = 0.5 * h

    # half a kick: the brackets of (118)-(121), (123) and (124)
    v, rv = vector_at(state, VELOCITY), vector_at(state, REMAINDER + VELOCITY)
    v, rv = add_vector(v, rv, to_velocity, vector_at(state, GRADIENT))
    p2, rp2 = vector_at(state, MOMENTUM_2), vector_at(state, REMAINDER + MOMENTUM_2)
    p2, rp2 = add_vector(p2, rp2, half, vector_at(state, TORQUE_2))
    p1, rp1 = vector_at(state, MOMENTUM_1), vector_at(state, REMAINDER + MOMENTUM_1)
    p1, rp1 = add_vector(p1, rp1, half, vector_at(state, TORQUE_1))

    # drift
    x, rx = vector_at(state, POSITION), vector_at(state, REMAINDER + POSITION)
    x, rx = add_vector(x, rx, h, v)  # (118)
    q2, rq2 = quaternion_at(state, ATTITUDE_2), quaternion_at(state, REMAINDER + ATTITUDE_2)
    inverse, ratios = vector_at(constants, INVERSE_2), vector_at(constants, RATIOS_2)
    q2, rq2, p2, rp2, solved = turn(q2, rq2, p2, rp2, inverse, ratios, h)
    if not solved:
        return NO_ROTATION
    q1, rq1 = quaternion_at(state, ATTITUDE_1), quaternion_at(state, REMAINDER + ATTITUDE_1)
    inverse, ratios = vector_at(constants, INVERSE_1), vector_at(constants, RATIOS_1)
    q1, rq1, p1, rp1, solved = turn(q1, rq1, p1, rp1, inverse, ratios, h)
    if not solved:
        return NO_ROTATION + 1

    # half a kick at the new configuration
    u, gradient, torque_2, torque_1 = attract(
        x, quaternion_to_matrix(q2), quaternion_to_matrix(q1), potential, parameters
    )
    v, rv = add_vector(v, rv, to_velocity, gradient)  # (119)
    p1, rp1 = add_vector(p1, rp1, half, torque_1)  # (120)
    p2, rp2 = add_vector(p2, rp2, half, torque_2)  # (121)
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
