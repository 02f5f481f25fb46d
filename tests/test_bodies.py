"""Shapes and bodies: inertia, mass centre, principal axes; pickling; what cannot be."""

import pickle

import astropy.units as u
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.bodies import principal_axes
from binaryast.constants import G
from binaryast.errors import InputError


def test_an_ellipsoid_has_the_textbook_inertia() -> None:
    body = ba.RigidBody("E", ba.Ellipsoid(3 * u.km, 2 * u.km, 1 * u.km), mass=5 * u.kg)
    np.testing.assert_allclose(body.inertia.to_value(u.kg * u.km**2), [5, 10, 13])
    np.testing.assert_array_equal(body.turn, np.eye(3))


def test_axes_are_not_sorted() -> None:
    body = ba.RigidBody("E", ba.Ellipsoid(1 * u.km, 3 * u.km, 2 * u.km), mass=5 * u.kg)
    np.testing.assert_allclose(body.inertia.to_value(u.kg * u.km**2), [13, 5, 10])


def test_mass_density_and_gm_say_the_same() -> None:
    shape = ba.Sphere(100 * u.m)
    volume = 4 / 3 * np.pi * 1e6
    for given_as in (
        {"mass": 2e9 * u.kg},
        {"density": 2e9 / volume * u.kg / u.m**3},
        {"gm": 2e9 * G * u.m**3 / u.s**2},
    ):
        body = ba.RigidBody("S", shape, **given_as)
        assert body.mass.to_value("kg") == pytest.approx(2e9, rel=1e-15)
        assert body.gm.to_value("m3 / s2") == pytest.approx(2e9 * G, rel=1e-15)


def test_gm_keeps_another_constant_of_gravitation() -> None:
    body = ba.RigidBody("S", ba.Sphere(1 * u.m), gm=6.674e-11 * 1e12 * u.m**3 / u.s**2)
    assert body.si.gm == 6.674e-11 * 1e12


def test_the_papers_dumbbells_have_the_papers_inertia() -> None:
    """Errata: J1 = diag(.000375, .0238125, .0238125), J2 = diag(.003, .1905, .1905) from spheres of a tenth of l."""
    one = ba.RigidBody("1", ba.Dumbbell(0.25 * u.m, 0.025 * u.m), mass=1.5 * u.kg)
    two = ba.RigidBody("2", ba.Dumbbell(0.5 * u.m, 0.05 * u.m), mass=3 * u.kg)
    np.testing.assert_allclose(one.si.moments, [0.000375, 0.0238125, 0.0238125])
    np.testing.assert_allclose(two.si.moments, [0.003, 0.1905, 0.1905])


def test_a_cloud_is_brought_to_its_principal_axes() -> None:
    random = np.random.default_rng(1)
    points, weights = random.normal(size=(50, 3)) * [3, 2, 1], random.uniform(1, 2, 50)
    turn, shift = Rotation.from_euler("zyx", [0.3, -0.2, 0.1]).as_matrix(), np.array([10.0, -5, 2])
    body = ba.RigidBody("C", ba.PointCloud((points @ turn.T + shift) * u.m, weights), mass=7 * u.kg)
    positions, fractions = body.points
    np.testing.assert_allclose(fractions @ positions, 0, atol=1e-13)
    second = (positions * fractions[:, None]).T @ positions * 7
    np.testing.assert_allclose(np.trace(second) * np.eye(3) - second, np.diag(body.si.moments), atol=1e-12)
    original = body.offset.value + positions @ body.turn.T
    np.testing.assert_allclose(original, points @ turn.T + shift, atol=1e-13)


@given(
    st.tuples(*[st.floats(-0.7, 0.7)] * 3), st.sampled_from([(1, 2, 2.5), (2, 2, 3), (3, 2, 2), (2, 2, 2), (1, 1.5, 1)])
)
def test_principal_axes_are_the_nearest(angles: tuple, moments: tuple) -> None:
    r = Rotation.from_rotvec(angles).as_matrix()
    found, turn = principal_axes(r @ np.diag(moments) @ r.T, "inertia")
    np.testing.assert_allclose(turn @ np.diag(found) @ turn.T, r @ np.diag(moments) @ r.T, atol=1e-12)
    np.testing.assert_allclose(turn.T @ turn, np.eye(3), atol=1e-14)
    assert np.linalg.det(turn) > 0
    assert np.trace(turn) >= np.trace(r) - 1e-9


def test_inertia_as_a_matrix_turns_points_and_surface() -> None:
    r = Rotation.from_euler("z", 0.4).as_matrix()
    inertia = r @ np.diag([3.0, 5.0, 6.0]) @ r.T * u.kg * u.m**2
    body = ba.RigidBody("E", ba.Ellipsoid(2 * u.m, 1 * u.m, 1 * u.m), mass=5 * u.kg, inertia=inertia)
    np.testing.assert_allclose(body.si.moments, [3, 5, 6])
    np.testing.assert_allclose(body.turn, r, atol=1e-14)
    ((_, matrix),) = body.surface
    np.testing.assert_allclose(body.turn @ matrix @ body.turn.T, np.diag([4, 1, 1]), atol=1e-13)


