"""Surfaces of triangles: read from files, checked, and mended on request."""

from typing import Any, NamedTuple

import numpy as np

from binaryast.errors import InputError
from binaryast.units import Floats, Indices, brief


class Mesh(NamedTuple):
    """Vertices (V, 3) and, for each face, the indices (F, 3) of its corners, anticlockwise as seen from outside."""

    vertices: Floats
    faces: Indices


def as_faces(value: Any, count: int, name: str) -> Indices:
    """Return faces as an array (F, 3) of indices into ``count`` vertices.

    Raises
    ------
    InputError
        For another shape, anything but whole numbers, fewer than four faces, or a vertex that does not exist.
    """
    try:
        faces = np.asarray(value)
    except ValueError:  # rows of different lengths
        raise InputError(f"{name}: expected three vertices in each face, got rows of different lengths") from None
    if faces.ndim != 2 or faces.shape[1] != 3:
        raise InputError(f"{name}: expected an array of shape (F, 3), got shape {faces.shape}")
    if hasattr(value, "unit") or faces.dtype.kind not in "iu":
        raise InputError(f"{name}: expected whole numbers, got {brief(value)}")
    if len(faces) < 4:
        raise InputError(f"{name}: {len(faces)} faces enclose nothing: expected four at least")
    lowest, highest = int(faces.min()), int(faces.max())
    if lowest < 0 or highest >= count:
        wrong = lowest if lowest < 0 else highest
        more = ": they seem to count from 1, subtract 1" if lowest == 1 and highest == count else ""
        raise InputError(
            f"{name}: there is no vertex {wrong}: the {count} vertices have the indices 0 to {count - 1}{more}"
        )
    return faces.astype(np.int64)
