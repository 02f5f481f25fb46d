"""Vectors and quaternions in formulas: the functions of ``kernels/so3.py`` as they are written, and a few more."""

from collections.abc import Sequence
from typing import Any, TypeAlias

from binaryast.kernels import so3

Number: TypeAlias = Any  # a float, or what stands for one in a formula
Numbers: TypeAlias = Sequence[Number]
cross, dot, rotate, rotate_back, quaternion_to_matrix = (
    getattr(so3, name).py_func for name in ("cross", "dot", "rotate", "rotate_back", "quaternion_to_matrix")
)


def added(a: Numbers, b: Numbers) -> list[Number]:
    """Return the sum of two vectors."""
    return [one + two for one, two in zip(a, b, strict=True)]


def subtracted(a: Numbers, b: Numbers) -> list[Number]:
    """Return the difference of two vectors."""
    return [one - two for one, two in zip(a, b, strict=True)]


def scaled(k: Number, a: Numbers) -> list[Number]:
    """Return a multiple of a vector."""
    return [k * component for component in a]


def conjugate(q: Numbers) -> list[Number]:
    """Return the quaternion of the turn back."""
    return [-q[0], -q[1], -q[2], q[3]]


def product(a: Numbers, b: Numbers) -> list[Number]:
    """Return the quaternion of the turn b, then a."""
    turned = added(cross(a[:3], b[:3]), added(scaled(a[3], b[:3]), scaled(b[3], a[:3])))
    return [*turned, a[3] * b[3] - dot(a[:3], b[:3])]
