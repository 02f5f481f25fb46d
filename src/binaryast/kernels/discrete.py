"""The discrete maps as the paper prints them, with its misprints corrected; an equation's number is on its line.

These are the reference that the production steps are held to: matrices and vectors, plain sums, nothing merged. Each
function takes ``steps`` steps, changes its variables in place and returns a status. The Lagrangian forms step two
configurations, k and k+1. There F is a product of two attitudes, which round-off takes off SO(3); second differences
would add that up with the square of the number of steps, so F is taken as the nearest rotation. They still lose digits
as the step shrinks. The summed forms carry the differences themselves, as one would sum (78) and (79): D, which is
x_{k+1} - x_k or F2_k X_{k+1} - X_k, and g of (128), S(g) = F J_d - J_d F^T.

A body whose inertia is zero is a point, which does not turn.
"""

import numpy as np
from numba import types

from binaryast.kernels.derivatives import of_bodies, of_pair, of_rigid
from binaryast.kernels.implicit import solve
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
from binaryast.kernels.so3 import exp, nearest_rotation, vee
from binaryast.kernels.status import COMPLETED, NO_ROTATION

_BODIES = (PAIR_POINTERS, ARRAY, PAIR_INDICES, ARRAY, BODY_MATRICES)  # potentials, p, pairs, m, J
_STEPS = (types.float64, types.int64)  # h, steps
_PAIR = (PAIR_POINTERS, ARRAY, types.float64, types.float64, ROWS, ROWS)  # potentials, p, m1, m2, J1, J2


@jit(allocates=True)
def nonstandard(J: Array) -> Array:
    """Return the nonstandard moment of inertia J_d = tr(J) I/2 - J, as J = tr(J_d) I - J_d below (12)."""
    result: Array = 0.5 * (J[0, 0] + J[1, 1] + J[2, 2]) * np.eye(3) - J
    return result


@jit(allocates=True)
def turn(J: Array, g: Array) -> tuple[Array, int]:
    """Return F of F J_d - J_d F^T = S(g), and the number of iterations, -1 without a solution."""
    if J[0, 0] + J[1, 1] + J[2, 2] == 0.0:
        return np.eye(3), 0
    f, iterations = solve(J, g)
    return exp(f), iterations


@jit(allocates=True)
def momentum_of(F: Array, J: Array) -> Array:
    """Return g of S(g) = F J_d - J_d F^T (128)."""
    Jd = nonstandard(J)
    return vee(F @ Jd - Jd @ F.T)


@reference(types.int64(*_BODIES, *_STEPS, ROWS, BODY_MATRICES, ROWS, BODY_MATRICES))
def lagrangian_inertial(
    potentials: Array,
    p: Array,
    pairs: Array,
    m: Array,
    J: Array,
    h: float,
    steps: int,
    x: Array,
    R: Array,
    next_x: Array,
    next_R: Array,
) -> int:
    """Take steps of (78)-(80): from configurations k and k+1 to k+1 and k+2."""
    for _ in range(steps):
        _, dU, M = of_bodies(potentials, p, pairs, next_x, next_R)
        for i in range(len(m)):
            F = nearest_rotation(R[i].T @ next_R[i])  # (80)
            Jd = nonstandard(J[i])
            F, iterations = turn(J[i], vee(Jd @ F - F.T @ Jd) + h**2 * M[i])  # (79)
            if iterations < 0:
                return NO_ROTATION + i
            new_x = 2 * next_x[i] - x[i] - h**2 / m[i] * dU[i]  # (78)
            x[i], next_x[i] = next_x[i], new_x
            R[i] = next_R[i]
            next_R[i] = R[i] @ F  # (80)
    return COMPLETED


