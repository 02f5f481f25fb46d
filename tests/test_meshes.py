"""Meshes: what files hold, what is wrong with a mesh, in one line, and what mending does."""

import struct
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.errors import InputError, MeshError, MeshWarning, StorageError, UnitError
from tests import solids
from tests.test_polyhedron import SHAPES, polyhedron, with_shapes

NO_FACES = np.zeros((0, 3), dtype=int)


def lines(
    vertices: np.ndarray, faces: np.ndarray, base: int, vertex: str = "", face: str = "", number: bool = False
) -> list:
    """Return the rows of both tables: after a word, or after their numbers."""
    rows = [f"{vertex} {i + base if number else ''} {x} {y} {z}" for i, (x, y, z) in enumerate(vertices)]
    return rows + [
        f"{face} {i + base if number else ''} {a + base} {b + base} {c + base}" for i, (a, b, c) in enumerate(faces)
    ]


def stl(vertices: np.ndarray, faces: np.ndarray) -> bytes:
    """Return a binary STL file."""
    records = (struct.pack("<12fH", 0, 0, 0, *vertices[face].ravel(), 0) for face in faces)
    return bytes(80) + struct.pack("<I", len(faces)) + b"".join(records)


def ply(vertices: np.ndarray, faces: np.ndarray) -> str:
    head = f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz")
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    return (
        head + "\n".join([*(f"{x} {y} {z}" for x, y, z in vertices), *(f"3 {a} {b} {c}" for a, b, c in faces)]) + "\n"
    )


VERTICES, BOX_FACES = solids.box((-1, 0, 0.5), (2, 4, 1))
SIZES = f"{len(VERTICES)} {len(BOX_FACES)}"
ROWS = {base: lines(VERTICES, BOX_FACES, base) for base in (0, 1)}
NUMBERED = lines(VERTICES, BOX_FACES, 1, number=True)
VERTEX_LINES = lines(VERTICES, NO_FACES, 1, "v")
TEXTURED = [
    f"usemtl m{i % 2}\nf {a + 1}/{1 + i % 2}/1 {b + 1}/1/1 {c + 1}/2/1" for i, (a, b, c) in enumerate(BOX_FACES)
]
SQUARES = ["f 1 2 4 3", "f 5 7 8 6", "f 1 5 6 2", "f 3 4 8 7", "f 1 3 7 5", "f 2 6 8 4"]
FILES: dict[str, str | bytes] = {
    "plain.obj": "\n".join(["# a box", "o box", *lines(VERTICES, BOX_FACES, 1, "v", "f")]) + "\n",
    "textured.obj": "\n".join([*VERTEX_LINES, "vt 0 0", "vt 1 1", "vn 0 0 1", *TEXTURED]),
    "backwards.obj": "\n".join([*VERTEX_LINES, *(f"f {a - 8} {b - 8} {c - 8}" for a, b, c in BOX_FACES)]),
    "comments.obj": "\n".join(
        [
            *(f"{line} # so" for line in VERTEX_LINES),
            *(f"f {a + 1} {b + 1} \\\n {c + 1}  # it" for a, b, c in BOX_FACES),
        ]
    ),
    "squares.obj": "\n".join([*VERTEX_LINES, *SQUARES]),
    "box.ply": ply(VERTICES, BOX_FACES),
    "box.stl": stl(VERTICES, BOX_FACES),
    "vertex_facet_0.tab": "\r\n".join(lines(VERTICES, BOX_FACES, 0, "v", "f")) + "\r\n",
    "vertex_facet_1.tab": "\n".join(lines(VERTICES, BOX_FACES, 1, "v", "f")),
    "plates_0.tab": "\n".join([SIZES, *ROWS[0]]),
    "plates_1.TAB": "\n".join([SIZES, *ROWS[1]]).replace("0.5", "5.0D-01"),
    "commas.tab": "\n".join([SIZES, *ROWS[1]]).strip().replace("\n ", "\n").replace(" ", ", "),
    "numbered.tab": "\n".join([SIZES, *NUMBERED]),
    "numbers_before_each.tab": "\n".join(["8", *NUMBERED[:8], "12", *NUMBERED[8:]]),
}


