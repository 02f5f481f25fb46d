"""Polyhedra: their volume, mass centre, inertia and moments against closed forms and exact arithmetic."""

import pickle
import time
from fractions import Fraction
from math import comb, factorial
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.errors import DensityWarning
from binaryast.kernels.moments import count, exponents
from binaryast.kernels.polyhedron import volume_moments
from tests import solids

SHAPES = Path(__file__).parents[2] / "shared" / "shapes"
with_shapes = pytest.mark.skipif(not SHAPES.is_dir(), reason="the shape models are not here")
DENSITY = 2000 * u.kg / u.m**3


def polyhedron(solid: solids.Solid, unit: u.Unit = u.m) -> ba.Polyhedron:
    vertices, faces = solid
    return ba.Polyhedron(vertices * unit, faces)


def box_moments(low: np.ndarray, high: np.ndarray, degree: int) -> np.ndarray:
    """Return the specific moments of a box, whose integrals are products."""
    powers = exponents(degree) + 1
    return np.prod((high**powers - low**powers) / powers, axis=1) / np.prod(high - low)


def test_moments_are_ordered_as_agreed() -> None:
    assert exponents(2).tolist() == [
        *([0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]),
        *([2, 0, 0], [1, 1, 0], [1, 0, 1], [0, 2, 0], [0, 1, 1], [0, 0, 2]),
    ]
    for degree in range(9):
        rows = exponents(degree)
        assert len(rows) == count(degree)
        for at, (i, j, k) in enumerate(rows):
            n = i + j + k
            assert at == n * (n + 1) * (n + 2) // 6 + (n - i) * (n - i + 1) // 2 + k


@pytest.mark.parametrize("middle", [(0.0, 0.0, 0.0), (1.5, -2.0, 0.5), (1e5, -3e5, 2e5)])
def test_a_box(middle: tuple) -> None:
    sizes = np.array([3.0, 2.0, 1.0])
    low, high = np.array(middle) - sizes / 2, np.array(middle) + sizes / 2
    shape = polyhedron(solids.box(low, high))
    assert shape.volume == pytest.approx(6, rel=1e-14)
    np.testing.assert_allclose(shape.centre, middle, rtol=1e-15, atol=1e-15)
    body = ba.RigidBody("box", shape, mass=12e3 * u.kg)
    np.testing.assert_allclose(body.si.moments, [5e3, 10e3, 13e3], rtol=1e-14)
    np.testing.assert_allclose(body.turn, np.eye(3), atol=1e-14)
    moments = shape.moments(8, shape.centre, np.eye(3))
    np.testing.assert_allclose(moments, box_moments(-sizes / 2, sizes / 2, 8), rtol=1e-13, atol=1e-14)


def test_a_box_in_another_frame() -> None:
    low, high = np.array([1.0, 2.0, -1.0]), np.array([4.0, 4.0, 0.5])
    moments = polyhedron(solids.box(low, high)).moments(8, np.zeros(3), np.eye(3))
    np.testing.assert_allclose(moments, box_moments(low, high, 8), rtol=1e-13)
    turn = Rotation.from_euler("zyx", [0.4, -0.3, 0.8]).as_matrix()
    vertices, faces = solids.box(low, high)
    turned = polyhedron((vertices @ turn.T + [7.0, -5.0, 3.0], faces))
    np.testing.assert_allclose(turned.moments(8, np.array([7.0, -5.0, 3.0]), turn), moments, rtol=1e-12)


def test_an_icosahedron() -> None:
    """Edges s: V = 5 (3 + 5^(1/2)) s^3/12, I = golden^2 m s^2/10; no harmonics of degrees 1 to 5."""
    shape = polyhedron(solids.icosahedron())
    assert shape.volume == pytest.approx(5 / 12 * (3 + 5**0.5) * 8, rel=1e-14)
    inertia = solids.GOLDEN**2 * 4 / 10
    np.testing.assert_allclose(shape.specific_inertia, inertia * np.eye(3), rtol=1e-14, atol=1e-14)
    moments = dict(zip(map(tuple, exponents(5).tolist()), shape.moments(5, shape.centre, np.eye(3)), strict=True))
    assert moments[4, 0, 0] == pytest.approx(3 * moments[2, 2, 0], rel=1e-13)
    assert all(abs(value) < 1e-14 for powers, value in moments.items() if any(power % 2 for power in powers))


