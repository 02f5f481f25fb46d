"""How the faces of a mesh hang together, whatever its shape: edges, connected surfaces, orientation."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from binaryast.units import Indices


class Edges(NamedTuple):
    """The edges of a mesh. Half-edge h = 3 f + i runs from corner i of face f to the next.

    Attributes
    ----------
    start, end : ndarray
        Vertices (3 F,) between which each half-edge runs.
    faces_at : ndarray
        How many faces each edge has (E,).
    pairs : ndarray
        The two half-edges (k, 2) of each edge that has two faces.
    same_way : ndarray
        Whether the two run the same way (k,), so that one of their faces is turned against the other.
    """

    start: Indices
    end: Indices
    faces_at: Indices
    pairs: Indices
    same_way: NDArray[np.bool_]

    @property
    def neighbours(self) -> Indices:
        """Pairs (k, 2) of faces with an edge between them."""
        return self.pairs // 3


def edges(faces: Indices) -> Edges:
    """Return the edges of a mesh."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    keys = np.minimum(start, end) * (faces.max() + 1) + np.maximum(start, end)
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(np.diff(keys[order], prepend=-1))  # where each edge begins in that order
    faces_at = np.diff(first, append=len(keys))
    double = first[faces_at == 2]
    pairs = np.stack([order[double], order[double + 1]], axis=1)
    return Edges(start, end, faces_at, pairs, start[pairs[:, 0]] == start[pairs[:, 1]])


def connected(links: Indices, count: int) -> Indices:
    """Return a label (count,) for each node, the same for nodes that links (k, 2) join."""
    graph = coo_matrix((np.ones(len(links), dtype=np.int8), (links[:, 0], links[:, 1])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def to_be_turned(surface: Edges, count: int) -> NDArray[np.bool_] | None:
    """Return which of the faces (count,) must be turned so that all agree, the fewer ones of each connected surface.

    None where they cannot agree, as on a Moebius strip. Each face has two nodes, itself and itself turned; neighbours
    that agree join like with like, others crosswise.
    """
    one, two = surface.neighbours.T
    crosswise = surface.same_way * count
    links = np.concatenate([np.stack([one, two + crosswise], 1), np.stack([one + count, two + count - crosswise], 1)])
    labels = connected(links, 2 * count)
    as_is, turned = labels[:count], labels[count:]
    if np.any(as_is == turned):
        return None
    flips = as_is > turned
    component = np.minimum(as_is, turned)
    most = np.bincount(component, flips) > 0.5 * np.bincount(component)
    return np.asarray(flips ^ most[component])


def pinched_vertices(faces: Indices, surface: Edges) -> int:
    """Return at how many vertices of a closed mesh parts of the surface meet in nothing but that vertex.

    The corners of faces are joined across edges; a sound vertex has all its corners in one piece.
    """
    h, g = surface.pairs.T
    after_h, after_g = h - h % 3 + (h + 1) % 3, g - g % 3 + (g + 1) % 3
    one, two = np.where(surface.same_way, g, after_g), np.where(surface.same_way, after_g, g)
    links = np.concatenate([np.stack([h, one], 1), np.stack([after_h, two], 1)])
    fans = np.unique(np.stack([faces.ravel(), connected(links, faces.size)], 1), axis=0)
    return int(np.count_nonzero(np.bincount(fans[:, 0]) > 1))
