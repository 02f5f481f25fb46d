"""Whether faces meet, against a linear programme; whether a point is inside, against the solid angle of the faces."""

from fractions import Fraction

import numpy as np
import pytest
from scipy.optimize import linprog

from binaryast.kernels.face_contact import contacts
from binaryast.kernels.inside import windings
from binaryast.kernels.orientation import side_of_line, side_of_plane
from tests import solids


def have_a_common_point(one: np.ndarray, two: np.ndarray) -> bool:
    """Whether two triangles have a point in common: sum l_i a_i = sum m_i b_i with weights that add up to one."""
    equations = np.zeros((5, 6))
    equations[:3, :3], equations[:3, 3:] = one.T, -two.T
    equations[3, :3] = equations[4, 3:] = 1
    return linprog(np.zeros(6), A_eq=equations, b_eq=[0, 0, 0, 1, 1], bounds=(0, None)).status == 0


def has_area(triangle: np.ndarray) -> bool:
    return bool(np.any(np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])))


@pytest.mark.parametrize("flat", [False, True])
def test_pairs_of_triangles_on_a_small_lattice(flat: bool) -> None:
    """Whole coordinates from 0 to 4 give every way to touch: corners on edges and faces, edges on edges, one plane."""
    random = np.random.default_rng(5)
    seen = {True: 0, False: 0}
    while sum(seen.values()) < 300:
        corners = random.integers(0, 4 if flat else 5, size=(2, 3, 3)).astype(float)
        if flat:
            corners[..., 2] = 1
        if len(np.unique(corners.reshape(-1, 3), axis=0)) < 6 or not all(has_area(triangle) for triangle in corners):
            continue
        expected = have_a_common_point(*corners)
        seen[expected] += 1
        vertices = corners.reshape(-1, 3)
        for same in (vertices, vertices[:, [2, 0, 1]] * 0.5, vertices[::-1] * [1024, -1, 0.25] + 4096):
            found = contacts(np.ascontiguousarray(same), np.array([[0, 1, 2], [3, 4, 5]]))
            assert found.tolist() == ([[0, 1]] if expected else []), corners
    assert min(seen.values()) > 30


def test_sides_have_no_round_off() -> None:
    """Points of a plane, and of a line, moved by their last digits: the sign is that of exact arithmetic."""
    random = np.random.default_rng(4)
    signs = set()
    for _ in range(300):
        a, b, c = random.uniform(-1, 1, size=(3, 3)) + 1e3
        p = a + 0.3 * (b - a) + 0.6 * (c - a) + random.integers(-1, 2, size=3) * 1e-13
        rows = [[Fraction(x) - Fraction(y) for x, y in zip(q, a, strict=True)] for q in (b, c, p)]
        (ux, uy, uz), (vx, vy, vz), (dx, dy, dz) = rows
        exact = dx * (uy * vz - uz * vy) + dy * (uz * vx - ux * vz) + dz * (ux * vy - uy * vx)
        assert side_of_plane(*map(tuple, (a, b, c, p))) == np.sign(float(exact))
        assert side_of_line(*map(tuple, (a, b, p)), 0, 1) == np.sign(float(ux * dy - uy * dx))
        signs.add(np.sign(float(exact)))
    assert {-1, 1} <= signs


@pytest.mark.parametrize(
    ("free", "meets"),
    [
        ([(1, -1, -1), (1, 3, 1)], True),  # its free edge goes through the other's and beyond
        ([(0.5, 0.4, -1), (0.5, 0.4, 1)], True),  # and through the other face
        ([(-1, 0, 0), (-1, -1, 0)], False),  # in one plane, on the other side
        ([(1, 0.5, 0), (0.5, 1, 0)], True),  # in one plane, overlapping
        ([(1, 1, 1), (2, 1, 1)], False),
    ],
)
def test_faces_with_one_vertex_in_common(free: list, meets: bool) -> None:
    vertices = np.array([(0, 0, 0), (2, 0, 0), (0, 2, 0), *free], dtype=float)
    expected = [[0, 1]] if meets else []
    assert contacts(vertices, np.array([[0, 1, 2], [0, 3, 4]])).tolist() == expected
    assert contacts(vertices, np.array([[0, 1, 2], [4, 0, 3]])).tolist() == expected


@pytest.mark.parametrize(("free", "meets"), [((0, -1, 0), False), ((0.3, 1, 0), True), ((0.3, 1, 1e-6), False)])
def test_faces_with_an_edge_in_common_may_not_be_folded(free: tuple, meets: bool) -> None:
    vertices = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), free], dtype=float)
    assert len(contacts(vertices, np.array([[0, 1, 2], [1, 0, 3]]))) == meets


def solid_angles(points: np.ndarray, vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return the solid angle of the surface over 4 pi, by A. van Oosterom, J. Strackee, IEEE TBME 30 (1983) 125."""
    a, b, c = (vertices[faces[:, i]][None] - points[:, None] for i in range(3))
    p, q, r = (np.linalg.norm(v, axis=-1) for v in (a, b, c))
    dot = np.einsum
    below = p * q * r + dot("pfi,pfi->pf", a, b) * r + dot("pfi,pfi->pf", b, c) * p + dot("pfi,pfi->pf", c, a) * q
    return np.sum(2 * np.arctan2(dot("pfi,pfi->pf", a, np.cross(b, c)), below), axis=1) / (4 * np.pi)


@pytest.mark.parametrize("solid", [solids.torus(), solids.box(), solids.icosphere(2)])
def test_windings_by_solid_angles(solid: solids.Solid) -> None:
    vertices, faces = solid
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    points = np.random.default_rng(1).uniform(low - 0.1, high + 0.1, size=(500, 3))
    found = windings(points, vertices.astype(float), faces)
    np.testing.assert_allclose(found, solid_angles(points, vertices, faces), atol=1e-9)
    assert set(found.tolist()) == {0, 1}


def test_nothing_slips_through_vertices_and_edges() -> None:
    """Points right below and above vertices, and on lines of the lattice, where a ray along z hits edges."""
    vertices, faces = solids.divided(*solids.divided(*solids.box()))
    lattice = np.stack(np.meshgrid(*3 * [np.linspace(0.125, 0.875, 7)], indexing="ij"), axis=-1).reshape(-1, 3)
    assert np.all(windings(lattice, vertices, faces) == 1)
    for shift in ([0, 0, 1], [1, 0, 0], [0, -1, 0], [0, 0, -1]):
        assert not np.any(windings(lattice + shift, vertices, faces))
    ball, faces = solids.icosphere(3)
    assert np.all(windings(ball * (1 - 1e-9), ball, faces) == 1)
    assert not np.any(windings(ball * (1 + 1e-9), ball, faces))


def test_a_surface_inside_out_winds_the_other_way() -> None:
    vertices, faces = solids.icosphere(1)
    assert windings(np.zeros((1, 3)), vertices, faces[:, ::-1].copy()).tolist() == [-1]
