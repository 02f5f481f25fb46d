"""What is watched at every step of a pair: energy, angular momentum, the attitudes' orthogonality, the separation."""

from math import sqrt

from binaryast.kernels.arrays import matrix_at, quaternion_at, vector_at
from binaryast.kernels.jit import MEASURE, Array, Measures, jit
from binaryast.kernels.pair.layout import (
    ATTITUDE_1,
    ATTITUDE_2,
    INVERSE_1,
    INVERSE_2,
    MOMENTUM_1,
    MOMENTUM_2,
    POSITION,
    POTENTIAL,
    REDUCED_MASS,
    VELOCITY,
)
from binaryast.kernels.so3 import cross, dot, rotate, rotation_error


@jit()
def measured(state: Array, constants: Array) -> Measures:
    """Return E and pi_T (3) of section 5.1 about the barycentre, where gamma_T (3) is 0; ||I - R^T R||; and |x|."""
    mass = constants[REDUCED_MASS]
    x, v = vector_at(state, POSITION), vector_at(state, VELOCITY)
    p2, p1 = vector_at(state, MOMENTUM_2), vector_at(state, MOMENTUM_1)
    i2, i1 = vector_at(constants, INVERSE_2), vector_at(constants, INVERSE_1)
    r2, r1 = matrix_at(state, ATTITUDE_2), matrix_at(state, ATTITUDE_1)
    rotation_2 = p2[0] * p2[0] * i2[0] + p2[1] * p2[1] * i2[1] + p2[2] * p2[2] * i2[2]
    rotation_1 = p1[0] * p1[0] * i1[0] + p1[1] * p1[1] * i1[1] + p1[2] * p1[2] * i1[2]
    energy = 0.5 * (mass * dot(v, v) + rotation_2 + rotation_1) + state[POTENTIAL]
    orbit, spin_2, spin_1 = cross(x, v), rotate(r2, p2), rotate(r1, p1)
    return (
        energy,
        mass * orbit[0] + spin_2[0] + spin_1[0],
        mass * orbit[1] + spin_2[1] + spin_1[1],
        mass * orbit[2] + spin_2[2] + spin_1[2],
        0.0,
        0.0,
        0.0,
        max(rotation_error(quaternion_at(state, ATTITUDE_2)), rotation_error(quaternion_at(state, ATTITUDE_1))),
        sqrt(dot(x, x)),
    )


@jit(MEASURE)
def measure(state: Array, constants: Array) -> Measures:
    """Return that of a pair alone."""
    return measured(state, constants)