@pytest.mark.parametrize("name", FILES)
def test_every_kind_of_file_holds_the_same_box(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    data = FILES[name]
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    shape = ba.Polyhedron.read(path, unit=u.km)
    assert shape.volume == pytest.approx(6e9, rel=1e-14)
    np.testing.assert_allclose(shape.centre, [500, 2000, 750], rtol=1e-14)
    if name != "box.stl":  # its vertices are in the order in which faces name them
        np.testing.assert_array_equal(shape.vertices.to_value("km"), VERTICES)
    if name not in ("box.stl", "squares.obj"):
        np.testing.assert_array_equal(shape.faces, BOX_FACES)
    assert len(shape.vertices) == 8


def test_a_pair_of_csv_files(tmp_path: Path) -> None:
    one, two = tmp_path / "vertices.csv", tmp_path / "facets.csv"
    one.write_text("\n".join(f"0,{x},{y},{z}" for x, y, z in VERTICES))
    two.write_text("\n".join(f"{a + 1},{b + 1},{c + 1},," for a, b, c in BOX_FACES))
    shape = ba.Polyhedron.read(one, u.m, facets=two)
    np.testing.assert_array_equal(shape.vertices.value, VERTICES)
    np.testing.assert_array_equal(shape.faces, BOX_FACES)
    with pytest.raises(MeshError, match="facets="):
        ba.Polyhedron.read(one, u.m)
    one.write_text("number, x, y, z\n" + one.read_text())
    two.write_text("v1,v2,v3,,\n" + two.read_text())
    np.testing.assert_array_equal(ba.Polyhedron.read(one, u.m, facets=two).vertices.value, VERTICES)


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a.txt", "", "a mesh of the kind .txt cannot be read: expected .obj, .ply, .stl, .tab, .csv"),
        ("a", "", "no suffix"),
        ("a.obj", "", "it has no vertices"),
        ("a.obj", "v 0 0 0\n", "0 faces enclose nothing"),
        ("a.obj", "v 0 0\n", "expected 3 numbers in each line, got '0 0'"),
        ("a.obj", "v 0 0 x\n", "could not convert string to float: 'x'"),
        ("a.obj", "v 0 0 nan\nf 1 1 1\nf 1 1 1\nf 1 1 1\nf 1 1 1", "expected finite values"),
        ("a.obj", "v 0 0 0\nf 0 1 2\n", "vertex 0: expected numbers from 1"),
        ("a.obj", "v 0 0 0\nf 1 2 3\nf 1 2 3\nf 1 2 3\nf 1 2 3", "there is no vertex 2: the 1 vertices"),
        ("a.ply", "ply\n", "not a readable .ply file"),
        ("a.ply", ply(VERTICES, NO_FACES), "it has no faces: a cloud of points"),
        ("a.stl", "solid", "a.stl: "),
        ("a.tab", "-90 0 1\n-90 5 1\n", "neither of the two layouts"),
        ("a.tab", "", "neither of the two layouts"),
        ("a.tab", "2 1\n0 0 0\n", "expected 4 lines by the numbers of vertices and plates in it, got 2"),
        ("a.tab", "2\n1 0 0 0\n", "neither of the two layouts"),
        ("a.tab", "1 1\n0 0 0\n1.5 1 1\n", "expected whole numbers"),
        ("a.tab", "2 1\n1 0 0 0\n3 0 0 0\n1 1 1 1\n", "do not follow each other"),
        ("a.tab", "1 1\n0 0\n1 1 1\n", "expected 3 or 4 numbers in each line"),
    ],
)
def test_one_line_for_each_broken_file(name: str, text: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        ba.Polyhedron.read(path, unit=u.km)
    assert says in str(caught.value)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("length", [60, 90, 300])
def test_a_binary_file_that_was_cut_off(length: int, tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    path.write_bytes(stl(VERTICES, BOX_FACES)[:length])
    with pytest.raises(MeshError, match=r"ends too early|cut off") as caught:
        ba.Polyhedron.read(path, unit=u.km)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_files_that_are_not_there(tmp_path: Path) -> None:
    with pytest.raises(StorageError, match="no such file"):
        ba.Polyhedron.read(tmp_path / "none.obj", u.km)
    with pytest.raises(StorageError, match="is not the name of a file"):
        ba.Polyhedron.read(3, u.km)
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(StorageError, match="a folder"):
        ba.Polyhedron.read(tmp_path / "folder.obj", u.km)
    (tmp_path / "a.obj").write_text("")
    with pytest.raises(MeshError, match="it holds its faces itself"):
        ba.Polyhedron.read(tmp_path / "a.obj", u.km, facets=tmp_path / "a.obj")


@pytest.mark.parametrize("unit", [None, 1, 1000.0, u.kg, "furlongs and more", 1 * u.km])
def test_a_unit_of_length_is_needed(unit: object, tmp_path: Path) -> None:
    (tmp_path / "box.obj").write_text(FILES["plain.obj"])
    with pytest.raises(UnitError, match=r"unit: expected the unit of a length such as u\.m"):
        ba.Polyhedron.read(tmp_path / "box.obj", unit)


@pytest.mark.parametrize(
    ("vertices", "faces", "says"),
    [
        (VERTICES, BOX_FACES, "has no unit|expected a length"),
        (VERTICES * u.kg, BOX_FACES, "is not a length"),
        (VERTICES[:, :2] * u.m, BOX_FACES, "vertices: expected an array of shape"),
        (VERTICES[0] * u.m, BOX_FACES, "vertices: expected an array of shape"),
        (np.where(VERTICES == 4, np.nan, VERTICES) * u.m, BOX_FACES, "finite"),
        (VERTICES * 1e30 * u.m, BOX_FACES, "a size of 4e.30 m is beyond what can be computed with"),
        (VERTICES * 1e-30 * u.m, BOX_FACES, "a size of 4e-30 m is beyond what can be computed with"),
        (VERTICES * 0 * u.m, BOX_FACES, "7 vertices in the place of another"),
        (np.zeros((0, 3)) * u.m, BOX_FACES, "no vertex 7"),
        (VERTICES * u.m, BOX_FACES[:, :2], "faces: expected an array of shape"),
        (VERTICES * u.m, [[0, 1], [0, 1, 2]], "rows of different lengths"),
        (VERTICES * u.m, BOX_FACES * 1.0, "whole numbers"),
        (VERTICES * u.m, np.zeros((0, 3), dtype=int), "0 faces enclose nothing"),
        (VERTICES * u.m, BOX_FACES[:3], "3 faces enclose nothing"),
        (VERTICES * u.m, BOX_FACES + 1, "no vertex 8: .* they seem to count from 1, subtract 1"),
        (VERTICES * u.m, BOX_FACES - 1, "no vertex -1"),
        (VERTICES * u.m, BOX_FACES + 5, "no vertex 12"),
    ],
)
def test_arrays_that_are_no_mesh(vertices: object, faces: object, says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        ba.Polyhedron(vertices, faces)
    assert "\n" not in str(caught.value)


def moved(solid: solids.Solid, vertex: int, to: tuple) -> solids.Solid:
    vertices, faces = solid[0].copy(), solid[1]
    vertices[vertex] = to
    return vertices, faces


def turned(solid: solids.Solid, faces_turned: list) -> solids.Solid:
    vertices, faces = solid[0], solid[1].copy()
    faces[faces_turned] = faces[faces_turned][:, ::-1]
    return vertices, faces


def pitted(depth: float) -> solids.Solid:
    """Return a box with a pit in its top, whose deepest point is at a height above the bottom."""
    vertices, faces = solids.divided(*solids.box())
    top = next(i for i, v in enumerate(vertices) if v.tolist() == [0.5, 0.5, 1])
    return moved((vertices, faces), top, (0.5, 0.45, depth))


BALL = solids.icosphere(2)


def with_vertices(*more: tuple) -> solids.Solid:
    """Return the ball with vertices that no face uses."""
    return solids.together(BALL, (np.array(more), NO_FACES))


def with_faces(*more: tuple) -> solids.Solid:
    return BALL[0], np.concatenate([BALL[1], more])


def unmerged() -> solids.Solid:
    """Return the ball with three vertices for each face alone."""
    return BALL[0][BALL[1]].reshape(-1, 3), np.arange(BALL[1].size).reshape(-1, 3)


def with_a_fin() -> solids.Solid:
    """Return the ball with a face that stands out from an edge."""
    vertices, faces = with_vertices((2, 2, 2))
    return vertices, np.concatenate([faces, [(*faces[0, :2], len(vertices) - 1)]])


def joined_in_a_point() -> solids.Solid:
    """Return two tetrahedra with one vertex in common."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]])
    one = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    return vertices, np.array([*one, (0, 4, 5), (0, 6, 4), (0, 5, 6), (4, 6, 5)])


def one_sided() -> solids.Solid:
    """Return the projective plane of six vertices."""
    about_0 = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 1)]
    others = [(1, 2, 4), (2, 3, 5), (3, 4, 1), (4, 5, 2), (5, 1, 3)]
    return solids.icosahedron()[0][[0, 1, 2, 4, 6, 8]], np.array([*about_0, *others])


def flattened() -> solids.Solid:
    """Return the ball without thickness, no vertex above another."""
    vertices, faces = solids.icosphere(3)
    return vertices @ Rotation.from_euler("xy", [0.3, 0.7]).as_matrix() * [1, 1, 0], faces


DEFECTS = {
    "unused": (with_vertices((5, 5, 5), (6, 6, 6)), "2 vertices without a face (mending removes them)"),
    "one unused": (with_vertices((9, 9, 9)), "1 vertex without a face (mending removes it)"),
    "unmerged": (unmerged(), "798 vertices in the place of another (mending merges them)"),
    "corner twice": (with_faces((0, 0, 1), (2, 2, 2)), "2 faces with a vertex twice (mending removes them)"),
    "twice": (with_faces(*BALL[1][[4, 7]][:, [1, 2, 0]]), "2 faces in the place of another"),
    "open": ((BALL[0], BALL[1][1:]), "3 edges with one face only (the surface is open: close its holes"),
    "a fin": (with_a_fin(), "1 edge with three faces or more"),
    "flipped": (turned(BALL, [3, 200]), "2 faces turned against the neighbours (mending turns them)"),
    "one flipped": (turned(BALL, [3]), "1 face turned against the neighbours (mending turns it)"),
    "inside out": ((BALL[0], BALL[1][:, ::-1]), "all faces look inwards (mending turns them)"),
    "two bodies": (solids.together(BALL, (BALL[0] + 5, BALL[1])), "2 separate surfaces (expected one"),
    "nested": (solids.together(BALL, (BALL[0] / 2, BALL[1])), "a core or a hollow is ba.Layered"),
    "two that cross": (solids.together(BALL, (BALL[0] + 0.5, BALL[1])), "pairs of faces that cross or touch"),
    "in a point": (joined_in_a_point(), "1 vertex where parts touch in a point"),
    "through itself": (moved(BALL, 0, tuple(-1.5 * BALL[0][0])), "pairs of faces that cross or touch (such as faces"),
    "through the bottom": (pitted(-0.2), "pairs of faces that cross or touch"),
    "onto the bottom": (pitted(0.0), "pairs of faces that cross or touch"),
    "flat": ((BALL[0] * [1, 1, 0], BALL[1]), "no face is left"),
    "flattened": (flattened(), "at least 1000 pairs of faces that cross or touch"),
    "one-sided": (one_sided(), "its faces cannot agree on an outside"),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_each_defect_is_named_with_its_count(name: str) -> None:
    (vertices, faces), says = DEFECTS[name]
    with pytest.raises(MeshError) as caught:
        ba.Polyhedron(vertices * u.m, faces)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_faces_without_area() -> None:
    vertices, faces = solids.divided(*solids.box())
    a, b, c = faces[0]
    flat = moved((vertices, faces), a, tuple((vertices[b] + vertices[c]) / 2))
    with pytest.raises(MeshError, match=r"1 face without area \(three corners on a line: remesh there\)"):
        polyhedron(flat)


def test_a_pit_that_ends_above_the_bottom_is_sound() -> None:
    for height in (0.5, 1e-3, 1e-9):
        assert polyhedron(pitted(height)).volume < 1


def test_faces_in_one_plane_are_not_taken_for_contact() -> None:
    """A box of many faces, turned and far from the origin, so that round-off bends each of its planes."""
    random = np.random.default_rng(2)
    vertices, faces = solids.divided(*solids.divided(*solids.box((-3, -2, -1), (3, 2, 1))))
    for turn in Rotation.random(20, random_state=3).as_matrix():
        shift = random.uniform(-1e5, 1e5, size=3)
        assert polyhedron((vertices @ turn.T + shift, faces)).volume == pytest.approx(48, rel=1e-9)


def test_a_mesh_can_have_several_defects() -> None:
    vertices, faces = turned(BALL, [3])
    vertices = np.vstack([vertices, [[9, 9, 9]]])
    with pytest.raises(MeshError, match=r"1 vertex without a face .*; 1 face turned .*; to mend: ") as caught:
        ba.Polyhedron(vertices * u.m, faces)
    assert "ba.Polyhedron.mended" in str(caught.value)


@pytest.mark.parametrize("name", ["unused", "unmerged", "corner twice", "twice", "flipped", "inside out"])
def test_what_can_be_mended(name: str) -> None:
    (vertices, faces), _ = DEFECTS[name]
    with pytest.warns(MeshWarning, match="mended: ") as caught:
        shape = ba.Polyhedron.mended(vertices * u.m, faces)
    assert len(shape.vertices) == len(BALL[0])
    assert len(shape.faces) == len(BALL[1])
    assert shape.volume == pytest.approx(polyhedron(BALL).volume, rel=1e-14)
    assert "\n" not in str(caught[0].message)


def test_what_mending_says() -> None:
    vertices, faces = DEFECTS["unmerged"][0]
    vertices = np.vstack([vertices, [[9, 9, 9]]])
    with pytest.warns(MeshWarning) as caught:
        ba.Polyhedron.mended(vertices * u.m, faces[:, ::-1])
    assert str(caught[0].message) == (
        "Polyhedron: mended: 798 vertices merged with another in the same place, 1 vertex removed that no face uses, "
        "all faces turned outwards"
    )


def test_a_sound_mesh_is_left_as_it_is() -> None:
    shape = ba.Polyhedron.mended(BALL[0] * u.m, BALL[1])
    np.testing.assert_array_equal(shape.vertices.value, BALL[0])
    np.testing.assert_array_equal(shape.faces, BALL[1])


@pytest.mark.parametrize("name", ["open", "a fin", "two bodies", "in a point", "through itself", "one-sided"])
def test_what_cannot_be_mended(name: str) -> None:
    (vertices, faces), says = DEFECTS[name]
    with pytest.raises(MeshError) as caught:
        ba.Polyhedron.mended(vertices * u.m, faces)
    assert says in str(caught.value)


@with_shapes
def test_ryugu_has_vertices_without_a_face() -> None:
    path = SHAPES / "ryugu_test.obj"
    with pytest.raises(MeshError, match="surface: 8 vertices without a face") as caught:
        ba.Polyhedron.read(path, u.km)
    assert str(caught.value).startswith(str(path))
    with pytest.warns(MeshWarning, match="ryugu_test.obj: mended: 8 vertices removed that no face uses"):
        shape = ba.Polyhedron.read(path, u.km, mend=True)
    assert shape.volume == pytest.approx(0.376881e9, rel=2e-6)
