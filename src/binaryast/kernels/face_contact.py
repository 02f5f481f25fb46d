"""Whether faces of a mesh cross or touch where they should not.

Two triangles meet exactly where an edge of one meets the other. That is decided by signs of determinants which have no
round-off, so faces in one plane, or in nearly one, are not taken for crossing, and a point on a face is found.
"""

import numpy as np
from numba import types

from binaryast.kernels.jit import Array, Indices, Vector, jit
from binaryast.kernels.orientation import side_of_line, side_of_plane
from binaryast.kernels.polyhedron import FACES, VERTICES
from binaryast.kernels.so3 import cross, dot

MOST = 1000  # pairs that are looked for
PAIRS = types.Array(types.int64, 2, "C")
ORDER = types.Array(types.int64, 1, "C")
BOXES = types.Array(types.float64, 2, "C")  # of each face in that order, its lowest and highest coordinates


@jit()
def corner(vertices: Array, i: int) -> Vector:
    """Return a vertex."""
    return vertices[i, 0], vertices[i, 1], vertices[i, 2]


@jit()
def difference(a: Vector, b: Vector) -> Vector:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@jit()
def segments_meet(p: Vector, q: Vector, a: Vector, b: Vector, i: int, j: int) -> bool:
    """Whether the segments pq and ab, in one plane, have a point in common."""
    sp, sq = side_of_line(a, b, p, i, j), side_of_line(a, b, q, i, j)
    sa, sb = side_of_line(p, q, a, i, j), side_of_line(p, q, b, i, j)
    if sp == 0 and sq == 0 and sa == 0 and sb == 0:  # on one line
        in_i = max(min(p[i], q[i]), min(a[i], b[i])) <= min(max(p[i], q[i]), max(a[i], b[i]))
        in_j = max(min(p[j], q[j]), min(a[j], b[j])) <= min(max(p[j], q[j]), max(a[j], b[j]))
        return in_i and in_j
    return sp * sq <= 0 and sa * sb <= 0


@jit()
def meet_in_plane(p: Vector, q: Vector, a: Vector, b: Vector, c: Vector) -> bool:
    """Whether the segment pq meets the triangle abc, both in one plane: it begins inside, or it crosses an edge."""
    nx, ny, nz = cross(difference(b, a), difference(c, a))
    i, j = 0, 1  # seen along the axis nearest to the normal
    if abs(nx) >= max(abs(ny), abs(nz)):
        i, j = 1, 2
    elif abs(ny) >= abs(nz):
        i, j = 2, 0
    s1, s2, s3 = side_of_line(a, b, p, i, j), side_of_line(b, c, p, i, j), side_of_line(c, a, p, i, j)
    if not (min(s1, s2, s3) < 0 < max(s1, s2, s3)):
        return True
    return segments_meet(p, q, a, b, i, j) or segments_meet(p, q, b, c, i, j) or segments_meet(p, q, c, a, i, j)


@jit()
def edge_meets_face(p: Vector, q: Vector, a: Vector, b: Vector, c: Vector) -> bool:
    """Whether the segment pq meets the triangle abc: its ends on both sides of the plane, its line inside all edges."""
    sp, sq = side_of_plane(a, b, c, p), side_of_plane(a, b, c, q)
    if sp * sq > 0:
        return False
    if sp == 0 and sq == 0:
        return meet_in_plane(p, q, a, b, c)
    s1, s2, s3 = side_of_plane(p, q, a, b), side_of_plane(p, q, b, c), side_of_plane(p, q, c, a)
    return not (min(s1, s2, s3) < 0 < max(s1, s2, s3))


@jit()
def has(faces: Indices, f: int, i: int) -> bool:
    """Whether a vertex is one of a face's corners."""
    return bool(faces[f, 0] == i or faces[f, 1] == i or faces[f, 2] == i)


@jit()
def free_edge_meets(vertices: Array, faces: Indices, f: int, g: int) -> bool:
    """Whether an edge of face f that has no vertex in common with face g meets it."""
    a, b, c = corner(vertices, faces[g, 0]), corner(vertices, faces[g, 1]), corner(vertices, faces[g, 2])
    for i in range(3):
        p, q = faces[f, i], faces[f, (i + 1) % 3]
        if has(faces, g, p) or has(faces, g, q):
            continue
        if edge_meets_face(corner(vertices, p), corner(vertices, q), a, b, c):
            return True
    return False


@jit()
def folded(vertices: Array, faces: Indices, f: int, g: int) -> bool:
    """Whether two faces with an edge in common lie on each other: in one plane, on the same side of the edge."""
    at_f, at_g = 0, 0  # where each has its free corner
    for i in range(3):
        if not has(faces, g, faces[f, i]):
            at_f = i
        if not has(faces, f, faces[g, i]):
            at_g = i
    a, b = corner(vertices, faces[f, (at_f + 1) % 3]), corner(vertices, faces[f, (at_f + 2) % 3])
    c, d = corner(vertices, faces[f, at_f]), corner(vertices, faces[g, at_g])
    edge = difference(b, a)
    same_side = dot(cross(edge, difference(c, a)), cross(edge, difference(d, a))) > 0.0
    return same_side and side_of_plane(a, b, c, d) == 0


@jit()
def faces_meet(vertices: Array, faces: Indices, f: int, g: int) -> bool:
    """Whether two faces have more in common than their common vertices.

    Faces with one vertex in common that meet elsewhere too do so at the edge opposite to it, of one or the other.
    """
    common = 0
    for i in range(3):
        common += has(faces, g, faces[f, i])
    if common == 3:
        return True
    if common == 2:
        return folded(vertices, faces, f, g)
    return free_edge_meets(vertices, faces, f, g) or free_edge_meets(vertices, faces, g, f)


@jit(types.int64(PAIRS, VERTICES, FACES, ORDER, BOXES))
def sweep(found: Indices, vertices: Array, faces: Indices, order: Indices, boxes: Array) -> int:
    """Put the pairs of faces that meet into ``found``, until it is full, and return how many they are.

    Each face is looked at with those that begin before it ends along x; what remains apart in the boxes is passed over.
    """
    count = 0
    for i in range(len(order)):
        begin_y, begin_z = boxes[i, 1], boxes[i, 2]
        end_x, end_y, end_z = boxes[i, 3], boxes[i, 4], boxes[i, 5]
        for j in range(i + 1, len(order)):
            if boxes[j, 0] > end_x:
                break
            apart = boxes[j, 1] > end_y or boxes[j, 4] < begin_y or boxes[j, 2] > end_z or boxes[j, 5] < begin_z
            if not apart and faces_meet(vertices, faces, order[i], order[j]):
                found[count, 0], found[count, 1] = min(order[i], order[j]), max(order[i], order[j])
                count += 1
                if count == len(found):
                    return count
    return count


def contacts(vertices: Array, faces: Indices) -> Indices:
    """Return the pairs (k, 2) of faces that meet elsewhere than at common vertices and edges, MOST of them at most."""
    corners = vertices[faces]
    low, high = corners.min(axis=1), corners.max(axis=1)
    extent = high.max(axis=0) - low.min(axis=0)
    axes = np.roll(np.arange(3), -np.argmax(extent))  # the longest comes first
    order = np.argsort(low[:, axes[0]], kind="stable")
    boxes = np.concatenate([low[:, axes], high[:, axes]], axis=1)[order]
    found = np.zeros((MOST, 2), dtype=np.int64)
    count = sweep(found, vertices, faces, order, boxes)
    return found[:count]
