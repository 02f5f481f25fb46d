"""Between rows: the order of the interpolation, rotations that remain some, what is estimated, sides of impulses."""

from dataclasses import replace

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba
from binaryast import dense
from binaryast.errors import InputError, InterpolationWarning, UnitError
from binaryast.rows import TrajectoryFloats

FINE = 100  # s


@pytest.fixture(scope="module")
def fine() -> ba.Trajectory:
    """A pair that tumbles, with a row every hundred seconds, right to 1e-13."""
    from validation.systems import tumbling_pair

    return ba.propagate(
        *tumbling_pair(),
        duration=128 * 1600 * u.s,
        integrator=ba.Splitting(FINE * u.s, "ss10"),
        save_every=FINE * u.s,
    )


def rows_of(run: ba.Trajectory) -> dense.Rows:
    return dense.Rows(*run.si[:5])


def every(run: ba.Trajectory, k: int) -> dense.Rows:
    return dense.Rows(*(array[::k].copy() for array in rows_of(run)))


def errors(run: ba.Trajectory, k: int) -> np.ndarray:
    """Return the errors at all rows of an interpolation between each k-th of them."""
    return dense.difference(dense.between(every(run, k), run.si.time), rows_of(run))


def test_the_error_falls_with_the_eighth_power_of_the_distance_of_rows(fine: ba.Trajectory) -> None:
    found = [errors(fine, k).max() for k in (4, 8, 16)]
    slopes = np.log2(np.array(found[1:]) / found[:-1])
    assert slopes[0] == pytest.approx(8, abs=0.6)
    assert slopes[1] == pytest.approx(8, abs=0.6)
    assert found[0] < 2e-11


def test_velocities_and_spins_are_the_derivatives(fine: ba.Trajectory) -> None:
    off = []
    for k in (4, 8):
        between, known = dense.between(every(fine, k), fine.si.time), rows_of(fine)
        off.append([np.abs(getattr(between, name) - getattr(known, name)).max() for name in ("velocity", "spin")])
    slopes = np.log2(np.array(off[1]) / off[0])
    assert np.all(slopes > 6.3)
    between = dense.between(every(fine, 16), np.array([5000.0, 5000.01, 5000.02]))
    rate = (between.position[2] - between.position[0]) / 0.02
    np.testing.assert_allclose(rate, between.velocity[1], atol=1e-9)
    turn = between.attitude[0].swapaxes(-1, -2) @ between.attitude[2]
    vee = np.stack([turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], -1)
    np.testing.assert_allclose(vee / 0.04, between.spin[1], atol=1e-12)


def test_attitudes_stay_rotations_and_rows_stay_what_they_are(fine: ba.Trajectory) -> None:
    for k in (2, 16, 64):
        between, rows = dense.between(every(fine, k), fine.si.time), every(fine, k)
        r = between.attitude
        assert np.linalg.norm(np.eye(3) - r.swapaxes(-1, -2) @ r, axis=(-2, -1)).max() < 2e-15
        for array, known in zip(between, rows, strict=True):
            np.testing.assert_array_equal(array[::k], known)


def test_the_estimate_is_near_the_error(fine: ba.Trajectory) -> None:
    for k in (4, 8, 16, 32):
        found = errors(fine, k)
        largest = np.array([found[i : i + k].max() for i in range(0, len(found) - 1, k)])
        ratio = dense.errors(every(fine, k)) / largest
        assert ratio.min() > 1
        assert np.median(ratio) < 5


def test_a_row_close_behind_another_spoils_nothing(fine: ba.Trajectory) -> None:
    """A run that ends by an event may have its last row just after another."""
    rows = every(fine, 4)
    near = dense.between(rows, np.array([8000 + 1e-7]))
    joined = [np.concatenate([array[:21], new]) for array, new in zip(rows, near, strict=True)]
    times = fine.si.time[:81]
    found = dense.between(dense.Rows(*joined), times)
    known = dense.Rows(*(array[:81] for array in rows_of(fine)))
    assert dense.difference(found, known).max() < 2e-10  # at the end there are rows on one side only
    assert dense.errors(dense.Rows(*joined)).max() < 1e-9


def test_uniform_rotation_is_exact_however_fast() -> None:
    """A body may turn further than half a turn between rows, which its spin tells."""
    time = np.arange(6) * 10.0
    spin = np.array([0.3, -0.4, 1.2])  # 13 rad between rows
    angle = time[:, None] * spin
    attitude = np.array([[np.eye(3), dense._exp(one)] for one in angle])
    zero = np.zeros((6, 2, 3))
    place = zero + np.array([[0, 0, 0], [1, 0, 0]])
    rows = dense.Rows(time, place, zero, attitude, zero + np.array([np.zeros(3), spin]))
    found = dense.between(rows, np.array([3.3, 27.0, 48.1]))
    known = np.array([dense._exp(when * spin) for when in (3.3, 27.0, 48.1)])
    np.testing.assert_allclose(found.attitude[:, 1], known, atol=2e-14)


@pytest.fixture(scope="module")
def run() -> ba.Trajectory:
    system, state = ba.catalogue.load("didymos")
    kick = ba.Impulse(30000 * u.s, [0, 5, 0] * u.mm / u.s, "Dimorphos")
    integrator = ba.Splitting(200 * u.s, "ss10")
    return ba.propagate(
        system, state, duration=60000 * u.s, integrator=integrator, save_every=1000 * u.s, impulses=[kick]
    )


