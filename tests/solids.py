"""Small closed meshes whose figures are known, as arrays of vertices and faces."""

from itertools import product

import numpy as np

GOLDEN = (1 + 5**0.5) / 2
Solid = tuple[np.ndarray, np.ndarray]


def box(low=(0.0, 0.0, 0.0), high=(1.0, 1.0, 1.0)) -> Solid:
    """Return a box: vertex 4 i + 2 j + k is at the low or high end of x, y and z."""
    vertices = np.array(
        [[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for i, j, k in product((0, 1), repeat=3)]
    )
    squares = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [triangle for a, b, c, d in squares for triangle in ((a, b, c), (a, c, d))]
    return vertices, np.array(faces)


def icosahedron() -> Solid:
    """Return an icosahedron with edges of 2."""
    vertices = [np.roll([0, a, b * GOLDEN], shift) for shift in range(3) for a, b in product((1, -1), repeat=2)]
    vertices = np.array(vertices)
    near = np.linalg.norm(vertices[:, None] - vertices, axis=-1) < 2.1
    faces = []
    for a in range(12):
        for b in range(a + 1, 12):
            for c in range(b + 1, 12):
                if near[a, b] and near[b, c] and near[c, a]:
                    outward = np.linalg.det(vertices[[a, b, c]]) > 0
                    faces.append((a, b, c) if outward else (a, c, b))
    return vertices, np.array(faces)


def icosphere(divisions: int) -> Solid:
    """Return a unit sphere: an icosahedron whose faces are divided in four so many times."""
    vertices, faces = icosahedron()
    for _ in range(divisions):
        vertices, faces = divided(vertices, faces)
    return vertices / np.linalg.norm(vertices, axis=1)[:, None], faces


def divided(vertices: np.ndarray, faces: np.ndarray) -> Solid:
    """Return the same surface, each face divided in four."""
    ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    edges, place = np.unique(ends, axis=0, return_inverse=True)
    p, q, r = place.reshape(3, -1) + len(vertices)
    a, b, c = faces.T
    four = np.concatenate([np.stack(t, axis=1) for t in ((a, p, r), (p, b, q), (r, q, c), (p, q, r))])
    return np.concatenate([vertices, vertices[edges].mean(axis=1)]), four


def torus(around: int = 12, across: int = 8, large: float = 3.0, small: float = 1.0) -> Solid:
    """Return a torus about z: closed and sound, though not like a ball."""
    u, v = np.meshgrid(2 * np.pi * np.arange(around) / around, 2 * np.pi * np.arange(across) / across, indexing="ij")
    radius = large + small * np.cos(v)
    vertices = np.stack([radius * np.cos(u), radius * np.sin(u), small * np.sin(v)], axis=-1).reshape(-1, 3)
    faces = []
    for i, j in product(range(around), range(across)):
        a, b = i * across + j, (i + 1) % around * across + j
        c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
        faces += [(a, b, c), (a, c, d)]
    return vertices, np.array(faces)


def together(*solids: Solid) -> Solid:
    """Return several meshes as one."""
    vertices = np.concatenate([vertices for vertices, _ in solids])
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in solids])
    return vertices, np.concatenate([faces + start for (_, faces), start in zip(solids, starts, strict=False)])
