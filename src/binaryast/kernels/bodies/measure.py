"""What is watched at every step of n bodies."""

from math import inf, sqrt

from binaryast.kernels.arrays import matrix_at, quaternion_at, vector_at
from binaryast.kernels.bodies.layout import (
    INVERSE,
    IS_POINT,
    MASS,
    PRIMARY,
    PULLS,
    SECONDARY,
    attitude_of,
    body_constants,
    momentum_of,
    pair_constants,
    potential_of,
    velocity_of,
)
from binaryast.kernels.jit import MEASURE, Array, Measures, jit
from binaryast.kernels.so3 import cross, dot, rotate, rotation_error


@jit()
def measured(state: Array, constants: Array) -> Measures:
    """Return E, pi_T (3) and gamma_T (3) about the barycentre, the largest ||I - R^T R||, the smallest |x_i - x_j|."""
    n = int(constants[0])
    energy, largest, square = state[potential_of(n)], 0.0, inf
    l1 = l2 = l3 = p1 = p2 = p3 = 0.0
    for i in range(n):
        body = body_constants(i)
        mass = constants[body + MASS] * constants[body + PULLS]  # what does not pull has no part in the sums
        x, v = vector_at(state, 3 * i), vector_at(state, velocity_of(n) + 3 * i)
        energy += 0.5 * mass * dot(v, v)
        orbit = cross(x, v)
        l1, l2, l3 = l1 + mass * orbit[0], l2 + mass * orbit[1], l3 + mass * orbit[2]
        p1, p2, p3 = p1 + mass * v[0], p2 + mass * v[1], p3 + mass * v[2]
        if constants[body + IS_POINT]:
            continue
        p, inverse = vector_at(state, momentum_of(n) + 3 * i), vector_at(constants, body + INVERSE)
        r = matrix_at(state, attitude_of(n) + 4 * i)
        largest = max(largest, rotation_error(quaternion_at(state, attitude_of(n) + 4 * i)))
        if constants[body + PULLS] == 0.0:
            continue
        energy += 0.5 * (p[0] * p[0] * inverse[0] + p[1] * p[1] * inverse[1] + p[2] * p[2] * inverse[2])
        spin = rotate(r, p)
        l1, l2, l3 = l1 + spin[0], l2 + spin[1], l3 + spin[2]
    for k in range(int(constants[1])):
        pair = pair_constants(n, k)
        x, y = (
            vector_at(state, 3 * int(constants[pair + PRIMARY])),
            vector_at(state, 3 * int(constants[pair + SECONDARY])),
        )
        d = (x[0] - y[0], x[1] - y[1], x[2] - y[2])
        square = min(square, dot(d, d))
    return energy, l1, l2, l3, p1, p2, p3, largest, sqrt(square)


@jit(MEASURE)
def measure(state: Array, constants: Array) -> Measures:
    """Return that of bodies alone."""
    return measured(state, constants)