def test_one_time_is_a_state_and_several_are_a_trajectory(run: ba.Trajectory) -> None:
    state = run.at(12345 * u.s)
    assert isinstance(state, ba.State)
    several = run.at([0.2, 5, 12.3] * u.h)
    assert isinstance(several, ba.Trajectory)
    assert len(several) == 3
    np.testing.assert_array_equal(run.at([12345] * u.s)[0].position.value, state.position.value)
    np.testing.assert_array_equal(run.at(3000 * u.s).attitude, run[3].attitude)
    assert run.at(60000 * u.s).position[1, 0] == run[-1].position[1, 0]


def test_energy_and_epoch_go_with_it(run: ba.Trajectory) -> None:
    several = run.at([500.5, 3000, 59000.25] * u.s)
    np.testing.assert_allclose(several.energy.value, np.interp(several.si.time, *_distinct(run)), rtol=1e-15)
    assert several.potential_energy[1] == run.potential_energy[3]
    exact = ba.retrace(run, several.time)
    np.testing.assert_allclose(several.potential_energy.value, exact.potential_energy.value, rtol=1e-7)


def _distinct(run: ba.Trajectory) -> tuple[np.ndarray, np.ndarray]:
    time, first = np.unique(run.si.time, return_index=True)
    return time, run.energy.value[first]


def test_both_sides_of_an_impulse(run: ba.Trajectory) -> None:
    before, after = (run.at(30000 * u.s, side=side) for side in ("before", "after"))
    np.testing.assert_allclose((after.velocity - before.velocity)[1].to_value("mm/s"), [0, 5, 0], atol=1e-12)
    for away in (1e-3, 333.0):  # nothing of the other leg is taken in
        one, other = run.at(30000 * u.s - away * u.s), run.at(30000 * u.s + away * u.s)
        for state, when in ((one, 30000 - away), (other, 30000 + away)):
            again = ba.retrace(run, when * u.s)
            np.testing.assert_allclose(state.position.value, again.position.value, atol=1e-6)
            np.testing.assert_allclose(state.velocity.value, again.velocity.value, atol=1e-9)


def test_to_retrace_is_as_accurate_as_the_run() -> None:
    """From rows that are far apart, and by every integrator."""
    system, state = ba.catalogue.load("didymos")
    duration, when = 6 * u.h, 12345.678 * u.s
    for integrator in (
        ba.LGVI(20 * u.s, order=8),
        ba.Splitting(200 * u.s, "ss10"),
        ba.KeplerSplitting(100 * u.s),
        ba.RungeKutta(),
    ):
        far = ba.propagate(system, state, duration=duration, integrator=integrator, save_every=3 * u.h)
        exact = ba.propagate(system, state, duration=when, integrator=ba.Splitting(200 * u.s, "ss10"))[-1]
        again = ba.retrace(far, when)
        np.testing.assert_allclose(again.position.value, exact.position.value, atol=1e-7)
        np.testing.assert_allclose(again.attitude, exact.attitude, atol=1e-9)
    np.testing.assert_array_equal(ba.retrace(far, 3 * u.h).position.value, far[1].position.value)
    assert len(ba.retrace(far, [1, 3, 4] * u.h)) == 3


def test_rows_too_far_apart_are_a_warning(run: ba.Trajectory) -> None:
    with pytest.warns(InterpolationWarning, match=r"save more often, or take ba\.retrace"):
        run[::6].at(12345 * u.s)
    run[::6].at(6000 * u.s)  # a row is what it is
    assert len(run.interpolation_error) == len(run) - 1
    assert run.interpolation_error.max() < 3e-9


@pytest.mark.parametrize(
    ("time", "kind", "says"),
    [
        (70000 * u.s, InputError, "is outside of the run, whose rows are from 0 s to 16.6667 h"),
        (-1 * u.s, InputError, "is outside"),
        ([2, 1] * u.s, InputError, "times that grow"),
        ([] * u.s, InputError, "times that grow"),
        (np.ones((2, 2)) * u.s, InputError, "single value"),
        (5, UnitError, "write time=5 \\* u.s"),
    ],
)
def test_what_cannot_be(run: ba.Trajectory, time: object, kind: type, says: str) -> None:
    for ask in (run.at, lambda when: ba.retrace(run, when)):
        with pytest.raises(kind, match=says):
            ask(time)
    with pytest.raises(InputError, match="'before' or 'after'"):
        run.at(1 * u.s, side="left")


def test_few_rows() -> None:
    system, state = ba.catalogue.load("didymos")
    run = ba.propagate(
        system, state, duration=400 * u.s, integrator=ba.Splitting(40 * u.s, "ss10"), save_every=40 * u.s
    )
    exact = run[3].position.value
    three, two = run[::5], replace(run, si=TrajectoryFloats(*(array[::10] for array in run.si)))
    np.testing.assert_allclose(three.at(120 * u.s).position.value, exact, atol=1e-7)
    with pytest.warns(InterpolationWarning, match="inf"):
        np.testing.assert_allclose(two.at(120 * u.s).position.value, exact, atol=3e-4)
    with pytest.raises(InputError, match="one row only"):
        run[:1].at(0 * u.s + 1e-20 * u.s)
