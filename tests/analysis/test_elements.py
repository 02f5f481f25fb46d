"""Elements: osculating ones come back as given, means drift as secular theory says; degenerate orbits are finite."""

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba
from binaryast.analysis.kepler import mean_anomaly, orbits_of, true_anomaly
from binaryast.errors import InputError


def points(**elements: object) -> ba.Trajectory:
    bodies = [ba.RigidBody(n, ba.Sphere(1 * u.km), mass=m * u.kg) for n, m in (("A", 4e14), ("B", 1e14))]
    system = ba.System(bodies, gravity=ba.PointMass())
    start = ba.State.from_elements(system, semi_major_axis=20 * u.km, spins=["synchronous", "synchronous"], **elements)
    return ba.propagate(system, start, duration=10 * u.day, integrator=ba.KeplerSplitting(10 * u.min))


@pytest.mark.parametrize("pole", [None, [0.3, -0.2, 0.9], [70 * u.deg, -72 * u.deg]])
def test_elements_of_keplers_orbit_come_back(pole: object) -> None:
    given = {
        "eccentricity": 0.3,
        "inclination": 50 * u.deg,
        "longitude_of_ascending_node": 40 * u.deg,
        "argument_of_periapsis": 110 * u.deg,
        "mean_anomaly": 25 * u.deg,
    }
    run = points(pole=pole, **given)
    found = ba.analysis.osculating_elements(run, pole=pole)
    assert not np.any(found.circular | found.planar)
    np.testing.assert_allclose(found.semi_major_axis.to_value("km"), 20, rtol=1e-12)
    np.testing.assert_allclose(found.eccentricity, 0.3, rtol=1e-11)
    for name in ("inclination", "longitude_of_ascending_node", "argument_of_periapsis"):
        np.testing.assert_allclose(getattr(found, name).value, given[name].value, rtol=1e-10)
    elapsed = found.mean_motion.to_value("deg / s") * run.si.time
    np.testing.assert_allclose(found.mean_anomaly.value, 25 + elapsed, rtol=1e-11)
    np.testing.assert_allclose(found.mean_longitude.value, 175 + elapsed, rtol=1e-11)
    assert np.all(np.diff(found.true_anomaly.value) > 0)
    assert found.to_table()["eccentricity"].shape == (len(run),)


def test_rows_may_lie_turns_apart() -> None:
    run = points(eccentricity=0.1)
    few, all_ = ba.analysis.osculating_elements(run[::180]), ba.analysis.osculating_elements(run)
    turns = np.diff(few.mean_longitude.value) / 360
    assert turns.min() > 1
    np.testing.assert_allclose(few.mean_longitude.value, all_.mean_longitude.value[::180], rtol=1e-12)


def test_circular_and_planar_orbits_are_said_and_finite() -> None:
    x, v = np.array([[1.0, 0, 0], [0, 1.0, 0]]), np.array([[0, 1.0, 0], [-1.0, 0, 0]])
    angles = orbits_of(x, v, 1.0).angles(np.eye(3), None)
    assert np.all(angles.circular & angles.planar)
    np.testing.assert_allclose(angles.mean_longitude, [0, np.pi / 2], atol=1e-15)
    assert np.all(angles.node == 0)
    assert np.all(angles.periapsis == 0)
    back = orbits_of(x, -v, 1.0).angles(np.eye(3), None)  # retrograde: planar too
    assert np.all(back.planar)
    np.testing.assert_allclose(back.inclination, np.pi)
    for fields in (angles, back):
        assert all(np.all(np.isfinite(one)) for one in fields)


def test_unbound_orbits_are_finite() -> None:
    x, v = np.array([[1.0, 0, 0], [1.0, 0, 0]]), np.array([[0.1, 2.0, 0], [0, np.sqrt(2), 0]])  # hyperbola, parabola
    orbits = orbits_of(x, v, 1.0)
    assert orbits.axis[0] == pytest.approx(1 / (2 - 4.01))
    assert orbits.size[1] == pytest.approx(1)
    assert all(np.all(np.isfinite(one)) for one in orbits.angles(np.eye(3), None))


