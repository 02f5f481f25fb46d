"""The continuous equations of motion as the paper prints them, with its misprints corrected; numbers on their lines.

Each function returns the rates of the variables in the order in which its equations give them. Inertial: v, Omega, x,
R and so on have one row for each body. Relative: everything but what reconstructs body 2, the primary, is in its frame.
A body whose inertia is zero is a point, which does not turn.
"""

import numpy as np
from numba import types

from binaryast.kernels.derivatives import of_bodies, of_pair, of_rigid
from binaryast.kernels.jit import (
    ARRAY,
    BODY_MATRICES,
    PAIR_INDICES,
    PAIR_POINTERS,
    ROWS,
    Array,
    jit,
    reference,
)
from binaryast.kernels.so3 import hat, solve_linear

_BODIES = (PAIR_POINTERS, ARRAY, PAIR_INDICES, ARRAY, BODY_MATRICES)  # potentials, p, pairs, m, J
_INERTIAL = types.Tuple((ROWS, ROWS, ROWS, BODY_MATRICES))(*_BODIES, ROWS, ROWS, ROWS, BODY_MATRICES)
_PAIR = (PAIR_POINTERS, ARRAY, types.float64, types.float64, ROWS, ROWS)  # potentials, p, m1, m2, J1, J2
_VARIABLES = (ARRAY, ARRAY, ARRAY, ARRAY, ROWS, ARRAY, ARRAY, ROWS)
_RELATIVE = types.Tuple(_VARIABLES)(*_PAIR, *_VARIABLES)


@jit(allocates=True)
def angular_velocity(J: Array, Pi: Array) -> Array:
    """Return Omega of J Omega = Pi; a point, which has no inertia, does not turn."""
    if J[0, 0] + J[1, 1] + J[2, 2] == 0.0:
        return np.zeros(3)
    return solve_linear(J, Pi)


@reference(_INERTIAL)
def lagrangian_inertial(
    potentials: Array, p: Array, pairs: Array, m: Array, J: Array, v: Array, Omega: Array, x: Array, R: Array
) -> tuple[Array, Array, Array, Array]:
    """Return the rates of v, Omega, x and R: (25)-(28)."""
    dv, dOmega, dx, dR = np.empty_like(v), np.empty_like(Omega), np.empty_like(x), np.empty_like(R)
    _, dU, M = of_bodies(potentials, p, pairs, x, R)
    for i in range(len(m)):
        dv[i] = -dU[i] / m[i]  # (25)
        dOmega[i] = angular_velocity(J[i], M[i] - np.cross(Omega[i], J[i] @ Omega[i]))  # (26)
        dx[i] = v[i]  # (27)
        dR[i] = R[i] @ hat(Omega[i])  # (28)
    return dv, dOmega, dx, dR


@reference(_INERTIAL)
def hamiltonian_inertial(
    potentials: Array, p: Array, pairs: Array, m: Array, J: Array, gamma: Array, Pi: Array, x: Array, R: Array
) -> tuple[Array, Array, Array, Array]:
    """Return the rates of gamma, Pi, x and R: (29)-(32)."""
    dgamma, dPi, dx, dR = np.empty_like(gamma), np.empty_like(Pi), np.empty_like(x), np.empty_like(R)
    _, dU, M = of_bodies(potentials, p, pairs, x, R)
    for i in range(len(m)):
        Omega = angular_velocity(J[i], Pi[i])
        dgamma[i] = -dU[i]  # (29)
        dPi[i] = of_rigid(J[i], M[i] - np.cross(Omega, Pi[i]))  # (30)
        dx[i] = gamma[i] / m[i]  # (31)
        dR[i] = R[i] @ hat(Omega)  # (32)
    return dgamma, dPi, dx, dR


@reference(_RELATIVE)
def lagrangian_relative(
    potentials: Array,
    p: Array,
    m1: float,
    m2: float,
    J1: Array,
    J2: Array,
    V: Array,
    Omega: Array,
    Omega2: Array,
    X: Array,
    R: Array,
    v2: Array,
    x2: Array,
    R2: Array,
) -> tuple[Array, Array, Array, Array, Array, Array, Array, Array]:
    """Return the rates of V, Omega, Omega2, X, R and, for reconstruction, v2, x2, R2: (55)-(62).

    (56) is for the product J_R Omega, whose factor J_R = R J1 R^T turns with R: its rate is taken off.
    """
    m = m1 * m2 / (m1 + m2)
    _, dU, M = of_pair(potentials, 0, p, X, R)
    JR = R @ J1 @ R.T
    turning = hat(Omega) - hat(Omega2)
    dJR = turning @ JR - JR @ turning  # by (59)
    dV = -dU / m - np.cross(Omega2, V)  # (55)
    dOmega = angular_velocity(JR, -M - np.cross(Omega2, JR @ Omega) - dJR @ Omega)  # (56)
    dOmega2 = angular_velocity(J2, np.cross(X, dU) + M - np.cross(Omega2, J2 @ Omega2))  # (57)
    dX = V - np.cross(Omega2, X)  # (58)
    dR = hat(Omega) @ R - hat(Omega2) @ R  # (59)
    dv2 = R2 @ dU / m2  # (60)
    dx2 = v2.copy()  # (61)
    dR2 = R2 @ hat(Omega2)  # (62)
    return dV, dOmega, dOmega2, dX, dR, dv2, dx2, dR2


@reference(_RELATIVE)
def hamiltonian_relative(
    potentials: Array,
    p: Array,
    m1: float,
    m2: float,
    J1: Array,
    J2: Array,
    Gamma: Array,
    Pi: Array,
    Pi2: Array,
    X: Array,
    R: Array,
    gamma2: Array,
    x2: Array,
    R2: Array,
) -> tuple[Array, Array, Array, Array, Array, Array, Array, Array]:
    """Return the rates of Gamma, Pi, Pi2, X, R and, for reconstruction, gamma2, x2, R2: (63)-(70)."""
    m = m1 * m2 / (m1 + m2)
    _, dU, M = of_pair(potentials, 0, p, X, R)
    Omega = angular_velocity(R @ J1 @ R.T, Pi)
    Omega2 = angular_velocity(J2, Pi2)
    dGamma = -dU - np.cross(Omega2, Gamma)  # (63)
    dPi = of_rigid(J1, -M - np.cross(Omega2, Pi))  # (64)
    dPi2 = of_rigid(J2, np.cross(X, dU) + M - np.cross(Omega2, Pi2))  # (65)
    dX = Gamma / m - np.cross(Omega2, X)  # (66)
    dR = hat(Omega) @ R - hat(Omega2) @ R  # (67)
    dgamma2 = R2 @ dU  # (68)
    dx2 = gamma2 / m2  # (69)
    dR2 = R2 @ hat(Omega2)  # (70)
    return dGamma, dPi, dPi2, dX, dR, dgamma2, dx2, dR2