@reference(types.int64(*_BODIES, *_STEPS, ROWS, BODY_MATRICES, ROWS, ROWS))
def summed_inertial(
    potentials: Array,
    p: Array,
    pairs: Array,
    m: Array,
    J: Array,
    h: float,
    steps: int,
    x: Array,
    R: Array,
    D: Array,
    g: Array,
) -> int:
    """Take steps of (78)-(80) in summed form: x and R of k, D = x_{k+1} - x_k, S(g) = F_k J_d - J_d F_k^T."""
    for _ in range(steps):
        F = np.empty_like(R)
        for i in range(len(m)):
            F[i], iterations = turn(J[i], g[i])
            if iterations < 0:
                return NO_ROTATION + i
            x[i] = x[i] + D[i]
            R[i] = R[i] @ F[i]  # (80)
        _, dU, M = of_bodies(potentials, p, pairs, x, R)
        for i in range(len(m)):
            D[i] = D[i] - h**2 / m[i] * dU[i]  # (78)
            g[i] = of_rigid(J[i], F[i].T @ g[i] + h**2 * M[i])  # (79), J_d F - F^T J_d being F^T (F J_d - J_d F^T) F
    return COMPLETED


@reference(types.int64(*_BODIES, *_STEPS, ROWS, ROWS, ROWS, BODY_MATRICES))
def hamiltonian_inertial(
    potentials: Array,
    p: Array,
    pairs: Array,
    m: Array,
    J: Array,
    h: float,
    steps: int,
    x: Array,
    gamma: Array,
    Pi: Array,
    R: Array,
) -> int:
    """Take steps of (93)-(97)."""
    _, dU, M = of_bodies(potentials, p, pairs, x, R)
    F = np.empty_like(R)
    for _ in range(steps):
        for i in range(len(m)):
            F[i], iterations = turn(J[i], h * (Pi[i] + h / 2 * M[i]))  # (95)
            if iterations < 0:
                return NO_ROTATION + i
            x[i] = x[i] + h / m[i] * gamma[i] - h**2 / (2 * m[i]) * dU[i]  # (93)
            R[i] = R[i] @ F[i]  # (97)
        _, next_dU, next_M = of_bodies(potentials, p, pairs, x, R)
        for i in range(len(m)):
            gamma[i] = gamma[i] - h / 2 * dU[i] - h / 2 * next_dU[i]  # (94)
            Pi[i] = of_rigid(J[i], F[i].T @ Pi[i] + h / 2 * F[i].T @ M[i] + h / 2 * next_M[i])  # (96)
        dU, M = next_dU, next_M
    return COMPLETED


@reference(types.int64(*_PAIR, *_STEPS, ARRAY, ROWS, ROWS, ARRAY, ARRAY, ROWS, ROWS, ARRAY))
def lagrangian_relative(
    potentials: Array,
    p: Array,
    m1: float,
    m2: float,
    J1: Array,
    J2: Array,
    h: float,
    steps: int,
    X: Array,
    R: Array,
    R2: Array,
    x2: Array,
    next_X: Array,
    next_R: Array,
    next_R2: Array,
    next_x2: Array,
) -> int:
    """Take steps of (112)-(117): from configurations k and k+1 to k+1 and k+2."""
    m = m1 * m2 / (m1 + m2)
    for _ in range(steps):
        F2 = nearest_rotation(R2.T @ next_R2)  # (116)
        F = nearest_rotation(F2 @ next_R @ R.T)  # (115)
        _, dU, M = of_pair(potentials, 0, p, next_X, next_R)
        JR, next_JR = R @ J1 @ R.T, next_R @ J1 @ next_R.T
        moment = np.cross(next_X, dU) + M
        next_F, iterations = turn(next_JR, F2.T @ momentum_of(F, JR) - h**2 * M)  # (113)
        if iterations < 0:
            return NO_ROTATION + 1
        next_F2, iterations = turn(J2, F2.T @ momentum_of(F2, J2) + h**2 * moment)  # (114)
        if iterations < 0:
            return NO_ROTATION
        new_X = next_F2.T @ (2 * next_X - F2.T @ X - h**2 / m * dU)  # (112)
        new_x2 = 2 * next_x2 - x2 + h**2 / m2 * (next_R2 @ dU)  # (117)
        X[:], R[:], R2[:], x2[:] = next_X, next_R, next_R2, next_x2
        next_X[:], next_x2[:] = new_X, new_x2
        next_R[:] = next_F2.T @ next_F @ R  # (115)
        next_R2[:] = R2 @ next_F2  # (116)
    return COMPLETED


