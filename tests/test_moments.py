"""Moments of bodies: of every shape, in the body frame, given by the user, and what follows from a given inertia."""

import pickle
from math import factorial

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import lpmv

import binaryast as ba
from binaryast.errors import DensityWarning, InputError, ScenarioError
from binaryast.kernels import moments as monomials
from binaryast.kernels.harmonics import harmonic_moments
from binaryast.scenario import loads
from tests.solids import box

TURN = Rotation.from_rotvec([0.3, -0.5, 0.8]).as_matrix()
ROCK = 2000 * u.kg / u.m**3
X = np.array([900.0, 500.0, -300.0])


def quadrature(axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return points and weights that integrate polynomials of degree 9 exactly over a homogeneous ellipsoid."""
    z, wz = np.polynomial.legendre.leggauss(6)
    radius, wr = np.polynomial.legendre.leggauss(8)
    phi = np.arange(12) * np.pi / 6
    r, ct, p = (grid.ravel() for grid in np.meshgrid((radius + 1) / 2, z, phi))
    weight = (np.meshgrid(wr, wz, np.ones(12))[0] * np.meshgrid(wr, wz, np.ones(12))[1]).ravel() * r**2
    st = np.sqrt(1 - ct**2)
    return np.stack([r * st * np.cos(p), r * st * np.sin(p), r * ct], axis=1) * axes, weight / weight.sum()


def test_an_ellipsoid() -> None:
    axes = np.array([5.0, 4.0, 3.0])
    body = ba.RigidBody("E", ba.Ellipsoid(*(axes * u.m)), mass=2 * u.kg)
    points, weights = quadrature(axes)
    expected = monomials.of_points(points, weights, 9)
    np.testing.assert_allclose(body.moments(9), expected, rtol=1e-12, atol=1e-10)
    assert not np.any(body.moments(9)[np.any(monomials.exponents(9) % 2, axis=1)])
    np.testing.assert_array_equal(body.moments(4), body.moments(9)[: monomials.count(4)])
    moved = body.shape.moments(6, np.array([1.0, -2.0, 0.5]), TURN)
    expected = monomials.of_points((points - [1.0, -2.0, 0.5]) @ TURN, weights, 6)
    np.testing.assert_allclose(moved, expected, rtol=1e-12, atol=1e-10)


def test_spheres_points_and_dumbbells() -> None:
    sphere = ba.Sphere(2 * u.m).moments(4, np.array([1.0, 0, 0]), np.eye(3))
    ellipsoid = ba.Ellipsoid(2 * u.m, 2 * u.m, 2 * u.m).moments(4, np.array([1.0, 0, 0]), np.eye(3))
    np.testing.assert_allclose(sphere, ellipsoid, rtol=1e-15)
    point = ba.Point().moments(3, np.array([1.0, 2, 3]), np.eye(3))
    np.testing.assert_allclose(point, monomials.of_points(-np.array([[1.0, 2, 3]]), np.ones(1), 3))
    assert ba.RigidBody("P", ba.Point(), mass=1 * u.kg).moments(2).tolist() == [1] + 9 * [0]
    body = ba.RigidBody("D", ba.Dumbbell(6 * u.m, 1 * u.m), mass=3 * u.kg)
    np.testing.assert_allclose(body.moments(2), [1, 0, 0, 0, 9.2, 0, 0, 0.2, 0, 0.2], atol=1e-15)


SHAPES = {
    "ellipsoid": ba.Ellipsoid(90 * u.m, 60 * u.m, 50 * u.m),
    "dumbbell": ba.Dumbbell(90 * u.m, 20 * u.m),
    "cloud": ba.PointCloud(np.random.default_rng(0).normal(size=(6, 3)) * 50 * u.m),
    "union": ba.Union(
        [
            ba.Part(ba.Ellipsoid(90 * u.m, 60 * u.m, 50 * u.m), density=ROCK),
            ba.Part(ba.Sphere(40 * u.m), density=ROCK, offset=[110, 10, 0] * u.m),
            ba.Part(ba.Ellipsoid(30 * u.m, 15 * u.m, 10 * u.m), mass=1e8 * u.kg, offset=[0, -70, 20] * u.m, turn=TURN),
        ]
    ),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_a_body_is_about_its_mass_centre_and_principal_axes(shape: str) -> None:
    """By construction, not only in figures; and the shape says the same up to round-off."""
    body = ba.RigidBody("B", SHAPES[shape], mass=3e9 * u.kg)
    own = SHAPES[shape].moments(5, SHAPES[shape].centre, body.turn)
    assert body.moments(5)[[1, 2, 3, 5, 6, 8]].tolist() == 6 * [0]
    size = np.sqrt(own[4:10].max())
    scale = size ** monomials.exponents(5).sum(axis=1)
    np.testing.assert_allclose(body.moments(5) / scale, own / scale, atol=1e-14)
    inertia = monomials.specific_inertia(monomials.second_degree(body.moments(2)))
    np.testing.assert_allclose(np.diag(inertia) * body.si.mass, body.si.moments, rtol=1e-14)


def test_a_given_inertia_rules_the_second_degree_alone() -> None:
    shape, matrix = SHAPES["ellipsoid"], TURN @ np.diag([2.0, 2.5, 3.0]) @ TURN.T * 1e12
    plain = ba.RigidBody("A", shape, mass=1e9 * u.kg)
    body = ba.RigidBody("A", shape, mass=1e9 * u.kg, inertia=matrix * u.kg * u.m**2)
    xx, _, _, yy, _, zz = body.moments(4)[4:10] * 1e9
    np.testing.assert_allclose([yy + zz, xx + zz, xx + yy], body.si.moments, rtol=1e-14)
    turned = monomials.moved(plain.moments(4), 4, np.zeros(3), body.turn)
    np.testing.assert_allclose(body.moments(4)[10:], turned[10:], atol=1e-9 * turned[10])
    other = ba.RigidBody("B", ba.Sphere(40 * u.m), mass=1e8 * u.kg)
    one, two = (
        ba.System([other, body], gravity).attraction(X, TURN) for gravity in (ba.Multipole(2), ba.SecondDegree())
    )
    np.testing.assert_allclose(one[:4], two[:4], rtol=1e-14)


def test_a_union() -> None:
    """A cloud in two parts is the cloud; points, surfaces and masses are those of the parts."""
    points = np.random.default_rng(1).normal(size=(9, 3)) * 30
    whole = ba.PointCloud(points * u.m)
    parts = [
        ba.Part(ba.PointCloud(points[:4] * u.m), mass=4 * u.kg),
        ba.Part(
            ba.PointCloud((points[4:] - [5, 6, 7]) @ TURN * u.m),
            mass=5 * u.kg,
            offset=[5, 6, 7] * u.m,
            turn=Rotation.from_matrix(TURN),
        ),
    ]
    union = ba.Union(parts)
    origin = np.array([3.0, -5, 1])
    expected = whole.moments(5, origin, TURN)
    np.testing.assert_allclose(union.moments(5, origin, TURN), expected, atol=1e-13 * np.abs(expected).max())
    np.testing.assert_allclose(union.centre, whole.centre)
    np.testing.assert_allclose(union.specific_inertia, whole.specific_inertia, rtol=1e-13)
    np.testing.assert_allclose(union.points[0], points)
    assert ba.RigidBody("U", union).mass == 9 * u.kg
    assert ba.RigidBody("U", union, mass=18 * u.kg).inertia[0] == 2 * ba.RigidBody("U", union).inertia[0]
    body = ba.RigidBody("U", SHAPES["union"])
    assert len(body.surface) == 3
    centre, matrix = body.surface[2]
    np.testing.assert_allclose(body.offset.value + body.turn @ centre, [0, -70, 20], atol=1e-12)
    np.testing.assert_allclose(body.turn @ matrix @ body.turn.T, TURN @ np.diag([900, 225, 100]) @ TURN.T, atol=1e-10)
    assert body.density is None
    ball = ba.Part(ba.Sphere(3 * u.m), density=ROCK, offset=[10, 0, 0] * u.m)
    hollow = ba.Part(ba.Sphere(1 * u.m), density=-ROCK, offset=[10, 0, 0] * u.m)
    assert ba.Union([ball, hollow]).mass == pytest.approx(2000 * 4 / 3 * np.pi * 26)
    np.testing.assert_allclose(ba.Union([ball, hollow]).centre, [10, 0, 0])


def test_a_union_of_meshes() -> None:
    """Two boxes side by side are the box that they make, in moments, corners and size."""
    vertices, faces = box(high=(2.0, 3.0, 4.0))
    half, whole = ba.Polyhedron(vertices * u.m, faces), ba.Polyhedron(vertices * [2, 1, 1] * u.m, faces)
    union = ba.Union([ba.Part(half, density=ROCK), ba.Part(half, density=ROCK, offset=[2, 0, 0] * u.m)])
    expected = whole.moments(5, np.zeros(3), TURN)
    np.testing.assert_allclose(union.moments(5, np.zeros(3), TURN), expected, atol=1e-12 * np.abs(expected).max())
    assert union.corners.shape == (16, 3)
    assert ba.RigidBody("U", union).bounding_radius > 0.999999 * np.linalg.norm([2, 1.5, 2])
    mixed = ba.Union([ba.Part(half, density=ROCK), ba.Part(ba.Sphere(1 * u.m), density=ROCK, offset=[5, 0, 0] * u.m)])
    assert mixed.corners is None


def test_what_takes_mass_away_has_no_surface() -> None:
    vertices, faces = box()
    stone = ba.Polyhedron(vertices * u.m, faces)
    parts = [
        ba.Part(stone, density=ROCK),
        ba.Part(stone, density=ROCK, offset=[1, 0, 0] * u.m),
        ba.Part(ba.Sphere(0.3 * u.m), density=-ROCK, offset=[1, 1, 1] * u.m),
    ]
    union = ba.Union(parts)
    assert len(union.pieces) == 2
    assert len(union.corners) == 16
    assert union.mass == pytest.approx(2000 * (2 - 4 / 3 * np.pi * 0.3**3))


def test_the_density_of_a_part() -> None:
    vertices, faces = box()
    stone = ba.Polyhedron(vertices * u.m, faces)
    with pytest.warns(DensityWarning, match=r"Part: 2e\+07 kg in this mesh's volume make 2e\+07 kg/m3") as caught:
        ba.Part(stone, mass=2e7 * u.kg)
    assert caught[0].filename == __file__
    with pytest.warns(DensityWarning, match="RigidBody B: 0.002 kg in this mesh") as caught:
        ba.RigidBody("B", stone, mass=0.002 * u.kg)
    assert caught[0].filename == __file__
    ba.Part(stone, mass=2000 * u.kg)
    ba.Part(stone, mass=-1 * u.kg)


def test_short_names() -> None:
    shapes = [SHAPES["union"], SHAPES["cloud"], ba.InertiaIntegrals(integrals(), 1 * u.m), stokes()]
    names = ["Union(3 parts)", "PointCloud(6 points)", "InertiaIntegrals(degree 2)", "StokesCoefficients(degree 2)"]
    assert [repr(shape) for shape in shapes] == names
    assert repr(ba.Union([ba.Part(ba.Sphere(1 * u.m), mass=1 * u.kg)])) == "Union(1 part)"
    assert stokes(normalised=np.False_).normalised is False


def test_many_points_are_summed_in_parts() -> None:
    random = np.random.default_rng(4)
    points, fractions = random.normal(size=(10000, 3)), np.full(10000, 1e-4)
    expected = [np.prod(points**powers, axis=1) @ fractions for powers in monomials.exponents(3)]
    np.testing.assert_allclose(monomials.of_points(points, fractions, 3), expected, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: ba.Part(ba.Sphere(1 * u.m)), "give one of mass= and density="),
        (lambda: ba.Part(ba.Sphere(1 * u.m), mass=1 * u.kg, density=ROCK), "give one of"),
        (lambda: ba.Part(ba.Point(), density=ROCK), "Point has no volume"),
        (lambda: ba.Part(ba.Sphere(1 * u.m), mass=0 * u.kg), "its mass is zero"),
        (lambda: ba.Part("sphere", mass=1 * u.kg), "expected a shape"),
        (lambda: ba.Part(ba.Sphere(1 * u.m), mass=1 * u.kg, turn=2 * np.eye(3)), "not a rotation"),
        (lambda: ba.Part(ba.Sphere(1 * u.m), mass=1 * u.kg, offset=[1, 2] * u.m), "shape"),
        (lambda: ba.Part(stokes(), mass=1 * u.kg), "has no inertia of its own"),
        (lambda: ba.Union([]), r"expected a list of ba.Part"),
        (lambda: ba.Union(ba.Sphere(1 * u.m)), r"expected a list of ba.Part"),
        (lambda: ba.Union([ba.Part(ba.Sphere(1 * u.m), mass=-1 * u.kg)]), "add up to -1 kg"),
        (lambda: ba.RigidBody("U", SHAPES["union"], density=ROCK), "Union has no volume"),
        (lambda: ba.InertiaIntegrals(np.ones((2, 2, 2)), 1 * u.m), "expected shape"),
        (lambda: ba.InertiaIntegrals([[1, 2], [3]], 1 * u.m), "expected shape"),
        (lambda: ba.InertiaIntegrals(np.full((3, 3, 3), np.nan), 1 * u.m), "finite"),
        (lambda: ba.InertiaIntegrals(np.zeros((3, 3, 3)), 1 * u.m), "T_000 is the mass"),
        (lambda: ba.InertiaIntegrals(np.ones((3, 3, 3)), 1), "has no unit"),
        (lambda: stokes(C=3), "C: expected an array"),
        (lambda: stokes(S=np.zeros((4, 4))), "S: expected an array"),
        (lambda: stokes(C=2 * C), r"C\[0\]\[0\]: the mass is the body's"),
        (lambda: stokes(normalised=1), "normalised: expected True or False"),
        (lambda: ba.RigidBody("S", stokes(), mass=1 * u.kg), "inertia: coefficients of degree 2 do not fix its trace"),
        (
            lambda: ba.RigidBody("S", stokes(), mass=1 * u.kg, inertia=[4200, 3800, 4500] * u.kg * u.m**2),
            "does not agree with the coefficients of degree 2, .* xx 3800, xy 0, .* zz 4500 kg m2, got xx 4200, xy",
        ),
        (
            lambda: ba.RigidBody("S", turned_field(), mass=1 * u.kg, inertia=[3800, 4200, 4500] * u.kg * u.m**2),
            "three moments are about the shape's axes: give the matrix",
        ),
        (
            lambda: ba.RigidBody(
                "U",
                ba.Union([ba.Part(ba.Sphere(1 * u.m), mass=9 * u.kg), ba.Part(ba.Sphere(9 * u.m), mass=-1 * u.kg)]),
            ),
            "must all be positive: its negative parts take away more than there is",
        ),
        (
            lambda: ba.RigidBody("S", ba.Sphere(1 * u.m), mass=1 * u.kg).moments(-1),
            "RigidBody S: moments: degree: .*-1",
        ),
        (
            lambda: ba.RigidBody("S", ba.Sphere(1 * u.m), mass=1 * u.kg).moments(2.0),
            "a whole number, 0 or more, got 2.0",
        ),
        (
            lambda: ba.RigidBody("I", ba.InertiaIntegrals(integrals(), 1 * u.m), mass=1 * u.kg).moments(3),
            "RigidBody I: InertiaIntegrals: moments of degree 3 are asked for",
        ),
    ],
)
def test_what_is_refused(make, says: str) -> None:
    with pytest.raises(InputError, match=says) as error:
        make()
    assert "\n" not in str(error.value)


C = np.array([[1, 0, 0], [0, 0, 0], [-0.05, 0, 0.01]])


def stokes(**change: object) -> ba.StokesCoefficients:
    arguments = {"C": C, "S": np.zeros((3, 3)), "reference_radius": 100 * u.m, "normalised": False}
    return ba.StokesCoefficients(**arguments | change)


def turned_field() -> ba.StokesCoefficients:
    """Return a field whose principal axes are turned about z."""
    s = np.zeros((3, 3))
    s[2, 2] = 0.004
    return stokes(S=s)


def ellipsoid_coefficients(a: float, b: float, c: float, radius: float) -> np.ndarray:
    """Return C_lm of a homogeneous ellipsoid to degree 4, plain (G. Balmino, Celest. Mech. 60 (1994) 331-364)."""
    result = np.zeros((5, 5))
    result[0, 0] = 1
    result[2, 0] = (c**2 - (a**2 + b**2) / 2) / (5 * radius**2)
    result[2, 2] = (a**2 - b**2) / (20 * radius**2)
    result[4, 0] = 15 / 7 * (result[2, 0] ** 2 + 2 * result[2, 2] ** 2)
    result[4, 2] = 5 / 7 * result[2, 0] * result[2, 2]
    result[4, 4] = 5 / 28 * result[2, 2] ** 2
    return result


@pytest.mark.parametrize("normalised", [True, False])
@pytest.mark.parametrize("condon_shortley", [True, False])
def test_stokes_coefficients_of_an_ellipsoid(normalised: bool, condon_shortley: bool) -> None:
    c = ellipsoid_coefficients(90, 60, 50, 77)
    if normalised:
        factors = {(0, 0): 1, (2, 0): 5, (2, 2): 5 / 12, (4, 0): 9, (4, 2): 1 / 20, (4, 4): 1 / 2240}
        c = np.array([[c[l, m] / np.sqrt(factors.get((l, m), 1)) for m in range(5)] for l in range(5)])
    plain = ba.RigidBody("A", SHAPES["ellipsoid"], mass=2e9 * u.kg)
    field = ba.StokesCoefficients(c, np.zeros((5, 5)), 77 * u.m, normalised, condon_shortley)
    body = ba.RigidBody("A", field, mass=2e9 * u.kg, inertia=plain.inertia)
    other = ba.RigidBody("B", SHAPES["dumbbell"], mass=1e8 * u.kg)
    for degree in (2, 4):
        one, two = (ba.System([other, first], ba.Multipole(degree)).attraction(X / 4, TURN) for first in (plain, body))
        np.testing.assert_allclose(two, one, rtol=1e-12)
    with pytest.raises(InputError, match="moments of degree 6 are asked for, and given up to 4"):
        ba.System([other, body], ba.Multipole(6))


def test_the_signs_of_stokes_coefficients() -> None:
    """Of a point: (2 - d_m0) (l - m)!/(l + m)! (r/a)^l P_lm e^(i m longitude); those of degree 1 are its place."""
    p, degree = np.array([30.0, -20, 25]), 5
    r, longitude = np.linalg.norm(p), np.arctan2(p[1], p[0])
    plain = np.zeros((degree + 1, degree + 1), dtype=complex)
    for l in range(degree + 1):
        for m in range(l + 1):
            ways = (2 if m else 1) * factorial(l - m) / factorial(l + m)
            plain[l, m] = ways * (r / 100) ** l * lpmv(m, l, p[2] / r) * np.exp(1j * m * longitude)
    expected = harmonic_moments(monomials.of_points(p[None], np.ones(1), degree), degree)
    signs = (-1.0) ** np.arange(degree + 1)
    for c, condon_shortley in ((plain, True), (plain * signs, False)):  # SciPy's P_lm has the sign
        field = ba.StokesCoefficients(c.real, c.imag, 100 * u.m, False, condon_shortley)
        found = harmonic_moments(field.moments(degree, np.zeros(3), np.eye(3)), degree)
        np.testing.assert_allclose(found, expected, rtol=1e-12)
        np.testing.assert_allclose(field.centre, p)


def test_a_field_off_its_centre() -> None:
    """Coefficients of degree 1 are the mass centre: the body is about it, with the moments that it has there."""
    degree = 4
    shape = ba.Union([ba.Part(SHAPES["ellipsoid"], mass=1 * u.kg, offset=[3, -4, 5] * u.m, turn=TURN)])
    direct = ba.RigidBody("A", shape, mass=1 * u.kg)
    c, s = np.zeros((degree + 1, degree + 1)), np.zeros((degree + 1, degree + 1))
    l, m = np.tril_indices(degree + 1)
    factors = np.where(m > 0, 2, 1) * np.array([factorial(n) for n in l - m]) / 80.0**l
    own = harmonic_moments(shape.moments(degree, np.zeros(3), np.eye(3)), degree)
    c[l, m], s[l, m] = (factors * part for part in own)
    field = ba.StokesCoefficients(c, s, 80 * u.m, normalised=False)
    body = ba.RigidBody("A", field, mass=1 * u.kg, inertia=shape.specific_inertia * u.kg * u.m**2)
    np.testing.assert_allclose(body.offset.value, [3, -4, 5])
    np.testing.assert_allclose(body.si.moments, direct.si.moments, rtol=1e-12)
    other = ba.RigidBody("B", SHAPES["dumbbell"], mass=1 * u.kg)
    one, two = (ba.System([other, first], ba.Multipole(degree)).attraction(X, TURN) for first in (direct, body))
    np.testing.assert_allclose(two, one, rtol=1e-9)


def test_values_pickle_and_come_back_from_a_file(tmp_path) -> None:
    shapes = [SHAPES["union"], ba.InertiaIntegrals(integrals(), 1 * u.m), stokes()]
    inertias = [None, None, [3800, 4200, 4500] * u.kg * u.m**2]
    for shape, inertia in zip(shapes, inertias, strict=True):
        body = ba.RigidBody("A", shape, mass=1 * u.kg, inertia=inertia)
        system = ba.System([body, ba.RigidBody("B", ba.Sphere(10 * u.m), mass=1 * u.kg)], ba.Multipole(2))
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(body)).moments(2), body.moments(2))
        state = ba.State.circular_orbit(system, separation=2 * u.km, spins=["synchronous", "synchronous"])
        run = ba.propagate(system, state, duration=10 * u.s, integrator=ba.LGVI(10 * u.s))
        again = ba.Trajectory.read(run.write(tmp_path / f"{type(shape).__name__}.h5"))
        assert again.system.gravity.degree == 2
        np.testing.assert_array_equal(again.system.parameters, system.parameters)


def integrals() -> np.ndarray:
    table = np.zeros((3, 3, 3))
    table[0, 0, 0], table[2, 0, 0], table[0, 2, 0], table[0, 0, 2] = 10, 50, 32, 18
    return table


SCENARIO = """
[[bodies]]
name = "A"
{body}

[[bodies]]
name = "B"
shape = {{ type = "Sphere", radius = "10 m" }}
mass = "1e6 kg"

[gravity]
type = "Multipole"
degree = 2

[state]
type = "circular_orbit"
separation = "2 km"
spins = ["synchronous", "synchronous"]

[run]
duration = "1 h"
step = "10 s"
"""
UNION = """
[[bodies.shape.parts]]
shape = { type = "Ellipsoid", a = "90 m", b = "60 m", c = "50 m" }
density = "2000 kg / m3"
[[bodies.shape.parts]]
shape = { type = "Sphere", radius = "40 m" }
mass = "5e8 kg"
offset = "[110, 0, 0] m"
turn = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
[bodies.shape]
type = "Union"
"""
STOKES = """
mass = "1 kg"
inertia = "[3800, 4200, 4500] kg m2"
[bodies.shape]
type = "StokesCoefficients"
C = [[1, 0, 0], [0, 0, 0], [-0.05, 0, 0.01]]
S = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]
reference_radius = "100 m"
normalised = false
"""


def test_scenario_files() -> None:
    union, field = (loads(SCENARIO.format(body=body), name="x", where="x.toml").system for body in (UNION, STOKES))
    assert union.primary.mass.value == pytest.approx(2000 * 4 / 3 * np.pi * 90 * 60 * 50 + 5e8)
    assert union.gravity.degree == 2
    np.testing.assert_allclose(field.primary.si.moments, [3800, 4200, 4500])
    for body, change, says in (
        (UNION, ("radius", "size"), r"bodies\[0\].shape.parts\[1\].shape.size: unknown key"),
        (UNION, ('mass = "5e8 kg"', ""), r"bodies\[0\].shape.parts\[1\]: Part: give one of"),
        (UNION, ('mass = "5e8 kg"', "mass = 5e8"), r"parts\[1\].mass: expected a text with a unit"),
        (STOKES, ("normalised = false", ""), r"bodies\[0\].shape.normalised is missing"),
    ):
        with pytest.raises(ScenarioError, match=says):
            loads(SCENARIO.format(body=body.replace(*change)), name="x", where="x.toml")
    with pytest.raises(ScenarioError, match="gravity: Multipole: degree: expected a whole number from 2 to 16, got 40"):
        loads(SCENARIO.format(body=STOKES).replace("degree = 2", "degree = 40"), name="x", where="x.toml")
