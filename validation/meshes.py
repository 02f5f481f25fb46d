"""Meshes for the cases on polyhedra: boxes, spheres, and an asteroid with fewer faces."""

from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

Mesh = tuple[np.ndarray, np.ndarray]
SHAPES = Path(__file__).parents[2] / "shared" / "shapes"  # real shapes, which are no part of the package


def box(half: np.ndarray) -> Mesh:
    """Return a box of these half-sizes: the convex hull of its corners."""
    corners = np.stack(np.meshgrid(*np.outer(half, [-1, 1]), indexing="ij"), axis=-1).reshape(-1, 3)
    return _outward(corners, ConvexHull(corners).simplices)


def directions(faces: int) -> Mesh:
    """Return a unit sphere of an even number of faces, its vertices on a spiral of the golden angle."""
    count = faces // 2 + 2
    k = np.arange(count) + 0.5
    z, angle = 1 - 2 * k / count, k * np.pi * (3 - np.sqrt(5))
    points = np.stack([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z], axis=1)
    return _outward(points, ConvexHull(points).simplices)


def resampled(mesh: Mesh, faces: int) -> Mesh:
    """Return a star-shaped mesh with an even number of faces: its radii along `directions`, scaled to its volume."""
    points, triangles = directions(faces)
    points = points * _radii(mesh, points)[:, None]
    return points * np.cbrt(volume(mesh) / volume((points, triangles))), triangles


def volume(mesh: Mesh) -> float:
    """Return the volume."""
    points, triangles = mesh
    return float(np.linalg.det(points[triangles]).sum() / 6)


def _radii(mesh: Mesh, along: np.ndarray) -> np.ndarray:
    """Return the distances (n,) from the origin to the surface along unit vectors (n, 3)."""
    a, b, c = np.moveaxis(mesh[0][mesh[1]], 1, 0)
    sides = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)])
    determinant = np.sum(a * sides[0], axis=1)
    result = []
    for n in along:
        shares = sides @ n  # of the corners in where n leaves the face
        hit = np.all(shares >= 0, axis=0) & (shares.sum(axis=0) > 0)
        result.append(np.max(determinant[hit] / shares.sum(axis=0)[hit]))
    return np.array(result)


def _outward(points: np.ndarray, triangles: np.ndarray) -> Mesh:
    """Return a mesh about the origin with its faces turned outward."""
    inward = np.linalg.det(points[triangles]) < 0
    triangles = triangles.astype(np.int64)
    triangles[inward] = triangles[inward][:, ::-1]
    return points, triangles


def asteroid(name: str) -> Mesh | None:
    """Return the radar shape of 1999 KW4, ``primary`` or ``secondary``, in m and its principal axes, if it is here."""
    folder = SHAPES / "kw4_aligned"
    if not folder.is_dir():
        return None
    points = np.loadtxt(folder / f"kw4_{name}_vert_m.csv", delimiter=",")[:, 1:]
    triangles = np.loadtxt(folder / f"kw4_{name}_facet.csv", delimiter=",", dtype=np.int64)[:, -3:]
    return points, triangles - 1
