"""The paper's dumbbells and the observed pair of Didymos in runs; figures of the paper are in the validation."""

import astropy.units as u
import numpy as np

import binaryast as ba
from tests.conftest import attitude_angle


def test_rotations_and_momenta_are_kept() -> None:
    system, state = ba.catalogue.load("dumbbells")
    run = ba.propagate(system, state, duration=15 * u.s, integrator=ba.LGVI(2e-4 * u.s))
    run.check(momentum=1e-12, rotation=3e-13)
    momentum = run.angular_momentum.value
    assert np.linalg.norm(momentum - momentum[0], axis=1).max() < 1e-12 * np.linalg.norm(momentum[0])


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
