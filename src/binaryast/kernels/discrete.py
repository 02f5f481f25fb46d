"""The discrete maps as the paper prints them, with its misprints corrected; an equation's number is on its line.

These are the reference that the production steps are held to: matrices and vectors, plain sums, nothing merged.
"""

import numpy as np
from numba import types

from binaryast.kernels.implicit import solve
from binaryast.kernels.jit import ARRAY, PAIR_POTENTIAL, ROWS, Array, PairPotential, jit
from binaryast.kernels.so3 import exp
from binaryast.kernels.status import COMPLETED, NO_ROTATION_1, NO_ROTATION_2


@jit(allocates=True)
def derivatives(potential: PairPotential, p: Array, X: Array, R: Array) -> tuple[Array, Array]:
    """Return dU/dX and M."""
    _, g1, g2, g3, m1, m2, m3 = potential(
        p, X[0], X[1], X[2], R[0, 0], R[0, 1], R[0, 2], R[1, 0], R[1, 1], R[1, 2], R[2, 0], R[2, 1], R[2, 2]
    )
    return np.array([g1, g2, g3]), np.array([m1, m2, m3])


_HAMILTONIAN_RELATIVE = types.int64(
    types.FunctionType(PAIR_POTENTIAL),
    ARRAY,  # p
    types.float64,  # m1
    types.float64,  # m2
    ROWS,  # J1
    ROWS,  # J2
    types.float64,  # h
    types.int64,  # steps
    ARRAY,  # X
    ARRAY,  # Gamma
    ARRAY,  # Pi
    ARRAY,  # Pi2
    ROWS,  # R
    ARRAY,  # x2
    ARRAY,  # gamma2
    ROWS,  # R2
)


@jit(_HAMILTONIAN_RELATIVE, allocates=True)
def hamiltonian_relative(
    potential: PairPotential,
    p: Array,
    m1: float,
    m2: float,
    J1: Array,
    J2: Array,
    h: float,
    steps: int,
    X: Array,
    Gamma: Array,
    Pi: Array,
    Pi2: Array,
    R: Array,
    x2: Array,
    gamma2: Array,
    R2: Array,
) -> int:
    """Take ``steps`` steps of (118)-(127), changing X .. R2 in place; a status.

    X, Gamma, Pi, Pi2 and R are in the primary's frame (Pi = R J1 Omega1 is the secondary's angular momentum there),
    x2, gamma2 and R2 reconstruct the primary's motion in the inertial frame. J1, J2 are full inertia matrices.
    """
    m = m1 * m2 / (m1 + m2)
    dU, M = derivatives(potential, p, X, R)
    for _ in range(steps):
        f, iterations = solve(R @ J1 @ R.T, h * (Pi - h / 2 * M))  # (123)
        if iterations < 0:
            return NO_ROTATION_1
        F = exp(f)
        f, iterations = solve(J2, h * (Pi2 + h / 2 * np.cross(X, dU) + h / 2 * M))  # (124)
        if iterations < 0:
            return NO_ROTATION_2
        F2 = exp(f)
        next_X = F2.T @ (X + h * Gamma / m - h**2 / (2 * m) * dU)  # (118)
        next_R = F2.T @ F @ R  # (122)
        next_R2 = R2 @ F2  # (127)
        next_dU, next_M = derivatives(potential, p, next_X, next_R)
        Gamma[:] = F2.T @ (Gamma - h / 2 * dU) - h / 2 * next_dU  # (119)
        Pi[:] = F2.T @ (Pi - h / 2 * M) - h / 2 * next_M  # (120)
        Pi2[:] = (
            F2.T @ (Pi2 + h / 2 * np.cross(X, dU) + h / 2 * M) + h / 2 * np.cross(next_X, next_dU) + h / 2 * next_M
        )  # (121)
        x2[:] = x2 + h * gamma2 / m2 + h**2 / (2 * m2) * (R2 @ dU)  # (125)
        gamma2[:] = gamma2 + h / 2 * (R2 @ dU) + h / 2 * (next_R2 @ next_dU)  # (126)
        X[:], R[:], R2[:], dU, M = next_X, next_R, next_R2, next_dU, next_M
    return COMPLETED
