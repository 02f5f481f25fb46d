"""What the equations of motion conserve, for any matrices R, whether they are rotations or not."""

from math import inf, sqrt

import numpy as np
from numba import types

from binaryast.kernels.derivatives import of_bodies
from binaryast.kernels.jit import (
    ARRAY,
    BODY_MATRICES,
    PAIR_INDICES,
    PAIR_POINTERS,
    ROWS,
    Array,
    Measures,
    reference,
)

_INVARIANTS = types.Tuple((types.float64, types.UniTuple(types.float64, 9)))(
    PAIR_POINTERS, ARRAY, PAIR_INDICES, ARRAY, BODY_MATRICES, ROWS, ROWS, ROWS, BODY_MATRICES
)


@reference(_INVARIANTS)
def invariants(
    potentials: Array, p: Array, pairs: Array, m: Array, J: Array, v: Array, Omega: Array, x: Array, R: Array
) -> tuple[float, Measures]:
    """Return U; then E and pi_T (3) about the barycentre, gamma_T (3), the largest ||I - R^T R||, least |x_i - x_j|."""
    U, _, _ = of_bodies(potentials, p, pairs, x, R)
    E, rotation_error, square = U, 0.0, inf
    angular, linear = np.zeros(3), np.zeros(3)
    centre, drift = m @ x / np.sum(m), m @ v / np.sum(m)
    for i in range(len(m)):
        momentum, velocity = J[i] @ Omega[i], v[i] - drift
        E += 0.5 * (m[i] * (velocity @ velocity) + Omega[i] @ momentum)
        angular += m[i] * np.cross(x[i] - centre, velocity) + R[i] @ momentum
        linear += m[i] * v[i]
        error = np.eye(3) - R[i].T @ R[i]
        rotation_error = max(rotation_error, sqrt(np.sum(error * error)))
        for j in range(i):
            d = x[i] - x[j]
            square = min(square, d @ d)
    return U, (E, angular[0], angular[1], angular[2], linear[0], linear[1], linear[2], rotation_error, sqrt(square))