def test_an_icosphere_becomes_a_sphere() -> None:
    """Its volume and its inertia come nearer to those of the sphere by four with each division."""
    errors = []
    for divisions in (2, 3, 4):
        shape = polyhedron(solids.icosphere(divisions))
        errors.append((4 / 3 * np.pi - shape.volume, 2 / 5 - shape.specific_inertia[0, 0]))
    ratios = np.array(errors[:-1]) / np.array(errors[1:])
    np.testing.assert_allclose(ratios, 4, rtol=0.02)


def exact_moments(vertices: list, faces: list, degree: int) -> list[Fraction]:
    """Return int x^i y^j z^k dV by the theorem of divergence, in fractions.

    It is 1/(i + 1) times the integral of x^(i+1) y^j z^k n_x over the surface; on a face, x is sum l_c x_c, and the
    integral of l^al dS is 2 A al!/(|al| + 2)!.
    """

    def power(values: list[Fraction], n: int) -> dict[tuple, Fraction]:
        result = {}
        for a in range(n + 1):
            for b in range(n - a + 1):
                c = n - a - b
                number = comb(n, a) * comb(n - a, b)
                result[a, b, c] = number * values[0] ** a * values[1] ** b * values[2] ** c
        return result

    def product(one: dict, two: dict) -> dict[tuple, Fraction]:
        result: dict[tuple, Fraction] = {}
        for p, x in one.items():
            for q, y in two.items():
                key = tuple(m + n for m, n in zip(p, q, strict=True))
                result[key] = result.get(key, Fraction(0)) + x * y
        return result

    total = [Fraction(0)] * count(degree)
    for face in faces:
        corners = [[Fraction(value) for value in vertices[v]] for v in face]
        (_, ay, az), (_, by, bz), (_, cy, cz) = corners
        normal = (by - ay) * (cz - az) - (bz - az) * (cy - ay)  # 2 A n_x
        columns = [[corner[axis] for corner in corners] for axis in range(3)]
        powers = [[power(column, n) for n in range(degree + 2)] for column in columns]
        for at, (i, j, k) in enumerate(exponents(degree).tolist()):
            terms = product(product(powers[0][i + 1], powers[1][j]), powers[2][k])
            integral = sum(
                value * factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 2)
                for (a, b, c), value in terms.items()
            )
            total[at] += normal * integral / (i + 1)
    return total


@pytest.mark.parametrize("offset", [0, 5])
def test_moments_in_exact_arithmetic(offset: int) -> None:
    """An irregular solid that is not star-shaped about its origin, by another theorem and without any round-off."""
    random = np.random.default_rng(3)
    vertices, faces = solids.icosahedron()
    vertices = np.round(vertices * random.integers(3, 9, size=(12, 1)) * 4) / 4 + offset
    shape = polyhedron((vertices, faces))
    exact = [float(value) for value in exact_moments(vertices.tolist(), faces.tolist(), 6)]
    found = volume_moments(shape.vertices.value, shape.faces, 6)
    degree = exponents(6).sum(axis=1)
    scale = exact[0] * np.abs(vertices).max() ** degree
    np.testing.assert_allclose(found / scale, exact / scale, rtol=0, atol=2e-15)
    assert np.abs(found / exact - 1).max() < 1e-13


def test_a_torus_is_as_good_as_a_ball() -> None:
    shape = polyhedron(solids.torus(96, 64))
    assert shape.volume == pytest.approx(2 * np.pi**2 * 3, rel=3e-3)
    np.testing.assert_allclose(shape.centre, 0, atol=1e-14)
    assert shape.contains([[3, 0, 0], [0, 0, 0], [0, 0, 5], [0, -2.5, 0.3]] * u.m).tolist() == [
        True,
        False,
        False,
        True,
    ]


