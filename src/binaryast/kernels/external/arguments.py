"""What a step is told of what acts from outside."""

from typing import Any, NamedTuple

from numba import types

from binaryast.kernels.jit import ARRAY, BODY_MATRICES, PAIR_POINTERS, ROWS


class External(NamedTuple):
    """What acts, and room for where the bodies are and for what is exerted on each.

    Attributes
    ----------
    potentials, forces : ndarray
        Tables of pointers to compiled functions.
    parameters, begins : ndarray
        What these need, one after the other, and where each begins: potentials first.
    x, v, R, Omega : ndarray
        Of each body, inertial but for the spin, which is in the body's frame: (n, 3), (n, 3), (n, 3, 3), (n, 3).
    F, N : ndarray
        Force (n, 3), inertial, and torque (n, 3) about the mass centre, in the body's frame.
    counts : ndarray
        Whether a body counts in sums over all (n,): 1, or 0 of one that pulls no other.
    """

    potentials: Any
    forces: Any
    parameters: Any
    begins: Any
    x: Any
    v: Any
    R: Any
    Omega: Any
    F: Any
    N: Any
    counts: Any


_INDICES = types.Array(types.int64, 1, "C")
EXTERNAL = types.NamedTuple(
    (PAIR_POINTERS, PAIR_POINTERS, ARRAY, _INDICES, ROWS, ROWS, BODY_MATRICES, ROWS, ROWS, ROWS, ARRAY), External
)
