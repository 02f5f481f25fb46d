"""An accuracy asked for: that it is had, said how, refused where it cannot be; and that no clock has a say."""

import re

import astropy.units as u
import numpy as np
import pytest
from validation.accuracies import SETTINGS, error, results
from validation.systems import tumbling_pair

import binaryast as ba
from binaryast import trials
from binaryast.errors import AccuracyError, InputError


@pytest.mark.parametrize(
    "name",
    ["didymos, a day", "dumbbells, past the encounter", "wobbling pair", "tumbling pair", "patroclus", "four bodies"],
)
def test_the_error_is_below_what_was_asked_and_not_far_below(name: str) -> None:
    for result in results(SETTINGS[name], (1e-5, 1e-9)):
        assert result.true < result.asked
        assert result.true > result.asked / 200
        assert result.true / 10 < result.estimated <= result.asked
        assert result.run.accuracy == result.asked
        assert "cheapest of" in result.run.choice
        assert f"{result.estimated:.1e}" in result.run.summary()


def test_no_clock_has_a_say(didymos: ba.System) -> None:
    state = ba.catalogue.load("didymos")[1]
    one, two = (ba.propagate(didymos, state, duration=2 * u.day, accuracy=1e-7) for _ in range(2))
    assert repr(one.integrator) == repr(two.integrator)
    assert one.estimated_error == two.estimated_error
    np.testing.assert_array_equal(one.si.attitude, two.si.attitude)


def test_rows_are_where_they_are_wanted(didymos: ba.System) -> None:
    state = ba.catalogue.load("didymos")[1]
    run = ba.propagate(didymos, state, duration=10 * u.h, accuracy=1e-6, save_every=7 * u.min)
    np.testing.assert_allclose(run.si.time[1:-1], 420 * np.arange(1, 86))
    assert run.si.time[-1] == pytest.approx(36000)
    assert run.step <= 7 * u.min


def test_without_anything_it_is_a_millionth(didymos: ba.System) -> None:
    run = ba.propagate(didymos, ba.catalogue.load("didymos")[1], duration=1 * u.day)
    assert run.accuracy == 1e-6
    assert run.estimated_error < 1e-6


def test_chaos_is_refused_with_its_horizon() -> None:
    """Within the horizon that is named, the accuracy can be had."""
    system, state = tumbling_pair()
    with pytest.raises(AccuracyError, match=r"1e-07 after 60 d is lost to round-off") as refused:
        ba.propagate(system, state, duration=60 * u.day, accuracy=1e-7)
    days = float(re.search(r"for the first ([\d.]+) d", str(refused.value))[1])
    assert 3 < days < 30
    run = ba.propagate(system, state, duration=0.5 * days * u.day, accuracy=1e-7)
    reference = ba.propagate(system, state, duration=0.5 * days * u.day, integrator=ba.Splitting(300 * u.s, "ss10"))
    assert error(run[-1], reference[-1]) < 1e-7


def test_less_than_round_off_is_refused_with_what_can_be_had(didymos: ba.System) -> None:
    state = ba.catalogue.load("didymos")[1]
    with pytest.raises(AccuracyError, match=r"1e-13 after .* is below what round-off leaves, about \de-1[23]"):
        ba.propagate(didymos, state, duration=60 * u.day, accuracy=1e-13)


@pytest.mark.filterwarnings("ignore::binaryast.errors.GravityWarning")
def test_a_run_that_ends_by_contact(didymos: ba.System) -> None:
    state = ba.State(
        [[0, 0, 0], [1.5, 0, 0]] * u.km, np.zeros((2, 3)) * u.m / u.s, [np.eye(3)] * 2, np.zeros((2, 3)) * u.rad / u.s
    )
    with pytest.warns(ba.errors.EndWarning, match="touched"):
        run = ba.propagate(didymos, state, duration=5 * u.day, accuracy=1e-7)
    assert run.status == "contact"
    assert run.estimated_error is None
    with pytest.warns(ba.errors.EndWarning):
        reference = ba.propagate(didymos, state, duration=5 * u.day, integrator=ba.Splitting(1 * u.s))
    assert run.si.time[-1] == pytest.approx(reference.si.time[-1], abs=2e-4)  # found within its step


def test_it_survives_a_file(didymos: ba.System, tmp_path) -> None:
    run = ba.propagate(didymos, ba.catalogue.load("didymos")[1], duration=1 * u.day, accuracy=1e-7)
    run.write(tmp_path / "run.h5")
    again = ba.Trajectory.read(tmp_path / "run.h5")
    assert (again.accuracy, again.estimated_error, again.choice) == (run.accuracy, run.estimated_error, run.choice)
    other = ba.propagate(didymos, run[-1], duration=1 * u.day, integrator=run.integrator)
    assert other.accuracy is None
    assert other.choice == ""


@pytest.mark.parametrize("value", [0, -1e-8, 1, 1e-15, np.nan, np.inf, "1e-8", [1e-8]])
def test_what_is_no_accuracy(didymos: ba.System, value) -> None:
    with pytest.raises(InputError, match="accuracy"):
        ba.propagate(didymos, ba.catalogue.load("didymos")[1], duration=1 * u.day, accuracy=value)


def test_both_are_too_much(didymos: ba.System) -> None:
    with pytest.raises(InputError, match="give one of them"):
        ba.propagate(
            didymos, ba.catalogue.load("didymos")[1], duration=1 * u.day, accuracy=1e-8, integrator=ba.LGVI(40 * u.s)
        )


def test_what_is_wrong_with_the_start_is_said_first(didymos: ba.System) -> None:
    state = ba.State(
        [[0, 0, 0], [300, 0, 0]] * u.m, np.zeros((2, 3)) * u.m / u.s, [np.eye(3)] * 2, np.zeros((2, 3)) * u.rad / u.s
    )
    with pytest.raises(ba.errors.ContactError, match="overlap"):
        ba.propagate(didymos, state, duration=1 * u.day, accuracy=1e-8)


def test_how_errors_are_carried_on() -> None:
    rows = np.arange(9.0)
    assert trials.at_end(rows**1.5, 4.0) == pytest.approx(8**1.5 * 4**1.5, rel=0.1)
    assert trials.at_end(rows**5, 4.0) == pytest.approx(8**5 * 4**2)
    assert trials.at_end(np.ones(9), 4.0) == pytest.approx(4)
