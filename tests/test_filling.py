"""Mascons: mass centre and inertia exactly, higher moments nearly, the same each time."""

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba
from binaryast.errors import InputError
from binaryast.filling import density
from binaryast.kernels.moments import exponents
from tests import solids
from tests.test_polyhedron import SHAPES, polyhedron, with_shapes

BALL = solids.icosphere(2)
BENT = polyhedron((BALL[0] * [3, 2, 1] + 0.2 * BALL[0][:, [1, 2, 0]] ** 2 + 5.0, BALL[1]))
KINDS = {
    "ellipsoid": ba.Ellipsoid(3 * u.m, 2 * u.m, 1 * u.m),
    "sphere": ba.Sphere(2 * u.m),
    "dumbbell": ba.Dumbbell(4 * u.m, 1 * u.m),
    "polyhedron": BENT,
    "torus": polyhedron(solids.torus(24, 16)),
    "core": ba.Layered(polyhedron(solids.box((-2, -2, -2), (2, 2, 2))), polyhedron(solids.box()), density_ratio=3),
    "hollow": ba.Layered(ba.Sphere(2 * u.m), ba.Sphere(1.5 * u.m), density_ratio=0),
}


@pytest.mark.parametrize("count", [30, 2000])
@pytest.mark.parametrize("arrangement", ["grid", "random"])
@pytest.mark.parametrize("name", KINDS)
def test_mass_centre_and_inertia_are_exact(name: str, arrangement: str, count: int) -> None:
    shape = KINDS[name]
    cloud = ba.mascons(shape, count=count, arrangement=arrangement)
    size = np.sqrt(np.trace(shape.specific_inertia))
    np.testing.assert_allclose(cloud.centre, shape.centre, atol=3e-15 * (size + np.abs(shape.centre).max()))
    np.testing.assert_allclose(cloud.specific_inertia, shape.specific_inertia, rtol=1e-13, atol=1e-13 * size**2)
    assert np.all(cloud.weights > 0)
    number = len(cloud.positions)
    assert number == count if arrangement == "random" else 0.5 * count < number < 2.2 * count


@pytest.mark.parametrize("arrangement", ["grid", "random"])
def test_higher_moments_come_near(arrangement: str) -> None:
    """Degrees 3 and 4 relative to the size, to about 1 % with some thousand points."""
    cloud = ba.mascons(BENT, count=4000, arrangement=arrangement, seed=1)
    size = np.sqrt(np.trace(BENT.specific_inertia))
    powers = exponents(4)
    arms = (cloud.positions.value - BENT.centre) / size
    found = np.mean(np.prod(arms[:, None, :] ** powers, axis=2), axis=0)
    exact = BENT.moments(4, BENT.centre, np.eye(3)) / size ** powers.sum(axis=1)
    np.testing.assert_allclose(found, exact, atol=0.01)


def test_the_same_seed_gives_the_same_points() -> None:
    one, two, other = (
        ba.mascons(BENT, count=100, arrangement="random", seed=seed).positions.value for seed in (3, 3, 4)
    )
    np.testing.assert_array_equal(one, two)
    assert not np.array_equal(one, other)


def test_points_lie_where_the_mass_is() -> None:
    core = KINDS["core"]
    points = np.array([[0.5, 0.5, 0.5], [-0.5, 0.5, 0.5], [3.0, 0, 0]])
    np.testing.assert_array_equal(density(core, points), [3, 1, 0])
    np.testing.assert_array_equal(
        density(KINDS["hollow"], np.array([[0, 0, 0.0], [1.7, 0, 0], [0, 2.5, 0]])), [0, 1, 0]
    )
    np.testing.assert_array_equal(
        density(KINDS["dumbbell"], np.array([[2, 0, 0.9], [0, 0, 0], [-2.5, 0, 0]])), [1, 0, 1]
    )
    cloud = ba.mascons(KINDS["core"], count=4000)
    assert sorted(set(cloud.weights.tolist())) == [1, 3]


def test_mascons_attract_as_the_shape_does() -> None:
    """The pair sum of two filled ellipsoids and the second degree agree better the further away they are."""
    shapes = [ba.Ellipsoid(3 * u.m, 2 * u.m, 1.5 * u.m), ba.Ellipsoid(1.5 * u.m, 1 * u.m, 0.8 * u.m)]
    full = [ba.RigidBody(n, shape, mass=1e6 * u.kg) for n, shape in zip("AB", shapes, strict=True)]
    filled = [
        ba.RigidBody(n, ba.mascons(shape, count=200), mass=1e6 * u.kg) for n, shape in zip("AB", shapes, strict=True)
    ]
    errors = []
    for distance in (10.0, 20.0):
        x = np.array([0.8, 0.5, 0.3]) * distance * u.m
        one = ba.System(full).mutual_gravity(x).energy.value
        two = ba.System(filled, gravity=ba.PointPairs()).mutual_gravity(x).energy.value
        errors.append(abs(two / one - 1))
    assert errors[0] < 2e-3
    assert errors[0] / errors[1] > 12  # the fourth degree falls by 16


@with_shapes
def test_kleopatra_filled() -> None:
    shape = ba.Polyhedron.read(SHAPES / "kleopatra.obj", u.km)
    cloud = ba.mascons(shape, count=1000)
    np.testing.assert_allclose(
        cloud.specific_inertia, shape.specific_inertia, rtol=0, atol=1e-13 * np.trace(shape.specific_inertia)
    )


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"shape": ba.Point(), "count": 10}, "has no inside to fill"),
        ({"shape": ba.PointCloud([[1, 0, 0]] * u.m), "count": 10}, "has no inside to fill"),
        ({"shape": None, "count": 10}, "None has no inside to fill"),
        ({"shape": BENT, "count": 3}, "four or more"),
        ({"shape": BENT, "count": 10.0}, "a whole number of points"),
        ({"shape": BENT, "count": 10, "arrangement": "gird"}, "expected 'grid' or 'random'"),
        ({"shape": BENT, "count": 10, "arrangement": ["grid"]}, "expected 'grid' or 'random'"),
        ({"shape": BENT, "count": 10, "seed": -1}, "seed=-1"),
        (
            {"shape": ba.Ellipsoid(9 * u.m, 9 * u.m, 0.01 * u.m), "count": 4},
            "expected a larger count, or arrangement='random'",
        ),
    ],
)
def test_one_line_for_each_mistake(arguments: dict, says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        ba.mascons(**arguments)
    assert "\n" not in str(caught.value)