@reference(types.int64(*_PAIR, *_STEPS, ARRAY, ROWS, ROWS, ARRAY, ARRAY, ARRAY, ARRAY, ARRAY))
def summed_relative(
    potentials: Array,
    p: Array,
    m1: float,
    m2: float,
    J1: Array,
    J2: Array,
    h: float,
    steps: int,
    X: Array,
    R: Array,
    R2: Array,
    x2: Array,
    D: Array,
    g: Array,
    g2: Array,
    D2: Array,
) -> int:
    """Take steps of (112)-(117) in summed form.

    X, R, R2 and x2 are those of k; D = F2_k X_{k+1} - X_k, D2 = x2_{k+1} - x2_k, S(g) = F_k J_dR - J_dR F_k^T and
    S(g2) = F2_k J_d2 - J_d2 F2_k^T.
    """
    m = m1 * m2 / (m1 + m2)
    for _ in range(steps):
        F, iterations = turn(R @ J1 @ R.T, g)
        if iterations < 0:
            return NO_ROTATION + 1
        F2, iterations = turn(J2, g2)
        if iterations < 0:
            return NO_ROTATION
        X[:] = F2.T @ (X + D)
        R[:] = F2.T @ F @ R  # (115)
        R2[:] = R2 @ F2  # (116)
        x2[:] = x2 + D2
        _, dU, M = of_pair(potentials, 0, p, X, R)
        D[:] = F2.T @ D - h**2 / m * dU  # (112)
        g[:] = of_rigid(J1, F2.T @ g - h**2 * M)  # (113)
        g2[:] = of_rigid(J2, F2.T @ g2 + h**2 * np.cross(X, dU) + h**2 * M)  # (114)
        D2[:] = D2 + h**2 / m2 * (R2 @ dU)  # (117)
    return COMPLETED


@reference(types.int64(*_PAIR, *_STEPS, ARRAY, ARRAY, ARRAY, ARRAY, ROWS, ARRAY, ARRAY, ROWS))
def hamiltonian_relative(
    potentials: Array,
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
    """Take steps of (118)-(127).

    X, Gamma, Pi, Pi2 and R are in the primary's frame (Pi = R J1 Omega1 is the secondary's angular momentum there),
    x2, gamma2 and R2 reconstruct the primary's motion in the inertial frame.
    """
    m = m1 * m2 / (m1 + m2)
    _, dU, M = of_pair(potentials, 0, p, X, R)
    for _ in range(steps):
        F, iterations = turn(R @ J1 @ R.T, h * (Pi - h / 2 * M))  # (123)
        if iterations < 0:
            return NO_ROTATION + 1
        F2, iterations = turn(J2, h * (Pi2 + h / 2 * np.cross(X, dU) + h / 2 * M))  # (124)
        if iterations < 0:
            return NO_ROTATION
        next_X = F2.T @ (X + h * Gamma / m - h**2 / (2 * m) * dU)  # (118)
        next_R = F2.T @ F @ R  # (122)
        next_R2 = R2 @ F2  # (127)
        _, next_dU, next_M = of_pair(potentials, 0, p, next_X, next_R)
        Gamma[:] = F2.T @ (Gamma - h / 2 * dU) - h / 2 * next_dU  # (119)
        Pi[:] = of_rigid(J1, F2.T @ (Pi - h / 2 * M) - h / 2 * next_M)  # (120)
        bracket = Pi2 + h / 2 * np.cross(X, dU) + h / 2 * M
        Pi2[:] = of_rigid(J2, F2.T @ bracket + h / 2 * np.cross(next_X, next_dU) + h / 2 * next_M)  # (121)
        x2[:] = x2 + h * gamma2 / m2 + h**2 / (2 * m2) * (R2 @ dU)  # (125)
        gamma2[:] = gamma2 + h / 2 * (R2 @ dU) + h / 2 * (next_R2 @ next_dU)  # (126)
        X[:], R[:], R2[:], dU, M = next_X, next_R, next_R2, next_dU, next_M
    return COMPLETED
