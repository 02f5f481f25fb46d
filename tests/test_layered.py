"""Bodies of two densities: their moments as sums, and whether the inner shape is inside."""

import pickle
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba
from binaryast.errors import InputError
from tests import solids
from tests.test_polyhedron import box_moments, polyhedron

HIGH, LOW = np.array([3.0, 2.0, 2.0]), np.array([-1.0, -2.0, -1.0])
CORE_LOW, CORE_HIGH = np.array([0.5, -1.0, 0.0]), np.array([2.5, 0.0, 1.0])


@pytest.mark.parametrize("ratio", [0, 0.5, 1, 3.5])
def test_a_box_in_a_box(ratio: float) -> None:
    outer, inner = polyhedron(solids.box(LOW, HIGH)), polyhedron(solids.box(CORE_LOW, CORE_HIGH))
    shape = ba.Layered(outer, inner, density_ratio=ratio)
    one, two = np.prod(HIGH - LOW), (ratio - 1) * np.prod(CORE_HIGH - CORE_LOW)

    def moments(origin: np.ndarray) -> np.ndarray:
        boxes = ((one, LOW, HIGH), (two, CORE_LOW, CORE_HIGH))
        return sum(mass * box_moments(low - origin, high - origin, 4) for mass, low, high in boxes) / (one + two)

    np.testing.assert_allclose(shape.moments(4, np.zeros(3), np.eye(3)), moments(np.zeros(3)), rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(shape.centre, moments(np.zeros(3))[1:4], rtol=1e-14)
    xx, xy, xz, yy, yz, zz = moments(shape.centre)[4:10]
    second = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    np.testing.assert_allclose(shape.specific_inertia, np.trace(second) * np.eye(3) - second, rtol=1e-13, atol=1e-14)
    assert shape.volume == outer.volume


def test_a_ratio_of_one_changes_nothing() -> None:
    vertices, faces = solids.icosphere(2)
    outer, inner = polyhedron((vertices, faces)), polyhedron((vertices / 2 + 0.2, faces))
    plain, same = ba.RigidBody("x", outer, density=2e3 * u.kg / u.m**3), ba.Layered(outer, inner, density_ratio=1)
    np.testing.assert_allclose(same.specific_inertia, plain.shape.specific_inertia, rtol=1e-14)
    np.testing.assert_allclose(same.centre, plain.shape.centre, atol=1e-15)


def test_its_surface_and_its_density_are_those_of_the_whole() -> None:
    shape = ba.Layered(ba.Ellipsoid(300 * u.m, 200 * u.m, 100 * u.m), ba.Sphere(50 * u.m), density_ratio=0)
    body = ba.RigidBody("shell", shape, density=1000 * u.kg / u.m**3)
    assert body.si.mass == pytest.approx(4 / 3 * np.pi * 6e6 * 1000)
    ((_, matrix),) = body.surface
    np.testing.assert_allclose(np.sqrt(np.diag(matrix)), [300, 200, 100])


BALL = solids.icosphere(2)
TOOTH = (BALL[0] * [0.5, 0.5, 0.5], BALL[1])
TOOTH[0][0] *= 4  # one vertex reaches out


@pytest.mark.parametrize(
    ("outer", "inner", "inside"),
    [
        (ba.Ellipsoid(3 * u.m, 2 * u.m, 1 * u.m), ba.Ellipsoid(2.9 * u.m, 1.9 * u.m, 0.9 * u.m), True),
        (ba.Ellipsoid(3 * u.m, 2 * u.m, 1 * u.m), ba.Sphere(1 * u.m), False),
        (ba.Sphere(1.01 * u.m), polyhedron(BALL), True),
        (ba.Sphere(0.99 * u.m), polyhedron(BALL), False),
        (polyhedron(BALL), ba.Sphere(0.95 * u.m), True),
        (polyhedron(BALL), ba.Sphere(0.99 * u.m), False),  # its faces lie inside of the sphere of its vertices
        (polyhedron((BALL[0] + 3, BALL[1])), ba.Sphere(0.5 * u.m), False),  # beside it
        (polyhedron((BALL[0] * [3, 2, 1], BALL[1])), ba.Ellipsoid(2.8 * u.m, 1.8 * u.m, 0.9 * u.m), True),
        (polyhedron(BALL), polyhedron((BALL[0] * 0.9, BALL[1])), True),
        (polyhedron(BALL), polyhedron(BALL), False),
        (polyhedron(BALL), polyhedron((BALL[0] * 0.9 + 0.2, BALL[1])), False),
        (polyhedron(BALL), polyhedron(TOOTH), False),
        (polyhedron((BALL[0] * 0.9, BALL[1])), polyhedron(BALL), False),
        (polyhedron(solids.torus()), polyhedron((BALL[0] * 0.5, BALL[1])), False),  # in its hole
        (polyhedron(solids.torus()), polyhedron((BALL[0] * 0.5 + [3, 0, 0], BALL[1])), True),
    ],
)
def test_the_inner_shape_must_be_inside(outer: ba.Shape, inner: ba.Shape, inside: bool) -> None:
    if inside:
        assert ba.Layered(outer, inner, density_ratio=2).volume == outer.volume
        return
    with pytest.raises(InputError, match=r"reaches out of the .* or touches it") as caught:
        ba.Layered(outer, inner, density_ratio=2)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("outer", "inner", "ratio", "says"),
    [
        (ba.Sphere(2 * u.m), ba.Dumbbell(1 * u.m, 0.1 * u.m), 1, "inner: expected a ba.Ellipsoid, ba.Sphere or"),
        (None, ba.Sphere(1 * u.m), 1, "outer: expected"),
        (ba.Sphere(2 * u.m), ba.Sphere(1 * u.m), -1, "density_ratio: expected a value of zero or more"),
        (ba.Sphere(2 * u.m), ba.Sphere(1 * u.m), np.nan, "density_ratio: expected finite"),
        (ba.Sphere(2 * u.m), ba.Sphere(1 * u.m), "2", "density_ratio: expected a number"),
        (ba.Sphere(2 * u.m), ba.Sphere(1 * u.m), 2000 * u.kg / u.m**3, "without a unit"),
    ],
)
def test_one_line_for_each_mistake(outer: object, inner: object, ratio: object, says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        ba.Layered(outer, inner, density_ratio=ratio)
    assert "\n" not in str(caught.value)


def test_it_pickles_and_comes_back_from_a_file(tmp_path: Path) -> None:
    outer, inner = polyhedron((BALL[0] * 500, BALL[1])), ba.Sphere(200 * u.m)
    shape = ba.Layered(outer, inner, density_ratio=2.5)
    again = pickle.loads(pickle.dumps(shape))
    np.testing.assert_array_equal(again.specific_inertia, shape.specific_inertia)
    bodies = [
        ba.RigidBody("A", shape, density=2000 * u.kg / u.m**3),
        ba.RigidBody("B", ba.Sphere(50 * u.m), density=2000 * u.kg / u.m**3),
    ]
    system = ba.System(bodies)
    state = ba.State.circular_orbit(system, separation=2 * u.km, spins=[5 * u.h, 10 * u.h])
    run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(30 * u.s))
    body = ba.Trajectory.read(run.write(tmp_path / "run.h5")).system.primary
    assert isinstance(body.shape, ba.Layered)
    assert isinstance(body.shape.inner, ba.Sphere)
    np.testing.assert_array_equal(body.si.moments, bodies[0].si.moments)
