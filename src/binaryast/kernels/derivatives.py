"""The potential and its derivatives as arrays, for the equations as printed."""

import numpy as np
from numba import types

from binaryast.kernels.jit import ARRAY, BODY_MATRICES, PAIR_INDICES, PAIR_POINTERS, ROWS, Array, jit, reference
from binaryast.kernels.pointers import pointer_at

# A row of ``pairs``: index of the primary and of the secondary, where the pair's parameters begin and end.
PRIMARY, SECONDARY, BEGIN, END = 0, 1, 2, 3


@jit(allocates=True)
def of_rigid(J: Array, value: Array) -> Array:
    """Return what turns a body, and zero for a point, whose inertia is zero: round-off would give it a momentum."""
    if J[0, 0] + J[1, 1] + J[2, 2] == 0.0:
        return np.zeros(3)
    return value


@jit(allocates=True)
def of_pair(potentials: Array, k: int, p: Array, X: Array, R: Array) -> tuple[float, Array, Array]:
    """Return U, dU/dX and the moment M (54) of the k-th pair."""
    potential = pointer_at(potentials, k)
    U, g1, g2, g3, m1, m2, m3 = potential(
        p, X[0], X[1], X[2], R[0, 0], R[0, 1], R[0, 2], R[1, 0], R[1, 1], R[1, 2], R[2, 0], R[2, 1], R[2, 2]
    )
    return U, np.array([g1, g2, g3]), np.array([m1, m2, m3])


@jit(allocates=True)
def of_bodies(potentials: Array, p: Array, pairs: Array, x: Array, R: Array) -> tuple[float, Array, Array]:
    """Return U, dU/dx_i (n, 3) and the moments M_i (24) (n, 3) of all bodies, each M_i in its body's frame."""
    U, dU, M = 0.0, np.zeros_like(x), np.zeros_like(x)
    for k in range(len(pairs)):
        two, one = pairs[k, PRIMARY], pairs[k, SECONDARY]
        X = R[two].T @ (x[one] - x[two])  # (34)
        Rk = R[two].T @ R[one]  # (35)
        Uk, dUk, Mk = of_pair(potentials, k, p[pairs[k, BEGIN] : pairs[k, END]], X, Rk)
        U += Uk
        dU[one] += R[two] @ dUk  # U depends on x1 - x2
        dU[two] -= R[two] @ dUk
        M[one] -= Rk.T @ Mk  # (56) in the secondary's own frame
        M[two] += np.cross(X, dUk) + Mk  # (57)
    return U, dU, M


@reference(types.Tuple((types.float64, ROWS, ROWS))(PAIR_POINTERS, ARRAY, PAIR_INDICES, ROWS, BODY_MATRICES))
def derivatives(potentials: Array, p: Array, pairs: Array, x: Array, R: Array) -> tuple[float, Array, Array]:
    """Return what `of_bodies` does, to Python."""
    return of_bodies(potentials, p, pairs, x, R)
