"""What a user may give for a rotation."""

from typing import Any

import numpy as np

from binaryast.errors import InputError
from binaryast.units import Floats, numbers

ROTATION_TOLERANCE = 1e-9  # ||I - R^T R|| of an attitude that a user gives


def rotation(value: Any, name: str, shape: tuple[int, ...]) -> Floats:
    """Return rotation matrices of shape (*shape, 3, 3), from matrices or from a SciPy ``Rotation``; read-only.

    Raises
    ------
    InputError
        Where ||I - R^T R|| is above 1e-9 or a determinant is -1.
    """
    matrices = numbers(value.as_matrix() if hasattr(value, "as_matrix") else value, name, (*shape, 3, 3))
    error = np.linalg.norm(np.eye(3) - np.swapaxes(matrices, -1, -2) @ matrices, axis=(-2, -1))
    if np.any(error > ROTATION_TOLERANCE):
        raise InputError(
            f"{name}: not a rotation: ||I - R^T R|| is {np.max(error):.3g}, expected below {ROTATION_TOLERANCE:g}; "
            "scipy.spatial.transform.Rotation.from_matrix(R) gives the nearest one"
        )
    if np.any(np.linalg.det(matrices) < 0):
        raise InputError(f"{name}: a reflection, with determinant -1: expected a rotation; turn one axis round")
    return matrices