@with_shapes
def test_kleopatra_is_not_star_shaped() -> None:
    """Tetrahedra of the mass centre and a face with unsigned volumes make 1.41 % too much mass: signed ones do not."""
    shape = ba.Polyhedron.read(SHAPES / "kleopatra.obj", u.km)
    assert shape.volume == pytest.approx(708868e9, rel=1e-6)
    vertices, faces = shape.vertices.value - shape.centre, shape.faces
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    determinants = np.einsum("fi,fi->f", a, np.cross(b, c))
    assert np.sum(determinants < 0) == 189
    assert np.sum(np.abs(determinants)) / np.sum(determinants) - 1 == pytest.approx(0.0141, abs=5e-5)

    def second(weights: np.ndarray) -> np.ndarray:
        s = a + b + c
        return np.einsum("f,fij->ij", weights / 120, sum(p[:, :, None] * p[:, None, :] for p in (a, b, c, s)))

    inertia = {name: np.trace(s) * np.eye(3) - s for name, s in (
        ("signed", second(determinants)), ("unsigned", second(np.abs(determinants)))
    )}  # fmt: skip
    np.testing.assert_allclose(shape.specific_inertia * shape.volume, inertia["signed"], rtol=1e-11, atol=1e-3)
    excess = np.diag(inertia["unsigned"]) / np.diag(inertia["signed"]) - 1
    assert excess.min() == pytest.approx(0.007, abs=1e-3)
    assert excess.max() == pytest.approx(0.018, abs=1e-3)


@with_shapes
@pytest.mark.parametrize(
    ("name", "volume", "vertices", "faces"),
    [
        ("a66391_1999kw4_primary.obj", 1.19531, 4586, 9168),
        ("a66391_1999kw4_secondary.obj", 0.0480345, 1148, 2292),
        ("itokawa_8.obj", 0.0172887, 386, 768),
        ("itokawa_16.obj", 0.017616, 1538, 3072),
    ],
)
def test_published_shapes_are_sound(name: str, volume: float, vertices: int, faces: int) -> None:
    shape = ba.Polyhedron.read(SHAPES / name, u.km)
    assert (len(shape.vertices), len(shape.faces)) == (vertices, faces)
    assert shape.volume == pytest.approx(volume * 1e9, rel=4e-6)


@with_shapes
def test_shapes_brought_to_their_principal_axes_by_others() -> None:
    """The same bodies as derived elsewhere, as pairs of CSV files in metres, and in the publishers' own axes."""
    for part in ("primary", "secondary"):
        given = ba.Polyhedron.read(SHAPES / f"a66391_1999kw4_{part}.obj", u.km)
        folder = SHAPES / "kw4_aligned"
        vertices, facets = folder / f"kw4_{part}_vert_m.csv", folder / f"kw4_{part}_facet.csv"
        aligned = ba.Polyhedron.read(vertices, u.m, facets=facets)
        assert aligned.volume == pytest.approx(given.volume, rel=1e-9)
        np.testing.assert_allclose(aligned.centre, 0, atol=1e-6)
        one, two = (ba.RigidBody("x", shape, density=DENSITY) for shape in (given, aligned))
        np.testing.assert_allclose(two.turn, np.eye(3), atol=1e-8)
        np.testing.assert_allclose(np.sort(one.si.moments), np.sort(two.si.moments), rtol=1e-8)
    didymos = ba.Polyhedron.read(SHAPES / "Didymos_A_vert_met.csv", u.m, facets=SHAPES / "Didymos_A_facet.csv")
    assert didymos.volume == pytest.approx(0.248548e9, rel=1e-6)


@with_shapes
def test_moments_are_fast() -> None:
    shape = ba.Polyhedron.read(SHAPES / "a66391_1999kw4_primary.obj", u.km)
    times = []
    for _ in range(5):
        start = time.perf_counter()
        shape.moments(8, shape.centre, np.eye(3))
        times.append(time.perf_counter() - start)
    assert min(times) < 20e-3