def test_keplers_equation_both_ways() -> None:
    mean = np.linspace(-3.1, 3.1, 101)
    for e in (0.0, 0.3, 0.95):
        eccentricity = np.full(101, e)
        np.testing.assert_allclose(mean_anomaly(true_anomaly(mean, eccentricity), eccentricity), mean, atol=2e-14)


def test_on_a_line_there_are_none() -> None:
    with pytest.raises(InputError, match="on a line"):
        orbits_of(np.array([[1.0, 0, 0]]), np.array([[-1.0, 0, 0]]), 1.0)


def test_means_drift_as_secular_theory_says() -> None:
    """Node and periapsis about an oblate primary, to first order in J2 = 0.01 at r = 10 R."""
    oblate = ba.RigidBody("A", ba.Ellipsoid(1000 * u.m, 1000 * u.m, 900 * u.m), mass=1e13 * u.kg)
    light = ba.RigidBody("B", ba.Sphere(10 * u.m), mass=1e6 * u.kg)
    system = ba.System([oblate, light])
    inclination = np.radians(30)
    orbit = ba.Orbit(
        10 * u.km,
        eccentricity=0.1,
        inclination=30 * u.deg,
        longitude_of_ascending_node=20 * u.deg,
        argument_of_periapsis=50 * u.deg,
    )
    start = ba.State.from_orbits(system, [orbit], spins=[5 * u.h, "synchronous"], poles={"A": [0, 0, 1]})
    # the equator stays where it is: the primary turns about z, and the light body has no torque to give
    period = 2 * np.pi * np.sqrt(1e12 / (1e13 * ba.constants.G))
    run = ba.propagate(
        system, start, duration=60 * period * u.s, integrator=ba.Splitting(period / 48 * u.s, scheme="ss10"),
        save_every=period / 24 * u.s,
    )  # fmt: skip
    means, osculating = ba.analysis.mean_elements(run), ba.analysis.osculating_elements(run)
    C, A = oblate.si.moments[2], oblate.si.moments[0]
    factor = 1.5 * (C - A) / 1e13 / (1e8 * (1 - 0.1**2) ** 2)  # 3/2 J2 (R/p)^2
    expected = {
        "longitude_of_ascending_node": -factor * np.cos(inclination),
        "argument_of_periapsis": factor * (2 - 2.5 * np.sin(inclination) ** 2),
    }
    anomaly = np.radians(means.mean_longitude.value)
    for name, rate in expected.items():
        angle = np.radians(getattr(means, name).value)
        assert np.polyfit(anomaly, angle, 1)[0] == pytest.approx(rate, rel=5e-3)
    for name in ("semi_major_axis", "eccentricity"):
        wobble = [float(np.ptp(np.asarray(getattr(one, name)))) for one in (means, osculating)]
        assert wobble[0] < 0.05 * wobble[1]


def test_what_has_no_means(tumbling: tuple[ba.System, ba.State]) -> None:
    run = ba.propagate(*tumbling, duration=1 * u.day, integrator=ba.LGVI(20 * u.s), save_every=30 * u.min)
    with pytest.raises(InputError, match="at least three"):
        ba.analysis.mean_elements(run)
    kick = ba.Impulse(time=6 * u.h, body="B", delta_v=[0, 0, 1] * u.mm / u.s)
    kicked = ba.propagate(*tumbling, duration=1 * u.day, integrator=ba.LGVI(20 * u.s), impulses=[kick])
    with pytest.raises(InputError, match=r"run\.legs"):
        ba.analysis.mean_elements(kicked)


def test_of_two_among_several() -> None:
    system, state = ba.catalogue.load("sn263")
    run = ba.propagate(system, state, duration=5 * u.day, integrator=ba.LGVI(60 * u.s))
    found = ba.analysis.osculating_elements(run, ("Alpha", "Gamma"))
    assert found.semi_major_axis.to_value("km").mean() == pytest.approx(3.8, rel=0.02)
    with pytest.raises(InputError, match="bodies"):
        ba.analysis.osculating_elements(run)
