"""Roll, pitch and yaw, the axes that turn over, and synchrony that is lost: of motions that are known."""

from dataclasses import replace

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.errors import InputError


@pytest.fixture(scope="module")
def circle() -> ba.Trajectory:
    """A synchronous pair of spheres on an inclined circle."""
    bodies = [ba.RigidBody(n, ba.Sphere(1 * u.km), mass=m * u.kg) for n, m in (("A", 4e14), ("B", 1e14))]
    system = ba.System(bodies, gravity=ba.PointMass())
    start = ba.State.circular_orbit(
        system, separation=20 * u.km, pole=[0.3, 0.2, 1.0], spins=["synchronous", "synchronous"]
    )
    return ba.propagate(system, start, duration=3 * u.day, integrator=ba.KeplerSplitting(5 * u.min))


def turned(run: ba.Trajectory, turns: Rotation) -> ba.Trajectory:
    """Return a run whose secondary is turned, in its own axes, by given rotations."""
    attitude = run.si.attitude.copy()
    attitude[:, 1] = attitude[:, 1] @ turns.as_matrix()
    return replace(run, si=run.si._replace(attitude=attitude))


def test_roll_pitch_and_yaw_are_turns_one_after_the_other(circle: ba.Trajectory) -> None:
    """In this order, 1-2-3, each about the axis that the one before has left."""
    angles = np.random.default_rng(1).uniform(-1, 1, (len(circle), 3)) * [180, 89, 180]
    found = ba.analysis.roll_pitch_yaw(turned(circle, Rotation.from_euler("XYZ", angles, degrees=True)))
    for value, expected in zip((found.roll, found.pitch, found.yaw), angles.T, strict=True):
        np.testing.assert_allclose(value.value, expected, atol=1e-9)


def test_at_a_pitch_of_a_right_angle_they_are_finite(circle: ba.Trajectory) -> None:
    turns = Rotation.from_euler("XYZ", [[20, 90, 15]] * len(circle), degrees=True)
    found = ba.analysis.roll_pitch_yaw(turned(circle, turns))
    np.testing.assert_allclose(found.pitch.value, 90, atol=1e-6)
    np.testing.assert_allclose(found.roll.value + found.yaw.value, 35, atol=1e-6)


def test_small_yaw_is_libration(circle: ba.Trajectory) -> None:
    angle = 0.3 * np.sin(circle.si.time / 1e4)
    run = turned(circle, Rotation.from_rotvec(np.outer(angle, [0, 0, 1])))
    np.testing.assert_allclose(ba.analysis.roll_pitch_yaw(run).yaw.to_value("rad"), angle, atol=1e-12)
    assert ba.analysis.libration_amplitude(run).to_value("rad") == pytest.approx(np.abs(angle).max(), rel=1e-10)
    other = turned(run, Rotation.from_rotvec(np.pi * np.array([[0, 0, 1]] * len(run))))  # the other end in front
    assert ba.analysis.libration_amplitude(other).to_value("rad") == pytest.approx(np.abs(angle).max(), rel=1e-10)


@pytest.mark.parametrize(
    ("axis", "kind", "over"),
    [
        ([1, 0, 0], "rolling", [False, True, True]),
        ([0, 1, 0], "pitching", [True, False, True]),
        ([0, 0, 1], "yawing", [True, True, False]),
        ([1, 1, 1], "tumbling", [True, True, True]),
    ],
)
@pytest.mark.parametrize("start", [[0, 0, 0], [0, 0, np.pi], [np.pi, 0, 0]])
def test_the_axis_about_which_it_turns_is_named(
    circle: ba.Trajectory, axis: list[int], kind: str, over: list[bool], start: list[float]
) -> None:
    """From any of the four positions that look the same; when, is known."""
    rate = 2 * np.pi / 86400  # so slow that a quarter of it takes 6 h
    angle = rate * circle.si.time
    unit = np.array(axis) / np.linalg.norm(axis)
    run = turned(circle, Rotation.from_rotvec(np.outer(angle, unit)) * Rotation.from_rotvec(start))
    found = ba.analysis.tumbling(run)
    assert found.kind == kind
    assert np.isfinite(found.turned_over.value).tolist() == over
    if kind != "tumbling":
        np.testing.assert_allclose(found.turned_over.to_value("h")[over], 6, rtol=1e-9)
    assert ba.analysis.tumbling(circle).kind == "synchronous"


def test_when_synchrony_is_lost(circle: ba.Trajectory) -> None:
    rate = 2 * np.pi / 86400
    run = turned(circle, Rotation.from_rotvec(np.outer(rate * circle.si.time, [0, 0, 1])))
    assert ba.analysis.loss_of_synchrony(run).to_value("h") == pytest.approx(6, rel=1e-9)
    assert np.isinf(ba.analysis.loss_of_synchrony(circle).value)
    assert ba.analysis.libration_amplitude(run) > 90 * u.deg
    assert ba.analysis.loss_of_synchrony(run).unit == ba.analysis.loss_of_synchrony(circle).unit


def test_a_point_has_no_axes() -> None:
    bodies = [ba.RigidBody("A", ba.Sphere(1 * u.km), mass=1e14 * u.kg), ba.RigidBody("B", ba.Point(), mass=1 * u.kg)]
    system = ba.System(bodies, ba.PointMass())
    start = ba.State.circular_orbit(system, separation=20 * u.km, spins=["synchronous", None])
    run = ba.propagate(system, start, duration=1 * u.day, integrator=ba.Splitting(10 * u.min))
    for read in (ba.analysis.roll_pitch_yaw, ba.analysis.tumbling, ba.analysis.poincare_section):
        with pytest.raises(InputError, match="B is a point"):
            read(run)
