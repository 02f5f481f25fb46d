"""The paper's section 5, the observed period of Dimorphos, a documented case of another code."""

import astropy.units as u
import numpy as np
import pytest
from validation import discrete_law, f2bptoolkit

import binaryast as ba
from tests.conftest import attitude_angle

UNIT_OF_ENERGY = 2 / 9 / ba.constants.G  # J: the paper's unit of mass, the reduced mass, at 1 m2/s2
INITIAL_ENERGY = 0.44066240192821  # errata


def dumbbells(step: float, duration: float = 15.0, **options) -> ba.Trajectory:
    system, state = ba.catalogue.load("dumbbells")
    return ba.propagate(system, state, duration=duration * u.s, integrator=ba.LGVI(step * u.s), **options)


@pytest.fixture(scope="module")
def run() -> ba.Trajectory:
    return dumbbells(2e-4)


def test_the_papers_largest_energy_deviation(run: ba.Trajectory) -> None:
    assert run.energy[0].value / UNIT_OF_ENERGY == pytest.approx(INITIAL_ENERGY, rel=1e-13)
    assert 2.6960e-7 <= run.max_energy_error.value / UNIT_OF_ENERGY <= 2.6967e-7
    assert run.max_relative_energy_error == pytest.approx(6.1188e-7, rel=1e-4)


def test_rotations_and_momenta_are_kept(run: ba.Trajectory) -> None:
    run.check(momentum=1e-12, rotation=3e-13)
    momentum = run.angular_momentum.value
    assert np.linalg.norm(momentum - momentum[0], axis=1).max() < 1e-12 * np.linalg.norm(momentum[0])


def test_closest_approach(run: ba.Trajectory) -> None:
    assert run.closest_approach_time.value == pytest.approx(9.0022, abs=2e-4)
    assert run.closest_approach.value == pytest.approx(0.3303, abs=5e-5)


@pytest.mark.parametrize(
    ("time", "separation", "x2"),
    [
        (5, 0.997571611796, (-0.294973547348, 0.134272422190, -0.074388490523)),
        (9, 0.330305022287, (-0.081878775542, 0.073594701585, -0.001436890053)),
    ],
)
def test_high_precision_states(time: float, separation: float, x2: tuple) -> None:
    """Errors of order 2 extrapolated away, against DOP853 at 3e-14 (errata)."""
    coarse, fine = (dumbbells(h, time, save_every=time * u.s) for h in (2e-4, 1e-4))
    extrapolated = (4 * fine.si.position[-1] - coarse.si.position[-1]) / 3
    np.testing.assert_allclose(extrapolated[0], x2, atol=2e-9)
    assert np.linalg.norm(extrapolated[1] - extrapolated[0]) == pytest.approx(separation, abs=2e-9)


def test_second_order() -> None:
    errors = [dumbbells(h).max_energy_error.value for h in (1e-3, 5e-4, 2.5e-4)]
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2, atol=0.01)
    assert errors[0] / UNIT_OF_ENERGY == pytest.approx(6.7365e-6, rel=1e-3)
    assert errors[1] / UNIT_OF_ENERGY == pytest.approx(1.685e-6, rel=1e-3)


def test_the_attitude_runs_ahead_as_the_discrete_law_says() -> None:
    run, law = discrete_law.year_ahead(30.0)
    assert run == pytest.approx(law, abs=1e-7)
    assert law == pytest.approx(2.2, abs=0.05)


def test_didymos_for_sixty_days() -> None:
    """Energy without drift, angular momentum to 1e-12, and the observed mutual period within 0.1 %."""
    system, state = ba.catalogue.load("didymos")
    run = ba.propagate(system, state, duration=60 * u.day, integrator=ba.LGVI(step=40 * u.s), save_every=40 * u.s)
    run.check(energy=1e-8, momentum=1e-12, rotation=1e-14)
    assert run.max_energy_error_over_potential < 1e-6
    assert abs(ba.analysis.mutual_period(run).to_value("h") / 11.921473 - 1) < 1e-3
    error = run.energy.value / run.energy.value[0] - 1
    days = run.si.time / 86400
    # the error oscillates with the spin, so neighbours are not independent: means of 200 blocks of 7.2 h are
    count = len(days) // 200
    blocks, times = (array[: 200 * count].reshape(200, count).mean(axis=1) for array in (error, days))
    (slope, _), covariance = np.polyfit(times, blocks, 1, cov=True)
    assert abs(slope) < 3 * np.sqrt(covariance[0, 0])
    assert abs(slope) * 60 < 0.02 * run.max_relative_energy_error


def test_the_documented_case_of_f2bptoolkit() -> None:
    differences = {step: f2bptoolkit.difference(step) for step in (20.0, 10.0, 5.0)}
    assert abs(differences[10.0]) < 2e-3
    assert np.log2(differences[20.0] / differences[10.0]) == pytest.approx(2, abs=0.1)
    assert np.log2(differences[10.0] / differences[5.0]) == pytest.approx(2, abs=0.1)


def test_frames_do_not_matter() -> None:
    """The same pair, turned and moved as a whole in space, runs the same."""
    from scipy.spatial.transform import Rotation

    system, state = ba.catalogue.load("dumbbells")
    turn = Rotation.from_rotvec([0.4, -1.0, 2.0]).as_matrix()
    turned = ba.State(
        state.position @ turn.T + [1, 2, 3] * u.m, state.velocity @ turn.T, turn @ state.attitude, state.spin
    )
    one, two = (ba.propagate(system, s, duration=5 * u.s, integrator=ba.LGVI(1e-3 * u.s)) for s in (state, turned))
    np.testing.assert_allclose(two.position[-1].value, one.position[-1].value @ turn.T + [1, 2, 3], atol=1e-12)
    assert attitude_angle(two.attitude[-1], turn @ one.attitude[-1]) < 1e-12
