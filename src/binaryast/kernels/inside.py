"""Whether points are inside a closed surface of triangles: its winding number round each of them.

The faces that the half line from the point towards +z crosses are counted, +1 where it leaves, -1 where it enters. A
face is crossed where its projection along z holds the point, and that is counted by edges. The two faces of an edge
see the same numbers and therefore always agree, so nothing slips through between them, however a point lies.
"""

import numpy as np
from numba import types

from binaryast.kernels.jit import Array, Indices, jit
from binaryast.kernels.polyhedron import FACES, VERTICES

NUMBERS = types.Array(types.int64, 1, "C")


@jit()
def turn_of_edge(x: float, y: float, vertices: Array, i: int, j: int) -> int:
    """Return +1 or -1 where the edge from vertex i to j, seen along z, crosses the half line from (x, y) towards +x.

    Up counts +1, down -1. A point on the edge, or level with its end, is taken to be a little to the left and above. An
    edge is looked at from its lower index to its higher, whichever way it runs.
    """
    low, high = min(i, j), max(i, j)
    if (vertices[low, 1] <= y) == (vertices[high, 1] <= y):
        return 0
    dx, dy = vertices[high, 0] - vertices[low, 0], vertices[high, 1] - vertices[low, 1]
    left = dx * (y - vertices[low, 1]) - (x - vertices[low, 0]) * dy  # of the way from low to high, where positive
    if (dy > 0.0 and left < 0.0) or (dy < 0.0 and left > 0.0):
        return 0
    return 1 if (dy > 0.0) == (i < j) else -1


@jit()
def height_of_face(x: float, y: float, vertices: Array, i: int, j: int, k: int) -> float:
    """Return z of a face at (x, y), which is in its projection but for round-off: within the face's own z."""
    ax, ay, az = vertices[i, 0], vertices[i, 1], vertices[i, 2]
    ux, uy, uz = vertices[j, 0] - ax, vertices[j, 1] - ay, vertices[j, 2] - az
    vx, vy, vz = vertices[k, 0] - ax, vertices[k, 1] - ay, vertices[k, 2] - az
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    z = az if nz == 0.0 else az - (nx * (x - ax) + ny * (y - ay)) / nz
    lowest, highest = min(az, az + uz, az + vz), max(az, az + uz, az + vz)
    return float(min(max(z, lowest), highest))


@jit()
def turn_of_face(x: float, y: float, z: float, vertices: Array, i: int, j: int, k: int) -> int:
    """Return +1 or -1 where the half line from a point towards +z crosses a face from within or from without."""
    turn = turn_of_edge(x, y, vertices, i, j) + turn_of_edge(x, y, vertices, j, k) + turn_of_edge(x, y, vertices, k, i)
    if turn == 0 or height_of_face(x, y, vertices, i, j, k) <= z:
        return 0
    return turn


@jit(types.void(NUMBERS, VERTICES, VERTICES, FACES, NUMBERS, NUMBERS, NUMBERS))
def sum_turns(
    result: Indices, points: Array, vertices: Array, faces: Indices, at: Indices, members: Indices, begin: Indices
) -> None:
    """Add up, for each point, the turns of the faces in its band."""
    for p in range(len(points)):
        x, y, z = points[p, 0], points[p, 1], points[p, 2]
        for m in range(begin[at[p]], begin[at[p] + 1]):
            f = members[m]
            result[p] += turn_of_face(x, y, z, vertices, faces[f, 0], faces[f, 1], faces[f, 2])


def windings(points: Array, vertices: Array, faces: Indices) -> Indices:
    """Return how often a closed surface winds round each point (P, 3): 1 inside, 0 outside, where it is sound.

    The faces are sorted into bands across y, so that a point looks at no more than those that reach into its own.
    """
    bands = 1 + int(np.sqrt(len(faces)))
    lowest, highest = vertices[:, 1].min(), vertices[:, 1].max()
    edges = np.linspace(lowest, highest, bands + 1)[1:-1]
    first, last = (np.searchsorted(edges, y) for y in (vertices[faces, 1].min(axis=1), vertices[faces, 1].max(axis=1)))
    lengths = last - first + 1
    members = np.repeat(np.arange(len(faces)), lengths)
    band = np.arange(len(members)) - np.repeat(np.cumsum(lengths) - lengths - first, lengths)
    order = np.argsort(band, kind="stable")
    begin = np.searchsorted(band[order], np.arange(bands + 1))
    result = np.zeros(len(points), dtype=np.int64)
    sum_turns(result, points, vertices, faces, np.searchsorted(edges, points[:, 1]), members[order], begin)
    return result
