"""Meshes from files: OBJ, PLY, STL, tables of the Planetary Data System, pairs of CSV files.

Nothing is changed on the way, but for STL, which has no common vertices: those in exactly one place are merged. PLY and
STL are read by trimesh. OBJ is not, because trimesh doubles vertices along the seams of textures and materials.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from binaryast.errors import MeshError, StorageError
from binaryast.meshes import Mesh
from binaryast.meshes.mending import merged
from binaryast.units import Floats, Indices, brief

Rows = Sequence[Sequence[str]]


def read_mesh(path: Path, facets: Path | None = None) -> Mesh:
    """Return the mesh of a file, by its suffix, in the file's own unit of length.

    Raises
    ------
    StorageError
        Where there is no such file.
    MeshError
        Where it is not understood, or of another kind.
    """
    kind = path.suffix.lower()
    if kind not in READERS and kind != ".csv":
        kinds = ", ".join([*READERS, ".csv"])
        raise MeshError(f"{path}: a mesh of the kind {kind or '(no suffix)'} cannot be read: expected {kinds}")
    for each in (path, facets):
        if each is not None and not each.is_file():
            raise StorageError(f"{each}: {'a folder, not a file' if each.is_dir() else 'no such file'}")
    if kind == ".csv":
        if facets is None:
            raise MeshError(f"{path}: vertices alone are no mesh: give the file of the faces too, facets=")
        return read_csv(path, facets)
    if facets is not None:
        raise MeshError(f"{path}: it holds its faces itself: facets= goes with a .csv of vertices")
    try:
        return READERS[kind](path)
    except MeshError:
        raise
    except Exception as error:  # whatever a broken file makes a reader say
        raise MeshError(f"{path}: not a readable {kind} file: {brief(error) or type(error).__name__}") from None


def read_by_trimesh(path: Path) -> Mesh:
    """Return the mesh of a PLY file as it is."""
    import trimesh

    try:
        loaded = trimesh.load_mesh(str(path), process=False, fix_texture=False, skip_materials=True)
    except ImportError:  # of what it would need to read the file as text, when a binary file is shorter than it says
        raise MeshError(f"{path}: it ends too early, or is no {path.suffix.lower()} file: get it again") from None
    if not len(getattr(loaded, "faces", ())):
        raise MeshError(f"{path}: it has no faces: a cloud of points, a file that was cut off, or of another kind")
    return Mesh(np.array(loaded.vertices, dtype=np.float64), np.array(loaded.faces, dtype=np.int64))


def read_stl(path: Path) -> Mesh:
    """Return the mesh of an STL file, its vertices merged."""
    return merged(read_by_trimesh(path))


def read_obj(path: Path) -> Mesh:
    """Return the mesh of a Wavefront OBJ file: the lines v and f, of which nothing but the vertices matters."""
    rows = _rows(path)
    vertices = _table([row[1:4] for row in rows if row[0] == "v"], path, "vertices")
    faces, seen = [], 0
    for row in rows:
        seen += row[0] == "v"
        if row[0] == "f":
            corners = [int(corner.split("/")[0]) for corner in row[1:]]
            if 0 in corners:
                raise MeshError(f"{path}: a face has the vertex 0: expected numbers from 1, or back from -1")
            faces += _fan([corner - 1 if corner > 0 else seen + corner for corner in corners])  # -1 is the last so far
    return Mesh(vertices, np.array(faces, dtype=np.int64).reshape(-1, 3))


def _fan(corners: list[int]) -> list[list[int]]:
    """Return a polygon as triangles about its first corner."""
    return [[corners[0], *pair] for pair in pairwise(corners[1:])]


def read_tab(path: Path) -> Mesh:
    """Return the mesh of a table of the Planetary Data System, in either of its layouts.

    The vertex-facet layout has a letter in each line: v x y z, then f i j k. The plate model begins with the numbers of
    vertices and plates, in one line or each before its own table, and its rows x y z and i j k may be numbered.
    Vertices are counted from 0 in some of them, from 1 in others: from 0 where a face has the vertex 0.
    """
    rows = [" ".join(row).split() for row in _rows(path, ",")]  # separated by spaces, commas or both
    if rows and rows[0][0] in ("v", "f"):
        vertices = _table([row[1:] for row in rows if row[0] == "v"], path, "vertices")
        return Mesh(vertices, _from_zero(_table([row[1:] for row in rows if row[0] == "f"], path, "faces"), path))
    try:
        counts = [int(word) for word in rows[0]]
        if len(counts) == 2:
            first, start = counts[0], 1 + counts[0]
            last = start + counts[1]
        else:
            (first,) = counts
            (number,) = (int(word) for word in rows[1 + first])
            start, last = 2 + first, 2 + first + number
    except (ValueError, IndexError):
        raise MeshError(
            f"{path}: neither of the two layouts of shape models: expected lines v x y z and f i j k, or first the "
            "numbers of vertices and plates (a grid of latitude, longitude and radius is no mesh)"
        ) from None
    if len(rows) != last:
        raise MeshError(f"{path}: expected {last} lines by the numbers of vertices and plates in it, got {len(rows)}")
    vertices = _numbered(_table(rows[1 : 1 + first], path, "vertices", (3, 4)), path)
    return Mesh(vertices, _from_zero(_numbered(_table(rows[start:], path, "faces", (3, 4)), path), path))


def read_csv(path: Path, facets: Path) -> Mesh:
    """Return the mesh of two CSV files, as GUBAS reads them: any number, x, y, z; and v1, v2, v3, counted from 1.

    A first row without a number, the names of the columns, is skipped.
    """
    one, two = (_without_names(_rows(file, ",")) for file in (path, facets))
    vertices = _table([row[:4] for row in one], path, "vertices", (4,))[:, 1:]
    return Mesh(vertices, _from_zero(_table([row[:3] for row in two], facets, "faces"), facets))


def _without_names(rows: Rows) -> Rows:
    """Return rows without the first where it holds no number."""
    return rows[1:] if rows and not any(_is_number(word) for word in rows[0]) else rows


def _is_number(word: str) -> bool:
    try:
        _number(word)
    except ValueError:
        return False
    return True


def _number(word: str) -> float:
    """Return a number, of which the exponent may also be written as in Fortran."""
    return float(word.replace("D", "E").replace("d", "e"))


def _rows(path: Path, separator: str | None = None) -> list[list[str]]:
    """Return the words of each line of a text file that is neither empty nor a comment, without comments at its end.

    A line that ends in a backslash goes on in the next.
    """
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise StorageError(f"{path}: cannot be read: {(error.strerror or str(error)).lower()}") from None
    lines = (line.split("#")[0] for line in text.replace("\\\n", " ").splitlines())
    return [[word.strip() for word in line.split(separator)] for line in lines if line.strip()]


def _table(rows: Rows, path: Path, what: str, columns: tuple[int, ...] = (3,)) -> Floats:
    """Return rows of words as an array of numbers with as many columns as are allowed."""
    if not rows:
        raise MeshError(f"{path}: it has no {what}")
    width = len(rows[0])
    for row in rows:
        if len(row) != width or width not in columns:
            expected = " or ".join(str(number) for number in columns)
            raise MeshError(f"{path}: {what}: expected {expected} numbers in each line, got {brief(' '.join(row))!r}")
    try:
        return np.array([[_number(word) for word in row] for row in rows])
    except ValueError as error:
        raise MeshError(f"{path}: {what}: {brief(error)}") from None


def _numbered(table: Floats, path: Path) -> Floats:
    """Return a table without the column of row numbers, which must follow each other, where it has one."""
    if table.shape[1] == 3:
        return table
    if np.any(np.diff(table[:, 0]) != 1):
        raise MeshError(f"{path}: the numbers of its rows do not follow each other: expected 1, 2, 3, ...")
    return table[:, 1:]


def _from_zero(faces: Floats, path: Path) -> Indices:
    """Return faces that count their vertices from 0, given such or from 1; a closed mesh uses its first vertex."""
    if np.any(faces != np.round(faces)):
        raise MeshError(f"{path}: faces: expected whole numbers, the indices of three vertices")
    return np.asarray(faces - (0 if np.any(faces == 0) else 1), dtype=np.int64)


READERS: dict[str, Callable[[Path], Mesh]] = {
    ".obj": read_obj,
    ".ply": read_by_trimesh,
    ".stl": read_stl,
    ".tab": read_tab,
}


def as_file(path: Any, name: str) -> Path:
    """Return a path, from whatever a user gives for one."""
    try:
        return Path(path)
    except TypeError:
        raise StorageError(f"{name}: {brief(repr(path))} is not the name of a file") from None
