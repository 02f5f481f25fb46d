"""What bodies look like: ellipsoids, faces, or balls in the body frame, as the page's script reads them."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from binaryast.bodies import RigidBody
from binaryast.layered import Layered
from binaryast.polyhedron import Polyhedron
from binaryast.shapes import Dumbbell, Shape
from binaryast.unions import Union
from binaryast.units import Floats
from binaryast.viewer.packing import packed

FILLING = 0.6  # of the volume of a cloud's own ellipsoid, by the balls that stand for its points


def solids(body: RigidBody, unit: float) -> list[dict[str, Any]]:
    """Return what is to be drawn of a body; lengths over ``unit`` [m]. Nothing of a point.

    Faces are drawn as they are, surfaces without faces as the ellipsoids they consist of, and points without a surface
    as balls whose volumes are as their masses.
    """
    if body.is_point and body.corners is None and body.bounding_radius == 0:
        return []
    to_body = body.turn / unit
    found: list[dict[str, Any]] = [
        {
            "vertices": packed((vertices - body.shape.centre) @ to_body, np.float32),
            "faces": packed(faces, np.uint32),
        }
        for vertices, faces in meshes(body.shape)
    ]
    if not found:
        found = [
            {"centre": (centre / unit).tolist(), "matrix": (root(matrix) / unit).ravel().tolist()}
            for centre, matrix in body.surface
            if np.any(matrix)
        ]
    if isinstance(body.shape, Dumbbell):
        found.append({"rod": [(centre / unit).tolist() for centre, _ in body.surface]})
    return found or balls(body, unit)


def meshes(shape: Shape) -> Iterator[tuple[Floats, Any]]:
    """Yield vertices (k, 3) [m] and faces (m, 3) of each surface that consists of faces, in the shape's frame."""
    if isinstance(shape, Layered):
        yield from meshes(shape.outer)
    elif isinstance(shape, Union) and shape.corners is not None:
        for part in shape.parts:
            if part.si.mass > 0:
                for vertices, faces in meshes(part.shape):
                    yield part.si.offset + vertices @ part.si.turn.T, faces
    elif isinstance(shape, Polyhedron):
        yield shape.vertices.value, shape.faces


def balls(body: RigidBody, unit: float) -> list[dict[str, Any]]:
    """Return balls for the points of a body, if it has some."""
    if body.points is None:
        return []
    places, radii = body.points[0] / unit, ball_radii(body) / unit
    return [{"balls": packed(places, np.float32), "radii": packed(radii, np.float32)}]


def ball_radii(body: RigidBody) -> Floats:
    """Return radii (k,) [m] of balls for the points of a body: they fill a part of the ellipsoid of its inertia."""
    assert body.points is not None
    second = np.maximum(body.si.moments.sum() / 2 - body.si.moments, 0) / body.si.mass
    semi_axes = np.sqrt(5 * second)
    semi_axes = np.maximum(semi_axes, 0.1 * semi_axes.max())  # of points on a line or in a plane
    return np.asarray(np.cbrt(FILLING * body.points[1] * np.prod(semi_axes)))


def root(matrix: Floats) -> Floats:
    """Return the symmetric root of a matrix (3, 3): it takes the unit sphere to the ellipsoid, turning it least."""
    squares, axes = np.linalg.eigh(matrix)
    return np.asarray((axes * np.sqrt(np.maximum(squares, 0))) @ axes.T)


def reach(body: RigidBody) -> float:
    """Return the distance from the mass centre of all that is drawn [m]; 0 of a point."""
    if body.bounding_radius > 0 or body.points is None:
        return body.bounding_radius
    return float(np.linalg.norm(body.points[0], axis=1).max())
