"""What can be mended in a mesh without changing the surface that was meant. Holes and crossings are not among it."""

import numpy as np

from binaryast.kernels.polyhedron import volume_moments
from binaryast.meshes import Mesh
from binaryast.meshes.topology import connected, edges, to_be_turned
from binaryast.units import Indices


def mended(mesh: Mesh) -> tuple[Mesh, list[str]]:
    """Return a mesh with all that can be mended, and what was done, in words.

    In this order: vertices in one place are merged, faces that have a vertex twice are removed, so are faces that stand
    twice, a pair back to back both, and vertices that no face uses; faces are turned to agree with their neighbours,
    and all of them where they look inwards.
    """
    done = []

    def note(number: int, what: str) -> None:
        if number:
            done.append(counted(number, what))

    vertices, faces = merged(mesh)
    note(len(mesh.vertices) - len(vertices), "vertex merged with another in the same place")
    thin = repeats_a_vertex(faces)
    note(int(thin.sum()), "face removed that had a vertex twice")
    faces = faces[~thin]
    keep = not_twice(faces)
    note(int(len(faces) - keep.sum()), "face removed that stood twice")
    faces = faces[keep]
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    note(int(len(vertices) - used.sum()), "vertex removed that no face uses")
    vertices, faces = vertices[used], (np.cumsum(used) - 1)[faces]
    faces, turned = agreeing(faces)
    note(turned, "face turned to agree with the neighbours")
    if looks_inwards(Mesh(vertices, faces)):
        faces = faces[:, ::-1].copy()
        done.append("all faces turned outwards")
    return Mesh(vertices, faces), done


def merged(mesh: Mesh) -> Mesh:
    """Return a mesh in which vertices in exactly one place are one, in the order in which each first appears."""
    _, first, place = np.unique(mesh.vertices + 0.0, axis=0, return_index=True, return_inverse=True)  # -0 is 0
    rank = np.empty_like(first)
    rank[np.argsort(first)] = np.arange(len(first))
    return Mesh(mesh.vertices[np.sort(first)], rank[place.ravel()][mesh.faces])


def repeats_a_vertex(faces: Indices) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return which faces have a vertex twice."""
    a, b, c = faces.T
    return np.asarray((a == b) | (b == c) | (c == a))


def not_twice(faces: Indices) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return which faces to keep so that none stands twice; of a pair back to back, none."""
    low = np.argmin(faces, axis=1)[:, None]
    second, third = (np.take_along_axis(faces, (low + i) % 3, axis=1).ravel() for i in (1, 2))
    way = np.where(second < third, 1, -1)  # the same vertices can be seen from two sides
    _, place = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True)
    place = place.ravel()
    net = np.bincount(place, way)[place]  # of the faces on the same vertices
    candidates = np.flatnonzero(way * net > 0)
    keep = np.zeros(len(faces), dtype=bool)
    keep[candidates[np.unique(place[candidates], return_index=True)[1]]] = True
    return keep


def agreeing(faces: Indices) -> tuple[Indices, int]:
    """Return faces turned so that neighbours agree, where they can, and how many were turned."""
    if not len(faces):
        return faces, 0
    surface = edges(faces)
    turn = to_be_turned(surface, len(faces)) if np.all(surface.faces_at == 2) else None
    if turn is None:
        return faces, 0
    faces = faces.copy()
    faces[turn] = faces[turn][:, ::-1]
    return faces, int(turn.sum())


def looks_inwards(mesh: Mesh) -> bool:
    """Whether a closed surface in one piece, whose faces agree, encloses a negative volume."""
    if not len(mesh.faces):
        return False
    surface = edges(mesh.faces)
    if not np.all(surface.faces_at == 2) or np.any(surface.same_way):
        return False
    return not np.any(connected(surface.neighbours, len(mesh.faces))) and volume(mesh) < 0


def volume(mesh: Mesh) -> float:
    """Return the signed volume that a closed mesh encloses, about its middle."""
    return float(volume_moments(mesh.vertices - mesh.vertices.mean(axis=0), mesh.faces, 0)[0])


def counted(number: int, what: str) -> str:
    """Return a number of things in words; the first word of ``what`` is the thing.

    Examples
    --------
    >>> from binaryast.meshes.mending import counted
    >>> counted(2, "vertex merged")
    '2 vertices merged'
    """
    noun, _, rest = what.partition(" ")
    plural = {"vertex": "vertices"}.get(noun, noun + "s")
    return f"{number} {noun if number == 1 else plural} {rest}".rstrip()
