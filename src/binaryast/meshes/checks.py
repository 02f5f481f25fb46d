"""Whether a mesh is one sound surface: closed, outward, in one piece, nowhere in contact with itself."""

from typing import NamedTuple

import numpy as np

from binaryast.errors import MeshError
from binaryast.kernels.face_contact import MOST, contacts
from binaryast.meshes import Mesh
from binaryast.meshes.mending import counted, looks_inwards, merged, not_twice, repeats_a_vertex
from binaryast.meshes.topology import Edges, connected, edges, pinched_vertices, to_be_turned
from binaryast.units import Indices

THIN = 1e-12  # area of a face over the square of its longest edge, below which it has none


class Defect(NamedTuple):
    """What is wrong with a mesh, with its count; what helps; and whether mending does that."""

    text: str
    remedy: str
    mendable: bool


def refuse(mesh: Mesh, name: str) -> None:
    """Raise, in one line, where a mesh has defects.

    Raises
    ------
    MeshError
        Each defect with its count and what helps.
    """
    found = defects(mesh)
    if not found:
        return
    text = "; ".join(f"{defect.text} ({defect.remedy})" for defect in found)
    if any(defect.mendable for defect in found):
        text += "; to mend: ba.Polyhedron.read(.., mend=True) or ba.Polyhedron.mended(vertices, faces)"
    raise MeshError(f"{name}: the mesh is not one sound surface: {text}")


def defects(mesh: Mesh) -> list[Defect]:
    """Return what is wrong with a mesh whose vertices are finite and whose indices are in range.

    Vertices in one place are taken for one, and faces that mending would remove are left out, before it is looked at
    how the faces hang together; and only a closed surface is looked at as a whole.
    """
    single = merged(mesh)
    kept = np.flatnonzero(~repeats_a_vertex(single.faces))
    different = kept[not_twice(single.faces[kept])]
    clean = Mesh(single.vertices, single.faces[different])
    flat = int(np.sum(without_area(clean)))
    counts = (
        (len(mesh.vertices) - len(np.unique(mesh.faces)), "vertex without a face", "removes"),
        (len(mesh.vertices) - len(single.vertices), "vertex in the place of another", "merges"),
        (len(mesh.faces) - len(kept), "face with a vertex twice", "removes"),
        (len(kept) - len(different), "face in the place of another", "removes"),
    )
    found = [_mendable(number, what, verb) for number, what, verb in counts if number]
    if flat:
        remedy = "three corners on a line: remesh there"
        found.append(Defect(counted(flat, "face without area"), remedy, mendable=False))
    if not len(clean.faces):
        return [*found, Defect("no face is left", "export it again", mendable=False)]
    surface = edges(clean.faces)
    found += _of_edges(surface)
    if np.all(surface.faces_at == 2):
        found += _of_the_whole(clean, surface)
        found += [] if flat else _of_contact(clean, different)
    return found


def _mendable(number: int, what: str, verb: str) -> Defect:
    return Defect(counted(number, what), f"mending {verb} {'it' if number == 1 else 'them'}", mendable=True)


def without_area(mesh: Mesh) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return which faces have no area beside the square of their longest edge."""
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    squares = np.max([np.sum((q - p) ** 2, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) <= 2 * THIN * squares)


def _of_edges(surface: Edges) -> list[Defect]:
    """Return what is wrong with edges, each of which must have two faces."""
    found = []
    if loose := int(np.sum(surface.faces_at == 1)):
        remedy = "the surface is open: close its holes in a mesh editor"
        found.append(Defect(counted(loose, "edge with one face only"), remedy, mendable=False))
    if crowded := int(np.sum(surface.faces_at > 2)):
        remedy = "walls inside, or parts that touch: take them apart in a mesh editor"
        found.append(Defect(counted(crowded, "edge with three faces or more"), remedy, mendable=False))
    return found


def _of_the_whole(clean: Mesh, surface: Edges) -> list[Defect]:
    """Return what is wrong with a closed surface as a whole."""
    found = []
    turn = to_be_turned(surface, len(clean.faces))
    if turn is None:
        found.append(Defect("its faces cannot agree on an outside", "one-sided: export it again", mendable=False))
    elif turn.any():
        found.append(_mendable(int(turn.sum()), "face turned against the neighbours", "turns"))
    elif looks_inwards(clean):
        found.append(Defect("all faces look inwards", "mending turns them", mendable=True))
    pieces = 1 + int(connected(surface.neighbours, len(clean.faces)).max())
    if pieces > 1:
        remedy = "expected one; a core or a hollow is ba.Layered"
        found.append(Defect(f"{pieces} separate surfaces", remedy, mendable=False))
    if pinched := pinched_vertices(clean.faces, surface):
        remedy = "move them apart in a mesh editor"
        found.append(Defect(counted(pinched, "vertex where parts touch in a point"), remedy, mendable=False))
    return found


def _of_contact(clean: Mesh, numbers: Indices) -> list[Defect]:
    """Return what is wrong with faces that meet where they should not; ``numbers`` are those that they were given."""
    meeting = contacts(clean.vertices, clean.faces)
    if not len(meeting):
        return []
    text = counted(len(meeting), "pair of faces that cross or touch")
    one, two = numbers[meeting[0]]
    remedy = f"such as faces {one} and {two}: take them apart in a mesh editor"
    return [Defect(f"at least {text}" if len(meeting) == MOST else text, remedy, mendable=False)]
