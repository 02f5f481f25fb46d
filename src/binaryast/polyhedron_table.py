"""What the kernels of a polyhedron's field need to know of a body: its edges and faces, weighted by density."""

from typing import NamedTuple

import numpy as np

from binaryast.bodies import RigidBody
from binaryast.kernels.polyhedron_field import BLOCK
from binaryast.layered import Layered
from binaryast.polyhedron import Polyhedron
from binaryast.units import Floats


class Layer(NamedTuple):
    """A polyhedron and the share of the body's mass that it has, negative for what is missing in a hollow."""

    shape: Polyhedron
    share: float


def layers_of(body: RigidBody) -> list[Layer] | None:
    """Return the polyhedra that make a body, the outer one first; None where it is not made of polyhedra."""
    shape = body.shape
    if isinstance(shape, Polyhedron):
        return [Layer(shape, 1.0)]
    if isinstance(shape, Layered) and isinstance(shape.outer, Polyhedron) and isinstance(shape.inner, Polyhedron):
        return [Layer(part, share) for part, share in zip((shape.outer, shape.inner), shape.shares, strict=True)]
    return None


def table_of(body: RigidBody, layers: list[Layer]) -> Floats:
    """Return the table of ``kernels/polyhedron_field.py`` in the body frame."""
    edges, faces, radius = [], [], 0.0
    for shape, share in layers:
        assert shape.volume is not None
        weight = body.si.gm * share / shape.volume
        vertices = (shape.vertices.value - body.shape.centre) @ body.turn
        radius = max(radius, float(np.linalg.norm(vertices, axis=1).max()))
        normals, areas2 = normals_of(vertices[shape.faces])
        edges.append(_edge_rows(vertices, shape.faces, normals, weight))
        corners, weights = vertices[shape.faces].reshape(-1, 9), np.full(len(normals), weight)
        faces.append(np.column_stack([corners, normals, areas2, weights]))
    outer = layers[0]
    assert outer.shape.volume is not None
    blocks = [_blocks(np.concatenate(edges), 7), _blocks(np.concatenate(faces), 13)]
    header = [radius, body.si.gm, body.si.gm * outer.share / outer.shape.volume, *(len(part) for part in blocks)]
    return np.concatenate([header, *(part.ravel() for part in blocks)])


def _blocks(rows: Floats, weights: int) -> Floats:
    """Return rows as blocks (k, columns, BLOCK), the last one filled up with copies whose weights are zero."""
    missing = -len(rows) % BLOCK
    copies = np.repeat(rows[-1:], missing, axis=0)
    copies[:, weights:] = 0.0
    return np.swapaxes(np.concatenate([rows, copies]).reshape(-1, BLOCK, rows.shape[1]), 1, 2)


def normals_of(triangles: Floats) -> tuple[Floats, Floats]:
    """Return the outward unit normals (F, 3) of triangles (F, 3, 3) and twice their areas (F,)."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    normals = np.cross(b - a, c - a)
    areas2 = np.linalg.norm(normals, axis=1)
    return normals / areas2[:, None], areas2


def _edge_rows(vertices: Floats, faces: Floats, normals: Floats, weight: float) -> Floats:
    """Return the rows of the edges: both ends, the length, and E = w (n_A m_A + n_B m_B).

    Each edge is met twice, once in each direction: in a closed mesh, sorting by its ends puts the two side by side.
    """
    starts, ends = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    face = np.repeat(np.arange(len(faces)), 3)
    order = np.lexsort((np.maximum(starts, ends), np.minimum(starts, ends)))
    forward, backward = order[::2], order[1::2]
    one, two = vertices[starts[forward]], vertices[ends[forward]]
    lengths = np.linalg.norm(two - one, axis=1)
    along = (two - one) / lengths[:, None]
    dyads = np.zeros((len(one), 3, 3))
    for n, sense in ((normals[face[forward]], 1.0), (normals[face[backward]], -1.0)):
        dyads += n[:, :, None] * (sense * np.cross(along, n))[:, None, :]
    dyads = weight / 2 * (dyads + np.swapaxes(dyads, 1, 2))
    return np.column_stack([one, two, lengths, dyads[:, *np.triu_indices(3)]])