@pytest.mark.parametrize(
    ("build", "says"),
    [
        (lambda: ba.Ellipsoid(1, 2, 3), "a=1 has no unit: expected a length, write a=1 * u.m"),
        (lambda: ba.Ellipsoid(1 * u.kg, 2 * u.m, 3 * u.m), "is not a length"),
        (lambda: ba.Sphere(-1 * u.m), "positive"),
        (lambda: ba.Sphere(np.nan * u.m), "finite"),
        (lambda: ba.Dumbbell(1 * u.m, 0.6 * u.m), "overlap"),
        (lambda: ba.PointCloud([] * u.m), "positions"),
        (lambda: ba.PointCloud([[1, 2, 3]] * u.m, [-1]), "positive"),
        (lambda: ba.RigidBody("x", ba.Sphere(1 * u.m)), "exactly one"),
        (lambda: ba.RigidBody("x", ba.Sphere(1 * u.m), mass=1 * u.kg, gm=1 * u.m**3 / u.s**2), "mass and gm"),
        (lambda: ba.RigidBody("x", ba.Sphere(1 * u.m), mass=-1 * u.kg), "positive"),
        (lambda: ba.RigidBody("x", "sphere", mass=1 * u.kg), "expected a shape"),
        (lambda: ba.Sphere(1e200 * u.m), "beyond what can be computed"),
        (lambda: ba.Sphere((1 + 1j) * u.m), "real"),
        (lambda: ba.Sphere("1 m"), "expected a length such as 1 * u.m, got 1 m"),
        (lambda: ba.Sphere(None), "expected a length such as 1 * u.m, got None"),
        (lambda: ba.PointCloud([[1, 2, 3]] * u.m, [1] * u.kg), "without a unit"),
        (lambda: ba.PointCloud([[1, 2, 3]] * u.m, ["1"]), "numbers"),
        (lambda: ba.PointCloud([[1 * u.m], [1 * u.m, 2 * u.m]]), "different shapes"),
        (lambda: ba.RigidBody("a\nb", ba.Sphere(1 * u.m), mass=1 * u.kg), "printable"),
        (lambda: ba.RigidBody("x" * 65, ba.Sphere(1 * u.m), mass=1 * u.kg), "64 characters"),
        (lambda: ba.RigidBody("x", ba.Sphere(1e80 * u.m), density=1e80 * u.kg / u.m**3), "beyond what can be computed"),
        (lambda: ba.System(None), "expected a list of ba.RigidBody"),
        (lambda: ba.System([1, 2]), "expected ba.RigidBody"),
        (lambda: ba.LGVI(1 * u.s, order=[2, 2]), "order"),
        (lambda: ba.PairPotential(lambda: 0), "decorate it"),
        (lambda: ba.pair_potential(lambda p: 0.0), "13 arguments"),
        (lambda: ba.RigidBody("", ba.Sphere(1 * u.m), mass=1 * u.kg), "name"),
        (lambda: ba.RigidBody("x", ba.Sphere(1 * u.m), mass=1 * u.kg, inertia=[1, 1, 3] * u.kg * u.m**2), "triangle"),
        (
            lambda: ba.RigidBody("x", ba.Sphere(1 * u.m), mass=1 * u.kg, inertia=np.ones((3, 3)) * u.kg * u.m**2),
            "positive",
        ),
        (lambda: ba.RigidBody("x", ba.PointCloud([[1, 0, 0], [2, 0, 0]] * u.m), mass=1 * u.kg), "give inertia="),
        (lambda: ba.RigidBody("x", ba.PointCloud([[1, 0, 0]] * u.m), density=1 * u.kg / u.m**3), "no volume"),
    ],
)
def test_what_cannot_be(build, says: str) -> None:
    with pytest.raises(InputError, match=says.replace("(", r"\(").replace("*", r"\*")) as caught:
        build()
    assert "\n" not in str(caught.value)


def test_lists_of_quantities_are_joined() -> None:
    inertia = [5 * u.kg * u.m**2, 6 * u.kg * u.m**2, 70000 * u.kg * u.cm**2]
    body = ba.RigidBody("x", ba.Sphere(1 * u.m), mass=1 * u.kg, inertia=inertia)
    np.testing.assert_allclose(body.si.moments, [5, 6, 7])


def test_gravity_that_is_not_a_number_does_not_leave() -> None:
    system = ba.System([ba.RigidBody(n, ba.Sphere(1 * u.m), mass=1 * u.kg) for n in "AB"])
    for x in (1e-150, 1e89):
        if x < 1:
            with pytest.raises(InputError, match="not a number"):
                system.mutual_gravity([x, 0, 0] * u.m)
        else:
            assert np.isfinite(system.mutual_gravity([x, 0, 0] * u.m).energy)


def test_bodies_are_frozen_and_pickle() -> None:
    body = ba.RigidBody("E", ba.Ellipsoid(3 * u.km, 2 * u.km, 1 * u.km), gm=5 * u.m**3 / u.s**2)
    with pytest.raises(AttributeError):
        body.name = "other"
    with pytest.raises(ValueError, match="read-only"):
        body.si.moments[0] = 1
    again = pickle.loads(pickle.dumps(body))
    assert again.si.gm == body.si.gm
    np.testing.assert_array_equal(again.si.moments, body.si.moments)
