"""Bodies as triangles, and what is seen of them from one side: those that face it, and how much light they get."""

from functools import cache
from typing import NamedTuple

import numpy as np

from binaryast.bodies import RigidBody
from binaryast.units import Floats
from binaryast.viewer.solids import ball_radii, meshes, root

FINE, COARSE = 36, 10  # how many parts of a circle: of an ellipsoid, of one of many balls
DARKEST = 0.2


class Seen(NamedTuple):
    """What is seen of triangles: their corners on the plane (k, 3, 2), their depth towards the eye and their shade."""

    corners: Floats
    depth: Floats
    shade: Floats


def facets(body: RigidBody) -> Floats:
    """Return the surface of a body as triangles (k, 3, 3) [m] in its frame, outward by the right hand."""
    found = [((vertices - body.shape.centre) @ body.turn)[faces] for vertices, faces in meshes(body.shape)]
    if not found:
        found = [sphere(FINE) @ root(matrix) + centre for centre, matrix in body.surface if np.any(matrix)]
    if not found and body.points is not None and not body.is_point:
        places, radii = body.points[0], ball_radii(body)
        found = [sphere(COARSE) * radius + place for place, radius in zip(places, radii, strict=True)]
    return np.concatenate(found) if found else np.zeros((0, 3, 3))


@cache
def sphere(count: int) -> Floats:
    """Return the unit sphere as triangles (k, 3, 3), ``count`` of them round its equator."""
    longitude = np.linspace(0, 2 * np.pi, count + 1)
    colatitude = np.linspace(0, np.pi, count // 2 + 1)
    theta, phi = np.meshgrid(colatitude, longitude, indexing="ij")
    points = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    both = np.concatenate(
        [np.stack([a, b, c], axis=2).reshape(-1, 3, 3), np.stack([a, c, d], axis=2).reshape(-1, 3, 3)]
    )
    normals = np.cross(both[:, 1] - both[:, 0], both[:, 2] - both[:, 0])
    return np.asarray(both[np.linalg.norm(normals, axis=1) > 1e-12])  # not those with two corners at a pole


def seen(triangles: Floats, light: Floats) -> Seen:
    """Return what is seen of triangles (k, 3, 3) along z, which points to the eye; ``light`` (3,) is a direction."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    facing = normals[:, 2] > 0
    triangles, normals = triangles[facing], normals[facing]
    lit = np.maximum(normals @ light / np.linalg.norm(normals, axis=1), 0)
    return Seen(triangles[..., :2], triangles[..., 2].mean(axis=1), DARKEST + (1 - DARKEST) * lit)