def test_the_surface_is_an_ellipsoid_of_equal_volume_and_axes() -> None:
    vertices, faces = solids.icosphere(4)
    turn = Rotation.from_euler("zx", [0.3, 0.5]).as_matrix()
    shape = polyhedron(((vertices * [300.0, 200.0, 150.0]) @ turn.T + 40.0, faces))
    body = ba.RigidBody("x", shape, density=DENSITY)
    ((centre, matrix),) = body.surface
    np.testing.assert_allclose(centre, 0, atol=1e-10)
    np.testing.assert_allclose(np.sqrt(np.diag(matrix)), [300, 200, 150], rtol=2e-3)
    assert 4 / 3 * np.pi * np.sqrt(np.linalg.det(matrix)) == pytest.approx(shape.volume, rel=1e-12)
    assert np.linalg.norm(body.corners, axis=1).max() <= body.bounding_radius * (1 + 1e-12)


def test_a_unit_that_cannot_be_right_is_warned_of() -> None:
    vertices, faces = solids.icosphere(2)
    shape = ba.Polyhedron(vertices * u.m, faces)  # meant as km
    with pytest.warns(DensityWarning, match="is its unit right") as caught:
        ba.RigidBody("rock", shape, mass=8e12 * u.kg)
    text = str(caught[0].message)
    assert "kg/m3" in text
    assert "times longer" in text
    assert "\n" not in text
    with pytest.warns(DensityWarning, match="times shorter"):
        ba.RigidBody("rock", ba.Polyhedron(vertices * u.km, faces), gm=1 * u.m**3 / u.s**2)
    ba.RigidBody("rock", ba.Polyhedron(vertices * u.km, faces), mass=8e12 * u.kg)
    ba.RigidBody("rock", shape, density=1 * u.kg / u.m**3)  # a density that was given is what was meant


def moshup() -> tuple[ba.System, ba.State]:
    """Return two polyhedra of the sizes of 1999 KW4, and a circular orbit."""
    bodies = []
    for name, axes, mass in (("Alpha", (760, 750, 670), 2.353e12), ("Beta", (285, 230, 175), 1.35e11)):
        vertices, faces = solids.icosphere(2)
        bumps = 1 + 0.03 * np.sin(7 * vertices).sum(axis=1, keepdims=True)
        bodies.append(ba.RigidBody(name, ba.Polyhedron(vertices * bumps * axes * u.m, faces), mass=mass * u.kg))
    system = ba.System(bodies)
    return system, ba.State.circular_orbit(system, period=17.42 * u.h, spins=[2.7645 * u.h, "synchronous"])


def test_polyhedra_run_and_come_back_from_files(tmp_path: Path) -> None:
    system, state = moshup()
    run = ba.propagate(system, state, duration=6 * u.h, integrator=ba.LGVI(30 * u.s), save_every=1 * u.h)
    run.check(energy=1e-7, momentum=1e-12, rotation=1e-14)
    again = ba.Trajectory.read(run.write(tmp_path / "run.h5"))
    for one, two in zip(run.system.bodies, again.system.bodies, strict=True):
        assert repr(two.shape) == repr(one.shape)
        np.testing.assert_array_equal(two.shape.vertices.value, one.shape.vertices.value)
        np.testing.assert_array_equal(two.shape.faces, one.shape.faces)
        np.testing.assert_array_equal(two.si.moments, one.si.moments)
    ax = ba.plotting.orbit(again)
    assert len(ax.patches) == 2
    one, two = (ba.propagate(s.system, s[-1], duration=1 * u.h, integrator=s.integrator) for s in (run, again))
    np.testing.assert_array_equal(one.si.position, two.si.position)


def test_polyhedra_are_frozen_and_pickle() -> None:
    shape = polyhedron(solids.icosphere(1))
    again = pickle.loads(pickle.dumps(shape))
    np.testing.assert_array_equal(again.vertices.value, shape.vertices.value)
    with pytest.raises(ValueError, match="read-only"):
        shape.faces[0, 0] = 1
    with pytest.raises(ValueError, match="read-only"):
        shape.vertices.value[0, 0] = 1
    vertices, faces = solids.box()
    given = vertices * u.m
    kept = ba.Polyhedron(given, faces)
    given[0], faces[0] = 7 * u.m, 0
    assert kept.vertices.value[0].tolist() == [0, 0, 0]
    assert kept.faces[0].tolist() == [0, 1, 3]
