"""Vectors, quaternions and rotation matrices in and out of flat arrays."""

from binaryast.kernels.jit import Array, Matrix, Quaternion, Vector, jit
from binaryast.kernels.so3 import quaternion_to_matrix


@jit()
def vector_at(a: Array, at: int) -> Vector:
    """Return three numbers of an array."""
    return a[at], a[at + 1], a[at + 2]


@jit()
def quaternion_at(a: Array, at: int) -> Quaternion:
    """Return four numbers of an array."""
    return a[at], a[at + 1], a[at + 2], a[at + 3]


@jit()
def matrix_at(a: Array, at: int) -> Matrix:
    """Return the rotation matrix of the quaternion at ``at``."""
    return quaternion_to_matrix(quaternion_at(a, at))


@jit()
def put_vector(a: Array, at: int, v: Vector) -> None:
    """Put three numbers into an array."""
    a[at], a[at + 1], a[at + 2] = v


@jit()
def put_quaternion(a: Array, at: int, q: Quaternion) -> None:
    """Put four numbers into an array."""
    a[at], a[at + 1], a[at + 2], a[at + 3] = q
